//! Common LUT Format (Academy S-2014-006, version 3): cube root, 3-D table, cube, matrix.
//!
//! The table holds cube roots of XYZ over cube roots of balanced camera RGB. The model has degree one, and so has
//! what stands between the roots: nearly linear, in the shadows as in the lights, and exact for greys.

use std::fmt::Write as _;

use darkroot_colour::{Matrix3, RgbSpace, Vector3, Xyz, white};

use super::cube::{describe, plain};
use super::grid::{Grid, SIZES};
use super::{ClfFault, Error};
use crate::{Calibration, Profile};

/// The file for one light: balanced camera RGB, 0..=1, to linear RGB of `space`, with a table of `size`^3 nodes.
pub fn write(profile: &Profile, calibration: &Calibration, size: usize, space: &RgbSpace) -> String {
    let table = Grid::sample(size, |coded| {
        let xyz = calibration.model.xyz(coded.map(|v| v * v * v));
        <[f64; 3]>::from(xyz).map(f64::cbrt)
    });
    let name = plain(&format!("{} under {}", profile.camera().name(), calibration.light.name));
    let id: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let out = describe(&space.linear());
    let size = table.size();
    let mut text = format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<ProcessList id="darkroot-{id}" name="{name}" compCLFversion="3">
<Description>Colours of a camera by Darkroot</Description>
<InputDescriptor>balanced camera RGB, linear, 0..1; (1,1,1) is the white of the light</InputDescriptor>
<OutputDescriptor>{out}, 1 for the white</OutputDescriptor>
<Exponent inBitDepth="32f" outBitDepth="32f" style="basicFwd">
<ExponentParams exponent="0.333333333333"/>
</Exponent>
<LUT3D inBitDepth="32f" outBitDepth="32f" interpolation="tetrahedral">
<Description>cube roots of XYZ relative to D50</Description>
<Array dim="{size} {size} {size} 3">
"#
    );
    for [x, y, z] in table.nodes() {
        let _ = writeln!(text, "{x:.7} {y:.7} {z:.7}");
    }
    text += r#"</Array>
</LUT3D>
<Exponent inBitDepth="32f" outBitDepth="32f" style="basicMirrorFwd">
<ExponentParams exponent="3"/>
</Exponent>
<Matrix inBitDepth="32f" outBitDepth="32f">
<Array dim="3 3">
"#;
    for row in space.from_xyz_under(white::D50).row_iter() {
        let _ = writeln!(text, "{:.9} {:.9} {:.9}", row[0], row[1], row[2]);
    }
    text + "</Array>\n</Matrix>\n</ProcessList>\n"
}

/// One step of a file.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    Power(f64),
    Table(Grid),
    Matrix(Matrix3),
}

/// What a file of [`write()`]'s kind says, step by step.
#[derive(Debug, Clone, PartialEq)]
pub struct Clf {
    steps: Vec<Step>,
}

impl Clf {
    /// Reads a file of exponents, 3-D tables and matrices of floats. It reads the elements that [`write()`] writes and
    /// refuses all others; it is no general reader of XML.
    ///
    /// # Errors
    /// Text with anything else in it.
    pub fn read(text: &str) -> Result<Self, Error> {
        let mut steps = Vec::new();
        let mut within = "";
        for piece in text.split('<').skip(1) {
            let (tag, content) = piece.split_once('>').ok_or(ClfFault::OpenTag)?;
            let element = tag.split_whitespace().next().unwrap_or_default();
            let step = match element {
                "Exponent" | "LUT3D" | "Matrix" => {
                    within = element;
                    continue;
                }
                "ExponentParams" => attribute(tag, "exponent").and_then(|v| v.parse().ok()).map(Step::Power),
                "Array" if within == "LUT3D" => table(tag, content).map(Step::Table),
                "Array" => {
                    let numbers = numbers(content).filter(|n| n.len() == 9);
                    numbers.map(|n| Step::Matrix(Matrix3::from_row_slice(&n)))
                }
                "?xml" | "ProcessList" | "Description" | "InputDescriptor" | "OutputDescriptor" => continue,
                _ if element.starts_with('/') => continue,
                _ => return Err(ClfFault::UnknownElement(element.to_owned()).into()),
            };
            steps.push(step.ok_or_else(|| ClfFault::BrokenElement(element.to_owned()))?);
        }
        if steps.is_empty() { Err(ClfFault::NoSteps.into()) } else { Ok(Self { steps }) }
    }

