//! What a person asks for: the settings of each stage, all with defaults.

use darkroot_colour::RgbSpace;

pub use crate::geometry::{Crop, Flip, Geometry, Lens, Lines, Marks, Perspective, Resize, Turn};
pub use crate::lut::Overlay;
pub use crate::tone::{Points, PointsError, Tones};

/// How a photograph shall be developed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recipe {
    /// White of the light.
    pub balance: Balance,
    /// What becomes of clipped highlights.
    pub highlights: Highlights,
    /// What becomes of hot and dead pixels.
    pub hot_pixels: Mending,
    /// What becomes of rows that lie too high or too low.
    pub banding: Mending,
    /// How much noise is taken away.
    pub denoise: Denoise,
    /// How missing colours are interpolated.
    pub demosaic: Demosaic,
    /// How much of the sharpness that the camera took is given back: 0 nothing, 1 as much as was measured; `None` for what
    /// suits the look: 1, in the linear look and in camera RGB 0.
    pub sharpen: Option<f32>,
    /// Brightness.
    pub exposure: Exposure,
    /// What becomes of a local tone map in the file.
    pub local_tone: LocalTone,
    /// Rendering from scene to display.
    pub look: Look,
    /// What is changed about it.
    pub tones: Tones,
    /// A table laid over it; `None` for none.
    pub lut: Option<Overlay>,
    /// What becomes of colours that the output cannot show.
    pub gamut: Gamut,
    /// Which part of the frame.
    pub crop: Crop,
    /// How that lies in the picture, and how large it gets.
    pub geometry: Geometry,
    /// Name of the lens, for whoever looks up what is known of it; `None` for that in the metadata.
    pub lens_name: Option<String>,
    /// Space and sample type of the result.
    pub output: Output,
}

/// Where the white of the light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Balance {
    /// As the camera recorded it; from the picture when it did not.
    #[default]
    AsShot,
    /// Daylight at noon, CIE D55.
    Daylight,
    /// Estimated from the picture.
    Auto,
    /// A colour temperature (2000..=25000 K) and a tint (-150 green ..= 150 magenta, 0 on the Planckian locus).
    Kelvin {
        /// Correlated colour temperature, K.
        kelvin: f64,
        /// Distance of the light from the Planckian locus, 3000 units per unit of CIE 1960 uv; positive makes the
        /// picture more magenta.
        tint: f64,
    },
    /// A grey surface in the picture: centre and side of a square, in pixels of the developed picture.
    Spot {
        /// Column of the centre.
        x: usize,
        /// Row of the centre.
        y: usize,
        /// Side of the square.
        side: usize,
    },
    /// Multipliers for red, green and blue; only their ratios count.
    Multipliers([f64; 3]),
}

/// What becomes of the local tone map that a file carries, as phones write it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LocalTone {
    /// It is applied in looks for people: not in the linear one, not in the reproduction.
    #[default]
    Auto,
    /// It is left out.
    Off,
}

/// What becomes of samples at the sensor's limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Highlights {
    /// Clipped channels are estimated from the others; where all are clipped the result is neutral.
    #[default]
    Rebuild,
    /// Every channel is cut at the level where the first one clips: white stays white, detail is lost.
    Clip,
    /// Nothing: values stay as the sensor gave them, which tints clipped areas. For measurement.
    Keep,
}

/// What becomes of faults of the sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mending {
    /// They are put right where they are certain; in the linear look and in camera RGB they stay.
    #[default]
    Auto,
    /// They stay.
    Off,
}

/// What noise is told by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DenoiseBy {
    /// By how strong details of each scale are around a place: fast.
    #[default]
    Scales,
    /// By blocks of the picture that are like each other: better, and slow. Where there is nothing to compare, under other
    /// arrays than Bayer's and in the smallest frames, by scales.
    Likeness,
}

/// How much noise is taken away before interpolation: shares of what the noise model expects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Denoise {
    /// How it is told.
    pub by: DenoiseBy,
    /// Of all; `None` for what suits the look: all of it, in the linear look none.
    pub amount: Option<f32>,
    /// Of brightness, times `amount`.
    pub luma: f32,
    /// Of colour, times `amount`.
    pub chroma: f32,
}

impl Default for Denoise {
    fn default() -> Self {
        Self { by: DenoiseBy::Scales, amount: None, luma: 1.0, chroma: 1.0 }
    }
}

/// How missing colours of a mosaic are interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Demosaic {
    /// The best for the sensor: directional LMMSE for Bayer, a directional method for X-Trans.
    #[default]
    Best,
    /// Bilinear: fast and soft; the reference for tests.
    Bilinear,
}

/// Brightness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Exposure {
    /// Stops to add: +1 is twice the light.
    pub stops: f64,
    /// Whether to choose a brightness from the picture first.
    pub auto: bool,
}

/// Rendering from scene to display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Look {
    /// Gentle contrast and soft highlights, colours as measured.
    #[default]
    Neutral,
    /// More contrast and chroma.
    Vivid,
    /// Low contrast, for further editing.
    Flat,
    /// As the camera rendered it: neutral with a curve and a factor on chroma that are fitted to the embedded preview
    /// ([`camera_look`](crate::camera_look)). Without that, neutral.
    Camera,
    /// As the maker of the profile would show it: look table and tone curve of a DCP. Refused where the profile has none.
    Profile,
    /// Colorimetric: light in proportion, colours as measured, no tone curve, no baseline exposure; neither denoised nor
    /// sharpened unless asked. What an original is reproduced with.
    Reproduction,
    /// Strictly scene-linear: no automatic anything, not even the maker's baseline exposure.
    Linear,
}

/// What becomes of colours that the output cannot show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gamut {
    /// What suits the look: they are cut in the reproduction look, and mapped in those with a tone curve.
    #[default]
    Auto,
    /// Each channel is cut at black and at white: what the output can show stays exactly as it is, and of the rest hue,
    /// lightness and chroma may change.
    Clip,
    /// They lose chroma at their hue and lightness until the output can show them.
    Map,
}

/// Space and sample type of the result.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// Colour space.
    pub space: OutputSpace,
    /// Sample type.
    pub bits: Bits,
}

/// Colour space of the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OutputSpace {
    /// An RGB space with its transfer curve.
    Rgb(RgbSpace),
    /// Linear, balanced camera RGB before any profile.
    Camera,
    /// Linear camera RGB that is not balanced, for another raw developer. Noise, hot pixels and the lens are corrected as for
    /// people, but nothing is rebuilt, exposed or sharpened.
    Raw,
}

impl Default for OutputSpace {
    fn default() -> Self {
        Self::Rgb(RgbSpace::SRGB)
    }
}

/// Sample type of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bits {
    /// 8-bit integers.
    #[default]
    Eight,
    /// 16-bit integers.
    Sixteen,
    /// 32-bit floating point, not cut at black and white.
    Float,
}

impl Bits {
    /// 8, 16 or 32.
    pub fn count(self) -> u8 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
            Self::Float => 32,
        }
    }
}
