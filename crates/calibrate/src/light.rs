//! The light that a chart stood in: its name, its chromaticity and, where it is known, its spectrum.

use darkroot_colour::illuminant::{ILLUMINANTS, Illuminant};
use darkroot_colour::temperature::{Temperature, planckian_xy};
use darkroot_colour::{Spectrum, Xy, white};
use darkroot_profile::Light;

/// Temperature from which a light given in kelvin is taken for daylight, not for a black body.
const DAYLIGHT_FROM: f64 = 4000.0;

/// A light.
#[derive(Debug, Clone, PartialEq)]
pub struct LightSource {
    /// Name and chromaticity.
    pub light: Light,
    /// Relative power, where it is known.
    pub spectrum: Option<Spectrum>,
}

impl LightSource {
    /// The light that a text names: a CIE illuminant ("D65", "A", "FL11", "LED-B3"), a temperature ("5500K": daylight
    /// from 4000 K on, black body below) or a chromaticity ("0.34,0.36"). `None` where it is none of these.
    pub fn by_name(text: &str) -> Option<Self> {
        if let Some(known) = Illuminant::by_name(text) {
            return Some(Self::of_spectrum(known.name, known.spectrum()));
        }
        if let Some(kelvin) = text.strip_suffix(['K', 'k']).and_then(|n| n.trim().parse::<f64>().ok()) {
            return Self::of_kelvin(kelvin);
        }
        let (x, y) = text.split_once(',')?;
        Self::of_chromaticity(x.trim().parse().ok()?, y.trim().parse().ok()?)
    }

    /// A light whose spectrum is known.
    pub fn of_spectrum(name: &str, spectrum: Spectrum) -> Self {
        let white = spectrum.white();
        let sum = white.x + white.y + white.z;
        let light = Light { name: name.to_owned(), xy: Xy::new(white.x / sum, white.y / sum) };
        Self { light, spectrum: Some(spectrum) }
    }

    /// What is taken for a light of which nothing is known: D50, as in graphic arts.
    pub fn assumed() -> Self {
        let light = Light { name: "D50".to_owned(), xy: white::D50_XY };
        Self { light, spectrum: Illuminant::by_name("D50").map(|d50| d50.spectrum()) }
    }

    /// Daylight, or a black body below 4000 K, of the temperature of a white that was measured, to the nearest 10 K. `None`
    /// outside of 1000 to 25000 K.
    pub fn of_white(white: Xy) -> Option<Self> {
        Self::of_kelvin((Temperature::of(white).kelvin / 10.0).round() * 10.0)
    }

    /// Daylight of a temperature, a black body below 4000 K. `None` outside of 1000 to 25000 K.
    pub fn of_kelvin(kelvin: f64) -> Option<Self> {
        if !(1000.0..=25_000.0).contains(&kelvin) {
            return None;
        }
        let name = format!("{kelvin:.0} K");
        if kelvin >= DAYLIGHT_FROM {
            return Some(Self::of_spectrum(&name, Spectrum::daylight(kelvin)));
        }
        let body = Self::of_spectrum(&name, Spectrum::black_body(kelvin));
        // The exact locus, so that the temperature comes back as it was given.
        Some(Self { light: Light { name, xy: planckian_xy(kelvin) }, ..body })
    }

    /// A light of which only the chromaticity is known. `None` where no light can have it.
    pub fn of_chromaticity(x: f64, y: f64) -> Option<Self> {
        let sound = x > 0.0 && y > 0.0 && x + y < 1.0;
        let light = Light { name: format!("xy {x},{y}"), xy: Xy::new(x, y) };
        sound.then_some(Self { light, spectrum: None })
    }

    /// Names of the lights that are known by name.
    pub fn names() -> impl Iterator<Item = &'static str> {
        ILLUMINANTS.iter().map(|i| i.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kelvin(text: &str) -> f64 {
        LightSource::by_name(text).unwrap().light.kelvin()
    }

    #[test]
    fn lights_are_found_as_people_name_them() {
        assert!((kelvin("D65") - 6504.0).abs() < 10.0);
        assert!((kelvin("fl11") - 4000.0).abs() < 20.0);
        assert!((kelvin("2900K") - 2900.0).abs() < 3.0);
        assert!((kelvin("5500k") - 5500.0).abs() < 20.0);
        assert!((kelvin("0.3127, 0.3290") - 6504.0).abs() < 10.0);
        assert!(LightSource::by_name("0.34,0.36").unwrap().spectrum.is_none());
    }

    #[test]
    fn what_is_no_light_is_not_found() {
        for text in ["moon", "90K", "0.9,0.9", "no/such.csv", "nanK"] {
            assert_eq!(LightSource::by_name(text), None, "{text}");
        }
    }
}
