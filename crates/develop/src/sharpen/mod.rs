//! Sharpness that lens, low-pass filter and pixels took: the light is deconvolved by the blur that the picture's own edges
//! show.
//!
//! One linear filter undoes a Gaussian blur as far as noise lets it (Wiener, 1949). What it adds is held back where it
//! could be noise, by the noise model of the samples, and bounded by the light around, so that edges get steep without
//! rims. Colours keep their ratios. Every step is homogeneous: twice the light gives twice the picture.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Rgb, Size};

use crate::denoise::{Line, NoiseModel};
use crate::stage::{Stage, WhenSmaller};

pub(crate) mod blur;
mod kernel;
mod neighbours;
#[cfg(test)]
mod slow;
#[cfg(test)]
mod tests;

use kernel::{Kernel, RADIUS};
use neighbours::{largest, smallest, squares};

/// Pixels on each side whose details and light are compared with those of a pixel.
const AROUND: usize = 2;
/// Pixels around the result that are looked at.
pub const BORDER: usize = RADIUS + AROUND;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "sharpen", border: BORDER, when_smaller: WhenSmaller::Skipped };

/// Share of red, green and blue in the light that is sharpened: that of their samples.
const SHARES: [f32; 3] = [0.25, 0.5, 0.25];
/// Variance of interpolated light against that of samples, where neither has detail: interpolation averages.
const INTERPOLATED: f32 = 0.55;
/// Details count as far as they are stronger than so many times what noise makes of them.
const DOUBTFUL: f32 = 1.7;
/// An edge may pass the light around it by this share of its height, and on its dark side by no more than this share of
/// twice the darkest: a reflex that is many times as bright gets no black rim.
const BEYOND: f32 = 0.04;
/// A line or a dot may stand out by this much more than it does.
const STANDS_OUT: f32 = 0.5;
/// No pixel becomes brighter or darker by more than this factor.
const MOST: f32 = 3.0;
const LEAST: f32 = 1.0 / MOST;

/// What undoes the blur of one capture.
#[derive(Debug, Clone, PartialEq)]
pub struct Sharpener {
    /// Gives what a pixel lacks.
    kernel: Kernel,
    /// How much of that is added: 1 is all of it.
    amount: f32,
    /// Variance of what the kernel gives in a noisy picture without detail.
    noise: Line,
    /// Light that brighter light counts as: how bright clipped highlights are was guessed, and has no edges to sharpen.
    white: f32,
}

impl Sharpener {
    /// For a blur of so many pixels (standard deviation), in light balanced with these multipliers, in which what is brighter than
    /// `white` has no detail.
    pub fn of(blur: f32, amount: f32, noise: Option<NoiseModel>, multipliers: [f32; 3], white: f32) -> Self {
        let kernel = Kernel::of(f64::from(blur));
        let factor = DOUBTFUL * INTERPOLATED * kernel.power();
        let noise = noise.map_or(Line::default(), |model| {
            let sum = |f: &dyn Fn(usize) -> f32| factor * (0..3).map(|c| SHARES[c] * f(c)).sum::<f32>();
            Line {
                slope: sum(&|c| multipliers[c] * model.channels[c].slope),
                floor: sum(&|c| multipliers[c] * multipliers[c] * model.channels[c].floor),
            }
        });
        Self { kernel, amount, noise, white }
    }
}

/// What the stage works in.
#[derive(Debug, Default)]
pub struct Scratch {
    light: Plane,
    details: Plane,
    power: Plane,
    /// Smallest and largest light of 3 x 3.
    low: Plane,
    high: Plane,
    /// The same of those: smallest and largest of 5 x 5, light without lines and dots that are brighter, and darker.
    least: Plane,
    most: Plane,
    opened: Plane,
    closed: Plane,
}

/// Samples by rows.
#[derive(Debug, Default)]
struct Plane {
    width: usize,
    samples: Vec<f32>,
}

impl Plane {
    fn height(&self) -> usize {
        self.samples.len() / self.width.max(1)
    }

    fn row(&self, y: usize) -> &[f32] {
        &self.samples[y * self.width..][..self.width]
    }

