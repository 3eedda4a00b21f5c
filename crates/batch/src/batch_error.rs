//! Why a batch cannot run.

use std::path::PathBuf;

use super::journal::JournalError;
use super::plan_fault::PlanFault;
use darkroot::shown;

/// Why a batch cannot run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// The journal.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The plan.
    #[error(transparent)]
    Plan(#[from] PlanFault),
    /// Workers.
    #[error("workers cannot be started: {0}")]
    Worker(std::io::Error),
    /// The output folder.
    #[error("{path}: the output folder cannot be made: {reason}", path = shown(path))]
    Out {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// The chart shot that a session was to be coloured by shows none.
    #[error("{path}: no colour chart was found in it", path = shown(path))]
    NoChart {
        /// The shot.
        path: PathBuf,
    },
    /// The chart shot that a session was to be coloured by gives no profile.
    #[error("{path}: no profile can be made of it", path = shown(path))]
    NoProfile {
        /// The shot.
        path: PathBuf,
    },
}
