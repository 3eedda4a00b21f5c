//! What the crew is given to do, and what it and its caller tell each other about it.

use std::time::{Duration, Instant};

use super::failure::Failure;
use super::task::{Answer, Task};

/// A task in the queue.
#[derive(Debug, Clone)]
pub(crate) struct Work {
    /// The caller's number for it.
    pub(crate) id: usize,
    pub(crate) task: Task,
    /// Bytes of its file.
    pub(crate) size: u64,
    /// Not before this time.
    pub(crate) after: Option<Instant>,
    /// Whether a worker died over it already.
    pub(crate) second_try: bool,
}

impl Work {
    pub(crate) fn new(id: usize, task: Task, size: u64) -> Self {
        Self { id, task, size, after: None, second_try: false }
    }
}

/// What the crew tells its caller about a task.
pub(crate) enum Progress {
    /// It is about to be sent to a worker.
    Begins,
    /// It came to its end.
    Ended(Result<Answer, Failure>),
}

/// What the caller wants next.
pub(crate) enum Next {
    GoOn,
    /// The same task again after a while.
    Again(Duration),
    /// Another task: this one is not to be begun.
    Leave,
    /// No more new tasks.
    Finish,
}
