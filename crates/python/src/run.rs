//! Work without Python's lock, which Ctrl-C ends.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use darkroot::Cancel;
use pyo3::prelude::*;

use crate::fault;

/// How often Python is asked whether somebody pressed Ctrl-C.
const LISTENING: Duration = Duration::from_millis(50);
/// How long work may take to heed that before it is left to itself.
const PATIENCE: Duration = Duration::from_millis(500);

/// Runs `work` on a thread of its own and returns what it gives.
///
/// The thread has its own pool of `threads` threads (all cores if not given): nothing is shared between calls, so that they
/// do not wait for each other, and a process that was forked has all it needs. When Ctrl-C is pressed, work is cancelled; what
/// does not heed that in time goes on to its end unseen, and its result is thrown away.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    cancel: &Arc<Cancel>,
    work: impl FnOnce(&Cancel) -> T + Send + 'static,
) -> PyResult<T> {
    let own = Arc::clone(cancel);
    let in_pool = move |wish: &Cancel| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        match pool {
            Ok(pool) => pool.install(|| work(wish)),
            // No room for threads: this one does it alone, by rayon's own fallback.
            Err(_) => work(wish),
        }
    };
    run_until(py, cancel, move || own.cancel(), in_pool)
}

/// As [`run`], on a thread alone. `ask` is called when Ctrl-C is pressed.
pub(crate) fn run_until<T: Send + 'static>(
    py: Python<'_>,
    cancel: &Arc<Cancel>,
    ask: impl FnOnce() + Send,
    work: impl FnOnce(&Cancel) -> T + Send + 'static,
) -> PyResult<T> {
    let (give, result) = channel();
    let own = Arc::clone(cancel);
    let guarded = move || {
        // Nobody listens any more after Ctrl-C.
        let _ = give.send(catch_unwind(AssertUnwindSafe(|| work(&own))));
    };
    let thread = thread::Builder::new().name("darkroot".into()).spawn(guarded);
    thread.map_err(|e| fault::storage(format!("no thread can be started: {e}")))?;
    py.detach(move || wait(&result, ask))
}

/// What a thread ended with: its result, or what it panicked with.
type Ended<T> = Result<T, Box<dyn Any + Send>>;

fn wait<T>(result: &Receiver<Ended<T>>, ask: impl FnOnce()) -> PyResult<T> {
    loop {
        match result.recv_timeout(LISTENING) {
            Ok(ended) => return ended.map_err(|_| fault::ours()),
            Err(RecvTimeoutError::Disconnected) => return Err(fault::ours()),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(interrupt) = Python::attach(|py| py.check_signals()) {
                    ask();
                    let until = Instant::now() + PATIENCE;
                    while let Some(left) = until.checked_duration_since(Instant::now()) {
                        if !matches!(result.recv_timeout(left), Err(RecvTimeoutError::Timeout)) {
                            break;
                        }
                    }
                    return Err(interrupt);
                }
            }
        }
    }
}
