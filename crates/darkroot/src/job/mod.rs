//! Developing one file.

mod beside;
mod decoded;
mod report;

use std::io;
use std::path::Path;
use std::time::Instant;

use darkroot_develop::{Analysis, Bits, Cancel, Cancelled, Look, OutputSpace, Plan, Recipe, Scale};
use darkroot_encode::{Format, Outline};
use darkroot_photo::{Capture, Metadata, Picture};

use crate::files::{self, Failed, Output};
use crate::from_chart::Told;
use crate::metadata::{About, Keep, of_picture};
use crate::photo::Photo;
use crate::planned::planned;
use crate::settings::{Engine, Settings};
use crate::store::{ChosenProfile, ProfileStore};
use crate::{Error, Job, dng, from_chart, hdr, lut, provenance};

use beside::Beside;
pub use decoded::opened;
use decoded::{Decoded, decoded};
pub use report::{Report, colours};
use report::{blank_report, far_light};

/// How far a file has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Reading and decoding.
    Decode,
    /// Running the stages.
    Develop,
    /// Encoding and writing, of which little is left where a picture is written while it is developed.
    Write,
}

/// What a job tells while it runs, and how it is stopped.
#[derive(Default)]
pub struct Control<'a> {
    /// Hears of each step as it begins.
    pub step: Option<&'a dyn Fn(Step)>,
    /// Stops it: the job ends with [`Error::Cancelled`], and nothing is written.
    pub cancel: Option<&'a Cancel>,
    /// Sees the picture before it is written. Then all of it is in memory, which else it need not be.
    pub seen: Option<&'a mut dyn FnMut(&Picture)>,
}

impl Control<'_> {
    fn step(&self, step: Step) {
        if let Some(hear) = self.step {
            hear(step);
        }
    }
}

/// Develops one file and writes its picture.
///
/// # Errors
/// One sentence that names the file, what is wrong and what to do. Nothing is left half written.
pub fn develop(
    job: &Job,
    settings: &Settings,
    store: &ProfileStore,
    control: Control<'_>,
) -> Result<Report, Error> {
    let output = open_output(job, settings)?;
    develop_into(output, job, || files::read(&job.input), settings, store, control)
}

/// Opens the output of a job, to be filled by [`develop_into`].
///
/// # Errors
/// An output that exists and is not to be replaced, or a place where nothing can be written.
pub fn open_output(job: &Job, settings: &Settings) -> Result<Output, Error> {
    refuse_existing(job, settings)?;
    Output::open(&job.output, settings.tree.as_ref()).map_err(|e| Error::write(&job.output, e))
}

/// Without `overwrite`, an output that exists is an error: before any work is done.
fn refuse_existing(job: &Job, settings: &Settings) -> Result<(), Error> {
    if !settings.overwrite && !files::is_stream(&job.output) && job.output.symlink_metadata().is_ok() {
        return Err(Error::Exists { path: job.output.clone() });
    }
    Ok(())
}

