//! A folder of raw files to a folder of pictures, in a way that can be trusted.
//!
//! ```no_run
//! use darkroot::ProfileStore;
//! use darkroot::batch::{Batch, CrewOptions, PlanOptions, Recipes, Search, Session, Stop, find};
//! use darkroot::recipe::{Layer, Layers};
//!
//! let search = Search { inputs: vec!["shoot".into()], ..Search::default() };
//! let options = PlanOptions::into("pictures".as_ref());
//! let mut recipes = Recipes::new(Layers::new(None, Layer::flags([])?, true)?);
//! // A program that calls `batch::serve` on its stdin and stdout, such as `darkroot worker`.
//! let crew = CrewOptions::new("darkroot".into(), vec!["worker".into()]);
//! let stop = Stop::default();
//! let mut batch = Batch::open(&options, crew, ProfileStore::builtin())?;
//! let sources = find(&search, "pictures".as_ref())?;
//! let plan = batch.plan(sources, &options, &mut recipes, &Session::default(), &stop)?;
//! let summary = batch.run(&plan, &stop, &mut |_event| {})?;
//! println!("{} done, {} failed", summary.done, summary.failed);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`find`](mod@find) looks up the inputs, [`plan`](mod@plan) decides about each before anything is written, and
//! [`Batch::run`] hands them to worker processes ([`crew`], [`worker`]) within a budget of memory and threads. The
//! [`journal`] in the output folder says what was done, so the next run does only what is left. [`watch`](mod@watch) plans and runs again and again, whenever files came.
//!
//! An output is absent, or whole: unfinished ones lie in `.darkroot` inside the output folder, on the same disk, and
//! are renamed into place.

pub mod find;
pub use find::{FindError, Search, Source, Sources, find};

pub mod journal;
pub use journal::JournalError;

pub mod record;

pub mod history;
pub use history::History;

pub mod names;

pub mod plan;
pub use plan::{Item, OnCollision, Plan, PlanError, PlanOptions, Recipes, State, Why, check, plan_only};

pub mod shard;
pub use shard::Shard;

pub mod session;
pub use session::{ChartShot, Session};

pub mod stop;
pub use stop::Stop;

pub mod crew;
pub use crew::CrewOptions;

pub mod worker;
pub use worker::serve;

pub mod outcome;
pub use outcome::{BatchError, Event, Summary};

pub mod run;
pub use run::Batch;

pub mod watch;
pub use watch::{Notice, WatchError, WatchOptions, Watched, watch};

pub mod estimate;
pub use estimate::{Estimate, estimate};

pub mod sheet;
pub use sheet::Sheet;

mod budget;
pub mod hash;
mod need;
mod process;
mod settle;
mod state;
pub mod system;
mod task;
mod thumbnail;
mod wake;

pub(crate) use task::Header;
