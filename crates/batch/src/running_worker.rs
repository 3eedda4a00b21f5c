//! A worker at work, whatever it is.

use std::time::Duration;

use super::crew_options::{CrewOptions, Workers};
use super::process::{Exit, Process};
use super::task::{Answer, Order};
use super::thread::Thread;

/// A process or a thread.
pub(crate) enum RunningWorker {
    Process(Process),
    Thread(Thread),
}

impl RunningWorker {
    /// Starts one. `on_answer` gets each of its answers, and `None` once when there will be no more.
    ///
    /// # Errors
    /// The system has no such program, or no room for it.
    pub(crate) fn start(
        options: &CrewOptions,
        on_answer: impl Fn(Option<Answer>) -> bool + Send + 'static,
    ) -> std::io::Result<Self> {
        match &options.workers {
            Workers::Processes(program, arguments) => {
                Process::start(program, arguments, on_answer).map(Self::Process)
            }
            Workers::Threads(store) => {
                Thread::start(store.clone(), options.wording.clone(), on_answer).map(Self::Thread)
            }
        }
    }

    pub(crate) fn send(&mut self, order: &Order) {
        match self {
            Self::Process(process) => process.send(order),
            Self::Thread(thread) => thread.send(order),
        }
    }

    /// Waits so long for it to end by itself; a process is then ended.
    pub(crate) fn end(self, grace: Duration) -> Option<Exit> {
        match self {
            Self::Process(process) => process.end(grace),
            Self::Thread(thread) => {
                thread.end();
                None
            }
        }
    }
}
