//! What can be wrong with a shot of a chart, a file of spectra, a camera's neutrals. Each message completes "FILE: ".

use darkroot_calibrate::{Gate, ShotError};
use darkroot_chart::Refusal;
use darkroot_chart::layout::LayoutError;
use darkroot_chart::reference::ReferenceError;
use darkroot_colour::measured::SpectrumError;

use crate::quoted;

/// Why a shot, a chart or a reference cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChartError {
    /// The name is neither that of a chart nor of a file.
    #[error("is no chart; known are {}, or a file that describes one", crate::charts::names())]
    UnknownChart,
    /// A file that describes no chart.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// No reference is built in for the chart.
    #[error(
        "has no built-in reference; give one (a file, or {})",
        darkroot_chart::builtin_reference::names().collect::<Vec<_>>().join(", ")
    )]
    NoReference,
    /// A reference that is no text.
    #[error("is not text; known are CGATS, CxF 3 and CSV")]
    NotText,
    /// A file that is no reference.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// A picture that was rendered.
    #[error("is a rendered picture, not a raw file: a tone curve has changed its colours; take the raw file")]
    Rendered,
    /// A camera without colours.
    #[error("is monochrome; a colour profile needs a colour sensor")]
    Monochrome,
    /// A rendered picture that cannot be read.
    #[error("cannot be read as a picture: {0}")]
    Picture(image::ImageError),
    /// A rendered picture that would take too much memory.
    #[error(
        "is too large to look for a chart in ({width} x {height} pixels); reduce it or cut the chart out"
    )]
    Large {
        /// Width of the picture.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// A picture without pixels.
    #[error("has no pixels")]
    Empty,
    /// No chart in it.
    #[error("no {chart} was found{}; take it larger, sharper and whole", reason.as_ref().map_or_else(String::new, |r| format!(" ({r})")))]
    NotFound {
        /// Title of the chart.
        chart: String,
        /// What spoke against what came nearest.
        reason: Option<Refusal>,
    },
    /// Corners that make no quadrilateral.
    #[error("the corners are no quadrilateral; give them clockwise from patch 1")]
    Corners,
    /// A chart that is cut off.
    #[error(
        "the chart lies partly outside of the picture ({width} x {height} pixels); take it whole, with some room around it"
    )]
    Outside {
        /// Width of the picture.
        width: usize,
        /// Its height.
        height: usize,
    },
    /// A flat or dark shot of another camera.
    #[error("was taken with {camera}, the chart with {of}; take both with one camera")]
    CompanionCamera {
        /// Its camera.
        camera: String,
        /// The camera of the chart's shot.
        of: String,
    },
    /// A flat or dark shot of another size.
    #[error("has {} x {} pixels, the chart {} x {}; take both at one size", size[0], size[1], of[0], of[1])]
    CompanionSize {
        /// Its width and height.
        size: [usize; 2],
        /// Those of the chart's shot.
        of: [usize; 2],
    },
    /// Shots of two cameras.
    #[error("was taken with {camera}, another shot with {other}; a profile is for one camera")]
    SeveralCameras {
        /// Its camera.
        camera: String,
        /// That of another shot.
        other: String,
    },
    /// The profile is for another camera.
    #[error("was taken with {camera}, the profile is for {of}")]
    OtherCamera {
        /// Its camera.
        camera: String,
        /// The camera of the profile.
        of: String,
    },
    /// The patches cannot be measured.
    #[error(transparent)]
    Shot(#[from] ShotError),
    /// The shot is not good enough.
    #[error("{}; {}", .0.words(), .0.advice())]
    Refused(Box<Gate>),
    /// The greys have no light in a channel.
    #[error("its greys have no light in a channel")]
    DarkGreys,
    /// Patches to which no model can be fitted.
    #[error("cannot be fitted to: {0}")]
    Fit(#[from] darkroot_profile::fit::FitError),
    /// A table without the patch that is to be left out.
    #[error("has no patch {} to exclude", quoted(name))]
    NoPatch {
        /// As it was given.
        name: String,
    },
    /// Colours that cannot have been measured in a light.
    #[error("has no XYZ: colours that were measured in the light of the shot are XYZ relative to its white")]
    NotXyz,
    /// A picture whose colour profile cannot be used.
    #[error("{0}")]
    SourceProfile(#[from] darkroot_encode::ProfileFault),
    /// A finished picture of another light than the one that was named.
    #[error(
        "says of itself that its colours are those under {says}, not under {named}: judge it under that light"
    )]
    OtherLight {
        /// What it says.
        says: String,
        /// What was named.
        named: String,
    },
    /// A finished picture whose greys are not neutral by far.
    #[error(
        "shows its greys as a light of {kelvin:.0} K would make them, where they should be neutral: it was balanced for another \
         light than the chart's; balance it by the chart"
    )]
    OtherBalance {
        /// Temperature of its greys, seen under D50.
        kelvin: f64,
    },
    /// A file that is no log of verified shots.
    #[error("is no log of verified shots")]
    NoLog,
}

