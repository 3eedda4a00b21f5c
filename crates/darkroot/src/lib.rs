//! Files in, files out: what the program `darkroot` does, for other programs.
//!
//! ```no_run
//! use darkroot::{Control, Job, ProfileStore, Settings};
//!
//! let settings = Settings::default();
//! let store = ProfileStore::builtin();
//! let job = Job { input: "DSC_0001.NEF".into(), output: "DSC_0001.jpg".into() };
//! let report = darkroot::develop(&job, &settings, &store, Control::default())?;
//! println!("{} developed with {}", report.camera, report.colours);
//! # Ok::<(), darkroot::Error>(())
//! ```
//!
//! [`naming`] decides where outputs go and finds collisions before anything is written, [`develop()`] makes one
//! file, [`inspect()`] says what a file is. Outputs get their names when they are complete: an output is
//! absent, the old one, or the whole new one.
//!
//! Call it from threads of your own or of no pool, not from inside an iteration of rayon's: there a thread that waits would
//! begin the next file in the midst of one, until its stack is full (`docs/security.md`, "Stacks").
//!
//! **What it does not do:** it prints nothing and reads no arguments.

pub mod settings;
pub use settings::{Engine, Key, NotAValue, ProfileChoice, Settings, SettingsError};

pub mod recipe;
pub use recipe::{Effective, Layer, Layers, Origin, RecipeError};

pub mod photo;
mod planned;
pub use photo::{Photo, PlanError};

pub mod naming;
pub use naming::{Job, NamingError, Target, plan_outputs};

pub mod job;
pub use job::{Control, Report, Step, develop, develop_into, encode_picture, open_output};

pub mod common_look;
pub use common_look::{CommonLook, common_look};

pub mod frames;
pub use frames::FrameFault;

pub mod lut;

mod dng;
mod from_chart;
mod hdr;
pub use from_chart::Told as ToldByChart;
mod provenance;

pub mod inspect;
pub use inspect::{Inspection, inspect, inspect_photo, save_preview};

pub mod spectra;
pub use spectra::SpectraFile;

pub mod light;
pub use light::LightSource;

pub mod estimate;
pub use estimate::{Estimated, estimate, estimate_named};

pub mod from_spectra;
pub use from_spectra::{FromSpectra, from_spectra};

pub mod from_table;
pub use from_table::{FromTable, TableProfile, from_table};

pub mod evaluate;

pub mod export;

pub mod store;
pub use store::{ChosenProfile, ProfileStore};

pub mod error;
pub use error::Error;

pub mod fault;

pub mod charts;

pub mod find_chart;
pub use find_chart::{FoundCharts, find_charts, find_charts_in};

pub mod shot;
pub use shot::{ChartRequest, Shot, ShotOptions};

pub mod verify;

pub mod deliver;

pub mod page;

pub mod report;

pub mod chart_camera;
pub use chart_camera::{chart_camera, table_camera};

pub mod make_profile;
pub use make_profile::{MadeProfile, make_profile};

pub mod metadata;

mod lean;
mod lens;
mod shown;
pub use shown::{json_lines, lines, quoted, shown};

mod quiet;
pub use quiet::keep_decoders_quiet;

mod nearest;
pub use nearest::nearest;

pub mod path_text;

pub mod files;
pub use files::{Output, abandon, write_text};

#[cfg(feature = "imagepipe")]
mod pipe;

pub use darkroot_develop::{Analysis, Cancel, Cancelled, Plan, Recipe, Scale, View};
pub use darkroot_encode::{ChromaSubsampling, Format, Options as EncodeOptions};
pub use darkroot_raw::{Decoder, Limits, Listed, cameras};

/// Version of Darkroot, as outputs carry it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
