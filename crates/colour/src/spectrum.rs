//! Spectra on one fixed grid, their tristimulus values, and lights that a formula gives.

use crate::measured::{Measured, SpectrumError};
use crate::tables::daylight::{DAYLIGHT_S0, DAYLIGHT_S1, DAYLIGHT_S2};
use crate::tables::observer::{X_BAR, Y_BAR, Z_BAR};
use crate::temperature::daylight_xy;
use crate::{Xy, Xyz};

/// Number of samples of a [`Spectrum`].
pub const SAMPLES: usize = 81;
/// Wavelength of the first sample, nm.
pub const FIRST_NM: f64 = 380.0;
/// Wavelength of the last sample, nm.
pub const LAST_NM: f64 = 780.0;
/// Distance of two samples, nm.
pub const STEP_NM: f64 = 5.0;

/// Second radiation constant c2 in nm K (CIE 015:2018: 1.4388e-2 m K for illuminants).
const C2_NM_K: f64 = 1.4388e7;
/// c2 that standard illuminant A keeps from 1931 (ISO 11664-2): 1.435e-2 m K at 2848 K.
const C2_A_NM_K: f64 = 1.435e7;

/// A quantity over wavelength, 380 to 780 nm every 5 nm: a reflectance (0..=1), a relative power, a sensitivity.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum(pub [f64; SAMPLES]);

impl Spectrum {
    /// Samples `f`, a function of wavelength in nm.
    pub fn from_fn(f: impl Fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(Self::wavelength(i))))
    }

    /// Measured samples at any ascending wavelengths (nm), resampled by linear interpolation and carried on flat at
    /// the ends: [`Measured::spectrum`] in one call.
    pub fn from_samples(wavelengths: &[f64], values: &[f64]) -> Result<Self, SpectrumError> {
        Ok(Measured::new(wavelengths, values)?.spectrum())
    }

    /// The same value everywhere (a perfect grey, illuminant E).
    pub fn constant(value: f64) -> Self {
        Self([value; SAMPLES])
    }

    /// Wavelength in nm of sample `i`.
    pub fn wavelength(i: usize) -> f64 {
        FIRST_NM + STEP_NM * i as f64
    }

    /// Value at `nm` by linear interpolation; the nearest end outside of 380..=780 nm.
    pub fn at(&self, nm: f64) -> f64 {
        interpolate(&self.0, nm)
    }

    /// The same spectrum, `k` times as strong.
    #[must_use]
    pub fn scaled(&self, k: f64) -> Self {
        Self(self.0.map(|v| k * v))
    }

    /// Product sample by sample: a reflectance under a light, a light through a filter.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }

    /// Sum over wavelength of the product of two spectra (no step factor).
    pub fn dot(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(a, b)| a * b).sum()
    }

    /// Tristimulus values of this stimulus for the CIE 1931 2-degree observer, unnormalised.
    pub fn stimulus_xyz(&self) -> Xyz {
        let sum = |bar: &[f64; SAMPLES]| self.0.iter().zip(bar).map(|(s, b)| s * b).sum();
        Xyz::new(sum(&X_BAR), sum(&Y_BAR), sum(&Z_BAR))
    }

    /// Tristimulus values of this reflectance under `light`, with Y = 1 for the perfect diffuser
    /// (CIE 015:2018, 7.1).
    pub fn reflected_xyz(&self, light: &Self) -> Xyz {
        let white = light.stimulus_xyz();
        self.times(light).stimulus_xyz().scaled(1.0 / white.y)
    }

    /// Tristimulus values of the perfect diffuser under this light, Y = 1; the light needs some luminance.
    pub fn white(&self) -> Xyz {
        let white = self.stimulus_xyz();
        white.scaled(1.0 / white.y)
    }

    /// Black-body radiation at `kelvin` (more than 0), relative, 1 at 560 nm (Planck's law).
    pub fn black_body(kelvin: f64) -> Self {
        Self::planck(kelvin, C2_NM_K)
    }

    /// CIE standard illuminant A (CIE 015:2018, 4.1), relative, 1 at 560 nm.
    pub fn illuminant_a() -> Self {
        Self::planck(2848.0, C2_A_NM_K)
    }

    /// Daylight of the given correlated colour temperature, 4000 to 25000 K (CIE 015:2018, 4.2), about 100 at
    /// 560 nm. Outside that range the nearest end is used. `daylight(6504.0)` is nearly D65, whose table
    /// ([`Illuminant`](crate::Illuminant)) was made with older constants: 1e-4 in x, y.
    pub fn daylight(kelvin: f64) -> Self {
        let Xy { x, y } = daylight_xy(kelvin);
        let m = 0.0241 + 0.2562 * x - 0.7341 * y;
        // The standard rounds M1 and M2 to three decimals.
        let m1 = ((-1.3515 - 1.7703 * x + 5.9114 * y) / m * 1000.0).round() / 1000.0;
        let m2 = ((0.0300 - 31.4424 * x + 30.0717 * y) / m * 1000.0).round() / 1000.0;
        Self(std::array::from_fn(|i| DAYLIGHT_S0[i] + m1 * DAYLIGHT_S1[i] + m2 * DAYLIGHT_S2[i]))
    }

    fn planck(kelvin: f64, c2: f64) -> Self {
        let power = |nm: f64| nm.powi(-5) / ((c2 / (nm * kelvin)).exp() - 1.0);
        let at_560 = power(560.0);
        Self::from_fn(|nm| power(nm) / at_560)
    }
}

/// Linear interpolation between samples; the nearest end outside.
pub(crate) fn interpolate(samples: &[f64; SAMPLES], nm: f64) -> f64 {
    let position = ((nm - FIRST_NM) / STEP_NM).clamp(0.0, (SAMPLES - 1) as f64);
    let left = (position as usize).min(SAMPLES - 2);
    let share = position - left as f64;
    samples[left] + share * (samples[left + 1] - samples[left])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::white;

    fn assert_xy(light: &Spectrum, expected: Xy, tolerance: f64) {
        let xy = light.stimulus_xyz().xy().unwrap();
        assert!(
            (xy.x - expected.x).abs() < tolerance && (xy.y - expected.y).abs() < tolerance,
            "{xy:?} is not {expected:?}"
        );
    }

    #[test]
    fn the_standard_illuminants_have_their_published_chromaticities() {
        assert_xy(&Spectrum::illuminant_a(), white::A_XY, 2e-5);
        assert_xy(&Spectrum::daylight(6504.0), Xy::new(0.31272, 0.32903), 1e-4);
        assert_xy(&Spectrum::daylight(5003.0), Xy::new(0.34567, 0.35851), 1e-4);
        assert_xy(&Spectrum::constant(1.0), Xy::new(1.0 / 3.0, 1.0 / 3.0), 2e-5);
    }

    #[test]
    fn the_perfect_diffuser_has_luminance_one_under_any_light() {
        for light in [Spectrum::illuminant_a(), Spectrum::daylight(7500.0)] {
            assert!((Spectrum::constant(1.0).reflected_xyz(&light).y - 1.0).abs() < 1e-12);
        }
    }
}
