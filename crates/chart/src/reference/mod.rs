//! What the patches of a chart really are: reference files of makers, instruments and other programs.

mod cgats;
mod cxf;
mod photographed;
mod sequence;
mod table;

pub use photographed::{PhotographedPatch, photographed};
pub use sequence::Sequence;

use darkroot_colour::measured::{Measured, SpectrumError};
use darkroot_colour::{Lab, Spectrum, Xyz, white};

/// The colours of one chart, patch by patch.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Name and colour of each patch, in the sequence of the file.
    pub patches: Vec<(String, ReferenceColour)>,
}

/// What is known of a patch.
#[derive(Debug, Clone, PartialEq)]
pub enum ReferenceColour {
    /// Its spectral reflectance, 0..=1.
    Reflectance(Measured),
    /// Its XYZ under D50, Y = 1 for the perfect diffuser.
    Xyz(Xyz),
    /// Its CIELAB under D50.
    Lab(Lab),
}

/// Why a text is no reference, or not that of a chart. Each message completes "FILE: ".
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// None of the formats.
    #[error("is no reference file: {0}; known are CGATS (.txt, .cie, .ti2, .ti3), CxF 3 and CSV")]
    Format(#[from] NotAReference),
    /// A table with neither Lab nor XYZ nor spectra.
    #[error(
        "has no colours: its columns are {}; it needs LAB_L, LAB_A, LAB_B, or XYZ_X, XYZ_Y, XYZ_Z, or spectra",
        .0.join(", ")
    )]
    Columns(Vec<String>),
    /// A table without what a camera made of the patches.
    #[error("has no camera RGB: its columns are {}; it needs RGB_R, RGB_G, RGB_B", .0.join(", "))]
    NoRgb(Vec<String>),
    /// CxF without colours.
    #[error("has no colours: it needs an Object with a ReflectanceSpectrum, ColorCIEXYZ or ColorCIELab")]
    NoColours,
    /// A cell that should be a number is none.
    #[error("patch {patch}: `{cell}` is not a number")]
    Number {
        /// Name of the patch.
        patch: String,
        /// What stands there.
        cell: String,
    },
    /// A colour that no surface has.
    #[error("patch {patch}: {fault}")]
    Colour {
        /// Name of the patch.
        patch: String,
        /// What is impossible about it.
        fault: ImpossibleColour,
    },
    /// A spectrum that cannot be used.
    #[error("patch {patch}: {source}")]
    Spectrum {
        /// Name of the patch.
        patch: String,
        /// What is wrong.
        source: SpectrumError,
    },
    /// The chart has patches that the reference has not.
    #[error(
        "has no patch {missing} (it has {have} patches, the chart {need}); is it the reference of another chart?"
    )]
    Missing {
        /// Name of the first missing patch.
        missing: String,
        /// Patches of the reference.
        have: usize,
        /// Patches of the chart.
        need: usize,
    },
    /// The colours are not those of the chart.
    #[error(
        "its colours are not those of {chart} (mean dE2000 {off:.0} from what such a chart has); is it the reference of \
         another chart, or turned?"
    )]
    OtherChart {
        /// Title of the chart.
        chart: String,
        /// Mean difference.
        off: f64,
    },
}

/// Why a text is of none of the formats.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotAReference {
    /// CGATS without names of its columns.
    #[error("it has no BEGIN_DATA_FORMAT")]
    NoDataFormat,
    /// CGATS without rows.
    #[error("it has no data between BEGIN_DATA and END_DATA")]
    NoData,
    /// CGATS with a last row that is too short, or the like.
    #[error("{values} values do not fill rows of {columns} columns")]
    Rows {
        /// Cells of the table.
        values: usize,
        /// Cells of a row.
        columns: usize,
    },
    /// Broken XML.
    #[error(transparent)]
    Xml(roxmltree::Error),
    /// XML with elements inside elements, deeper than in any CxF.
    #[error("its XML is nested too deep")]
    Deep,
    /// XML with more attributes or name spaces than any CxF.
    #[error("its XML has too many attributes")]
    Crowded,
    /// XML of something else.
    #[error("its XML is `{element}`, not `CxF`")]
    OtherXml {
        /// Name of the outermost element.
        element: String,
    },
    /// No first line, or one without delimiters.
    #[error("its first line names no columns")]
    NoColumns,
    /// Broken CSV.
    #[error("{message}")]
    Csv {
        /// What the reader of CSV says.
        message: String,
    },
    /// Columns and nothing below.
    #[error("it has no patches")]
    NoPatches,
}

/// Why a colour is that of no surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImpossibleColour {
    /// An X, Y or Z below zero.
    #[error("XYZ is negative; are these columns Lab?")]
    NegativeXyz,
    /// More light than a perfect white reflects.
    #[error("XYZ is brighter than a perfect white; give Y from 0 to 1 or from 0 to 100")]
    BrighterThanWhite,
    /// L* below 0 or above 100.
    #[error("L* must lie between 0 and 100")]
    Lightness,
    /// Too colourful.
    #[error("a* and b* are larger than those of any surface")]
    Chroma,
    /// A spectrum that does not say where it begins or how far its values are apart.
    #[error("its spectrum has no start wavelength and increment")]
    NoWavelengths,
    /// A reflectance below 0 or above 1.
    #[error("a reflectance lies outside of 0 to 1 (or of 0 to 100 %)")]
    Reflectance,
}

impl ReferenceColour {
    /// The reflectance on the grid of [`Spectrum`], where it is known.
    pub fn spectrum(&self) -> Option<Spectrum> {
        match self {
            Self::Reflectance(measured) => {
                let smooth = measured.smooth().unwrap_or_else(|| measured.spectrum());
                Some(Spectrum(smooth.0.map(|v| v.clamp(0.0, 1.0))))
            }
            Self::Xyz(_) | Self::Lab(_) => None,
        }
    }

