//! Takes back the bias that interpolating square roots leaves in noise.
//!
//! The mean of squares is the square of the mean plus the variance. A colour that is estimated at a site carries
//! the variance of that site's own channel (its noise, after balancing) instead of its own, and the channels have
//! different ones: in deep shadows red and blue come out too dark and green too bright, by some percent. The
//! difference of the two variances, as measured for the capture at this brightness, is added.

use darkroot_photo::{CameraSpace, Layout, Mosaic, Rgb};

use crate::noise::Noise;
use crate::stage::{Stage, WhenSmaller};

/// Pixels around the result that the correction looks at.
pub const BORDER: usize = 2;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "noise bias", border: BORDER, when_smaller: WhenSmaller::Skipped };

/// Corrects a picture that [`super::Method::Lmmse`] made of this mosaic, which has `border` more pixels on each
/// side.
pub fn debias(mosaic: &Mosaic<f32>, border: usize, noise: &Noise, picture: &mut Rgb<CameraSpace>) {
    let Layout::Cfa(cfa) = &mosaic.layout else { return };
    if *noise == Noise::NONE {
        return;
    }
    let width = mosaic.size.width;
    let size = picture.size();
    let [r, g, b] = picture.planes_mut();
    let mut columns = vec![0f32; size.width + 4];
    for y in 0..size.height {
        let v = y + border;
        // Five by five samples hold every channel in nearly the same share.
        let start = |row: usize| (v + row - 2) * width + border - 2;
        let rows: [&[f32]; 5] = std::array::from_fn(|k| &mosaic.samples[start(k)..][..columns.len()]);
        for (i, sum) in columns.iter_mut().enumerate() {
            *sum = rows[0][i] + rows[1][i] + rows[2][i] + rows[3][i] + rows[4][i];
        }
        let own = [0, 1].map(|x| cfa.at(border + x, v).plane().unwrap_or(1));
        let run = y * size.width..(y + 1) * size.width;
        let (r, g, b) = (&mut r[run.clone()], &mut g[run.clone()], &mut b[run]);
        for (x, sums) in columns.windows(5).enumerate() {
            let brightness = (sums[0] + sums[1] + sums[2] + sums[3] + sums[4]) * (1.0 / 25.0);
            let variances = noise.at(brightness);
            let of_site = variances[own[x % 2]];
            r[x] += variances[0] - of_site;
            g[x] += variances[1] - of_site;
            b[x] += variances[2] - of_site;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demosaic::{Method, demosaic};
    use crate::light::LinearLight;
    use darkroot_photo::{Capture, Cfa, Counts, Size};

    /// A dark grey whose noise is stronger in red and blue, as balancing makes it.
    fn shadows(size: Size) -> Mosaic<f32> {
        let cfa = Cfa::parse("RGGB").unwrap();
        let mut state = 1u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 24) as f32
        };
        let samples = (0..size.area())
            .map(|i| {
                let noise: f32 = (0..12).map(|_| uniform()).sum::<f32>() - 6.0;
                let spread = [0.0025, 0.001, 0.0015][cfa.at(i % size.width, i / size.width).plane().unwrap()];
                0.004 + spread * noise
            })
            .collect();
        Mosaic { size, layout: Layout::Cfa(cfa), samples }
    }

    fn worst_error(picture: &Rgb<CameraSpace>) -> f32 {
        let mean = |plane: &[f32]| plane.iter().sum::<f32>() / plane.len() as f32;
        picture.planes().iter().map(|p| (mean(p) / 0.004 - 1.0).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn noise_in_deep_shadows_does_not_tint_the_picture() {
        let mosaic = shadows(Size { width: 512, height: 512 });
        let capture = Capture::bare(Counts::F32(mosaic.clone()));
        let windows = crate::noise::windows(&capture, &LinearLight::of(&capture));
        let noise = Noise::of(&windows, [1.0; 3]);
        let mut picture = demosaic(&mosaic, Method::Lmmse, 16);
        let plain = worst_error(&picture);
        debias(&mosaic, 16, &noise, &mut picture);
        let debiased = worst_error(&picture);
        assert!(plain > 0.07 && debiased < 0.03, "{plain} without, {debiased} with");
    }
}
