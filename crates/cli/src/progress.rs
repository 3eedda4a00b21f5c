//! The progress bar: on a terminal, for several files or a long one.

use std::io::IsTerminal;

use darkroot::shown;
use darkroot::{Job, Step};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A file of this size takes long enough to show that something happens.
const LONG_FILE: u64 = 40_000_000;
/// Steps of one file.
const STEPS: u64 = 3;

pub(crate) struct Progress {
    bar: ProgressBar,
    /// Number of the file that is being developed, from 0.
    file: std::cell::Cell<u64>,
}

impl Progress {
    pub(crate) fn new(jobs: &[Job], quiet: bool) -> Self {
        let long = jobs.len() > 1
            || jobs.iter().any(|j| std::fs::metadata(&j.input).is_ok_and(|m| m.len() > LONG_FILE));
        let shown = !quiet && long && std::io::stderr().is_terminal();
        let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(jobs.len() as u64 * STEPS), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {elapsed} (left: {eta}) {msg}") {
            bar.set_style(style);
        }
        Self { bar, file: std::cell::Cell::new(0) }
    }

    /// File number `number` (from 0) begins.
    pub(crate) fn begin(&self, number: usize, job: &Job) {
        self.file.set(number as u64);
        self.bar.set_message(shown(&job.input));
    }

    /// A step of the file begins: the ones before it are done.
    pub(crate) fn step(&self, step: Step) {
        let done = match step {
            Step::Decode => 0,
            Step::Develop => 1,
            Step::Write => 2,
        };
        self.bar.set_position(self.file.get() * STEPS + done);
    }

    /// Words for the person, above the bar.
    pub(crate) fn say(&self, words: &str) {
        self.bar.suspend(|| crate::say(format_args!("{words}")));
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
