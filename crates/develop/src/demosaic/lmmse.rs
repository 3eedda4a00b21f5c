//! Directional linear minimum mean square-error demosaicing for Bayer sensors.
//!
//! L. Zhang and X. Wu, "Color demosaicking via directional linear minimum mean square-error estimation", IEEE
//! Transactions on Image Processing 14(12), 2005. The difference between green and red or blue is smooth. Along
//! rows and along columns it is estimated by a linear interpolation, whose error is taken for noise and removed
//! by a local linear estimator; the two directions are joined by the inverse of their estimated errors. Other than in
//! the paper, less of the second difference is used and the overshoot of green is limited.
//!
//! A tile is gone through from top to bottom, each step as many rows behind the one before as it looks ahead, so that only
//! the last rows of each are kept.

use std::array::from_fn;

use darkroot_photo::{CameraSpace, Cfa, Filter, Mosaic, Rgb};

use super::rows::{Row, Rows};
use super::{signed_sqrt, signed_square};
use darkroot_colour::simd::vectorised;

/// Pixels around the result that the method looks at: 2 for the interpolation, 4 for its low-pass, 4 for the
/// statistics, 1 for red and blue.
pub const BORDER: usize = 11;

/// Half the width of the low-pass and of the window of the statistics.
const HALF: usize = 4;
/// The low-pass of the paper (section III): a Gaussian of 9 taps.
const LOW_PASS: [f32; 2 * HALF + 1] = [
    4.0 / 128.0,
    9.0 / 128.0,
    15.0 / 128.0,
    23.0 / 128.0,
    26.0 / 128.0,
    23.0 / 128.0,
    15.0 / 128.0,
    9.0 / 128.0,
    4.0 / 128.0,
];
/// Factor of the other colour's second difference in the interpolation of one. Hamilton and Adams have a quarter,
/// right for grey detail; with this nothing is lost there, and colourful detail gains (0.2 dB on the McMaster
/// pictures).
const SECOND_DIFFERENCE: f32 = 0.1875;
/// What is left out on both sides of a row, in pairs of columns: there differences, low-pass and estimates would look
/// beyond it.
const DIFFERENCE_MARGIN: usize = 1;
const LOW_PASS_MARGIN: usize = DIFFERENCE_MARGIN + HALF / 2;
const ESTIMATE_MARGIN: usize = LOW_PASS_MARGIN + HALF / 2;
/// Keeps quotients of vanishing variances finite; far below the square of any sample.
const TINY: f32 = 1e-30;

/// Demosaics the inner part of a Bayer mosaic.
pub fn demosaic(mosaic: &Mosaic<f32>, cfa: &Cfa, border: usize, picture: &mut Rgb<CameraSpace>) {
    vectorised(
        #[inline(always)]
        || run(mosaic, cfa, border, picture),
    );
}

#[inline(always)]
fn run(mosaic: &Mosaic<f32>, cfa: &Cfa, border: usize, picture: &mut Rgb<CameraSpace>) {
    let (width, size) = (mosaic.size.width, picture.size());
    let half = width.div_ceil(2);
    // Of each: from the row that comes in back to the last one that is still looked at.
    let mut roots = Rows::new(2 + 2 * HALF + 2, half);
    let mut vertical = Rows::new(3 * HALF + 1, half);
    let mut vertical_low = Rows::new(2 * HALF + 1, half);
    let mut joined = Rows::new(3, half);
    let (mut horizontal, mut horizontal_low) = (Row::new(half), Row::new(half));
    let mut estimates = Estimates::new(half);
    let mut finished = [0; 3].map(|_| Row::new(half));

    let first = border - BORDER;
    for y in first..border + size.height + BORDER {
        roots.next(y).part(&mosaic.samples[y * width..(y + 1) * width], signed_sqrt);
        // The row in the middle of those that have come in.
        let middle = |behind: usize| (y >= first + 2 * behind).then(|| y - behind);
        if let Some(y) = middle(2) {
            difference_down(vertical.next(y), &roots, y, green_columns(cfa, y));
        }
        if let Some(y) = middle(2 + HALF) {
            low_pass_down(vertical_low.next(y), &vertical, y);
        }
        if let Some(y) = middle(2 + 2 * HALF) {
            let greens = green_columns(cfa, y);
            difference_along(&mut horizontal, roots.row(y), greens);
            low_pass_along(&mut horizontal_low, &horizontal);
            estimates.along(&horizontal, &horizontal_low, 1 - greens);
            estimates.down(&vertical, &vertical_low, y, 1 - greens);
            let out = &mut joined.next(y).columns[1 - greens][..];
            estimates.join(out);
            limit(out, &roots, y, 1 - greens);
        }
        if let Some(y) = middle(BORDER).filter(|y| *y < border + size.height) {
            // `own` is the colour that shares this row with green, `other` the one of the rows above and below.
            let [red, green, blue] = &mut finished;
            let red_row = (0..2).any(|x| cfa.at(x, y) == Filter::Red);
            let (own, other) = if red_row { (red, blue) } else { (blue, red) };
            colours([green, own, other], roots.row(y), &joined, y, green_columns(cfa, y));
            let out = (y - border) * size.width..(y - border + 1) * size.width;
            for (row, plane) in finished.iter().zip(picture.planes_mut()) {
                row.join(border, &mut plane[out.clone()]);
            }
        }
    }
}

