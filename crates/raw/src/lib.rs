//! Bytes of a raw file to a [`Capture`]: the only part of Darkroot that meets hostile input.
//!
//! [`decode`] screens the container first (`screen.rs`), so that no decoder sees a file whose directories loop
//! or whose sizes are beyond the [`Limits`], whose strips overlap or are larger than their place
//! (`pieces.rs`). Then one of two decoders runs, behind a guard that turns a panic
//! into an error: flashraw (default) or rawloader (older makers, cross-check).
//!
//! **What it does not do:** it opens no files, it corrects nothing but what the file's own OpcodeList1 asks for,
//! and it never guesses in silence: what had to be assumed stands in [`Capture::notes`].

use darkroot_photo::Capture;

use elsewhere::Question;

pub mod cameras;
pub use cameras::{Listed, cameras, is_listed};

pub mod error;
pub use error::{Damage, Error, TooLarge, Unknown};

pub mod elsewhere;

pub mod limits;
pub use limits::Limits;

pub mod preview;
pub use preview::{Preview, decode_preview, preview, preview_pixels, preview_to_show};

pub mod samples;
pub use samples::samples_hash;

mod jpeg_frame;
mod jxl_frame;
mod pieces;
mod screen;
mod tiff;

mod flash;
mod flash_facts;
mod loader;

mod dng_extras;
mod dng_jxl;
mod dng_mends;
mod local_tone;
mod maker_note;
mod nef_packing;
mod nikon_note;
mod raf;

mod exif;
mod opcode_work;
mod opcodes;

/// Which library decodes the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Decoder {
    /// flashraw: every current format, exact on all known-truth fixtures.
    #[default]
    Flashraw,
    /// rawloader: a second opinion for cameras up to about 2018. It dithers Nikon files slightly and is refused
    /// where it is known to be wrong.
    Rawloader,
}

/// Decodes a raw file.
///
/// The samples are as stored, after the file's linearisation table and DNG OpcodeList1; black and white level
/// are facts beside them, not applied.
///
/// # Errors
/// Anything wrong with the file, as one [`Error`] that says what and what to do. Never panics for input.
pub fn decode(bytes: &[u8], decoder: Decoder, limits: &Limits) -> Result<Capture, Error> {
    if let Some(place) = elsewhere::place() {
        return elsewhere::capture(place, Question::Samples(decoder), bytes, limits);
    }
    let container = screen::screen(bytes, limits)?;
    container.tiff.as_ref().map_or(Ok(()), nikon_note::refuse_high_efficiency)?;
    match decoder {
        Decoder::Flashraw => guarded("flashraw", || flash::decode(bytes, &container, limits)),
        Decoder::Rawloader => {
            // rawloader takes a file that ends too early for a whole one; flashraw says so.
            if let Err(damaged @ Error::Damaged(_)) =
                guarded("flashraw", || flash::decode(bytes, &container, limits).map(drop))
            {
                return Err(damaged);
            }
            // Everything but the samples comes from flashraw's reading of the headers and our own.
            let header = guarded("flashraw", || flash::header(bytes, &container, limits))?;
            guarded("rawloader", || loader::decode(bytes, header, limits))
        }
    }
}

/// Reads everything but the samples: fast, for choosing a profile or listing files. The samples of the result
/// are empty.
///
/// # Errors
/// As [`decode`].
pub fn header(bytes: &[u8], limits: &Limits) -> Result<Capture, Error> {
    if let Some(place) = elsewhere::place() {
        return elsewhere::capture(place, Question::Header, bytes, limits);
    }
    let container = screen::screen(bytes, limits)?;
    guarded("flashraw", || flash::header(bytes, &container, limits))
}

/// Runs a foreign decoder so that a panic inside it costs one file and no more.
fn guarded<T>(decoder: &'static str, run: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(run))
        .unwrap_or(Err(Error::DecoderFailed { decoder }))
}

#[cfg(test)]
mod tests;
