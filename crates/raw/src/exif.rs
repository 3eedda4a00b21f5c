//! What the camera wrote about the shot: standard Exif fields of any container.

use darkroot_photo::metadata::{Directory, Metadata, Value, tag};
use flashraw::{PreviewEncoding, RawMetadata};

use crate::maker_note;
use crate::screen::Container;
use crate::tiff::{Directories, EXIF_IFD, Entry, GPS_IFD};

/// Fields of the primary directory that still hold for the developed picture.
const IMAGE_TAGS: [u16; 8] = [
    tag::IMAGE_DESCRIPTION,
    tag::MAKE,
    tag::MODEL,
    tag::DATE_TIME,
    tag::ARTIST,
    tag::COPYRIGHT,
    tag::RATING[0],
    tag::RATING[1],
];
/// What people wrote, in blocks of their own.
const BLOCKS: [u16; 2] = [tag::XMP, tag::IPTC];

/// Fields of the Exif directory that still hold for the developed picture: exposure, dates, lens, conditions.
/// Those that describe the stored pixels or the camera's own rendering are left out.
const EXIF_TAGS: [u16; 53] = [
    0x829a, 0x829d, 0x8822, 0x8827, 0x8830, 0x8831, 0x8832, 0x8833, 0x8834, 0x8835, 0x9003, 0x9004, 0x9010,
    0x9011, 0x9012, 0x9201, 0x9202, 0x9203, 0x9204, 0x9205, 0x9206, 0x9207, 0x9208, 0x9209, 0x920a, 0x9286,
    0x9290, 0x9291, 0x9292, 0x9400, 0x9401, 0x9402, 0x9403, 0x9404, 0x9405, 0xa217, 0xa300, 0xa301, 0xa402,
    0xa403, 0xa404, 0xa405, 0xa406, 0xa40c, 0xa420, 0xa430, 0xa431, 0xa432, 0xa433, 0xa434, 0xa435, 0xa460,
    0xa461,
];

/// Exif 2.32 defines no tags beyond this one in the directory of the position.
const LAST_GPS_TAG: u16 = 0x1f;

/// No real text field is longer.
const MAX_TEXT: usize = 4096;
/// No field that is carried over has more values.
const MAX_VALUES: usize = 1024;
/// Bytes of the largest field that is carried over: the longest list of fractions.
const MAX_LENGTH: usize = 8 * MAX_VALUES;

/// Bytes of the largest packet of XMP that is carried over, and of the largest block of IPTC.
const MAX_BLOCK: usize = 1 << 20;

/// Reads the standard fields of the file itself, or of its embedded JPEG where the container is not TIFF.
///
/// However many entries there are and whatever they claim, what is kept of them is bounded: each wanted field once, of
/// [`MAX_LENGTH`] bytes at most.
pub(crate) fn read(bytes: &[u8], container: &Container<'_>, meta: &RawMetadata) -> Metadata {
    if let Some(tiff) = &container.tiff {
        return fields(tiff);
    }
    let block = embedded_jpeg(bytes, meta).and_then(exif_of_jpeg);
    // A file with no readable Exif develops all the same; its fields are then few.
    let tiff = block.and_then(|block| Directories::walk(block).ok().flatten());
    tiff.map_or_else(Metadata::default, |tiff| fields(&tiff))
}

/// The fields of a TIFF-based file; none of another.
pub(crate) fn of_container(container: &Container<'_>) -> Metadata {
    container.tiff.as_ref().map_or_else(Metadata::default, fields)
}

/// Exif ColorSpace: 1 is sRGB.
pub(crate) fn colour_space(tiff: &Directories<'_>) -> Option<u64> {
    tiff.below(tiff.all.first()?, EXIF_IFD)?.number(tiff, tag::COLOUR_SPACE)
}

/// The wanted fields of the first directory and of those below it.
fn fields(tiff: &Directories<'_>) -> Metadata {
    let mut metadata = Metadata::default();
    let Some(image) = tiff.all.first() else { return metadata };
    let mut take = |entries: &[Entry], directory, wanted: &dyn Fn(u16) -> bool| {
        for entry in entries.iter().filter(|e| wanted(e.tag)) {
            if let Some(value) = value(tiff, entry) {
                metadata.set(directory, entry.tag, value);
            }
        }
    };
    take(&image.entries, Directory::Image, &|tag| IMAGE_TAGS.contains(&tag));
    if let Some(exif) = tiff.below(image, EXIF_IFD) {
        take(&exif.entries, Directory::Exif, &|tag| EXIF_TAGS.contains(&tag));
    }
    if let Some(gps) = tiff.below(image, GPS_IFD) {
        take(&gps.entries, Directory::Gps, &|tag| tag <= LAST_GPS_TAG);
    }
    for entry in image.entries.iter().filter(|entry| BLOCKS.contains(&entry.tag)) {
        // Types are bytes of any kind; IPTC is at times stored as whole numbers of 32 bits.
        let block = tiff.value(entry, MAX_BLOCK).filter(|block| !block.is_empty());
        if let Some(block) = block.filter(|_| matches!(entry.kind, 1 | 2 | 4 | 7)) {
            metadata.set(Directory::Image, entry.tag, Value::Bytes(block.to_vec()));
        }
    }
    maker_note::complete(&mut metadata, tiff);
    metadata
}

