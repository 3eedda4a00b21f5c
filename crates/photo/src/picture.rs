//! The finished picture: what an encoder writes.

use darkroot_colour::RgbSpace;

use crate::Size;

/// Interleaved RGB samples in the type of the file.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// 8 bits: 0 = black, 255 = white.
    U8(Vec<u8>),
    /// 16 bits: 0 = black, 65535 = white.
    U16(Vec<u16>),
    /// Floating point: 0 = black, 1 = white; may lie outside when the picture is scene-linear.
    F32(Vec<f32>),
}

impl Samples {
    /// Bits a sample: 8, 16 or 32.
    pub fn bits(&self) -> u8 {
        match self {
            Self::U8(_) => 8,
            Self::U16(_) => 16,
            Self::F32(_) => 32,
        }
    }
}

/// What the numbers of a finished picture mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PictureSpace {
    /// An RGB space with its transfer curve.
    Rgb(RgbSpace),
    /// Linear, balanced camera RGB before any profile: no ICC profile can describe it.
    Camera,
    /// Linear camera RGB as the sensor has it, not balanced, for another raw developer: 0 is no light, 1 the level at which the
    /// sensor is full.
    Raw,
}

impl PictureSpace {
    /// Name as people write it.
    pub fn name(&self) -> String {
        match self {
            Self::Rgb(space) if space.curve == darkroot_colour::TransferCurve::Linear => {
                format!("{}, linear", space.name)
            }
            Self::Rgb(space) => space.name.to_owned(),
            Self::Camera => "camera RGB, linear".to_owned(),
            Self::Raw => "camera RGB, linear, not balanced".to_owned(),
        }
    }
}

/// A finished picture, upright.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Size in pixels.
    pub size: Size,
    /// `3 * size.area()` samples: R, G, B of each pixel, row by row.
    pub samples: Samples,
    /// What the samples mean.
    pub space: PictureSpace,
}
