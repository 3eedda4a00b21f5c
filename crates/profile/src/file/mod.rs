//! The profile file: TOML, versioned, readable.
//!
//! ```toml
//! format = "darkroot profile"
//! version = 1
//! white = "(1,1,1) is the white of the light; XYZ relative to D50 by Bradford"
//!
//! [camera]
//! make = "Nikon"
//! model = "D700"
//! aliases = ["NIKON CORPORATION NIKON D700"]
//!
//! [origin]                 # all of it optional: chart, reference, reference_sha256, sensitivities, ...
//! summary = "chart of 24 patches"
//! date = "2026-05-01"
//!
//! [[calibration]]
//! light = "D65"
//! xy = [0.3127, 0.3290]
//! kelvin = 6504            # optional; correlated colour temperature of xy
//! model = "root-2"
//! order = 2                # optional for linear and root-n
//!
//! [calibration.terms]      # a matrix or root polynomial: term = [X, Y, Z], relative to D50
//! r = [0.7, 0.3, 0.0]
//! # ... every term of the order
//! "(rg)^1/2" = [0.01, 0.02, 0.0]
//!
//! [calibration.hue_plane]  # matrices round the hues, row by row, the first for red
//! matrices = [[0.7, 0.2, 0.1, 0.3, 0.7, 0.0, 0.0, 0.1, 0.8]]   # 6, 12, 18 ... of them
//!
//! [calibration.residual]   # bumps over chromaticity: r, g, b where it stands, X, Y, Z that it adds
//! centres = [[0.7, 0.2, 0.1, 0.01, 0.02, 0.0]]
//!
//! [calibration.polynomial] # a plain polynomial: term = [X, Y, Z]
//!
//! [calibration.figures]    # mean, median, 95th percentile, largest
//! training = { de2000 = [0.5, 0.4, 1.2, 1.9], de_uv = [0.9, 0.7, 2.2, 3.0] }
//! leave_one_out = { de2000 = [0.6, 0.5, 1.4, 2.2], de_uv = [1.0, 0.8, 2.6, 3.4] }
//!
//! [[calibration.patch]]
//! name = "dark skin"
//! rgb = [0.11, 0.09, 0.06]
//! xyz = [0.12, 0.10, 0.05]
//! de2000 = 0.4
//! ```
//!
//! A profile that is a camera has version 2 and, instead of calibrations:
//!
//! ```toml
//! [sensitivities]          # 380 to 780 nm every 10 nm: 41 numbers each
//! red = [0.0, 0.001]
//! green = [0.0, 0.002]
//! blue = [0.001, 0.2]
//! expected_de2000 = 1.1    # optional: they are an estimate, and colours are probably off by so much
//!
//! [[sensitivities.held_out]]  # optional, for each light: errors on surfaces that took no part
//! light = "D65"
//! de2000 = [0.5, 0.4, 1.2, 1.9]
//! de_uv = [0.9, 0.7, 2.2, 3.0]
//! ```
//!
//! One of both that says how its maker would show colours, as a DCP does, has version 3 and:
//!
//! ```toml
//! [rendering]
//! exposure = 0.0           # stops
//! curve = [[0.0, 0.0], [0.1, 0.2], [1.0, 1.0]]  # optional: points of a tone curve over linear light
//!
//! [rendering.look]         # optional: a table over hue, saturation and value of linear ProPhoto RGB
//! divisions = [1, 2, 1]    # numbers of hues, saturations and values
//! coded = false            # whether values count as the curve of sRGB has them
//! nodes = [[0.0, 1.0, 1.0], [5.0, 1.1, 1.0]]    # degrees, factor of saturation, factor of value; the saturation fastest
//! ```
//!
//! Which parts a model has follows from its name; see [`crate::Kind`].

mod fault;
pub use fault::{CalibrationFault, SensitivitiesFault};

mod read;
mod rendering;
mod write;

pub use read::parse;
pub use write::format;

/// What can be wrong with a profile file. Each message completes "FILE: ".
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Not TOML, or not with the fields of a profile.
    #[error("is not a Darkroot profile: {detail}")]
    Syntax {
        /// What the reader says, with the line.
        detail: String,
    },
    /// Another version of the format.
    #[error(
        "has version {found} of the profile format, this program reads versions 1 to 3; get a newer Darkroot"
    )]
    Version {
        /// The version in the file.
        found: i64,
    },
    /// Another convention for white than this program's.
    #[error("has the white convention `{found}`, which this program does not know; get a newer Darkroot")]
    White {
        /// The convention in the file.
        found: String,
    },
    /// A calibration with something missing or impossible.
    #[error("has an unusable calibration for {light}: {source}")]
    Calibration {
        /// Name of the light.
        light: String,
        /// What is wrong.
        source: CalibrationFault,
    },
    /// Sensitivities that cannot be those of a camera.
    #[error("has unusable sensitivities: {0}")]
    Sensitivities(SensitivitiesFault),
    /// A rendering that cannot be.
    #[error(
        "has an unusable [rendering]: its curve or its table is in disorder, or a value is no finite number"
    )]
    Rendering,
    /// No calibration at all.
    #[error("has neither a [[calibration]] nor [sensitivities]; a profile needs one of both")]
    Empty,
    /// Both.
    #[error("has a [[calibration]] and [sensitivities]; a profile has one of both")]
    Both,
}

