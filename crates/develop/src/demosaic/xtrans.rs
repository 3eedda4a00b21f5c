//! Demosaicing for Fujifilm X-Trans sensors: linear prediction under several models of the picture, joined by how
//! well each predicts the samples that are there.
//!
//! A model says how alike two samples are, by their distance, by the angle between them and by their colours; the
//! best linear prediction of a missing colour under it is a fixed weighting of the samples around the pixel
//! (kriging: G. Matheron, "Principles of geostatistics", Economic Geology 58, 1963; for filter arrays: H. J.
//! Trussell and R. E. Hartley, "Mathematics for demosaicking", IEEE Transactions on Image Processing 11(4),
//! 2002). No model is right everywhere, so there are eight: edges that run in four directions, each with colours
//! that change along with brightness and with colours that change on their own.
//!
//! Which of them fits is seen from the samples themselves: each sample is predicted from those around it without
//! itself (O. Dubrule, "Cross validation of kriging in a unique neighborhood", Mathematical Geology 15(6), 1983),
//! and the models are joined by the errors that this shows nearby.

use std::sync::LazyLock;

use darkroot_photo::{CameraSpace, Cfa, Mosaic, Rgb};

use super::{signed_sqrt, signed_square};
use darkroot_profile::simd::vectorised;

/// Pixels around the result that the method looks at: 4 for the prediction, 4 for its errors.
pub const BORDER: usize = REACH + HALF;

/// Samples within this distance, and half a pixel more, predict.
const REACH: usize = 4;
/// Half the width of the window of the errors.
const HALF: usize = 4;
/// Weights of the errors by rows and by columns away: a triangle.
const WINDOW: [f32; HALF + 1] = [0.04, 0.08, 0.12, 0.16, 0.2];
/// Keeps quotients of vanishing errors finite; far below the square of any sample.
const TINY: f32 = 1e-30;

/// Columns and rows after which the array repeats.
const PERIOD: usize = 6;
/// The array of every X-Trans sensor, but for where it begins.
const ARRAY: [&[u8; PERIOD]; PERIOD] = [b"GBGGRG", b"RGRBGB", b"GBGGRG", b"GRGGBG", b"BGBRGR", b"GRGGBG"];

/// The array's colour (0 red, 1 green, 2 blue) in column `x` of row `y`.
fn colour(x: usize, y: usize) -> usize {
    match ARRAY[y % PERIOD][x % PERIOD] {
        b'R' => 0,
        b'G' => 1,
        _ => 2,
    }
}

/// Column and row of the X-Trans array at which `cfa` begins; `None` for any other array.
pub fn phase(cfa: &Cfa) -> Option<(usize, usize)> {
    let places = (0..PERIOD * PERIOD).map(|i| (i % PERIOD, i / PERIOD));
    let same =
        |x: usize, y: usize, (u, v): (usize, usize)| cfa.at(x, y).plane() == Some(colour(x + u, y + v));
    let six = cfa.width() == PERIOD && cfa.height() == PERIOD;
    places.clone().find(|&begin| six && places.clone().all(|(x, y)| same(x, y, begin)))
}

/// Models of the picture.
const MODELS: usize = 8;
/// A number for each model.
type Each = [f32; MODELS];

/// How unlike two samples are: half the mean square of their difference, up to a factor, is
/// `d(stretch)^power + share d(colour_stretch)^colour_power`. The second term is for equal colours only; for unequal
/// ones it is a constant, which the prediction does not depend on. `d(s)` is the distance in pixels, divided by the
/// root of `s` along the edges and multiplied by it across them.
///
/// The numbers were found by trying, on four Kodak and three McMaster pictures in linear light.
#[derive(Clone, Copy)]
struct Model {
    stretch: f64,
    colour_stretch: f64,
    /// How much colours change on their own.
    share: f64,
    /// Of the distance, in quarters.
    power: u32,
    colour_power: u32,
}

