//! JPEG: baseline (ITU-T T.81), with the profile in APP2 and Exif in APP1.
//!
//! Pixels to blocks of lightness and colour (`units.rs`), these to coefficients (`transform.rs`), these to bits
//! (`entropy.rs`); the numbers of the standard stand in `tables.rs`, what precedes the bits is written by `header.rs`.
//! It is our own because it is a quarter of all work when a photograph is developed: see `docs/performance.md`.

mod entropy;
mod header;
mod tables;
mod transform;
mod units;

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

use darkroot_photo::metadata::Directory;
use darkroot_photo::{Metadata, PictureSpace, Size};
use rayon::prelude::*;

use crate::format::{Frame, profile_of};
use crate::{Error, Options, exif};

use header::{END, Header};
use units::{Scan, Subsampling};

/// Bytes that a segment has for Exif: 65535, less its length (2) and "Exif\0\0" (6).
const EXIF_LIMIT: usize = 65_527;

pub(crate) fn write(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut impl Write,
) -> Result<(), Error> {
    let size = Size { width: frame.width as usize, height: frame.height as usize };
    let bands = Bands::of(size, frame.space, options, metadata)?;
    let mut out = InOrder::new(out);
    let parts: Vec<&[u8]> = frame.bytes().chunks(frame.row() * bands.rows).collect();
    let coded: Vec<Vec<u8>> =
        parts.par_iter().enumerate().map(|(band, part)| bands.encode(band, part)).collect();
    for (band, bytes) in coded.into_iter().enumerate() {
        out.put(band, bytes).map_err(Error::Io)?;
    }
    bands.end(out)
}

/// A JPEG in bands, each coded on its own and parted from the next one by a restart marker (ITU-T T.81, E.1.4), where
/// prediction begins anew.
pub(crate) struct Bands {
    header: Vec<u8>,
    size: Size,
    /// Rows of every band but the last.
    pub(crate) rows: usize,
    scan: Scan,
}

/// Rows of a band, unless its units are too many to be counted.
const BAND_ROWS: usize = 96;

impl Bands {
    /// Prepares a picture of a size that [`Format::sides`](crate::Format::sides) has allowed.
    pub(crate) fn of(
        size: Size,
        space: &PictureSpace,
        options: &Options,
        metadata: &Metadata,
    ) -> Result<Self, Error> {
        let subsampling = Subsampling::of(options.subsampling);
        let units = size.width.div_ceil(subsampling.width());
        let high = (BAND_ROWS / subsampling.height()).min(usize::from(u16::MAX) / units).max(1);
        let rows = high * subsampling.height();
        let header = Header {
            size,
            subsampling,
            quality: options.quality,
            restart: if size.height > rows { (units * high) as u16 } else { 0 },
            profile: &profile_of(space),
            exif: &block_that_fits(metadata)?,
        };
        Ok(Self { header: header.bytes(), size, rows, scan: Scan::new(subsampling, options.quality) })
    }

    /// Codes a band and writes it when those before it are written.
    pub(crate) fn take<W: Write>(
        &self,
        band: usize,
        samples: &[u8],
        out: &Mutex<InOrder<W>>,
    ) -> Result<(), Error> {
        let bytes = self.encode(band, samples);
        out.lock().unwrap_or_else(PoisonError::into_inner).put(band, bytes).map_err(Error::Io)
    }

    /// Writes what stands after the last band.
    pub(crate) fn end<W: Write>(&self, out: InOrder<W>) -> Result<(), Error> {
        out.end(self.size.height.div_ceil(self.rows)).map_err(Error::Io)
    }

    /// The bytes of a band: of the first one with the header of all.
    fn encode(&self, band: usize, samples: &[u8]) -> Vec<u8> {
        // A photograph at quality 92 takes a fifth of its samples.
        let mut bytes = Vec::with_capacity(self.header.len() + samples.len() / 4);
        if band == 0 {
            bytes.extend_from_slice(&self.header);
        }
        self.scan.encode(samples, self.size.width, bytes)
    }
}

/// Writes bands in their order, with a restart marker between them; those that come too early wait.
pub(crate) struct InOrder<W> {
    out: W,
    next: usize,
    waiting: BTreeMap<usize, Vec<u8>>,
}

impl<W: Write> InOrder<W> {
    pub(crate) fn new(out: W) -> Self {
        Self { out, next: 0, waiting: BTreeMap::new() }
    }

    fn put(&mut self, band: usize, bytes: Vec<u8>) -> io::Result<()> {
        self.waiting.insert(band, bytes);
        while let Some(bytes) = self.waiting.remove(&self.next) {
            if self.next > 0 {
                // RST0 to RST7 in turn.
                self.out.write_all(&[0xff, 0xd0 + ((self.next - 1) % 8) as u8])?;
            }
            self.out.write_all(&bytes)?;
            self.next += 1;
        }
        Ok(())
    }

    fn end(mut self, bands: usize) -> io::Result<()> {
        if self.next != bands {
            return Err(io::Error::other(format!("{} of {bands} bands came", self.next)));
        }
        self.out.write_all(&END)
    }
}

