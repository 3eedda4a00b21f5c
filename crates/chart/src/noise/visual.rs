//! Visual noise: what an eye sees of the noise of a patch, after ISO 15739:2013, annex B (that of 2017 is the same).
//!
//! XYZ adapted to illuminant E by Bradford's transform; opponent signals A = Y, C1 = X - Y, C2 = 0.4 (Y - Z); each filtered by
//! the contrast sensitivity of the eye; back to XYZ under D65, what is negative set to 0; CIELUV; standard deviations of L\*,
//! u\* and v\*, summed with the weights 1, 0.852 and 0.323.
//!
//! The standard was not at hand. Its steps are as Imatest ("ISO 15739") and Image Engineering ("Visual noise: the difference in
//! implementation") describe them. The sensitivities are those of Johnson and Fairchild, "A Top Down Description of S-CIELAB
//! and CIEDE2000" (2003), that for A on the scale of Baxter et al., "Development of the I3A CPIQ spatial metrics" (2012, 3 at
//! its largest), those of colours 1 at frequency 0. The opponent signals and the blue-yellow sensitivity could not be compared with
//! a copy of a source. The edition of 2023 has other sensitivities and another sum.

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Matrix3, Vector3, Xyz, white};
use darkroot_photo::{Layout, Mosaic};

use super::deviation;
use super::fourier::filtered;
use crate::Quad;
use crate::measure::inside;

/// Pixels a degree of sight of a picture at 100 % on a screen of 100 pixels an inch, 60 cm away.
pub const PIXELS_PER_DEGREE: f64 = 41.0;
/// Fewest pixels on a side of the square that is looked at, and most.
const FEWEST: usize = 24;
const MOST: usize = 128;
/// Illuminant E.
const EQUAL_ENERGY: Xyz = Xyz::new(1.0, 1.0, 1.0);
/// C2 is this times Y - Z.
const C2: f64 = 0.4;

/// Standard deviations of what an eye sees of noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisualNoise {
    /// Of L\*.
    pub l: f64,
    /// Of u\*.
    pub u: f64,
    /// Of v\*.
    pub v: f64,
}

impl VisualNoise {
    /// Visual noise, their weighted sum (ISO 15739:2013, B.4).
    pub fn weighted(&self) -> f64 {
        self.l + 0.852 * self.u + 0.323 * self.v
    }
}

/// Visual noise of the largest upright square about the middle of a window, at most 128 pixels wide. Slopes of light over it
/// are taken off. `to_xyz` turns linear light into XYZ relative to D50. `None` for squares of less than 24 pixels.
pub fn visual_noise(
    light: &Mosaic<f32>,
    to_xyz: &Matrix3,
    window: &Quad,
    pixels_per_degree: f64,
) -> Option<VisualNoise> {
    let square = Square::within(light, window)?;
    let into = bradford(white::D50, EQUAL_ENERGY) * to_xyz;
    let out = bradford(EQUAL_ENERGY, white::D65);
    let seen: Vec<Xyz> = square.pixels(light).map(|rgb| Xyz::from(into * rgb)).collect();
    let filter = |signal: &dyn Fn(&Xyz) -> f64, sensitivity: fn(f64) -> f64| {
        let (mean, rest) = levelled(&seen.iter().map(signal).collect::<Vec<_>>(), square.side);
        let eye = filtered(&rest, square.side, |cycles| sensitivity(cycles * pixels_per_degree));
        eye.into_iter().map(|v| mean + v).collect::<Vec<_>>()
    };
    let a = filter(&|c| c.y, achromatic);
    let c1 = filter(&|c| c.x - c.y, red_green);
    let c2 = filter(&|c| C2 * (c.y - c.z), blue_yellow);
    let luv = |i: usize| {
        let under_e = Vector3::new(a[i] + c1[i], a[i], a[i] - c2[i] / C2);
        let Xyz { x, y, z } = Xyz::from(out * under_e);
        Xyz::new(x.max(0.0), y.max(0.0), z.max(0.0)).luv(white::D65)
    };
    let luvs: Vec<_> = (0..a.len()).map(luv).collect();
    let of =
        |part: fn(&darkroot_colour::luv::Luv) -> f64| deviation(&luvs.iter().map(part).collect::<Vec<_>>());
    Some(VisualNoise { l: of(|c| c.l), u: of(|c| c.u), v: of(|c| c.v) })
}

/// Sensitivity to contrast of luminance at a frequency in cycles a degree: 75 f^0.8 exp(-0.2 f) / 34.05.
fn achromatic(f: f64) -> f64 {
    75.0 * f.powf(0.8) * (-0.2 * f).exp() / 34.05
}

/// That to red against green, 1 at 0.
fn red_green(f: f64) -> f64 {
    two_exponentials(f, [109.14130, 0.00038, 3.42436], [93.59711, 0.00367, 2.16771])
}

/// That to blue against yellow, 1 at 0.
fn blue_yellow(f: f64) -> f64 {
    two_exponentials(f, [7.032845, 0.000004, 4.258205], [40.690950, 0.103909, 1.648658])
}

fn two_exponentials(f: f64, one: [f64; 3], other: [f64; 3]) -> f64 {
    let term = |[a, b, c]: [f64; 3]| a * (-b * f.powf(c)).exp();
    (term(one) + term(other)) / (one[0] + other[0])
}

/// The mean of a square, and what is left without it and without a slope of light.
fn levelled(values: &[f64], side: usize) -> (f64, Vec<f64>) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let middle = (side as f64 - 1.0) / 2.0;
    let [across, down] =
        [0, 1].map(|axis| move |i: usize| (if axis == 0 { i % side } else { i / side }) as f64 - middle);
    let slope = |place: &dyn Fn(usize) -> f64| {
        let product: f64 = values.iter().enumerate().map(|(i, v)| place(i) * v).sum();
        product / (0..values.len()).map(|i| place(i).powi(2)).sum::<f64>()
    };
    let (x, y) = (slope(&across), slope(&down));
    let rest = values.iter().enumerate().map(|(i, v)| v - mean - x * across(i) - y * down(i));
    (mean, rest.collect())
}

/// An upright square of pixels.
struct Square {
    left: usize,
    top: usize,
    side: usize,
}

impl Square {
    fn within(light: &Mosaic<f32>, window: &Quad) -> Option<Self> {
        let middle = [0, 1].map(|k| window.iter().map(|p| p[k]).sum::<f64>() / 4.0);
        let fits = |side: usize| {
            let [left, top] = middle.map(|m| (m - (side as f64 - 1.0) / 2.0).round());
            let reach = side as f64 - 1.0;
            let corners =
                [[left, top], [left + reach, top], [left + reach, top + reach], [left, top + reach]];
            let within = left >= 0.0
                && top >= 0.0
                && left + reach < light.size.width as f64
                && top + reach < light.size.height as f64;
            let fits = within && corners.iter().all(|[x, y]| inside(window, *x, *y));
            fits.then_some(Self { left: left as usize, top: top as usize, side })
        };
        let is_rgb = matches!(light.layout, Layout::Rgb);
        (FEWEST..=MOST).rev().find_map(fits).filter(|_| is_rgb)
    }

    fn pixels<'a>(&'a self, light: &'a Mosaic<f32>) -> impl Iterator<Item = Vector3> + 'a {
        (0..self.side * self.side).map(|i| {
            let (x, y) = (self.left + i % self.side, self.top + i / self.side);
            let first = 3 * (y * light.size.width + x);
            Vector3::from([0, 1, 2].map(|c| f64::from(light.samples[first + c])))
        })
    }
}

#[cfg(test)]
mod tests;
