//! AVIF: 10 bits with full colour resolution, in every space, with Exif and XMP.
//!
//! ravif codes the picture; the file around it is ours (`boxes.rs`), because ravif's has no place for an ICC profile or XMP. What
//! R, G and B mean stands there: sRGB, Display P3 and Rec. 2020 by their numbers, all others by an ICC profile.

mod boxes;
mod hdr;

use std::io::Write;

use darkroot_colour::RgbSpace;
use darkroot_photo::{Metadata, PictureSpace, Samples};
use ravif::{BitDepth, Encoder, Img, MatrixCoefficients, PixelRange, RGBA8};

use boxes::{Coded, Parts};

use crate::format::{Frame, same_colours};
use crate::output::Buffered;
use crate::{Error, Format, Options, exif};

/// Number of threads, and of tiles that the picture is cut into. It is fixed, as the bytes depend on it.
const TILES: usize = 4;

pub(crate) fn write(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
) -> Result<(), Error> {
    let encoder = Encoder::new()
        .with_quality(f32::from(options.quality))
        .with_speed(options.avif_speed)
        .with_bit_depth(BitDepth::Ten)
        .with_num_threads(Some(TILES));
    let (width, height) = (frame.width as usize, frame.height as usize);
    let failed = Error::encoder(Format::Avif);
    let (encoded, matrix, named) = match (frame.samples, options.peak) {
        (Samples::F32(samples), Some(peak)) => {
            let planes = hdr::planes(samples, peak);
            let (range, matrix) = (PixelRange::Full, MatrixCoefficients::BT2020NCL);
            let opacity = None::<[u16; 0]>;
            let encoded = encoder.encode_raw_planes_10_bit(width, height, planes, opacity, range, matrix);
            (encoded, hdr::MATRIX, Some(hdr::NAMED))
        }
        _ => {
            // With opacity, which is dropped again: `encode_rgb` is compiled anew, with all of the encoder, in every crate that
            // calls it, which takes minutes.
            let pixels: Vec<RGBA8> =
                frame.bytes().chunks_exact(3).map(|p| RGBA8::new(p[0], p[1], p[2], 255)).collect();
            (encoder.encode_rgba(Img::new(&pixels[..], width, height)), MATRIX, named(frame.space))
        }
    };
    let encoded = encoded.map_err(|e| failed(e.into()))?;
    let coded = Coded::of_file(&encoded.avif_file)
        .ok_or_else(|| Error::encoder(Format::Avif)("its file has no picture".into()))?;
    let parts = Parts {
        width: frame.width,
        height: frame.height,
        coded: &coded,
        bits: BITS,
        named: named.unwrap_or([UNSPECIFIED; 2]),
        matrix,
        profile: &if named.is_some() { Vec::new() } else { frame.profile() },
        exif: &exif::block(metadata),
        xmp: exif::xmp(metadata),
    };
    out.write_all(&parts.file()).map_err(Error::Io)
}

/// The matrix of ITU-R BT.601, by which ravif codes colours.
const MATRIX: u16 = 6;
/// Bits of the coded picture.
const BITS: u8 = 10;
/// In ITU-T H.273: somebody else says it.
const UNSPECIFIED: u16 = 2;

/// Numbers of primaries and curve in ITU-T H.273; `None` where there are none.
fn named(space: &PictureSpace) -> Option<[u16; 2]> {
    let PictureSpace::Rgb(space) = space else { return None };
    // IEC 61966-2-1; of Rec. 2020, the curve for 10 bits.
    let known = [(RgbSpace::SRGB, [1, 13]), (RgbSpace::DISPLAY_P3, [12, 13]), (RgbSpace::REC2020, [9, 14])];
    known.into_iter().find(|(known, _)| same_colours(known, space)).map(|(_, numbers)| numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{SIZES, encoded, metadata, picture, picture_for};
    use darkroot_photo::metadata::{Directory, Value, tag};

    #[test]
    fn the_file_names_its_kind_and_size() {
        for (width, height) in SIZES {
            let file = encoded(&picture_for(Format::Avif, width, height), Format::Avif, &Metadata::default());
            let file = file.unwrap();
            assert_eq!(&file[4..12], b"ftypavif");
            let at = file.windows(4).position(|w| w == b"ispe").unwrap() + 8;
            let side = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
            assert_eq!((side(at), side(at + 4)), (width, height));
        }
    }

    #[test]
    fn every_space_is_named_or_has_its_profile_and_the_metadata_come_back() {
        let spaces = [RgbSpace::SRGB, RgbSpace::DISPLAY_P3, RgbSpace::ADOBE_RGB, RgbSpace::PROPHOTO];
        for space in spaces.into_iter().chain([RgbSpace::REC2020, RgbSpace::ECIRGB_V2]) {
            let picture = picture(40, 30, 8, PictureSpace::Rgb(space));
            let mut metadata = metadata();
            metadata.set(Directory::Image, tag::XMP, Value::Bytes(b"<x:xmpmeta/>".to_vec()));
            let file = encoded(&picture, Format::Avif, &metadata).unwrap();
            let has = |part: &[u8]| file.windows(part.len()).any(|w| w == part);
            let profile = crate::icc::profile(&space);
            assert_eq!(has(&profile), named(&picture.space).is_none(), "{}", space.name);
            assert!(has(b"nclx") && has(b"<x:xmpmeta/>") && has(b"application/rdf+xml"));
            let about = exif::of_picture(&metadata, picture.size, &picture.space, Format::Avif);
            assert!(has(&exif::block(&about)));
            // The picture lies where the file says.
            let at = file.windows(4).position(|w| w == b"iloc").unwrap() + 4 + 8 + 6;
            let number = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
            let (place, length) = (number(at), number(at + 4));
            let data = file.windows(4).position(|w| w == b"mdat").unwrap() + 4;
            assert!(place == data && place + length < file.len());
        }
    }

    #[test]
    fn the_bytes_do_not_depend_on_the_number_of_threads() {
        let picture = picture_for(Format::Avif, 700, 600);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| encoded(&picture, Format::Avif, &Metadata::default()).unwrap())
        };
        assert!(with(1) == with(3));
    }
}
