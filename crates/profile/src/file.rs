//! The profile file: TOML, versioned, readable.
//!
//! ```toml
//! format = "darkroot profile"
//! version = 1
//! origin = "chart of 24 patches, 2026-05-01"
//!
//! [camera]
//! make = "Nikon"
//! model = "D700"
//! aliases = ["NIKON CORPORATION NIKON D700"]
//!
//! [[calibration]]
//! light = "D65"
//! xy = [0.3127, 0.3290]
//! model = "root-2"
//!
//! [calibration.terms]      # term = [X, Y, Z], relative to D50
//! r = [0.7, 0.3, 0.0]
//! # ... every term of the order
//! "(rg)^1/2" = [0.01, 0.02, 0.0]
//! ```

use std::collections::BTreeMap;
use std::fmt::Write;

use colour::Xy;
use serde::Deserialize;

use crate::{Calibration, Light, Model, Order, Profile, ProfileCamera};

/// What can be wrong with a profile file. Each message completes "FILE: ".
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Not TOML, or not with the fields of a profile.
    #[error("is not a Darkroot profile: {detail}")]
    Syntax {
        /// What the reader says, with the line.
        detail: String,
    },
    /// Another version of the format.
    #[error("has version {found} of the profile format, this program reads version 1; get a newer Darkroot")]
    Version {
        /// The version in the file.
        found: i64,
    },
    /// A calibration with something missing or impossible.
    #[error("has an unusable calibration for {light}: {what}")]
    Calibration {
        /// Name of the light.
        light: String,
        /// What is wrong.
        what: String,
    },
    /// No calibration at all.
    #[error("has no [[calibration]]; a profile needs at least one light")]
    Empty,
}

