//! What one camera's colours mean: from balanced camera RGB to XYZ.
//!
//! A [`Profile`] holds one [`Calibration`] per light. Its [`Model`] takes balanced camera RGB, in which the white
//! of the light is (1,1,1), to XYZ relative to D50. A model is a sum of parts: a matrix or root polynomial of order
//! 2, 3 or 4 (Finlayson, Mackiewicz, Hurlbert, "Color Correction Using Root-Polynomial Regression", IEEE TIP 24(5),
//! 2015), a table of matrices by hue, a smooth function of chromaticity. Each has degree one, so the correction
//! commutes with exposure. Only plain polynomials, kept for comparison, do not.
//!
//! **What it does not do:** it reads no files (the caller gives it text) and knows no pictures, only planes of
//! numbers.

pub mod terms;
pub use terms::{Order, Term};

pub mod model;
pub use model::{Model, Part};

pub mod root;
pub use root::RootPolynomial;

pub mod hue_plane;
pub use hue_plane::HuePlane;

pub mod rendering;
pub use rendering::{LookTable, Rendering, ToneCurve};

pub mod residual;
pub use residual::Residual;

pub mod polynomial;
pub use polynomial::Polynomial;

pub mod planes;
pub use planes::PlaneModel;

pub mod calibration;
pub use calibration::{Calibration, FarLight, Light, Origin, Patch, Profile, ProfileCamera};

pub mod kind;
pub use kind::Kind;

pub mod figures;
pub use figures::{Errors, Figures, Summary};

pub mod camera;

pub mod fit;

pub mod lint;

pub mod spectra;
pub use spectra::{Effective, Sensitivities};

pub mod file;
pub use file::Error;

pub mod export;

#[cfg(test)]
mod samples_for_tests;
