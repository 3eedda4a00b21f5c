//! Reflectances under a light, through a camera's sensitivities: colours that are known from both sides.

use darkroot_colour::{Spectrum, Xyz};

use crate::fit::{FitError, Samples};

/// Sensitivity to energy of a camera's red, green and blue channel over wavelength, each relative.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities(pub [Spectrum; 3]);

/// What each channel makes of each wavelength under a light: light times sensitivity, scaled to the sum 1, so that
/// the perfect diffuser gives (1,1,1).
#[derive(Debug, Clone, PartialEq)]
pub struct Effective(pub [Spectrum; 3]);

impl Sensitivities {
    /// The sensitivities under a light. `None` when a channel sees nothing of it.
    pub fn under(&self, light: &Spectrum) -> Option<Effective> {
        let totals = self.0.each_ref().map(|s| s.dot(light));
        let seen = totals.iter().all(|t| t.is_finite() && *t > 0.0);
        seen.then(|| Effective([0, 1, 2].map(|c| self.0[c].times(light).scaled(1.0 / totals[c]))))
    }
}

impl Effective {
    /// Balanced camera RGB of a reflectance.
    pub fn rgb(&self, reflectance: &Spectrum) -> [f64; 3] {
        self.0.each_ref().map(|e| e.dot(reflectance))
    }

    /// Camera RGB and XYZ of reflectances under the light that this camera stands under.
    ///
    /// # Errors
    /// Values that are not finite.
    pub fn render(&self, reflectances: &[Spectrum], light: &Spectrum) -> Result<Samples, FitError> {
        let rgb = reflectances.iter().map(|r| self.rgb(r)).collect();
        let xyz = reflectances.iter().map(|r| r.reflected_xyz(light)).collect();
        Samples::new(rgb, xyz, white(light))
    }
}

/// XYZ of the perfect diffuser under a light, Y = 1.
pub fn white(light: &Spectrum) -> Xyz {
    Spectrum::constant(1.0).reflected_xyz(light)
}

/// The light as the root-polynomial papers sample it: 31 channels, 400 to 700 nm every 10 nm, nothing in between.
/// Sums over wavelength under it are sums over these channels.
pub fn in_31_channels(light: &Spectrum) -> Spectrum {
    Spectrum(std::array::from_fn(|i| {
        let nm = Spectrum::wavelength(i);
        if (400.0..=700.0).contains(&nm) && i % 2 == 0 { light.0[i] } else { 0.0 }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_31_channels() {
        let channels = in_31_channels(&Spectrum::constant(1.0));
        assert!((channels.0.iter().sum::<f64>() - 31.0).abs() < 1e-12);
        assert!(channels.0[4] > 0.0 && channels.0[64] > 0.0 && channels.0[5].abs() < 1e-12);
    }

    #[test]
    fn the_perfect_diffuser_is_white_for_camera_and_observer() {
        let band = |centre: f64| Spectrum::from_fn(|nm| (-((nm - centre) / 40.0).powi(2)).exp());
        let camera = Sensitivities([band(600.0), band(540.0), band(450.0)]);
        let light = Spectrum::illuminant_a();
        let samples = camera.under(&light).unwrap().render(&[Spectrum::constant(1.0)], &light).unwrap();
        assert!(samples.rgb()[0].iter().all(|v| (v - 1.0).abs() < 1e-12));
        assert_eq!(samples.xyz()[0], samples.white());
        assert_eq!(camera.under(&Spectrum::constant(0.0)), None);
    }
}
