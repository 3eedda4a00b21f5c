//! How long a batch will take, roughly.

use super::history::History;
use super::item::{BatchPlan, State};

/// CPU seconds per megabyte of raw file, where no journal tells: 24 MP of losslessly compressed NEF to JPEG.
const SECONDS_PER_MEGABYTE: f64 = 0.07;

/// What is to be expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Files to develop.
    pub files: usize,
    /// Their size together, bytes.
    pub bytes: u64,
    /// Seconds that they will take.
    pub seconds: f64,
    /// Bytes that the outputs will take; none where no journal tells.
    pub output_bytes: Option<u64>,
    /// Whether it goes by what earlier runs took, not by typical figures.
    pub by_experience: bool,
}

/// Estimates a plan for so many files at once.
pub fn estimate(plan: &BatchPlan, history: &History, jobs: usize) -> Estimate {
    let todo = || plan.items.iter().filter(|i| matches!(i.state, State::Todo(_)));
    let files = todo().count();
    let bytes: u64 = todo().map(|i| i.source.size).sum();
    let (mut read, mut seconds, mut written) = (0u64, 0.0, 0u64);
    for done in history.outputs.values().filter_map(|k| k.done.as_ref()) {
        read += done.source.size;
        written += done.written.size;
        seconds += done.seconds;
    }
    let by_experience = read > 0;
    let rate = if by_experience { seconds / read as f64 } else { SECONDS_PER_MEGABYTE / 1e6 };
    let output_bytes = by_experience.then(|| (bytes as f64 * written as f64 / read as f64) as u64);
    let at_once = jobs.clamp(1, files.max(1));
    Estimate { files, bytes, seconds: bytes as f64 * rate / at_once as f64, output_bytes, by_experience }
}
