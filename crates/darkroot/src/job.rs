//! Developing one file.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use darkroot_develop::{Cancel, Cancelled, Colours, OutputSpace, Plan, Recipe, Scale};
use darkroot_encode::Format;
use darkroot_photo::metadata::{Directory, Metadata, Value, tag};
use darkroot_photo::{Capture, Picture, PictureSpace};
use darkroot_profile::Profile;
use serde::Serialize;

use crate::files::{self, Failed};
use crate::photo::Photo;
use crate::settings::{Engine, Settings};
use crate::store::ProfileStore;
use crate::{Error, Job, VERSION};

/// How far a file has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Reading and decoding.
    Decode,
    /// Running the stages.
    Develop,
    /// Encoding and writing.
    Write,
}

/// What was done to one file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The raw file.
    #[serde(serialize_with = "crate::files::as_text")]
    pub input: PathBuf,
    /// The picture.
    #[serde(serialize_with = "crate::files::as_text")]
    pub output: PathBuf,
    /// Its format.
    pub format: String,
    /// Its colour space.
    pub space: String,
    /// Its bits a sample.
    pub bits: u8,
    /// Its width in pixels.
    pub width: usize,
    /// Its height in pixels.
    pub height: usize,
    /// The camera.
    pub camera: String,
    /// Decoder and version.
    pub decoder: String,
    /// "darkroot" or "imagepipe".
    pub engine: String,
    /// What gave the colours, in words.
    pub colours: String,
    /// Path of the profile or "built in", when a profile was used.
    pub profile: Option<String>,
    /// Correlated colour temperature of the light, K, and tint, where known.
    pub kelvin: Option<f64>,
    /// Tint of the light: positive above the Planckian locus (greenish light), as raw developers show it.
    pub tint: Option<f64>,
    /// White-balance multipliers of red, green and blue; the smallest is 1.
    pub multipliers: [f32; 3],
    /// Demosaicing method.
    pub demosaic: String,
    /// Factor on scene-linear light (exposure).
    pub gain: f32,
    /// What had to be assumed or left out.
    pub notes: Vec<String>,
    /// Time taken.
    pub seconds: f64,
}

/// Develops one file and writes its picture. `progress`, if there is one, hears of each step as it begins.
///
/// # Errors
/// One sentence that names the file, what is wrong and what to do. Nothing is left half written.
pub fn develop(
    job: &Job,
    settings: &Settings,
    store: &ProfileStore,
    progress: Option<&dyn Fn(Step)>,
) -> Result<Report, Error> {
    let step = |s: Step| {
        if let Some(progress) = progress {
            progress(s);
        }
    };
    refuse_existing(job, settings)?;
    step(Step::Decode);
    let read = || files::read(&job.input);
    develop_bytes(job, read, settings, store, &step, &mut |_, _| {})
}

/// Without `overwrite`, an output that exists is an error: before any work is done.
fn refuse_existing(job: &Job, settings: &Settings) -> Result<(), Error> {
    if !settings.overwrite && job.output.symlink_metadata().is_ok() {
        return Err(Error::Exists { path: job.output.clone() });
    }
    Ok(())
}

/// As [`develop()`], with the bytes of the input from `read`. `seen` gets to see the camera and the
/// picture before that is written.
///
/// # Errors
/// As [`develop()`].
pub fn develop_bytes(
    job: &Job,
    read: impl FnOnce() -> Result<Vec<u8>, Error>,
    settings: &Settings,
    store: &ProfileStore,
    step: &dyn Fn(Step),
    seen: &mut dyn FnMut(&darkroot_photo::Camera, &Picture),
) -> Result<Report, Error> {
    let start = Instant::now();
    let (input, output) = (&job.input, &job.output);
    refuse_existing(job, settings)?;
    let format = format_of(output, settings);
    let recipe =
        settings.resolve(format).map_err(|e| Error::Write { path: output.clone(), reason: e.to_string() })?;
    let photo = Photo::open_with(&read()?, settings.decoder, &settings.limits)
        .map_err(|source| Error::Raw { path: input.clone(), source })?;

    step(Step::Develop);
    let (picture, mut report) = match settings.engine {
        Engine::Darkroot => own_engine(input, &photo, settings, store, &recipe)?,
        Engine::Imagepipe => second_engine(input, photo.capture(), &recipe)?,
    };
    let capture = photo.capture();
    let mut notes = capture.notes.clone();
    let metadata = metadata_for(capture, &picture);
    seen(&capture.camera, &picture);
    drop(photo);

    step(Step::Write);
    let write = |out: &mut io::BufWriter<&std::fs::File>| {
        darkroot_encode::write(&picture, format, &settings.encode, &metadata, out)
    };
    let folder = settings.scratch.as_deref();
    files::write(output, folder, settings.overwrite, write).map_err(|failed| match failed {
        Failed::Io(e) if e.kind() == io::ErrorKind::AlreadyExists => Error::Exists { path: output.clone() },
        Failed::Io(e) => Error::write(output, &e),
        Failed::Other(darkroot_encode::Error::Io(e)) => Error::write(output, &e),
        Failed::Other(source) => Error::Encode { path: output.clone(), source },
    })?;

    notes.append(&mut report.notes);
    notes.dedup();
    Ok(Report {
        output: output.clone(),
        format: format.name().to_owned(),
        space: picture.space.name(),
        bits: picture.samples.bits(),
        notes,
        seconds: start.elapsed().as_secs_f64(),
        ..report
    })
}

