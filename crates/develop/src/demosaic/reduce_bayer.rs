//! Binning for Bayer arrays, by the differences of red and blue from green.
//!
//! At the site of a red sample green is interpolated from those around it, with red's own curvature (J. F. Hamilton and
//! J. E. Adams, US patent 5629734, 1997; both directions alike). The difference green - red is smooth, so it is smoothed
//! a little and interpolated to all pixels; blue likewise. A pixel of the smaller picture is a sum over a square:
//!
//! ```text
//! green = (all samples + differences at red and blue sites) / pixels
//! red   = green - (green - red interpolated to every pixel) / pixels
//! ```
//!
//! and as all of it is linear, interpolation and sums are weights of the sites' differences.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Cfa, Filter, Mosaic, Rgb};

/// Pixels around a square that have a say in its colours: 4 to the farthest site, 2 around that.
pub(super) const BORDER: usize = 6;

/// Factor of the other colour's second difference, as in [`lmmse`](super::lmmse).
const SECOND_DIFFERENCE: f32 = 0.1875;
/// Smoothing of the differences, by sites away.
const SMOOTHING: [f32; 3] = [0.125, 0.75, 0.125];

/// Columns that are summed at a time.
const LANES: usize = 16;

/// Reduces the inner part of a Bayer mosaic to a picture of that size.
pub(super) fn reduce(
    mosaic: &Mosaic<f32>,
    cfa: &Cfa,
    border: usize,
    bin: usize,
    picture: &mut Rgb<CameraSpace>,
) {
    vectorised(
        #[inline(always)]
        || run(mosaic, cfa, border, bin, picture),
    );
}

#[inline(always)]
fn run(mosaic: &Mosaic<f32>, cfa: &Cfa, border: usize, bin: usize, picture: &mut Rgb<CameraSpace>) {
    let size = picture.size();
    let colours = [Filter::Red, Filter::Blue].map(|filter| Colour::of(cfa, filter, border, bin));
    // Rows of differences, as many as one row of the picture needs.
    let width = mosaic.size.width;
    let mut differences: Vec<Vec<f32>> = vec![vec![0.0; width.next_multiple_of(LANES)]; bin + 2 * BORDER];
    let count = differences.len();
    let (mut of_sites, mut of_pixels) = (differences[0].clone(), differences[0].clone());
    let mut columns = vec![0f32; size.width * bin];
    let mut next = border - 4;
    let share = 1.0 / (bin * bin) as f32;
    let [red, green, blue] = picture.planes_mut();
    for v in 0..size.height {
        let top = border + v * bin;
        while next < top + bin + 4 {
            difference_row(mosaic, next, &mut differences[next % count]);
            next += 1;
        }
        let row = v * size.width..(v + 1) * size.width;
        let green = &mut green[row.clone()];
        totals(mosaic, (border, top), bin, &mut columns, green);
        for (colour, plane) in colours.iter().zip([&mut *red, &mut *blue]) {
            let rows = colour.down.sites.iter().zip(&colour.down.pixels).enumerate();
            let rows = rows.map(|(i, (site, pixel))| {
                (&differences[(top + colour.first.1 + 2 * i - 4) % count][..], *site, *pixel)
            });
            sum_down(rows, &mut of_sites, &mut of_pixels);
            let plane = &mut plane[row.clone()];
            for (u, (green, out)) in green.iter_mut().zip(plane.iter_mut()).enumerate() {
                let first = border + u * bin + colour.first.0 - 4;
                *green += every_second(&colour.across.sites, &of_sites[first..]);
                *out = every_second(&colour.across.pixels, &of_pixels[first..]);
            }
        }
        for ((r, g), b) in red[row.clone()].iter_mut().zip(green).zip(&mut blue[row]) {
            *g *= share;
            *r = *g - *r * share;
            *b = *g - *b * share;
        }
    }
}

/// Sums of all samples of the squares that begin at a column and row.
#[inline(always)]
fn totals(mosaic: &Mosaic<f32>, (x, y): (usize, usize), bin: usize, columns: &mut [f32], out: &mut [f32]) {
    columns.fill(0.0);
    for y in y..y + bin {
        let row = &mosaic.samples[y * mosaic.size.width + x..][..columns.len()];
        for (sum, sample) in columns.iter_mut().zip(row) {
            *sum += sample;
        }
    }
    for (out, columns) in out.iter_mut().zip(columns.chunks_exact(bin)) {
        *out = columns.iter().sum::<f32>();
    }
}

/// Weighted sums of rows: with the weights of sites, and with those of pixels.
#[inline(always)]
fn sum_down<'a>(
    rows: impl Iterator<Item = (&'a [f32], f32, f32)> + Clone,
    of_sites: &mut [f32],
    of_pixels: &mut [f32],
) {
    let blocks = of_sites.chunks_exact_mut(LANES).zip(of_pixels.chunks_exact_mut(LANES));
    for (i, (of_sites, of_pixels)) in blocks.enumerate() {
        let (mut sites, mut pixels) = ([0f32; LANES], [0f32; LANES]);
        for (row, site, pixel) in rows.clone() {
            let row = &row[i * LANES..][..LANES];
            for lane in 0..LANES {
                sites[lane] += site * row[lane];
                pixels[lane] += pixel * row[lane];
            }
        }
        of_sites.copy_from_slice(&sites);
        of_pixels.copy_from_slice(&pixels);
    }
}

