//! TIFF structure (TIFF 6.0, little-endian): directories with their values first, picture data last.

use darkroot_photo::metadata::{Field, Value};

/// Type numbers of TIFF 6.0, section 2.
mod kind {
    pub(super) const BYTE: u16 = 1;
    pub(super) const ASCII: u16 = 2;
    pub(super) const SHORT: u16 = 3;
    pub(super) const LONG: u16 = 4;
    pub(super) const RATIONAL: u16 = 5;
    pub(super) const UNDEFINED: u16 = 7;
    pub(super) const SIGNED_SHORT: u16 = 8;
    pub(super) const SIGNED_RATIONAL: u16 = 10;
    pub(super) const FLOAT: u16 = 11;
}

/// An image file directory to be written.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ifd {
    entries: Vec<(u16, Entry)>,
}

#[derive(Debug, Clone)]
enum Entry {
    Value(Value),
    /// Signed numbers of 16 bits.
    SignedShorts(Vec<i16>),
    /// Numbers of 32 bits with a floating point.
    Floats(Vec<f32>),
    Directories(Vec<Ifd>),
    /// Offsets of pieces of picture data; the second number is the tag of their lengths.
    Pieces(Vec<Vec<u8>>),
}

impl Ifd {
    /// Adds any value, in place of one with the same tag.
    pub(crate) fn put(&mut self, tag: u16, value: Value) -> &mut Self {
        self.insert(tag, Entry::Value(value))
    }

    /// Adds text.
    pub(crate) fn text(&mut self, tag: u16, text: &str) -> &mut Self {
        self.put(tag, Value::Text(text.to_owned()))
    }

    /// Adds 16-bit numbers.
    pub(crate) fn shorts(&mut self, tag: u16, numbers: &[u16]) -> &mut Self {
        self.put(tag, Value::Shorts(numbers.to_vec()))
    }

    /// Adds signed 16-bit numbers, which only makers' notes have.
    pub(crate) fn signed_shorts(&mut self, tag: u16, numbers: &[i16]) -> &mut Self {
        self.insert(tag, Entry::SignedShorts(numbers.to_vec()))
    }

    /// Adds 32-bit numbers with a floating point, which only makers' notes have.
    pub(crate) fn floats(&mut self, tag: u16, numbers: &[f32]) -> &mut Self {
        self.insert(tag, Entry::Floats(numbers.to_vec()))
    }

    /// Adds sizes as 32-bit numbers; no picture of this crate comes near the limit.
    pub(crate) fn longs(&mut self, tag: u16, numbers: &[usize]) -> &mut Self {
        self.put(tag, Value::Longs(numbers.iter().map(|&n| n as u32).collect()))
    }

    /// Adds unsigned fractions with six decimals at most.
    pub(crate) fn fractions(&mut self, tag: u16, numbers: &[f64]) -> &mut Self {
        let fraction = |&n: &f64| fraction(n).map(|i| i.max(0) as u32).into();
        self.put(tag, Value::Rationals(numbers.iter().map(fraction).collect()))
    }

    /// Adds signed fractions with six decimals at most.
    pub(crate) fn signed_fractions(&mut self, tag: u16, numbers: &[f64]) -> &mut Self {
        self.put(tag, Value::SignedRationals(numbers.iter().map(|&n| fraction(n).into()).collect()))
    }

    /// Adds Exif fields as they are.
    pub(crate) fn fields<'a>(&mut self, fields: impl Iterator<Item = &'a Field>) -> &mut Self {
        for field in fields {
            self.put(field.tag, field.value.clone());
        }
        self
    }

    /// Adds directories below this one.
    pub(crate) fn directories(&mut self, tag: u16, directories: Vec<Self>) -> &mut Self {
        self.insert(tag, Entry::Directories(directories))
    }

    /// Adds strips or tiles: `offsets` and `lengths` are the tags that point at them.
    pub(crate) fn pieces(&mut self, offsets: u16, lengths: u16, pieces: Vec<Vec<u8>>) -> &mut Self {
        let sizes: Vec<usize> = pieces.iter().map(Vec::len).collect();
        self.longs(lengths, &sizes).insert(offsets, Entry::Pieces(pieces))
    }

    fn insert(&mut self, tag: u16, entry: Entry) -> &mut Self {
        match self.entries.binary_search_by_key(&tag, |(tag, _)| *tag) {
            Ok(i) => self.entries[i] = (tag, entry),
            Err(i) => self.entries.insert(i, (tag, entry)),
        }
        self
    }
}

/// `n` as a fraction of powers of ten, exact to a millionth.
fn fraction(n: f64) -> [i32; 2] {
    [1, 10, 100, 1000, 10_000, 100_000]
        .into_iter()
        .map(|d| (n * f64::from(d), d))
        .find(|(n, _)| (n - n.round()).abs() < 1e-9)
        .map_or([(n * 1e6).round() as i32, 1_000_000], |(n, d)| [n.round() as i32, d])
}

/// A whole file with one chain of one directory.
pub(crate) fn file(root: &Ifd) -> Vec<u8> {
    after(b"II*\0\x08\0\0\0", root)
}

