//! How blurred a capture is where it is sharpest: measured in the greens along its diagonals.
//!
//! Along a diagonal of greens lies a sample in every column and row, in Bayer arrays and others. Where an upright or level
//! edge crosses it, the largest step between two samples is a share of the edge's height that tells the blur: light that
//! a point spreads by a Gaussian, seen by pixels of side 1, steps by the part of the Gaussian within a triangle of base 2.
//! Most edges in a picture are out of focus or soft of themselves, so the steepest tenth counts.

use darkroot_photo::{Capture, Cfa, Layout};
use rayon::prelude::*;

use crate::denoise::NoiseModel;
use crate::light::{LinearLight, period};

/// Samples of an edge: before its steepest step, and from it on.
const BEFORE: usize = 3;
const AFTER: usize = 4;
/// Height of an edge, against the mean of its ends, and against its noise.
const CONTRAST: f32 = 0.3;
const CERTAIN: f32 = 30.0;
/// The outermost steps of an edge are at most this share of its height; no step goes back by more than half of it.
const EVEN: f32 = 0.06;
/// An edge is upright or level where both diagonals show steps that differ by no more than this share.
const ALIKE: f32 = 0.15;
/// Edges above this share of saturation are not looked at.
const BRIGHTEST: f32 = 0.9;
/// Fewer edges tell nothing.
const FEWEST: usize = 50;
/// The steepest edges count.
const SHARPEST: f64 = 0.9;
/// Rows that are looked at together, and how many of them at most in all samples.
const ROWS: usize = 32;
const MOST_SAMPLES: usize = 4_000_000;
/// Blurs that can be told, pixels.
const BLURS: (f64, f64) = (0.2, 3.0);

/// The blur in pixels, as the standard deviation of a Gaussian; `None` where too few edges tell. `saturation` is that of
/// green.
pub(crate) fn measured(
    capture: &Capture,
    linear: &LinearLight,
    saturation: f32,
    noise: Option<&NoiseModel>,
) -> Option<f32> {
    let area = capture.active_area;
    let height = ROWS + BEFORE + AFTER;
    if area.width < 2 * (BEFORE + AFTER) || area.height < height {
        return None;
    }
    let bands = (area.height - BEFORE - AFTER) / ROWS;
    let step = (bands * ROWS * area.width).div_ceil(MOST_SAMPLES).max(1);
    let tops: Vec<usize> = (0..bands).step_by(step).map(|band| area.y + band * ROWS).collect();
    let layout = capture.counts.layout();
    let finder = Finder { layout, limit: BRIGHTEST * saturation, noise };
    let of_band = |&top: &usize| {
        let mut greens = vec![0f32; area.width * height];
        let mut row = vec![0f32; area.width * layout.planes()];
        for (i, greens) in greens.chunks_exact_mut(area.width).enumerate() {
            linear.row(&capture.counts, area.x, top + i, &mut row);
            let green = row.iter().skip(layout.planes() / 2).step_by(layout.planes());
            greens.iter_mut().zip(green).for_each(|(out, v)| *out = *v);
        }
        finder.steps((area.x, top), area.width, &greens)
    };
    let mut steps: Vec<f32> = tops.par_iter().flat_map_iter(of_band).collect();
    if steps.len() < FEWEST {
        return None;
    }
    let rank = (SHARPEST * steps.len() as f64) as usize;
    let (_, step, _) = steps.select_nth_unstable_by(rank, f32::total_cmp);
    Some(blur_of(f64::from(*step)) as f32)
}

/// What edges are looked for.
struct Finder<'a> {
    layout: &'a Layout,
    limit: f32,
    noise: Option<&'a NoiseModel>,
}

