//! A batch that was started elsewhere, as far as its journal tells.

use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use darkroot_batch::history::{History, Known};
use darkroot_batch::{JournalError, journal};

use crate::running::{Failure, Finished, LINES, Phase, Told};
use crate::state::locked;

/// A folder of pictures with a journal.
pub(crate) struct Watched {
    pub(crate) out: PathBuf,
    seen: Mutex<Seen>,
}

struct Seen {
    history: History,
    /// Size of all journals when they were read.
    size: u64,
    /// Since when nothing was added.
    quiet: Instant,
    fault: Option<String>,
    /// Seconds since the first change that was seen, and megapixels done until then.
    since: Option<(Instant, f64)>,
}

/// For how long a batch may add nothing and still be at work.
const PATIENCE: Duration = Duration::from_secs(20);

impl Watched {
    /// Reads the journals of a folder.
    ///
    /// # Errors
    /// There is none, or it cannot be read.
    pub(crate) fn open(out: PathBuf) -> Result<Self, JournalError> {
        let size = size(&out);
        let history = merged(&out)?;
        let long_ago = Instant::now().checked_sub(PATIENCE).unwrap_or_else(Instant::now);
        let seen = Seen { history, size, quiet: long_ago, fault: None, since: None };
        Ok(Self { out, seen: Mutex::new(seen) })
    }

    /// What is to be said.
    pub(crate) fn told(&self) -> Told {
        let mut seen = locked(&self.seen);
        let now = size(&self.out);
        if now != seen.size || seen.fault.is_some() {
            match merged(&self.out) {
                Ok(history) => {
                    if seen.since.is_none() {
                        seen.since = Some((Instant::now(), megapixels(&seen.history)));
                    }
                    (seen.history, seen.size, seen.quiet, seen.fault) = (history, now, Instant::now(), None);
                }
                Err(error) => seen.fault = Some(error.to_string()),
            }
        }
        told(&seen)
    }

    /// What became of files, by their path below their root.
    pub(crate) fn states(&self) -> Vec<(PathBuf, &'static str)> {
        let seen = locked(&self.seen);
        let one = |known: &Known| {
            let failed = known.failed.as_ref().map(|failed| (failed.input.as_str(), "failed"));
            let (input, state) = failed.or_else(|| Some((known.done.as_ref()?.input.as_str(), "done")))?;
            Some((darkroot::path_text::path(input), state))
        };
        seen.history.outputs.values().filter_map(one).collect()
    }
}

fn merged(out: &std::path::Path) -> Result<History, JournalError> {
    let mut all = History::default();
    journal::read_all(out)?.into_iter().for_each(|(_, history)| all.merge(history));
    Ok(all)
}

/// Size of all journals, bytes: they only ever grow.
fn size(out: &std::path::Path) -> u64 {
    let entries = std::fs::read_dir(out.join(darkroot_batch::facts::FOLDER)).into_iter().flatten().flatten();
    let journals = entries.filter(|entry| entry.file_name().as_encoded_bytes().starts_with(b"journal"));
    journals.filter_map(|entry| Some(entry.metadata().ok()?.len())).sum()
}

fn megapixels(history: &History) -> f64 {
    let done = history.outputs.values().filter_map(|known| known.done.as_ref());
    done.map(|done| (done.width * done.height) as f64 / 1e6).sum()
}

fn told(seen: &Seen) -> Told {
    let outputs = &seen.history.outputs;
    let all = || outputs.values();
    let name = |text: &str| darkroot::shown(&darkroot::path_text::path(text));
    let mut failed: Vec<_> = all().filter_map(|known| known.failed.as_ref()).collect();
    failed.sort_by(|a, b| b.at.cmp(&a.at));
    let mut done: Vec<_> =
        all().filter(|known| known.failed.is_none()).filter_map(|known| known.done.as_ref()).collect();
    done.sort_by(|a, b| b.at.cmp(&a.at));
    let mut at_work: Vec<String> = outputs
        .iter()
        .filter(|(_, known)| known.open && known.failed.is_none())
        .map(|(output, _)| name(output))
        .collect();
    at_work.sort();
    let quiet = seen.quiet.elapsed() >= PATIENCE;
    let rate = seen.since.filter(|_| !quiet).and_then(|(since, before)| {
        let seconds = since.elapsed().as_secs_f64();
        (seconds > 1.0).then(|| (megapixels(&seen.history) - before) / seconds)
    });
    let mut notes: Vec<String> = seen.fault.iter().cloned().collect();
    if seen.history.damaged > 0 {
        notes.push(format!("{} torn or damaged lines of the journal are passed over", seen.history.damaged));
    }
    // Also what this run is not about, which an earlier one was.
    let total = seen.history.files.map(|files| files.max(outputs.len()));
    let left = total.map(|total| total.saturating_sub(done.len() + failed.len()) as f64);
    let each = megapixels(&seen.history) / done.len().max(1) as f64;
    Told {
        kind: "watched",
        total,
        left: left.zip(rate.filter(|rate| *rate > 0.0)).map(|(left, rate)| (left * each / rate).round()),
        phase: match (at_work.is_empty(), quiet) {
            (_, false) => Phase::Running,
            // It was ended in the midst of something.
            (false, true) => Phase::Paused,
            (true, true) => Phase::Done,
        },
        done: done.len(),
        failed: failed.len(),
        megapixels: megapixels(&seen.history),
        rate: rate.map(|rate| (rate * 10.0).round() / 10.0),
        at_work,
        failures: failed
            .iter()
            .take(LINES)
            .map(|failed| Failure { input: name(&failed.input), words: failed.error.clone() })
            .collect(),
        recent: done
            .iter()
            .take(LINES)
            .map(|done| Finished {
                input: name(&done.input),
                output: name(&done.output),
                seconds: done.seconds,
            })
            .collect(),
        notes,
        ..Told::default()
    }
}
