//! The fields of the shot as an Exif block.

use std::io::Cursor;

use darkroot_colour::RgbSpace;
use darkroot_photo::metadata::{Directory, Field, Value, tag};
use darkroot_photo::{Metadata, PictureSpace, Size};
use exif::experimental::Writer;
use exif::{Context, In, Rational, SRational, Tag};

use crate::Format;

/// The fields as a block in the structure of TIFF, little endian, without the "Exif\0\0" that some files put
/// before it. It is empty when there are no fields.
///
/// The orientation in the block is always 1, as the pixels are upright already. Fields that say how another
/// file stores its pixels, and fields without a value, are left out. Text keeps its UTF-8 bytes.
pub fn block(metadata: &Metadata) -> Vec<u8> {
    with_thumbnail(metadata, None)
}

/// The same with a JPEG as thumbnail.
pub(crate) fn with_thumbnail(metadata: &Metadata, thumbnail: Option<&[u8]>) -> Vec<u8> {
    let fields: Vec<exif::Field> = fields(metadata)
        .filter(|field| !has_own_place(field))
        .map(|field| exif::Field {
            tag: Tag(context(field.directory), field.tag),
            ifd_num: In::PRIMARY,
            value: value(&field.value),
        })
        .collect();
    if fields.is_empty() {
        return Vec::new();
    }
    let upright = exif::Field {
        tag: Tag(Context::Tiff, tag::ORIENTATION),
        ifd_num: In::PRIMARY,
        value: exif::Value::Short(vec![1]),
    };
    let mut writer = Writer::new();
    writer.push_field(&upright);
    fields.iter().for_each(|field| writer.push_field(field));
    let of_thumbnail = thumbnail_fields();
    if let Some(jpeg) = thumbnail {
        of_thumbnail.iter().for_each(|field| writer.push_field(field));
        writer.set_jpeg(jpeg, In::THUMBNAIL);
    }
    let mut block = Cursor::new(Vec::new());
    match writer.write(&mut block, true) {
        Ok(()) => block.into_inner(),
        // Left are blocks of 4 GB and more.
        Err(_) => Vec::new(),
    }
}

/// What a thumbnail must state (Exif 2.32, table 21): that it is a JPEG, and a resolution.
fn thumbnail_fields() -> [exif::Field; 4] {
    const JPEG: u16 = 6;
    let resolution = exif::Value::Rational(vec![Rational { num: UNKNOWN, denom: 1 }]);
    [
        (Tag::Compression, exif::Value::Short(vec![JPEG])),
        (Tag::XResolution, resolution.clone()),
        (Tag::YResolution, resolution),
        (Tag::ResolutionUnit, exif::Value::Short(vec![INCH])),
    ]
    .map(|(tag, value)| exif::Field { tag, ifd_num: In::THUMBNAIL, value })
}

/// What a finished picture states of itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stated {
    /// When it was taken ("2026:05:01 12:00:00").
    pub date: Option<String>,
    /// Pixels an inch; none where it states 72, as Exif has it where nobody knows (Exif 2.32, 4.6.4).
    pub resolution: Option<f64>,
}

/// What the bytes of a finished picture's file state; nothing where there is no Exif.
pub fn stated(file: &[u8]) -> Stated {
    let exif = exif::Reader::new().read_from_container(&mut Cursor::new(file));
    exif.map_or_else(
        |_| Stated::default(),
        |exif| Stated { date: date(&exif), resolution: resolution(&exif) },
    )
}

fn date(exif: &exif::Exif) -> Option<String> {
    match &exif.get_field(Tag::DateTimeOriginal, In::PRIMARY)?.value {
        exif::Value::Ascii(texts) => texts.first().and_then(|text| String::from_utf8(text.clone()).ok()),
        _ => None,
    }
}