/// As [`develop()`], with the output open already, and with the bytes of the input from `read`. Nothing else is opened
/// but what the settings name: a profile and [their files](Settings::files).
///
/// # Errors
/// As [`develop()`].
pub fn develop_into(
    to: Output,
    job: &Job,
    read: impl FnOnce() -> Result<Vec<u8>, Error>,
    settings: &Settings,
    store: &ProfileStore,
    mut control: Control<'_>,
) -> Result<Report, Error> {
    let start = Instant::now();
    let (input, output) = (&job.input, &job.output);
    control.step(Step::Decode);
    let format = format_of(output, settings);
    let mut recipe =
        settings.resolve(format).map_err(|e| Error::Settings { path: output.clone(), source: e })?;
    recipe.lut = lut::Last::default().of(settings)?;
    let (asked, mut encode) = (recipe.clone(), encoding(settings));
    if format == Format::Dng {
        recipe = dng::samples(&asked);
    } else if format == Format::Avif && settings.hdr > 0.0 {
        recipe = hdr::absolute(&asked, settings.hdr);
    }
    let Decoded { photo, told, hash } = decoded(input, read, settings, store, &recipe)?;

    control.step(Step::Develop);
    let mut notes = photo.capture().notes.clone();
    let uncancelled = Cancel::default();
    let cancel = control.cancel.unwrap_or(&uncancelled);
    let (mut report, metadata, picture) = match settings.engine {
        Engine::Darkroot => {
            let chosen = photo.profile(store, settings).map_err(|fault| fault.about(input))?;
            let analysis = photo.analyse_as_asked();
            let plan_of = |recipe: &Recipe| {
                plan(input, (&photo, &analysis), chosen.as_ref(), settings, recipe, told.as_ref())
            };
            let (plan, report) = plan_of(&recipe)?;
            let beside = Beside {
                input,
                capture: photo.capture(),
                settings,
                format,
                asked: &asked,
                plan: &plan,
                planned: &|recipe| Ok(plan_of(recipe)?.0),
                cancel,
            };
            encode = beside.options(encode, &mut control.seen, &mut notes)?;
            let by_chart = told.as_ref().zip(settings.chart.pitch).map(|(told, pitch)| told.dpi(pitch));
            let dpi = settings.dpi.or(by_chart);
            let mut origin = Vec::new();
            if recipe.look == Look::Reproduction {
                let (profile, chart) = (chosen.as_ref(), told.as_ref());
                let raw = (from_chart::file_name(input), hash);
                origin =
                    provenance::fields(&provenance::Known { raw, settings, profile, chart, plan: &plan });
                notes.extend(report::without_provenance(format, settings.about.keep));
            }
            let metadata = of_picture(photo.capture(), dpi, &settings.about, &origin);
            drop(chosen);
            drop(analysis);
            drop(photo);
            if format.takes_bands() && control.seen.is_none() {
                let write = match recipe.output.bits {
                    Bits::Eight => write_in_bands::<u8>,
                    Bits::Sixteen => write_in_bands::<u16>,
                    Bits::Float => write_in_bands::<f32>,
                };
                write(to, job, settings, (format, &encode), &metadata, &plan, cancel)?;
                notes.extend(report::clipped(&plan));
                (report, metadata, None)
            } else {
                let picture = plan
                    .render(plan.whole(Scale::FULL), cancel)
                    .map_err(|Cancelled| Error::Cancelled { path: input.clone() })?;
                notes.extend(report::clipped(&plan));
                (report, metadata, Some((picture, to)))
            }
        }
        Engine::Imagepipe => {
            let (picture, report) = second_engine(input, photo.capture(), &recipe)?;
            let metadata = of_picture(photo.capture(), settings.dpi, &settings.about, &[]);
            (report, metadata, Some((picture, to)))
        }
    };
    control.step(Step::Write);
    if let Some((picture, to)) = picture {
        if let Some(seen) = &mut control.seen {
            seen(&picture);
        }
        write_file(to, job, settings, |out| {
            Ok(darkroot_encode::write(&picture, format, &encode, &metadata, out)?)
        })?;
    }
    notes.append(&mut report.notes);
    notes.extend(settings.about.left_out.clone());
    notes.dedup();
    if encode.peak.is_some() {
        report.space = hdr::SPACE.to_owned();
    }
    Ok(Report {
        output: output.clone(),
        format: format.name().to_owned(),
        bits: format.stored_bits(report.bits),
        notes,
        seconds: start.elapsed().as_secs_f64(),
        ..report
    })
}

/// Why no picture was written.
enum Unwritten {
    Cancelled,
    Encode(darkroot_encode::Error),
}

