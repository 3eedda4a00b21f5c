//! The size header of a JPEG XL (ISO/IEC 18181-1, D.2, and the boxes of 18181-2), without decoding any of it.

/// Samples of a JPEG XL of three colours, as large as it says that it is; `None` for bytes that are none.
pub(crate) fn most_samples(jxl: &[u8]) -> Option<u64> {
    let mut bits = Bits { bytes: codestream(jxl)?.strip_prefix(&[0xff, 0x0a])?, at: 0 };
    let by_eight = bits.take(1)? == 1;
    let height = bits.side(by_eight)?;
    let width = match bits.take(3)? {
        0 => bits.side(by_eight)?,
        1 => height,
        2 => height * 12 / 10,
        3 => height * 4 / 3,
        4 => height * 3 / 2,
        5 => height * 16 / 9,
        6 => height * 5 / 4,
        _ => height * 2,
    };
    Some(3 * width * height)
}

/// The codestream: all of it, or what the first box of one holds.
fn codestream(jxl: &[u8]) -> Option<&[u8]> {
    let Some(mut boxes) = jxl.strip_prefix(b"\0\0\0\x0cJXL \r\n\x87\n") else { return Some(jxl) };
    loop {
        let &[s3, s2, s1, s0, a, b, c, d, ref content @ ..] = boxes else { return None };
        match &[a, b, c, d] {
            b"jxlc" => return Some(content),
            b"jxlp" => return content.get(4..),
            _ => boxes = boxes.get((u32::from_be_bytes([s3, s2, s1, s0]) as usize).max(8)..)?,
        }
    }
}

/// Bits, the lowest of each byte first.
struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Bits<'_> {
    fn take(&mut self, count: usize) -> Option<u64> {
        let mut value = 0;
        for i in 0..count {
            let byte = *self.bytes.get(self.at / 8)?;
            value |= u64::from(byte >> (self.at % 8) & 1) << i;
            self.at += 1;
        }
        Some(value)
    }

    /// A width or a height.
    fn side(&mut self, by_eight: bool) -> Option<u64> {
        if by_eight {
            return Some(8 * (self.take(5)? + 1));
        }
        let bits = [9, 13, 18, 30][self.take(2)? as usize];
        Some(self.take(bits)? + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A codestream of these numbers, each with its number of bits.
    fn stream(numbers: &[(u64, usize)]) -> Vec<u8> {
        let bits: Vec<u8> =
            numbers.iter().flat_map(|(n, c)| (0..*c).map(move |i| (n >> i & 1) as u8)).collect();
        let bytes = bits.chunks(8).map(|b| b.iter().enumerate().map(|(i, bit)| bit << i).sum::<u8>());
        [0xff, 0x0a].into_iter().chain(bytes).collect()
    }

    #[test]
    fn sizes_of_every_kind_are_read() {
        assert_eq!(most_samples(&stream(&[(1, 1), (31, 5), (0, 3), (3, 5)])), Some(3 * 256 * 32));
        assert_eq!(most_samples(&stream(&[(1, 1), (31, 5), (7, 3)])), Some(3 * 256 * 512));
        let odd = [(0, 1), (0, 2), (299, 9), (0, 3), (1, 2), (3999, 13)];
        assert_eq!(most_samples(&stream(&odd)), Some(3 * 300 * 4000));
        let largest = (1 << 30) - 1;
        let large = stream(&[(0, 1), (3, 2), (largest, 30), (1, 3)]);
        assert_eq!(most_samples(&large), Some(3 << 60));
        for length in 0..6 {
            assert_eq!(most_samples(&large[..length]), None);
        }
        assert_eq!(most_samples(b"\xff\xd8\xff"), None);
    }

    #[test]
    fn a_box_of_the_container_holds_the_stream() {
        let inside = stream(&[(1, 1), (31, 5), (1, 3)]);
        let other = b"\0\0\0\x0cftypjxl ";
        for kind in [&b"\0\0\0\0jxlc"[..], b"\0\0\0\0jxlp\0\0\0\0"] {
            let container = [b"\0\0\0\x0cJXL \r\n\x87\n", &other[..], kind, &inside].concat();
            assert_eq!(most_samples(&container), Some(3 * 256 * 256));
        }
    }
}
