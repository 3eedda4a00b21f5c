//! What can go wrong, sorted by whose fault it is.

use std::error::Error as StdError;
use std::io;

use darkroot_photo::Size;

use crate::Format;

/// Why a picture was not written. Each message is a sentence for a person, without its full stop.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    // The choice of the person: another format, space or setting will do.
    /// The format cannot say what the numbers of this space mean.
    #[error("{format} cannot hold a picture in {space}: {instead}")]
    Space {
        /// The format that was asked for.
        format: Format,
        /// Name of the space.
        space: String,
        /// What to choose instead.
        instead: &'static str,
    },
    /// The format has no samples of so many bits.
    #[error("{format} has no samples of {bits} bits: choose {}", either(format.bits()))]
    Bits {
        /// The format that was asked for.
        format: Format,
        /// Bits a sample of the picture.
        bits: u8,
    },
    /// The picture is wider or higher than the format allows.
    #[error(
        "{format} holds at most {limit} pixels a side, and the picture has {} x {}: make it smaller or \
         choose another format",
        size.width, size.height
    )]
    TooLarge {
        /// The format that was asked for.
        format: Format,
        /// Size of the picture.
        size: Size,
        /// Largest width and height.
        limit: usize,
    },
    /// The quality is not one of 1..=100.
    #[error("the quality is {0}: choose a number from 1 to 100")]
    Quality(u8),
    /// The speed of the AVIF encoder is not one of 1..=10.
    #[error("the AVIF speed is {0}: choose a number from 1 (smallest file) to 10 (fastest)")]
    Speed(u8),

    // The fields of the shot.
    /// The Exif fields do not fit in the one segment that a JPEG has for them, even without the maker note.
    #[error("the Exif fields take {bytes} bytes and a JPEG has room for {limit}: leave some out")]
    ExifTooLarge {
        /// Bytes of the Exif block.
        bytes: usize,
        /// Bytes that a JPEG has room for.
        limit: usize,
    },

    // The fault of the program that made the picture.
    /// The picture has no pixels.
    #[error("the picture has no pixels: it is {} x {}", .0.width, .0.height)]
    Empty(Size),
    /// The samples do not fill the picture.
    #[error("a picture of {} x {} cannot have {samples} samples", size.width, size.height)]
    SampleCount {
        /// Size of the picture.
        size: Size,
        /// Number of its samples; `3 * size.area()` would be right.
        samples: usize,
    },

    /// The format needs the whole picture at once.
    #[error("{0} is not written in bands")]
    NotInBands(Format),

    // The fault of the world.
    /// The bytes could not be written, for example because the disk is full.
    #[error("the picture could not be written")]
    Io(#[source] io::Error),
    /// The library that encodes this format gave up.
    #[error("the {format} encoder gave up")]
    Encoder {
        /// The format that was asked for.
        format: Format,
        /// What the library says.
        #[source]
        source: Box<dyn StdError + Send + Sync>,
    },
}

impl Error {
    /// Wraps what the library for `format` says.
    pub(crate) fn encoder(format: Format) -> impl Fn(Box<dyn StdError + Send + Sync>) -> Self {
        move |source| Self::Encoder { format, source }
    }
}

/// "8 or 16".
fn either(bits: &[u8]) -> String {
    bits.iter().map(u8::to_string).collect::<Vec<_>>().join(" or ")
}
