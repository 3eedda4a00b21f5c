//! `darkroot batch`, `darkroot batch status` and the worker process behind them.

mod options;
mod shown;
mod status;
mod watch;
mod worker;

use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, Subcommand};
use darkroot::ProfileStore;
use darkroot_batch::{
    Batch as Run, BatchPlan, Event, Experience, Session, SettingsByFile, Sheet, State, Summary, find, journal,
};

pub(crate) use options::Work;
pub(crate) use shown::Shown;
pub(crate) use watch::Watch;
pub(crate) use worker::Worker;

use crate::{Common, Outcome, interrupt};

/// Develop folders of raw photographs
///
/// The plan is made first: collisions and wrong settings are found before anything is written. A journal in OUT
/// says what was done, so that the same command again does only what is left, whatever ended the run before.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Batch {
    #[command(subcommand)]
    command: Option<Command>,

    #[command(flatten)]
    work: Work,

    /// Say what would be done, with sizes and an estimate, and write nothing; where no journal tells how long such files
    /// take, a few of them are developed for that, and thrown away
    #[arg(long)]
    dry_run: bool,

    /// Read all outputs again and compare them with the journal; damaged ones are made anew
    #[arg(long)]
    verify: bool,

    /// Develop everything again, also what is done and unchanged
    #[arg(long)]
    redo: bool,

    /// Report every event as a line of JSON on stdout
    #[arg(long)]
    json: bool,

    /// Write a report: FILE.html is a contact sheet, FILE.json for programs
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Status(status::Status),
}

impl Batch {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        if let Some(Command::Status(status)) = self.command {
            return status.run();
        }
        let work = &self.work;
        let out = work.out()?;
        let chart = work.chart_shot()?;
        let mut options = work.plan_options()?;
        options.redo = self.redo;
        options.verify = self.verify;
        let crew = work.crew(common)?;
        let jobs = crew.jobs;
        let store = ProfileStore::of_user();
        let mut shown = Shown::new(common, self.json);
        for fault in &store.faults {
            shown.warn(&format!("{fault}; it is not used"));
        }
        let mut settings = SettingsByFile::new(work.picture.layers()?);
        let stop = interrupt::stop();
        let sources = find(&work.search(), &out)?;

        if self.dry_run {
            let history = journal::read_merged(&out)?;
            let plan =
                darkroot_batch::plan_only(sources, &options, &mut settings, &history, &store, crew.clone())?;
            let mut experience = Experience::of(&history);
            if experience.is_empty() {
                // Without a place for a few trials, or a worker, typical figures serve.
                experience = darkroot_batch::trial(&plan, crew, &stop).unwrap_or_default();
            }
            shown.plan(&plan, &experience.estimate(&plan, jobs))?;
            return Ok(if faults(&plan) == 0 { Outcome::Done } else { Outcome::SomeFailed });
        }

        if sources.files.is_empty() {
            shown.warn(
                "no raw files were found; `--include PATTERN` takes files that are not named like raw files",
            );
        }
        darkroot_batch::check(&sources, &options, &mut settings)?;
        let mut sheet = Sheet::new(&self.report)?;
        let mut run = Run::open(&options, crew, store)?.with_thumbnails(sheet.wants_thumbnails());
        if run.history().damaged > 0 {
            shown.warn(&format!(
                "{} torn or damaged lines of the journal are passed over",
                run.history().damaged
            ));
        }
        let session = match &chart {
            Some(chart) => run.session(&sources, chart, &stop, &mut |words| shown.note(words))?,
            None => Session::default(),
        };
        let plan = run.plan(sources, &options, &mut settings, &session, &stop)?;
        shown.begin(&plan)?;
        let mut broken = None;
        let mut on_event = |event: Event<'_>| {
            sheet.record(&event);
            broken = broken.take().or(shown.event(&event).err());
        };
        let summary = run.run(&plan, &stop, &mut on_event)?;
        if sheet.wants_thumbnails() && !summary.interrupted {
            run.thumbnails_of_done(&plan, &stop, &mut |item, picture| sheet.picture(item, picture))?;
        }
        shown.end(&plan, &summary)?;
        sheet.write(&plan, &summary)?;
        broken.map_or(Ok(()), Err)?;
        Ok(outcome(&plan, &summary))
    }
}

/// Things that went wrong with a plan before anything ran.
fn faults(plan: &BatchPlan) -> usize {
    let conflicts = plan.items.iter().filter(|i| matches!(i.state, State::Conflict(_))).count();
    plan.faults.len() + conflicts
}

pub(crate) fn outcome(plan: &BatchPlan, summary: &Summary) -> Outcome {
    if summary.interrupted {
        Outcome::Interrupted
    } else if summary.failed > 0 || summary.left > 0 || !plan.faults.is_empty() {
        Outcome::SomeFailed
    } else {
        Outcome::Done
    }
}
