//! Colour charts: their layouts and reference colours, finding one in a picture, measuring its patches.
//!
//! **What it does not do:** it reads no files and fits no colours; text comes from the caller, fits are in `profile`.

pub mod layout;
pub use layout::{ChartLayout, PatchPlace};

pub mod measure;
pub use measure::{Measurement, measure};

pub mod sharpness;
pub use sharpness::{EdgeWidth, edge_width};

pub mod slanted_edge;
pub use slanted_edge::{EdgeLine, EdgeResponse};

pub mod distortion;
pub use distortion::Distortion;

pub mod noise;
pub use noise::{PatchNoise, VisualNoise, patch_noise};

pub mod banding;
pub use banding::{Banding, banding};

pub mod unevenness;
pub use unevenness::Slope;

pub mod glare;
pub use glare::ChannelLight;

pub mod reference;
pub use reference::{Reference, ReferenceColour, Sequence};

pub mod windows;

pub mod builtin_reference;

pub mod detect;
pub use detect::{Found, Options, Refusal, Rejected, Search, SearchImage};

pub mod geometry;
pub use geometry::{Homography, Quad};
