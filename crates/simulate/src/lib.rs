//! Reflectances x light x camera to captures, and DNG and NEF bytes of them.
//!
//! A [`Scene`] says which reflectance each pixel shows; [`expose`](expose::expose) makes a
//! [`darkroot_photo::Capture`] of it as a [`Camera`] would, and [`dng::write`], [`nef::write`] and [`makers`] make files of that, so
//! what a developed picture ought to look like is known exactly.
//!
//! **What it does not do:** it reads no file and no clock; it simulates no lens but for shading and veiling glare.
//! The same arguments give the same bytes on every machine.

pub mod reflectance;

pub mod chart;

mod chart_scene;

pub mod scene;
pub use scene::{Patch, Scene};

pub mod camera;
pub use camera::Camera;

pub mod expose;
pub use expose::Exposure;

pub mod dng;
pub mod makers;
pub mod nef;

pub mod levels;
pub mod samples;

mod exact;
mod nef_huffman;
mod preview;
mod random;
mod still_life;
mod tag;
mod tiff_writer;
