//! What a person, or a program, sees of a batch: a bar on a terminal, a line a file elsewhere, JSON lines.

use std::io::{IsTerminal, Write};
use std::time::Duration;

use anyhow::Result;
use darkroot_batch::{BatchPlan, Estimate, Event, Item, State, Summary, Why};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;

use crate::Common;
use darkroot::{path_text, shown};

pub(crate) struct Shown {
    common: Common,
    json: bool,
    bar: ProgressBar,
    /// Whether the bar is seen: then finished files need no line.
    terminal: bool,
    pixels: u64,
    failed: usize,
}

impl Shown {
    pub(crate) fn new(common: Common, json: bool) -> Self {
        let terminal = !common.quiet && std::io::stderr().is_terminal();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        Self { common, json, bar, terminal, pixels: 0, failed: 0 }
    }

    pub(crate) fn say(&self, words: &str) {
        self.bar.suspend(|| crate::say(format_args!("{words}")));
    }

    pub(crate) fn line(&self, value: &serde_json::Value) -> Result<()> {
        if self.json {
            let mut out = crate::out::json();
            writeln!(out, "{value}")?;
            out.flush()?;
        }
        Ok(())
    }

    /// A line a file, on terminals too: for what has no end that a bar could show.
    pub(crate) fn without_bar(mut self) -> Self {
        self.terminal = false;
        self
    }

    pub(crate) fn warn(&self, words: &str) {
        self.say(&format!("warning: {words}"));
    }

    pub(crate) fn note(&self, words: &str) {
        if !self.common.quiet {
            self.say(words);
        }
    }

    /// A plan that is not run.
    pub(crate) fn plan(&self, plan: &BatchPlan, estimate: &Estimate) -> Result<()> {
        for item in &plan.items {
            self.line(&planned(item))?;
            if !self.json {
                let input = shown(&item.source.path);
                let output = shown(&item.place(&plan.out));
                let words = match &item.state {
                    State::Todo(why) => {
                        let size = megabytes(item.source.size);
                        format!("{input} -> {} ({size}, {})", output, reason(*why))
                    }
                    State::Done(_) => format!("{input} -> {} (unchanged)", output),
                    State::Conflict(conflict) => format!("error: {}", crate::hint::words(conflict)),
                };
                writeln!(crate::out::lines(), "{words}")?;
            }
        }
        self.left_out(plan)?;
        self.faults(plan);
        let Estimate { files, bytes, seconds, output_bytes, by_experience } = *estimate;
        self.line(&json!({
            "event": "estimate", "files": files, "bytes": bytes, "seconds": seconds,
            "output_bytes": output_bytes, "by_experience": by_experience,
        }))?;
        let unchanged = plan.items.iter().filter(|i| matches!(i.state, State::Done(_))).count();
        let by =
            if by_experience { "as such files took here" } else { "as such files take on a usual machine" };
        let outputs =
            output_bytes.map_or_else(String::new, |b| format!(", about {} of pictures", megabytes(b)));
        self.note(&format!(
            "{files} files to develop ({}), {unchanged} unchanged; about {}{outputs}, {by}",
            megabytes(bytes),
            duration(seconds)
        ));
        Ok(())
    }

    /// Inputs that others stand for.
    fn left_out(&self, plan: &BatchPlan) -> Result<()> {
        for left in &plan.left_out {
            self.note(&left.words());
            let (input, instead, output) = (&left.input, &left.instead, &left.output);
            self.line(&json!({ "event": "left-out", "input": input, "instead": instead, "output": output }))?;
        }
        Ok(())
    }

    fn faults(&self, plan: &BatchPlan) {
        for fault in &plan.faults {
            self.say(&format!("error: {}", crate::hint::words(fault)));
        }
    }

    /// A plan is about to run.
    pub(crate) fn begin(&mut self, plan: &BatchPlan) -> Result<()> {
        self.left_out(plan)?;
        self.faults(plan);
        for fault in &plan.faults {
            self.line(&json!({ "event": "fault", "error": crate::hint::words(fault) }))?;
        }
        let todo = plan.items.iter().filter(|i| matches!(i.state, State::Todo(_))).count();
        let unchanged = plan.items.iter().filter(|i| matches!(i.state, State::Done(_))).count();
        self.line(
            &json!({ "event": "plan", "files": plan.items.len(), "todo": todo, "unchanged": unchanged }),
        )?;
        for item in &plan.items {
            if item.state == State::Todo(Why::OutputDamaged) {
                self.warn(&format!(
                    "{}: was damaged on the disk since it was written; it is made anew",
                    shown(&item.place(&plan.out))
                ));
            }
        }
        if self.terminal && todo > 0 {
            self.bar = ProgressBar::with_draw_target(Some(todo as u64), ProgressDrawTarget::stderr());
            if let Ok(style) =
                ProgressStyle::with_template("{bar:30} {pos}/{len} files  {msg}  {elapsed} (left: {eta})")
            {
                self.bar.set_style(style);
            }
            self.bar.enable_steady_tick(Duration::from_millis(500));
        }
        Ok(())
    }