/// Colours that change along with brightness.
const GREYISH: Model = Model { stretch: 1.7, colour_stretch: 1.4, share: 0.018, power: 6, colour_power: 4 };
/// Colours that change on their own.
const COLOURFUL: Model = Model { stretch: 2.5, colour_stretch: 2.8, share: 0.6, power: 6, colour_power: 7 };
/// Directions of the edges.
const DIRECTIONS: [(f64, f64); MODELS / 2] = {
    use std::f64::consts::FRAC_1_SQRT_2 as S;
    [(1.0, 0.0), (S, S), (0.0, 1.0), (-S, S)]
};
/// Variance of each sample's own noise, in the unit of the models: keeps the equations well conditioned.
const NOISE: f64 = 1e-3;

impl Model {
    /// Likeness of two samples `dx` columns and `dy` rows apart where edges run along `direction`.
    fn likeness(&self, direction: (f64, f64), (dx, dy): (isize, isize), same_colour: bool) -> f64 {
        let (dx, dy) = (dx as f64, dy as f64);
        let along = direction.0 * dx + direction.1 * dy;
        let across = direction.0 * dy - direction.1 * dx;
        let unlike = |stretch: f64, power: u32| {
            let squared = along * along / stretch + across * across * stretch;
            // Powers from square roots, which are the same on every machine.
            let (half, quarter, eighth) =
                (squared.sqrt(), squared.sqrt().sqrt(), squared.sqrt().sqrt().sqrt());
            let factor = |bit: u32, root: f64| if power & bit != 0 { root } else { 1.0 };
            factor(4, half) * factor(2, quarter) * factor(1, eighth)
        };
        let colour =
            if same_colour { self.share * unlike(self.colour_stretch, self.colour_power) } else { 0.0 };
        -unlike(self.stretch, self.power) - colour
    }
}

/// What predicts at one place of the array: weights of the samples of [`reached`], in their order.
struct Site {
    /// Colour of the place.
    own: usize,
    /// For the two other colours.
    missing: [Vec<Each>; 2],
    /// For the error of predicting the place's own sample without itself.
    error: Vec<Each>,
}

/// Places of the samples that predict, from the pixel: columns and rows.
fn reached() -> Vec<(isize, isize)> {
    let reach = REACH as isize;
    let square = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
    square.filter(|(dx, dy)| dx * dx + dy * dy <= reach * reach + reach).collect()
}

/// The sites of the array. It looks the same three columns and three rows on, so three rows have them all.
static SITES: LazyLock<Vec<Site>> =
    LazyLock::new(|| (0..PERIOD * PERIOD / 2).map(|i| site(i % PERIOD, i / PERIOD)).collect());

fn site_at(x: usize, y: usize) -> &'static Site {
    let x = if y % PERIOD < 3 { x } else { x + 3 };
    &SITES[y % 3 * PERIOD + x % PERIOD]
}

