//! What a worker does with a file to develop.

use std::fs::File;
use std::io::{Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::Instant;

use darkroot::files::{Output, Tree};
use darkroot::job::{Control, develop_into, open_output};
use darkroot::recipe::Effective;
use darkroot::{Error, Format, Job, ProfileStore, Settings};
use darkroot_photo::{Camera, Picture};

use super::facts::{CameraNames, Identity, modified};
use super::failure::FailureKind;
use super::task::{Develop, Developed, Fault, TaskError};
use super::{hash, process_limits, thumbnail};
use darkroot::shown;

/// Settings and format of a task. The parent has checked them.
fn settings(task: &Develop) -> Result<(Settings, Format), TaskError> {
    let wrong = |e: darkroot::RecipeError| {
        let words = format!("{}: {e}", shown(&task.input));
        TaskError { kind: FailureKind::File, words }
    };
    let effective = Effective::from_texts(&task.texts).map_err(wrong)?;
    let settings = effective.settings().map_err(wrong)?;
    let format = Format::from_extension(&task.format).unwrap_or_else(|| settings.default_format());
    Ok((settings, format))
}

/// A file to develop whose output is open.
pub(crate) struct Opened {
    task: Develop,
    job: Job,
    pub(crate) settings: Settings,
    pub(crate) format: Format,
    pub(crate) output: Output,
}

impl Opened {
    pub(crate) fn input(&self) -> &Path {
        &self.job.input
    }

    /// Profiles that were made of charts.
    pub(crate) fn session_profiles(&self) -> impl Iterator<Item = PathBuf> {
        self.task.session.iter().map(|colour| colour.profile.clone())
    }
}

/// Opens the output of a task.
pub(crate) fn open(task: Develop) -> Result<Opened, Fault> {
    let (mut settings, format) = settings(&task).map_err(Fault::Task)?;
    settings.format = Some(format);
    settings.overwrite = task.overwrite;
    settings.tree = Some(Tree { root: task.out.clone(), scratch: task.scratch.clone() });
    let job = Job { input: task.input.clone(), output: task.output.clone() };
    let output = open_output(&job, &settings)?;
    Ok(Opened { task, job, settings, format, output })
}

/// Develops the file whose bytes these are and writes its picture.
pub(crate) fn develop(
    opened: Opened,
    bytes: Vec<u8>,
    identity: Identity,
    camera: &Camera,
    store: &ProfileStore,
) -> Result<Developed, Fault> {
    let start = Instant::now();
    let Opened { task, job, mut settings, output, .. } = opened;
    let names = CameraNames::from(camera);
    let colour = task.session.iter().find(|c| c.camera == names);
    if let Some(colour) = colour {
        colour.apply(&mut settings);
    }
    let wrong = |e| Error::write(&task.output, e);
    let mut file = output.file().map_err(wrong)?;
    let mut small = None;
    let mut seen = |picture: &Picture| small = thumbnail::of_picture(picture);
    let control = Control { seen: task.thumbnail.then_some(&mut seen), ..Control::default() };
    // The bytes whose hash is recorded are the ones that are decoded.
    let report = develop_into(output, &job, || Ok(bytes), &settings, store, control)?;
    let profile = hash::profile(&settings, camera, store)?;
    let written = written(&mut file).map_err(|e| Error::read(&task.output, e))?;
    let mut notes = report.notes;
    if let Some(colour) = colour {
        notes.push(format!("white balance and profile from the chart in {}", colour.chart));
    }
    Ok(Developed {
        source: identity,
        written,
        camera: names,
        profile,
        colours: report.colours,
        width: report.width,
        height: report.height,
        seconds: start.elapsed().as_secs_f64(),
        notes,
        thumbnail: small,
        peak: process_limits::peak(),
        needed: 0,
    })
}

/// What a finished output is.
fn written(file: &mut File) -> std::io::Result<Identity> {
    let data = file.metadata()?;
    file.seek(SeekFrom::Start(0))?;
    Ok(Identity { size: data.len(), modified: modified(&data), sha256: hash::content(file)? })
}
