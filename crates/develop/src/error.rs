//! Why a capture cannot be developed as asked.

use std::fmt;

use darkroot_photo::Size;

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
