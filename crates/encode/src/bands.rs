//! Pictures that are written while they are made: nowhere is the whole picture in memory. Bands of rows come on any thread
//! and in any order; each is coded by the thread that made it, and written when those above it are written.

use std::collections::BTreeMap;
use std::io;
use std::sync::{Mutex, PoisonError};

use darkroot_photo::{Metadata, PictureSpace, Size};

use crate::{Error, Format, Options, Out, Sample, dng, exif, jpeg, output, png, tiff};

/// What a picture will be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// Its size in pixels.
    pub size: Size,
    /// What its samples will mean.
    pub space: PictureSpace,
}

/// Takes a band: its number, from the top, and the R, G, B of its pixels, row by row. Any thread may call it, with the
/// bands in any order.
pub type TakeBand<'a, T> = dyn Fn(usize, &[T]) -> Result<(), Error> + Sync + 'a;

/// Writes a picture while `make` makes it: that gets the rows of a band (the last one has what is left) and what takes the
/// bands. The file is, byte for byte, what [`write`](crate::write()) makes of the whole picture.
///
/// # Errors
/// As [`write`](crate::write()), and those of `make`; [`Error::NotInBands`] for a format for which
/// [`Format::takes_bands`] is false.
pub fn write_in_bands<T: Sample, E: From<Error>>(
    outline: &Outline,
    format: Format,
    options: &Options,
    metadata: &Metadata,
    out: &mut dyn Out,
    make: impl FnOnce(usize, &TakeBand<'_, T>) -> Result<(), E>,
) -> Result<(), E> {
    // Stands for what `make` says, of which encoders know nothing. No output fails like this: such calls are made again.
    const MAKING_FAILED: io::ErrorKind = io::ErrorKind::Interrupted;
    let (mut make, mut failure) = (Some(make), None);
    let written = write_made(outline, format, options, metadata, out, &mut |rows, take| match make
        .take()
        .map(|make| make(rows, take))
    {
        Some(Err(e)) => {
            failure = Some(e);
            Err(Error::Io(MAKING_FAILED.into()))
        }
        _ => Ok(()),
    });
    match (written, failure) {
        (Err(Error::Io(e)), Some(failure)) if e.kind() == MAKING_FAILED => Err(failure),
        // An output that failed is why `make` did.
        (written, _) => Ok(written?),
    }
}

/// Has the bands of a picture made, of so many rows each.
pub(crate) type MakeBands<'a, T> = dyn FnMut(usize, &TakeBand<'_, T>) -> Result<(), Error> + 'a;

/// As [`write_in_bands`], for one type of error, so that encoders are compiled once.
fn write_made<T: Sample>(
    outline: &Outline,
    format: Format,
    options: &Options,
    metadata: &Metadata,
    out: &mut dyn Out,
    make: &mut MakeBands<'_, T>,
) -> Result<(), Error> {
    format.accepts(&outline.space)?;
    options.check()?;
    format.sides(outline.size, T::BITS)?;
    let metadata = exif::of_picture(metadata, outline.size, &outline.space, format);
    output::buffered(out, |out| match format {
        Format::Jpeg => jpeg::write(outline, options, &metadata, out, make),
        Format::Png => png::write(outline, &metadata, out, make),
        Format::Tiff => tiff::write(outline, options, &metadata, out, make),
        Format::Dng => dng::write(outline, options, &metadata, out, make),
        Format::Webp | Format::Avif | Format::Exr | Format::Jxl => Err(Error::NotInBands(format)),
    })
}

/// What takes the coded bands of a file, from the top.
pub(crate) trait Sink: Send {
    /// A band as it will stand in the file, or nearly so.
    type Coded: Send;

    /// Writes the next band.
    fn put(&mut self, coded: Self::Coded) -> Result<(), Error>;
}

/// Has bands made, coded and put into `sink`, which it gives back.
pub(crate) fn code<T, S: Sink>(
    size: Size,
    rows: usize,
    sink: S,
    code: impl Fn(usize, &[T]) -> Result<S::Coded, Error> + Sync,
    make: &mut MakeBands<'_, T>,
) -> Result<S, Error> {
    let in_order = Mutex::new(InOrder { sink, next: 0, waiting: BTreeMap::new() });
    make(rows, &|band, samples| {
        let coded = code(band, samples)?;
        in_order.lock().unwrap_or_else(PoisonError::into_inner).put(band, coded)
    })?;
    let in_order = in_order.into_inner().unwrap_or_else(PoisonError::into_inner);
    let bands = size.height.div_ceil(rows);
    if in_order.next != bands {
        let missing = format!("{} of {bands} bands came", in_order.next);
        return Err(Error::Io(io::Error::other(missing)));
    }
    Ok(in_order.sink)
}

