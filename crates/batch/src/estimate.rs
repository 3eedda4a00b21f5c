//! How long a batch will take, roughly.

use std::collections::BTreeMap;

use super::history::History;
use super::item::{BatchPlan, Item, State};
use super::names::ending;

/// Seconds of one worker per megabyte of raw file, where nothing tells: 24 MP of losslessly compressed NEF to JPEG.
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
    /// Bytes that the outputs will take; none where nothing tells.
    pub output_bytes: Option<u64>,
    /// Whether it goes by what such files took on this machine, not by typical figures.
    pub by_experience: bool,
}

/// What files took: all together, and those of each ending.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Experience {
    all: Taken,
    by_ending: BTreeMap<String, Taken>,
}

/// What some files took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Taken {
    read: u64,
    written: u64,
    seconds: f64,
}

impl Experience {
    /// What stands in journals.
    pub fn of(history: &History) -> Self {
        let mut experience = Self::default();
        for done in history.outputs.values().filter_map(|k| k.done.as_ref()) {
            experience.add(&done.input, done.source.size, done.written.size, done.seconds);
        }
        experience
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.all.read == 0
    }

    /// A file of this key took so much.
    pub(crate) fn add(&mut self, key: &str, read: u64, written: u64, seconds: f64) {
        for taken in [&mut self.all, self.by_ending.entry(ending(key)).or_default()] {
            taken.read += read;
            taken.written += written;
            taken.seconds += seconds;
        }
    }

    fn with_ending_of(&self, key: &str) -> &Taken {
        self.by_ending.get(&ending(key)).unwrap_or(&self.all)
    }

    /// What is to be expected of a plan for so many files at once.
    pub fn estimate(&self, plan: &BatchPlan, jobs: usize) -> Estimate {
        let todo: Vec<&Item> = todo(plan).collect();
        let (mut bytes, mut seconds, mut written) = (0, 0.0, 0.0);
        for item in &todo {
            let size = item.source.size;
            let Taken { read, written: out, seconds: took } = *self.with_ending_of(&item.source.key);
            let share = size as f64 / read.max(1) as f64;
            bytes += size;
            seconds += if read > 0 { share * took } else { size as f64 * SECONDS_PER_MEGABYTE / 1e6 };
            written += share * out as f64;
        }
        let at_once = jobs.clamp(1, todo.len().max(1));
        Estimate {
            files: todo.len(),
            bytes,
            seconds: seconds / at_once as f64,
            output_bytes: (!self.is_empty()).then_some(written as u64),
            by_experience: !self.is_empty(),
        }
    }
}

/// The files of a plan that are to be developed.
pub(crate) fn todo(plan: &BatchPlan) -> impl Iterator<Item = &Item> {
    plan.items.iter().filter(|item| matches!(item.state, State::Todo(_)))
}
