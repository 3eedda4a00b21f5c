//! What a photograph is at each step of development: nouns only.
//!
//! | type | meaning, range |
//! |---|---|
//! | [`Counts`] | what the decoder gave: sensor counts under a colour filter array, or linear RGB, as stored |
//! | [`Mosaic<f32>`](Mosaic) | linear light under the same filters: 0 = black, 1 = saturated |
//! | [`Rgb<Camera>`](Rgb) | linear, balanced so that the light's white is (1,1,1), one sensor's primaries; may be negative |
//! | [`Rgb<Scene>`](Rgb) | scene-linear Rec. 2020, unbounded, white (1,1,1) |
//! | [`Rgb<Toned>`](Rgb) | a look applied: Oklab's cone-like responses to the light that a display shall show, 1 = white |
//! | [`Rgb<Display>`](Rgb) | linear, output primaries; 0..=1 after a look, unbounded in the linear look |
//! | [`Picture`] | the finished picture, interleaved, in the sample type of the file |
//!
//! A stage takes one of these types and gives another, so a wrong order of stages does not compile:
//!
//! ```compile_fail
//! use darkroot_photo::{Rgb, Scene, Size, Toned};
//! fn tone(picture: Rgb<Scene>) -> Rgb<Toned> { unimplemented!() }
//! let toned: Rgb<Toned> = Rgb::black(Size { width: 2, height: 2 });
//! tone(toned); // A picture cannot be toned twice.
//! ```
//!
//! **What it does not do:** it computes nothing about colour, reads no bytes and knows no file.

pub mod capture;
pub use capture::{AsShot, Calibration, Camera, Capture, Source};

pub mod mosaic;
pub use mosaic::{Cfa, Counts, Filter, Layout, Mosaic};

pub mod levels;
pub use levels::{BlackLevel, WhiteLevel};

pub mod correction;
pub use correction::Correction;

pub mod local_tone;
pub use local_tone::LocalToneMap;

pub mod maker_lens;
pub use maker_lens::{MakerLens, Radial};

pub mod planes;
pub use planes::{Camera as CameraSpace, Display, Rgb, Scene, Toned};

pub mod picture;
pub use picture::{Picture, PictureSpace, Samples};

pub mod geometry;
pub use geometry::{Orientation, Rect, Size};

pub mod metadata;
pub use metadata::Metadata;