/// 0 when the filters over the even columns of row `y` are green, 1 when those over the odd ones are.
#[inline(always)]
fn green_columns(cfa: &Cfa, y: usize) -> usize {
    usize::from(cfa.at(0, y) != Filter::Green)
}

/// Differences along the columns of row `y`.
#[inline(always)]
fn difference_down(out: &mut Row, roots: &Rows, y: usize, greens: usize) {
    for (parity, out) in out.columns.iter_mut().enumerate() {
        let samples = [y - 2, y - 1, y, y + 1, y + 2].map(|y| &roots.row(y).columns[parity][..]);
        difference(out, samples, parity == greens);
    }
}

/// Differences along a row.
#[inline(always)]
fn difference_along(out: &mut Row, roots: &Row, greens: usize) {
    for (parity, out) in out.columns.iter_mut().enumerate() {
        let samples = [-2, -1, 0, 1, 2].map(|shift| roots.beside(parity, shift, DIFFERENCE_MARGIN));
        let inner = DIFFERENCE_MARGIN..out.len() - DIFFERENCE_MARGIN;
        difference(&mut out[inner], samples, parity == greens);
    }
}

/// Difference of green and the other colour from five samples in line (the interpolation of Hamilton and Adams, with less
/// of the second difference), of which the middle one is green or not.
#[inline(always)]
fn difference(out: &mut [f32], s: [&[f32]; 5], is_green: bool) {
    let sign = if is_green { -1.0 } else { 1.0 };
    let s = s.map(|s| &s[..out.len()]);
    for (i, out) in out.iter_mut().enumerate() {
        let bend = SECOND_DIFFERENCE * (2.0 * s[2][i] - s[0][i] - s[4][i]);
        *out = sign * (0.5 * (s[1][i] + s[3][i]) + bend - s[2][i]);
    }
}

#[inline(always)]
fn low_pass_down(out: &mut Row, differences: &Rows, y: usize) {
    for (parity, out) in out.columns.iter_mut().enumerate() {
        low_pass(out, from_fn(|k| &differences.row(y + k - HALF).columns[parity][..]));
    }
}

#[inline(always)]
fn low_pass_along(out: &mut Row, differences: &Row) {
    for (parity, out) in out.columns.iter_mut().enumerate() {
        let inner = LOW_PASS_MARGIN..out.len() - LOW_PASS_MARGIN;
        let beside = |k| differences.beside(parity, k as isize - HALF as isize, LOW_PASS_MARGIN);
        low_pass(&mut out[inner], from_fn(beside));
    }
}

#[inline(always)]
fn low_pass(out: &mut [f32], s: [&[f32]; 9]) {
    let s = s.map(|s| &s[..out.len()]);
    for (i, out) in out.iter_mut().enumerate() {
        *out = LOW_PASS[0] * (s[0][i] + s[8][i])
            + LOW_PASS[1] * (s[1][i] + s[7][i])
            + LOW_PASS[2] * (s[2][i] + s[6][i])
            + LOW_PASS[3] * (s[3][i] + s[5][i])
            + LOW_PASS[4] * s[4][i];
    }
}

/// What the differences at red and blue sites of a row are, along it and along its columns, and how wrong that may be.
struct Estimates {
    along: [Vec<f32>; 2],
    down: [Vec<f32>; 2],
}

impl Estimates {
    fn new(half: usize) -> Self {
        let two = || [vec![0.0; half], vec![0.0; half]];
        Self { along: two(), down: two() }
    }

    #[inline(always)]
    fn along(&mut self, differences: &Row, low: &Row, sites: usize) {
        let [x, error] = &mut self.along;
        let inner = ESTIMATE_MARGIN..x.len() - ESTIMATE_MARGIN;
        estimate(
            &mut x[inner.clone()],
            &mut error[inner],
            from_fn(|k| differences.beside(sites, k as isize - HALF as isize, ESTIMATE_MARGIN)),
            from_fn(|k| low.beside(sites, k as isize - HALF as isize, ESTIMATE_MARGIN)),
        );
    }

