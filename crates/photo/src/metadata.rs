//! What the camera wrote about the shot, as Exif fields.

use serde::{Deserialize, Serialize};

/// The directory that a field belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Directory {
    /// Primary image (IFD0): make, model, artist, copyright, ...
    Image,
    /// Exif: exposure, lens, dates, ...
    Exif,
    /// GPS: position.
    Gps,
}

/// Value of a field, in the types of Exif 2.32.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// Text (Exif ASCII; UTF-8 is kept as it is), without the closing zero.
    Text(String),
    /// Unsigned bytes.
    Bytes(Vec<u8>),
    /// Bytes whose meaning the tag defines.
    Undefined(Vec<u8>),
    /// 16-bit numbers.
    Shorts(Vec<u16>),
    /// 32-bit numbers.
    Longs(Vec<u32>),
    /// Fractions, numerator and denominator.
    Rationals(Vec<(u32, u32)>),
    /// Signed fractions, numerator and denominator.
    SignedRationals(Vec<(i32, i32)>),
}

/// One Exif field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Directory it belongs to.
    pub directory: Directory,
    /// Tag number.
    pub tag: u16,
    /// Its value.
    pub value: Value,
}

/// Exif fields of a shot, each tag of a directory at most once, sorted.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Metadata {
    fields: Vec<Field>,
}

impl Metadata {
    /// All fields, sorted by directory and tag.
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Sets a field, in place of any there was.
    pub fn set(&mut self, directory: Directory, tag: u16, value: Value) {
        let field = Field { directory, tag, value };
        match self.fields.binary_search_by_key(&(directory, tag), |f| (f.directory, f.tag)) {
            Ok(i) => self.fields[i] = field,
            Err(i) => self.fields.insert(i, field),
        }
    }

    /// Keeps the fields that `wanted` says.
    pub fn retain(&mut self, wanted: impl FnMut(&Field) -> bool) {
        self.fields.retain(wanted);
    }

    /// Value of a field.
    pub fn get(&self, directory: Directory, tag: u16) -> Option<&Value> {
        let found = self.fields.binary_search_by_key(&(directory, tag), |f| (f.directory, f.tag));
        found.ok().map(|i| &self.fields[i].value)
    }

    /// Text of a field, trimmed; `None` when there is none or it is empty.
    pub fn text(&self, directory: Directory, tag: u16) -> Option<&str> {
        match self.get(directory, tag)? {
            Value::Text(text) => Some(text.trim()).filter(|t| !t.is_empty()),
            _ => None,
        }
    }

    /// Bytes of a field that is made of them.
    pub fn bytes(&self, directory: Directory, tag: u16) -> Option<&[u8]> {
        match self.get(directory, tag)? {
            Value::Bytes(bytes) | Value::Undefined(bytes) => Some(bytes),
            _ => None,
        }
    }

    /// First number of a field, whatever its type.
    pub fn number(&self, directory: Directory, tag: u16) -> Option<f64> {
        let ratio = |n: f64, d: f64| (d != 0.0).then(|| n / d);
        match self.get(directory, tag)? {
            Value::Shorts(v) => v.first().map(|&n| f64::from(n)),
            Value::Longs(v) => v.first().map(|&n| f64::from(n)),
            Value::Rationals(v) => v.first().and_then(|&(n, d)| ratio(f64::from(n), f64::from(d))),
            Value::SignedRationals(v) => v.first().and_then(|&(n, d)| ratio(f64::from(n), f64::from(d))),
            Value::Bytes(v) => v.first().map(|&n| f64::from(n)),
            Value::Text(_) | Value::Undefined(_) => None,
        }
    }
}

/// Tag numbers of Exif 2.32 that Darkroot names.
pub mod tag {
    /// Image: maker of the camera.
    pub const MAKE: u16 = 0x010f;
    /// Image: camera model.
    pub const MODEL: u16 = 0x0110;
    /// Image: pixels across one unit of length, and down.
    pub const RESOLUTION: [u16; 2] = [0x011a, 0x011b];
    /// Image: that unit (2 = inch).
    pub const RESOLUTION_UNIT: u16 = 0x0128;
    /// Image: orientation.
    pub const ORIENTATION: u16 = 0x0112;
    /// Image: software that wrote the file.
    pub const SOFTWARE: u16 = 0x0131;
    /// A packet of XMP, as bytes (XMP specification, part 3, 3.2.3.2: TIFF).
    pub const XMP: u16 = 0x02bc;
    /// Image: what is seen, in words.
    pub const IMAGE_DESCRIPTION: u16 = 0x010e;
    /// Image: stars, 0 to 5, and the same in percent.
    pub const RATING: [u16; 2] = [0x4746, 0x4749];
    /// A block of IPTC-IIM, as bytes.
    pub const IPTC: u16 = 0x83bb;
    /// Image: date and time of the last change.
    pub const DATE_TIME: u16 = 0x0132;
    /// Image: photographer.
    pub const ARTIST: u16 = 0x013b;
    /// Image: copyright notice.
    pub const COPYRIGHT: u16 = 0x8298;
    /// Exif: exposure time, s.
    pub const EXPOSURE_TIME: u16 = 0x829a;
    /// Exif: f-number.
    pub const F_NUMBER: u16 = 0x829d;
    /// Exif: ISO speed.
    pub const ISO: u16 = 0x8827;
    /// Exif: date and time of the shot.
    pub const DATE_TIME_ORIGINAL: u16 = 0x9003;
    /// Exif: colour space of the picture (1 = sRGB, 65535 = other).
    pub const COLOUR_SPACE: u16 = 0xa001;
    /// Exif: distance of the subject, m.
    pub const SUBJECT_DISTANCE: u16 = 0x9206;
    /// Exif: focal length, mm.
    pub const FOCAL_LENGTH: u16 = 0x920a;
    /// Exif: serial number of the camera, and of the lens.
    pub const SERIAL_NUMBERS: [u16; 2] = [0xa431, 0xa435];
    /// Exif: owner of the camera.
    pub const OWNER: u16 = 0xa430;
    /// Exif: number of this photograph, as hexadecimal digits.
    pub const UNIQUE_ID: u16 = 0xa420;
    /// Exif: lens specification.
    pub const LENS_SPECIFICATION: u16 = 0xa432;
    /// Exif: lens maker.
    pub const LENS_MAKE: u16 = 0xa433;
    /// Exif: lens model.
    pub const LENS_MODEL: u16 = 0xa434;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_that_is_set_twice_has_the_second_value() {
        let mut metadata = Metadata::default();
        metadata.set(Directory::Exif, tag::ISO, Value::Shorts(vec![100]));
        metadata.set(Directory::Image, tag::MAKE, Value::Text("Darkroot ".into()));
        metadata.set(Directory::Exif, tag::ISO, Value::Shorts(vec![200]));
        assert_eq!(metadata.fields().len(), 2);
        assert_eq!(metadata.number(Directory::Exif, tag::ISO), Some(200.0));
        assert_eq!(metadata.text(Directory::Image, tag::MAKE), Some("Darkroot"));
    }
}
