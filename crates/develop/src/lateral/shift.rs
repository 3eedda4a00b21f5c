//! By how much one colour lies beside green in a block.
//!
//! Where red sees r(x), green sees g(x + s), but for a factor and a constant: across an edge between two surfaces that holds
//! for any colours of theirs. Factor, constant and s are found by least squares with g made linear about the last s (Lucas
//! and Kanade, IJCAI 1981), until s stays. Least squares also tell how certain s is, along each direction.

use super::blocks::SIDE;

/// Samples of a colour along a block's side.
const SAMPLES: usize = SIDE / 2 - 2;
/// Samples beyond those that are compared, on each side: what a shift may need.
const MARGIN: usize = 4;
/// Samples along a side that are compared.
const INNER: usize = SAMPLES - 2 * MARGIN;
/// Shifts beyond this are none, in samples.
const FARTHEST: f64 = 2.0;
/// Times that the shift is improved; it stays before where a step is below the second, in samples.
const STEPS: usize = 6;
const STILL: f64 = 0.01;
/// Share of a colour's variance that green must explain.
const ALIKE: f64 = 0.6;
/// So many compared samples count as one, because their errors depend on each other: the low-pass has 3 x 3 taps, and where one
/// factor and one constant do not fit all colours of a block, whole edges are off.
const DEPENDENT: f64 = 40.0;

/// A displacement against green in pixels, and its certainty: the inverse of its covariance (xx, xy, yy).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shift {
    pub(super) by: [f64; 2],
    /// Where the edges are that tell it, in pixels from the middle of the block.
    pub(super) at: [f64; 2],
    pub(super) certainty: [f64; 3],
}

/// A colour of a block, and green at the same places: every second pixel, low-passed.
#[derive(Debug, Clone, Default)]
pub(super) struct Planes {
    colour: Vec<f32>,
    green: Vec<f32>,
    raw: Vec<f32>,
}

impl Planes {
    /// Takes the samples of a block in which the colour has this first column and row.
    pub(super) fn of(&mut self, samples: &[f32], (x, y): (usize, usize)) {
        // From the first place on that has greens on all sides, and to the last.
        let first = |phase: usize| if phase == 0 { 2 } else { 1 };
        let corner = first(y) * SIDE + first(x);
        let at = |i: usize, j: usize| corner + 2 * (j * SIDE + i);
        let Self { colour, green, raw } = self;
        low_passed(|i, j| samples[at(i, j)], raw, colour);
        let around = |i: usize, j: usize| {
            let at = at(i, j);
            0.25 * ((samples[at - 1] + samples[at + 1]) + (samples[at - SIDE] + samples[at + SIDE]))
        };
        low_passed(around, raw, green);
    }
}

/// A low-pass of three binomial taps along both axes; the outermost samples only serve their neighbours.
fn low_passed(sample: impl Fn(usize, usize) -> f32, raw: &mut Vec<f32>, out: &mut Vec<f32>) {
    const N: usize = SAMPLES;
    raw.clear();
    raw.extend((0..N * N).map(|k| sample(k % N, k / N)));
    out.clear();
    out.resize(N * N, 0.0);
    for (j, out) in out.chunks_exact_mut(N).enumerate().take(N - 1).skip(1) {
        let mut sums = [0f32; N];
        for (i, sum) in sums.iter_mut().enumerate() {
            let at = j * N + i;
            *sum = 0.25 * (raw[at - N] + raw[at + N]) + 0.5 * raw[at];
        }
        for (out, around) in out[1..N - 1].iter_mut().zip(sums.windows(3)) {
            *out = 0.25 * (around[0] + around[2]) + 0.5 * around[1];
        }
    }
}

/// Where the colour of what green shows lies, against green; `None` where the block does not tell.
pub(super) fn displaced(planes: &Planes) -> Option<Shift> {
    let mut s = [0f64; 2];
    let (mut last, mut at) = (None, [0.0; 2]);
    for _ in 0..STEPS {
        let sums = Sums::of(planes, s);
        let (step, certainty) = sums.solved()?;
        at = sums.middle();
        s = [s[0] + step[0], s[1] + step[1]];
        // Written so that no number is refused, too.
        if !(s[0].abs() < FARTHEST && s[1].abs() < FARTHEST) {
            return None;
        }
        last = Some(certainty);
        if step[0].hypot(step[1]) < STILL {
            break;
        }
    }
    // Samples lie two pixels apart; what green shows at x + s, the colour shows at x.
    let certainty = last?.map(|v| v / 4.0);
    Some(Shift { by: s.map(|s| -2.0 * s), at, certainty })
}

/// Products of what is compared, less those of the means: green, its slopes along x and y, the colour.
struct Sums {
    products: [[f64; 4]; 4],
    /// Sums of squared slopes, plain and times the distance from the first column and row.
    slopes: [f64; 3],
}

