//! A finished picture to the bytes of a file, with ICC profile and Exif.
//!
//! | format | bits | colour spaces | compression |
//! |---|---|---|---|
//! | JPEG | 8 | any with an ICC profile | lossy |
//! | PNG | 8, 16 | any with an ICC profile | lossless |
//! | TIFF | 8, 16, 32 (float) | any, also camera RGB | none or deflate |
//! | WebP | 8 | any with an ICC profile | lossless or lossy |
//! | AVIF | 8 (stored as 10) | any, by numbers or ICC profile | lossy |
//! | DNG | 16 | camera RGB for raw developers | lossless |
//! | OpenEXR | 32 (float) | linear ones, also camera RGB | PIZ, lossless |
//! | JPEG XL | 8, 16 | all but those with a ROMM or L\* curve | lossless |
//!
//! ```
//! use darkroot_encode::{Format, Options};
//! use darkroot_photo::{Metadata, Picture, PictureSpace, Samples, Size};
//!
//! let picture = Picture {
//!     size: Size { width: 2, height: 1 },
//!     samples: Samples::U8(vec![255, 0, 0, 0, 0, 255]),
//!     space: PictureSpace::Rgb(darkroot_colour::RgbSpace::SRGB),
//! };
//! let mut file = std::io::Cursor::new(Vec::new());
//! darkroot_encode::write(&picture, Format::Png, &Options::default(), &Metadata::default(), &mut file)?;
//! assert!(file.into_inner().starts_with(b"\x89PNG"));
//! # Ok::<(), darkroot_encode::Error>(())
//! ```
//!
//! The same picture, options and metadata give the same bytes: nothing here looks at the clock, at the
//! environment or at the number of processors.
//!
//! [`SourceProfile`] goes the other way: what the numbers of a finished picture mean, by the ICC profile in it.
//!
//! **What it does not do:** it opens no file, changes no number of the picture that it writes, and converts between neither
//! colour spaces nor sample types; `develop` makes the picture as the file wants it.

use darkroot_photo::{Metadata, Picture};
use rayon::prelude::*;

use sample::ForSamples;

pub mod format;
pub use format::Format;

pub mod options;
pub use options::{ChromaSubsampling, Options, TiffCompression, WebpKind};

pub mod error;
pub use error::Error;

pub mod bands;
pub use bands::{Outline, write_in_bands};

pub mod sample;
pub use sample::Sample;

pub use output::Out;

pub mod dng;
pub use dng::Dng;

pub mod bits;
pub mod exif;
pub mod icc;
pub mod iptc;
pub mod ljpeg;

pub mod tiff_field;

pub mod source_profile;
pub use source_profile::{ProfileFault, SourceProfile};

mod avif;
mod exr;
mod jpeg;
pub use jpeg::gain_map::{self, GainMap};
mod jxl;
mod output;
mod png;
mod tiff;
mod tiff_entries;
mod webp;

#[cfg(test)]
mod testing;

/// Writes `picture` as a file of `format` to `out`.
///
/// `out` must stand at its beginning, and is flushed at the end; it need not be buffered. With any field in
/// `metadata` the file says, besides those fields, that the picture is upright (orientation 1), its size in
/// pixels and whether it is in sRGB; with none the file has no Exif.
///
/// # Errors
///
/// [`Error::Io`] when `out` cannot take the bytes: what was written till then is no picture. Everything else is
/// found before the first byte is written, except [`Error::Encoder`].
pub fn write(
    picture: &Picture,
    format: Format,
    options: &Options,
    metadata: &Metadata,
    out: &mut dyn Out,
) -> Result<(), Error> {
    format.accepts(&picture.space)?;
    options.check()?;
    let frame = format::Frame::of(picture, format, options)?;
    let about = exif::of_picture(metadata, picture.size, &picture.space, format);
    match format {
        Format::Jpeg | Format::Png | Format::Tiff | Format::Dng => {
            InBands { picture, format, options, metadata, out }.with_all(&picture.samples)
        }
        Format::Webp => output::buffered(out, |out| webp::write(&frame, options, &about, out)),
        Format::Avif => output::buffered(out, |out| avif::write(&frame, options, &about, out)),
        Format::Exr => output::buffered(out, |out| exr::write(&frame, &about, out)),
        Format::Jxl => output::buffered(out, |out| jxl::write(&frame, &about, out)),
    }
}

/// Bands of a whole picture, coded by all threads.
struct InBands<'a> {
    picture: &'a Picture,
    format: Format,
    options: &'a Options,
    metadata: &'a Metadata,
    out: &'a mut dyn Out,
}

