//! JPEG: baseline, with the profile in APP2 and Exif in APP1.

use std::io::Write;

use darkroot_photo::Metadata;
use darkroot_photo::metadata::Directory;
use jpeg_encoder::{ChromaSubsamplingMethod, ColorType, Encoder, EncodingError, SamplingFactor};

use crate::format::Frame;
use crate::{ChromaSubsampling, Error, Format, Options, exif};

/// Bytes that a segment has for Exif: 65535, less its length (2) and "Exif\0\0" (6).
const EXIF_LIMIT: usize = 65_527;

pub(crate) fn write(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut impl Write,
) -> Result<(), Error> {
    let block = block_that_fits(metadata)?;
    encode(frame, options, &block, out).map_err(|e| Error::encoder(Format::Jpeg)(e.into()))
}

fn encode(
    frame: &Frame<'_>,
    options: &Options,
    block: &[u8],
    out: &mut impl Write,
) -> Result<(), EncodingError> {
    let mut encoder = Encoder::new(out, options.quality);
    encoder.set_sampling_factor(match options.subsampling {
        ChromaSubsampling::S444 => SamplingFactor::R_4_4_4,
        ChromaSubsampling::S422 => SamplingFactor::R_4_2_2,
        ChromaSubsampling::S420 => SamplingFactor::R_4_2_0,
    });
    encoder.set_chroma_subsampling_method(ChromaSubsamplingMethod::Average);
    if !block.is_empty() {
        encoder.add_exif_metadata(block)?;
    }
    encoder.add_icc_profile(&frame.profile())?;
    // Frame::of has seen to it that neither side is over 65535.
    encoder.encode(frame.bytes(), frame.width as u16, frame.height as u16, ColorType::Rgb)
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
