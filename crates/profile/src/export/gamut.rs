//! How far a file is from the profile that it was made of, over colours that pictures have.

use darkroot_colour::difference::de2000;
use darkroot_colour::{Matrix3, RgbSpace, TransferCurve, Vector3, Xyz, white};

use crate::{Calibration, Model, Summary};

/// How far a file is from its profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// CIEDE2000 between both.
    pub de2000: Summary,
    /// Number of colours that were compared.
    pub colours: usize,
}

/// Compares what a file makes of balanced camera RGB with the calibration's model: over the patches of the fit and
/// [`srgb_colours`], as far as they lie in 0..=1.
pub fn deviation(calibration: &Calibration, read_back: impl Fn([f64; 3]) -> Xyz) -> Deviation {
    let patches = calibration.patches.iter().map(|p| p.rgb).filter(|rgb| inside(*rgb));
    let colours: Vec<[f64; 3]> = patches.chain(srgb_colours(&calibration.model)).collect();
    let lab = |xyz: Xyz| xyz.lab(white::D50);
    let apart = |rgb: &[f64; 3]| de2000(lab(read_back(*rgb)), lab(calibration.model.xyz(*rgb)));
    let differences: Vec<f64> = colours.iter().map(apart).collect();
    Deviation { de2000: Summary::of(&differences), colours: differences.len() }
}

/// Balanced camera RGB of the colours of sRGB's gamut that a camera can have: nine levels of each channel, as far as
/// the model has camera RGB in 0..=1 for them.
pub fn srgb_colours(model: &Model) -> Vec<[f64; 3]> {
    const LEVELS: usize = 9;
    let to_xyz = RgbSpace::SRGB.to_xyz_under(white::D50);
    let level = |i: usize| TransferCurve::Srgb.decode(i as f64 / (LEVELS - 1) as f64);
    (1..LEVELS * LEVELS * LEVELS)
        .map(|i| [level(i / (LEVELS * LEVELS)), level(i / LEVELS % LEVELS), level(i % LEVELS)])
        .filter_map(|rgb| invert(model, (to_xyz * Vector3::from(rgb)).into()))
        .map(|rgb| rgb.map(|v| if (v - 1.0).abs() < 1e-6 { 1.0 } else { v }))
        .filter(|rgb| inside(*rgb))
        .collect()
}

fn inside(rgb: [f64; 3]) -> bool {
    rgb.iter().all(|v| (0.0..=1.0).contains(v))
}

/// Balanced camera RGB, none negative, of which a model makes this XYZ, by Newton's method from the matrix that the
/// model is near grey. `None` when there is none.
pub fn invert(model: &Model, wanted: Xyz) -> Option<[f64; 3]> {
    const STEPS: usize = 50;
    let wanted = Vector3::from(wanted);
    let close = 1e-9 * wanted.norm();
    let near_grey = model.jacobian([0.5; 3]).try_inverse()?;
    let mut rgb = near_grey * wanted;
    let least = 1e-3 * rgb.max().abs().max(f64::MIN_POSITIVE);
    rgb = rgb.map(|v| v.max(least));
    for _ in 0..STEPS {
        let off = wanted - Vector3::from(model.xyz(rgb.into()));
        if off.norm() < close {
            return Some(rgb.into());
        }
        let jacobian: Matrix3 = model.jacobian(rgb.into());
        let step = jacobian.try_inverse()? * off;
        // Roots are steep near 0: no channel may lose more than nine tenths at once.
        rgb = (rgb + step).zip_map(&rgb, |next, now| next.max(0.1 * now));
        if !rgb.iter().all(|v| v.is_finite()) {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::tests::{calibration, models};

    #[test]
    fn the_colours_of_srgb_are_found_and_are_those_of_srgb() {
        for model in models() {
            let colours = srgb_colours(&model);
            assert!(colours.len() > 300, "{}", colours.len());
            let from_xyz = RgbSpace::SRGB.from_xyz_under(white::D50);
            for rgb in colours {
                let srgb = from_xyz * Vector3::from(model.xyz(rgb));
                assert!(srgb.min() > -1e-5 && srgb.max() < 1.0 + 1e-5, "{rgb:?} {srgb}");
            }
        }
    }

    #[test]
    fn the_model_itself_does_not_deviate() {
        let calibration = calibration(models().remove(1));
        let found = deviation(&calibration, |rgb| calibration.model.xyz(rgb));
        assert!(found.de2000.max == 0.0 && found.colours > 300);
        let darker = deviation(&calibration, |rgb| calibration.model.xyz(rgb).scaled(0.9));
        assert!(darker.de2000.mean > 1.0);
    }
}
