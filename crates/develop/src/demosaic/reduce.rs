//! From the mosaic to a smaller picture: binning instead of interpolation.
//!
//! A pixel of the smaller picture is the mean light of a square of the sensor, for each colour as well as it can be told
//! from the samples in the square and around it: the best linear prediction of that mean under the models of
//! [`kriging`](super::kriging) without a direction (block kriging; A. G. Journel and C. J. Huijbregts, "Mining
//! Geostatistics", 1978, chapter V).

use darkroot_photo::{CameraSpace, Cfa, Layout, Mosaic, Rgb, Size};

use super::kriging::{NOISE, solve, usual_likeness};
use crate::stage::{Stage, WhenSmaller};

/// Pixels around a square that have a say in its colours.
pub const BORDER: usize = 3;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "binning", border: BORDER, when_smaller: WhenSmaller::Same };

/// Sides of the squares that colours are predicted for; larger pixels are means of these.
const MOST: usize = 4;

/// Column, row and weight of a sample, from the top left corner of a square with its border.
type Tap = (usize, usize, f32);

/// Weights for squares of one side over one filter array: for each place of the array at which a square can begin.
#[derive(Debug, Clone)]
pub struct Reduction {
    side: usize,
    period: (usize, usize),
    /// By column and row of the array at which the square with its border begins.
    kernels: Vec<[Vec<Tap>; 3]>,
}

impl Reduction {
    /// Prepares the weights for pixels of `bin` x `bin` samples, wherever they begin.
    pub fn new(cfa: &Cfa, bin: usize) -> Self {
        let side = bin.min(MOST);
        let period = (cfa.width(), cfa.height());
        let places = (0..period.0 * period.1).map(|i| (i % period.0, i / period.0));
        Self { side, period, kernels: places.map(|at| kernel_of(cfa, side, at)).collect() }
    }
}

/// Weights for the mean light of the square of `side` pixels that begins `BORDER` pixels right of and below `at`.
fn kernel_of(cfa: &Cfa, side: usize, at: (usize, usize)) -> [Vec<Tap>; 3] {
    let width = side + 2 * BORDER;
    let places: Vec<(usize, usize)> = (0..width * width).map(|i| (i % width, i / width)).collect();
    let colour = |(x, y): (usize, usize)| cfa.at(at.0 + x, at.1 + y).plane().unwrap_or(1);
    let apart =
        |a: (usize, usize), b: (usize, usize)| (a.0 as isize - b.0 as isize, a.1 as isize - b.1 as isize);
    let inner: Vec<(usize, usize)> =
        (0..side * side).map(|i| (BORDER + i % side, BORDER + i / side)).collect();
    let is = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(places.len() + 3);
    for (i, &place) in places.iter().enumerate() {
        let c = colour(place);
        let mut row: Vec<f64> =
            places.iter().map(|&other| usual_likeness(apart(place, other), colour(other) == c)).collect();
        row[i] += NOISE;
        row.extend([0, 1, 2].map(|mean| is(c, mean)));
        row.extend([0, 1, 2].map(|wanted| {
            let all = inner.iter().map(|&p| usual_likeness(apart(place, p), c == wanted));
            all.sum::<f64>() / inner.len() as f64
        }));
        rows.push(row);
    }
    for mean in 0..3 {
        let mut row: Vec<f64> = places.iter().map(|&place| is(colour(place), mean)).collect();
        row.extend([0.0; 3]);
        row.extend([0, 1, 2].map(|wanted| is(wanted, mean)));
        rows.push(row);
    }
    solve(&mut rows);
    let n = places.len();
    [0, 1, 2].map(|c| {
        let weights = rows.iter().take(n).map(|row| row[n + 3 + c] as f32);
        places.iter().zip(weights).map(|(&(x, y), weight)| (x, y, weight)).collect()
    })
}

/// Reduces the inner part of a balanced mosaic: `border` pixels, at least [`BORDER`], are cut off on each side, and what
/// is left becomes one pixel for each square of `bin` pixels. `begin` is the place in the frame at which the mosaic begins.
pub fn reduce(
    mosaic: &Mosaic<f32>,
    border: usize,
    bin: usize,
    begin: (isize, isize),
    reduction: Option<&Reduction>,
) -> Rgb<CameraSpace> {
    let inner = |v: usize| (v - 2 * border) / bin;
    let size = Size { width: inner(mosaic.size.width), height: inner(mosaic.size.height) };
    match (&mosaic.layout, reduction) {
        (Layout::Cfa(_), Some(reduction)) => {
            let side = reduction.side;
            let squares = Size { width: size.width * bin / side, height: size.height * bin / side };
            let picture = predict(mosaic, border, begin, reduction, squares);
            mean(picture.planes(), squares.width, bin / side, size)
        }
        (layout, _) => {
            let planes = layout.planes();
            let plane = |c: usize| mosaic.samples.iter().skip(c.min(planes - 1)).step_by(planes).copied();
            let planes: [Vec<f32>; 3] = [0, 1, 2].map(|c| {
                let all: Vec<f32> = plane(c).collect();
                let rows = all.chunks_exact(mosaic.size.width).skip(border).take(size.height * bin);
                rows.flat_map(|row| row[border..border + size.width * bin].iter().copied()).collect()
            });
            mean(planes.each_ref().map(Vec::as_slice), size.width * bin, bin, size)
        }
    }
}

fn predict(
    mosaic: &Mosaic<f32>,
    border: usize,
    begin: (isize, isize),
    reduction: &Reduction,
    size: Size,
) -> Rgb<CameraSpace> {
    let mut picture = Rgb::black(size);
    let (width, side) = (mosaic.size.width, reduction.side);
    let planes = picture.planes_mut();
    for y in 0..size.height {
        for x in 0..size.width {
            let (u, v) = (x * side + border - BORDER, y * side + border - BORDER);
            let phase = |at: usize, begin: isize, period: usize| {
                (at as isize + begin).rem_euclid(period as isize) as usize
            };
            let (cx, cy) = (phase(u, begin.0, reduction.period.0), phase(v, begin.1, reduction.period.1));
            let kernel = &reduction.kernels[cy * reduction.period.0 + cx];
            for c in 0..3 {
                planes[c][y * size.width + x] =
                    kernel[c].iter().map(|(dx, dy, w)| w * mosaic.samples[(v + dy) * width + u + dx]).sum();
            }
        }
    }
    picture
}

/// Means over squares of `side` pixels of planes whose rows are `width` long.
fn mean(planes: [&[f32]; 3], width: usize, side: usize, size: Size) -> Rgb<CameraSpace> {
    let mut picture = Rgb::black(size);
    let share = 1.0 / (side * side) as f32;
    for (out, plane) in picture.planes_mut().into_iter().zip(planes) {
        for (y, out) in out.chunks_exact_mut(size.width.max(1)).enumerate() {
            for row in plane[y * side * width..(y + 1) * side * width].chunks_exact(width) {
                for (out, pixels) in out.iter_mut().zip(row.chunks_exact(side)) {
                    *out += pixels.iter().sum::<f32>() * share;
                }
            }
        }
    }
    picture
}