    /// XYZ under D50 for the CIE 1931 observer, Y = 1 for the perfect diffuser.
    pub fn xyz_d50(&self) -> Xyz {
        match self {
            Self::Reflectance(_) => {
                self.spectrum().map_or_else(Xyz::default, |s| s.reflected_xyz(&Spectrum::daylight(5003.0)))
            }
            Self::Xyz(xyz) => *xyz,
            Self::Lab(lab) => lab.xyz(white::D50),
        }
    }
}

impl Reference {
    /// Reads a reference: CGATS.17 and Argyll's `.cie`, `.ti2`, `.ti3`, CxF 3, or CSV with a header.
    ///
    /// # Errors
    /// Another format, columns that hold no colours, values that are no numbers or no colours of surfaces.
    pub fn parse(text: &str) -> Result<Self, ReferenceError> {
        let text = text.trim_start_matches('\u{feff}');
        if text.trim_start().starts_with('<') {
            return cxf::parse(text);
        }
        parse_table(text)?.reference()
    }

    /// The colours of the patches of a chart, found by name: "A1" is "A01" and "a1", "white 9.5 (.05 D)" is "white".
    ///
    /// # Errors
    /// Patches that the reference does not have.
    pub fn for_patches(&self, names: &[&str]) -> Result<Vec<ReferenceColour>, ReferenceError> {
        let find = |name: &str| {
            let wanted = key(name);
            let of = |plain: fn(&str) -> String| self.patches.iter().find(|(n, _)| plain(n) == wanted);
            of(key).or_else(|| of(short_key)).map(|(_, colour)| colour.clone())
        };
        let missing = |name: &str| ReferenceError::Missing {
            missing: name.to_owned(),
            have: self.patches.len(),
            need: names.len(),
        };
        names.iter().map(|name| find(name).ok_or_else(|| missing(name))).collect()
    }
}

/// A table of any kind: CGATS or CSV.
fn parse_table(text: &str) -> Result<table::Table, ReferenceError> {
    let is_cgats = text.contains("BEGIN_DATA_FORMAT") || text.contains("BEGIN_DATA");
    if is_cgats { cgats::parse(text) } else { table::parse_csv(text) }
}

/// A key without what stands in brackets, and, for white and black, without their number.
fn short_key(name: &str) -> String {
    let plain = key(name.split(['(', '[']).next().unwrap_or_default());
    let bare = plain.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
    if matches!(bare, "white" | "black") { bare.to_owned() } else { plain }
}

/// A patch name without what people write differently: case, blanks, leading zeros of numbers.
fn key(name: &str) -> String {
    let plain: String = name.chars().filter(|c| c.is_alphanumeric() || *c == '.').collect();
    let letters: String =
        plain.chars().take_while(|c| c.is_alphabetic()).flat_map(char::to_lowercase).collect();
    let rest: String = plain.chars().skip_while(|c| c.is_alphabetic()).collect();
    letters + rest.trim_start_matches('0')
}

/// Checks that values can be the XYZ of a surface.
fn checked_xyz(patch: &str, xyz: Xyz) -> Result<ReferenceColour, ReferenceError> {
    let fault = |fault| ReferenceError::Colour { patch: patch.to_owned(), fault };
    if xyz.x < -1e-3 || xyz.y < -1e-3 || xyz.z < -1e-3 {
        return Err(fault(ImpossibleColour::NegativeXyz));
    }
    if xyz.y > 1.3 || xyz.x > 1.5 || xyz.z > 1.7 {
        return Err(fault(ImpossibleColour::BrighterThanWhite));
    }
    Ok(ReferenceColour::Xyz(xyz))
}

/// Checks that values can be the Lab of a surface.
fn checked_lab(patch: &str, lab: Lab) -> Result<ReferenceColour, ReferenceError> {
    let fault = |fault| ReferenceError::Colour { patch: patch.to_owned(), fault };
    if !(-0.5..=105.0).contains(&lab.l) {
        return Err(fault(ImpossibleColour::Lightness));
    }
    if lab.chroma() > 180.0 {
        return Err(fault(ImpossibleColour::Chroma));
    }
    Ok(ReferenceColour::Lab(lab))
}

fn checked_reflectance(
    patch: &str,
    wavelengths: &[f64],
    values: &[f64],
) -> Result<ReferenceColour, ReferenceError> {
    if values.iter().any(|v| *v < -0.02 || *v > 1.5) {
        let fault = ImpossibleColour::Reflectance;
        return Err(ReferenceError::Colour { patch: patch.to_owned(), fault });
    }
    Measured::new(wavelengths, values)
        .map(ReferenceColour::Reflectance)
        .map_err(|source| ReferenceError::Spectrum { patch: patch.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_are_found_however_they_are_written() {
        let lab = |l: f64| ReferenceColour::Lab(Lab { l, a: 0.0, b: 0.0 });
        let reference = Reference { patches: vec![("A01".into(), lab(1.0)), ("b 12".into(), lab(2.0))] };
        assert_eq!(reference.for_patches(&["a1", "B12"]).unwrap(), [lab(1.0), lab(2.0)]);
        assert!(reference.for_patches(&["A1", "C1"]).unwrap_err().to_string().contains("no patch C1"));
        assert!(reference.for_patches(&["x", "y"]).is_err());
        let names = ["White 9.5 (.05 D)", "neutral 8 (.23 D)", "Black 2 (1.5 D)"];
        let reference = Reference { patches: names.map(|n| (n.to_owned(), lab(n.len() as f64))).to_vec() };
        assert!(reference.for_patches(&["white", "neutral 8", "black"]).is_ok());
    }
}