impl Finder<'_> {
    /// Steps of the edges in rows of samples that begin in this column and row of the frame, as shares of their heights.
    fn steps(&self, (x0, y0): (usize, usize), width: usize, samples: &[f32]) -> Vec<f32> {
        let (columns, rows) = period(self.layout);
        let is_centre: Vec<bool> = (0..columns * rows)
            .map(|i| self.crosses_greens(x0 + i % columns, y0 + BEFORE.max(AFTER) + i / columns))
            .collect();
        let reach = BEFORE.max(AFTER);
        let mut steps = Vec::new();
        for y in reach..samples.len() / width - reach {
            let of_row = &is_centre[(y - reach) % rows * columns..][..columns];
            for x in (reach..width - reach).filter(|x| of_row[x % columns]) {
                let centre = y * width + x;
                let down = self.step(samples, centre, width as isize + 1);
                let Some(down) = down else { continue };
                let Some(up) = self.step(samples, centre, 1 - width as isize) else { continue };
                if (down - up).abs() < ALIKE * down.max(up) {
                    steps.push((0.5 * (down * down + up * up)).sqrt());
                }
            }
        }
        steps
    }

    /// Whether all samples on both diagonals through a place are green, as far as edges are looked at.
    fn crosses_greens(&self, x: usize, y: usize) -> bool {
        let Layout::Cfa(cfa) = self.layout else { return true };
        let is_green = |x: isize, y: isize| {
            let (x, y) = (x.rem_euclid(cfa.width() as isize), y.rem_euclid(cfa.height() as isize));
            Cfa::at(cfa, x as usize, y as usize).plane() == Some(1)
        };
        let (x, y) = (x as isize, y as isize);
        (-(BEFORE as isize)..=AFTER as isize).all(|i| is_green(x + i, y + i) && is_green(x + i, y - i))
    }

    /// The step behind a sample, along a diagonal, as a share of the height of the edge that it belongs to; `None` where
    /// there is no edge or this is not its largest step.
    fn step(&self, samples: &[f32], centre: usize, along: isize) -> Option<f32> {
        let at = |i: isize| samples[(centre as isize + i * along) as usize];
        let (here, next) = (at(0), at(1));
        let step = (next - here).abs();
        // Most places end here.
        if step.is_nan() || step <= 0.1 * CONTRAST * (here + next) {
            return None;
        }
        let (first, last) = (at(-(BEFORE as isize)), at(AFTER as isize));
        let height = (last - first).abs();
        let brightest = first.max(last);
        let certain = self.noise.map_or(0.0, |noise| CERTAIN * noise.channels[1].at(brightest).sqrt());
        if height < (0.5 * CONTRAST * (first + last)).max(certain) || brightest > self.limit {
            return None;
        }
        let sign = (last - first).signum();
        let rises = |i: isize| sign * (at(i + 1) - at(i));
        let is_even = rises(-(BEFORE as isize)) < EVEN * height && rises(AFTER as isize - 1) < EVEN * height;
        let is_largest = step >= rises(-1) && step >= rises(1);
        let mut within = -(BEFORE as isize)..AFTER as isize;
        (is_even && is_largest && within.all(|i| rises(i) > -0.5 * EVEN * height)).then(|| step / height)
    }
}

/// The blur at which edges step by this share at most.
fn blur_of(step: f64) -> f64 {
    let (mut sharp, mut soft) = BLURS;
    for _ in 0..30 {
        let middle = 0.5 * (sharp + soft);
        if largest_step(middle) > step { sharp = middle } else { soft = middle }
    }
    0.5 * (sharp + soft)
}

/// The largest step between two pixels, as a share of the height, of an edge that is blurred by a Gaussian.
fn largest_step(sigma: f64) -> f64 {
    const PARTS: usize = 400;
    let width = 1.0 / PARTS as f64;
    let middles = (0..PARTS).map(|i| (i as f64 + 0.5) * width);
    let within = |u: f64| (1.0 - u) * (-0.5 * (u / sigma).powi(2)).exp();
    2.0 * width * middles.map(within).sum::<f64>() / (sigma * std::f64::consts::TAU.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the antiderivative, by tables of the normal distribution.
    #[test]
    fn steps_of_known_blurs() {
        for (sigma, step) in [(0.3, 0.7606), (0.5, 0.6096), (0.8, 0.4426)] {
            assert!((largest_step(sigma) - step).abs() < 2e-3, "{sigma}: {}", largest_step(sigma));
            assert!((blur_of(step) - sigma).abs() < 5e-3);
        }
    }
}