/// Adds what the decoder knows from maker notes and other containers, where the standard field is missing.
pub(crate) fn complete(metadata: &mut Metadata, meta: &RawMetadata) {
    let text = |s: &Option<String>| s.as_ref().map(|s| Value::Text(s.clone()));
    let (exposure, lens) = (&meta.exposure, &meta.lens);
    let date = meta.capture_time.as_deref().and_then(exif_date).map(Value::Text);
    let known = [
        (Directory::Image, tag::MAKE, Some(Value::Text(meta.make.clone()))),
        (Directory::Image, tag::MODEL, Some(Value::Text(meta.model.clone()))),
        (Directory::Image, tag::ARTIST, text(&meta.artist)),
        (Directory::Image, tag::COPYRIGHT, text(&meta.copyright)),
        (Directory::Exif, tag::EXPOSURE_TIME, exposure.exposure_time.and_then(fraction)),
        (Directory::Exif, tag::F_NUMBER, exposure.f_number.and_then(|v| fraction(v.into()))),
        (Directory::Exif, tag::ISO, exposure.iso.map(|v| Value::Shorts(vec![v.min(65535) as u16]))),
        (Directory::Exif, tag::FOCAL_LENGTH, exposure.focal_length.and_then(|v| fraction(v.into()))),
        (Directory::Exif, tag::DATE_TIME_ORIGINAL, date),
        (Directory::Exif, tag::LENS_MAKE, text(&lens.make)),
        (Directory::Exif, tag::LENS_MODEL, text(&lens.model)),
    ];
    for (directory, number, value) in known {
        let empty = matches!(&value, Some(Value::Text(t)) if t.trim().is_empty());
        if let Some(value) = value
            && !empty
            && metadata.get(directory, number).is_none()
        {
            metadata.set(directory, number, value);
        }
    }
}

fn embedded_jpeg<'a>(bytes: &'a [u8], meta: &RawMetadata) -> Option<&'a [u8]> {
    let jpeg = meta.previews.iter().filter(|p| p.encoding == PreviewEncoding::Jpeg);
    let largest = jpeg.max_by_key(|p| p.length)?;
    let start = usize::try_from(largest.offset).ok()?;
    bytes.get(start..start.checked_add(usize::try_from(largest.length).ok()?)?)
}

/// The Exif block of a JPEG: the first APP1 segment that says so (Exif 2.32, 4.7.2).
pub(crate) fn exif_of_jpeg(jpeg: &[u8]) -> Option<&[u8]> {
    let mut rest = jpeg.strip_prefix(&[0xff, 0xd8])?;
    while let [0xff, marker, high, low, ..] = *rest {
        let (segment, after) =
            rest.get(2..)?.split_at_checked(usize::from(u16::from_be_bytes([high, low])))?;
        match marker {
            0xe1 if segment.get(2..8) == Some(b"Exif\0\0") => return segment.get(8..),
            // The scan: headers are over.
            0xda => return None,
            _ => rest = after,
        }
    }
    None
}

/// The value of an entry; `None` for types that no wanted field has, and for values larger than any real one.
fn value(tiff: &Directories<'_>, entry: &Entry) -> Option<Value> {
    let bytes = tiff.value(entry, MAX_LENGTH).filter(|bytes| !bytes.is_empty())?;
    let pairs = || tiff.longs(bytes).as_chunks().0.iter().map(|&[n, d]| (n, d)).collect::<Vec<(u32, u32)>>();
    let value = match entry.kind {
        2 => return text(bytes),
        1 => Value::Bytes(bytes.to_vec()),
        7 => Value::Undefined(bytes.to_vec()),
        3 => Value::Shorts(tiff.shorts(bytes)),
        4 => Value::Longs(tiff.longs(bytes)),
        5 => Value::Rationals(pairs()),
        10 => Value::SignedRationals(pairs().into_iter().map(|(n, d)| (n as i32, d as i32)).collect()),
        _ => return None,
    };
    (entry.count <= MAX_VALUES as u64).then_some(value)
}

/// The lines of a text field, which zeros divide.
fn text(bytes: &[u8]) -> Option<Value> {
    let lines = bytes.split(|&b| b == 0).map(|l| String::from_utf8_lossy(l).trim_matches(' ').to_owned());
    let text = lines.filter(|l| !l.is_empty()).collect::<Vec<_>>().join("; ");
    (!text.is_empty() && text.len() <= MAX_TEXT).then_some(Value::Text(text))
}

