//! The filter that undoes a Gaussian blur.

use std::array::from_fn;

use darkroot_colour::simd::vectorised;

use super::Plane;

/// Columns and rows that the filter reaches.
pub(super) const RADIUS: usize = 4;
/// Power of the noise that the filter reckons with, against that of the light at every frequency.
const NOISE: f64 = 0.015;
/// Frequencies, cycles a pixel, from which on less is given back and at which nothing is: what a mosaic shows there
/// is as often of its own making.
const FADING: (f64, f64) = (0.35, 0.5);
/// Frequencies along a side at which the filter is designed.
const FREQUENCIES: usize = 64;

/// What a Gaussian blur took of a pixel, as weights of the light around: by rows away, then by columns away.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Kernel([[f32; RADIUS + 1]; RADIUS + 1]);

impl Kernel {
    /// For a blur of this standard deviation, in pixels: the Wiener filter H / (H^2 + n), H the Fourier transform of the
    /// Gaussian, less the light itself, faded out towards the finest details, under a Hann window.
    pub(super) fn of(sigma: f64) -> Self {
        let turn = std::f64::consts::TAU;
        let frequency = |i: usize| {
            let i = if i < FREQUENCIES / 2 { i as f64 } else { i as f64 - FREQUENCIES as f64 };
            i / FREQUENCIES as f64
        };
        let gain: Vec<f64> = (0..FREQUENCIES * FREQUENCIES)
            .map(|i| {
                let (u, v) = (frequency(i % FREQUENCIES), frequency(i / FREQUENCIES));
                let blurred = (-0.5 * (turn * sigma).powi(2) * (u * u + v * v)).exp();
                let lacking = blurred * (1.0 + NOISE) / (blurred * blurred + NOISE) - 1.0;
                lacking * kept(u) * kept(v)
            })
            .collect();
        let wave: Vec<[f64; RADIUS + 1]> =
            (0..FREQUENCIES).map(|i| from_fn(|x| (turn * frequency(i) * x as f64).cos())).collect();
        let window = |at: usize| (0.5 + 0.5 * (0.5 * turn * at as f64 / (RADIUS + 1) as f64).cos()).sqrt();
        let weights: [[f64; RADIUS + 1]; RADIUS + 1] = from_fn(|y| {
            from_fn(|x| {
                let of = |i: usize| gain[i] * wave[i % FREQUENCIES][x] * wave[i / FREQUENCIES][y];
                window(x) * window(y) * (0..gain.len()).map(of).sum::<f64>()
            })
        });
        // Even light lacks nothing: the middle takes what the window leaves of the sum.
        let times = |at: usize| if at == 0 { 1.0 } else { 2.0 };
        let places = (0..=RADIUS).flat_map(|y| (0..=RADIUS).map(move |x| (x, y)));
        let sum: f64 = places.map(|(x, y)| times(x) * times(y) * weights[y][x]).sum();
        let share = 1.0 / (FREQUENCIES * FREQUENCIES) as f64;
        let left = |x: usize, y: usize| if x + y == 0 { sum } else { 0.0 };
        Self(from_fn(|y| from_fn(|x| (share * (weights[y][x] - left(x, y))) as f32)))
    }

    /// The weight of what lies so many columns and rows away.
    pub(super) fn at(&self, x: isize, y: isize) -> f32 {
        self.0[y.unsigned_abs()][x.unsigned_abs()]
    }

    /// Sum of the squares of all weights: what becomes of the variance of samples that do not depend on each other.
    pub(super) fn power(&self) -> f32 {
        let reach = RADIUS as isize;
        (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| self.at(x, y).powi(2))).sum()
    }

    /// What the pixels of a plane lack, but for [`RADIUS`] of them on each side.
    pub(super) fn details(&self, light: &Plane, details: &mut Plane) {
        let (width, height) = (light.width - 2 * RADIUS, light.height() - 2 * RADIUS);
        details.resize(width, height);
        let mut pairs = vec![0f32; light.width];
        for (y, out) in details.samples.chunks_exact_mut(width).enumerate() {
            out.fill(0.0);
            for (away, weights) in self.0.iter().enumerate() {
                let (above, below) = (light.row(y + RADIUS - away), light.row(y + RADIUS + away));
                // The middle row is its own pair.
                let share = if away == 0 { 0.5 } else { 1.0 };
                vectorised(
                    #[inline(always)]
                    || {
                        for ((pair, above), below) in pairs.iter_mut().zip(above).zip(below) {
                            *pair = share * (above + below);
                        }
                        add(weights, &pairs, out);
                    },
                );
            }
        }
    }
}

/// Share of what is lacking at a frequency that is given back.
fn kept(frequency: f64) -> f64 {
    let along = (frequency.abs() - FADING.0) / (FADING.1 - FADING.0);
    0.5 + 0.5 * (std::f64::consts::PI * along.clamp(0.0, 1.0)).cos()
}

/// Adds to each pixel what one pair of rows gives it.
#[inline(always)]
fn add(weights: &[f32; RADIUS + 1], pairs: &[f32], out: &mut [f32]) {
    let [w0, w1, w2, w3, w4] = *weights;
    for (out, at) in out.iter_mut().zip(pairs.windows(2 * RADIUS + 1)) {
        let near = w0 * at[4] + w1 * (at[3] + at[5]) + w2 * (at[2] + at[6]);
        *out += near + w3 * (at[1] + at[7]) + w4 * (at[0] + at[8]);
    }
}