/// Why a file of spectra cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SpectraError {
    /// Not UTF-8.
    #[error("is not text")]
    NotText,
    /// Nothing in it.
    #[error("is empty")]
    Empty,
    /// Rows of different lengths, or broken quotes.
    #[error("is no table of spectra: {0}")]
    Table(#[from] csv::Error),
    /// A wavelength that is no number.
    #[error("has `{}` where a wavelength in nm should stand", quoted(cell))]
    Wavelength {
        /// What stands there.
        cell: String,
    },
    /// A value that is no number.
    #[error("`{}` has `{}` where a number should stand", quoted(name), quoted(cell))]
    Number {
        /// Name of the spectrum.
        name: String,
        /// What stands there.
        cell: String,
    },
    /// A spectrum that cannot be used.
    #[error("`{}`: {source}", quoted(name))]
    Spectrum {
        /// Its name.
        name: String,
        /// What is wrong with it.
        source: SpectrumError,
    },
    /// Wavelengths alone.
    #[error("has wavelengths but no spectrum; give a row for each")]
    NoSpectrum,
    /// Not three sensitivities.
    #[error("has {count} spectra; sensitivities are three: red, green and blue, a row each")]
    NotThree {
        /// Spectra that there are.
        count: usize,
    },
    /// Sensitivities of no camera.
    #[error("has a channel that sees nothing; give three sensitivities to light between 380 and 780 nm")]
    Blind,
    /// A column that a table of matrices needs.
    #[error("has no column `{}`; a table of matrices has make, model, and D65_00 to D65_22", quoted(name))]
    NoColumn {
        /// Its name.
        name: String,
    },
    /// Cameras without published matrices.
    #[error(
        "and the files with it: fewer than two of these cameras have a published matrix; name files cam_SOURCE_MAKE_MODEL.csv"
    )]
    NoMatrix,
    /// A light that the file does not have.
    #[error("has no light `{}`; it has {}", quoted(name), list(names))]
    NoLight {
        /// As it was asked for.
        name: String,
        /// Lights of the file.
        names: Vec<String>,
    },
    /// Several lights, and none was named.
    #[error("has {} lights ({}); name one: {file}:{}", names.len(), list(names), names.first().map_or("NAME".to_owned(), |name| quoted(name)))]
    SeveralLights {
        /// The file, as it was given.
        file: String,
        /// Lights of the file.
        names: Vec<String>,
    },
    /// A light that nobody sees.
    #[error("`{}` has no luminance; give the relative power of a light", quoted(name))]
    Dark {
        /// Its name.
        name: String,
    },
    /// Not the form of a set.
    #[error("is no set; write NAME=FILE.csv or NAME=FILE.csv:LIST.txt")]
    NoSet,
    /// A spectrum of a list that the file does not have.
    #[error("has no spectrum `{}`, which {list} asks for", quoted(name))]
    Missing {
        /// Its name.
        name: String,
        /// The file with the list.
        list: String,
    },
}

fn list(names: &[String]) -> String {
    const MOST: usize = 8;
    let first: Vec<String> = names.iter().take(MOST).map(|name| quoted(name)).collect();
    first.join(", ") + if names.len() > MOST { ", ..." } else { "" }
}

/// Why a raw file does not tell what its camera makes of a white.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NeutralError {
    /// Another camera than the profile's.
    #[error("it was taken with {camera}, not with {of}; name a raw file of that camera")]
    OtherCamera {
        /// Its camera.
        camera: String,
        /// The camera of the profile.
        of: String,
    },
    /// Neither the file nor the decoder has a matrix.
    #[error("no color matrix of its camera is known; give the neutrals yourself")]
    NoMatrix,
}