/// A positive number as a fraction: 1/n where it is one, else in thousandths.
fn fraction(v: f64) -> Option<Value> {
    if !(v.is_finite() && v > 0.0 && v < 1e6) {
        return None;
    }
    let inverse = 1.0 / v;
    let one_over = v < 1.0 && inverse < 1e6 && (inverse - inverse.round()).abs() < 0.01 * inverse;
    let pair = if one_over { (1, inverse.round() as u32) } else { ((v * 1000.0).round() as u32, 1000) };
    Some(Value::Rationals(vec![pair]))
}

/// "2024-05-06T07:08:09..." as Exif writes it, "2024:05:06 07:08:09".
fn exif_date(iso: &str) -> Option<String> {
    let (date, time) = iso.split_once(['T', ' '])?;
    let time = time.get(..8)?;
    (date.len() == 10).then(|| format!("{} {time}", date.replace('-', ":")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A big-endian TIFF whose first directory points to an Exif directory with these entries of values at the end.
    fn tiff(entries: &[(u16, u16, u32)], values: &[u8]) -> Vec<u8> {
        let mut bytes = b"MM\0\x2a\0\0\0\x08\0\x01\x87\x69\0\x04\0\0\0\x01\0\0\0\x1a\0\0\0\0".to_vec();
        let values_at = (bytes.len() + 2 + 12 * entries.len() + 4) as u32;
        bytes.extend((entries.len() as u16).to_be_bytes());
        for (tag, kind, count) in entries {
            bytes.extend([tag.to_be_bytes(), kind.to_be_bytes()].concat());
            bytes.extend([count.to_be_bytes(), values_at.to_be_bytes()].concat());
        }
        bytes.extend([0; 4]);
        bytes.extend(values);
        bytes
    }

    fn read_fields(bytes: &[u8]) -> Metadata {
        fields(&Directories::walk(bytes).unwrap().unwrap())
    }

    #[test]
    fn values_of_every_type_are_read_in_the_file_s_byte_order() {
        let values = [0, 0, 0, 7, 0xff, 0xff, 0xff, 0xfe, 0, 0];
        let wanted = [(0x829a, 5, 1), (0x9204, 10, 1), (0x8827, 3, 4), (0x8830, 4, 2), (0x9286, 7, 6)];
        let metadata = read_fields(&tiff(&wanted, &values));
        let of = |tag| metadata.get(Directory::Exif, tag).unwrap().clone();
        assert_eq!(of(0x829a), Value::Rationals(vec![(7, 0xffff_fffe)]));
        assert_eq!(of(0x9204), Value::SignedRationals(vec![(7, -2)]));
        assert_eq!(of(0x8827), Value::Shorts(vec![0, 7, 0xffff, 0xfffe]));
        assert_eq!(of(0x8830), Value::Longs(vec![7, 0xffff_fffe]));
        assert_eq!(of(0x9286), Value::Undefined(values[..6].to_vec()));
        let lines = read_fields(&tiff(&[(0xa434, 2, 12)], b"50 mm\0 f/2 \0"));
        assert_eq!(lines.text(Directory::Exif, 0xa434), Some("50 mm; f/2"));
    }

    #[test]
    fn values_larger_than_any_real_one_and_unknown_types_are_left_out() {
        let block = vec![b'a'; 20_000];
        let large =
            [(0x8830, 4, 1025), (0x9003, 2, 4097), (0x9286, 7, 1025), (0x9291, 13, 9), (0x9292, 2, u32::MAX)];
        assert_eq!(read_fields(&tiff(&large, &block)), Metadata::default());
        let largest = [(0x829a, 5, 1024), (0x9003, 2, 4096), (0x9286, 7, 1024)];
        assert_eq!(read_fields(&tiff(&largest, &block)).fields().len(), 3);
    }

    #[test]
    fn the_block_of_a_jpeg_is_its_first_exif_segment() {
        let jpeg = b"\xff\xd8\xff\xe0\0\x04JF\xff\xe1\0\x05XMP\xff\xe1\0\x0cExif\0\0MM\0\x2a\xff\xda\0\x02";
        assert_eq!(exif_of_jpeg(jpeg), Some(&b"MM\0\x2a"[..]));
        for length in 0..jpeg.len() - 4 {
            assert_eq!(exif_of_jpeg(&jpeg[..length]), None, "{length}");
        }
        assert_eq!(exif_of_jpeg(b"\xff\xd8\xff\xda\0\x02\xff\xe1\0\x0aExif\0\0MM"), None);
    }

    #[test]
    fn exposure_times_become_the_fractions_that_cameras_show() {
        assert_eq!(fraction(0.005), Some(Value::Rationals(vec![(1, 200)])));
        assert_eq!(fraction(2.8), Some(Value::Rationals(vec![(2800, 1000)])));
        assert_eq!(fraction(f64::NAN), None);
        assert_eq!(fraction(-1.0), None);
    }

    #[test]
    fn dates_are_written_as_exif_wants_them() {
        assert_eq!(exif_date("2024-05-06T07:08:09.25+02:00").as_deref(), Some("2024:05:06 07:08:09"));
        assert_eq!(exif_date("yesterday"), None);
    }
}
