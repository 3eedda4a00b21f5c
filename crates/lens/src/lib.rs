//! From what a photograph's metadata say of camera and lens to the corrections that the lensfun database knows:
//! distortion, lateral chromatic aberration (TCA) and vignetting.
//!
//! ```
//! use darkroot_lens::{Shot, find};
//!
//! let shot = Shot {
//!     lens_model: Some("NIKKOR Z 24-70mm f/4 S"),
//!     aperture: Some(4.0),
//!     ..Shot::new("NIKON CORPORATION", "NIKON Z 6", 24.0)
//! };
//! let found = find(&shot).unwrap();
//! let corrections = found.corrections((6048, 4024));
//! // Half the diagonal from the middle: where that light is in the picture as taken, for red, green and blue.
//! let [_, green, _] = corrections.place(1512.0, 1006.0);
//! assert!(green.0.is_finite() && corrections.gain(green.0, green.1) > 1.0);
//! ```
//!
//! The crate `lensfun` reads the database when this one is built; the program contains tables (about 1.1 MB, never
//! unpacked) and searches them from front to end, so that nothing is loaded when it starts. The models and how
//! measurements are interpolated are those of lensfun 0.3.4, as its manual has them
//! (<https://lensfun.github.io/manual/latest/>); NOTICE beside `Cargo.toml` says whose the measurements are.
//!
//! **What it does not do:** it reads no files and no Exif, does not move pixels, does not turn fisheye pictures into
//! rectilinear ones, and never takes a lens that is only similar.

mod catalogue;
mod corrections;
mod find;
mod interpolate;
mod name;

pub use corrections::{Corrections, MOST_GAIN};
pub use find::{Found, Match, Shot, find};
