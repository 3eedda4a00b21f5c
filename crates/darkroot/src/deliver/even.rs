//! How even a picture of an even surface is.

use std::path::Path;

use darkroot_calibrate::delivery::Uniformity;
use darkroot_chart::{Banding, banding};
use darkroot_colour::{Lab, Xyz, white};
use darkroot_encode::source_profile::LINEAR;
use darkroot_photo::Mosaic;

use super::{Opened, xyz};
use crate::Error;

/// Parts of the picture across and down.
const PARTS: [usize; 2] = [12, 8];

/// Differences over a finished picture of an even surface, the means of 12 x 8 parts of it against each other, and the bands in it.
///
/// # Errors
/// A file that cannot be read, or a profile that tells no colours.
pub(super) fn evenness(path: &Path) -> Result<(Uniformity, Option<Banding>), Error> {
    let light = Opened::read(path)?.light;
    let to_xyz = LINEAR.to_xyz_under(white::D50);
    Ok((of_light(&light), banding(&light, [0, 1, 2].map(|c| to_xyz[(1, c)]))))
}

fn of_light(light: &Mosaic<f32>) -> Uniformity {
    let to_xyz = LINEAR.to_xyz_under(white::D50);
    let parts: Vec<Xyz> = (0..PARTS[0] * PARTS[1]).map(|i| xyz(&to_xyz, mean(light, i))).collect();
    let labs: Vec<Lab> = parts.iter().map(|part| part.lab(white::D50)).collect();
    let range = |of: &dyn Fn(usize) -> f64| {
        let values = (0..parts.len()).map(of);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        high - low
    };
    let average = |of: &dyn Fn(usize) -> f64| (0..parts.len()).map(of).sum::<f64>() / parts.len() as f64;
    let (a, b) = (average(&|i| labs[i].a), average(&|i| labs[i].b));
    Uniformity {
        lightness: range(&|i| labs[i].l),
        luminance: 100.0 * range(&|i| parts[i].y) / average(&|i| parts[i].y).max(1e-9),
        colour: labs.iter().map(|lab| (lab.a - a).hypot(lab.b - b)).fold(0.0, f64::max),
    }
}

/// Mean linear light of a part.
fn mean(light: &Mosaic<f32>, part: usize) -> [f64; 3] {
    let cut = |i: usize, parts: usize, length: usize| {
        i * length / parts..((i + 1) * length / parts).max(i * length / parts + 1)
    };
    let columns = cut(part % PARTS[0], PARTS[0], light.size.width);
    let rows = cut(part / PARTS[0], PARTS[1], light.size.height);
    let (mut sum, mut count) = ([0.0; 3], 0.0f64);
    for y in rows.filter(|y| *y < light.size.height) {
        for x in columns.clone().filter(|x| *x < light.size.width) {
            let first = 3 * (y * light.size.width + x);
            for (sum, v) in sum.iter_mut().zip(&light.samples[first..first + 3]) {
                *sum += f64::from(*v);
            }
            count += 1.0;
        }
    }
    sum.map(|v| v / count.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::{Layout, Size};

    #[test]
    fn a_slope_of_light_is_told_in_percent() {
        let size = Size { width: 120, height: 80 };
        // From 0.5 to 0.55 across: between the means of the outermost parts lie 11 of 12 of that.
        let samples = (0..size.area()).flat_map(|i| [0.5 + 0.05 * (i % 120) as f32 / 119.0; 3]).collect();
        let found = of_light(&Mosaic { size, layout: Layout::Rgb, samples });
        assert!((found.luminance - 100.0 * 0.05 * (110.0 / 119.0) / 0.525).abs() < 0.05, "{found:?}");
        assert!(found.colour < 0.01 && found.lightness > 1.0, "{found:?}");
    }

    #[test]
    fn a_picture_smaller_than_its_parts_is_judged_all_the_same() {
        let light = Mosaic { size: Size { width: 2, height: 1 }, layout: Layout::Rgb, samples: vec![0.5; 6] };
        assert!(of_light(&light).luminance.is_finite());
    }
}
