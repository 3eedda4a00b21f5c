//! Lights as people name them: by a name, a temperature, a chromaticity, or a file with their spectrum.

use std::path::Path;

pub use darkroot_calibrate::LightSource;

use crate::fault::SpectraError;
use crate::{Error, spectra};

/// Finds a light: what [`LightSource::by_name`] knows, or a file of spectra ("lamp.csv", and "lamps.csv:NAME" where it has
/// several).
///
/// # Errors
/// None of these, or a file that cannot be used.
pub fn find(text: &str) -> Result<LightSource, Error> {
    LightSource::by_name(text).map_or_else(|| of_file(text), Ok)
}

/// What a person can name, in words.
pub(crate) fn known() -> String {
    let names: Vec<&str> = LightSource::names().collect();
    format!(
        "{}; a temperature of 1000 to 25000 K (5500K); a chromaticity (0.34,0.36); or a CSV file of spectra (lamp.csv, \
         lamps.csv:NAME)",
        names.join(", ")
    )
}

fn of_file(text: &str) -> Result<LightSource, Error> {
    let whole = Path::new(text);
    let (path, name) = match text.rsplit_once(':') {
        Some((path, name)) if !whole.is_file() => (Path::new(path), Some(name)),
        _ => (whole, None),
    };
    if !path.is_file() {
        return Err(Error::Light { text: text.to_owned() });
    }
    let lights = spectra::read(path)?.lights();
    let wrong = |fault: SpectraError| Error::spectra(path, fault);
    let names = || lights.iter().map(|(n, _)| n.clone()).collect();
    let (name, spectrum) = match (name, lights.as_slice()) {
        (None, [only]) => only,
        (Some(name), all) => all
            .iter()
            .find(|(n, _)| n == name)
            .ok_or_else(|| wrong(SpectraError::NoLight { name: name.to_owned(), names: names() }))?,
        (None, _) => {
            let file = path.display().to_string();
            return Err(wrong(SpectraError::SeveralLights { file, names: names() }));
        }
    };
    let luminous = spectrum.stimulus_xyz().y > 0.0;
    if !luminous {
        return Err(wrong(SpectraError::Dark { name: name.clone() }));
    }
    Ok(LightSource::of_spectrum(name, spectrum.clone()))
}

#[cfg(test)]
mod tests {
    use super::*;

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
