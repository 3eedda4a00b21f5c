//! Quantised coefficients to bits (T.81, F.1.2).

use super::tables::{Code, Kind};
use super::transform::Blocks;

/// Bits of a scan. After a byte of ones stands a zero, so that no code looks like a marker.
pub(super) struct Bits {
    bytes: Vec<u8>,
    /// Bits that are not in `bytes` yet, the last ones of this number, and how many: at most 32 between two calls.
    waiting: u64,
    count: u32,
}

impl Bits {
    pub(super) fn with_room_for(bytes: usize) -> Self {
        Self { bytes: Vec::with_capacity(bytes), waiting: 0, count: 0 }
    }

    /// Adds up to 32 bits.
    #[inline(always)]
    fn put(&mut self, bits: u32, count: u32) {
        self.waiting = self.waiting << count | u64::from(bits);
        self.count += count;
        if self.count > 32 {
            self.count -= 32;
            let four = (self.waiting >> self.count) as u32;
            // Only if all bits of a byte are set, adding 1 to each takes its highest one away; a carry from the byte below is
            // a byte of ones too.
            if four & !four.wrapping_add(0x0101_0101) & 0x8080_8080 == 0 {
                self.bytes.extend_from_slice(&four.to_be_bytes());
            } else {
                self.stuffed(four.to_be_bytes());
            }
        }
    }

    #[cold]
    fn stuffed(&mut self, bytes: [u8; 4]) {
        for byte in bytes {
            self.byte(byte);
        }
    }

    fn byte(&mut self, byte: u8) {
        self.bytes.push(byte);
        if byte == 0xff {
            self.bytes.push(0);
        }
    }

    /// Fills the last byte with ones; all bytes.
    pub(super) fn end(mut self) -> Vec<u8> {
        let fill = (8 - self.count % 8) % 8;
        self.waiting = self.waiting << fill | ((1 << fill) - 1);
        self.count += fill;
        for i in (0..self.count / 8).rev() {
            self.byte((self.waiting >> (8 * i)) as u8);
        }
        self.bytes
    }
}

/// Codes with how many bits they have and, in one number, the bits that follow: those of a value's size.
pub(super) struct Coder {
    mean: [(u32, u32); 16],
    others: [(u32, u32); 256],
}

impl Coder {
    pub(super) fn new(kind: Kind) -> Self {
        // The code stands before as many bits as its value says.
        let before = |code: &Code, value: usize| {
            let (bits, count) = code.of[value];
            let size = value as u32 & 15;
            (u32::from(bits) << size, u32::from(count) + size)
        };
        let (mean, others) = (kind.mean_code(), kind.code());
        Self {
            mean: std::array::from_fn(|value| before(&mean, value)),
            others: std::array::from_fn(|value| before(&others, value)),
        }
    }

    /// Adds one of eight blocks; `mean` is the first coefficient of the one before, and becomes that of this one.
    #[inline(always)]
    pub(super) fn put(&self, blocks: &Blocks, block: usize, mean: &mut i16, bits: &mut Bits) {
        const END: usize = 0x00;
        const SIXTEEN_ZEROS: usize = 0xf0;
        let first = blocks.coefficient(block, 0);
        let (size, low) = sized(i32::from(first) - i32::from(*mean));
        *mean = first;
        let (code, count) = self.mean[size as usize & 15];
        bits.put(code | low, count);

        let mut left = blocks.occupied(block) >> 1;
        let mut at = 0;
        while left != 0 {
            let mut zeros = left.trailing_zeros();
            at += zeros as usize + 1;
            left = left >> zeros >> 1;
            while zeros > 15 {
                let (code, count) = self.others[SIXTEEN_ZEROS];
                bits.put(code, count);
                zeros -= 16;
            }
            let (size, low) = sized(i32::from(blocks.coefficient(block, at)));
            let (code, count) = self.others[(zeros << 4 | size) as usize & 255];
            bits.put(code | low, count);
        }
        if at < 63 {
            let (code, count) = self.others[END];
            bits.put(code, count);
        }
    }
}

/// How many bits a number has, and these: one less where it is negative (T.81, F.1.2.1).
#[inline(always)]
fn sized(value: i32) -> (u32, u32) {
    let size = u32::BITS - value.unsigned_abs().leading_zeros();
    let low = (value + (value >> 31)) as u32 & ((1 << size) - 1);
    (size, low)
}