    #[inline(always)]
    fn down(&mut self, differences: &Rows, low: &Rows, y: usize, sites: usize) {
        let [x, error] = &mut self.down;
        estimate(
            x,
            error,
            from_fn(|k| &differences.row(y + k - HALF).columns[sites][..]),
            from_fn(|k| &low.row(y + k - HALF).columns[sites][..]),
        );
    }

    /// Joins both by the inverse of their errors.
    #[inline(always)]
    fn join(&self, out: &mut [f32]) {
        let n = out.len();
        let [[x_h, e_h], [x_v, e_v]] = [&self.along, &self.down].map(|d| d.each_ref().map(|v| &v[..n]));
        for (i, out) in out.iter_mut().enumerate() {
            let (e_h, e_v) = (e_h[i] + TINY, e_v[i] + TINY);
            *out = (e_v * x_h[i] + e_h * x_v[i]) / (e_h + e_v);
        }
    }
}

/// The local linear estimate of a noisy signal and its expected error (equations 8 to 12 of the paper).
#[inline(always)]
fn estimate(x: &mut [f32], error: &mut [f32], signal: [&[f32]; 9], low: [&[f32]; 9]) {
    let n = x.len();
    let (signal, low) = (signal.map(|s| &s[..n]), low.map(|s| &s[..n]));
    let error = &mut error[..n];
    for i in 0..n {
        // From the one in the middle, so that what they have in common takes no digits.
        let middle = low[4][i];
        let (mut sum, mut squares, mut noise) = (0.0, 0.0, 0.0);
        for k in 0..9 {
            let spread = low[k][i] - middle;
            let rest = low[k][i] - signal[k][i];
            sum += spread;
            squares += spread * spread;
            noise += rest * rest;
        }
        let mean = sum * (1.0 / 9.0);
        let own = squares - sum * mean;
        let own = if own > 0.0 { own } else { 0.0 };
        let mean = middle + mean;
        let gain = own / (own + noise + TINY);
        x[i] = mean + gain * (signal[4][i] - mean);
        error[i] = gain * noise;
    }
}

/// Keeps green within the range of its four neighbours and as much again on both sides: where red or blue change by
/// more than green does, as at the edges of saturated colours, the estimate overshoots and leaves a grid of dots.
#[inline(always)]
fn limit(differences: &mut [f32], roots: &Rows, y: usize, sites: usize) {
    let n = differences.len() - 2;
    let differences = &mut differences[1..=n];
    let [left, here, right] = [-1, 0, 1].map(|shift| &roots.row(y).beside(sites, shift, 1)[..n]);
    let [up, down] = [y - 1, y + 1].map(|y| &roots.row(y).beside(sites, 0, 1)[..n]);
    let least = |a: f32, b: f32| if a < b { a } else { b };
    let most = |a: f32, b: f32| if a > b { a } else { b };
    for i in 0..n {
        let low = least(least(left[i], right[i]), least(up[i], down[i]));
        let high = most(most(left[i], right[i]), most(up[i], down[i]));
        let range = high - low;
        let green = here[i] + differences[i];
        differences[i] = least(most(green, low - range), high + range) - here[i];
    }
}

/// Green, the colour that shares row `y` with it and the other one, from the row's samples and the differences there and
/// in the rows above and below.
#[inline(always)]
fn colours([green, own, other]: [&mut Row; 3], samples: &Row, differences: &Rows, y: usize, greens: usize) {
    let n = samples.columns[0].len() - 2;
    let at = |down: usize, parity: usize, shift: isize| {
        &differences.row(y + down - 1).beside(parity, shift, 1)[..n]
    };
    let sites = greens;
    let (left, right, up, down) = (at(1, sites, -1), at(1, sites, 1), at(0, sites, 0), at(2, sites, 0));
    let [g, o, t] = [&mut *green, &mut *own, &mut *other].map(|row| &mut row.columns[sites][1..=n]);
    for (i, &s) in samples.beside(sites, 0, 1).iter().enumerate() {
        g[i] = signed_square(s);
        o[i] = signed_square(s - 0.5 * (left[i] + right[i]));
        t[i] = signed_square(s - 0.5 * (up[i] + down[i]));
    }
    let sites = 1 - greens;
    let (up_left, up_right) = (at(0, sites, -1), at(0, sites, 1));
    let (here, down_left, down_right) = (at(1, sites, 0), at(2, sites, -1), at(2, sites, 1));
    let [g, o, t] = [green, own, other].map(|row| &mut row.columns[sites][1..=n]);
    for (i, &s) in samples.beside(sites, 0, 1).iter().enumerate() {
        let estimate = s + here[i];
        g[i] = signed_square(estimate);
        o[i] = signed_square(s);
        t[i] = signed_square(estimate - 0.25 * (up_left[i] + up_right[i] + down_left[i] + down_right[i]));
    }
}
