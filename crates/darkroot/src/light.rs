//! Lights as people name them.

use std::path::Path;

use darkroot_colour::illuminant::{ILLUMINANTS, Illuminant};
use darkroot_colour::temperature::planckian_xy;
use darkroot_colour::{Spectrum, Xy};
use darkroot_profile::Light;

use crate::{Error, spectra};

/// Temperature from which a light given in kelvin is taken for daylight, not for a black body.
const DAYLIGHT_FROM: f64 = 4000.0;

/// A light that a person named.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedLight {
    /// Name and chromaticity.
    pub light: Light,
    /// Relative power, where it is known.
    pub spectrum: Option<Spectrum>,
}

/// Finds a light: the name of a CIE illuminant ("D65", "A", "FL11", "LED-B3"), a temperature ("5500K": daylight from
/// 4000 K on, black body below), a chromaticity ("0.34,0.36"), or a file of spectra ("lamp.csv", and
/// "lamps.csv:NAME" where it has several).
///
/// # Errors
/// None of these, or a file that cannot be used.
pub fn find(text: &str) -> Result<NamedLight, Error> {
    if let Some(known) = Illuminant::by_name(text) {
        return Ok(of_spectrum(known.name, known.spectrum()));
    }
    if let Some(kelvin) = text.strip_suffix(['K', 'k']).and_then(|n| n.trim().parse::<f64>().ok()) {
        return of_kelvin(kelvin).ok_or_else(|| unknown(text));
    }
    if let Some((x, y)) = text.split_once(',')
        && let (Ok(x), Ok(y)) = (x.trim().parse::<f64>(), y.trim().parse::<f64>())
    {
        let sound = x > 0.0 && y > 0.0 && x + y < 1.0;
        let light = Light { name: format!("xy {x},{y}"), xy: Xy::new(x, y) };
        return if sound { Ok(NamedLight { light, spectrum: None }) } else { Err(unknown(text)) };
    }
    of_file(text)
}

fn unknown(text: &str) -> Error {
    let names: Vec<&str> = ILLUMINANTS.iter().map(|i| i.name).collect();
    Error::Light {
        text: text.to_owned(),
        names: format!(
            "{}; a temperature of 1000 to 25000 K (5500K); a chromaticity (0.34,0.36); or a CSV file of spectra \
             (lamp.csv, lamps.csv:NAME)",
            names.join(", ")
        ),
    }
}

fn of_spectrum(name: &str, spectrum: Spectrum) -> NamedLight {
    let white = spectrum.white();
    let sum = white.x + white.y + white.z;
    let light = Light { name: name.to_owned(), xy: Xy::new(white.x / sum, white.y / sum) };
    NamedLight { light, spectrum: Some(spectrum) }
}

fn of_kelvin(kelvin: f64) -> Option<NamedLight> {
    if !(1000.0..=25_000.0).contains(&kelvin) {
        return None;
    }
    let name = format!("{kelvin:.0} K");
    if kelvin >= DAYLIGHT_FROM {
        return Some(of_spectrum(&name, Spectrum::daylight(kelvin)));
    }
    let body = of_spectrum(&name, Spectrum::black_body(kelvin));
    // The exact locus, so that the temperature comes back as it was given.
    Some(NamedLight { light: Light { name, xy: planckian_xy(kelvin) }, ..body })
}

fn of_file(text: &str) -> Result<NamedLight, Error> {
    let whole = Path::new(text);
    let (path, name) = match text.rsplit_once(':') {
        Some((path, name)) if !whole.is_file() => (Path::new(path), Some(name)),
        _ => (whole, None),
    };
    if !path.is_file() {
        return Err(unknown(text));
    }
    let lights = spectra::read(path)?.lights();
    let wrong = |what: String| Error::Spectra { path: path.to_owned(), what };
    let (name, spectrum) = match (name, lights.as_slice()) {
        (None, [only]) => only,
        (Some(name), all) => all
            .iter()
            .find(|(n, _)| n == name)
            .ok_or_else(|| wrong(format!("has no light `{name}`; it has {}", list(all))))?,
        (None, all) => {
            let first = all.first().map_or("NAME", |(n, _)| n.as_str());
            return Err(wrong(format!(
                "has {} lights ({}); name one: {}:{first}",
                all.len(),
                list(all),
                path.display()
            )));
        }
    };
    let luminous = spectrum.stimulus_xyz().y > 0.0;
    if !luminous {
        return Err(wrong(format!("`{name}` has no luminance; give the relative power of a light")));
    }
    Ok(of_spectrum(name, spectrum.clone()))
}

fn list(lights: &[(String, Spectrum)]) -> String {
    const MOST: usize = 8;
    let names: Vec<&str> = lights.iter().take(MOST).map(|(n, _)| n.as_str()).collect();
    names.join(", ") + if lights.len() > MOST { ", ..." } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kelvin(text: &str) -> f64 {
        find(text).unwrap().light.kelvin()
    }

    #[test]
    fn lights_are_found_as_people_name_them() {
        assert!((kelvin("D65") - 6504.0).abs() < 10.0);
        assert!((kelvin("fl11") - 4000.0).abs() < 20.0);
        assert!((kelvin("2900K") - 2900.0).abs() < 3.0);
        assert!((kelvin("5500k") - 5500.0).abs() < 20.0);
        assert!((kelvin("0.3127, 0.3290") - 6504.0).abs() < 10.0);
        assert!(find("0.34,0.36").unwrap().spectrum.is_none());
    }

    #[test]
    fn what_is_no_light_is_said() {
        for text in ["moon", "90K", "0.9,0.9", "no/such.csv", "nanK"] {
            let message = find(text).unwrap_err().to_string();
            assert!(message.contains("LED-B3") && message.contains(text), "{message}");
        }
    }

    #[test]
    fn a_lamp_of_a_file_is_found_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lamps.csv");
        let nm: Vec<String> = (380..=780).step_by(10).map(|n| n.to_string()).collect();
        let flat = vec!["1"; nm.len()].join(",");
        std::fs::write(&path, format!("name,{}\none,{flat}\ntwo,{flat}\n", nm.join(","))).unwrap();
        let text = path.display().to_string();
        let named = find(&format!("{text}:two")).unwrap();
        assert_eq!(named.light.name, "two");
        assert!((named.light.xy.x - 1.0 / 3.0).abs() < 1e-4);
        assert!(find(&text).unwrap_err().to_string().contains("name one"));
        assert!(find(&format!("{text}:three")).unwrap_err().to_string().contains("one, two"));
    }
}