/// Bands that come too early wait.
struct InOrder<S: Sink> {
    sink: S,
    next: usize,
    waiting: BTreeMap<usize, S::Coded>,
}

impl<S: Sink> InOrder<S> {
    fn put(&mut self, band: usize, coded: S::Coded) -> Result<(), Error> {
        self.waiting.insert(band, coded);
        while let Some(coded) = self.waiting.remove(&self.next) {
            self.sink.put(coded)?;
            self.next += 1;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::sample::ForSamples;
    use crate::testing::{decoded, metadata, picture};
    use crate::{ChromaSubsampling, TiffCompression, write};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::Picture;

    const SRGB: PictureSpace = PictureSpace::Rgb(RgbSpace::SRGB);

    /// The file of a picture whose bands come from the bottom up.
    struct FromBelow<'a>(&'a Picture, Format, &'a Options);

    impl ForSamples for FromBelow<'_> {
        type Made = Vec<u8>;

        fn with<T: Sample>(self, samples: &[T]) -> Vec<u8> {
            let Self(picture, format, options) = self;
            let outline = Outline { size: picture.size, space: picture.space };
            let mut file = Cursor::new(Vec::new());
            write_in_bands(&outline, format, options, &metadata(), &mut file, |rows, take| {
                let bands: Vec<&[T]> = samples.chunks(3 * picture.size.width * rows).collect();
                bands.iter().enumerate().rev().try_for_each(|(i, band)| take(i, band))
            })
            .unwrap();
            file.into_inner()
        }
    }

    #[test]
    fn bands_in_any_order_give_the_file_of_the_whole_picture() {
        let mut options = Vec::new();
        for subsampling in [ChromaSubsampling::S444, ChromaSubsampling::S422, ChromaSubsampling::S420] {
            options.push((Format::Jpeg, Options { subsampling, ..Options::default() }));
        }
        for compression in [TiffCompression::None, TiffCompression::Deflate] {
            options.push((Format::Tiff, Options { compression, ..Options::default() }));
        }
        options.push((Format::Png, Options::default()));
        for (format, options) in options {
            for &bits in format.bits() {
                for (width, height) in [(1, 1), (130, 95), (130, 96), (130, 97), (61, 1000)] {
                    let picture = picture(width, height, bits, SRGB);
                    let mut whole = Cursor::new(Vec::new());
                    write(&picture, format, &options, &metadata(), &mut whole).unwrap();
                    let banded = FromBelow(&picture, format, &options).with_all(&picture.samples);
                    assert!(*whole.get_ref() == banded, "{format} {options:?} {bits} {width} x {height}");
                    let (size, samples) = decoded(format, &banded);
                    assert_eq!(size, picture.size);
                    assert!(format == Format::Jpeg || samples == picture.samples, "{format} {bits}");
                }
            }
        }
    }

    #[test]
    fn a_band_that_never_came_is_an_error() {
        let outline = Outline { size: Size { width: 20, height: 400 }, space: SRGB };
        let options = Options::default();
        let in_eight_bits = |format: &Format| format.takes_bands() && format.bits().contains(&8);
        for format in Format::ALL.into_iter().filter(in_eight_bits) {
            let mut out = Cursor::new(Vec::new());
            let made: Result<(), Error> =
                write_in_bands::<u8, _>(&outline, format, &options, &metadata(), &mut out, |_, _| Ok(()));
            assert!(matches!(made, Err(Error::Io(_))), "{format}");
        }
    }

    #[test]
    fn a_format_that_needs_the_whole_picture_says_so() {
        let outline = Outline { size: Size { width: 20, height: 400 }, space: SRGB };
        let options = Options::default();
        for format in [Format::Webp, Format::Jxl, Format::Avif] {
            let mut out = Cursor::new(Vec::new());
            let made: Result<(), Error> =
                write_in_bands::<u8, _>(&outline, format, &options, &metadata(), &mut out, |_, _| Ok(()));
            assert!(matches!(made, Err(Error::NotInBands(f)) if f == format));
        }
    }
}