/// A directory, and all that it points to, after these bytes, from whose beginning offsets count.
pub(crate) fn after(head: &[u8], root: &Ifd) -> Vec<u8> {
    let mut out = Out { bytes: head.to_vec(), pieces: Vec::new() };
    out.directory(root);
    for (patch, piece) in std::mem::take(&mut out.pieces) {
        out.align();
        out.point(patch);
        out.bytes.extend_from_slice(piece);
    }
    out.bytes
}

struct Out<'a> {
    bytes: Vec<u8>,
    /// Data still to come, and the places where its offsets go.
    pieces: Vec<(usize, &'a [u8])>,
}

impl<'a> Out<'a> {
    /// Writes `ifd` at the end and returns its offset.
    fn directory(&mut self, ifd: &'a Ifd) -> u32 {
        self.align();
        let start = self.bytes.len();
        let count = ifd.entries.len();
        self.bytes.extend_from_slice(&(count as u16).to_le_bytes());
        self.bytes.resize(start + 2 + 12 * count + 4, 0);
        for (i, (tag, entry)) in ifd.entries.iter().enumerate() {
            let place = start + 2 + 12 * i;
            let (kind, count, bytes) = match entry {
                Entry::Value(value) => encode(value),
                Entry::SignedShorts(v) => {
                    (kind::SIGNED_SHORT, v.len(), v.iter().flat_map(|n| n.to_le_bytes()).collect())
                }
                Entry::Floats(v) => (kind::FLOAT, v.len(), v.iter().flat_map(|n| n.to_le_bytes()).collect()),
                Entry::Directories(below) => {
                    let offsets: Vec<u8> =
                        below.iter().flat_map(|ifd| self.directory(ifd).to_le_bytes()).collect();
                    (kind::LONG, below.len(), offsets)
                }
                Entry::Pieces(pieces) => (kind::LONG, pieces.len(), vec![0; 4 * pieces.len()]),
            };
            self.set(place, &tag.to_le_bytes());
            self.set(place + 2, &kind.to_le_bytes());
            self.set(place + 4, &(count as u32).to_le_bytes());
            let mut values_at = place + 8;
            if bytes.len() <= 4 {
                self.set(values_at, &bytes);
            } else {
                self.align();
                self.point(values_at);
                values_at = self.bytes.len();
                self.bytes.extend_from_slice(&bytes);
            }
            if let Entry::Pieces(pieces) = entry {
                let places = pieces.iter().enumerate().map(|(i, p)| (values_at + 4 * i, p.as_slice()));
                self.pieces.extend(places);
            }
        }
        start as u32
    }

    /// Offsets must be even (TIFF 6.0, section 2).
    fn align(&mut self) {
        self.bytes.resize(self.bytes.len().next_multiple_of(2), 0);
    }

    /// Writes the offset of the end at `place`.
    fn point(&mut self, place: usize) {
        let end = (self.bytes.len() as u32).to_le_bytes();
        self.set(place, &end);
    }

    fn set(&mut self, place: usize, bytes: &[u8]) {
        self.bytes[place..place + bytes.len()].copy_from_slice(bytes);
    }
}

/// Type, count and bytes of a value.
fn encode(value: &Value) -> (u16, usize, Vec<u8>) {
    match value {
        Value::Text(text) => (kind::ASCII, text.len() + 1, [text.as_bytes(), b"\0"].concat()),
        Value::Bytes(v) => (kind::BYTE, v.len(), v.clone()),
        Value::Undefined(v) => (kind::UNDEFINED, v.len(), v.clone()),
        Value::Shorts(v) => (kind::SHORT, v.len(), v.iter().flat_map(|n| n.to_le_bytes()).collect()),
        Value::Longs(v) => (kind::LONG, v.len(), v.iter().flat_map(|n| n.to_le_bytes()).collect()),
        Value::Rationals(v) => {
            let bytes = v.iter().flat_map(|(n, d)| [n.to_le_bytes(), d.to_le_bytes()].concat());
            (kind::RATIONAL, v.len(), bytes.collect())
        }
        Value::SignedRationals(v) => {
            let bytes = v.iter().flat_map(|(n, d)| [n.to_le_bytes(), d.to_le_bytes()].concat());
            (kind::SIGNED_RATIONAL, v.len(), bytes.collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fraction_is_exact_to_a_millionth() {
        assert_eq!(fraction(0.5), [5, 10]);
        assert_eq!(fraction(-3.0), [-3, 1]);
        assert_eq!(fraction(1.0 / 3.0), [333_333, 1_000_000]);
    }

    #[test]
    fn data_lies_behind_the_directories_at_even_offsets() {
        let mut ifd = Ifd::default();
        ifd.text(0x010f, "odd").pieces(0x0111, 0x0117, vec![vec![1, 2, 3], vec![4]]);
        let bytes = file(&ifd);
        let offset = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let offsets = offset(10 + 12 + 8);
        assert_eq!(bytes[offset(offsets)], 1);
        assert_eq!(bytes[offset(offsets + 4)], 4);
        assert!(offset(offsets + 4).is_multiple_of(2));
    }
}
