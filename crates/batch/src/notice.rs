//! Watching a folder: what is asked for, what is told, how it ends.

use std::time::Duration;

use darkroot::RecipeError;

use super::batch_error::BatchError;
use super::filter::FindError;
use super::find::{Search, Source};
use super::item::PlanOptions;
use super::outcome::{Event, StopReason};
use super::session::ChartShot;
use super::source_fault::SourceFault;

/// What to watch, and how.
#[derive(Debug, Clone)]
pub struct WatchOptions {
    /// Folders, and what of them is taken.
    pub search: Search,
    /// Where outputs go.
    pub plan: PlanOptions,
    /// A file is taken when its size and time of change have been the same for so long.
    pub settle: Duration,
    /// Look every so often instead of waiting for notifications.
    pub poll: Option<Duration>,
    /// Where session colours come from.
    pub chart: Option<ChartShot>,
}

/// What a watch tells.
#[derive(Debug)]
pub enum Notice<'a> {
    /// It watches now; `polling` if it looks every so often, and `why` if that was not asked for.
    Watching {
        /// How often it looks.
        polling: Option<Duration>,
        /// Why there are no notifications.
        why: Option<&'a str>,
    },
    /// Something happened to a file.
    File(Event<'a>),
    /// A file cannot be developed as long as this is so. Said once for each reason.
    Held {
        /// The file.
        source: &'a Source,
        /// Why, in one sentence, as the program words it.
        words: &'a str,
    },
    /// Something cannot be read. Said once, as long as it is so.
    Fault(&'a SourceFault),
    /// An input folder is not there; it is waited for.
    Away(&'a str),
    /// It is there again.
    Back(&'a str),
    /// So many pictures are not as they would be made now, and are left so.
    Outdated(usize),
    /// About the colours of a session.
    Colours(&'a str),
}

/// How a watch came out.
#[derive(Debug, Default)]
pub struct Watched {
    /// Files developed.
    pub done: usize,
    /// Files that failed.
    pub failed: usize,
    /// Files that wait for something: a recipe to be corrected, an output to be moved.
    pub held: usize,
    /// Why it ended by itself, if it did.
    pub stopped: Option<StopReason>,
}

/// Why nothing is watched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WatchError {
    /// The batch behind it.
    #[error(transparent)]
    Batch(#[from] BatchError),
    /// A pattern.
    #[error(transparent)]
    Find(#[from] FindError),
    /// Settings.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// Not a folder.
    #[error("{input}: is no folder")]
    NoFolder {
        /// As it was given.
        input: String,
    },
}
