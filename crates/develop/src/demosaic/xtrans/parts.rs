//! Rows of an X-Trans mosaic taken apart by columns of the array, so that neighbours in memory are alike.

use super::super::signed_sqrt;
use super::sites::PERIOD;

/// Pixels that are worked on at once: of one column of the array, so [`PERIOD`] columns apart.
pub(super) const LANES: usize = 16;
pub(super) type Lanes = [f32; LANES];

/// The next pixels of a row that is taken apart.
#[inline(always)]
pub(super) fn lanes(pixels: &[f32]) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&pixels[..LANES]);
    lanes
}

/// A row of pixels taken apart by columns of the array: part `k` has columns `k`, `k + 6`, `k + 12` and so on,
/// after one pixel of nothing and before others.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    /// Pixels of a part that are worked on: a multiple of [`LANES`].
    pub(super) pixels: usize,
}

impl Parts {
    pub(super) fn of(width: usize) -> Self {
        Self { pixels: width.div_ceil(PERIOD).next_multiple_of(LANES) }
    }

    /// Floats of a part.
    pub(super) fn length(self) -> usize {
        self.pixels + 2
    }

    /// Floats of a row.
    pub(super) fn row(self) -> usize {
        PERIOD * self.length()
    }

    /// Where in a row the pixel `dx` columns from pixel 0 of part `k` is, `|dx| < 6`.
    pub(super) fn index(self, k: usize, dx: isize) -> usize {
        let column = (k + PERIOD).wrapping_add_signed(dx);
        column % PERIOD * self.length() + column / PERIOD
    }
}

/// Signed square roots of samples, each row taken apart.
#[inline(always)]
pub(super) fn take_apart(samples: &[f32], width: usize, parts: Parts) -> Vec<f32> {
    let mut roots = vec![0f32; samples.len() / width * parts.row()];
    for (row, out) in samples.chunks_exact(width).zip(roots.chunks_exact_mut(parts.row())) {
        for (k, out) in out.chunks_exact_mut(parts.length()).enumerate() {
            for (out, v) in out[1..].iter_mut().zip(row[k.min(width)..].iter().step_by(PERIOD)) {
                *out = signed_sqrt(*v);
            }
        }
    }
    roots
}

/// Puts a row together again, from column `first` on.
#[inline(always)]
pub(super) fn put_together(out: &mut [f32], row: &[f32], first: usize, parts: Parts) {
    for k in 0..PERIOD {
        let column = first + k;
        let part = &row[parts.index(column % PERIOD, 0) + column / PERIOD..];
        for (out, v) in out.iter_mut().skip(k).step_by(PERIOD).zip(part) {
            *out = *v;
        }
    }
}
