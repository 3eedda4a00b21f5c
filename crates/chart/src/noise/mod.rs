//! Noise of patches as guidelines for archives count it: the standard deviation of L\*, that of luminance, and what an eye makes
//! of the noise.

mod fourier;

pub mod visual;
pub use visual::{VisualNoise, visual_noise};

use darkroot_colour::white;
use darkroot_colour::{Matrix3, Xyz};
use darkroot_photo::Mosaic;
use rayon::prelude::*;

use crate::Quad;
use crate::measure::for_each_inside;

/// Noise of one patch.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PatchNoise {
    /// Standard deviation of L\*.
    pub lightness: f64,
    /// Standard deviation of luminance, 1 for a perfect white.
    pub luminance: f64,
    /// Pixels that these were measured by.
    pub pixels: usize,
    /// What an eye sees of it; `None` where the patch is too small.
    pub visual: Option<VisualNoise>,
}

/// Noise of each window of a picture in linear light, which `to_xyz` turns into XYZ relative to D50. `pixels_per_degree` is how
/// large the picture is seen. 0 for a window without pixels.
pub fn patch_noise(
    light: &Mosaic<f32>,
    to_xyz: &Matrix3,
    windows: &[Quad],
    pixels_per_degree: f64,
) -> Vec<PatchNoise> {
    let one = |window: &Quad| {
        let luminances = luminances(light, to_xyz, window);
        let lightness: Vec<f64> = luminances.iter().map(|y| Xyz::new(*y, *y, *y).lab(white::D50).l).collect();
        PatchNoise {
            lightness: deviation(&lightness),
            luminance: deviation(&luminances),
            pixels: luminances.len(),
            visual: visual_noise(light, to_xyz, window, pixels_per_degree),
        }
    };
    windows.par_iter().map(one).collect()
}

/// Luminance of every pixel of a window.
fn luminances(light: &Mosaic<f32>, to_xyz: &Matrix3, window: &Quad) -> Vec<f64> {
    let (mut y, mut values) = (0.0, Vec::new());
    for_each_inside(light, window, |_, _, channel, value| {
        y += to_xyz[(1, channel)] * f64::from(value);
        if channel == 2 {
            values.push(y);
            y = 0.0;
        }
    });
    values
}

/// Standard deviation of a sample; 0 for fewer than two values.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::{Layout, Size};

    #[test]
    fn the_deviation_is_that_of_lightness() {
        // L* 49 and 51 in a chequerboard.
        let y = |l: f64| ((l + 16.0f64) / 116.0).powi(3) as f32;
        let size = Size { width: 20, height: 20 };
        let samples =
            (0..400).flat_map(|i| [y(if (i + i / 20) % 2 == 0 { 49.0 } else { 51.0 }); 3]).collect();
        let light = Mosaic { size, layout: Layout::Rgb, samples };
        let window = [[2.0, 2.0], [17.0, 2.0], [17.0, 17.0], [2.0, 17.0]];
        let to_xyz = Matrix3::new(0.3, 0.3, 0.3, 0.25, 0.5, 0.25, 0.3, 0.3, 0.3);
        let noise = patch_noise(&light, &to_xyz, &[window], 40.0).remove(0);
        assert!((noise.lightness - 1.0).abs() < 0.01, "{noise:?}");
        assert!((noise.luminance - f64::from(y(51.0) - y(49.0)) / 2.0).abs() < 1e-4, "{noise:?}");
        assert_eq!(noise.visual, None, "16 pixels are too few");
    }
}
