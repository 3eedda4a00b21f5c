//! Weighted means of overlapping blocks.

use darkroot_photo::Rect;

use super::transform::{SIDE, Stack};

/// Numbers that are kept of each place: sums of four planes, sums of their weights, and how many blocks there were.
const KEPT: usize = 9;

/// Sums over blocks that cover places of a rectangle: row by row, and in each one after the other what is kept.
pub(super) struct Sums {
    pub(super) rect: Rect,
    rows: Vec<f32>,
}

/// Some of their rows.
pub(super) struct Rows<'a> {
    rect: Rect,
    rows: &'a mut [f32],
}

impl Sums {
    pub(super) fn new(rect: Rect) -> Self {
        Self { rect, rows: vec![0.0; KEPT * rect.width * rect.height] }
    }

    /// Rows between places where they are parted: as many parts, one more than places.
    pub(super) fn parts(&mut self, at: &[usize]) -> Vec<Rows<'_>> {
        let Rect { x, y, width, height } = self.rect;
        let mut rest = &mut self.rows[..];
        let mut parts = Vec::with_capacity(at.len() + 1);
        let mut top = y;
        for end in at.iter().copied().chain([y + height]) {
            let end = end.clamp(top, y + height);
            let (rows, after) = std::mem::take(&mut rest).split_at_mut((end - top) * KEPT * width);
            parts.push(Rows { rect: Rect { x, y: top, width, height: end - top }, rows });
            (rest, top) = (after, end);
        }
        parts
    }

    /// Means of row `y` of a plane from column `x` on.
    #[inline(always)]
    pub(super) fn means(&self, k: usize, (x, y): (usize, usize), out: &mut [f32]) {
        let (sums, weights) = (self.kept(k, x, y, out.len()), self.kept(4 + k, x, y, out.len()));
        for ((out, sum), weight) in out.iter_mut().zip(sums).zip(weights) {
            *out = sum / weight;
        }
    }

    /// The share of the variance that is left in them. A block whose share is s has the weight 1 / s.
    #[inline(always)]
    pub(super) fn left(&self, k: usize, (x, y): (usize, usize), out: &mut [f32]) {
        let (counts, weights) = (self.kept(8, x, y, out.len()), self.kept(4 + k, x, y, out.len()));
        for ((out, count), weight) in out.iter_mut().zip(counts).zip(weights) {
            *out = count / weight;
        }
    }

    #[inline(always)]
    fn kept(&self, which: usize, x: usize, y: usize, count: usize) -> &[f32] {
        let Rect { x: left, y: top, width, .. } = self.rect;
        &self.rows[((y - top) * KEPT + which) * width + x - left..][..count]
    }
}

impl Rows<'_> {
    /// Adds the blocks of a plane, the block `i` at `places[i]`.
    #[inline(always)]
    pub(super) fn add<const N: usize>(
        &mut self,
        k: usize,
        stack: &Stack<N>,
        places: &[(usize, usize); N],
        weight: f32,
    ) {
        for (block, (x, y)) in stack.0.iter().zip(places) {
            for (r, row) in block.iter().enumerate() {
                let sums = self.kept(k, *x, y + r);
                for i in 0..SIDE {
                    sums[i] += weight * row[i];
                }
                for sum in self.kept(4 + k, *x, y + r) {
                    *sum += weight;
                }
            }
        }
    }

    /// Counts blocks.
    #[inline(always)]
    pub(super) fn count<const N: usize>(&mut self, places: &[(usize, usize); N]) {
        for (x, y) in places {
            for r in 0..SIDE {
                for count in self.kept(8, *x, y + r) {
                    *count += 1.0;
                }
            }
        }
    }

    #[inline(always)]
    fn kept(&mut self, which: usize, x: usize, y: usize) -> &mut [f32; SIDE] {
        let Rect { x: left, y: top, width, .. } = self.rect;
        let begin = ((y - top) * KEPT + which) * width + x - left;
        let row = &mut self.rows[begin..begin + SIDE];
        row.try_into().unwrap_or_else(|_| unreachable!())
    }
}
