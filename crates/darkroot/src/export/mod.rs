//! A profile as the file of another program, read back to see how far it is from the profile.

mod calibration;
pub use calibration::calibration;

mod neutrals;
pub use neutrals::neutrals;

use std::path::{Path, PathBuf};

use darkroot_colour::{RgbSpace, Xyz};
use darkroot_develop::OutputSpace;
use darkroot_profile::export::clf::{self, Clf};
use darkroot_profile::export::cube::{self, Shaper};
use darkroot_profile::export::dcp::{Dcp, WithNeutral};
use darkroot_profile::export::icc::{self, Icc};
use darkroot_profile::export::{Deviation, deviation};
use darkroot_profile::{Calibration, Profile};

use crate::{Error, files};

/// A format of other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Camera profile of Adobe's programs, RawTherapee, darktable.
    Dcp,
    /// ICC input profile, of this version.
    Icc(icc::Version),
    /// 3-D table of Adobe and Resolve.
    Cube,
    /// Common LUT Format of the Academy, version 3.
    Clf,
}

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRequest {
    /// The format.
    pub target: Target,
    /// Lights of the calibrations, or temperatures; may be empty where the profile has one, and for a DCP, which takes the
    /// coldest and the warmest.
    pub lights: Vec<String>,
    /// For a DCP: a raw file of the camera, whose matrices say what its sensor makes of the light's white.
    pub raw_file: Option<PathBuf>,
    /// For a DCP, instead: what the sensor makes of the white, once for each light.
    pub neutrals: Vec<[f64; 3]>,
    /// For a cube and CLF: colour space of what comes out.
    pub space: Option<OutputSpace>,
    /// For a cube: what goes in.
    pub shaper: Shaper,
    /// Nodes along each side of a table, 2 to 129.
    pub grid: usize,
}

impl ExportRequest {
    /// Nothing but a format.
    pub fn to(target: Target) -> Self {
        Self {
            target,
            lights: Vec::new(),
            raw_file: None,
            neutrals: Vec::new(),
            space: None,
            shaper: Shaper::SquareRoot,
            grid: icc::SIZE,
        }
    }
}

/// Why a profile cannot be exported as asked.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// Several lights, and none was named.
    #[error("the profile has calibrations for {names}; choose one")]
    SeveralLights {
        /// Names of its lights.
        names: String,
    },
    /// A light that the profile does not have.
    #[error("the profile has no light `{name}`; it has {names}, or take a temperature (4000K)")]
    NoLight {
        /// As it was asked for.
        name: String,
        /// Names of its lights.
        names: String,
    },
    /// A light that a channel does not see.
    #[error("a channel of the camera sees nothing under `{name}`; choose another light")]
    BlindChannel {
        /// The light.
        name: String,
    },
    /// More lights than the format has room for.
    #[error("{}", if *most == 2 { "a DCP has at most two lights" } else { "this format has one light" })]
    ManyLights {
        /// How many it has.
        most: usize,
    },
    /// A DCP without the neutrals of its lights.
    #[error("a DCP needs what the sensor makes of the light's white, once for each of its lights ({names})")]
    NoNeutral {
        /// Names of the lights.
        names: String,
    },
    /// A space with a curve where only linear ones fit.
    #[error("CLF is written for linear spaces")]
    CurveInClf,
    /// Camera RGB as what comes out.
    #[error("the profile leads out of camera RGB")]
    IntoCamera,
    /// A profile that the format cannot hold, or a file that does not read back.
    #[error(transparent)]
    Format(#[from] darkroot_profile::export::Error),
    /// A raw file or a light that cannot be used.
    #[error(transparent)]
    File(#[from] Box<Error>),
}

/// The bytes of a file, and how far what they say is from the profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// The file.
    pub bytes: Vec<u8>,
    /// For each light its name and how far colours are off that were read back.
    pub deviations: Vec<(String, Deviation)>,
}

/// What an exported file makes of balanced camera RGB.
type ReadBack = Box<dyn Fn([f64; 3]) -> Xyz>;