/// A finished picture as the bytes of a file, with its colour space and the metadata of the capture that it is from.
///
/// # Errors
/// A format that cannot hold the picture.
pub fn encode_picture(
    picture: &Picture,
    format: Format,
    capture: &Capture,
) -> Result<Vec<u8>, darkroot_encode::Error> {
    let mut out = io::Cursor::new(Vec::new());
    let metadata = metadata_for(capture, picture);
    darkroot_encode::write(picture, format, &darkroot_encode::Options::default(), &metadata, &mut out)?;
    Ok(out.into_inner())
}

/// The format of an output: the one asked for, else by its ending.
fn format_of(output: &Path, settings: &Settings) -> Format {
    let by_name = || output.extension().and_then(|e| e.to_str()).and_then(Format::from_extension);
    settings.format.or_else(by_name).unwrap_or_else(|| settings.default_format())
}

fn own_engine(
    input: &Path,
    photo: &Photo,
    settings: &Settings,
    store: &ProfileStore,
    recipe: &Recipe,
) -> Result<(Picture, Report), Error> {
    let chosen = store.for_camera(&photo.capture().camera, &settings.profile);
    let chosen = chosen.map_err(|fault| fault.about(input))?;
    let profile = chosen.as_ref().map(|c| c.profile.as_ref());
    let plan = darkroot_develop::plan(&photo.analyse_as_asked(), profile, recipe)
        .map_err(|source| Error::Plan { path: input.to_owned(), source })?;
    let whole = plan.whole(Scale::FULL);
    let picture = plan
        .render(whole, &Cancel::default())
        .map_err(|Cancelled| Error::Cancelled { path: input.to_owned() })?;
    let camera_output = recipe.output.space == OutputSpace::Camera;
    let capture = photo.capture();
    let report = Report {
        engine: "darkroot".to_owned(),
        colours: if camera_output {
            "none (camera RGB)".to_owned()
        } else {
            colours(&plan, capture, profile)
        },
        profile: chosen.map(|c| c.place.into_owned()).filter(|_| !camera_output),
        kelvin: plan.white.map(|w| w.kelvin),
        tint: plan.white.map(|w| w.tint()),
        multipliers: plan.multipliers,
        demosaic: plan.demosaic.name().to_owned(),
        gain: plan.gain,
        notes: plan.notes,
        ..blank_report(input, capture, &picture)
    };
    Ok((picture, report))
}

/// What gave the colours, in words.
fn colours(plan: &Plan, capture: &Capture, profile: Option<&Profile>) -> String {
    match (plan.colours, profile) {
        (Colours::Profile, Some(p)) => {
            let light = p.calibrations().iter().map(|c| c.light.name.as_str()).collect::<Vec<_>>().join(", ");
            format!("profile for {} ({light})", p.camera().name())
        }
        (Colours::CameraMatrix, _) if capture.source.format == "DNG" => "matrix in the file".to_owned(),
        (Colours::CameraMatrix, _) => "camera matrix".to_owned(),
        (Colours::Grey, _) => "monochrome".to_owned(),
        _ => "assumed".to_owned(),
    }
}

#[cfg(feature = "imagepipe")]
fn second_engine(input: &Path, capture: &Capture, recipe: &Recipe) -> Result<(Picture, Report), Error> {
    let picture = crate::pipe::develop(capture, recipe.output.bits)
        .map_err(|reason| Error::Engine { path: input.to_owned(), reason })?;
    let report = Report {
        engine: "imagepipe".to_owned(),
        colours: "camera matrix, by imagepipe".to_owned(),
        demosaic: "bilinear, by imagepipe".to_owned(),
        ..blank_report(input, capture, &picture)
    };
    Ok((picture, report))
}

#[cfg(not(feature = "imagepipe"))]
fn second_engine(input: &Path, _: &Capture, _: &Recipe) -> Result<(Picture, Report), Error> {
    let reason = "this build was made without it".to_owned();
    Err(Error::Engine { path: input.to_owned(), reason })
}

fn blank_report(input: &Path, capture: &Capture, picture: &Picture) -> Report {
    Report {
        input: input.to_owned(),
        output: PathBuf::new(),
        format: String::new(),
        space: String::new(),
        bits: 0,
        width: picture.size.width,
        height: picture.size.height,
        camera: capture.camera.name(),
        decoder: capture.source.decoder.clone(),
        engine: String::new(),
        colours: String::new(),
        profile: None,
        kelvin: None,
        tint: None,
        multipliers: [1.0; 3],
        demosaic: String::new(),
        gain: 1.0,
        notes: Vec::new(),
        seconds: 0.0,
    }
}

/// The camera's fields with what developing changed.
fn metadata_for(capture: &Capture, picture: &Picture) -> Metadata {
    const SRGB: u16 = 1;
    const UNCALIBRATED: u16 = 65535;
    let mut metadata = capture.metadata.clone();
    metadata.set(Directory::Image, tag::SOFTWARE, Value::Text(format!("Darkroot {VERSION}")));
    let srgb = picture.space == PictureSpace::Rgb(darkroot_colour::RgbSpace::SRGB);
    let space = if srgb { SRGB } else { UNCALIBRATED };
    metadata.set(Directory::Exif, tag::COLOUR_SPACE, Value::Shorts(vec![space]));
    metadata
}