/// Solves the equations of kriging, every colour's mean being unknown, for column `x` of row `y` of the array.
fn site(x: usize, y: usize) -> Site {
    let places = reached();
    let n = places.len();
    let beside = |(dx, dy): (isize, isize)| {
        colour((x + PERIOD).wrapping_add_signed(dx), (y + PERIOD).wrapping_add_signed(dy))
    };
    let own = colour(x, y);
    let others = [(own + 1) % 3, (own + 2) % 3];
    let mut site = Site {
        own,
        missing: [vec![[0.0; MODELS]; n], vec![[0.0; MODELS]; n]],
        error: vec![[0.0; MODELS]; n],
    };
    for number in 0..MODELS {
        let model = if number < MODELS / 2 { GREYISH } else { COLOURFUL };
        let direction = DIRECTIONS[number % (MODELS / 2)];
        let is = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
        // Rows: one for each sample, one for each colour's mean. Columns: the same and three right-hand sides.
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n + 3);
        for (i, &place) in places.iter().enumerate() {
            let c = beside(place);
            let mut row: Vec<f64> = places
                .iter()
                .map(|&(u, v)| model.likeness(direction, (u - place.0, v - place.1), beside((u, v)) == c))
                .collect();
            row[i] += NOISE;
            row.extend([0, 1, 2].map(|mean| is(c, mean)));
            row.extend(others.map(|other| model.likeness(direction, place, c == other)));
            row.push(if place == (0, 0) { 1.0 } else { 0.0 });
            rows.push(row);
        }
        for mean in 0..3 {
            let mut row: Vec<f64> = places.iter().map(|&place| is(beside(place), mean)).collect();
            row.extend([0.0; 3]);
            row.extend(others.map(|other| is(other, mean)));
            row.push(0.0);
            rows.push(row);
        }
        solve(&mut rows);
        // The error is the solution for the unit vector of the own sample over its own coefficient (Dubrule).
        let whole = rows[places.iter().position(|&place| place == (0, 0)).unwrap_or(0)][n + 5];
        for (i, row) in rows.iter().take(n).enumerate() {
            site.missing[0][i][number] = row[n + 3] as f32;
            site.missing[1][i][number] = row[n + 4] as f32;
            site.error[i][number] = (row[n + 5] / whole) as f32;
        }
    }
    site
}

/// Solves a system of linear equations by elimination: `rows` are those of the matrix, each followed by its
/// right-hand sides, which become the solutions.
fn solve(rows: &mut [Vec<f64>]) {
    let n = rows.len();
    for pivot in 0..n {
        let size = |rows: &[Vec<f64>], i: usize| rows[i][pivot].abs();
        let largest = (pivot..n).fold(pivot, |a, b| if size(rows, b) > size(rows, a) { b } else { a });
        rows.swap(pivot, largest);
        let (done, below) = rows.split_at_mut(pivot + 1);
        let base = &mut done[pivot];
        let scale = 1.0 / base[pivot];
        for v in &mut base[pivot..] {
            *v *= scale;
        }
        for row in below {
            eliminate(row, base, pivot);
        }
    }
    // Backwards, on the right-hand sides alone.
    for pivot in (0..n).rev() {
        let (above, base) = rows.split_at_mut(pivot);
        for row in above {
            let factor = row[pivot];
            for (v, b) in row[n..].iter_mut().zip(&base[0][n..]) {
                *v -= factor * b;
            }
        }
    }
}

fn eliminate(row: &mut [f64], base: &[f64], pivot: usize) {
    let factor = row[pivot];
    for (v, b) in row[pivot..].iter_mut().zip(&base[pivot..]) {
        *v -= factor * b;
    }
}

/// Pixels that are worked on at once: of one column of the array, so [`PERIOD`] columns apart.
const LANES: usize = 8;
type Lanes = [f32; LANES];

/// A row of pixels taken apart by columns of the array: part `k` has columns `k`, `k + 6`, `k + 12` and so on,
/// after one pixel of nothing and before others.
#[derive(Clone, Copy)]
struct Parts {
    /// Pixels of a part that are worked on: a multiple of [`LANES`].
    pixels: usize,
}

impl Parts {
    fn of(width: usize) -> Self {
        Self { pixels: width.div_ceil(PERIOD).next_multiple_of(LANES) }
    }

    /// Floats of a part.
    fn length(self) -> usize {
        self.pixels + 2
    }

    /// Floats of a row.
    fn row(self) -> usize {
        PERIOD * self.length()
    }