    /// Something happened to a file.
    pub(crate) fn event(&mut self, event: &Event<'_>) -> Result<()> {
        match event {
            Event::Begun(item) => {
                self.line(&json!({ "event": "begun", "input": path_text::text(&item.source.path), "output": item.output }))
            }
            Event::Done { item, done, colours, .. } => {
                self.pixels += done.width as u64 * done.height as u64;
                self.advance();
                if !self.common.quiet && (!self.terminal || self.common.verbose) {
                    let mut words = format!(
                        "{} -> {} ({} x {}, {:.2} s; {})",
                        shown(&item.source.path),
                        item.output_shown(),
                        done.width,
                        done.height,
                        done.seconds,
                        shown(*colours)
                    );
                    for note in done.notes.iter().filter(|_| self.common.verbose) {
                        words += &format!("\n  note: {}", shown(note));
                    }
                    self.say(&words);
                }
                let mut value = serde_json::to_value(done)?;
                value["event"] = "done".into();
                value["colours"] = (*colours).into();
                self.line(&value)
            }
            Event::Failed { item, words, .. } => {
                self.failed += 1;
                if matches!(item.state, State::Todo(_)) {
                    self.advance();
                }
                self.say(&format!("error: {words}"));
                self.line(&json!({
                    "event": "failed", "input": path_text::text(&item.source.path), "output": item.output, "error": words,
                }))
            }
            Event::Later(item) => {
                if self.common.verbose {
                    self.say(&format!("{}: may still be growing; tried again", shown(&item.source.path)));
                }
                self.line(&json!({ "event": "later", "input": path_text::text(&item.source.path) }))
            }
            Event::Gone(item) => {
                if self.common.verbose {
                    self.say(&format!("{}: is not there any more", shown(&item.source.path)));
                }
                self.line(&json!({ "event": "gone", "input": path_text::text(&item.source.path) }))
            }
            Event::Stopping { words, .. } => {
                self.say(&format!("error: {words}"));
                self.line(&json!({ "event": "stopping", "error": words }))
            }
        }
    }

    fn advance(&self) {
        self.bar.inc(1);
        let seconds = self.bar.elapsed().as_secs_f64().max(1e-3);
        let failed = if self.failed > 0 { format!(", {} failed", self.failed) } else { String::new() };
        self.bar.set_message(format!("{:.1} MP/s{failed}", self.pixels as f64 / 1e6 / seconds));
    }

    /// The run is over.
    pub(crate) fn end(&mut self, plan: &BatchPlan, summary: &Summary) -> Result<()> {
        self.bar.finish_and_clear();
        let Summary { done, failed, skipped, left, interrupted, pixels, seconds, .. } = *summary;
        let mega = pixels as f64 / 1e6;
        let stopped = summary.stopped.as_ref().map(|reason| crate::hint::words(reason));
        self.line(&json!({
            "event": "summary", "done": done, "failed": failed, "unchanged": skipped, "left": left,
            "faults": plan.faults.len(), "stopped": stopped, "interrupted": interrupted,
            "megapixels": mega, "seconds": seconds, "peak_worker_memory": summary.peak, "estimated_worker_memory": summary.estimated,
        }))?;
        if !self.common.quiet {
            let rate = if seconds > 0.0 { mega / seconds } else { 0.0 };
            self.say(&format!(
                "developed {done:>7}   ({mega:.0} MP in {}, {rate:.1} MP/s)\nunchanged {skipped:>7}\nfailed    \
                 {failed:>7}\nleft      {left:>7}",
                duration(seconds)
            ));
            if left > 0 {
                self.say("the same command again does what is left");
            }
        }
        Ok(())
    }
}

fn planned(item: &Item) -> serde_json::Value {
    let (action, why, error) = match &item.state {
        State::Todo(why) => ("develop", serde_json::to_value(why).ok(), None),
        State::Done(_) => ("unchanged", None, None),
        State::Conflict(conflict) => ("conflict", None, Some(crate::hint::words(conflict))),
    };
    json!({
        "event": "planned", "input": path_text::text(&item.source.path), "output": item.output, "bytes": item.source.size,
        "action": action, "why": why, "error": error,
    })
}

fn reason(why: Why) -> &'static str {
    match why {
        Why::New => "new",
        Why::Interrupted => "was interrupted",
        Why::FailedBefore => "failed before",
        Why::InputChanged => "the input changed",
        Why::SettingsChanged => "the settings changed",
        Why::ProfileChanged => "the profile changed",
        Why::FileChanged => "a file that the settings name changed",
        Why::OutputMissing => "the output is missing",
        Why::OutputDamaged => "the output is damaged",
        Why::Asked => "again, as asked",
    }
}

/// Bytes for people.
pub(crate) fn megabytes(bytes: u64) -> String {
    darkroot_batch::failure::bytes_text(bytes)
}

/// Seconds for people.
pub(crate) fn duration(seconds: f64) -> String {
    if seconds < 10.0 {
        return format!("{seconds:.1} s");
    }
    humantime::format_duration(Duration::from_secs(seconds as u64)).to_string()
}
