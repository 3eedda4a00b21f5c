//! What can go wrong with one file. Each message names the file, what is wrong and what to do.

use std::io;
use std::path::{Path, PathBuf};

use darkroot_calibrate::{CalibrateError, LightSource};

use crate::SettingsError;
use crate::fault::{ChartError, NeutralError, SpectraError};
use crate::frames::FrameFault;
use crate::lut::LutFault;
use crate::{quoted, shown};

/// Why a file could not be developed or inspected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The input cannot be read.
    #[error("{path}: cannot be read: {}", why_unread(source), path = shown(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The input is no raw file, or damaged.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Raw {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: darkroot_raw::Error,
    },
    /// The capture cannot be developed as asked.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Plan {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        source: darkroot_develop::Error,
    },
    /// The profile file is unusable.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Profile {
        /// The profile's file.
        path: PathBuf,
        /// What is wrong with it.
        source: darkroot_profile::Error,
    },
    /// The DCP is unusable as a profile.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Dcp {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: darkroot_profile::export::Error,
    },
    /// A file of spectra is unusable.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Spectra {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: SpectraError,
    },
    /// A file of a look-up table is unusable.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Lut {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: LutFault,
    },
    /// A dark or flat frame that cannot stand beside the photograph.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Frame {
        /// The frame, or the folder of frames.
        path: PathBuf,
        /// What is wrong with it.
        source: FrameFault,
    },
    /// Neither a profile file nor a camera with a profile.
    #[error("{}: is neither a profile file nor a camera with a profile", shown(text))]
    NoProfile {
        /// As it was given.
        text: String,
    },
    /// Shots of a chart that make no camera.
    #[error(
        "the shots under {light} make no camera: that takes a light of known spectrum and a chart of known colours"
    )]
    NoCamera {
        /// The light.
        light: String,
    },
    /// An illuminant was named where the colours are those of a matrix.
    #[error(
        "the illuminant {light} needs a profile or a camera that can be estimated; here the file's own matrix gives the colours"
    )]
    LightOfMatrix {
        /// The light.
        light: String,
    },
    /// A shot of a chart cannot be used.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Chart {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: ChartError,
    },
    /// A raw file that does not say what an export needs.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Neutral {
        /// The file.
        path: PathBuf,
        /// What is missing.
        source: NeutralError,
    },
    /// A light that nobody knows.
    #[error(
        "`{}` is no light{}; known are {}", quoted(text),
        meant.as_ref().map_or_else(String::new, |name| format!("; did you mean `{name}`?")), crate::light::known()
    )]
    Light {
        /// As it was given.
        text: String,
        /// The light that may have been meant.
        meant: Option<String>,
    },
    /// Two shots under one light at one exposure, and nobody said what they are for.
    #[error(
        "{one} and {other} were both taken under {light} and at one exposure: they can be averaged, or one of them has \
         another light", one = shown(one), other = shown(other)
    )]
    SeveralShots {
        /// One of the shots.
        one: PathBuf,
        /// Another.
        other: PathBuf,
        /// Name of the light.
        light: String,
    },
    /// A model cannot be fitted.
    #[error("the profile for {light} cannot be made: {source}")]
    Fit {
        /// Name of the light.
        light: String,
        /// What is wrong.
        source: CalibrateError,
    },
    /// A camera that no decoder lists with a matrix.
    #[error(
        "`{}` is neither a file nor a camera with a published matrix; name a raw file of the camera",
        shown(text)
    )]
    NotListed {
        /// As it was asked for.
        text: String,
    },
    /// Too little is known for an estimate.
    #[error(
        "a camera cannot be estimated from its matrix: too few cameras or surfaces are left in the prior; give more"
    )]
    Prior,
    /// A profile for no light at all.
    #[error("a profile needs a light")]
    NoLight,
    /// The profile is for another camera.
    #[error(
        "{path}: is a profile for {of}, but {picture} was taken with {}; choose another profile, or add the camera to \
         its `aliases` if they are the same", shown(camera), path = shown(path),
        picture = picture.as_deref().map_or("the picture".into(), shown)
    )]
    OtherCamera {
        /// The profile's file.
        path: PathBuf,
        /// The camera of the profile.
        of: String,
        /// The raw file, where it has a name.
        picture: Option<PathBuf>,
        /// The camera of the raw file.
        camera: String,
    },
    /// The output exists.
    #[error("{path}: exists already", path = shown(path))]
    Exists {
        /// The output.
        path: PathBuf,
    },
    /// The output cannot be written.
    #[error("{path}: cannot be written: {}", why_unwritten(source), path = shown(path))]
    Write {
        /// The output.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Settings that contradict each other or the output's format.
    #[error("{path}: cannot be written: {}", sentence(source), path = shown(path))]
    Settings {
        /// The output.
        path: PathBuf,
        /// What contradicts.
        source: SettingsError,
    },
    /// The disk of the output is full.
    #[error("{path}: cannot be written: the disk is full; make room and run again", path = shown(path))]
    DiskFull {
        /// The output.
        path: PathBuf,
    },
    /// A photograph of another camera than the others, where a camera's look is asked for.
    #[error("{path}: is of {camera}, and those before it of {of}; a look is for one camera", path = shown(path))]
    LookOfOther {
        /// The raw file.
        path: PathBuf,
        /// Its camera.
        camera: String,
        /// That of the others.
        of: String,
    },
    /// The colours of a photograph do not fit into a DNG.
    #[error("{path}: its colours cannot go into a DNG: {}", sentence(source), path = shown(path))]
    Dng {
        /// The raw file.
        path: PathBuf,
        /// Why not.
        source: darkroot_profile::export::Error,
    },
    /// The format cannot hold the picture.
    #[error("{path}: {}", sentence(source), path = shown(path))]
    Encode {
        /// The output.
        path: PathBuf,
        /// Why not.
        source: darkroot_encode::Error,
    },
    /// The output is the input.
    #[error("{path}: is the raw file itself and would be overwritten; choose another name", path = shown(path))]
    OverInput {
        /// The file.
        path: PathBuf,
    },
    /// The file has no embedded preview.
    #[error("{path}: has no embedded JPEG preview; develop it instead", path = shown(path))]
    NoPreview {
        /// The file.
        path: PathBuf,
    },
    /// Somebody cancelled it.
    #[error("{path}: was cancelled", path = shown(path))]
    Cancelled {
        /// The file.
        path: PathBuf,
    },
    /// The second engine failed.
    #[error("{path}: the engine imagepipe cannot develop it ({})", shown(reason), path = shown(path))]
    Engine {
        /// The file.
        path: PathBuf,
        /// What it says.
        reason: String,
    },
}

