//! What one camera's colours mean: from balanced camera RGB to XYZ.
//!
//! A [`Profile`] holds one [`Calibration`] per light. Its [`Model`] takes balanced camera RGB, in which the white
//! of the light is (1,1,1), to XYZ relative to D50: a matrix (degree 1) or a root polynomial of order 2, 3 or 4
//! (Finlayson, Mackiewicz, Hurlbert, "Color Correction Using Root-Polynomial Regression", IEEE TIP 24(5), 2015).
//! Every term of a root polynomial has degree one, so the correction commutes with exposure.
//!
//! **What it does not do:** it reads no files (the caller gives it text) and knows no pictures, only planes of
//! numbers.

pub mod terms;
pub use terms::{Order, Term};

pub mod model;
pub use model::Model;

pub mod planes;
pub use planes::PlaneModel;

pub mod calibration;
pub use calibration::{Calibration, Light, Profile, ProfileCamera};

pub mod simd;

pub mod file;
pub use file::Error;