/// Weighted sum of every second value.
#[inline(always)]
fn every_second(weights: &[f32], values: &[f32]) -> f32 {
    // Squares of four pixels: a length that the compiler knows.
    if let (Ok(weights), Some(values)) = (<&[f32; 6]>::try_from(weights), values.first_chunk::<11>()) {
        let term = |k: usize| weights[k] * values[2 * k];
        return ((term(0) + term(1)) + (term(2) + term(3))) + (term(4) + term(5));
    }
    weights.iter().zip(values.iter().step_by(2)).map(|(w, v)| w * v).sum()
}

/// Where the sites of one colour are, and what they weigh.
struct Colour {
    /// Column and row of the first one in a square: 0 or 1.
    first: (usize, usize),
    across: AxisWeights,
    down: AxisWeights,
}

impl Colour {
    fn of(cfa: &Cfa, filter: Filter, border: usize, bin: usize) -> Self {
        let first = cfa.shifted(border, border).first(filter).unwrap_or((0, 0));
        Self { first, across: AxisWeights::of(bin, first.0), down: AxisWeights::of(bin, first.1) }
    }
}

/// Weights of sites along one axis in the sums over a square, from two sites before its first one on.
struct AxisWeights {
    /// Of the sites themselves.
    sites: Vec<f32>,
    /// Of the sites interpolated to every pixel.
    pixels: Vec<f32>,
}

impl AxisWeights {
    /// For squares of `bin` pixels whose first site is their first (`parity` 0) or second (1) pixel.
    fn of(bin: usize, parity: usize) -> Self {
        let count = bin / 2 + 4;
        let (mut sites, mut pixels) = (vec![0f32; count], vec![0f32; count]);
        for i in 0..count {
            // Place of the site in the square.
            let place = 2 * i as isize + parity as isize - 4;
            let inside = |at: isize| if (0..bin as isize).contains(&at) { 1.0 } else { 0.0 };
            sites[i] = inside(place);
            pixels[i] = 0.5 * inside(place - 1) + inside(place) + 0.5 * inside(place + 1);
        }
        let smooth = |w: &[f32]| {
            let at = |i: isize| usize::try_from(i).ok().and_then(|i| w.get(i)).copied().unwrap_or(0.0);
            (0..count as isize).map(|i| (0..3).map(|k| SMOOTHING[k] * at(i + k as isize - 1)).sum()).collect()
        };
        Self { sites: smooth(&sites), pixels: smooth(&pixels) }
    }
}

/// Differences from green in row `y`, as if there were no green samples in it: they mean something at the sites of the
/// other colour only.
#[inline(always)]
fn difference_row(mosaic: &Mosaic<f32>, y: usize, out: &mut [f32]) {
    let width = mosaic.size.width;
    let row = |y: usize| &mosaic.samples[y * width..(y + 1) * width];
    let (above2, above, here, below, below2) = (row(y - 2), row(y - 1), row(y), row(y + 1), row(y + 2));
    let inner = 2..width - 2;
    let n = inner.len();
    let (out, above2, above) = (&mut out[inner.clone()], &above2[inner.clone()], &above[inner.clone()]);
    let (below, below2) = (&below[inner.clone()], &below2[inner]);
    let shifts: [&[f32]; 5] = std::array::from_fn(|k| &here[k..k + n]);
    for i in 0..n {
        let own = shifts[2][i];
        let greens = shifts[1][i] + shifts[3][i] + above[i] + below[i];
        let bend = 4.0 * own - shifts[0][i] - shifts[4][i] - above2[i] - below2[i];
        out[i] = 0.25 * greens + 0.5 * SECOND_DIFFERENCE * bend - own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::{Layout, Size};

    #[test]
    fn a_surface_of_one_colour_keeps_it_whatever_the_phase() {
        let colour = [0.2, 0.5, 0.9];
        for letters in ["RGGB", "GRBG", "GBRG", "BGGR"] {
            let cfa = Cfa::parse(letters).unwrap();
            let size = Size { width: 2 * BORDER + 16, height: 2 * BORDER + 8 };
            let sample = |i: usize| colour[cfa.at(i % size.width, i / size.width).plane().unwrap()];
            let samples = (0..size.area()).map(sample).collect();
            let mosaic = Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples };
            for bin in [4, 8] {
                let small = Size { width: 16 / bin, height: 8 / bin };
                let mut picture = Rgb::black(small);
                reduce(&mosaic, &cfa, BORDER, bin, &mut picture);
                for (plane, wanted) in picture.planes().iter().zip(colour) {
                    assert!(plane.iter().all(|v| (v - wanted).abs() < 1e-5), "{letters} {bin} {plane:?}");
                }
            }
        }
    }

    #[test]
    fn a_grey_ramp_stays_grey_and_in_its_place() {
        let cfa = Cfa::parse("RGGB").unwrap();
        let size = Size { width: 2 * BORDER + 16, height: 2 * BORDER + 4 };
        let samples = (0..size.area()).map(|i| (i % size.width) as f32).collect();
        let mosaic = Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples };
        let mut picture = Rgb::black(Size { width: 4, height: 1 });
        reduce(&mosaic, &cfa, BORDER, 4, &mut picture);
        for x in 0..4 {
            let middle = (BORDER + 4 * x) as f32 + 1.5;
            assert!(picture.at(x, 0).iter().all(|v| (v - middle).abs() < 1e-4), "{:?}", picture.at(x, 0));
        }
    }
}