/// Makes the file.
///
/// # Errors
/// A light that the profile does not have, a profile that the format cannot hold, neutrals that are missing.
pub fn export(profile: &Profile, request: &ExportRequest) -> Result<Exported, ExportError> {
    let calibrations = calibrations(profile, request)?;
    let (bytes, read_back) = match request.target {
        Target::Dcp => dcp(profile, &calibrations, request)?,
        _ => table(profile, &calibrations[0], request)?,
    };
    let compared = calibrations.iter().zip(read_back);
    let deviations = compared.map(|(c, read)| (c.light.name.clone(), deviation(c, read))).collect();
    Ok(Exported { bytes, deviations })
}

/// The calibrations to write, coldest first; one but for a DCP.
fn calibrations(profile: &Profile, request: &ExportRequest) -> Result<Vec<Calibration>, ExportError> {
    let most = if request.target == Target::Dcp { 2 } else { 1 };
    if request.lights.len() > most {
        return Err(ExportError::ManyLights { most });
    }
    if !request.lights.is_empty() {
        return request.lights.iter().map(|light| calibration(profile, Some(light))).collect();
    }
    match profile.calibrations() {
        [coldest, .., warmest] if most == 2 => Ok(vec![coldest.clone(), warmest.clone()]),
        _ => Ok(vec![calibration(profile, None)?]),
    }
}

fn dcp(
    profile: &Profile,
    calibrations: &[Calibration],
    request: &ExportRequest,
) -> Result<(Vec<u8>, Vec<ReadBack>), ExportError> {
    let neutrals = match &request.raw_file {
        Some(raw_file) => {
            let whites: Vec<_> = calibrations.iter().map(|c| c.light.xy).collect();
            neutrals(profile, raw_file, &whites).map_err(Box::new)?
        }
        None => request.neutrals.clone(),
    };
    if neutrals.len() != calibrations.len() {
        let names: Vec<&str> = calibrations.iter().map(|c| c.light.name.as_str()).collect();
        return Err(ExportError::NoNeutral { names: names.join(", ") });
    }
    let pairs = calibrations.iter().zip(neutrals);
    let with: Vec<_> = pairs.map(|(calibration, neutral)| WithNeutral { calibration, neutral }).collect();
    let bytes = Dcp::of(profile, &with)?.write();
    let mut read = Dcp::read(&bytes)?.lights;
    // In the file the warmer light is first.
    if read.len() == 2 && calibrations[0].light.kelvin() > calibrations[1].light.kelvin() {
        read.swap(0, 1);
    }
    let read_back = read.into_iter().map(|light| Box::new(move |rgb| light.xyz(rgb)) as ReadBack);
    Ok((bytes, read_back.collect()))
}

fn table(
    profile: &Profile,
    calibration: &Calibration,
    request: &ExportRequest,
) -> Result<(Vec<u8>, Vec<ReadBack>), ExportError> {
    let size = request.grid;
    let (bytes, read_back): (Vec<u8>, ReadBack) = match request.target {
        Target::Clf => {
            let space = space(request, RgbSpace::ACES2065_1)?;
            if space != space.linear() {
                return Err(ExportError::CurveInClf);
            }
            let text = clf::write(profile, calibration, size, &space);
            let read = Clf::read(&text)?;
            (text.into_bytes(), Box::new(move |rgb| read.xyz(&space, rgb)))
        }
        Target::Icc(version) => {
            let bytes = icc::write(profile, calibration, size, version);
            let read = Icc::read(&bytes)?;
            (bytes, Box::new(move |rgb| read.xyz(rgb)))
        }
        Target::Cube | Target::Dcp => {
            let space = space(request, RgbSpace::REC2020.linear())?;
            let settings = cube::Settings { size, shaper: request.shaper, space };
            let text = cube::write(profile, calibration, &settings);
            let read = cube::read(&text)?;
            (text.into_bytes(), Box::new(move |rgb| cube::xyz(&read, &settings, rgb)))
        }
    };
    Ok((bytes, vec![read_back]))
}

fn space(request: &ExportRequest, usual: RgbSpace) -> Result<RgbSpace, ExportError> {
    match request.space {
        None => Ok(usual),
        Some(OutputSpace::Rgb(space)) => Ok(space),
        Some(OutputSpace::Camera | OutputSpace::Raw) => Err(ExportError::IntoCamera),
    }
}

/// Writes an exported file, whole or not at all. Missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub fn write(path: &Path, bytes: &[u8], overwrite: bool) -> Result<(), Error> {
    files::write_whole(path, bytes, overwrite)
}
