//! The white of the light, from a chart whose grey patches are not quite grey.

use darkroot_colour::{Matrix3, Vector3, Xyz};

use super::{FitError, Samples, plain};
use crate::{Kind, Order};

/// Largest chroma of a patch that counts as neutral.
const NEUTRAL_CHROMA: f64 = 4.0;
/// Least luminance of such a patch, relative to white.
const NEUTRAL_Y: f64 = 0.05;

/// Camera RGB of the perfect diffuser, in the units of the samples' RGB, which need not be balanced.
///
/// M, a matrix fitted to all patches, tells by its inverse which RGB a colour should have. For white that is M^-1
/// white. It is corrected by the neutral patches: for each channel by the median ratio of the RGB that they have to the
/// RGB that they should have, so w = median(rgb / M^-1 XYZ) M^-1 white. Simply taking grey patches for neutral would
/// carry their own slight tint into the profile. Without neutral patches, M alone decides.
///
/// # Errors
/// Too few colours, or colours that do not determine a matrix.
pub fn white_through(samples: &Samples) -> Result<[f64; 3], FitError> {
    let undetermined = FitError::Undetermined { kind: Kind::Linear };
    let linear = plain::root(samples, Order::One)?.model;
    let column = |c: usize| {
        let mut unit = [0.0; 3];
        unit[c] = 1.0;
        Vector3::from(linear.xyz(unit))
    };
    let matrix = Matrix3::from_columns(&[column(0), column(1), column(2)]);
    let inverse = matrix.try_inverse().ok_or(undetermined.clone())?;
    let expected = |xyz: Xyz| inverse * Vector3::from(xyz);
    let white = expected(samples.white());
    let neutral = |xyz: &Xyz| {
        xyz.lab(samples.white()).chroma() < NEUTRAL_CHROMA && xyz.y > NEUTRAL_Y * samples.white().y
    };
    let ratios: Vec<Vector3> = samples
        .rgb()
        .iter()
        .zip(samples.xyz())
        .filter(|(_, xyz)| neutral(xyz))
        .map(|(rgb, xyz)| Vector3::from(*rgb).component_div(&expected(*xyz)))
        .collect();
    let factor = |c: usize| {
        let mut values: Vec<f64> = ratios.iter().map(|r| r[c]).filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        match values.len() {
            0 => 1.0,
            n if n % 2 == 1 => values[n / 2],
            n => (values[n / 2 - 1] + values[n / 2]) / 2.0,
        }
    };
    let found = [0, 1, 2].map(|c| white[c] * factor(c));
    if found.iter().all(|v| v.is_finite() && *v > 0.0) { Ok(found) } else { Err(undetermined) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_white_is_found_through_greys_that_are_not_grey() {
        // A camera that is exactly linear: its white comes out exactly, whatever the tint of the greys.
        let matrix = Matrix3::new(0.6, 0.3, 0.1, 0.3, 0.7, 0.0, 0.05, 0.1, 0.9);
        let gains = [0.45, 1.0, 0.7];
        let white = Xyz::from(matrix * Vector3::repeat(1.0));
        let colours = [
            [0.90, 0.91, 0.88],
            [0.36, 0.35, 0.36],
            [0.18, 0.185, 0.18],
            [0.7, 0.1, 0.1],
            [0.1, 0.6, 0.2],
            [0.1, 0.15, 0.5],
            [0.7, 0.6, 0.1],
        ];
        let rgb = colours.iter().map(|c| [0, 1, 2].map(|k| c[k] * gains[k])).collect();
        let xyz = colours.iter().map(|c| Xyz::from(matrix * Vector3::from(*c))).collect();
        let found = white_through(&Samples::new(rgb, xyz, white).unwrap()).unwrap();
        for (found, gain) in found.into_iter().zip(gains) {
            assert!((found - gain).abs() < 1e-12, "{found} {gain}");
        }
    }
}
