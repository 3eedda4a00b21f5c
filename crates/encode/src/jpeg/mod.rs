//! JPEG: baseline (ITU-T T.81), with the profile in APP2 and Exif in APP1.
//!
//! Pixels to blocks of lightness and colour (`units.rs`), these to coefficients (`transform.rs`), these to bits
//! (`entropy.rs`); the numbers of the standard stand in `tables.rs`, what precedes the bits is written by `header.rs`.
//! It is our own because it is a quarter of all work when a photograph is developed: see `docs/performance.md`.

mod entropy;
pub mod gain_map;
mod header;
mod progressive;
mod tables;
mod thumbnail;
mod transform;
mod units;

use std::io::{Seek, Write};

use darkroot_photo::Metadata;
use darkroot_photo::metadata::Directory;

use crate::bands::{self, MakeBands, Outline, Sink};
use crate::format::profile_of;
use crate::output::Buffered;
use crate::{Error, Options, Sample, exif};

use header::{END, Header};
use thumbnail::Thumbnail;
use units::{Scan, Subsampling};

/// Bytes that a segment has for Exif: 65535, less its length (2) and "Exif\0\0" (6).
const EXIF_LIMIT: usize = 65_527;

/// Rows of a band, unless its units are too many to be counted.
const BAND_ROWS: usize = 192;

/// Writes a picture of a size that [`Format::sides`](crate::Format::sides) has allowed. Bands are parted by restart markers
/// (ITU-T T.81, E.1.4), where prediction begins anew.
pub(crate) fn write<T: Sample>(
    outline: &Outline,
    options: &Options,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
    make: &mut MakeBands<'_, T>,
) -> Result<(), Error> {
    let Outline { size, space } = outline;
    let subsampling = Subsampling::of(options.subsampling);
    let units = size.width.div_ceil(subsampling.width());
    let high = (BAND_ROWS / subsampling.height()).min(usize::from(u16::MAX) / units).max(1);
    let rows = high * subsampling.height();
    let second = options.gain_map.as_ref().map(|map| gain_map::file(map)).transpose()?;
    let xmp = exif::xmp(metadata);
    let naming = second.as_ref().map(|second| gain_map::naming(xmp, second.len()));
    let block = block_that_fits(metadata)?;
    let mut thumbnail = Thumbnail::of(*size, space).filter(|_| options.thumbnail && !block.is_empty());
    let with_place = thumbnail.as_ref().map(|_| exif::with_thumbnail(metadata, Some(&Thumbnail::place())));
    if with_place.as_ref().is_some_and(|block| block.len() > EXIF_LIMIT) {
        thumbnail = None;
    }
    let header = Header {
        size: *size,
        subsampling,
        quality: options.quality,
        restart: if size.height > rows { (units * high) as u16 } else { 0 },
        profile: &profile_of(space),
        exif: with_place.as_ref().filter(|_| thumbnail.is_some()).unwrap_or(&block),
        xmp: naming.as_deref().unwrap_or(xmp),
        more: if second.is_some() { &gain_map::segments() } else { &[] },
        iptc: exif::iptc(metadata),
    };
    let seen = |band: usize, samples: &[u8]| {
        if let Some(thumbnail) = &thumbnail {
            thumbnail.add(band * rows, size.width, samples);
        }
    };
    // Where nothing is filled in later, the output need not know where it is.
    let is_filled = thumbnail.is_some() || second.is_some();
    let start = if is_filled { out.stream_position().map_err(Error::Io)? } else { 0 };
    let begin = if options.progressive { header.about() } else { header.bytes() };
    out.write_all(&begin).map_err(Error::Io)?;
    if options.progressive {
        let whole = Vec::with_capacity(3 * size.area());
        let keep = |band, samples: &[T]| {
            let samples = bytemuck::cast_slice::<T, u8>(samples);
            seen(band, samples);
            Ok(samples.to_vec())
        };
        let whole = bands::code(*size, rows, Whole(whole), keep, make)?;
        let scans = progressive::scans(*size, &whole.0, options)?;
        out.write_all(&scans).map_err(Error::Io)?;
    } else {
        let scan = Scan::new(subsampling, options.quality);
        let code = |band, samples: &[T]| {
            let samples = bytemuck::cast_slice(samples);
            seen(band, samples);
            Ok(scan.encode(samples, size.width))
        };
        bands::code(*size, rows, RestartMarkers { out: &mut *out, next: None }, code, make)?;
        out.write_all(&END).map_err(Error::Io)?;
    }
    if let Some(thumbnail) = thumbnail {
        thumbnail.fill(&begin, start, out)?;
    }
    second.map_or(Ok(()), |second| gain_map::settle(&begin, start, &second, out))
}

/// All samples.
struct Whole(Vec<u8>);

impl Sink for Whole {
    type Coded = Vec<u8>;

    fn put(&mut self, band: Vec<u8>) -> Result<(), Error> {
        self.0.extend(band);
        Ok(())
    }
}

/// Bands with a restart marker between two.
struct RestartMarkers<'a, W> {
    out: &'a mut W,
    /// Number of the marker before the next band.
    next: Option<u8>,
}

impl<W: Write + Send> Sink for RestartMarkers<'_, W> {
    type Coded = Vec<u8>;

    fn put(&mut self, coded: Vec<u8>) -> Result<(), Error> {
        if let Some(number) = self.next {
            // RST0 to RST7 in turn.
            self.out.write_all(&[0xff, 0xd0 + number]).map_err(Error::Io)?;
        }
        self.next = Some(self.next.map_or(0, |number| (number + 1) % 8));
        self.out.write_all(&coded).map_err(Error::Io)
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
        use jpeg_encoder::{ChromaSubsamplingMethod, ColorType, Encoder};
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, options.quality);
        encoder.set_sampling_factor(progressive::sampling(options.subsampling));
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
    fn a_progressive_file_is_the_same_picture_and_smaller() {
        for subsampling in [ChromaSubsampling::S444, ChromaSubsampling::S422, ChromaSubsampling::S420] {
            let picture = srgb(500, 400);
            let options = |progressive| Options { subsampling, progressive, ..Options::default() };
            let [baseline, progressive] =
                [false, true].map(|progressive| file(&picture, &options(progressive), &metadata()));
            assert!(progressive.len() < baseline.len(), "{subsampling:?}");
            // SOF2 in place of SOF0.
            assert!(progressive.windows(4).any(|w| w == [0xff, 0xc2, 0, 17]));
            assert!(!progressive.windows(4).any(|w| w == [0xff, 0xc0, 0, 17]));
            let Samples::U8(there) = &picture.samples else { panic!() };
            let [one, other] = [&baseline, &progressive].map(|file| {
                let (_, Samples::U8(back)) = decoded(Format::Jpeg, file) else { panic!() };
                there.iter().zip(&back).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>()
            });
            assert!(other < 1.02 * one, "{subsampling:?}: {one} {other}");
            // What the file says of the picture is the same.
            let tables = baseline.windows(2).position(|w| w == [0xff, 0xdb]).unwrap();
            assert!(progressive.starts_with(&baseline[..tables]));
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
