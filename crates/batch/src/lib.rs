//! A folder of raw files to a folder of pictures, in a way that can be trusted.
//!
//! ```no_run
//! use darkroot::ProfileStore;
//! use darkroot::recipe::{Layer, Layers};
//! use darkroot_batch::{Batch, CrewOptions, PlanOptions, Search, Session, SettingsByFile, Stop, find};
//!
//! let search = Search { inputs: vec!["shoot".into()], ..Search::default() };
//! let options = PlanOptions::into("pictures".as_ref());
//! let mut settings = SettingsByFile::new(Layers::new(None, Layer::flags([])?, true)?);
//! // A program that calls `serve` on its stdin and stdout; `CrewOptions::in_process` needs none.
//! let crew = CrewOptions::new("darkroot".into(), vec!["worker".into()]);
//! let stop = Stop::default();
//! let mut batch = Batch::open(&options, crew, ProfileStore::builtin())?;
//! let sources = find(&search, "pictures".as_ref())?;
//! let plan = batch.plan(sources, &options, &mut settings, &Session::default(), &stop)?;
//! let summary = batch.run(&plan, &stop, &mut |_event| {})?;
//! println!("{} done, {} failed", summary.done, summary.failed);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`find()`] looks up the inputs, [`plan`] decides about each before anything is written, and [`Batch::run`] hands
//! them to workers ([`Workers`], [`serve`]) within a budget of memory and threads. The [`journal`] in the output folder
//! says what was done, so the next run does only what is left. [`watch()`] plans and runs again and again, whenever
//! files came.
//!
//! An output is absent, or whole: unfinished ones have no name, or lie in `.darkroot` inside the output folder, on the
//! same disk, and are renamed into place.
//!
//! **What it does not do:** it prints nothing, reads no arguments and knows no options: errors say what is wrong, and
//! the program that shows them says what to do ([`Wording`]).
//!
//! No two files use each other, not even by way of others.

pub mod facts;
pub mod failure;
pub mod hash;
pub mod names;
pub mod shard;
pub mod stop;
pub mod system;
pub mod wording;

pub mod filter;
pub mod record;
pub mod source_fault;

pub mod find;

pub mod history;
pub mod item;
pub mod journal;
pub mod plan_fault;

pub mod batch_error;
pub mod estimate;
pub mod outcome;
pub mod settings_by_file;

pub mod crew_options;
mod need;
pub mod process_limits;
mod raw_head;
mod task;
mod thumbnail;

mod chart_shot;
mod develop_task;
mod reach;
pub mod worker;

#[cfg(fuzzing)]
pub mod fuzzing;

mod budget;
mod process;
mod running_worker;
mod thread;

mod work;

mod crew;

mod headers;
mod trial;
pub use trial::trial;
mod split;
mod state;

pub mod plan;
mod run;
pub mod session;

pub mod batch;
mod causes;
pub mod sheet;

pub mod notice;
mod settle;
mod wake;
pub mod watch;
mod watch_plan;

pub use batch::Batch;
pub use batch_error::BatchError;
pub use crew_options::{CrewOptions, Workers};
pub use estimate::{Estimate, Experience};
pub use failure::{Conflict, Failure, FailureKind};
pub use filter::FindError;
pub use find::{Search, Source, Sources, find};
pub use history::History;
pub use item::{BatchPlan, Item, OnCollision, PlanOptions, State, Why};
pub use journal::JournalError;
pub use names::{Collision, LeftOut};
pub use notice::{Notice, WatchError, WatchOptions, Watched};
pub use outcome::{Event, StopReason, Summary};
pub use plan::{check, plan_only};
pub use plan_fault::PlanFault;
pub use session::{ChartShot, Session};
pub use settings_by_file::SettingsByFile;
pub use shard::{Shard, ShardError};
pub use sheet::{Sheet, SheetError};
pub use source_fault::SourceFault;
pub use stop::Stop;
pub use watch::watch;
pub use wording::Wording;
pub use worker::serve;
