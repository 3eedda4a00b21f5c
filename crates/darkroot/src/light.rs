//! Lights as people name them: by a name, a temperature, a chromaticity, or a file with their spectrum.

use std::path::Path;

pub use darkroot_calibrate::LightSource;

use crate::fault::SpectraError;
use crate::shown;
use crate::{Error, spectra};

/// Finds a light: what [`LightSource::by_name`] knows, or a file of spectra ("lamp.csv", and "lamps.csv:NAME" where it has
/// several).
///
/// # Errors
/// None of these, or a file that cannot be used.
pub fn find(text: &str) -> Result<LightSource, Error> {
    LightSource::by_name(text).map_or_else(|| of_file(text), Ok)
}

/// The text with the spectrum in place of the file that it names, so that whoever reads it needs no file; any other text
/// as it is.
///
/// # Errors
/// The file cannot be used.
pub fn without_file(text: &str) -> Result<String, Error> {
    if LightSource::by_name(text).is_some() {
        return Ok(text.to_owned());
    }
    match of_file(text) {
        Err(Error::Light { .. }) => Ok(text.to_owned()),
        light => Ok(light?.text().unwrap_or_else(|| text.to_owned())),
    }
}

/// What a person can name, in words.
pub(crate) fn known() -> String {
    format!("{}; or a CSV file of spectra (lamp.csv, lamps.csv:NAME)", known_names())
}

/// The same without files.
pub(crate) fn known_names() -> String {
    let names: Vec<&str> = LightSource::names().collect();
    format!("{}; a temperature of 1000 to 25000 K (5500K); a chromaticity (0.34,0.36)", names.join(", "))
}

/// Lights by other names that people have for them.
const ALSO: [(&[&str], &str); 7] = [
    (&["daylight", "day", "sun", "sunlight", "flash"], "D55"),
    (&["cloudy", "overcast", "noon"], "D65"),
    (&["shade", "north"], "D75"),
    (&["tungsten", "incandescent", "bulb", "halogen"], "A"),
    (&["tl84"], "FL11"),
    (&["cwf", "coolwhite", "fluorescent"], "FL2"),
    (&["tl83", "u30"], "FL12"),
];

/// The light that a person may have meant.
fn meant(text: &str) -> Option<String> {
    let low = text.trim().to_lowercase().replace(['-', ' '], "");
    let temperature =
        low.parse::<f64>().ok().map(|_| format!("{low}K")).filter(|k| LightSource::by_name(k).is_some());
    let also =
        || ALSO.iter().find(|(names, _)| names.contains(&low.as_str())).map(|(_, name)| (*name).to_owned());
    let near = || crate::nearest(&low, LightSource::names()).map(str::to_owned);
    temperature.or_else(also).or_else(near)
}

/// Whether a text that names no file can only have meant one: it says in which folder, or has an ending of letters.
fn is_file_name(path: &Path) -> bool {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    path.components().count() > 1 || ending.starts_with(|c: char| c.is_ascii_alphabetic())
}

fn of_file(text: &str) -> Result<LightSource, Error> {
    let whole = Path::new(text);
    let (path, name) = match text.rsplit_once(':') {
        Some((path, name)) if !whole.is_file() => (Path::new(path), Some(name)),
        _ => (whole, None),
    };
    if !is_file_name(path) && !path.is_file() {
        return Err(Error::Light { text: text.to_owned(), meant: meant(text) });
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
            let file = shown(path);
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
        for text in ["moon", "90K", "0.9,0.9", "nanK", "A.1"] {
            let message = find(text).unwrap_err().to_string();
            assert!(message.contains("LED-B3") && message.contains(text), "{message}");
        }
        for (text, meant) in [
            ("6500", "6500K"),
            ("daylight", "D55"),
            ("Tungsten", "A"),
            ("TL84", "FL11"),
            ("TL-84", "FL11"),
            ("D56", "D5"),
        ] {
            let message = find(text).unwrap_err().to_string();
            assert!(message.contains("did you mean") && message.contains(meant), "{message}");
        }
        for (names, light) in ALSO {
            assert!(names.iter().all(|name| find(name).is_err()) && find(light).is_ok(), "{light}");
        }
        for text in ["no/such.csv", "lamp.csv", "lamps.csv:two"] {
            let message = find(text).unwrap_err().to_string();
            assert!(message.contains("no such file") && !message.contains("LED-B3"), "{message}");
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
        let inside = without_file(&format!("{text}:two")).unwrap();
        assert!(inside.starts_with("two@10000,10000,"), "{inside}");
        assert_eq!(LightSource::by_name(&inside).unwrap().light.name, "two");
        assert_eq!(without_file("FL11").unwrap(), "FL11");
        assert_eq!(without_file("moon").unwrap(), "moon");
        assert!(find(&text).unwrap_err().to_string().contains("name one"));
        assert!(find(&format!("{text}:three")).unwrap_err().to_string().contains("one, two"));
    }
}
