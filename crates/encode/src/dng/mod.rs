//! Linear DNG (Adobe, Digital Negative Specification 1.7.1, "LinearRaw"): camera RGB of every pixel for another raw developer,
//! in tiles of lossless JPEG, with what gives its colours and pictures to look at.
//!
//! The first directory shows a small picture and says all of the shot; the samples and a larger picture stand in directories
//! below it, as most converters write.

mod facts;
mod preview;
mod tiles;

use std::io::{Seek, Write};

use darkroot_photo::Metadata;
use darkroot_photo::metadata::Directory;
use tiff::encoder::{DirectoryEncoder, Rational, SRational, TiffEncoder, TiffKindStandard};
use tiff::tags::{Tag, Type};
use tiff::{TiffError, TiffResult};

use crate::bands::{self, MakeBands, Outline};
use crate::output::Buffered;
use crate::sample::Sample;
use crate::tiff_entries::{shot_directories, write_bytes, write_fields};
use crate::{Error, Format, Options};

pub use facts::{CameraColours, Dng, HueSatTable};
use tiles::Tiles;

/// Tags of DNG 1.7.1 and TIFF/EP.
mod tag {
    pub(super) const SUB_IFDS: u16 = 330;
    pub(super) const DNG_VERSION: u16 = 50706;
    pub(super) const DNG_BACKWARD_VERSION: u16 = 50707;
    pub(super) const UNIQUE_CAMERA_MODEL: u16 = 50708;
    pub(super) const BLACK_LEVEL: u16 = 50714;
    pub(super) const WHITE_LEVEL: u16 = 50717;
    pub(super) const DEFAULT_SCALE: u16 = 50718;
    pub(super) const DEFAULT_CROP_ORIGIN: u16 = 50719;
    pub(super) const DEFAULT_CROP_SIZE: u16 = 50720;
    pub(super) const COLOR_MATRIX: u16 = 50721;
    pub(super) const AS_SHOT_NEUTRAL: u16 = 50728;
    pub(super) const BASELINE_EXPOSURE: u16 = 50730;
    pub(super) const BASELINE_NOISE: u16 = 50731;
    pub(super) const BASELINE_SHARPNESS: u16 = 50732;
    pub(super) const LINEAR_RESPONSE_LIMIT: u16 = 50734;
    pub(super) const CALIBRATION_ILLUMINANT: u16 = 50778;
    pub(super) const ORIGINAL_RAW_FILE_NAME: u16 = 50827;
    pub(super) const PROFILE_NAME: u16 = 50936;
    pub(super) const MAP_DIMENSIONS: u16 = 50937;
    pub(super) const MAP: u16 = 50938;
    pub(super) const EMBED_POLICY: u16 = 50941;
    pub(super) const FORWARD_MATRIX: u16 = 50964;
    pub(super) const PREVIEW_APPLICATION: u16 = 50966;
    pub(super) const PREVIEW_COLOR_SPACE: u16 = 50970;
    pub(super) const BLACK_RENDER: u16 = 51110;
}

/// What the file says by numbers.
mod value {
    pub(super) const LINEAR_RAW: u16 = 34892;
    pub(super) const JPEG: u16 = 7;
}

/// A directory that is being written. Offsets have 32 bits: there is no DNG of more than 4 GB.
type Entries<'a, W> = DirectoryEncoder<'a, W, TiffKindStandard>;

/// Writes a picture of a size that [`Format::sides`] has allowed.
pub(crate) fn write<T: Sample>(
    outline: &Outline,
    options: &Options,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
    make: &mut MakeBands<'_, T>,
) -> Result<(), Error> {
    let width = outline.size.width;
    let mut file = TiffEncoder::<_, TiffKindStandard>::new_generic(out).map_err(error)?;
    let tiles = Tiles::new(file.extra_directory().map_err(error)?);
    let code = |_, samples: &[T]| Ok(tiles::coded(bytemuck::cast_slice(samples), width));
    let tiles = bands::code(outline.size, tiles::SIDE, tiles, code, make)?;
    let mut below = vec![samples(tiles, outline).map_err(error)?];
    if let Some(picture) = &options.dng.preview {
        let jpeg = preview::jpeg(picture)?;
        below.push(preview::directory(&mut file, picture.size, &jpeg).map_err(error)?);
    }
    first_directory(&mut file, &below, &options.dng, metadata).map_err(error)
}

fn error(e: TiffError) -> Error {
    Error::encoder(Format::Dng)(e.into())
}

