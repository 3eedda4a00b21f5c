//! The longest time for one file: no decoder, however it is led astray, keeps the program for ever.

use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use clap::Args;
use darkroot_batch::Failure;

use crate::values;

/// How long one file may take.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct Deadline {
    /// Longest time for one file, such as 90s or 10m; a file that takes longer ends the program
    #[arg(long, value_name = "TIME", default_value = "10m", value_parser = values::time)]
    timeout: Duration,
}

impl Deadline {
    /// For so many files together.
    pub(crate) fn times(self, files: usize) -> Self {
        Self { timeout: self.timeout.saturating_mul(u32::try_from(files).unwrap_or(u32::MAX)) }
    }

    /// Does the work on a file. A thread cannot be ended from outside: when the time is over, unfinished outputs are
    /// removed, `late` may say what it says of files that fail, and the program ends. `after` is the number of files
    /// that are then left.
    pub(crate) fn over<T>(
        self,
        file: &Path,
        after: usize,
        late: impl FnOnce(&Failure) + Send,
        work: impl FnOnce() -> T,
    ) -> T {
        let (done, waiting) = channel::<()>();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                if waiting.recv_timeout(self.timeout) == Err(RecvTimeoutError::Timeout) {
                    darkroot::abandon();
                    let failure = Failure::TookTooLong { path: file.to_owned(), limit: self.timeout };
                    crate::say(format_args!("error: {}{}", crate::hint::words(&failure), left(after)));
                    late(&failure);
                    std::process::exit(crate::SOME_FAILED.into());
                }
            });
            let result = work();
            drop(done);
            result
        })
    }
}

/// What becomes of the files after a late one.
fn left(files: usize) -> String {
    match files {
        0 => String::new(),
        1 => "; the file after it was not begun".to_owned(),
        n => format!("; the {n} files after it were not begun, which `darkroot batch` would do"),
    }
}
