//! Which part of the frame becomes the picture, how it is turned and straightened, freed of what the lens did to it, and how
//! large it gets.
//!
//! All of that is one map from places of the picture to places of the frame, so a picture is interpolated once, in linear
//! light, however much of it is asked for. A turn, a mirroring and a crop of whole pixels interpolate nothing: they stay what
//! they are, a rectangle and an orientation.

mod asked;
mod homography;
mod lay;
mod lens;
mod optics;
mod perspective;
mod resample;
mod runs;
#[cfg(test)]
mod runs_tests;
mod taps;
mod vignetting;
mod warp;

pub use asked::{Crop, Flip, Geometry, Lens, Resize, Turn};
pub(crate) use lay::{Laid, lay};
pub use perspective::{Lines, Marks, Perspective};
pub(crate) use resample::{Scratch, resample};
pub(crate) use vignetting::brighten;
pub(crate) use warp::Warp;
