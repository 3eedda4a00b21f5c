//! Capture, profile and recipe to a picture.
//!
//! ```text
//! plan    looks at the whole capture once: white, highlights, exposure
//! render  cuts the picture into tiles and runs the stages over each, in parallel:
//!         level -> denoise -> corrections -> balance -> highlights -> lateral -> demosaic -> sharpen
//!         -> corrections -> geometry -> correct (profile) -> exposure -> tone -> lut -> gamut -> transfer
//! ```
//!
//! A stage is a function over a small picture in its own file; it neither knows nor cares whether that picture
//! is a tile or the whole frame. The picture does not depend on the number of threads, on the tiles or on the
//! machine: bit for bit the same.
//!
//! **What it does not do:** no files, no clock, no environment, no state.

// Tests compare exactly where results are exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod recipe;
pub use recipe::{
    Balance, Bits, Crop, Demosaic, Denoise, DenoiseBy, Exposure, Flip, Gamut, Geometry, Highlights, Lens,
    Lines, LocalTone, Look, Marks, Mending, Output, OutputSpace, Overlay, Perspective, Points, PointsError,
    Recipe, Resize, Tones, Turn,
};

pub mod error;
pub use error::{Error, GeometryFault, SpotFault};

pub mod light;
pub use light::LinearLight;

pub mod analysis;
pub use analysis::Analysis;

pub mod plan;
pub use plan::{Colours, Plan, plan};

pub mod view;
pub use view::{Cancel, Cancelled, Scale, View};

pub mod kept;
pub use kept::Kept;

pub mod tally;
pub use tally::{Clipped, Tally};

pub mod camera_look;

pub mod stage;

// What other frames tell of it.
pub mod companions;

// What is looked for in the whole frame.
pub mod frame;
pub use frame::Frame;
pub mod histogram;
pub use histogram::{Histogram, histogram};
pub mod noise;
mod saturation;
pub mod survey;
pub use survey::Survey;
pub mod white;
pub use white::CameraMatrix;
pub mod whites;
pub use whites::Whites;

mod auto_exposure;
mod auto_white;
mod base;
mod cones;
mod finish;
mod grid;
mod in_turn;
pub mod lateral;
mod local_tone;
mod neighbourhood;
mod neutral;
mod render;
mod shown;
mod tile;
pub mod tilt;

// The stages, in the order of the pipeline.
pub mod balance;
pub mod clipped_colours;
pub mod correct;
pub mod corrections;
pub mod demosaic;
pub mod denoise;
pub mod exposure;
pub mod fringe;
pub mod gamut;
mod geometry;
pub mod highlights;
pub mod level;
pub mod lut;
mod mend;
pub mod sharpen;
pub mod tone;
pub mod transfer;
