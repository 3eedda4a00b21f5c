//! `darkroot develop`.

use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use clap::Args;
use darkroot::{
    Control, Error, Format, Job, Output, ProfileStore, Report, Settings, Target, files, open_output,
    path_text, plan_outputs, shown,
};
use darkroot_batch::Failure;
use darkroot_sandbox::Access;

use crate::deadline::Deadline;
use crate::hint;
use crate::picture::{Order, Picture, source_paths, sources};
use crate::progress::Progress;
use crate::sandbox::{self, Sandbox};
use crate::{Common, Outcome};

/// Develop raw photographs into pictures
///
/// Without options every FILE becomes a JPEG in sRGB beside it. The output's ending, or --format, chooses
/// another format.
#[derive(Debug, Args)]
pub(crate) struct Develop {
    /// Raw files (NEF, DNG, CR2, ARW, RAF, ...); `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Where to write: a file, a folder, `-` (standard output), or a name with {stem} {suffix} {ext} {parent} {camera}
    /// {date} {year} {month} {day} {seq}
    #[arg(short, long, value_name = "OUT", help_heading = "Output")]
    output: Option<OsString>,

    /// Replace outputs that exist
    #[arg(long, help_heading = "Output")]
    overwrite: bool,

    #[command(flatten)]
    picture: Picture,

    #[command(flatten)]
    deadline: Deadline,

    #[command(flatten)]
    sandbox: Sandbox,

    /// Report each file as a line of JSON on stdout
    #[arg(long)]
    json: bool,
}

impl Develop {
    /// Develops every file; one that fails does not stop the others.
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        let target = self.output.as_deref().map_or(Ok(Target::Beside), Target::parse)?;
        ensure!(
            !(self.json && target == Target::Stream),
            "`--json` and `-o -` both write to standard output; leave one of them out"
        );
        ensure!(
            target != Target::Stream || !std::io::stdout().is_terminal(),
            "a picture is nothing for a terminal; send it on (`-o - > FILE`), or name a file"
        );
        let mut layers = self.picture.layers()?;
        let orders = self.files.iter().map(|file| Order::of(file, &mut layers, &target));
        let orders = orders.collect::<Result<Vec<Order>>>()?;
        let inputs: Vec<_> = self.files.iter().cloned().zip(orders.iter().map(|o| o.format)).collect();
        let store = ProfileStore::of_user();
        for fault in &store.faults {
            crate::say(format_args!("warning: {fault}; it is not used"));
        }
        let (jobs, mut outputs) = self.open(&inputs, &target, &orders, common)?;
        common.start_threads();

        let progress = Progress::new(&jobs, common.quiet);
        let mut failures = 0;
        for (number, (job, order)) in jobs.iter().zip(&orders).enumerate() {
            progress.begin(number, job);
            let settings = self.settings(order);
            let step = |step| progress.step(step);
            let control = Control { step: Some(&step), ..Control::default() };
            let late = |failure: &Failure| {
                if self.json {
                    // The program ends here: whoever should read this line is told by the exit code too.
                    let _ = print_line(order, failed(job, failure));
                }
            };
            let output = outputs.get_mut(number).and_then(Option::take);
            let mut result = self.deadline.over(&job.input, jobs.len() - number - 1, late, || {
                let output = output.unwrap_or_else(|| open_output(job, &settings))?;
                darkroot::develop_into(output, job, || files::read(&job.input), &settings, &store, control)
            });
            match &mut result {
                Ok(report) => {
                    report.notes.extend(order.notes.iter().cloned());
                    if !common.quiet {
                        progress.say(&words(report, order, common.verbose));
                    }
                }
                Err(error) => progress.say(&format!("error: {}", hint::words(error))),
            }
            failures += usize::from(result.is_err());
            if self.json {
                print_json(job, order, &result)?;
            }
        }
        progress.finish();
        if failures > 0 && jobs.len() > 1 {
            crate::say(format_args!("{} of {} files failed", failures, jobs.len()));
        }
        Ok(if failures == 0 { Outcome::Done } else { Outcome::SomeFailed })
    }

    fn settings(&self, order: &Order) -> Settings {
        Settings { overwrite: self.overwrite, ..order.settings.clone() }
    }

    /// Plans the outputs and gives up everything else, before a byte of an input is read. Outputs are opened first, so
    /// that nothing but they can be written; of very many files only their folders are kept.
    fn open(
        &self,
        inputs: &[(PathBuf, Format)],
        target: &Target,
        orders: &[Order],
        common: Common,
    ) -> Result<(Vec<Job>, Opened)> {
        let named = orders.iter().flat_map(|order| sandbox::named(&order.settings));
        let reach = sandbox::reading(&self.files).with_any(named, Access::Read);
        self.sandbox.say(common);
        if let Some(root) = target.root().filter(|_| target.needs_headers()) {
            // The names of the outputs come out of the files.
            self.sandbox.confine(&sandbox::writing(reach.clone(), &root.join("output")))?;
        }
        let jobs = plan_outputs(inputs, target)?;
        make_folders(target, &jobs)?;
        if jobs.len() > OPEN_AT_ONCE {
            let reach = jobs.iter().fold(reach, |reach, job| sandbox::writing(reach, &job.output));
            self.sandbox.confine(&reach)?;
            return Ok((jobs, Vec::new()));
        }
        let open = |(job, order)| open_output(job, &self.settings(order));
        let outputs: Vec<_> = jobs.iter().zip(orders).map(open).collect();
        let open = outputs.iter().filter_map(|output| output.as_ref().ok());
        let reach = open.fold(reach, |reach, output| sandbox::naming(reach, output, self.overwrite));
        self.sandbox.confine(&reach)?;
        Ok((jobs, outputs.into_iter().map(Some).collect()))
    }
}