/// The directory of the samples; its offset.
fn samples<W: Write + Seek>(tiles: Tiles<'_, W>, outline: &Outline) -> TiffResult<u32> {
    let (width, height) = (outline.size.width as u32, outline.size.height as u32);
    let mut entries = tiles.finish()?;
    entries.write_tag(Tag::NewSubfileType, 0_u32)?;
    entries.write_tag(Tag::ImageWidth, width)?;
    entries.write_tag(Tag::ImageLength, height)?;
    entries.write_tag(Tag::BitsPerSample, &[16_u16; 3][..])?;
    entries.write_tag(Tag::Compression, value::JPEG)?;
    entries.write_tag(Tag::PhotometricInterpretation, value::LINEAR_RAW)?;
    entries.write_tag(Tag::SamplesPerPixel, 3_u16)?;
    entries.write_tag(Tag::PlanarConfiguration, 1_u16)?;
    put(&mut entries, tag::BLACK_LEVEL, &[0_u32; 3][..])?;
    put(&mut entries, tag::WHITE_LEVEL, &[65_535_u32; 3][..])?;
    put(&mut entries, tag::DEFAULT_SCALE, &fractions(&[1.0, 1.0])[..])?;
    put(&mut entries, tag::DEFAULT_CROP_ORIGIN, &[0_u32, 0][..])?;
    put(&mut entries, tag::DEFAULT_CROP_SIZE, &[width, height][..])?;
    Ok(entries.finish_with_offsets()?.offset)
}

/// Everything but the samples: a small picture of them, the shot, and what gives the colours.
fn first_directory<W: Write + Seek>(
    file: &mut TiffEncoder<W, TiffKindStandard>,
    below: &[u32],
    facts: &Dng,
    metadata: &Metadata,
) -> TiffResult<()> {
    let pointers = shot_directories(file, metadata)?;
    let mut entries = file.image_directory()?;
    preview::thumbnail(&mut entries, facts.preview.as_deref())?;
    write_fields(&mut entries, metadata, Directory::Image)?;
    entries.write_tag(Tag::Orientation, 1_u16)?;
    for (pointer, offset) in pointers {
        put(&mut entries, pointer, offset)?;
    }
    put(&mut entries, tag::SUB_IFDS, below)?;
    write_bytes(&mut entries, tag::DNG_VERSION, Type::BYTE, &[1, 4, 0, 0])?;
    write_bytes(&mut entries, tag::DNG_BACKWARD_VERSION, Type::BYTE, &[1, 2, 0, 0])?;
    facts::put_into(&mut entries, facts)?;
    entries.finish()
}

fn put<W: Write + Seek>(
    entries: &mut Entries<'_, W>,
    tag: u16,
    value: impl tiff::encoder::TiffValue,
) -> TiffResult<()> {
    entries.write_tag(Tag::from_u16_exhaustive(tag), value)
}

/// Denominator of fractions.
const UNIT: f64 = 1e6;

fn fractions(numbers: &[f64]) -> Vec<Rational> {
    numbers.iter().map(|v| Rational { n: (v * UNIT).round() as u32, d: UNIT as u32 }).collect()
}

fn signed_fractions<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> Vec<SRational> {
    numbers.into_iter().map(|v| SRational { n: (v * UNIT).round() as i32, d: UNIT as i32 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_lossless, encoded, metadata, picture};
    use darkroot_colour::{RgbSpace, white};
    use darkroot_photo::PictureSpace;

    #[test]
    fn samples_come_back() {
        assert_lossless(Format::Dng, 16, PictureSpace::Raw);
    }

    #[test]
    fn the_first_directory_says_what_gives_the_colours() {
        let file = encoded(&picture(40, 30, 16, PictureSpace::Raw), Format::Dng, &metadata()).unwrap();
        let exif = exif::Reader::new().read_raw(file).unwrap();
        let value = |tag: u16| {
            let tag = exif::Tag(exif::Context::Tiff, tag);
            &exif.get_field(tag, exif::In::PRIMARY).unwrap().value
        };
        let field = |tag: u16| value(tag).display_as(exif::Tag(exif::Context::Tiff, tag)).to_string();
        assert_eq!(field(tag::DNG_VERSION), "1, 4, 0, 0");
        let exif::Value::Rational(neutral) = value(tag::AS_SHOT_NEUTRAL) else { panic!() };
        assert!(neutral.iter().all(|v| (v.to_f64() - 1.0).abs() < 1e-9));
        let exif::Value::SRational(matrix) = value(tag::COLOR_MATRIX) else { panic!() };
        let row: Vec<f64> = matrix[..3].iter().map(|v| v.to_f64()).collect();
        let of_srgb = RgbSpace::SRGB.from_xyz_under(white::D50);
        assert!(row.iter().zip(of_srgb.row(0).iter()).all(|(a, b)| (a - b).abs() < 1e-6), "{row:?}");
        assert_eq!(field(0x0110), "\"NIKON D700\"");
        assert_eq!(field(0x0112), "row 0 at top and column 0 at left");
    }
}
