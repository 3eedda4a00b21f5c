//! What a run tells while it goes on, and how it came out.

use std::path::PathBuf;

use super::journal::JournalError;
use super::plan::{Item, PlanError};
use super::record::Done;

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
        /// One sentence.
        error: &'a str,
    },
    /// It seems to be still growing and is tried again later.
    Later(&'a Item),
    /// It was not there any more when its turn came; no failure, while watching.
    Gone(&'a Item),
    /// No more files are begun, for this reason.
    Stopping(&'a str),
}

/// How a run came out.
#[derive(Debug, Clone, PartialEq, Default)]
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
    pub stopped: Option<String>,
    /// Whether a person or the system wanted it to stop.
    pub interrupted: bool,
    /// Pixels developed.
    pub pixels: u64,
    /// Seconds of the whole run.
    pub seconds: f64,
    /// Most memory that one worker held, bytes; 0 where the system does not tell.
    pub peak: u64,
    /// Most memory that was set aside for one worker, bytes.
    pub estimated: u64,
}

/// Why a batch cannot run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// The journal.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Worker processes.
    #[error("worker processes cannot be started: {0}")]
    Worker(std::io::Error),
    /// The output folder.
    #[error("{path}: the output folder cannot be made: {reason}; choose another `-o`", path = path.display())]
    Out {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// A chart shot that a session was to be coloured by.
    #[error("{0}")]
    Chart(String),
}