fn resolution(exif: &exif::Exif) -> Option<f64> {
    const CENTIMETRE: u32 = 3;
    let unit = exif.get_field(Tag::ResolutionUnit, In::PRIMARY).and_then(|field| field.value.get_uint(0));
    let exif::Value::Rational(value) = &exif.get_field(Tag::XResolution, In::PRIMARY)?.value else {
        return None;
    };
    let value = value.first()?.to_f64();
    let inch = u32::from(INCH);
    let stated = match unit.unwrap_or(inch) {
        CENTIMETRE => 2.54 * value,
        unit if unit == inch => value,
        _ => return None,
    };
    let is_stated = stated.is_finite() && stated > 0.0 && (stated - f64::from(UNKNOWN)).abs() > 1e-6;
    is_stated.then_some(stated)
}

/// The packet of XMP, where there is one. TIFF has a field for it; other formats have a place outside of Exif.
pub(crate) fn xmp(metadata: &Metadata) -> &[u8] {
    metadata.bytes(Directory::Image, tag::XMP).unwrap_or_default()
}

/// The block of IPTC-IIM, where there is one: in TIFF a field, in JPEG a place outside of Exif.
pub(crate) fn iptc(metadata: &Metadata) -> &[u8] {
    metadata.bytes(Directory::Image, tag::IPTC).unwrap_or_default()
}

/// Whether a field is none of the Exif block but stands beside it.
fn has_own_place(field: &Field) -> bool {
    field.directory == Directory::Image && [tag::XMP, tag::IPTC].contains(&field.tag)
}

/// The fields that are written for a picture, in the order of their tags, but for the orientation.
pub(crate) fn fields(metadata: &Metadata) -> impl Iterator<Item = &Field> {
    metadata.fields().iter().filter(|field| !is_about_storage(field) && !is_empty(&field.value))
}

/// The fields of the shot together with what the fields of the file must say of this picture: its size and
/// whether it is in sRGB, and what a JPEG must say beside that. No fields stay no fields.
pub(crate) fn of_picture(metadata: &Metadata, size: Size, space: &PictureSpace, format: Format) -> Metadata {
    let mut metadata = metadata.clone();
    if fields(&metadata).next().is_none() {
        return Metadata::default();
    }
    let srgb = match space {
        PictureSpace::Rgb(space) => crate::format::same_colours(space, &RgbSpace::SRGB),
        PictureSpace::Camera | PictureSpace::Raw => false,
    };
    let mut set = |tag, value| metadata.set(Directory::Exif, tag, value);
    set(tag::COLOUR_SPACE, Value::Shorts(vec![if srgb { 1 } else { UNCALIBRATED }]));
    set(FLASHPIX_VERSION, Value::Undefined(b"0100".to_vec()));
    // TIFF has the size in fields of its own (Exif 2.32, table 20).
    if format != Format::Tiff {
        set(PIXEL_X_DIMENSION, Value::Longs(vec![size.width as u32]));
        set(PIXEL_Y_DIMENSION, Value::Longs(vec![size.height as u32]));
    }
    if metadata.get(Directory::Exif, EXIF_VERSION).is_none() {
        metadata.set(Directory::Exif, EXIF_VERSION, Value::Undefined(b"0232".to_vec()));
    }
    if format == Format::Jpeg {
        required_of_jpeg(&mut metadata);
    }
    metadata
}

/// What every Exif of a JPEG states (Exif 2.32, table 20): 72 pixels an inch where nobody says another number, samples of
/// colour in the middle, the order of components.
fn required_of_jpeg(metadata: &mut Metadata) {
    const CENTRED: u16 = 1;
    let required = [
        (Directory::Image, tag::RESOLUTION[0], Value::Rationals(vec![(UNKNOWN, 1)])),
        (Directory::Image, tag::RESOLUTION[1], Value::Rationals(vec![(UNKNOWN, 1)])),
        (Directory::Image, tag::RESOLUTION_UNIT, Value::Shorts(vec![INCH])),
        (Directory::Image, YCBCR_POSITIONING, Value::Shorts(vec![CENTRED])),
        (Directory::Exif, COMPONENTS, Value::Undefined(vec![1, 2, 3, 0])),
    ];
    for (directory, tag, value) in required {
        if metadata.get(directory, tag).is_none() {
            metadata.set(directory, tag, value);
        }
    }
}

