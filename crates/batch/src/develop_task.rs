//! What a worker does with a file to develop.

use std::path::Path;
use std::time::Instant;

use darkroot::files::Tree;
use darkroot::job::{Control, develop_bytes};
use darkroot::recipe::Effective;
use darkroot::{Error, Format, Job, ProfileStore, Settings};
use darkroot_photo::{Camera, Picture};

use super::facts::{CameraNames, Identity, modified};
use super::failure::FailureKind;
use super::task::{Develop, Developed, Fault, TaskError};
use super::{hash, process_limits, thumbnail};
use darkroot::shown;

/// Settings and format of a task. The parent has checked them.
pub(crate) fn settings(task: &Develop) -> Result<(Settings, Format), TaskError> {
    let wrong = |e: darkroot::RecipeError| {
        let words = format!("{}: {e}", shown(&task.input));
        TaskError { kind: FailureKind::File, words }
    };
    let effective = Effective::from_texts(&task.texts).map_err(wrong)?;
    let settings = effective.settings().map_err(wrong)?;
    let format = Format::from_extension(&task.format).unwrap_or_else(|| settings.default_format());
    Ok((settings, format))
}

/// Develops the file whose bytes these are and writes its picture.
pub(crate) fn develop(
    task: &Develop,
    bytes: Vec<u8>,
    identity: Identity,
    camera: &Camera,
    store: &ProfileStore,
) -> Result<Developed, Fault> {
    let start = Instant::now();
    let (mut settings, format) = settings(task).map_err(Fault::Task)?;
    settings.format = Some(format);
    settings.overwrite = task.overwrite;
    settings.tree = Some(Tree { root: task.out.clone(), scratch: task.scratch.clone() });
    let names = CameraNames::from(camera);
    let colour = task.session.iter().find(|c| c.camera == names);
    if let Some(colour) = colour {
        colour.apply(&mut settings);
    }
    let job = Job { input: task.input.clone(), output: task.output.clone() };
    let mut small = None;
    let mut seen = |picture: &Picture| small = thumbnail::of_picture(picture);
    let control = Control { seen: task.thumbnail.then_some(&mut seen), ..Control::default() };
    // The bytes whose hash is recorded are the ones that are decoded.
    let report = develop_bytes(&job, || Ok(bytes), &settings, store, control)?;
    let profile = hash::profile(&settings, camera, store)?;
    let written = written(&task.output).map_err(|e| Error::read(&task.output, e))?;
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
fn written(path: &Path) -> std::io::Result<Identity> {
    let data = std::fs::metadata(path)?;
    Ok(Identity { size: data.len(), modified: modified(&data), sha256: hash::file(path)? })
}
