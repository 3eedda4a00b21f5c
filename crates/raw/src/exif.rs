//! What the camera wrote about the shot: standard Exif fields of any container.

use darkroot_photo::metadata::{Directory, Metadata, Value, tag};
use exif::{Context, In, Reader, Value as ExifValue};
use flashraw::{PreviewEncoding, RawMetadata};

use crate::screen::Container;

/// Fields of the primary directory that still hold for the developed picture.
const IMAGE_TAGS: [u16; 6] = [0x010e, tag::MAKE, tag::MODEL, tag::DATE_TIME, tag::ARTIST, tag::COPYRIGHT];

/// Fields of the Exif directory that still hold for the developed picture: exposure, dates, lens, conditions.
/// Those that describe the stored pixels or the camera's own rendering are left out.
const EXIF_TAGS: [u16; 53] = [
    0x829a, 0x829d, 0x8822, 0x8827, 0x8830, 0x8831, 0x8832, 0x8833, 0x8834, 0x8835, 0x9003, 0x9004, 0x9010,
    0x9011, 0x9012, 0x9201, 0x9202, 0x9203, 0x9204, 0x9205, 0x9206, 0x9207, 0x9208, 0x9209, 0x920a, 0x9286,
    0x9290, 0x9291, 0x9292, 0x9400, 0x9401, 0x9402, 0x9403, 0x9404, 0x9405, 0xa217, 0xa300, 0xa301, 0xa402,
    0xa403, 0xa404, 0xa405, 0xa406, 0xa40c, 0xa420, 0xa430, 0xa431, 0xa432, 0xa433, 0xa434, 0xa435, 0xa460,
    0xa461,
];

/// No real text field is longer.
const MAX_TEXT: usize = 4096;
/// No field that is carried over is longer.
const MAX_VALUES: usize = 1024;

/// Reads the standard fields of the file itself, or of its embedded JPEG where the container is not TIFF.
pub(crate) fn read(bytes: &[u8], container: &Container<'_>, meta: &RawMetadata) -> Metadata {
    let block = if container.tiff.is_some() { Some(bytes) } else { embedded_jpeg(bytes, meta) };
    let Some(block) = block else { return Metadata::default() };
    let mut reader = Reader::new();
    reader.continue_on_error(true);
    let parsed = reader
        .read_from_container(&mut std::io::Cursor::new(block))
        .or_else(|e| e.distill_partial_result(|_| ()));
    // A file with no readable Exif develops all the same; its fields are then few.
    let Ok(parsed) = parsed else { return Metadata::default() };
    let mut metadata = Metadata::default();
    for field in parsed.fields().filter(|f| f.ifd_num == In::PRIMARY) {
        let number = field.tag.number();
        let directory = match field.tag.context() {
            Context::Tiff if IMAGE_TAGS.contains(&number) => Directory::Image,
            Context::Exif if EXIF_TAGS.contains(&number) => Directory::Exif,
            Context::Gps => Directory::Gps,
            _ => continue,
        };
        if let Some(value) = value(&field.value) {
            metadata.set(directory, number, value);
        }
    }
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

fn value(value: &ExifValue) -> Option<Value> {
    let value = match value {
        ExifValue::Ascii(lines) => {
            let lines = lines.iter().map(|l| String::from_utf8_lossy(l).trim_matches(['\0', ' ']).to_owned());
            let text = lines.filter(|l| !l.is_empty()).collect::<Vec<_>>().join("; ");
            return (!text.is_empty() && text.len() <= MAX_TEXT).then_some(Value::Text(text));
        }
        ExifValue::Byte(v) => Value::Bytes(v.clone()),
        ExifValue::Undefined(v, _) => Value::Undefined(v.clone()),
        ExifValue::Short(v) => Value::Shorts(v.clone()),
        ExifValue::Long(v) => Value::Longs(v.clone()),
        ExifValue::Rational(v) => Value::Rationals(v.iter().map(|r| (r.num, r.denom)).collect()),
        ExifValue::SRational(v) => Value::SignedRationals(v.iter().map(|r| (r.num, r.denom)).collect()),
        _ => return None,
    };
    let count = match &value {
        Value::Bytes(v) | Value::Undefined(v) => v.len(),
        Value::Shorts(v) => v.len(),
        Value::Longs(v) => v.len(),
        Value::Rationals(v) => v.len(),
        Value::SignedRationals(v) => v.len(),
        Value::Text(_) => 1,
    };
    (1..=MAX_VALUES).contains(&count).then_some(value)
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
