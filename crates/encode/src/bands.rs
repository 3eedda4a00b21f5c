//! Pictures that are written while they are made: nowhere is the whole picture in memory.

use std::io::{Seek, Write};
use std::sync::{Mutex, PoisonError};

use darkroot_photo::{Metadata, PictureSpace, Size};

use crate::jpeg::{Bands, InOrder};
use crate::{Error, Format, Options, exif, output};

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
pub type TakeBand<'a> = dyn Fn(usize, &[u8]) -> Result<(), Error> + Sync + 'a;

/// Writes a picture of 8 bits as a JPEG while `make` makes it: that gets the rows of a band (the last one has what is
/// left) and what takes the bands. The file is, byte for byte, what [`write`](crate::write()) makes of the whole picture.
///
/// # Errors
/// As [`write`](crate::write()), and those of `make`.
pub fn write_in_bands<W: Write + Seek + Send, E: From<Error>>(
    outline: &Outline,
    options: &Options,
    metadata: &Metadata,
    out: &mut W,
    make: impl FnOnce(usize, &TakeBand<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let Outline { size, space } = outline;
    Format::Jpeg.accepts(space)?;
    options.check()?;
    Format::Jpeg.sides(*size, 8)?;
    let metadata = exif::of_picture(metadata, *size, space);
    let bands = Bands::of(*size, space, options, &metadata)?;
    output::buffered(out, |out| {
        let out = Mutex::new(InOrder::new(out));
        make(bands.rows, &|band, samples| bands.take(band, samples, &out))?;
        Ok(bands.end(out.into_inner().unwrap_or_else(PoisonError::into_inner))?)
    })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::testing::{decoded, metadata, picture};
    use crate::{ChromaSubsampling, write};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::Samples;

    #[test]
    fn bands_in_any_order_give_the_file_of_the_whole_picture() {
        for subsampling in [ChromaSubsampling::S444, ChromaSubsampling::S422, ChromaSubsampling::S420] {
            for (width, height) in [(1, 1), (130, 95), (130, 96), (130, 97), (61, 1000)] {
                let picture = picture(width, height, 8, PictureSpace::Rgb(RgbSpace::SRGB));
                let options = Options { subsampling, ..Options::default() };
                let mut whole = Cursor::new(Vec::new());
                write(&picture, Format::Jpeg, &options, &metadata(), &mut whole).unwrap();
                let Samples::U8(samples) = &picture.samples else { panic!() };
                let outline = Outline { size: picture.size, space: picture.space };
                let mut banded = Cursor::new(Vec::new());
                write_in_bands(&outline, &options, &metadata(), &mut banded, |rows, take| {
                    let bands: Vec<&[u8]> = samples.chunks(3 * width * rows).collect();
                    // The last one first.
                    bands.iter().enumerate().rev().try_for_each(|(i, band)| take(i, band))
                })
                .unwrap();
                assert!(whole.get_ref() == banded.get_ref(), "{subsampling:?} {width} x {height}");
                assert_eq!(decoded(Format::Jpeg, banded.get_ref()).0, picture.size);
            }
        }
    }

    #[test]
    fn a_band_that_never_came_is_an_error() {
        let outline =
            Outline { size: Size { width: 20, height: 400 }, space: PictureSpace::Rgb(RgbSpace::SRGB) };
        let mut out = Cursor::new(Vec::new());
        let options = Options::default();
        let made: Result<(), Error> =
            write_in_bands(&outline, &options, &metadata(), &mut out, |_, _| Ok(()));
        assert!(matches!(made, Err(Error::Io(_))));
    }
}
