//! How much of the machine a batch takes, and what its workers are.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use darkroot::ProfileStore;

use super::system;
use super::wording::Wording;

/// What workers are.
#[derive(Debug, Clone)]
pub enum Workers {
    /// Processes: this program with these arguments, something that calls [`serve`](super::serve) on its stdin and
    /// stdout. A file that crashes or stalls its decoder costs itself and no other.
    Processes(PathBuf, Vec<OsString>),
    /// Threads of this process, with these profiles: for a program that cannot or will not start others. Budget,
    /// journal and pictures are the same, and a panic in a decoder costs one file as well.
    ///
    /// **What they cannot do:** a thread cannot be ended from outside. So [`CrewOptions::timeout`] does not count,
    /// [`Stop::at_once`](super::Stop::at_once) waits for the files in flight as [`Stop::asked`](super::Stop::asked) does, an abort (a decoder that exhausts memory
    /// or the stack) takes the whole program with it, and nothing but the budget's estimate limits a file's memory.
    Threads(ProfileStore),
}

/// How to run a crew.
#[derive(Debug, Clone)]
pub struct CrewOptions {
    /// What workers are.
    pub workers: Workers,
    /// Files developed at once, at most.
    pub jobs: usize,
    /// Threads in all.
    pub threads: usize,
    /// Memory of all workers and of this process together, bytes.
    pub memory: u64,
    /// Longest time for one file.
    pub timeout: Duration,
    /// How errors are worded, in events and in the journal. Worker processes word theirs themselves.
    pub wording: Wording,
}

impl CrewOptions {
    /// Worker processes with the whole machine but for half of the free memory.
    pub fn new(program: PathBuf, arguments: Vec<OsString>) -> Self {
        Self::of(Workers::Processes(program, arguments))
    }

    /// Threads of this process with the whole machine but for half of the free memory. See [`Workers::Threads`] for
    /// what they cannot do.
    pub fn in_process(store: ProfileStore) -> Self {
        Self::of(Workers::Threads(store))
    }

    fn of(workers: Workers) -> Self {
        let threads = system::threads();
        Self {
            workers,
            jobs: threads,
            threads,
            memory: system::free_memory() / 2,
            timeout: Duration::from_secs(600),
            wording: Wording::default(),
        }
    }
}
