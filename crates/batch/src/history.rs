//! What is known from the records of a journal, or of all journals of an output folder.

use std::collections::HashMap;

use super::facts::{Calibrated, Looked};
use super::record::{Done, Failed, Record};

/// What is known about one output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Known {
    /// Whether it was begun and nothing was heard of it since: what is at its place is this journal's.
    pub open: bool,
    /// The last time it was done.
    pub done: Option<Done>,
    /// How it failed, if that was the last that happened.
    pub failed: Option<Failed>,
}

/// What earlier runs know of charts, by path of the shot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KnownCharts {
    /// Looks.
    pub looked: HashMap<String, Looked>,
    /// Profiles.
    pub calibrated: HashMap<String, Calibrated>,
}

/// All that a journal says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    /// By output.
    pub outputs: HashMap<String, Known>,
    /// Files that the last run was about, where it said so; of several journals their sum.
    pub files: Option<usize>,
    /// Number by input, where names carry one.
    pub numbers: HashMap<String, usize>,
    /// What is known of charts.
    pub charts: KnownCharts,
    /// Lines that were torn or damaged.
    pub damaged: usize,
}

impl History {
    pub(crate) fn add(&mut self, record: Record) {
        match record {
            Record::Journal { .. } => {}
            Record::Begun { input, output, number, of } => {
                self.files = of;
                self.outputs.entry(output).or_default().open = true;
                if let Some(number) = number {
                    self.numbers.insert(input, number);
                }
            }
            Record::Done(done) => {
                let known = self.outputs.entry(done.output.clone()).or_default();
                *known = Known { done: Some(*done), ..Known::default() };
            }
            Record::Failed(failed) => {
                let known = self.outputs.entry(failed.output.clone()).or_default();
                known.open = failed.died;
                known.failed = Some(failed);
            }
            Record::Gone { output, .. } => {
                if let Some(known) = self.outputs.get_mut(&output) {
                    known.open = false;
                    if known.done.is_none() {
                        self.outputs.remove(&output);
                    }
                }
            }
            Record::Looked(looked) => {
                self.charts.looked.insert(looked.input.clone(), looked);
            }
            Record::Calibrated(calibrated) => {
                self.charts.calibrated.insert(calibrated.input.clone(), calibrated);
            }
        }
    }

    /// Adds what another journal says, as journals of shards are added up.
    pub fn merge(&mut self, other: Self) {
        for (output, known) in other.outputs {
            let mine = self.outputs.entry(output).or_default();
            mine.open |= known.open;
            let newer = match (&mine.done, &known.done) {
                (Some(a), Some(b)) => b.at >= a.at,
                (None, _) => true,
                (_, None) => false,
            };
            if newer {
                mine.done = known.done;
                mine.failed = known.failed;
            }
        }
        self.files = match (self.files, other.files) {
            (Some(mine), Some(others)) => Some(mine + others),
            (mine, others) => mine.or(others),
        };
        self.numbers.extend(other.numbers);
        self.charts.looked.extend(other.charts.looked);
        self.charts.calibrated.extend(other.charts.calibrated);
        self.damaged += other.damaged;
    }
}
