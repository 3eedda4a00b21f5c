//! Tristimulus weighting factors: reflectances at any wavelengths to XYZ under one light.

use crate::measured::{MUST_REACH_NM, MUST_START_NM, SpectrumError, check_ascending};
use crate::spectrum::{FIRST_NM, LAST_NM};
use crate::{Spectrum, Xyz, observer};

/// Factors that turn a reflectance sampled at some wavelengths into tristimulus values under one light, relative to
/// its perfect diffuser (Y = 1): XYZ = sum over samples of factor x reflectance.
///
/// Each factor is light x colour-matching function x width of the sample (CIE 015:2018, 7.1), without the bandpass
/// correction of ASTM E308. Evenly spaced samples have the same width, the first and the last too.
#[derive(Debug, Clone, PartialEq)]
pub struct TristimulusWeights {
    /// Ascending, nm.
    wavelengths: Vec<f64>,
    factors: Vec<Xyz>,
}

impl TristimulusWeights {
    /// Factors for `light` and reflectances at `wavelengths`, ascending within 380..=780 nm, at least two.
    pub fn new(light: &Spectrum, wavelengths: &[f64]) -> Result<Self, SpectrumError> {
        if let Some(&nm) = wavelengths.iter().find(|nm| !(FIRST_NM..=LAST_NM).contains(*nm)) {
            return Err(SpectrumError::OutOfRange { nm });
        }
        check_ascending(wavelengths)?;
        let [_, .., _] = wavelengths else {
            return Err(SpectrumError::Missing { from: MUST_START_NM, to: MUST_REACH_NM });
        };
        let products: Vec<Xyz> = wavelengths
            .iter()
            .enumerate()
            .map(|(i, &nm)| observer::cie_1931(nm).scaled(light.at(nm) * width(wavelengths, i)))
            .collect();
        let luminance: f64 = products.iter().map(|p| p.y).sum();
        if !(luminance > 0.0 && luminance.is_finite()) {
            return Err(SpectrumError::Dark);
        }
        let factors = products.into_iter().map(|p| p.scaled(1.0 / luminance)).collect();
        Ok(Self { wavelengths: wavelengths.to_vec(), factors })
    }

    /// Wavelengths of the samples, nm, ascending.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// One factor for each wavelength; their sum is the white, with Y = 1.
    pub fn factors(&self) -> &[Xyz] {
        &self.factors
    }

    /// Tristimulus values of the perfect diffuser under the light, Y = 1.
    pub fn white(&self) -> Xyz {
        self.factors.iter().fold(Xyz::default(), |sum, f| Xyz::new(sum.x + f.x, sum.y + f.y, sum.z + f.z))
    }

    /// Tristimulus values of a reflectance (0..=1), one value for each wavelength; missing ones count as 0.
    pub fn reflected_xyz(&self, reflectance: &[f64]) -> Xyz {
        self.factors
            .iter()
            .zip(reflectance)
            .fold(Xyz::default(), |sum, (f, r)| Xyz::new(sum.x + r * f.x, sum.y + r * f.y, sum.z + r * f.z))
    }
}

/// Width in nm that sample `i` stands for.
fn width(wavelengths: &[f64], i: usize) -> f64 {
    let last = wavelengths.len() - 1;
    let (left, right) = (i.saturating_sub(1), (i + 1).min(last));
    (wavelengths[right] - wavelengths[left]) / (right - left) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Illuminant;

    /// A smooth reddish reflectance, made for these tests.
    fn reddish(nm: f64) -> f64 {
        0.2 + 0.6 * (-((nm - 600.0) / 60.0).powi(2)).exp()
    }

    fn assert_near(found: Xyz, expected: [f64; 3]) {
        for (f, e) in <[f64; 3]>::from(found).iter().zip(expected) {
            assert!((f - e).abs() < 1e-11, "{found:?} is not {expected:?}");
        }
    }

    #[test]
    fn thirty_one_channels_give_what_the_protocol_of_the_paper_gives() {
        // numpy: (R * L) @ cmf / (L @ y_bar), L @ cmf / (L @ y_bar) at 400, 410, .., 700 nm with D65 and the observer of
        // colour-science 0.4.7.
        let nm = observer::every_ten_nm();
        let d65 = Illuminant::by_name("D65").unwrap().spectrum();
        let weights = TristimulusWeights::new(&d65, &nm).unwrap();
        assert_near(weights.white(), [0.949400923207, 1.0, 1.087091222109]);
        assert_near(
            weights.reflected_xyz(&nm.map(reddish)),
            [0.551789180174, 0.525461958178, 0.225640275503],
        );
    }

    #[test]
    fn the_whole_grid_gives_what_the_spectrum_gives() {
        let light = Illuminant::by_name("F11").unwrap().spectrum();
        let nm: Vec<f64> = (0..crate::spectrum::SAMPLES).map(Spectrum::wavelength).collect();
        let weights = TristimulusWeights::new(&light, &nm).unwrap();
        let reflectance = Spectrum::from_fn(reddish);
        assert_near(weights.reflected_xyz(&reflectance.0), reflectance.reflected_xyz(&light).into());
    }

    #[test]
    fn uneven_samples_count_by_their_width() {
        let nm: Vec<f64> = (0..=80)
            .map(|i| 380.0 + 2.5 * f64::from(i))
            .chain((1..=40).map(|i| 580.0 + 5.0 * f64::from(i)))
            .collect();
        let weights = TristimulusWeights::new(&Spectrum::constant(1.0), &nm).unwrap();
        let white = weights.white();
        assert!((white.x - 1.0).abs() < 1e-3 && (white.z - 1.0).abs() < 1e-3, "{white:?}");
    }

    #[test]
    fn what_gives_no_weights_is_refused_with_the_reason() {
        let nm = observer::every_ten_nm();
        let refused = |light: f64, nm: &[f64]| TristimulusWeights::new(&Spectrum::constant(light), nm).err();
        assert_eq!(refused(0.0, &nm), Some(SpectrumError::Dark));
        assert_eq!(refused(1.0, &[500.0]), Some(SpectrumError::Missing { from: 400.0, to: 700.0 }));
        assert_eq!(refused(1.0, &[500.0, 790.0]), Some(SpectrumError::OutOfRange { nm: 790.0 }));
        assert!(refused(1.0, &[500.0, 500.0]).is_some());
        assert!(refused(1.0, &[f64::NAN, 500.0]).is_some());
    }
}
