//! What a run tells while it goes on, and how it came out.

use std::path::PathBuf;

use super::failure::Failure;
use super::item::Item;
use super::journal::JournalError;
use super::record::Done;
use super::wording::Wording;
use darkroot::shown;

/// What happens to a file.
#[derive(Debug)]
pub enum Event<'a> {
    /// A worker has it now.
    Begun(&'a Item),
    /// It is done.
    Done {
        /// The file.
        item: &'a Item,
        /// As it stands in the journal.
        done: &'a Done,
        /// What gave the colours, in words.
        colours: &'a str,
        /// A small JPEG as base 64, if asked for.
        thumbnail: Option<&'a str>,
    },
    /// It failed.
    Failed {
        /// The file.
        item: &'a Item,
        /// Why.
        failure: &'a Failure,
        /// The same in one sentence, as the program words it.
        words: &'a str,
    },
    /// It seems to be still growing and is tried again later.
    Later(&'a Item),
    /// It was not there any more when its turn came; no failure, while watching.
    Gone(&'a Item),
    /// No more files are begun.
    Stopping {
        /// Why.
        reason: &'a StopReason,
        /// The same in one sentence, as the program words it.
        words: &'a str,
    },
}

/// Why no more files are begun.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StopReason {
    /// The output folder is not there any more.
    #[error("{path}: the output folder is gone; bring it back and run again", path = shown(path))]
    FolderGone {
        /// The folder.
        path: PathBuf,
    },
    /// The journal cannot be written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A file failed in a way that no other would escape: the disk is full.
    #[error(transparent)]
    Failure(#[from] Failure),
}

impl StopReason {
    /// In words, as the program words it.
    pub(crate) fn words(&self, wording: &Wording) -> String {
        match self {
            Self::Failure(failure) => failure.words(wording),
            other => wording.of(other),
        }
    }
}

/// How a run came out.
#[derive(Debug, Default)]
pub struct Summary {
    /// Files developed.
    pub done: usize,
    /// Files that failed, conflicts among them.
    pub failed: usize,
    /// Files that were done before.
    pub skipped: usize,
    /// Files that vanished before their turn came, while watching.
    pub gone: usize,
    /// Files that are left because the run was stopped.
    pub left: usize,
    /// Why it was stopped before the end, if the disk or the output folder was the reason.
    pub stopped: Option<StopReason>,
    /// Whether a person or the system wanted it to stop.
    pub interrupted: bool,
    /// Pixels developed.
    pub pixels: u64,
    /// Seconds of the whole run.
    pub seconds: f64,
    /// Most memory that one worker process held, or this process where its threads are the workers, bytes; 0 where the
    /// system does not tell.
    pub peak: u64,
    /// Most memory that was set aside for one worker, bytes.
    pub estimated: u64,
}
