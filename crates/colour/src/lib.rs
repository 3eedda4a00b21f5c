//! Colour science without pictures.
//!
//! Tristimulus values, CIELAB, CIELUV, Oklab, white points, spectra measured or standard, the standard observer,
//! correlated colour temperature, chromatic adaptation, colour differences, RGB spaces and their transfer curves.
//! Everything is `f64`, pure and free of state.
//!
//! **What it does not do:** it knows no picture, no camera and no file.
//!
//! Conventions: XYZ is relative, with Y = 1 for the white; a matrix is applied to column vectors; wavelengths
//! are in nanometres.

pub mod xyz;
pub use xyz::{Lab, Xy, Xyz};

pub mod luv;
pub use luv::{Luv, UvPrime};

pub mod oklab;
pub use oklab::Oklab;

pub mod white;

pub mod adaptation;
pub use adaptation::Cat;

pub mod difference;
pub mod temperature;

pub mod space;
pub use space::{RgbSpace, TransferCurve};

pub mod spectrum;
pub use spectrum::Spectrum;

pub mod measured;
pub use measured::{Coverage, Measured, SpectrumError};

pub mod illuminant;
pub use illuminant::Illuminant;

pub mod observer;

pub mod weights;
pub use weights::TristimulusWeights;

pub mod statistics;

pub mod decomposition;

// No colour, but at the bottom of the house, where every crate with loops over pixels finds it.
pub mod simd;

mod sprague;
mod tables;

/// A 3x3 matrix applied to column vectors.
pub type Matrix3 = nalgebra::Matrix3<f64>;

/// A column of three numbers (an XYZ, an RGB) for use with [`Matrix3`].
pub type Vector3 = nalgebra::Vector3<f64>;