    /// Takes a size; what it holds is to be written.
    fn resize(&mut self, width: usize, height: usize) {
        self.width = width;
        self.samples.resize(width * height, 0.0);
    }
}

/// Sharpens the inner part of a picture, which has [`BORDER`] more pixels on each side than `out` will have.
pub fn sharpen(
    wide: &Rgb<CameraSpace>,
    sharpener: &Sharpener,
    scratch: &mut Scratch,
    out: &mut Rgb<CameraSpace>,
) {
    let size = Size { width: wide.size().width - 2 * BORDER, height: wide.size().height - 2 * BORDER };
    out.resize(size);
    light(wide, sharpener.white, &mut scratch.light);
    sharpener.kernel.details(&scratch.light, &mut scratch.details);
    squares(&scratch.details, &mut scratch.power);
    smallest(&scratch.light, &mut scratch.low);
    largest(&scratch.light, &mut scratch.high);
    smallest(&scratch.low, &mut scratch.least);
    largest(&scratch.low, &mut scratch.opened);
    largest(&scratch.high, &mut scratch.most);
    smallest(&scratch.high, &mut scratch.closed);
    let mut factors = vec![0f32; size.width];
    for y in 0..size.height {
        scratch.factors(sharpener, y, &mut factors);
        for (out, wide_plane) in out.planes_mut().into_iter().zip(wide.planes()) {
            let wide_row = &wide_plane[(y + BORDER) * wide.size().width + BORDER..][..size.width];
            let row = &mut out[y * size.width..][..size.width];
            vectorised(
                #[inline(always)]
                || {
                    for ((out, v), factor) in row.iter_mut().zip(wide_row).zip(&factors) {
                        *out = v * factor;
                    }
                },
            );
        }
    }
}

/// The light of a picture, at most that of white.
fn light(picture: &Rgb<CameraSpace>, white: f32, light: &mut Plane) {
    light.resize(picture.size().width, picture.size().height);
    let [red, green, blue] = picture.planes();
    vectorised(
        #[inline(always)]
        || {
            for (((out, r), g), b) in light.samples.iter_mut().zip(red).zip(green).zip(blue) {
                let sum = SHARES[0] * r + SHARES[1] * g + SHARES[2] * b;
                *out = if sum < white { sum } else { white };
            }
        },
    );
}

impl Scratch {
    /// By what the pixels of a row of the result become brighter.
    fn factors(&self, sharpener: &Sharpener, y: usize, factors: &mut [f32]) {
        let n = factors.len();
        let light = &self.light.row(y + BORDER)[BORDER..][..n];
        let details = &self.details.row(y + AROUND)[AROUND..][..n];
        let power = &self.power.row(y)[..n];
        // Extremes of 5 x 5 stand for the middle, which lies two pixels further in.
        let [least, most, opened, closed] = [&self.least, &self.most, &self.opened, &self.closed]
            .map(|plane| &plane.row(y + BORDER - 2)[BORDER - 2..][..n]);
        let (amount, noise) = (sharpener.amount, sharpener.noise);
        let beyond = BEYOND * amount;
        vectorised(
            #[inline(always)]
            || {
                let [light, details, power] = [light, details, power].map(|row| &row[..n]);
                let [least, most, opened, closed] = [least, most, opened, closed].map(|row| &row[..n]);
                for (i, factor) in factors.iter_mut().enumerate().take(n) {
                    let v = light[i];
                    let doubt = noise.at(v);
                    let sure = if power[i] > doubt { (power[i] - doubt) / power[i] } else { 0.0 };
                    let height = most[i] - least[i];
                    let dark = if 2.0 * least[i] < height { 2.0 * least[i] } else { height };
                    let high = most[i] + beyond * height + STANDS_OUT * (v - opened[i]);
                    let low = least[i] - beyond * dark - STANDS_OUT * (closed[i] - v);
                    let new = v + amount * sure * details[i];
                    let new = if new < high { new } else { high };
                    let new = if new > low { new } else { low };
                    let new = if new < MOST * v { new } else { MOST * v };
                    let new = if new > LEAST * v { new } else { LEAST * v };
                    *factor = if v > 0.0 { new / v } else { 1.0 };
                }
            },
        );
    }
}
