//! Decoding in another process, for a program that a file must not take over: one that answers connections, or holds what is
//! not saved. Such a program gives a place once, with [`decode_at`]; from then on no decoder runs in its own process, whichever
//! function of this crate is called.

use std::sync::OnceLock;

use darkroot_photo::{Capture, Size};
use serde::{Deserialize, Serialize};

use crate::preview::Preview;
use crate::{Decoder, Error, Limits};

/// What is asked of bytes, by the function that it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Question {
    /// [`crate::decode`].
    Samples(Decoder),
    /// [`crate::header`].
    Header,
    /// [`crate::preview_to_show`].
    Preview {
        /// Pixels that its longer side shall have at least.
        longest: u32,
    },
    /// [`crate::decode_preview`].
    DevelopedPreview,
    /// [`crate::preview_pixels`].
    Pixels,
}

/// What a decoder gives.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// To [`Question::Samples`], [`Question::Header`] and [`Question::DevelopedPreview`].
    Capture(Box<Capture>),
    /// To [`Question::Preview`].
    Preview(Preview),
    /// To [`Question::Pixels`].
    Pixels(Size, Vec<u8>),
    /// There is no embedded picture.
    Nothing,
}

impl Question {
    /// Answers it, in this process if it has given no other place.
    ///
    /// # Errors
    /// As those of the function that it stands for.
    pub fn answer(self, bytes: &[u8], limits: &Limits) -> Result<Answer, Error> {
        let capture = |capture| Answer::Capture(Box::new(capture));
        Ok(match self {
            Self::Samples(decoder) => capture(crate::decode(bytes, decoder, limits)?),
            Self::Header => capture(crate::header(bytes, limits)?),
            Self::Preview { longest } => {
                crate::preview_to_show(bytes, longest)?.map_or(Answer::Nothing, Answer::Preview)
            }
            Self::DevelopedPreview => crate::decode_preview(bytes, limits)?.map_or(Answer::Nothing, capture),
            Self::Pixels => {
                let (size, rgb) = crate::preview_pixels(bytes, limits)?;
                Answer::Pixels(size, rgb)
            }
        })
    }
}

/// Where decoders run.
pub trait Place: Send + Sync + 'static {
    /// Has a question answered there.
    ///
    /// # Errors
    /// [`Error::Elsewhere`] with what the decoder says, or how its process ended.
    fn ask(&self, question: Question, bytes: &[u8], limits: &Limits) -> Result<Answer, Error>;
}

static PLACE: OnceLock<Box<dyn Place>> = OnceLock::new();

/// From now on decoders run there, and not in this process. A process can say so once; whether it has not yet.
pub fn decode_at(place: impl Place) -> bool {
    PLACE.set(Box::new(place)).is_ok()
}

pub(crate) fn place() -> Option<&'static dyn Place> {
    PLACE.get().map(|place| &**place)
}

pub(crate) fn capture(
    place: &dyn Place,
    question: Question,
    bytes: &[u8],
    limits: &Limits,
) -> Result<Capture, Error> {
    match place.ask(question, bytes, limits)? {
        Answer::Capture(capture) => Ok(*capture),
        _ => Err(another()),
    }
}

/// A decoder that answers something else has been led astray.
pub(crate) fn another() -> Error {
    Error::Elsewhere { words: "made its decoder answer something else than was asked".to_owned() }
}
