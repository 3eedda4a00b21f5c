//! Why a file was not developed.

use std::path::PathBuf;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::wording::Wording;
use darkroot::shown;

/// Why a file was not developed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// A worker tried and said why it failed.
    #[error("{words}")]
    Worker {
        /// Whose fault it is.
        kind: FailureKind,
        /// One sentence that names the file, in the words of the program that the worker belongs to.
        words: String,
    },
    /// All workers together may not have as much memory as this file needs.
    #[error(
        "{path}: needs {} of memory beside the main program, but all together may have {}",
        bytes_text(*needed), bytes_text(*allowed), path = shown(path)
    )]
    NeverFits {
        /// The file.
        path: PathBuf,
        /// Bytes that it needs.
        needed: u64,
        /// Bytes that all workers and the main program may have.
        allowed: u64,
    },
    /// It was not done in time.
    #[error("{path}: took longer than {}", humantime::format_duration(*limit), path = shown(path))]
    TookTooLong {
        /// The file.
        path: PathBuf,
        /// Time for one file.
        limit: Duration,
    },
    /// Its worker asked for more memory than it may have.
    #[error("{path}: took more memory than such a file should; it is most likely damaged", path = shown(path))]
    TooMuchMemory {
        /// The file.
        path: PathBuf,
    },
    /// The system ended its worker.
    #[error(
        "{path}: the system ended the process that worked on it, most likely for want of memory",
        path = shown(path)
    )]
    Ended {
        /// The file.
        path: PathBuf,
    },
    /// Its worker crashed.
    #[error(
        "{path}: its decoder crashed, which cost only this file; it is most likely damaged",
        path = shown(path)
    )]
    Crashed {
        /// The file.
        path: PathBuf,
    },
    /// Its worker tried what no decoder has to do, and was ended.
    #[error(
        "{path}: its decoder tried what decoding never needs, such as to start a program, and was ended; the file is \
         most likely an attack",
        path = shown(path)
    )]
    Breach {
        /// The file.
        path: PathBuf,
    },
    /// Another picture is in the way.
    #[error(transparent)]
    Conflict(#[from] Conflict),
}

impl Failure {
    /// In words: a worker's own where it said why, else as the program words it.
    pub(crate) fn words(&self, wording: &Wording) -> String {
        match self {
            Self::Worker { words, .. } => words.clone(),
            other => wording.of(other),
        }
    }

    /// What the rest of the batch must know of it.
    pub fn kind(&self) -> FailureKind {
        match self {
            Self::Worker { kind, .. } => *kind,
            Self::NeverFits { .. } | Self::Conflict(_) => FailureKind::File,
            Self::TookTooLong { .. }
            | Self::TooMuchMemory { .. }
            | Self::Ended { .. }
            | Self::Breach { .. }
            | Self::Crashed { .. } => FailureKind::Died,
        }
    }
}

/// What the rest of a batch must know of a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FailureKind {
    /// The file.
    File,
    /// The disk of the outputs is full: no other file fares better.
    DiskFull,
    /// The output cannot be written for another reason; perhaps its folder is gone.
    Output,
    /// The file changed while it was read.
    Changing,
    /// The worker died or was ended.
    Died,
}

/// A picture that stands where an output would go and is not replaced unless that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Conflict {
    /// No journal knows it.
    #[error("{path}: exists already and is not from a batch into this folder", path = shown(path))]
    NotOurs {
        /// The picture.
        path: PathBuf,
    },
    /// It is not what the journal says.
    #[error(
        "{path}: was changed after Darkroot wrote it, and would be replaced now",
        path = shown(path)
    )]
    Changed {
        /// The picture.
        path: PathBuf,
    },
}

/// Bytes for people.
pub fn bytes_text(bytes: u64) -> String {
    let mega = bytes as f64 / 1e6;
    match mega {
        m if m >= 1000.0 => format!("{:.1} GB", m / 1000.0),
        m if m >= 1.0 => format!("{m:.0} MB"),
        m => format!("{:.0} kB", m * 1000.0),
    }
}
