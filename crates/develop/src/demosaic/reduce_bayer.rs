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

use darkroot_photo::{CameraSpace, Cfa, Filter, Mosaic, Rgb, Size};
use darkroot_profile::simd::vectorised;

/// Pixels around a square that have a say in its colours: 4 to the farthest site, 2 around that.
pub(super) const BORDER: usize = 6;

/// Factor of the other colour's second difference, as in [`lmmse`](super::lmmse).
const SECOND_DIFFERENCE: f32 = 0.1875;
/// Smoothing of the differences, by sites away.
const SMOOTHING: [f32; 3] = [0.125, 0.75, 0.125];

/// Reduces the inner part of a Bayer mosaic.
pub(super) fn reduce(
    mosaic: &Mosaic<f32>,
    cfa: &Cfa,
    border: usize,
    bin: usize,
    size: Size,
) -> Rgb<CameraSpace> {
    let mut picture = Rgb::black(size);
    let [red, green, blue] = picture.planes_mut();
    totals(mosaic, border, bin, size, green);
    for (filter, plane) in [(Filter::Red, &mut *red), (Filter::Blue, &mut *blue)] {
        let site = (0..4).map(|i| (i % 2, i / 2)).find(|(x, y)| cfa.at(*x, *y) == filter);
        let sums = SiteSums::of(mosaic, site.unwrap_or((0, 0)), border, bin, size);
        sums.add(size, green, plane);
    }
    let share = 1.0 / (bin * bin) as f32;
    for ((r, g), b) in red.iter_mut().zip(green.iter_mut()).zip(blue.iter_mut()) {
        *g *= share;
        *r = *g - *r * share;
        *b = *g - *b * share;
    }
    picture
}

/// Sum of all samples of each square.
fn totals(mosaic: &Mosaic<f32>, border: usize, bin: usize, size: Size, out: &mut [f32]) {
    let width = size.width * bin;
    let mut columns = vec![0f32; width];
    for (v, out) in out.chunks_exact_mut(size.width.max(1)).enumerate() {
        columns.fill(0.0);
        for y in border + v * bin..border + (v + 1) * bin {
            let row = &mosaic.samples[y * mosaic.size.width + border..][..width];
            for (sum, sample) in columns.iter_mut().zip(row) {
                *sum += sample;
            }
        }
        for (out, columns) in out.iter_mut().zip(columns.chunks_exact(bin)) {
            *out = columns.iter().sum::<f32>();
        }
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

/// Differences from green at the sites of one colour, summed along rows.
struct SiteSums {
    /// For each row of sites and each column of the smaller picture: over the sites, and over every pixel.
    rows: Vec<(f32, f32)>,
    weights: AxisWeights,
    /// Rows of sites from one row of the smaller picture to the next.
    step: usize,
}

impl SiteSums {
    fn of(mosaic: &Mosaic<f32>, site: (usize, usize), border: usize, bin: usize, size: Size) -> Self {
        let parity = |site: usize| (site + border) % 2;
        let (across, down) = (AxisWeights::of(bin, parity(site.0)), AxisWeights::of(bin, parity(site.1)));
        let first = |site: usize| border + parity(site) - 4;
        let count = |pixels: usize| pixels * bin / 2 + 4;
        let columns = count(size.width);
        let mut differences = vec![0f32; columns];
        let mut rows = Vec::with_capacity(count(size.height) * size.width);
        for i in 0..count(size.height) {
            difference_row(mosaic, (first(site.0), first(site.1) + 2 * i), &mut differences);
            for x in 0..size.width {
                let sites = &differences[x * bin / 2..][..across.sites.len()];
                let sum = |weights: &[f32]| sites.iter().zip(weights).map(|(d, w)| d * w).sum::<f32>();
                rows.push((sum(&across.sites), sum(&across.pixels)));
            }
        }
        Self { rows, weights: down, step: bin / 2 }
    }

    /// Adds the sums over sites to green's totals, and those over every pixel to the colour's.
    fn add(&self, size: Size, green: &mut [f32], colour: &mut [f32]) {
        let width = size.width.max(1);
        let lines = green.chunks_exact_mut(width).zip(colour.chunks_exact_mut(width)).enumerate();
        for (v, (green, colour)) in lines {
            let weights = self.weights.sites.iter().zip(&self.weights.pixels);
            for (i, (of_sites, of_pixels)) in weights.enumerate() {
                let sums = &self.rows[(v * self.step + i) * width..][..width];
                for ((green, colour), (sites, pixels)) in green.iter_mut().zip(colour.iter_mut()).zip(sums) {
                    *green += of_sites * sites;
                    *colour += of_pixels * pixels;
                }
            }
        }
    }
}

/// Differences from green at every second pixel of a row, the first at column `x` of row `y`.
fn difference_row(mosaic: &Mosaic<f32>, (x, y): (usize, usize), out: &mut [f32]) {
    let width = mosaic.size.width;
    let length = 2 * out.len() + 3;
    let row = |y: usize| &mosaic.samples[y * width + x - 2..][..length];
    let (above2, above, here, below, below2) = (row(y - 2), row(y - 1), row(y), row(y + 1), row(y + 2));
    vectorised(
        #[inline(always)]
        || {
            for (i, out) in out.iter_mut().enumerate() {
                let c = 2 * i + 2;
                let own = here[c];
                let greens = here[c - 1] + here[c + 1] + above[c] + below[c];
                let bend = 4.0 * own - here[c - 2] - here[c + 2] - above2[c] - below2[c];
                *out = 0.25 * greens + 0.5 * SECOND_DIFFERENCE * bend - own;
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Layout;

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
                let picture = reduce(&mosaic, &cfa, BORDER, bin, small);
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
        let picture = reduce(&mosaic, &cfa, BORDER, 4, Size { width: 4, height: 1 });
        for x in 0..4 {
            let middle = (BORDER + 4 * x) as f32 + 1.5;
            assert!(picture.at(x, 0).iter().all(|v| (v - middle).abs() < 1e-4), "{:?}", picture.at(x, 0));
        }
    }
}