/// First line of every profile.
const FORMAT: &str = "darkroot profile";
const VERSION: i64 = 1;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: i64,
    #[serde(default)]
    origin: String,
    camera: CameraTable,
    #[serde(default)]
    calibration: Vec<CalibrationTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraTable {
    make: String,
    model: String,
    #[serde(default)]
    aliases: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CalibrationTable {
    light: String,
    xy: [f64; 2],
    model: String,
    terms: BTreeMap<String, [f64; 3]>,
}

/// Only what tells a profile of another version from a file that is none.
#[derive(Deserialize)]
struct Head {
    format: String,
    version: i64,
}

/// Reads a profile from the text of its file.
///
/// # Errors
/// Wrong syntax, unknown fields, another version, missing or extra terms, values that are not finite.
pub fn parse(text: &str) -> Result<Profile, Error> {
    let syntax = |e: toml::de::Error| Error::Syntax { detail: e.to_string().trim_end().replace('\n', " ") };
    let head: Head = toml::from_str(text).map_err(syntax)?;
    if head.format != FORMAT {
        return Err(Error::Syntax { detail: format!("its format is `{}`, not `{FORMAT}`", head.format) });
    }
    if head.version != VERSION {
        return Err(Error::Version { found: head.version });
    }
    let file: File = toml::from_str(text).map_err(syntax)?;
    debug_assert!(file.format == FORMAT && file.version == VERSION);
    let calibrations = file.calibration.into_iter().map(calibration).collect::<Result<Vec<_>, _>>()?;
    let camera =
        ProfileCamera { make: file.camera.make, model: file.camera.model, aliases: file.camera.aliases };
    Profile::new(camera, calibrations, file.origin).ok_or(Error::Empty)
}

fn calibration(table: CalibrationTable) -> Result<Calibration, Error> {
    let wrong = |what: String| Error::Calibration { light: table.light.clone(), what };
    let [x, y] = table.xy;
    if !(x > 0.0 && y > 0.0 && x + y < 1.0) {
        return Err(wrong(format!("xy = [{x}, {y}] is no chromaticity of a light")));
    }
    let order = match table.model.as_str() {
        "linear" => Order::One,
        "root-2" => Order::Two,
        "root-3" => Order::Three,
        "root-4" => Order::Four,
        other => return Err(wrong(format!("model `{other}` is not linear, root-2, root-3 or root-4"))),
    };
    let mut terms = table.terms.clone();
    let coefficients = order
        .terms()
        .iter()
        .map(|term| {
            terms.remove(&term.name()).ok_or_else(|| wrong(format!("term `{}` is missing", term.name())))
        })
        .collect::<Result<Vec<_>, _>>()?;
    if let Some(extra) = terms.keys().next() {
        return Err(wrong(format!("term `{extra}` does not belong to {}", table.model)));
    }
    let model =
        Model::new(order, coefficients).ok_or_else(|| wrong("a coefficient is not a number".into()))?;
    Ok(Calibration { light: Light { name: table.light.clone(), xy: Xy::new(x, y) }, model })
}

/// The text of a profile's file. [`parse`] gives the same profile back, to the last bit.
pub fn format(profile: &Profile) -> String {
    let quoted = |s: &str| toml::Value::String(s.to_owned()).to_string();
    let camera = profile.camera();
    let aliases: Vec<String> = camera.aliases.iter().map(|a| quoted(a)).collect();
    let mut text = format!(
        "format = {}\nversion = {VERSION}\norigin = {}\n\n[camera]\nmake = {}\nmodel = {}\naliases = [{}]\n",
        quoted(FORMAT),
        quoted(profile.origin()),
        quoted(&camera.make),
        quoted(&camera.model),
        aliases.join(", "),
    );
    for calibration in profile.calibrations() {
        let model = match calibration.model.order() {
            Order::One => "linear",
            Order::Two => "root-2",
            Order::Three => "root-3",
            Order::Four => "root-4",
        };
        let Light { name, xy } = &calibration.light;
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "\n[[calibration]]\nlight = {}\nxy = [{:?}, {:?}]\nmodel = {}\n\n[calibration.terms]\n",
            quoted(name),
            xy.x,
            xy.y,
            quoted(model)
        );
        for (term, [x, y, z]) in calibration.model.terms() {
            let _ = writeln!(text, "{} = [{x:?}, {y:?}, {z:?}]", quoted(&term.name()));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Profile {
        let camera =
            ProfileCamera { make: "Nikon".into(), model: "D\"700".into(), aliases: vec!["x".into()] };
        let model = |order: Order| {
            let coefficients =
                (0..order.terms().len()).map(|i| [0.1 + i as f64 / 3.0, 1e-17, -2.5e8]).collect();
            Model::new(order, coefficients).unwrap()
        };
        let light = |name: &str, xy| Light { name: name.into(), xy };
        let calibrations = vec![
            Calibration { light: light("D65", colour::white::D65_XY), model: model(Order::Four) },
            Calibration { light: light("A", colour::white::A_XY), model: model(Order::One) },
        ];
        Profile::new(camera, calibrations, "a test".into()).unwrap()
    }

    #[test]
    fn a_profile_survives_its_file_to_the_last_bit() {
        assert_eq!(parse(&format(&sample())).unwrap(), sample());
    }

    #[test]
    fn faults_are_named() {
        let good = format(&sample());
        for (from, to, word) in [
            ("version = 1", "version = 7", "version 7"),
            ("darkroot profile", "picture style", "picture style"),
            ("[camera]", "[camera]\ncolour = 1", "colour"),
            ("root-4", "root-9", "root-9"),
            ("root-4", "root-2", "does not belong"),
            ("\"(rg)^1/2\"", "\"(rg)^1/7\"", "missing"),
            ("-250000000.0", "nan", "not a number"),
            ("0.3127", "-0.3127", "chromaticity"),
            ("make =", "maker =", "maker"),
        ] {
            assert!(good.contains(from), "{from}");
            let message = parse(&good.replace(from, to)).unwrap_err().to_string();
            assert!(message.contains(word), "{from} -> {to}: {message}");
        }
        let head = good.split("\n[[").next().unwrap();
        assert_eq!(parse(head), Err(Error::Empty));
    }
}
