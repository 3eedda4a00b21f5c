//! The light that a chart stood in: its name, its chromaticity and, where it is known, its spectrum.

use darkroot_colour::illuminant::{ILLUMINANTS, Illuminant};
use darkroot_colour::spectrum::SAMPLES;
use darkroot_colour::temperature::{Temperature, planckian_xy};
use darkroot_colour::{Spectrum, Xy, white};
use darkroot_profile::Light;

/// Temperature from which a light given in kelvin is taken for daylight, not for a black body.
const DAYLIGHT_FROM: f64 = 4000.0;

/// What the largest power of a spectrum is written as.
const LARGEST_POWER: f64 = 10_000.0;

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
    /// from 4000 K on, black body below), a chromaticity ("0.34,0.36") or a spectrum ([`Self::text`]). `None` where it is none
    /// of these.
    pub fn by_name(text: &str) -> Option<Self> {
        if let Some(known) = Illuminant::by_name(text) {
            return Some(Self::of_spectrum(known.name, known.spectrum()));
        }
        if let Some((name, powers)) = text.rsplit_once('@') {
            return Self::of_powers(name, powers);
        }
        if let Some(kelvin) = text.strip_suffix(['K', 'k']).and_then(|n| n.trim().parse::<f64>().ok()) {
            return Self::of_kelvin(kelvin);
        }
        let (x, y) = text.split_once(',')?;
        Self::of_chromaticity(x.trim().parse().ok()?, y.trim().parse().ok()?)
    }

    /// A text that [`Self::by_name`] reads: the name, `@`, and relative powers at 380, 385 ... 780 nm with commas between
    /// them, as whole numbers of which the largest is 10000. `None` where the spectrum is not known.
    pub fn text(&self) -> Option<String> {
        let powers = &self.spectrum.as_ref()?.0;
        let largest = powers.iter().copied().fold(0.0, f64::max);
        let whole = powers.iter().map(|v| format!("{:.0}", LARGEST_POWER * v / largest));
        Some(format!("{}@{}", self.light.name, whole.collect::<Vec<_>>().join(",")))
    }

    fn of_powers(name: &str, powers: &str) -> Option<Self> {
        let powers: Vec<f64> = powers.split(',').map(|v| v.trim().parse().ok()).collect::<Option<_>>()?;
        let powers: [f64; SAMPLES] = powers.try_into().ok()?;
        let sound = powers.iter().all(|v| (0.0..=LARGEST_POWER).contains(v));
        let spectrum = Spectrum(powers);
        (sound && spectrum.stimulus_xyz().y > 0.0).then(|| Self::of_spectrum(name, spectrum))
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
    fn a_spectrum_comes_back_from_its_text() {
        let lamp = LightSource {
            light: Light { name: "desk@home".to_owned(), xy: white::D50_XY },
            ..LightSource::assumed()
        };
        let back = LightSource::by_name(&lamp.text().unwrap()).unwrap();
        assert_eq!(back.light.name, "desk@home");
        assert!((back.light.kelvin() - 5003.0).abs() < 5.0, "{}", back.light.kelvin());
        let again = back.text().unwrap();
        assert_eq!(Some(again), lamp.text());
    }

    #[test]
    fn what_is_no_light_is_not_found() {
        let dark = format!("lamp@{}", vec!["0"; 81].join(","));
        let bright = format!("lamp@{}", vec!["10001"; 81].join(","));
        for text in [dark.as_str(), bright.as_str(), "lamp@1,2,3", "90K", "0.9,0.9", "no/such.csv", "nanK"] {
            assert_eq!(LightSource::by_name(text), None, "{text}");
        }
    }
}
