//! White balance: multipliers that make the white of the light (1,1,1).

use darkroot_photo::{CameraSpace, Layout, Rgb};

/// Multiplies a run of samples of row `y` by the multipliers of their filters; the first sample is that of
/// column `x` (all samples of a pixel are there).
#[inline(always)]
pub fn row(light: &mut [f32], layout: &Layout, multipliers: [f32; 3], x: usize, y: usize) {
    match layout {
        Layout::Cfa(cfa) => {
            let gains: Vec<f32> =
                (0..cfa.width()).map(|i| multipliers[cfa.at(x + i, y).plane().unwrap_or(1)]).collect();
            if let [even, odd] = gains[..] {
                for (i, v) in light.iter_mut().enumerate() {
                    *v *= if i % 2 == 0 { even } else { odd };
                }
            } else {
                for (v, gain) in light.iter_mut().zip(gains.iter().cycle()) {
                    *v *= gain;
                }
            }
        }
        Layout::Rgb => {
            for pixel in light.chunks_exact_mut(3) {
                for (v, gain) in pixel.iter_mut().zip(multipliers) {
                    *v *= gain;
                }
            }
        }
        Layout::Monochrome => {}
    }
}

/// Divides a picture by the multipliers that its samples were multiplied by.
pub fn undo(mut picture: Rgb<CameraSpace>, multipliers: [f32; 3]) -> Rgb<CameraSpace> {
    for (plane, multiplier) in picture.planes_mut().into_iter().zip(multipliers) {
        for v in plane {
            *v /= multiplier;
        }
    }
    picture
}
