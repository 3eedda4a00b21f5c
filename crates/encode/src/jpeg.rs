//! JPEG: baseline, with the profile in APP2 and Exif in APP1.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

use darkroot_photo::metadata::Directory;
use darkroot_photo::{Metadata, PictureSpace, Size};
use jpeg_encoder::{ChromaSubsamplingMethod, ColorType, Encoder, EncodingError, SamplingFactor};
use rayon::prelude::*;

use crate::format::{Frame, profile_of};
use crate::{ChromaSubsampling, Error, Format, Options, exif};

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
    let files = parts.par_iter().enumerate().map(|(band, part)| bands.encode(band, part));
    for (band, bytes) in files.collect::<Result<Vec<_>, Error>>()?.into_iter().enumerate() {
        out.put(band, bytes).map_err(Error::Io)?;
    }
    bands.end(out)
}

/// A JPEG in bands, each encoded on its own and parted from the next one by a restart marker (ITU-T T.81, E.1.4), where
/// prediction begins anew. Each of them is made as a small JPEG of its own, of which only the first keeps its header.
pub(crate) struct Bands<'a> {
    options: &'a Options,
    width: u16,
    height: u16,
    /// Rows of every band but the last.
    pub(crate) rows: usize,
    /// Units of the scan in a band; 0 where there is one band only.
    restart: u16,
    profile: Vec<u8>,
    exif: Vec<u8>,
}

/// Rows of a band, unless its units are too many to be counted.
const BAND_ROWS: usize = 96;

impl<'a> Bands<'a> {
    /// Prepares a picture of a size that [`Format::sides`] has allowed.
    pub(crate) fn of(
        size: Size,
        space: &PictureSpace,
        options: &'a Options,
        metadata: &Metadata,
    ) -> Result<Self, Error> {
        let (unit_width, unit_height) = match options.subsampling {
            ChromaSubsampling::S444 => (8, 8),
            ChromaSubsampling::S422 => (16, 8),
            ChromaSubsampling::S420 => (16, 16),
        };
        let units = size.width.div_ceil(unit_width);
        let high = (BAND_ROWS / unit_height).min(usize::from(u16::MAX) / units).max(1);
        let rows = high * unit_height;
        Ok(Self {
            options,
            width: size.width as u16,
            height: size.height as u16,
            rows,
            restart: if size.height > rows { (units * high) as u16 } else { 0 },
            profile: profile_of(space),
            exif: block_that_fits(metadata)?,
        })
    }

    /// Encodes a band and writes it when those before it are written.
    pub(crate) fn take<W: Write>(
        &self,
        band: usize,
        samples: &[u8],
        out: &Mutex<InOrder<W>>,
    ) -> Result<(), Error> {
        let bytes = self.encode(band, samples)?;
        out.lock().unwrap_or_else(PoisonError::into_inner).put(band, bytes).map_err(Error::Io)
    }

    /// Writes what stands after the last band.
    pub(crate) fn end<W: Write>(&self, out: InOrder<W>) -> Result<(), Error> {
        out.end(usize::from(self.height).div_ceil(self.rows)).map_err(Error::Io)
    }

    /// The bytes of a band: of the first one with the header of all.
    fn encode(&self, band: usize, samples: &[u8]) -> Result<Vec<u8>, Error> {
        self.encode_alone(band, samples).map_err(|e| Error::encoder(Format::Jpeg)(e.into()))
    }

    fn encode_alone(&self, band: usize, samples: &[u8]) -> Result<Vec<u8>, EncodingError> {
        let mut file = Vec::with_capacity(samples.len() / 4);
        let mut encoder = Encoder::new(&mut file, self.options.quality);
        encoder.set_sampling_factor(match self.options.subsampling {
            ChromaSubsampling::S444 => SamplingFactor::R_4_4_4,
            ChromaSubsampling::S422 => SamplingFactor::R_4_2_2,
            ChromaSubsampling::S420 => SamplingFactor::R_4_2_0,
        });
        encoder.set_chroma_subsampling_method(ChromaSubsamplingMethod::Average);
        encoder.set_restart_interval(self.restart);
        if band == 0 {
            if !self.exif.is_empty() {
                encoder.add_exif_metadata(&self.exif)?;
            }
            encoder.add_icc_profile(&self.profile)?;
        }
        let height = (samples.len() / (3 * usize::from(self.width))) as u16;
        encoder.encode(samples, self.width, height, ColorType::Rgb)?;
        let header = Header::of(&file);
        if band > 0 {
            file.drain(..header.end);
        } else if let Some(at) = header.height {
            file[at..at + 2].copy_from_slice(&self.height.to_be_bytes());
        }
        file.truncate(file.len() - END.len());
        Ok(file)
    }
}

const END: [u8; 2] = [0xff, 0xd9];

/// What stands before the scan of a JPEG.
struct Header {
    /// Where the picture's height stands.
    height: Option<usize>,
    /// Where the scan begins.
    end: usize,
}

impl Header {
    /// Walks from marker to marker (ITU-T T.81, B.1.1) of a file that the encoder made.
    fn of(file: &[u8]) -> Self {
        const FRAME: u8 = 0xc0;
        const SCAN: u8 = 0xda;
        let mut height = None;
        let mut at = 2;
        while let [0xff, marker, high, low, ..] = file[at.min(file.len())..] {
            if marker == FRAME {
                // After marker, length and precision.
                height = Some(at + 5);
            }
            at += 2 + usize::from(u16::from_be_bytes([high, low]));
            if marker == SCAN {
                break;
            }
        }
        Self { height, end: at.min(file.len()) }
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
                let limit = if subsampling == ChromaSubsampling::S444 || width > 250 { 2.0 } else { 40.0 };
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
