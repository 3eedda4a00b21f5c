//! Noise of patches as guidelines for archives count it: the standard deviation of L\*.

use darkroot_colour::Xyz;
use darkroot_colour::white;
use darkroot_photo::Mosaic;
use rayon::prelude::*;

use crate::Quad;
use crate::measure::for_each_inside;

/// Standard deviation of L\* over each window of a picture in linear light; `luminance` is how much red, green and blue count
/// in Y. 0 for a window without pixels.
pub fn lightness_noise(light: &Mosaic<f32>, luminance: [f64; 3], windows: &[Quad]) -> Vec<f64> {
    let one = |window: &Quad| {
        let (mut y, mut values) = (0.0, Vec::new());
        for_each_inside(light, window, |_, _, channel, value| {
            y += luminance[channel] * f64::from(value);
            if channel == 2 {
                values.push(Xyz::new(y, y, y).lab(white::D50).l);
                y = 0.0;
            }
        });
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt()
    };
    windows.par_iter().map(one).collect()
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
        let noise = lightness_noise(&light, [0.25, 0.5, 0.25], &[window]);
        assert!((noise[0] - 1.0).abs() < 0.01, "{noise:?}");
    }
}
