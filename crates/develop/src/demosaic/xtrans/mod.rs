//! Demosaicing for Fujifilm X-Trans sensors: linear prediction under several models of the picture, joined by how
//! well each predicts the samples that are there.
//!
//! No model of `kriging` is right everywhere, so there are eight: edges that run in four directions,
//! each with colours that change along with brightness and with colours that change on their own.
//!
//! Which of them fits is seen from the samples themselves: each sample is predicted from those around it without
//! itself (O. Dubrule, "Cross validation of kriging in a unique neighborhood", Mathematical Geology 15(6), 1983),
//! and the models are joined by the errors that this shows nearby.

use darkroot_photo::{CameraSpace, Mosaic, Rgb};

mod mirror;
mod parts;
mod sites;
#[cfg(test)]
mod slow;

use darkroot_colour::simd::vectorised;

use super::signed_square;
use mirror::{Folded, Mirrored, Predictions, site_at};
use parts::{LANES, Lanes, Parts, lanes, put_together, take_apart};
pub(super) use sites::phase;
use sites::{MODELS, PERIOD, REACH, reached};

/// Pixels around the result that the method looks at: 4 for the prediction, 4 for its errors.
pub const BORDER: usize = REACH + HALF;

/// Half the width of the window of the errors.
const HALF: usize = 4;
/// Weights of the errors by rows and by columns away: a triangle.
const WINDOW: [f32; HALF + 1] = [0.04, 0.08, 0.12, 0.16, 0.2];
/// Keeps quotients of vanishing errors finite; far below the square of any sample.
const TINY: f32 = 1e-30;

/// Demosaics the inner part of an X-Trans mosaic whose array begins at `phase`.
pub fn demosaic(mosaic: &Mosaic<f32>, phase: (usize, usize), border: usize, picture: &mut Rgb<CameraSpace>) {
    vectorised(
        #[inline(always)]
        || run(mosaic, phase, border, picture),
    );
}

#[inline(always)]
fn run(mosaic: &Mosaic<f32>, phase: (usize, usize), border: usize, picture: &mut Rgb<CameraSpace>) {
    let (width, height) = (mosaic.size.width, mosaic.size.height);
    let parts = Parts::of(width);
    let roots = take_apart(&mosaic.samples, width, parts);
    // Where the samples that predict are, from the first of a row `REACH` above, for each part.
    let places = reached();
    let taps: [Vec<usize>; PERIOD] = std::array::from_fn(|k| {
        let tap =
            |&(dx, dy): &(isize, isize)| REACH.wrapping_add_signed(dy) * parts.row() + parts.index(k, dx);
        places.iter().map(tap).collect()
    });
    let around = |y: usize| Around {
        samples: &roots[(y - REACH) * parts.row()..],
        taps: &taps,
        sites: std::array::from_fn(|k| site_at(k + phase.0, y + phase.1)),
        parts,
    };

    let size = picture.size();
    let [red, green, blue] = picture.planes_mut();
    // Squared errors of one row, for each model; and of the last rows, smoothed along them.
    let mut errors = vec![0f32; MODELS * parts.row()];
    let mut smoothed = vec![vec![0f32; MODELS * parts.row()]; 2 * HALF + 1];
    let mut colours = [(); 3].map(|()| vec![0f32; parts.row()]);
    for y in border - HALF..height - border + HALF {
        around(y).squared_errors(&mut errors);
        let latest = smoothed.len() - 1;
        smoothed.rotate_left(1);
        for (out, errors) in
            smoothed[latest].chunks_exact_mut(parts.row()).zip(errors.chunks_exact(parts.row()))
        {
            smooth(out, errors, parts);
        }
        if y < border + HALF {
            continue;
        }
        window(&mut errors, std::array::from_fn(|i| &smoothed[i][..]));
        share(&mut errors, parts.row());
        let y = y - HALF;
        around(y).colours(&errors, &mut colours);
        let line = (y - border) * size.width..(y - border + 1) * size.width;
        for (plane, colour) in [&mut *red, &mut *green, &mut *blue].into_iter().zip(&colours) {
            put_together(&mut plane[line.clone()], colour, border, parts);
        }
    }
}

/// What one row is predicted from.
struct Around<'a> {
    /// Rows that are taken apart, from `REACH` rows above on.
    samples: &'a [f32],
    taps: &'a [Vec<usize>; PERIOD],
    /// For each part.
    sites: [&'static Mirrored; PERIOD],
    parts: Parts,
}

