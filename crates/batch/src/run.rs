//! One run of a plan: events as files come and go, the journal, and what stops it all.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use darkroot::VERSION;

use super::facts::modified;
use super::failure::{Conflict, Failure, FailureKind};
use super::find::Source;
use super::history::History;
use super::item::{BatchPlan, Item};
use super::journal::{self, Journal, JournalError};
use super::names;
use super::outcome::{Event, StopReason, Summary};
use super::record::{Done, Failed, Record};
use super::task::{Answer, Developed, Task};
use super::wording::Wording;
use super::work::{Next, Progress, Work};

/// How often a file that is still being written is tried again, and after what pause.
const TRIES: usize = 5;
const PAUSE: Duration = Duration::from_secs(2);
/// A damaged file that was changed less than this ago may be one that is still being written.
const FRESH: Duration = Duration::from_secs(3);

/// A run in progress.
pub(crate) struct Run<'a> {
    pub(crate) plan: &'a BatchPlan,
    pub(crate) out: &'a Path,
    pub(crate) journal: &'a mut Journal,
    pub(crate) history: &'a mut History,
    pub(crate) summary: Summary,
    /// How often a file was tried again.
    pub(crate) tries: HashMap<usize, usize>,
    /// Files whose output may stand in its place, made by a worker or a run that was ended before it could say so.
    pub(crate) in_doubt: HashSet<usize>,
    pub(crate) inputs_may_vanish: bool,
    pub(crate) on_event: &'a mut dyn FnMut(Event<'_>),
    pub(crate) wording: Wording,
}

impl<'a> Run<'a> {
    pub(crate) fn on_progress(&mut self, work: &Work, progress: Progress) -> Next {
        let item = &self.plan.items[work.id];
        match progress {
            Progress::Begins => self.begun(work, item),
            Progress::Ended(Ok(Answer::Developed(developed))) => self.done(item, *developed),
            Progress::Ended(Ok(_)) => Next::GoOn,
            Progress::Ended(Err(failure)) => self.failed(work.id, item, &failure),
        }
    }

    fn begun(&mut self, work: &Work, item: &'a Item) -> Next {
        if let Some(reason) = self.vanished() {
            return self.stop(reason);
        }
        if let Some(path) = in_the_way(work) {
            self.conflict(item, &Conflict::NotOurs { path });
            return Next::Leave;
        }
        let first = !self.tries.contains_key(&work.id);
        let interrupted = first && self.history.outputs.get(&item.output).is_some_and(|known| known.open);
        if work.second_try || interrupted {
            self.in_doubt.insert(work.id);
        }
        let number = names::needs_number(&self.plan.template).then_some(item.number);
        let (input, output) = (item.source.key.clone(), item.output.clone());
        let of = (!self.inputs_may_vanish).then_some(self.plan.items.len());
        let record = Record::Begun { input, output, number, of };
        if let Err(error) = self.write(record) {
            return self.stop(error);
        }
        (self.on_event)(Event::Begun(item));
        Next::GoOn
    }

    fn done(&mut self, item: &'a Item, developed: Developed) -> Next {
        let Developed { colours, thumbnail, peak, needed, .. } = &developed;
        let (colours, thumbnail, peak, needed) = (colours.clone(), thumbnail.clone(), *peak, *needed);
        let done = Done {
            input: item.source.key.clone(),
            output: item.output.clone(),
            source: developed.source,
            settings: item.settings_hash(&developed.camera),
            camera: developed.camera,
            profile: developed.profile,
            files: item.files.clone(),
            written: developed.written,
            width: developed.width,
            height: developed.height,
            seconds: developed.seconds,
            notes: developed.notes,
            number: names::needs_number(&self.plan.template).then_some(item.number),
            program: VERSION.to_owned(),
            at: journal::now(),
        };
        if let Err(error) = self.write(Record::Done(Box::new(done.clone()))) {
            // The picture is there; the next run makes it again, as the journal does not know of it.
            return self.stop(error);
        }
        self.summary.done += 1;
        self.summary.pixels += done.width as u64 * done.height as u64;
        self.summary.peak = self.summary.peak.max(peak);
        self.summary.estimated = self.summary.estimated.max(needed);
        (self.on_event)(Event::Done {
            item,
            done: &done,
            colours: &colours,
            thumbnail: thumbnail.as_deref(),
        });
        Next::GoOn
    }

