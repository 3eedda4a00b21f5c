//! The tables of a baseline JPEG: how coarsely coefficients are stored, and the codes for what is stored. The numbers are
//! those that ITU-T T.81 gives as examples in its annex K, and that nearly every JPEG has.

/// Where the coefficients of a block stand in its scan: the k-th of them has this index, rows of rising vertical frequency
/// (T.81, figure A.6).
pub(super) const ZIGZAG: [u8; 64] = {
    let mut order = [0; 64];
    let (mut x, mut y, mut k) = (0i32, 0i32, 0);
    let mut up = true;
    while k < 64 {
        order[k] = (8 * y + x) as u8;
        k += 1;
        match (up, x, y) {
            (true, 7, _) => (y, up) = (y + 1, false),
            (true, _, 0) => (x, up) = (x + 1, false),
            (true, ..) => (x, y) = (x + 1, y - 1),
            (false, _, 7) => (x, up) = (x + 1, true),
            (false, 0, _) => (y, up) = (y + 1, true),
            (false, ..) => (x, y) = (x - 1, y + 1),
        }
    }
    order
};

/// Steps of the coefficients of lightness at quality 50 (T.81, table K.1).
const LUMINANCE: [u16; 64] = [
    16, 11, 10, 16, 24, 40, 51, 61, //
    12, 12, 14, 19, 26, 58, 60, 55, //
    14, 13, 16, 24, 40, 57, 69, 56, //
    14, 17, 22, 29, 51, 87, 80, 62, //
    18, 22, 37, 56, 68, 109, 103, 77, //
    24, 35, 55, 64, 81, 104, 113, 92, //
    49, 64, 78, 87, 103, 121, 120, 101, //
    72, 92, 95, 98, 112, 100, 103, 99,
];

/// Those of the two colour differences (T.81, table K.2).
const CHROMINANCE: [u16; 64] = [
    17, 18, 24, 47, 99, 99, 99, 99, //
    18, 21, 26, 66, 99, 99, 99, 99, //
    24, 26, 56, 99, 99, 99, 99, 99, //
    47, 66, 99, 99, 99, 99, 99, 99, //
    99, 99, 99, 99, 99, 99, 99, 99, //
    99, 99, 99, 99, 99, 99, 99, 99, //
    99, 99, 99, 99, 99, 99, 99, 99, //
    99, 99, 99, 99, 99, 99, 99, 99,
];

/// What the components of a picture are, for their tables.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Luminance,
    Chrominance,
}

impl Kind {
    pub(super) const BOTH: [Self; 2] = [Self::Luminance, Self::Chrominance];

    /// The steps of 64 coefficients, rows of rising vertical frequency, at a quality of 1 to 100: those of the standard,
    /// made finer or coarser as the library of the Independent JPEG Group does it.
    pub(super) fn steps(self, quality: u8) -> [u8; 64] {
        let quality = u32::from(quality.clamp(1, 100));
        let percent = if quality < 50 { 5000 / quality } else { 200 - 2 * quality };
        let table = match self {
            Self::Luminance => LUMINANCE,
            Self::Chrominance => CHROMINANCE,
        };
        table.map(|step| ((u32::from(step) * percent + 50) / 100).clamp(1, 255) as u8)
    }

    /// The code of how many bits the difference of two neighbouring means has (T.81, tables K.3 and K.4).
    pub(super) fn mean_code(self) -> Code {
        match self {
            Self::Luminance => Code::new([0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0], MEAN_VALUES),
            Self::Chrominance => Code::new([0, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0], MEAN_VALUES),
        }
    }

    /// The code of the other coefficients: zeros before one (high four bits), and the bits that it has (T.81, tables K.5 and
    /// K.6).
    pub(super) fn code(self) -> Code {
        match self {
            Self::Luminance => {
                Code::new([0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 125], LUMINANCE_VALUES)
            }
            Self::Chrominance => {
                Code::new([0, 2, 1, 2, 4, 4, 3, 4, 7, 5, 4, 4, 0, 1, 2, 119], CHROMINANCE_VALUES)
            }
        }
    }
}

const MEAN_VALUES: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];

