//! `darkroot watch`.

use std::time::Duration;

use anyhow::{Error, Result};
use clap::Args;
use darkroot::ProfileStore;
use darkroot_batch::{Batch, Notice, SettingsByFile, Stop, WatchOptions, Watched, watch};
use serde_json::json;

use super::options::Work;
use super::shown::Shown;
use crate::values;
use crate::{Common, Outcome, interrupt};

/// Develop what comes into folders, until told to stop
///
/// A file is developed when it has stopped growing, once, and again when it changes. The journal in OUT is that of
/// `batch`: after a restart the watch goes on where it was, and tries those that failed once more.
///
/// Settings (options, `darkroot.toml`, sidecars) count as they are when a file is developed. A picture that is there
/// already is not made anew when they change, nor when it is taken out of OUT: the same IN and OUT with `batch` does
/// that.
///
/// Wrong recipes, names that collide and pictures in the way are reported and waited out; a folder that is not there
/// is waited for. Ctrl-C or SIGTERM finish the files in flight and end with 0; a second one abandons them and ends
/// with 130. A full disk or a lost OUT ends the watch with 1.
#[derive(Debug, Args)]
pub(crate) struct Watch {
    #[command(flatten)]
    work: Work,

    /// A file is developed when its size and time of change have been the same for this long
    #[arg(long, value_name = "TIME", default_value = "2s", value_parser = values::time, help_heading = "Watch")]
    settle: Duration,

    /// Look this often, instead of when the system tells of changes; for shares that other machines write to
    /// [default: 5s on shares]
    #[arg(long, value_name = "TIME", value_parser = values::time, help_heading = "Watch")]
    poll: Option<Duration>,

    /// Report every event as a line of JSON on stdout
    #[arg(long)]
    json: bool,
}

impl Watch {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        let work = &self.work;
        let options = WatchOptions {
            search: work.search(),
            plan: work.plan_options()?,
            settle: self.settle,
            poll: self.poll,
            chart: work.chart_shot()?,
        };
        let store = ProfileStore::of_user();
        let shown = Shown::new(common, self.json).without_bar();
        for fault in &store.faults {
            shown.warn(&format!("{fault}; it is not used"));
        }
        let stop = interrupt::stop();
        let mut batch = Batch::open(&options.plan, work.crew(common)?, store)?;
        if batch.history().damaged > 0 {
            let lines = batch.history().damaged;
            shown.warn(&format!("{lines} torn or damaged lines of the journal are passed over"));
        }
        // Read anew each time: files of settings may have changed.
        let mut settings = || work.picture.layers().map(SettingsByFile::new);
        let mut told = Told { shown, common, options: &options, stop: &stop, broken: None };
        let watched = watch(&mut batch, &options, &mut settings, &stop, &mut |notice| told.notice(&notice))?;
        told.end(&watched)?;
        Ok(match watched.stopped {
            Some(_) => Outcome::SomeFailed,
            None if stop.at_once() => Outcome::Interrupted,
            None => Outcome::Done,
        })
    }
}

/// What a person, or a program, is told.
struct Told<'a> {
    shown: Shown,
    common: Common,
    options: &'a WatchOptions,
    stop: &'a Stop,
    /// That nobody reads stdout any more.
    broken: Option<Error>,
}

impl Told<'_> {
    fn notice(&mut self, notice: &Notice<'_>) {
        let result = self.try_notice(notice);
        if let Err(error) = result {
            // Without its reader the watch ends in order.
            if self.broken.is_none() {
                self.stop.ask();
            }
            self.broken = self.broken.take().or(Some(error));
        }
    }

    fn try_notice(&mut self, notice: &Notice<'_>) -> Result<()> {
        let shown = &mut self.shown;
        match notice {
            Notice::Watching { polling, why } => {
                let often = polling.map(|t| humantime::format_duration(t).to_string());
                match (&often, why) {
                    (Some(often), Some(why)) => shown.note(&format!("{why}: looking every {often}")),
                    _ => {
                        let (inputs, out) = (
                            self.options
                                .search
                                .inputs
                                .iter()
                                .map(|i| named(i))
                                .collect::<Vec<_>>()
                                .join(", "),
                            darkroot::shown(&self.options.plan.out),
                        );
                        let how = often.map_or_else(String::new, |often| format!(", looking every {often}"));
                        shown.note(&format!("watching {inputs} -> {out}{how}"));
                    }
                }
                shown.line(&json!({
                    "event": "watching", "inputs": self.options.search.inputs, "output_folder": darkroot::path_text::text(&self.options.plan.out),
                    "polling_seconds": polling.map(|t| t.as_secs_f64()), "why": why,
                }))
            }
            Notice::File(event) => shown.event(event),
            Notice::Held { source, words } => {
                shown.say(&format!("error: {words}"));
                shown.line(&json!({ "event": "held", "input": darkroot::path_text::text(&source.path), "error": words }))
            }
            Notice::Fault(fault) => {
                let words = crate::hint::words(*fault);
                shown.say(&format!("error: {words}"));
                shown.line(&json!({ "event": "fault", "error": words }))
            }
            Notice::Away(input) => {
                shown.say(&format!("{}: is not there; waiting for it", named(input)));
                shown.line(&json!({ "event": "away", "input": input }))
            }
            Notice::Back(input) => {
                shown.note(&format!("{}: is there", named(input)));
                shown.line(&json!({ "event": "back", "input": input }))
            }
            Notice::Outdated(files) => {
                shown.note(&format!(
                    "{files} pictures were made with other settings, or are gone from the output folder; they are \
                     left so (`darkroot batch` makes them anew)"
                ));
                shown.line(&json!({ "event": "outdated", "files": files }))
            }
            Notice::Colours(words) => {
                shown.note(words);
                shown.line(&json!({ "event": "colours", "words": words }))
            }
        }
    }

    fn end(mut self, watched: &Watched) -> Result<()> {
        if let Some(error) = self.broken.take() {
            return Err(error);
        }
        let Watched { done, failed, held, stopped } = watched;
        let stopped = stopped.as_ref().map(|reason| crate::hint::words(reason));
        if !self.common.quiet {
            self.shown.say(&format!("developed {done}, failed {failed}, waiting {held}"));
        }
        self.shown.line(&json!({
            "event": "end", "done": done, "failed": failed, "held": held, "stopped": stopped,
        }))
    }
}

/// An input, for people.
fn named(input: &str) -> String {
    darkroot::shown(&darkroot::path_text::path(input))
}