    /// Where in a row the pixel `dx` columns from pixel 0 of part `k` is, `|dx| < 6`.
    fn index(self, k: usize, dx: isize) -> usize {
        let column = (k + PERIOD).wrapping_add_signed(dx);
        column % PERIOD * self.length() + column / PERIOD
    }
}

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
    let site = |k: usize, y: usize| site_at(k + phase.0, y + phase.1);

    let size = picture.size();
    let [red, green, blue] = picture.planes_mut();
    // Squared errors of one row, for each model; and of the last rows, smoothed along them.
    let mut errors = vec![0f32; MODELS * parts.row()];
    let mut smoothed = vec![vec![0f32; MODELS * parts.row()]; 2 * HALF + 1];
    let mut colours = [(); 3].map(|()| vec![0f32; parts.row()]);
    for y in border - HALF..height - border + HALF {
        let around = &roots[(y - REACH) * parts.row()..];
        for (k, taps) in taps.iter().enumerate() {
            let site = site(k, y);
            for j in (0..parts.pixels).step_by(LANES) {
                let error = predict(&around[j..], taps, &site.error);
                for (number, error) in error.iter().enumerate() {
                    let at = number * parts.row() + parts.index(k, 0) + j;
                    errors[at..at + LANES].copy_from_slice(&error.map(|e| e * e));
                }
            }
        }
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
        let around = &roots[(y - REACH) * parts.row()..];
        for (k, taps) in taps.iter().enumerate() {
            let site = site(k, y);
            for j in (0..parts.pixels).step_by(LANES) {
                let at = parts.index(k, 0) + j;
                let shares = &errors[at..];
                let mut put = |c: usize, root: Lanes| {
                    colours[c][at..at + LANES].copy_from_slice(&root.map(signed_square));
                };
                for (i, weights) in site.missing.iter().enumerate() {
                    put(
                        (site.own + 1 + i) % 3,
                        join(&predict(&around[j..], taps, weights), shares, parts.row()),
                    );
                }
                let own = &around[REACH * parts.row() + at..][..LANES];
                put(site.own, std::array::from_fn(|l| own[l]));
            }
        }
        let line = (y - border) * size.width..(y - border + 1) * size.width;
        for (plane, colour) in [&mut *red, &mut *green, &mut *blue].into_iter().zip(&colours) {
            put_together(&mut plane[line.clone()], colour, border, parts);
        }
    }
}

/// Signed square roots of samples, each row taken apart.
#[inline(always)]
fn take_apart(samples: &[f32], width: usize, parts: Parts) -> Vec<f32> {
    let mut roots = vec![0f32; samples.len() / width * parts.row()];
    for (row, out) in samples.chunks_exact(width).zip(roots.chunks_exact_mut(parts.row())) {
        for (k, out) in out.chunks_exact_mut(parts.length()).enumerate() {
            for (out, v) in out[1..].iter_mut().zip(row[k.min(width)..].iter().step_by(PERIOD)) {
                *out = signed_sqrt(*v);
            }
        }
    }
    roots
}

/// Puts a row together again, from column `first` on.
#[inline(always)]
fn put_together(out: &mut [f32], row: &[f32], first: usize, parts: Parts) {
    for k in 0..PERIOD {
        let column = first + k;
        let part = &row[parts.index(column % PERIOD, 0) + column / PERIOD..];
        for (out, v) in out.iter_mut().skip(k).step_by(PERIOD).zip(part) {
            *out = *v;
        }
    }
}

/// Weighted sums of samples, for each model.
#[inline(always)]
fn predict(samples: &[f32], taps: &[usize], weights: &[Each]) -> [Lanes; MODELS] {
    let mut sums = [[0f32; LANES]; MODELS];
    for (tap, weights) in taps.iter().zip(weights) {
        let samples: Lanes = std::array::from_fn(|l| samples[*tap..*tap + LANES][l]);
        for number in 0..MODELS {
            for l in 0..LANES {
                sums[number][l] += weights[number] * samples[l];
            }
        }
    }
    sums
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
fn join(predictions: &[Lanes; MODELS], shares: &[f32], row: usize) -> Lanes {
    let mut sum = [0f32; LANES];
    for (number, prediction) in predictions.iter().enumerate() {
        let shares = &shares[number * row..number * row + LANES];
        for l in 0..LANES {
            sum[l] += prediction[l] * shares[l];
        }
    }
    sum
}