/// ColorSpace of a picture that its ICC profile describes.
const UNCALIBRATED: u16 = 0xffff;
const EXIF_VERSION: u16 = 0x9000;
const COMPONENTS: u16 = 0x9101;
/// ResolutionUnit: an inch, and what is stated where the resolution is not known.
const INCH: u16 = 2;
const UNKNOWN: u32 = 72;
const FLASHPIX_VERSION: u16 = 0xa000;
const YCBCR_POSITIONING: u16 = 0x0213;
const PIXEL_X_DIMENSION: u16 = 0xa002;
const PIXEL_Y_DIMENSION: u16 = 0xa003;
/// Exif: what the maker wants to remember, in a form of its own.
pub(crate) const MAKER_NOTE: u16 = 0x927c;

/// Whether a field says how some other file stores its pixels or where it keeps a directory. In the file that
/// is written it would be wrong.
fn is_about_storage(field: &Field) -> bool {
    match field.directory {
        Directory::Image => matches!(
            field.tag,
            tag::ORIENTATION
                | 0x00fe..=0x0103 // kind of subfile, size, bits, compression
                | 0x0106 // photometric interpretation
                | 0x010a // fill order
                | 0x0111 // strips
                | 0x0115..=0x0119 // samples a pixel, rows a strip, strips, least and largest value
                | 0x011c // planar configuration
                | 0x013d // predictor
                | 0x012d | 0x013e..=0x013f // transfer function, white, primaries
                | 0x0140..=0x015b // palette, tiles, subfiles, inks, sample format, JPEG tables
                | 0x0200..=0x0212 | 0x0214 // thumbnail, YCbCr
                | 0x828d..=0x828e // colour filter array
                | 0x8769 // Exif directory
                | 0x8773 // ICC profile
                | 0x8825 // GPS directory
                | 0xc612..=0xcdff // DNG
        ),
        // Interoperability directory, colour filter array, gamma.
        Directory::Exif => matches!(field.tag, 0xa005 | 0xa302 | 0xa500),
        Directory::Gps => false,
    }
}

fn is_empty(value: &Value) -> bool {
    match value {
        Value::Text(text) => text.is_empty(),
        Value::Bytes(v) | Value::Undefined(v) => v.is_empty(),
        Value::Shorts(v) => v.is_empty(),
        Value::Longs(v) => v.is_empty(),
        Value::Rationals(v) => v.is_empty(),
        Value::SignedRationals(v) => v.is_empty(),
    }
}

fn context(directory: Directory) -> Context {
    match directory {
        Directory::Image => Context::Tiff,
        Directory::Exif => Context::Exif,
        Directory::Gps => Context::Gps,
    }
}