impl Around<'_> {
    /// Squared errors of predicting the row's own samples, for each model.
    #[inline(always)]
    fn squared_errors(&self, errors: &mut [f32]) {
        let parts = self.parts;
        let mut folded = Folded::NOTHING;
        for (k, (taps, site)) in self.taps.iter().zip(self.sites).enumerate() {
            for j in (0..parts.pixels).step_by(LANES) {
                folded.fill(&self.samples[j..], taps, site);
                let (error, models) = site.error(&folded);
                for (error, model) in error.iter().zip(models) {
                    let at = model * parts.row() + parts.index(k, 0) + j;
                    for (out, e) in errors[at..at + LANES].iter_mut().zip(error) {
                        *out = e * e;
                    }
                }
            }
        }
    }

    /// The three colours of the row, from the models' shares.
    #[inline(always)]
    fn colours(&self, shares: &[f32], colours: &mut [Vec<f32>; 3]) {
        let parts = self.parts;
        let mut folded = Folded::NOTHING;
        for (k, (taps, site)) in self.taps.iter().zip(self.sites).enumerate() {
            for j in (0..parts.pixels).step_by(LANES) {
                let at = parts.index(k, 0) + j;
                folded.fill(&self.samples[j..], taps, site);
                for (i, predictions) in site.missing(&folded).iter().enumerate() {
                    let root = join(predictions, &shares[at..], parts.row());
                    squared(&mut colours[(site.own + 1 + i) % 3][at..], &root);
                }
                squared(&mut colours[site.own][at..], &lanes(&self.samples[REACH * parts.row() + at..]));
            }
        }
    }
}

/// Light from its roots.
#[inline(always)]
fn squared(light: &mut [f32], roots: &Lanes) {
    for (light, root) in light.iter_mut().zip(roots) {
        *light = signed_square(*root);
    }
}

/// Smooths a row that is taken apart.
#[inline(always)]
fn smooth(out: &mut [f32], row: &[f32], parts: Parts) {
    for k in 0..PERIOD {
        let shifts =
            std::array::from_fn(|i| &row[parts.index(k, i as isize - HALF as isize)..][..parts.pixels]);
        window(&mut out[parts.index(k, 0)..][..parts.pixels], shifts);
    }
}

#[inline(always)]
fn window(out: &mut [f32], s: [&[f32]; 2 * HALF + 1]) {
    let n = out.len();
    let s = s.map(|s| &s[..n]);
    for i in 0..n {
        out[i] = WINDOW[0] * (s[0][i] + s[8][i])
            + WINDOW[1] * (s[1][i] + s[7][i])
            + WINDOW[2] * (s[2][i] + s[6][i])
            + WINDOW[3] * (s[3][i] + s[5][i])
            + WINDOW[4] * s[4][i];
    }
}

/// Turns mean square errors, those of one model `row` after the other, into shares of the models in the result:
/// inverse to the eighth power, so nearly a choice.
#[inline(always)]
fn share(errors: &mut [f32], row: usize) {
    let mut rows = errors.chunks_exact_mut(row);
    let each: [&mut [f32]; MODELS] = std::array::from_fn(|_| rows.next().unwrap_or_default());
    let mut each = each.map(|errors| &mut errors[..row]);
    for i in 0..row {
        let mut least = each[0][i];
        for errors in &each[1..] {
            least = if errors[i] < least { errors[i] } else { least };
        }
        let mut total = 0.0;
        for errors in &mut each {
            let ratio = (least + TINY) / (errors[i] + TINY);
            let second = ratio * ratio;
            let fourth = second * second;
            errors[i] = fourth * fourth;
            total += errors[i];
        }
        for shares in &mut each {
            shares[i] /= total;
        }
    }
}

/// The predictions joined by the models' shares, those of one model `row` after the other.
#[inline(always)]
fn join((predictions, models): &Predictions, shares: &[f32], row: usize) -> Lanes {
    let mut sum = [0f32; LANES];
    for (prediction, model) in predictions.iter().zip(*models) {
        let shares = lanes(&shares[model * row..]);
        for l in 0..LANES {
            sum[l] += prediction[l] * shares[l];
        }
    }
    sum
}
