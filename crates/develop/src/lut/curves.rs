//! A table for each channel, straight between its entries.

use super::alike;

/// A table for each channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    entries: Entries,
    /// One table for all three channels, or three.
    tables: Vec<Vec<f32>>,
}

/// Which values the entries of a table stand for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Entries {
    /// Even steps over a range of each channel.
    Even {
        /// Values of the first entries.
        least: [f32; 3],
        /// Values of the last entries.
        most: [f32; 3],
    },
    /// Every number of half precision, by its bits (IEEE 754 binary16): 65,536 entries.
    Halves,
}

impl Entries {
    /// Even steps from 0 to 1.
    pub const UNIT: Self = Self::Even { least: [0.0; 3], most: [1.0; 3] };
}

/// Bits of the greatest finite half.
const GREATEST: u32 = 0x7bff;
/// Bit of the sign of a half.
const NEGATIVE: u32 = 0x8000;

impl Curves {
    /// Entries that a table may have.
    pub const SIZES: std::ops::RangeInclusive<usize> = 2..=1 << 20;

    /// One table for all channels or three of one length; `None` where their number, the range or a value is none. Of a table
    /// over halves, entries for what is no number count as 0.
    pub fn new(entries: Entries, mut tables: Vec<Vec<f32>>) -> Option<Self> {
        let length = tables.first()?.len();
        if entries == Entries::Halves {
            // Infinity and what is no number are not asked for.
            for v in tables.iter_mut().flatten().filter(|v| !v.is_finite()) {
                *v = 0.0;
            }
        }
        let fits = match entries {
            Entries::Even { least, most } => {
                (0..3).all(|c| least[c] < most[c] && (most[c] - least[c]).is_finite())
            }
            Entries::Halves => length == 1 << 16,
        };
        let alike = matches!(tables.len(), 1 | 3) && tables.iter().all(|t| t.len() == length);
        let finite = tables.iter().flatten().all(|v| v.is_finite());
        (fits && alike && finite && Self::SIZES.contains(&length)).then_some(Self { entries, tables })
    }

    /// Whether the three channels get the same.
    pub(super) fn are_alike(&self) -> bool {
        let tables = self.tables.iter().all(|t| *t == self.tables[0]);
        tables
            && match self.entries {
                Entries::Even { least, most } => alike(least) && alike(most),
                Entries::Halves => true,
            }
    }

    /// What stands for three channels; beyond a range, what stands at its end.
    #[inline]
    pub fn at(&self, v: [f32; 3]) -> [f32; 3] {
        [0, 1, 2].map(|c| {
            let table = &self.tables[c.min(self.tables.len() - 1)];
            match self.entries {
                Entries::Even { least, most } => {
                    let last = table.len() - 1;
                    let place = (v[c] - least[c]) / (most[c] - least[c]) * last as f32;
                    let place = if place > 0.0 { place.min(last as f32) } else { 0.0 };
                    let i = (place as usize).min(last - 1);
                    table[i] + (place - i as f32) * (table[i + 1] - table[i])
                }
                Entries::Halves => {
                    let sign = if v[c] < 0.0 { NEGATIVE } else { 0 };
                    let (i, part) = half_below(v[c].abs());
                    let (low, high) =
                        (table[(sign + i) as usize], table[(sign + (i + 1).min(GREATEST)) as usize]);
                    low + part * (high - low)
                }
            }
        })
    }
}

/// Bits of the greatest half that is not more than a number of at least 0, and how far the number is on the way to the next.
fn half_below(v: f32) -> (u32, f32) {
    let greatest = half(GREATEST as u16);
    // What is no number is 0.
    let v = v.max(0.0);
    if v >= greatest {
        return (GREATEST, 0.0);
    }
    let bits = v.to_bits();
    let exponent = (bits >> 23) as i32 - 127 + 15;
    let i = if exponent <= 0 {
        // Below the normal ones, halves lie 2^-24 apart.
        (v * (1u32 << 24) as f32) as u32
    } else {
        ((exponent as u32) << 10) | ((bits & 0x7f_ffff) >> 13)
    };
    let (low, high) = (half(i as u16), half((i + 1).min(GREATEST) as u16));
    (i, if high > low { (v - low) / (high - low) } else { 0.0 })
}

/// The number of half precision with these bits.
pub fn half(bits: u16) -> f32 {
    let sign = if bits & NEGATIVE as u16 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff));
    sign * match exponent {
        0 => mantissa * 2f32.powi(-24),
        31 if mantissa > 0.0 => f32::NAN,
        31 => f32::INFINITY,
        _ => (1.0 + mantissa / 1024.0) * 2f32.powi(exponent - 15),
    }
}