/// Outputs by job, open or with the reason why they are not, until they are taken.
type Opened = Vec<Option<Result<Output, Error>>>;

/// Outputs that are opened before the first file is read; each takes three descriptors.
const OPEN_AT_ONCE: usize = 64;

/// Makes the folders that a folder or a template names; the folder of a file must be there.
fn make_folders(target: &Target, jobs: &[Job]) -> Result<()> {
    let folders: Vec<&Path> = match target {
        Target::Folder(folder) => vec![folder],
        Target::Template(_) => jobs.iter().filter_map(|job| job.output.parent()).collect(),
        Target::Beside | Target::File(_) | Target::Stream => return Ok(()),
    };
    for folder in folders {
        std::fs::create_dir_all(folder).map_err(|e| {
            anyhow::anyhow!("{}: the folder cannot be made: {e}; choose another `-o`", shown(folder))
        })?;
    }
    Ok(())
}

/// What was done to a file, for a person.
fn words(report: &Report, order: &Order, verbose: bool) -> String {
    let mut text = format!(
        "{} -> {} ({} x {}, {}, {} bits, {:.2} s)\n  colours: {}",
        shown(&report.input),
        shown(&report.output),
        report.width,
        report.height,
        report.space,
        report.bits,
        report.seconds,
        shown(&report.colours),
    );
    if let Some(profile) = &report.profile {
        text += &format!(", {}", shown(profile));
    }
    let sources = sources(&order.effective);
    if !sources.is_empty() {
        text += &format!("\n  settings: {sources}");
    }
    if verbose {
        let [r, g, b] = report.multipliers;
        text += &format!(
            "\n  camera: {}; decoder: {}; engine: {}",
            shown(&report.camera),
            report.decoder,
            report.engine
        );
        text += &format!("\n  white balance: {r:.3} {g:.3} {b:.3}");
        if let (Some(kelvin), Some(tint)) = (report.kelvin, report.tint) {
            text += &format!(" ({kelvin:.0} K, tint {tint:+.0})");
        }
        text += &format!("\n  demosaic: {}; exposure: x {:.3}", report.demosaic, report.gain);
    }
    for note in &report.notes {
        text += &format!("\n  note: {}", shown(note));
    }
    text
}

fn print_json(job: &Job, order: &Order, result: &Result<Report, darkroot::Error>) -> Result<()> {
    let line = match result {
        Ok(report) => {
            let mut line = serde_json::to_value(report)?;
            line["status"] = "done".into();
            line
        }
        Err(error) => failed(job, error),
    };
    print_line(order, line)
}

/// What is said of a file that failed.
fn failed(job: &Job, error: &(dyn std::error::Error + 'static)) -> serde_json::Value {
    serde_json::json!({
        "status": "failed", "input": path_text::text(&job.input), "output": path_text::text(&job.output),
        "error": hint::words(error),
    })
}

fn print_line(order: &Order, mut line: serde_json::Value) -> Result<()> {
    line["settings_from"] = source_paths(&order.effective).into();
    writeln!(crate::out::json(), "{line}")?;
    Ok(())
}
