//! Takes back the bias that interpolating square roots leaves in noise.
//!
//! The mean of squares is the square of the mean plus the variance. A colour that is estimated at a site carries
//! the variance of that site's own channel (its noise, after balancing) instead of its own, and the channels have
//! different ones: in deep shadows red and blue come out too dark and green too bright, by some percent. The
//! difference of the two variances, as measured for the capture at this brightness, is added.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Filter, Layout, Mosaic, Rgb};

use crate::noise::Noise;
use crate::stage::{Stage, WhenSmaller};

/// Pixels around the result that the correction looks at.
pub const BORDER: usize = 2;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "noise bias", border: BORDER, when_smaller: WhenSmaller::Skipped };

/// Corrects a picture that [`super::Method::Lmmse`] made of this mosaic, which has `border` more pixels on each
/// side.
///
/// The 2 x 2 pixels of a period of the array count as equally bright: as the mean of the 6 x 6 samples around them, which
/// hold every channel in its share.
pub fn debias(mosaic: &Mosaic<f32>, border: usize, noise: &Noise, picture: &mut Rgb<CameraSpace>) {
    let Layout::Cfa(cfa) = &mosaic.layout else { return };
    if *noise == Noise::NONE {
        return;
    }
    // Periods begin at red samples; the first one may begin one pixel before the picture.
    let (x0, y0) = cfa.first(Filter::Red).map_or((0, 0), |(x, y)| ((x + border) % 2, (y + border) % 2));
    let (size, width) = (picture.size(), mosaic.size.width);
    let periods = (size.width + x0).div_ceil(2);
    let mut columns = vec![0f32; 2 * periods + 4];
    let mut variances = [0; 3].map(|_| vec![0f32; periods]);
    let mut planes = picture.planes_mut();
    for top in (border - y0..border + size.height).step_by(2) {
        let start = |row: usize| (top + row - 2) * width + border - x0 - 2;
        let rows: [&[f32]; 6] = std::array::from_fn(|k| &mosaic.samples[start(k)..][..columns.len()]);
        vectorised(
            #[inline(always)]
            || {
                for (i, sum) in columns.iter_mut().enumerate() {
                    *sum = rows[0][i] + rows[1][i] + rows[2][i] + rows[3][i] + rows[4][i] + rows[5][i];
                }
            },
        );
        for i in 0..periods {
            let sums = &columns[2 * i..2 * i + 6];
            let brightness = sums.iter().sum::<f32>() * (1.0 / 36.0);
            let of_period = noise.at(brightness);
            for (variances, of_period) in variances.iter_mut().zip(of_period) {
                variances[i] = of_period;
            }
        }
        for y in top.max(border)..(top + 2).min(border + size.height) {
            let own = [0, 1].map(|x| cfa.at(border + x + x0, y).plane().unwrap_or(1));
            for (c, plane) in planes.iter_mut().enumerate() {
                let row = &mut plane[(y - border) * size.width..][..size.width];
                add(row, x0, &variances[c], own.map(|own| &variances[own][..]));
            }
        }
    }
}

/// Adds to each pixel of a row the variance of the channel less that of the pixel's own one. The row begins with the first
/// (0) or second (1) pixel of a period.
fn add(row: &mut [f32], first: usize, channel: &[f32], own: [&[f32]; 2]) {
    let (before, row) = row.split_at_mut(first.min(row.len()));
    for v in before {
        *v += channel[0] - own[1][0];
    }
    let (channel, own) = (&channel[first..], own.map(|own| &own[first..]));
    vectorised(
        #[inline(always)]
        || {
            let mut pairs = row.chunks_exact_mut(2);
            for (((pair, c), even), odd) in (&mut pairs).zip(channel).zip(own[0]).zip(own[1]) {
                pair[0] += c - even;
                pair[1] += c - odd;
            }
            let whole = channel.len().saturating_sub(1);
            for v in pairs.into_remainder() {
                *v += channel[whole] - own[0][whole];
            }
        },
    );
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
        let mut picture = Rgb::black(Size { width: 0, height: 0 });
        demosaic(&mosaic, Method::Lmmse, 16, &mut picture);
        let plain = worst_error(&picture);
        debias(&mosaic, 16, &noise, &mut picture);
        let debiased = worst_error(&picture);
        assert!(plain > 0.07 && debiased < 0.03, "{plain} without, {debiased} with");
    }
}