/// First line of every profile.
const FORMAT: &str = "darkroot profile";
const VERSION: i64 = 1;
/// Version of a profile that is a camera.
const CAMERA_VERSION: i64 = 2;
/// Version of a profile, of either kind, that says how its maker would show colours.
const RENDERING_VERSION: i64 = 3;
/// What balanced RGB and XYZ mean in every profile of this version.
const WHITE: &str = "(1,1,1) is the white of the light; XYZ relative to D50 by Bradford";

#[cfg(test)]
mod tests {
    use darkroot_colour::{Matrix3, Xyz};

    use super::*;
    use crate::samples_for_tests::all_parts;
    use crate::*;

    fn calibration(name: &str, xy: darkroot_colour::Xy, kind: Kind, model: Model) -> Calibration {
        let summary = |k: f64| Summary { mean: k / 3.0, median: k / 7.0, p95: k * 1.1, max: k * 2e-9 };
        let errors = |k: f64| Errors { de2000: summary(k), de_uv: summary(k + 0.1) };
        Calibration {
            light: Light { name: name.into(), xy },
            kind,
            model,
            figures: Figures {
                training: Some(errors(0.3)),
                leave_one_out: Some(errors(0.4)),
                held_out: None,
            },
            patches: vec![Patch {
                name: "dark \"skin\"".into(),
                rgb: [0.1, 1.0 / 3.0, 1e-5],
                xyz: Xyz::new(0.1, 0.7, -0.0),
                de2000: 0.4,
            }],
        }
    }

    fn sample() -> Profile {
        let camera =
            ProfileCamera { make: "Nikon".into(), model: "D\"700".into(), aliases: vec!["x".into()] };
        let root = RootPolynomial::new(
            Order::Four,
            (0..22).map(|i| [0.1 + f64::from(i) / 3.0, 1e-17, -2.5e8]).collect(),
        );
        let matrix = Matrix3::new(0.7, 1.0 / 3.0, 0.1, 0.3, 0.7, 0.0, 1e-9, 0.1, 0.8);
        let parts = all_parts();
        let chromatic = Model { root: None, ..parts[4].clone() };
        let half = Model { residual: None, ..parts[4].clone() };
        let calibrations = vec![
            calibration("D75", darkroot_colour::Xy::new(0.29902, 0.31485), Kind::Chromatic, chromatic),
            calibration("D65", darkroot_colour::white::D65_XY, Kind::Root(Order::Four), root.unwrap().into()),
            calibration("D50", darkroot_colour::white::D50_XY, Kind::Half, half),
            calibration("B", darkroot_colour::Xy::new(0.38, 0.38), Kind::Polynomial(4), parts[3].clone()),
            calibration("A", darkroot_colour::white::A_XY, Kind::Linear, Model::linear(&matrix)),
        ];
        let origin = Origin { summary: "a test".into(), date: "2026-05-01".into(), ..Origin::default() };
        Profile::new(camera, calibrations, origin).unwrap()
    }

    #[test]
    fn a_profile_survives_its_file_to_the_last_bit() {
        let read = parse(&format(&sample())).unwrap();
        assert_eq!(read, sample());
        // Equality takes -0 for 0; the text does not.
        assert_eq!(format(&read), format(&sample()));
    }

    #[test]
    fn how_its_maker_would_show_colours_survives_too() {
        let nodes = (0..12).map(|i| [0.1 * i as f32, 1.0 + 1e-7, 1.0 / 3.0]).collect();
        let rendering = Rendering {
            exposure: -0.35,
            table: LookTable::new([2, 3, 2], true, nodes),
            curve: ToneCurve::new(vec![[0.0, 0.0], [1.0 / 3.0, 0.5], [1.0, 1.0]]),
        };
        assert!(rendering.table.is_some() && rendering.curve.is_some());
        let profile = sample().rendered_by(Some(rendering.into()));
        let text = format(&profile);
        assert!(text.contains("version = 3"));
        assert_eq!(parse(&text).unwrap(), profile);
        assert_eq!(parse(&text.replacen("[2, 3, 2]", "[2, 3, 3]", 1)), Err(Error::Rendering));
        assert_eq!(sample().rendered_by(Some(Rendering::default().into())), sample());
    }

    #[test]
    fn faults_are_named() {
        let good = format(&sample());
        for (from, to, word) in [
            ("version = 1", "version = 7", "version 7"),
            ("darkroot profile", "picture style", "picture style"),
            ("by Bradford", "by magic", "by magic"),
            ("[camera]", "[camera]\ncolour = 1", "colour"),
            ("model = \"root-4\"", "model = \"root-9\"", "root-9"),
            ("model = \"root-4\"", "model = \"root-2\"", "does not have the parts"),
            ("\"(rg)^1/2\"", "\"(rg)^1/7\"", "missing"),
            ("order = 4", "order = 2", "does not belong"),
            ("order = 4", "order = 5", "order 5"),
            ("-250000000.0", "nan", "not a finite number"),
            ("0.3127", "-0.3127", "chromaticity"),
            ("kelvin = 650", "kelvin = 550", "colour temperature"),
            ("make =", "maker =", "maker"),
            ("rgb = [0.1,", "rgb = [nan,", "not a finite number"),
            ("matrices = [\n", "matrices = [\n[0.0, 1.0],\n", "9 numbers"),
        ] {
            assert!(good.contains(from), "{from}");
            let message = parse(&good.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(message.contains(word), "{from} -> {to}: {message}");
        }
        let head = good.split("\n[[").next().unwrap();
        assert_eq!(parse(head), Err(Error::Empty));
    }
}
