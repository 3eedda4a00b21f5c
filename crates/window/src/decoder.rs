//! The process that decodes for a window, and the words between both.
//!
//! A message is its head (what `postcard` makes of it) and a body of plain bytes, each behind its length: four bytes for the
//! head, eight for the body. The program sends an [`Order`] with the bytes of a file, and gets a [`Reply`] with samples, pixels or
//! a JPEG.

use std::error::Error as StdError;
use std::io::{self, Read, Write};

use darkroot::Limits;
use darkroot_batch::process_limits;
use darkroot_photo::{Capture, Counts, Orientation, Size};
use darkroot_raw::elsewhere::{Answer, Question};
use darkroot_sandbox::{Access, Breach, Reach, confine};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The longest head, bytes: gain maps and metadata of a file.
const LONGEST_HEAD: u32 = 256 << 20;

/// What is to be done with a body.
#[derive(Serialize, Deserialize)]
pub(crate) struct Order {
    pub(crate) question: Question,
    pub(crate) limits: Limits,
}

/// What became of it, or a sentence about the file.
pub(crate) type Reply = Result<Told, String>;

/// An answer without what stands in the body.
#[derive(Serialize, Deserialize)]
pub(crate) enum Told {
    /// The body has its samples.
    Capture(Box<Capture>),
    /// The body is the JPEG.
    Preview {
        size: Size,
        orientation: Orientation,
    },
    /// The body has red, green and blue of each pixel.
    Pixels(Size),
    Nothing,
}

/// Decodes for a window until there are no more orders. `words` words what is wrong with a file.
///
/// With `sandbox`, the process gives up every path, every connection and every other program before it reads a byte, as far as
/// the system offers that; see `darkroot_sandbox`. It must have no other threads then.
///
/// # Errors
/// A pipe fails, or the sandbox is refused.
pub fn serve_decoder(
    mut orders: impl Read,
    mut replies: impl Write,
    words: &dyn Fn(&(dyn StdError + 'static)) -> String,
    sandbox: bool,
) -> io::Result<()> {
    process_limits::prepare();
    if sandbox {
        let nothing = Reach::default().with("/proc/self", Access::Read);
        confine(&nothing, Breach::Ends).map_err(io::Error::other)?;
    }
    while let Some(Order { question, limits }) = read_head(&mut orders)? {
        // Samples have two bytes, or four; those of a file of that kind come from as many.
        process_limits::limit_memory(2 * limits.max_samples);
        let bytes = read_body(&mut orders, u64::MAX)?;
        match question.answer(&bytes, &limits) {
            Ok(answer) => reply(&mut replies, answer)?,
            Err(error) => send(&mut replies, &Reply::Err(words(&error)), &[])?,
        }
        replies.flush()?;
    }
    Ok(())
}

fn reply(to: &mut impl Write, answer: Answer) -> io::Result<()> {
    match answer {
        Answer::Capture(mut capture) => match &mut capture.counts {
            Counts::U16(mosaic) => {
                let samples = std::mem::take(&mut mosaic.samples);
                send(to, &Reply::Ok(Told::Capture(capture)), bytemuck::cast_slice(&samples))
            }
            Counts::F32(mosaic) => {
                let samples = std::mem::take(&mut mosaic.samples);
                send(to, &Reply::Ok(Told::Capture(capture)), bytemuck::cast_slice(&samples))
            }
        },
        Answer::Preview(preview) => {
            let told = Told::Preview { size: preview.size, orientation: preview.orientation };
            send(to, &Reply::Ok(told), &preview.jpeg)
        }
        Answer::Pixels(size, rgb) => send(to, &Reply::Ok(Told::Pixels(size)), &rgb),
        Answer::Nothing => send(to, &Reply::Ok(Told::Nothing), &[]),
    }
}

pub(crate) fn send(to: &mut impl Write, head: &impl Serialize, body: &[u8]) -> io::Result<()> {
    let head = postcard::to_stdvec(head).map_err(io::Error::other)?;
    let length = u32::try_from(head.len()).map_err(io::Error::other)?;
    to.write_all(&length.to_le_bytes())?;
    to.write_all(&head)?;
    to.write_all(&(body.len() as u64).to_le_bytes())?;
    to.write_all(body)
}

/// The next head; `None` where there is no more.
pub(crate) fn read_head<T: DeserializeOwned>(from: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; 4];
    match from.read_exact(&mut length) {
        Err(e) if e.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        read => read?,
    }
    let length = u32::from_le_bytes(length);
    if length > LONGEST_HEAD {
        return Err(io::ErrorKind::InvalidData.into());
    }
    let mut head = Vec::new();
    from.take(length.into()).read_to_end(&mut head)?;
    postcard::from_bytes(&head).map(Some).map_err(io::Error::other)
}

/// Length of the body that follows, at most so many bytes.
pub(crate) fn read_length(from: &mut impl Read, most: u64) -> io::Result<usize> {
    let mut length = [0; 8];
    from.read_exact(&mut length)?;
    let length = u64::from_le_bytes(length);
    let fits = usize::try_from(length).ok().filter(|_| length <= most);
    fits.ok_or_else(|| io::ErrorKind::InvalidData.into())
}

pub(crate) fn read_body(from: &mut impl Read, most: u64) -> io::Result<Vec<u8>> {
    let length = read_length(from, most)?;
    let mut body = Vec::new();
    body.try_reserve_exact(length).map_err(|_| io::ErrorKind::OutOfMemory)?;
    from.take(length as u64).read_to_end(&mut body)?;
    if body.len() == length { Ok(body) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}
