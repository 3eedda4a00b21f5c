//! Dark and flat frames that a person took for photographs: read, checked, and applied to a capture.

use std::path::{Path, PathBuf};

use darkroot_develop::companions::{self, FlatFault};
use darkroot_photo::metadata::{Directory, tag};
use darkroot_photo::{Capture, Correction};

use crate::photo::Photo;
use crate::settings::Settings;
use crate::shot::common_name;
use crate::{Error, files, shown};

/// More frames of one kind make a median no better that anybody sees.
const MOST: usize = 32;
/// Stops by which time or sensitivity of a dark frame may differ before a person is told.
const OTHER_EXPOSURE: f64 = 0.05;

/// Why a dark or flat frame cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameFault {
    /// Of another camera.
    #[error("was taken with {camera}, the photograph with {of}; take both with one camera")]
    Camera {
        /// Its camera.
        camera: String,
        /// The camera of the photograph.
        of: String,
    },
    /// Of another size or layout.
    #[error(
        "has other samples ({} x {}) than the photograph ({} x {}); take both in one mode of the camera",
        size[0], size[1], of[0], of[1]
    )]
    Size {
        /// Its width and height.
        size: [usize; 2],
        /// Those of the photograph.
        of: [usize; 2],
    },
    /// A folder without frames.
    #[error("is a folder without a raw file; put the frames into it")]
    NoFrames,
    /// A folder of too many.
    #[error("is a folder of {count} files; {MOST} frames do as well")]
    TooMany {
        /// Files in it.
        count: usize,
    },
    /// Flats that even nothing out.
    #[error(transparent)]
    Flat(#[from] FlatFault),
}

impl Error {
    fn frame(path: &Path, source: impl Into<FrameFault>) -> Self {
        Self::Frame { path: path.to_owned(), source: source.into() }
    }
}

/// Takes off the dark frames of the settings and evens out by their flats; a photograph for which there are none stays as it
/// is. What was done is a note of the capture.
///
/// # Errors
/// Frames that cannot be read or do not belong to the photograph.
pub(crate) fn apply(photo: Photo, settings: &Settings) -> Result<Photo, Error> {
    if settings.dark.is_none() && settings.flat.is_none() {
        return Ok(photo);
    }
    let rendered = photo.rendered.clone();
    let mut capture = photo.into_capture();
    if let Some(path) = &settings.dark {
        let frames = read(path, &capture, settings)?;
        let mended = companions::take_off(&mut capture, &frames);
        capture.notes.push(format!(
            "{} taken off{}",
            counted(frames.len(), "dark frame"),
            if mended > 0 {
                format!("; {} that are hot in them take the light around", counted(mended, "pixel"))
            } else {
                String::new()
            }
        ));
        let other = frames.first().and_then(|frame| unlike(frame, &capture));
        capture.notes.extend(other);
    }
    if let Some(path) = &settings.flat {
        let frames = read(path, &capture, settings)?;
        // The flat shows what is left after the file's own gain maps; what would come later is in it.
        capture.picture_corrections.retain(|correction| !matches!(correction, Correction::Vignette(_)));
        if let Some(lens) = &mut capture.maker_lens {
            lens.gain = None;
        }
        companions::even_out(&mut capture, &frames).map_err(|fault| Error::frame(path, fault))?;
        capture.notes.push(format!("evened out by {}", counted(frames.len(), "flat frame")));
    }
    Ok(Photo::with_rendered(capture, rendered))
}

fn counted(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

/// How the exposure of a dark frame differs from the photograph's, in words.
fn unlike(dark: &Capture, photo: &Capture) -> Option<String> {
    let number = |capture: &Capture, tag| {
        capture.metadata.number(Directory::Exif, tag).filter(|v| v.is_finite() && *v > 0.0)
    };
    let other = |tag| {
        let (a, b) = number(dark, tag).zip(number(photo, tag))?;
        ((a / b).log2().abs() > OTHER_EXPOSURE).then_some((a, b))
    };
    let time = other(tag::EXPOSURE_TIME).map(|(a, b)| format!("{a} s, the photograph for {b} s"));
    let iso = other(tag::ISO).map(|(a, b)| format!("at ISO {a}, the photograph at ISO {b}"));
    let said: Vec<String> = time.into_iter().chain(iso).collect();
    (!said.is_empty()).then(|| {
        format!(
            "the dark frame was exposed for {}: what the sensor gives without light differs by that",
            said.join("; ")
        )
    })
}

/// The frames of a file or a folder, each of which belongs to the photograph.
fn read(path: &Path, photo: &Capture, settings: &Settings) -> Result<Vec<Capture>, Error> {
    let paths = named(path)?;
    if paths.len() > MOST {
        return Err(Error::frame(path, FrameFault::TooMany { count: paths.len() }));
    }
    let frames: Vec<Capture> =
        paths.iter().map(|path| frame(path, photo, settings)).collect::<Result<_, _>>()?;
    if frames.is_empty() { Err(Error::frame(path, FrameFault::NoFrames)) } else { Ok(frames) }
}

/// The frames that a path stands for: a file for itself, a folder for its files by name, but for what is hidden, a setting or a
/// finished picture.
///
/// # Errors
/// A folder that cannot be read.
pub fn named(path: &Path) -> Result<Vec<PathBuf>, Error> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let folder = path;
    const OTHERS: [&str; 8] = ["toml", "xmp", "txt", "jpg", "jpeg", "png", "json", "html"];
    let entries = std::fs::read_dir(folder).map_err(|e| Error::read(folder, e))?;
    let mut paths: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().as_encoded_bytes();
            let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
            path.is_file() && !name.starts_with(b".") && !OTHERS.iter().any(|other| ending == *other)
        })
        .collect();
    paths.sort();
    Ok(paths)
}

fn frame(path: &Path, photo: &Capture, settings: &Settings) -> Result<Capture, Error> {
    let bytes = files::read(path)?;
    let frame = Photo::open_with(&bytes, settings.decoder, &settings.limits)
        .map_err(|source| Error::Raw { path: path.to_owned(), source })?
        .into_capture();
    if frame.camera != photo.camera {
        let (camera, of) = (common_name(&frame.camera), common_name(&photo.camera));
        return Err(Error::frame(path, FrameFault::Camera { camera: shown(&camera), of: shown(&of) }));
    }
    if !companions::fits(&frame, photo) {
        let [size, of] = [&frame, photo].map(|capture| {
            let size = capture.counts.size();
            [size.width, size.height]
        });
        return Err(Error::frame(path, FrameFault::Size { size, of }));
    }
    Ok(frame)
}