impl From<Cancelled> for Unwritten {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<darkroot_encode::Error> for Unwritten {
    fn from(e: darkroot_encode::Error) -> Self {
        Self::Encode(e)
    }
}

/// Develops and writes at once: each band goes into the file when it is finished, by the thread that finished it.
fn write_in_bands<T: darkroot_encode::Sample + darkroot_develop::transfer::Sample>(
    to: Output,
    job: &Job,
    settings: &Settings,
    (format, encode): (Format, &darkroot_encode::Options),
    metadata: &Metadata,
    plan: &Plan,
    cancel: &Cancel,
) -> Result<(), Error> {
    let outline = Outline { size: plan.size(), space: plan.picture_space() };
    write_file(to, job, settings, |out| {
        darkroot_encode::write_in_bands(&outline, format, encode, metadata, out, |rows, take| {
            plan.render_bands(plan.whole(Scale::FULL), cancel, rows, |band, samples: &[T]| {
                Ok(take(band, samples)?)
            })
        })
    })
}

/// How a picture is encoded: with a thumbnail where it says all that it can.
fn encoding(settings: &Settings) -> darkroot_encode::Options {
    let thumbnail = settings.about.keep == Keep::All;
    darkroot_encode::Options { thumbnail, ..settings.encode.clone() }
}

/// Writes the output through `fill`, whole or not at all.
fn write_file(
    to: Output,
    job: &Job,
    settings: &Settings,
    fill: impl FnOnce(&mut io::BufWriter<&std::fs::File>) -> Result<(), Unwritten>,
) -> Result<(), Error> {
    let output = &job.output;
    to.write(settings.overwrite, fill).map_err(|failed| match failed {
        Failed::Io(e) if e.kind() == io::ErrorKind::AlreadyExists => Error::Exists { path: output.clone() },
        Failed::Io(e) | Failed::Other(Unwritten::Encode(darkroot_encode::Error::Io(e))) => {
            Error::write(output, e)
        }
        Failed::Other(Unwritten::Encode(source)) => Error::Encode { path: output.clone(), source },
        Failed::Other(Unwritten::Cancelled) => Error::Cancelled { path: job.input.clone() },
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
    let metadata = of_picture(capture, None, &About::default(), &[]);
    darkroot_encode::write(picture, format, &darkroot_encode::Options::default(), &metadata, &mut out)?;
    Ok(out.into_inner())
}

/// The format of an output: the one asked for, else by its ending.
fn format_of(output: &Path, settings: &Settings) -> Format {
    let by_name = || output.extension().and_then(|e| e.to_str()).and_then(Format::from_extension);
    settings.format.or_else(by_name).unwrap_or_else(|| settings.default_format())
}

/// The plan of a job, and what it says of the picture.
fn plan(
    input: &Path,
    (photo, analysis): (&Photo, &Analysis),
    chosen: Option<&ChosenProfile<'_>>,
    settings: &Settings,
    recipe: &Recipe,
    told: Option<&Told>,
) -> Result<(Plan, Report), Error> {
    let profile = chosen.map(|c| c.profile.as_ref());
    let plan = planned(input, photo, analysis, chosen, settings, recipe, told)?;
    let camera_output = recipe.output.space == OutputSpace::Camera;
    let capture = photo.capture();
    let mut notes = plan.notes.clone();
    if !camera_output && settings.light.is_none() {
        notes.extend(profile.zip(plan.white).and_then(|(profile, white)| far_light(profile, white)));
    }
    let report = Report {
        engine: "darkroot".to_owned(),
        colours: if camera_output { "none (camera RGB)".to_owned() } else { colours(&plan, capture, chosen) },
        profile: chosen.filter(|c| !camera_output && !c.estimated).map(|c| c.place.clone().into_owned()),
        kelvin: plan.white.map(|w| w.kelvin),
        tint: plan.white.map(|w| w.tint()),
        multipliers: plan.multipliers(),
        demosaic: plan.demosaic().name().to_owned(),
        gain: plan.gain,
        notes,
        ..blank_report(input, capture, plan.size(), &plan.picture_space(), recipe.output.bits)
    };
    Ok((plan, report))
}

#[cfg(feature = "imagepipe")]
fn second_engine(input: &Path, capture: &Capture, recipe: &Recipe) -> Result<(Picture, Report), Error> {
    let picture = crate::pipe::develop(capture, recipe.output.bits)
        .map_err(|reason| Error::Engine { path: input.to_owned(), reason })?;
    let report = Report {
        engine: "imagepipe".to_owned(),
        colours: "camera matrix, by imagepipe".to_owned(),
        demosaic: "bilinear, by imagepipe".to_owned(),
        ..blank_report(input, capture, picture.size, &picture.space, recipe.output.bits)
    };
    Ok((picture, report))
}

#[cfg(not(feature = "imagepipe"))]
fn second_engine(input: &Path, _: &Capture, _: &Recipe) -> Result<(Picture, Report), Error> {
    let reason = "this build was made without it".to_owned();
    Err(Error::Engine { path: input.to_owned(), reason })
}
