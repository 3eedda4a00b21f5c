//! Why a capture cannot be developed as asked.

use std::fmt;

use darkroot_photo::Size;

use crate::camera_look::NoCameraLook;

/// What does not fit. Each message completes "FILE: ".
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The sensor has filters of other colours.
    #[error("has a sensor with the filters {filters}, which cannot be developed yet")]
    Filters {
        /// The filter array.
        filters: String,
    },
    /// A temperature was asked of a camera without matrices.
    #[error("has no colour matrix, so a colour temperature means nothing for it")]
    NoMatrix,
    /// A temperature that is no light.
    #[error(
        "cannot be balanced for {kelvin} K with tint {tint}: use 2000 to 25000 K and a tint of -150 to 150"
    )]
    Temperature {
        /// What was asked.
        kelvin: f64,
        /// What was asked.
        tint: f64,
    },
    /// Multipliers that are not positive numbers.
    #[error(
        "cannot be balanced with these multipliers: all three must be more than 0 (and at most 100 apart)"
    )]
    Multipliers,
    /// A grey spot that tells no white.
    #[error(
        "has no usable grey at {x},{y}: {fault}; choose a spot inside the {width} x {height} picture",
        width = size.width, height = size.height
    )]
    Spot {
        /// Column asked for.
        x: usize,
        /// Row asked for.
        y: usize,
        /// What is wrong with it.
        fault: SpotFault,
        /// Size of the picture.
        size: Size,
    },
    /// The camera's own look cannot be told.
    #[error("{0}; choose another look")]
    CameraLook(#[from] NoCameraLook),
    /// The profile says nothing of looks.
    #[error("has no profile that brings a tone curve or a look table along; choose another look")]
    NoProfileLook,
    /// A frame that cannot be.
    #[error("{fault}; the picture has {width} x {height} pixels", width = size.width, height = size.height)]
    Geometry {
        /// What is wrong.
        fault: GeometryFault,
        /// Size of the picture before it is straightened and cut.
        size: Size,
    },
}

/// What is wrong with how a picture shall lie in the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GeometryFault {
    /// Not between -45 and 45 degrees.
    Angle,
    /// Not the corners of a convex quadrangle, clockwise from the top left.
    Corners,
    /// Lines that do not tell how the camera was held.
    Lines,
    /// Not inside the picture.
    Crop,
    /// A corner shows what the picture has not.
    CropCorner,
    /// Nothing of the picture is left.
    Nothing,
    /// No pixel, or more than there can be.
    Size,
}

impl fmt::Display for GeometryFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Angle => "cannot be straightened by more than 45 degrees",
            Self::Corners => {
                "cannot be put into perspective: its four corners must be those of a convex quadrangle, from the top left \
                 one clockwise"
            }
            Self::Lines => {
                "cannot be put into perspective: lines must lean by less than 45 degrees from what they shall be, two of a kind must \
                 be apart, and they may meet outside of the picture only"
            }
            Self::Crop => "cannot be cropped to that: it is not inside of the picture",
            Self::CropCorner => "cannot be cropped to that: a corner lies outside of the straightened picture",
            Self::Nothing => "cannot be straightened and cropped like that: nothing is left",
            Self::Size => "cannot be made that large: sides have 1 to 65500 pixels",
        })
    }
}

/// What is wrong with a grey spot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpotFault {
    /// Beyond the picture's edge.
    Outside,
    /// Fewer than 8 x 8 pixels of it lie in the picture.
    TooSmall,
    /// Too little light for a colour.
    TooDark,
    /// A channel is at its limit.
    Clipped,
}

impl fmt::Display for SpotFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Outside => "it lies outside",
            Self::TooSmall => "the picture is too small there",
            Self::TooDark => "it is too dark",
            Self::Clipped => "it is clipped",
        })
    }
}
