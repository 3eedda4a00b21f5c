//! Writing numbers of any width, most significant bit first.

/// Bytes being filled from the top bit down.
#[derive(Debug, Clone, Default)]
pub struct Bits {
    bytes: Vec<u8>,
    pending: u64,
    count: u32,
}

impl Bits {
    /// Appends the low `width` bits of `value`; `width` is at most 32.
    pub fn push(&mut self, value: u32, width: u32) {
        let mask = (1u64 << width) - 1;
        self.pending = (self.pending << width) | (u64::from(value) & mask);
        self.count += width;
        while self.count >= 8 {
            self.count -= 8;
            self.bytes.push((self.pending >> self.count) as u8);
        }
    }

    /// The bytes, the last one filled up with `fill` bits.
    pub fn finish(mut self, fill: bool) -> Vec<u8> {
        let rest = (8 - self.count % 8) % 8;
        self.push(if fill { u32::MAX } else { 0 }, rest);
        self.bytes
    }
}

/// Category and extra bits of a prediction error, as JPEG codes it (ITU-T T.81, F.1.2.1 and H.1.2.2): the number
/// of bits of its size, and those bits, of the error less 1 when it is negative.
pub fn category(error: i32) -> (u8, u32) {
    let bits = 32 - error.unsigned_abs().leading_zeros();
    let extra = if error < 0 { (error - 1) as u32 } else { error as u32 };
    (bits as u8, extra & ((1 << bits) - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_packed_from_the_top_bit_down() {
        let mut bits = Bits::default();
        bits.push(0xabc, 12);
        bits.push(0x1, 2);
        assert_eq!(bits.finish(true), [0xab, 0xc7]);
    }

    #[test]
    fn categories_are_those_of_the_standard() {
        for (error, expected) in [(0, (0, 0)), (1, (1, 1)), (-1, (1, 0)), (-5, (3, 2)), (5, (3, 5))] {
            assert_eq!(category(error), expected);
        }
    }
}