/// The Exif block, without the maker note if it has no room for that.
fn block_that_fits(metadata: &Metadata) -> Result<Vec<u8>, Error> {
    let block = exif::block(metadata);
    if block.len() <= EXIF_LIMIT {
        return Ok(block);
    }
    let mut rest = Metadata::default();
    for field in metadata.fields() {
        if (field.directory, field.tag) != (Directory::Exif, exif::MAKER_NOTE) {
            rest.set(field.directory, field.tag, field.value.clone());
        }
    }
    let block = exif::block(&rest);
    match block.len() {
        0..=EXIF_LIMIT => Ok(block),
        bytes => Err(Error::ExifTooLarge { bytes, limit: EXIF_LIMIT }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{SIZES, decoded, metadata, picture};
    use crate::{ChromaSubsampling, Format};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::metadata::Value;
    use darkroot_photo::{Picture, PictureSpace, Samples};

    fn file(picture: &Picture, options: &Options, metadata: &Metadata) -> Vec<u8> {
        let mut file = std::io::Cursor::new(Vec::new());
        crate::write(picture, Format::Jpeg, options, metadata, &mut file).unwrap();
        file.into_inner()
    }

    fn srgb(width: usize, height: usize) -> Picture {
        picture(width, height, 8, PictureSpace::Rgb(RgbSpace::SRGB))
    }

    #[test]
    fn the_samples_come_back_nearly() {
        for subsampling in [ChromaSubsampling::S444, ChromaSubsampling::S422, ChromaSubsampling::S420] {
            for (width, height) in SIZES {
                let picture = srgb(width, height);
                let options = Options { subsampling, quality: 97, ..Options::default() };
                let (size, samples) = decoded(Format::Jpeg, &file(&picture, &options, &Metadata::default()));
                assert_eq!(size, picture.size);
                let (Samples::U8(there), Samples::U8(back)) = (&picture.samples, &samples) else { panic!() };
                let off: u32 = there.iter().zip(back).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
                let mean = f64::from(off) / there.len() as f64;
                // Few pixels have many hues; there subsampling shows.
                let limit = if subsampling == ChromaSubsampling::S444 || width > 250 { 2.5 } else { 40.0 };
                assert!(mean < limit, "{subsampling:?} {width} x {height}: {mean}");
            }
        }
    }

    #[test]
    fn a_lower_quality_and_fewer_colours_make_a_smaller_file() {
        let length = |quality, subsampling| {
            let options = Options { quality, subsampling, ..Options::default() };
            file(&srgb(300, 200), &options, &Metadata::default()).len()
        };
        assert!(length(50, ChromaSubsampling::S444) < length(92, ChromaSubsampling::S444));
        assert!(length(92, ChromaSubsampling::S420) < length(92, ChromaSubsampling::S422));
        assert!(length(92, ChromaSubsampling::S422) < length(92, ChromaSubsampling::S444));
    }

    /// The same picture by a library that was written by others.
    fn file_of_others(picture: &Picture, options: &Options) -> Vec<u8> {
        use jpeg_encoder::{ChromaSubsamplingMethod, ColorType, Encoder, SamplingFactor};
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, options.quality);
        encoder.set_sampling_factor(match options.subsampling {
            ChromaSubsampling::S444 => SamplingFactor::R_4_4_4,
            ChromaSubsampling::S422 => SamplingFactor::R_4_2_2,
            ChromaSubsampling::S420 => SamplingFactor::R_4_2_0,
        });
        encoder.set_chroma_subsampling_method(ChromaSubsamplingMethod::Average);
        let Samples::U8(samples) = &picture.samples else { panic!() };
        let (width, height) = (picture.size.width as u16, picture.size.height as u16);
        encoder.encode(samples, width, height, ColorType::Rgb).unwrap();
        file
    }

    #[test]
    fn the_picture_is_as_good_and_the_file_as_small_as_those_of_another_encoder() {
        let picture = srgb(500, 400);
        let squares = |file: &[u8]| {
            let (Samples::U8(there), Samples::U8(back)) = (&picture.samples, &decoded(Format::Jpeg, file).1)
            else {
                panic!()
            };
            there.iter().zip(back).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>()
        };
        for subsampling in [ChromaSubsampling::S444, ChromaSubsampling::S422, ChromaSubsampling::S420] {
            for quality in [1, 30, 92, 100] {
                let options = Options { quality, subsampling, ..Options::default() };
                let theirs = file_of_others(&picture, &options);
                let ours = file(&picture, &options, &Metadata::default());
                // The profile and the restart markers come on top.
                let length = ours.len() as f64 - crate::icc::profile(&RgbSpace::SRGB).len() as f64;
                let (larger, worse) = (length / theirs.len() as f64, squares(&ours) / squares(&theirs));
                assert!(larger < 1.01 && worse < 1.01, "{subsampling:?} {quality}: {larger} {worse}");
            }
        }
    }

    #[test]
    fn a_maker_note_that_has_no_room_is_left_out() {
        let mut large = metadata();
        large.set(Directory::Exif, exif::MAKER_NOTE, Value::Undefined(vec![7; 70_000]));
        let picture = srgb(2, 2);
        assert_eq!(
            file(&picture, &Options::default(), &large),
            file(&picture, &Options::default(), &metadata())
        );
    }

    #[test]
    fn other_fields_that_have_no_room_are_refused() {
        let mut large = metadata();
        large.set(Directory::Exif, 0x9286, Value::Undefined(vec![7; 70_000]));
        let mut out = std::io::Cursor::new(Vec::new());
        let refused = crate::write(&srgb(2, 2), Format::Jpeg, &Options::default(), &large, &mut out);
        assert!(matches!(refused, Err(Error::ExifTooLarge { limit: 65_527, .. })));
    }
}
