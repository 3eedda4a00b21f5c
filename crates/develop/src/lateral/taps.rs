//! Values between those of a plane, for a whole run of places that are displaced alike.

use super::CELL;
use super::shift::cubic;
use crate::cones::{greater, lesser};

/// Most places of a colour side by side in a cell, and columns that are looked at for them.
const RUN: usize = CELL / 2;
const WIDE: usize = 2 * RUN + 4;

/// Weights of the 4 x 4 values that a value at a distance is made of.
pub(super) struct Taps {
    left: isize,
    top: isize,
    across: [f32; 4],
    down: [f32; 4],
}

impl Taps {
    pub(super) fn of(by: [f64; 2]) -> Self {
        let [(left, across, _), (top, down, _)] = by.map(cubic);
        Self { left, top, across, down }
    }

    /// The value at the distance from one, in rows of this width.
    #[inline(always)]
    fn at(&self, values: &[f32], width: usize, at: usize) -> f32 {
        let first = at as isize + self.left + self.top * width as isize;
        let mut sums = [0f32; 4];
        for (j, weight) in self.down.iter().enumerate() {
            let row = &values[first as usize + j * width..][..4];
            for (sum, v) in sums.iter_mut().zip(row) {
                *sum += weight * v;
            }
        }
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.across[i] * sums[i]);
        (a + d) + (b + c)
    }

    /// As [`Self::at`] for so many values from one on, `STEP` apart. What columns have is shared by neighbours.
    #[inline(always)]
    pub(super) fn run<const STEP: usize>(
        &self,
        values: &[f32],
        width: usize,
        (at, count): (usize, usize),
    ) -> [f32; RUN] {
        let mut out = [0f32; RUN];
        let first = (at as isize + self.left + self.top * width as isize) as usize;
        let Some(rows) = values.get(first..first + 3 * width + WIDE) else {
            for (k, out) in out.iter_mut().enumerate().take(count) {
                *out = self.at(values, width, at + STEP * k);
            }
            return out;
        };
        let mut sums = [0f32; WIDE];
        for (j, weight) in self.down.iter().enumerate() {
            for (sum, v) in sums.iter_mut().zip(&rows[j * width..][..WIDE]) {
                *sum += weight * v;
            }
        }
        // Written out: as a closure over four it is done one by one.
        let [a, b, c, d] = self.across;
        for (k, out) in out.iter_mut().enumerate() {
            let at = STEP * k;
            *out = (a * sums[at] + d * sums[at + 3]) + (b * sums[at + 1] + c * sums[at + 2]);
        }
        out
    }

    /// As [`Self::range`] for so many values side by side, from one on.
    #[inline(always)]
    pub(super) fn ranges(
        &self,
        values: &[f32],
        width: usize,
        (at, count): (usize, usize),
    ) -> ([f32; RUN], [f32; RUN]) {
        let (mut least, mut most) = ([0f32; RUN], [0f32; RUN]);
        let first = (at as isize + self.left + self.top * width as isize) as usize;
        let Some(rows) = values.get(first..first + 3 * width + RUN + 4) else {
            for k in 0..count {
                (least[k], most[k]) = self.range(values, width, at + k);
            }
            return (least, most);
        };
        let (mut low, mut high) = ([f32::INFINITY; RUN + 4], [f32::NEG_INFINITY; RUN + 4]);
        for j in 0..4 {
            for ((low, high), &v) in low.iter_mut().zip(&mut high).zip(&rows[j * width..][..RUN + 4]) {
                *low = if v < *low { v } else { *low };
                *high = if v > *high { v } else { *high };
            }
        }
        for k in 0..RUN {
            least[k] = lesser(lesser(low[k], low[k + 1]), lesser(low[k + 2], low[k + 3]));
            most[k] = greater(greater(high[k], high[k + 1]), greater(high[k + 2], high[k + 3]));
        }
        (least, most)
    }

    /// The smallest and the largest of the values that [`Self::at`] looks at.
    #[inline(always)]
    fn range(&self, values: &[f32], width: usize, at: usize) -> (f32, f32) {
        let first = at as isize + self.left + self.top * width as isize;
        let (mut least, mut most) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
        for j in 0..4 {
            let row = &values[first as usize + j * width..][..4];
            for ((least, most), &v) in least.iter_mut().zip(&mut most).zip(row) {
                *least = if v < *least { v } else { *least };
                *most = if v > *most { v } else { *most };
            }
        }
        let fold = |[a, b, c, d]: [f32; 4], of: fn(f32, f32) -> f32| of(of(a, b), of(c, d));
        (fold(least, f32::min), fold(most, f32::max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_what_its_values_are_to_the_bit() {
        let mut random = 1u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as f32 / (1 << 24) as f32
        };
        let (width, height) = (61, 23);
        let values: Vec<f32> = (0..width * height).map(|_| next()).collect();
        for by in [[0.0, 0.0], [0.3, -0.8], [-2.6, 1.4], [1.999, 2.5]] {
            let taps = Taps::of(by);
            for (row, column, count) in [(6, 6, 8), (11, 20, 3), (15, 40, 8), (17, 47, 1), (17, 44, 5)] {
                let at = row * width + column;
                let (one, two) =
                    (taps.run::<1>(&values, width, (at, count)), taps.run::<2>(&values, width, (at, count)));
                let (least, most) = taps.ranges(&values, width, (at, count));
                for k in 0..count {
                    assert_eq!(one[k].to_bits(), taps.at(&values, width, at + k).to_bits());
                    assert_eq!(two[k].to_bits(), taps.at(&values, width, at + 2 * k).to_bits());
                    let range = taps.range(&values, width, at + k);
                    assert_eq!(
                        (least[k].to_bits(), most[k].to_bits()),
                        (range.0.to_bits(), range.1.to_bits())
                    );
                }
            }
        }
    }
}