    fn failed(&mut self, id: usize, item: &'a Item, failure: &Failure) -> Next {
        if self.inputs_may_vanish && item.source.path.symlink_metadata().is_err() {
            return self.gone(item);
        }
        let kind = failure.kind();
        match kind {
            FailureKind::DiskFull => return self.stop(failure.clone()),
            FailureKind::Output | FailureKind::Died => {
                if let Some(reason) = self.vanished() {
                    return self.stop(reason);
                }
            }
            FailureKind::Changing | FailureKind::File => {
                let tries = self.tries.entry(id).or_default();
                let unsettled = kind == FailureKind::Changing || is_fresh(&item.source);
                if unsettled && *tries < TRIES {
                    *tries += 1;
                    (self.on_event)(Event::Later(item));
                    return Next::Again(PAUSE);
                }
            }
        }
        let words = failure.words(&self.wording);
        let record = Record::Failed(Failed {
            input: item.source.key.clone(),
            output: item.output.clone(),
            error: words.clone(),
            died: kind == FailureKind::Died || self.in_doubt.contains(&id),
            program: VERSION.to_owned(),
            at: journal::now(),
        });
        if let Err(error) = self.write(record) {
            return self.stop(error);
        }
        self.summary.failed += 1;
        (self.on_event)(Event::Failed { item, failure, words: &words });
        Next::GoOn
    }

    fn gone(&mut self, item: &'a Item) -> Next {
        let record = Record::Gone { input: item.source.key.clone(), output: item.output.clone() };
        if let Err(error) = self.write(record) {
            return self.stop(error);
        }
        self.summary.gone += 1;
        (self.on_event)(Event::Gone(item));
        Next::GoOn
    }

    fn write(&mut self, record: Record) -> Result<(), JournalError> {
        self.journal.append(std::slice::from_ref(&record))?;
        self.history.add(record);
        Ok(())
    }

    /// A file that cannot be developed because another picture is in the way.
    pub(crate) fn conflict(&mut self, item: &Item, conflict: &Conflict) {
        self.summary.failed += 1;
        let words = self.wording.of(conflict);
        let failure = Failure::from(conflict.clone());
        (self.on_event)(Event::Failed { item, failure: &failure, words: &words });
    }

    /// What is wrong when the output folder is not there any more.
    fn vanished(&self) -> Option<StopReason> {
        (!self.journal.is_there()).then(|| StopReason::FolderGone { path: self.out.to_owned() })
    }

    fn stop(&mut self, reason: impl Into<StopReason>) -> Next {
        if self.summary.stopped.is_none() {
            let reason = reason.into();
            let words = reason.words(&self.wording);
            (self.on_event)(Event::Stopping { reason: &reason, words: &words });
            self.summary.stopped = Some(reason);
        }
        Next::Finish
    }
}

/// What stands at the output of a task that must not replace it: it came after the plan was made, so it is not ours, and
/// the journal must not say that it is.
fn in_the_way(work: &Work) -> Option<PathBuf> {
    match &work.task {
        Task::Develop(task) if !task.overwrite && task.output.symlink_metadata().is_ok() => {
            Some(task.output.clone())
        }
        _ => None,
    }
}

/// Whether a file changed since the plan was made, or just now.
fn is_fresh(source: &Source) -> bool {
    let Ok(data) = std::fs::metadata(&source.path) else { return false };
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos() as i64);
    let age = now - modified(&data);
    let just_changed = (0..FRESH.as_nanos() as i64).contains(&age);
    just_changed || data.len() != source.size
}
