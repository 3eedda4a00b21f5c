//! The way of the bytes out, which remembers why it failed.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use crate::Error;

/// Where the bytes of a file go.
pub trait Out: Write + Seek + Send {}

impl<T: Write + Seek + Send + ?Sized> Out for T {}

/// A writer that keeps the first error of the one below.
///
/// Encoders turn an error of their output into one of their own, and some lose its kind on the way ([`png`],
/// [`exr`] and others each do it differently). What went wrong is kept here, so that a caller can tell a full
/// disk from anything else.
pub(crate) struct Output<'a> {
    out: &'a mut dyn Out,
    failure: Option<io::Error>,
}

impl Output<'_> {
    /// Keeps the error and hands the encoder a copy of its kind.
    fn note<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| {
            let kind = error.kind();
            if kind != io::ErrorKind::Interrupted && self.failure.is_none() {
                self.failure = Some(error);
            }
            kind.into()
        })
    }
}

impl Write for Output<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.out.write(bytes);
        self.note(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.out.flush();
        self.note(result)
    }
}

impl Seek for Output<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let result = self.out.seek(to);
        self.note(result)
    }
}

/// What the encoders of this crate write to.
pub(crate) type Buffered<'a, 'b> = BufWriter<&'a mut Output<'b>>;

/// Runs `encode` on a buffer before `out`, and flushes it. An error of `out` comes back as [`Error::Io`],
/// whatever the encoder made of it.
pub(crate) fn buffered(
    out: &mut dyn Out,
    encode: impl FnOnce(&mut Buffered<'_, '_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut output = Output { out, failure: None };
    let mut buffer = BufWriter::with_capacity(1 << 17, &mut output);
    let result = encode(&mut buffer).and_then(|()| buffer.flush().map_err(Error::Io));
    // Dropping the buffer would try to write the rest of a file that has failed already.
    let _ = buffer.into_parts();
    match output.failure.take() {
        Some(error) => Err(Error::Io(error)),
        None => result,
    }
}

/// Writes over places that were left for it, each so many bytes from the output's beginning, and goes back to the end.
pub(crate) fn fill(out: &mut (impl Write + Seek), places: &[(u64, &[u8])]) -> Result<(), Error> {
    let mut filled = || {
        let end = out.stream_position()?;
        for (place, bytes) in places {
            out.seek(SeekFrom::Start(*place))?;
            out.write_all(bytes)?;
        }
        out.seek(SeekFrom::Start(end)).map(drop)
    };
    filled().map_err(Error::Io)
}