impl ForSamples for InBands<'_> {
    type Made = Result<(), Error>;

    fn with<T: Sample>(self, samples: &[T]) -> Result<(), Error> {
        let Self { picture, format, options, metadata, out } = self;
        let outline = Outline { size: picture.size, space: picture.space };
        write_in_bands(&outline, format, options, metadata, out, |rows, take| {
            let bands = samples.par_chunks(3 * picture.size.width * rows).enumerate();
            bands.try_for_each(|(band, samples)| take(band, samples))
        })
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, Cursor, Seek, SeekFrom, Write};

    use super::{Error, Format, Options, icc, write};
    use crate::testing::{SIZES, encoded, metadata, picture, picture_for};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::{Metadata, PictureSpace};
    use image::ImageDecoder;

    #[test]
    fn a_picture_of_any_size_can_be_written_in_every_format() {
        for format in Format::ALL {
            for (width, height) in SIZES {
                let file = encoded(&picture_for(format, width, height), format, &metadata());
                assert!(file.is_ok_and(|file| !file.is_empty()), "{format} {width} x {height}");
            }
        }
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        for format in Format::ALL {
            let picture = picture_for(format, 300, 270);
            let first = encoded(&picture, format, &metadata()).unwrap();
            assert!(first == encoded(&picture, format, &metadata()).unwrap(), "{format}");
        }
    }

    /// ICC profile and Exif block as the reader of the format finds them.
    fn found(format: Format, file: &[u8]) -> (Option<Vec<u8>>, Option<Vec<u8>>) {
        fn both(mut reader: impl ImageDecoder) -> (Option<Vec<u8>>, Option<Vec<u8>>) {
            (reader.icc_profile().unwrap(), reader.exif_metadata().unwrap())
        }
        use image::codecs::{jpeg::JpegDecoder, png::PngDecoder, webp::WebPDecoder};
        let file = Cursor::new(file);
        match format {
            Format::Jpeg => both(JpegDecoder::new(file).unwrap()),
            Format::Png => both(PngDecoder::new(file).unwrap()),
            Format::Webp => both(WebPDecoder::new(file).unwrap()),
            Format::Tiff => {
                let mut reader = tiff::decoder::Decoder::new(file.clone()).unwrap();
                let profile = reader.get_tag_u8_vec(tiff::tags::Tag::IccProfile).unwrap();
                (Some(profile), Some(file.into_inner().to_vec())) // TIFF is its own Exif block.
            }
            Format::Jxl => {
                let image = jxl_oxide::JxlImage::builder().read(file).unwrap();
                let exif = image.aux_boxes().first_exif().unwrap();
                (None, exif.has_data().then(|| exif.unwrap().payload().to_vec()))
            }
            Format::Avif => {
                let file = file.into_inner();
                let block = {
                    let picture = picture_for(format, 40, 30);
                    let metadata = crate::exif::of_picture(&metadata(), picture.size, &picture.space, format);
                    crate::exif::block(&metadata)
                };
                (None, file.windows(block.len()).find(|w| *w == block).map(<[u8]>::to_vec))
            }
            Format::Dng => (None, Some(file.into_inner().to_vec())),
            Format::Exr => (None, None),
        }
    }

    #[test]
    fn the_profile_comes_back_from_each_format_that_has_a_place_for_it() {
        for space in [RgbSpace::SRGB, RgbSpace::PROPHOTO, RgbSpace::REC2020.linear()] {
            for format in [Format::Jpeg, Format::Png, Format::Tiff, Format::Webp] {
                let picture = picture(40, 30, 8, PictureSpace::Rgb(space));
                let file = encoded(&picture, format, &metadata()).unwrap();
                assert_eq!(found(format, &file).0, Some(icc::profile(&space)), "{format}");
            }
        }
    }

    #[test]
    fn exif_comes_back_upright_from_each_format_that_has_a_place_for_it() {
        use exif::{In, Reader, Tag};
        for format in Format::ALL.into_iter().filter(|format| *format != Format::Exr) {
            let file = encoded(&picture_for(format, 40, 30), format, &metadata()).unwrap();
            let block = found(format, &file).1.unwrap();
            let exif = Reader::new().read_raw(block).unwrap();
            let number = |tag| exif.get_field(tag, In::PRIMARY).unwrap().value.get_uint(0);
            assert_eq!(number(Tag::Orientation), Some(1), "{format}");
            assert_eq!(number(Tag::PhotographicSensitivity), Some(400), "{format}");
            let latitude = exif.get_field(Tag::GPSLatitude, In::PRIMARY).unwrap();
            assert_eq!(latitude.display_value().to_string(), "52 deg 31 min 12 sec", "{format}");
            let artist = &exif.get_field(Tag::Artist, In::PRIMARY).unwrap().value;
            assert!(matches!(artist, exif::Value::Ascii(v) if v[0] == "Zoë Müller".as_bytes()), "{format}");
        }
    }

    #[test]
    fn without_fields_there_is_no_exif() {
        for format in [Format::Jpeg, Format::Png, Format::Webp, Format::Jxl] {
            let file = encoded(&picture_for(format, 4, 3), format, &Metadata::default()).unwrap();
            assert_eq!(found(format, &file).1, None, "{format}");
        }
    }

    /// A disk with room for so many bytes.
    struct Disk {
        file: Cursor<Vec<u8>>,
        room: u64,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            match self.file.position() + bytes.len() as u64 > self.room {
                true => Err(io::ErrorKind::StorageFull.into()),
                false => self.file.write(bytes),
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Disk {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.file.seek(to)
        }
    }

    #[test]
    fn a_full_disk_is_known_as_such() {
        for format in Format::ALL {
            // Large enough for the file not to fit in the buffer before the disk.
            let picture = picture_for(format, 600, 500);
            for room in [0, 10, 1000] {
                let mut disk = Disk { file: Cursor::new(Vec::new()), room };
                let failed = write(&picture, format, &Options::default(), &metadata(), &mut disk);
                match failed {
                    Err(Error::Io(error)) => assert_eq!(error.kind(), io::ErrorKind::StorageFull),
                    other => panic!("{format}: {other:?}"),
                }
            }
        }
    }
}
