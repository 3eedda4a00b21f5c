//! Binning under any repeating array: the best linear prediction of the mean light of a square, for each colour, from the
//! samples in it and around it, under the models of `kriging` without a direction (block kriging; A. G.
//! Journel and C. J. Huijbregts, "Mining Geostatistics", 1978, chapter V).

use darkroot_photo::{CameraSpace, Cfa, Mosaic, Rgb, Size};

use super::kriging::{NOISE, solve, usual_likeness};

/// Pixels around a square that have a say in its colours.
pub(super) const BORDER: usize = 3;

/// Side of the squares that colours are predicted for; larger pixels are means of these.
pub(super) const SIDE: usize = 4;

/// Column and row of a sample, from the top left corner of a square with its border, and its weight.
type Tap = (usize, usize, f32);

/// Weights for each place of the array at which a square, with its border, can begin.
#[derive(Debug, Clone)]
pub(crate) struct Weights {
    period: (usize, usize),
    kernels: Vec<[Vec<Tap>; 3]>,
}

impl Weights {
    pub(super) fn new(cfa: &Cfa) -> Self {
        let period = (cfa.width(), cfa.height());
        let places = (0..period.0 * period.1).map(|i| (i % period.0, i / period.0));
        Self { period, kernels: places.map(|at| kernel_of(cfa, at)).collect() }
    }
}

/// Weights for the mean light of the square that begins `BORDER` pixels right of and below `at`.
fn kernel_of(cfa: &Cfa, at: (usize, usize)) -> [Vec<Tap>; 3] {
    let width = SIDE + 2 * BORDER;
    let places: Vec<(usize, usize)> = (0..width * width).map(|i| (i % width, i / width)).collect();
    let colour = |(x, y): (usize, usize)| cfa.at(at.0 + x, at.1 + y).plane().unwrap_or(1);
    let apart =
        |a: (usize, usize), b: (usize, usize)| (a.0 as isize - b.0 as isize, a.1 as isize - b.1 as isize);
    let inner: Vec<(usize, usize)> =
        (0..SIDE * SIDE).map(|i| (BORDER + i % SIDE, BORDER + i / SIDE)).collect();
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

/// The colours of all squares in `size` pixels of `bin` samples each.
pub(super) fn reduce(
    mosaic: &Mosaic<f32>,
    border: usize,
    begin: (isize, isize),
    weights: &Weights,
    size: Size,
    bin: usize,
) -> Rgb<CameraSpace> {
    let squares = Size { width: size.width * bin / SIDE, height: size.height * bin / SIDE };
    let mut picture = Rgb::black(squares);
    let width = mosaic.size.width;
    let phase =
        |at: usize, begin: isize, period: usize| (at as isize + begin).rem_euclid(period as isize) as usize;
    let planes = picture.planes_mut();
    for y in 0..squares.height {
        for x in 0..squares.width {
            let (u, v) = (x * SIDE + border - BORDER, y * SIDE + border - BORDER);
            let (column, row) = (phase(u, begin.0, weights.period.0), phase(v, begin.1, weights.period.1));
            for (plane, taps) in [0, 1, 2].into_iter().zip(&weights.kernels[row * weights.period.0 + column])
            {
                planes[plane][y * squares.width + x] =
                    taps.iter().map(|(dx, dy, w)| w * mosaic.samples[(v + dy) * width + u + dx]).sum();
            }
        }
    }
    picture
}