    /// What comes out for balanced camera RGB.
    pub fn apply(&self, rgb: [f64; 3]) -> [f64; 3] {
        self.steps.iter().fold(rgb, |c, step| match step {
            Step::Power(power) => c.map(|v| v.abs().powf(*power).copysign(v)),
            Step::Table(table) => table.at(c),
            Step::Matrix(matrix) => (matrix * Vector3::from(c)).into(),
        })
    }

    /// XYZ relative to D50, where linear RGB of `space` comes out.
    pub fn xyz(&self, space: &RgbSpace, rgb: [f64; 3]) -> Xyz {
        (space.to_xyz_under(white::D50) * Vector3::from(self.apply(rgb))).into()
    }
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = tag.split_once(&format!("{name}=\""))?;
    rest.split('"').next()
}

fn numbers(content: &str) -> Option<Vec<f64>> {
    content.split_whitespace().map(|v| v.parse().ok().filter(|v: &f64| v.is_finite())).collect()
}

fn table(tag: &str, content: &str) -> Option<Grid> {
    let dim = attribute(tag, "dim")?;
    let size: usize = dim.split_whitespace().next()?.parse().ok().filter(|n| SIZES.contains(n))?;
    if dim.split_whitespace().collect::<Vec<_>>().join(" ") != format!("{size} {size} {size} 3") {
        return None;
    }
    let numbers = numbers(content)?;
    (numbers.len() % 3 == 0).then_some(())?;
    Grid::new(size, numbers.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::deviation;
    use crate::export::tests::{calibration, models, profile};

    const SPACE: RgbSpace = RgbSpace::ACES2065_1;

    #[test]
    fn what_is_read_back_is_the_model() {
        for model in models() {
            let calibration = calibration(model);
            let text = write(&profile(vec![calibration.clone()]), &calibration, 33, &SPACE);
            let read = Clf::read(&text).unwrap();
            let found = deviation(&calibration, |rgb| read.xyz(&SPACE, rgb)).de2000;
            assert!(found.mean < 0.1 && found.max < 2.0, "{found:?}");
        }
    }

    #[test]
    fn greys_are_grey_in_the_space() {
        let calibration = calibration(models().remove(1));
        let read = Clf::read(&write(&profile(vec![calibration.clone()]), &calibration, 17, &SPACE)).unwrap();
        for grey in [1.0, 0.3, 0.01, 1e-4] {
            assert!(read.apply([grey; 3]).iter().all(|v| (v - grey).abs() < 1e-5 * grey), "{grey}");
        }
    }

    #[test]
    fn broken_files_are_errors() {
        let calibration = calibration(models().remove(0));
        let good = write(&profile(vec![calibration.clone()]), &calibration, 2, &SPACE);
        assert!(Clf::read(&good).is_ok());
        for (from, to) in [
            ("<Matrix", "<Mystery"),
            ("dim=\"2 2 2 3\"", "dim=\"2 2 3\""),
            ("dim=\"2 2 2 3\"", "dim=\"9 9 9 3\""),
            ("exponent=\"3\"", "exponent=\"three\""),
            ("0.0000000 0.0000000 0.0000000", "0.0000000 0.0000000"),
            ("0.0000000 0.0000000 0.0000000", "0.0000000 NaN 0.0000000"),
            ("</ProcessList>", "</ProcessList"),
        ] {
            assert!(good.contains(from), "{from}");
            assert!(Clf::read(&good.replacen(from, to, 1)).is_err(), "{from} -> {to}");
        }
        assert!(Clf::read("").is_err());
    }
}