impl Sums {
    fn of(planes: &Planes, s: [f64; 2]) -> Self {
        let [(left, across, across_slope), (top, down, down_slope)] = s.map(cubic);
        let mut sums = [[0f64; 4]; 4];
        let (mut means, mut slopes) = ([0f64; 4], [0f64; 3]);
        let first = |begin: isize| (MARGIN as isize + begin) as usize;
        let (left, top) = (first(left), first(top));
        // Rows interpolated along x, with their slopes.
        let mut rows = [[[0f32; INNER]; 2]; INNER + 3];
        for (j, [value, slope]) in rows.iter_mut().enumerate() {
            let row = &planes.green[(top + j) * SAMPLES + left..][..INNER + 3];
            for i in 0..INNER {
                let taps = [row[i], row[i + 1], row[i + 2], row[i + 3]];
                value[i] = dot(&taps, &across);
                slope[i] = dot(&taps, &across_slope);
            }
        }
        for j in 0..INNER {
            let colour = &planes.colour[(MARGIN + j) * SAMPLES + MARGIN..][..INNER];
            let mut products = [[0f32; 4]; 4];
            let (mut of_row, mut along) = ([0f32; 4], 0f32);
            for i in 0..INNER {
                let taps =
                    |k: usize| [rows[j][k][i], rows[j + 1][k][i], rows[j + 2][k][i], rows[j + 3][k][i]];
                let values = taps(0);
                let v = [dot(&values, &down), dot(&taps(1), &down), dot(&values, &down_slope), colour[i]];
                along += (v[1] * v[1] + v[2] * v[2]) * i as f32;
                for a in 0..4 {
                    of_row[a] += v[a];
                    for b in a..4 {
                        products[a][b] += v[a] * v[b];
                    }
                }
            }
            let of_slopes = f64::from(products[1][1] + products[2][2]);
            slopes = [slopes[0] + of_slopes, slopes[1] + f64::from(along), slopes[2] + j as f64 * of_slopes];
            for a in 0..4 {
                means[a] += f64::from(of_row[a]);
                for b in a..4 {
                    sums[a][b] += f64::from(products[a][b]);
                }
            }
        }
        let n = (INNER * INNER) as f64;
        for a in 0..4 {
            for b in a..4 {
                sums[a][b] -= means[a] * means[b] / n;
                sums[b][a] = sums[a][b];
            }
        }
        Self { products: sums, slopes }
    }

    /// The mean place of the slopes, in pixels from the middle.
    fn middle(&self) -> [f64; 2] {
        let [all, x, y] = self.slopes;
        [x, y].map(|v| if all > 0.0 { 2.0 * (v / all - 0.5 * (INNER as f64 - 1.0)) } else { 0.0 })
    }

    /// The step of the shift, and its certainty, both in samples.
    fn solved(&self) -> Option<([f64; 2], [f64; 3])> {
        let [green, x, y, colour] = self.products;
        // What green itself explains is taken out of all.
        let less = |a: f64, b: f64, ab: f64| ab - a * b / green[0];
        let (xx, xy, yy) =
            (less(green[1], green[1], x[1]), less(green[1], green[2], x[2]), less(green[2], green[2], y[2]));
        let (xc, yc) = (less(green[1], green[3], x[3]), less(green[2], green[3], y[3]));
        // An edge tells nothing of a shift along itself: a little is added so that this stays none.
        let added = 1e-3 * (xx + yy);
        let (sxx, syy) = (xx + added, yy + added);
        let determinant = sxx * syy - xy * xy;
        if !(green[0] > 0.0 && determinant > 0.0) {
            return None;
        }
        let step = [(syy * xc - xy * yc) / determinant, (sxx * yc - xy * xc) / determinant];
        let factor = (green[3] - step[0] * green[1] - step[1] * green[2]) / green[0];
        let left = less(green[3], green[3], colour[3]) - step[0] * xc - step[1] * yc;
        let variance = (left / colour[3]).max(1e-6);
        if !(factor > 0.0 && colour[3] > 0.0 && variance < 1.0 - ALIKE) {
            return None;
        }
        let of_sample = variance * colour[3] * DEPENDENT / (INNER * INNER) as f64;
        let certainty = factor * factor / of_sample;
        Some((step.map(|v| v / factor), [certainty * xx, certainty * xy, certainty * yy]))
    }
}

#[inline(always)]
fn dot(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// The first of four samples from which one at a distance is interpolated, their weights, and those of the slope: Keys's
/// cubic convolution (IEEE Transactions on Acoustics, Speech and Signal Processing 29, 1981).
pub(super) fn cubic(s: f64) -> (isize, [f32; 4], [f32; 4]) {
    let whole = s.floor();
    let t = s - whole;
    let weights = [
        t * (t * (2.0 - t) - 1.0) / 2.0,
        (t * t * (3.0 * t - 5.0) + 2.0) / 2.0,
        t * (t * (4.0 - 3.0 * t) + 1.0) / 2.0,
        t * t * (t - 1.0) / 2.0,
    ];
    let slopes = [
        (t * (4.0 - 3.0 * t) - 1.0) / 2.0,
        t * (9.0 * t - 10.0) / 2.0,
        (t * (8.0 - 9.0 * t) + 1.0) / 2.0,
        t * (3.0 * t - 2.0) / 2.0,
    ];
    (whole as isize - 1, weights.map(|v| v as f32), slopes.map(|v| v as f32))
}