impl Error {
    /// The same with the picture's name, where it is about one that had none.
    pub(crate) fn about(mut self, input: &Path) -> Self {
        if let Self::OtherCamera { picture, .. } = &mut self {
            *picture = Some(input.to_owned());
        }
        self
    }

    /// A chart that cannot be used.
    pub fn chart(path: &Path, source: impl Into<ChartError>) -> Self {
        Self::Chart { path: path.to_owned(), source: source.into() }
    }

    pub(crate) fn spectra(path: &Path, source: SpectraError) -> Self {
        Self::Spectra { path: path.to_owned(), source }
    }

    pub(crate) fn fit(light: &LightSource, source: CalibrateError) -> Self {
        Self::Fit { light: light.light.name.clone(), source }
    }

    /// A file that cannot be read.
    pub fn read(path: &Path, source: io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }

    /// A file that cannot be written.
    pub fn write(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Self::DiskFull { path },
            _ => Self::Write { path, source },
        }
    }
}

/// What is wrong, in one line, whatever texts of the file stand in it.
fn sentence(source: &impl std::fmt::Display) -> String {
    /// In characters: more than any sentence of ours has, if the file puts nothing into it.
    const MOST: usize = 1000;
    let mut line = shown(&source.to_string());
    if let Some((end, _)) = line.char_indices().nth(MOST) {
        line.truncate(end);
        line += "...";
    }
    line
}

/// Why the system does not read a file, in words, with what to do.
fn why_unread(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file; check the name".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied; check the file's rights".to_owned(),
        io::ErrorKind::IsADirectory => "it is a folder; name the files in it".to_owned(),
        _ => error.to_string(),
    }
}

/// Why the system does not write a file, in words, with what to do.
fn why_unwritten(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "its folder does not exist; create it first".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied; choose another folder".to_owned(),
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only; choose another folder".to_owned(),
        _ => error.to_string(),
    }
}