const LUMINANCE_VALUES: &[u8] = &[
    0x01, 0x02, 0x03, 0x00, 0x04, 0x11, 0x05, 0x12, 0x21, 0x31, 0x41, 0x06, 0x13, 0x51, 0x61, 0x07, 0x22,
    0x71, 0x14, 0x32, 0x81, 0x91, 0xa1, 0x08, 0x23, 0x42, 0xb1, 0xc1, 0x15, 0x52, 0xd1, 0xf0, 0x24, 0x33,
    0x62, 0x72, 0x82, 0x09, 0x0a, 0x16, 0x17, 0x18, 0x19, 0x1a, 0x25, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x34,
    0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45, 0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55,
    0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64, 0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76,
    0x77, 0x78, 0x79, 0x7a, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96,
    0x97, 0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5,
    0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3, 0xd4,
    0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe1, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9, 0xea, 0xf1,
    0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa,
];

const CHROMINANCE_VALUES: &[u8] = &[
    0x00, 0x01, 0x02, 0x03, 0x11, 0x04, 0x05, 0x21, 0x31, 0x06, 0x12, 0x41, 0x51, 0x07, 0x61, 0x71, 0x13,
    0x22, 0x32, 0x81, 0x08, 0x14, 0x42, 0x91, 0xa1, 0xb1, 0xc1, 0x09, 0x23, 0x33, 0x52, 0xf0, 0x15, 0x62,
    0x72, 0xd1, 0x0a, 0x16, 0x24, 0x34, 0xe1, 0x25, 0xf1, 0x17, 0x18, 0x19, 0x1a, 0x26, 0x27, 0x28, 0x29,
    0x2a, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45, 0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54,
    0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64, 0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75,
    0x76, 0x77, 0x78, 0x79, 0x7a, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94,
    0x95, 0x96, 0x97, 0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3,
    0xb4, 0xb5, 0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2,
    0xd3, 0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9, 0xea,
    0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa,
];

/// A Huffman code.
pub(super) struct Code {
    /// Values with a code of 1, 2 ... 16 bits.
    pub(super) lengths: [u8; 16],
    /// The values, those with the shortest codes first.
    pub(super) values: &'static [u8],
    /// Code of each value and how many bits it has; none has 0.
    pub(super) of: [(u16, u8); 256],
}

impl Code {
    /// Codes of one length follow each other; the first of the next length is the next one with a 0 behind it (T.81,
    /// C.2).
    fn new(lengths: [u8; 16], values: &'static [u8]) -> Self {
        let mut of = [(0, 0); 256];
        let mut values_left = values.iter();
        let mut code = 0;
        for (bits, &count) in (1..).zip(&lengths) {
            for &value in values_left.by_ref().take(usize::from(count)) {
                of[usize::from(value)] = (code, bits);
                code += 1;
            }
            code <<= 1;
        }
        Self { lengths, values, of }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scan_begins_and_ends_as_in_the_standard() {
        assert_eq!(ZIGZAG[..10], [0, 1, 8, 16, 9, 2, 3, 10, 17, 24]);
        assert_eq!(ZIGZAG[58..], [53, 60, 61, 54, 47, 55, 62, 63][2..]);
        let mut all = ZIGZAG;
        all.sort_unstable();
        assert!(all.iter().enumerate().all(|(i, &v)| i == usize::from(v)));
    }

    #[test]
    fn quality_50_has_the_steps_of_the_standard_and_100_none() {
        for kind in Kind::BOTH {
            assert_eq!(kind.steps(50)[63], [99, 99][kind as usize]);
            assert_eq!(kind.steps(50)[0], [16, 17][kind as usize]);
            assert_eq!(kind.steps(100), [1; 64]);
            assert_eq!(kind.steps(1), [255; 64]);
        }
    }

    #[test]
    fn every_value_has_a_code_that_is_the_beginning_of_no_other_and_not_all_ones() {
        for kind in Kind::BOTH {
            for code in [kind.mean_code(), kind.code()] {
                assert_eq!(code.lengths.iter().map(|&n| usize::from(n)).sum::<usize>(), code.values.len());
                let codes: Vec<(u16, u8)> = code.values.iter().map(|&v| code.of[usize::from(v)]).collect();
                for (i, &(a, bits)) in codes.iter().enumerate() {
                    assert!(u32::from(a) + 1 < 1 << bits);
                    for &(b, longer) in &codes[i + 1..] {
                        assert!(longer >= bits && b >> (longer - bits) != a);
                    }
                }
            }
        }
    }
}
