//! `.cube` file: a 3-D table as Adobe, Resolve, ffmpeg and OpenColorIO read it ("Cube LUT Specification 1.0", Adobe
//! 2013).
//!
//! What goes in is balanced camera RGB in 0..=1, by default as its square root: a table over linear numbers has
//! hardly a node in the shadows. The head of the file says what goes in and what comes out.

use std::fmt::Write as _;

use darkroot_colour::{RgbSpace, Vector3, Xyz, white};

use super::grid::{Grid, SIZES};
use super::{CubeFault, CubeLine, Error};
use crate::{Calibration, Profile};

/// How camera RGB is coded before it goes into the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shaper {
    /// Not at all.
    None,
    /// As its square root.
    #[default]
    SquareRoot,
}

impl Shaper {
    fn encode(self, linear: f64) -> f64 {
        match self {
            Self::None => linear,
            Self::SquareRoot => linear.max(0.0).sqrt(),
        }
    }

    fn decode(self, coded: f64) -> f64 {
        match self {
            Self::None => coded,
            Self::SquareRoot => coded * coded,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::None => "balanced camera RGB, linear, 0..1",
            Self::SquareRoot => "square root of balanced camera RGB, 0..1 (linear values to the power 0.5)",
        }
    }
}

/// What the table takes and gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Nodes along each side.
    pub size: usize,
    /// How camera RGB goes in.
    pub shaper: Shaper,
    /// What comes out, coded with the curve of the space.
    pub space: RgbSpace,
}

/// The file for one light.
pub fn write(profile: &Profile, calibration: &Calibration, settings: &Settings) -> String {
    let Settings { size, shaper, space } = *settings;
    let from_xyz = space.from_xyz_under(white::D50);
    let table = Grid::sample(size, |coded| {
        let xyz = calibration.model.xyz(coded.map(|v| shaper.decode(v)));
        let rgb: [f64; 3] = (from_xyz * Vector3::from(xyz)).into();
        rgb.map(|v| space.curve.encode(v))
    });
    let name = plain(&format!("{} under {}", profile.camera().name(), calibration.light.name));
    let mut text = String::new();
    let _ = writeln!(text, "# in:  {}; (1,1,1) is the white of the light", shaper.words());
    let _ = writeln!(text, "# out: {}, 1 for the white", describe(&space));
    let _ = writeln!(text, "TITLE \"{name}\"\nLUT_3D_SIZE {}", table.size());
    text += "DOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n";
    for [r, g, b] in table.first_fastest() {
        let _ = writeln!(text, "{r:.7} {g:.7} {b:.7}");
    }
    text
}

/// A space with its curve in words: "Rec. 2020, linear".
pub(super) fn describe(space: &RgbSpace) -> String {
    let curve = if *space == space.linear() { "linear" } else { "coded with its curve" };
    format!("{}, {curve}", space.name)
}

/// A name without what would end a text in a file: quotes, angles, ampersands, line ends.
pub(super) fn plain(name: &str) -> String {
    name.chars().filter(|c| !c.is_control() && !['"', '<', '>', '&'].contains(c)).collect()
}

/// The table of a `.cube` file over 0..=1.
///
/// # Errors
/// Text that is no such file.
pub fn read(text: &str) -> Result<Grid, Error> {
    let line = |i: usize, wrong: CubeLine| CubeFault::Line { line: i + 1, wrong };
    let mut size = None;
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for (i, text) in text.lines().enumerate() {
        let words: Vec<&str> = text.split_whitespace().take(4).collect();
        match words[..] {
            [] | ["TITLE", ..] | ["DOMAIN_MIN", "0" | "0.0", ..] | ["DOMAIN_MAX", "1" | "1.0", ..] => {}
            [word, ..] if word.starts_with('#') => {}
            ["LUT_3D_SIZE", number] => {
                let number = number.parse().ok().filter(|n| SIZES.contains(n));
                size = Some(number.ok_or_else(|| line(i, CubeLine::Size))?);
            }
            [r, g, b] => {
                let parse = |v: &str| v.parse().map_err(|_| line(i, CubeLine::NotNumbers));
                rows.push([parse(r)?, parse(g)?, parse(b)?]);
            }
            _ => return Err(line(i, CubeLine::Unknown).into()),
        }
    }
    let size: usize = size.ok_or(CubeFault::NoSize)?;
    if rows.len() != size.pow(3) {
        return Err(CubeFault::Rows { rows: rows.len(), wanted: size.pow(3) }.into());
    }
    // In the file the first coordinate varies fastest.
    let turned =
        (0..rows.len()).map(|i| rows[(i % size * size + i / size % size) * size + i / (size * size)]);
    Grid::new(size, turned.collect()).ok_or(CubeFault::NotFinite.into())
}

/// XYZ relative to D50 that a table gives for balanced camera RGB.
pub fn xyz(table: &Grid, settings: &Settings, rgb: [f64; 3]) -> Xyz {
    let out = table.at(rgb.map(|v| settings.shaper.encode(v)));
    let linear = out.map(|v| settings.space.curve.decode(v));
    (settings.space.to_xyz_under(white::D50) * Vector3::from(linear)).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::deviation;
    use crate::export::tests::{calibration, models, profile};

    fn mean(shaper: Shaper, space: RgbSpace) -> f64 {
        let settings = Settings { size: 33, shaper, space };
        let calibration = calibration(models().remove(1));
        let read = read(&write(&profile(vec![calibration.clone()]), &calibration, &settings)).unwrap();
        deviation(&calibration, |rgb| xyz(&read, &settings, rgb)).de2000.mean
    }

    #[test]
    fn what_is_read_back_is_the_model() {
        for space in [RgbSpace::REC2020, RgbSpace::REC2020.linear(), RgbSpace::SRGB] {
            let mean = mean(Shaper::SquareRoot, space);
            assert!(mean < 0.2, "{}: {mean}", space.name);
        }
    }

    #[test]
    fn the_square_root_saves_the_shadows() {
        let space = RgbSpace::REC2020;
        assert!(4.0 * mean(Shaper::SquareRoot, space) < mean(Shaper::None, space));
    }

    #[test]
    fn broken_files_are_errors() {
        let calibration = calibration(models().remove(0));
        let settings = Settings { size: 2, shaper: Shaper::None, space: RgbSpace::SRGB };
        let good = write(&profile(vec![calibration.clone()]), &calibration, &settings);
        assert!(read(&good).is_ok());
        for (from, to) in [
            ("SIZE 2", "SIZE 3"),
            ("SIZE 2", "SIZE 1"),
            ("SIZE 2", "SIZE 99999999999999999999"),
            ("LUT_3D_SIZE 2", ""),
            ("DOMAIN_MAX 1", "DOMAIN_MAX 2"),
            ("LUT_3D_SIZE", "LUT_1D_SIZE"),
            ("\n0.0000000", "\nNaN"),
            ("\n0.0000000", "\nblack"),
            ("\n0.0000000", "\n"),
        ] {
            assert!(good.contains(from), "{from}");
            assert!(read(&good.replacen(from, to, 1)).is_err(), "{from} -> {to}");
        }
    }
}
