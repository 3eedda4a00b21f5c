//! A field of a TIFF file that somebody else wrote: bytes of the first directory, such as its ICC profile.
//!
//! The decoder at hand turns each byte into a value of its own and gives up at profiles of some ten thousand bytes, which
//! those with tables have.

/// Most entries of a directory that are looked at.
const MOST_ENTRIES: u64 = 4096;

/// How a file writes numbers.
#[derive(Clone, Copy)]
struct Form {
    little: bool,
    /// Offsets and counts of 64 bits (BigTIFF).
    big: bool,
}

/// The bytes of a field of types BYTE, ASCII or UNDEFINED in the first directory (TIFF 6.0, section 2; BigTIFF); `None` where
/// the file is no TIFF, has no such field, or says that it lies outside of the file.
pub fn bytes_of(file: &[u8], tag: u16) -> Option<&[u8]> {
    let little = match file.get(..2)? {
        b"II" => true,
        b"MM" => false,
        _ => return None,
    };
    let form = Form { little, big: false };
    let form = match form.number(file, 2, 2)? {
        42 => form,
        43 => Form { big: true, ..form },
        _ => return None,
    };
    let (start, width) = if form.big { (form.number(file, 8, 8)?, 8) } else { (form.number(file, 4, 4)?, 2) };
    let (entry, inline) = if form.big { (20, 8) } else { (12, 4) };
    let count = form.number(file, usize::try_from(start).ok()?, width)?.min(MOST_ENTRIES);
    let first = usize::try_from(start).ok()?.checked_add(width)?;
    for i in 0..usize::try_from(count).ok()? {
        let at = first.checked_add(i.checked_mul(entry)?)?;
        if form.number(file, at, 2)? != u64::from(tag) {
            continue;
        }
        if !matches!(form.number(file, at + 2, 2)?, 1 | 2 | 7) {
            return None;
        }
        let length = usize::try_from(form.number(file, at + 4, inline)?).ok()?;
        let value = at + 4 + inline;
        let from =
            if length <= inline { value } else { usize::try_from(form.number(file, value, inline)?).ok()? };
        return file.get(from..from.checked_add(length)?);
    }
    None
}

impl Form {
    /// An unsigned number of `width` bytes.
    fn number(self, file: &[u8], at: usize, width: usize) -> Option<u64> {
        let bytes = file.get(at..at.checked_add(width)?)?;
        let join = |all: u64, byte: &u8| all << 8 | u64::from(*byte);
        Some(if self.little { bytes.iter().rev().fold(0, join) } else { bytes.iter().fold(0, join) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Format;
    use crate::testing::{encoded, metadata, picture};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::PictureSpace;

    #[test]
    fn the_profile_of_a_tiff_is_found() {
        let picture = picture(20, 10, 16, PictureSpace::Rgb(RgbSpace::ECIRGB_V2));
        let file = encoded(&picture, Format::Tiff, &metadata()).unwrap();
        assert_eq!(bytes_of(&file, 0x8773), Some(&crate::icc::profile(&RgbSpace::ECIRGB_V2)[..]));
        assert_eq!(bytes_of(&file, 0x8774), None);
        for length in 0..file.len() {
            let _ = bytes_of(&file[..length], 0x8773);
        }
    }

    #[test]
    fn big_endian_and_bigtiff_are_read_and_lies_are_not_followed() {
        // One entry: tag 700, UNDEFINED, four bytes in place.
        let motorola = b"MM\0\x2a\0\0\0\x08\0\x01\x02\xbc\0\x07\0\0\0\x04abcd\0\0\0\0";
        assert_eq!(bytes_of(motorola, 700), Some(&b"abcd"[..]));
        let mut big = b"II\x2b\0\x08\0\0\0\x10\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0\xbc\x02\x01\0".to_vec();
        big.extend(3u64.to_le_bytes());
        big.extend(b"xyz\0\0\0\0\0");
        assert_eq!(bytes_of(&big, 700), Some(&b"xyz"[..]));
        let far = b"MM\0\x2a\0\0\0\x08\0\x01\x02\xbc\0\x07\xff\xff\xff\xff\xff\xff\xff\xf0\0\0\0\0";
        assert_eq!(bytes_of(far, 700), None);
        assert_eq!(bytes_of(b"MM\0\x2a\xff\xff\xff\xff", 700), None);
    }
}