fn value(value: &Value) -> exif::Value {
    match value {
        Value::Text(text) => exif::Value::Ascii(vec![text.as_bytes().to_vec()]),
        Value::Bytes(v) => exif::Value::Byte(v.clone()),
        Value::Undefined(v) => exif::Value::Undefined(v.clone(), 0),
        Value::Shorts(v) => exif::Value::Short(v.clone()),
        Value::Longs(v) => exif::Value::Long(v.clone()),
        Value::Rationals(v) => {
            exif::Value::Rational(v.iter().map(|&(num, denom)| Rational { num, denom }).collect())
        }
        Value::SignedRationals(v) => {
            exif::Value::SRational(v.iter().map(|&(num, denom)| SRational { num, denom }).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::metadata;

    fn read(block: Vec<u8>) -> exif::Exif {
        exif::Reader::new().read_raw(block).unwrap()
    }

    fn number(exif: &exif::Exif, tag: Tag) -> Option<u32> {
        exif.get_field(tag, In::PRIMARY)?.value.get_uint(0)
    }

    #[test]
    fn every_field_comes_back() {
        let exif = read(block(&metadata()));
        for field in metadata().fields().iter().filter(|field| field.tag != tag::ORIENTATION) {
            let back = exif.get_field(Tag(context(field.directory), field.tag), In::PRIMARY).unwrap();
            match (&back.value, value(&field.value)) {
                // Where the bytes lay is part of the value that was read.
                (exif::Value::Undefined(back, _), exif::Value::Undefined(there, _)) => {
                    assert_eq!(*back, there);
                }
                (back, there) => assert_eq!(format!("{back:?}"), format!("{there:?}")),
            }
        }
        assert_eq!(exif.fields().count(), metadata().fields().len());
    }

    #[test]
    fn a_packet_of_xmp_stands_outside_of_the_block() {
        let mut fields = metadata();
        fields.set(Directory::Image, tag::XMP, Value::Bytes(b"<x/>".to_vec()));
        fields.set(Directory::Image, tag::IPTC, Value::Undefined(vec![0x1c]));
        assert_eq!((xmp(&fields), iptc(&fields)), (b"<x/>".as_slice(), [0x1c].as_slice()));
        assert_eq!(block(&fields), block(&metadata()));
    }

    #[test]
    fn the_picture_is_upright_whatever_the_camera_said() {
        let mut turned = metadata();
        turned.set(Directory::Image, tag::ORIENTATION, Value::Shorts(vec![8]));
        assert_eq!(number(&read(block(&turned)), Tag::Orientation), Some(1));
    }

    #[test]
    fn no_fields_are_no_block() {
        assert!(block(&Metadata::default()).is_empty());
        let mut turned = Metadata::default();
        turned.set(Directory::Image, tag::ORIENTATION, Value::Shorts(vec![6]));
        turned.set(Directory::Image, tag::ARTIST, Value::Text(String::new()));
        assert!(block(&turned).is_empty());
        assert!(
            block(&of_picture(&turned, Size { width: 1, height: 1 }, &PictureSpace::Camera, Format::Jpeg))
                .is_empty()
        );
    }

    #[test]
    fn what_the_raw_file_said_of_its_own_storage_is_left_out() {
        let mut fields = metadata();
        for tag in [0x0100, 0x0102, 0x0103, 0x0111, 0x0117, 0x014a, 0x0201, 0x8769, 0x8773, 0xc621] {
            fields.set(Directory::Image, tag, Value::Longs(vec![99]));
        }
        fields.set(Directory::Exif, 0xa005, Value::Longs(vec![99]));
        assert_eq!(block(&fields), block(&metadata()));
    }

    #[test]
    fn the_fields_tell_the_size_and_whether_it_is_srgb() {
        for (space, wanted) in [(RgbSpace::SRGB, 1), (RgbSpace::ADOBE_RGB, 0xffff)] {
            let size = Size { width: 5, height: 3 };
            let exif = read(block(&of_picture(&metadata(), size, &PictureSpace::Rgb(space), Format::Jpeg)));
            assert_eq!(number(&exif, Tag::ColorSpace), Some(wanted));
            assert_eq!(number(&exif, Tag::PixelXDimension), Some(5));
            assert_eq!(number(&exif, Tag::PixelYDimension), Some(3));
            assert_eq!(number(&exif, Tag::YCbCrPositioning), Some(1));
        }
    }

    #[test]
    fn a_resolution_that_nobody_asked_for_is_not_stated() {
        let mut fields = metadata();
        let size = Size { width: 5, height: 3 };
        let space = PictureSpace::Rgb(RgbSpace::SRGB);
        let back =
            |fields: &Metadata| resolution(&read(block(&of_picture(fields, size, &space, Format::Jpeg))));
        assert_eq!(back(&fields), None);
        for tag in tag::RESOLUTION {
            fields.set(Directory::Image, tag, Value::Rationals(vec![(300, 1)]));
        }
        assert_eq!(back(&fields), Some(300.0));
    }
}
