//! Rows of light as the sensor saw it, and steps that fine and coarse scales share.

use darkroot_photo::{Capture, Rect};

use super::Denoiser;
use crate::light::{LinearLight, period};
use crate::mend::Mends;
use crate::tile::inside;

/// Where light comes from.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) capture: &'a Capture,
    pub(super) light: &'a LinearLight,
    pub(super) mends: &'a Mends,
}

impl Source<'_> {
    /// Mended light of row `y` of the frame from column `x` on, inside the active area.
    fn levelled(&self, x: usize, y: usize, out: &mut [f32]) {
        self.mends.levelled(self.capture, self.light, (x, y), out);
    }

    /// The light of row `y` from column `x` on, both counted from the active area's corner; beyond it the area goes on as a
    /// tile does.
    pub(super) fn row(&self, x: isize, y: isize, out: &mut [f32]) {
        let Rect { x: left, y: top, width, height } = self.capture.active_area;
        let period = period(self.capture.counts.layout());
        let y = inside(y + top as isize, top, height, period.1);
        // Places of the row that lie inside.
        let place = |column: usize| (column as isize - x).clamp(0, out.len() as isize) as usize;
        let straight = place(0)..place(width);
        if !straight.is_empty() {
            let begin = left + (x + straight.start as isize) as usize;
            self.levelled(begin, y, &mut out[straight.clone()]);
        }
        for i in (0..straight.start).chain(straight.end..out.len()) {
            let at = inside(x + i as isize + left as isize, left, width, period.0);
            let mirrored = usize::try_from(at as isize - left as isize - x).ok();
            if let Some(mirrored) = mirrored.filter(|place| straight.contains(place)) {
                out[i] = out[mirrored];
            } else {
                let mut one = [0.0];
                self.levelled(at, y, &mut one);
                out[i] = one[0];
            }
        }
    }
}

/// The samples of two rows of the mosaic by their place in the block of 2 x 2, stabilised.
pub(super) struct Places {
    rows: [Vec<f32>; 4],
}

impl Places {
    pub(super) fn new(columns: usize) -> Self {
        Self { rows: [0; 4].map(|_| vec![0.0; columns]) }
    }

    /// The rotated planes of two rows, `upper` and `lower`, of whole blocks.
    #[inline(always)]
    pub(super) fn rotated(
        &mut self,
        filter: &Denoiser,
        (upper, lower): (&[f32], &[f32]),
        planes: [&mut [f32]; 4],
    ) {
        let [a, b, c, d] = &mut self.rows;
        for (i, row, even, odd) in [(0, upper, a, b), (2, lower, c, d)] {
            let [of_even, of_odd] = [filter.stabilisers[i], filter.stabilisers[i + 1]];
            for ((pair, even), odd) in row.chunks_exact(2).zip(even.iter_mut()).zip(odd.iter_mut()) {
                *even = of_even.root(pair[0]);
                *odd = of_odd.root(pair[1]);
            }
        }
        filter.rotation.forth(self.rows.each_ref().map(|r| &r[..]), planes);
    }
}

/// (a + 2 b + c) / 4.
#[inline(always)]
pub(super) fn hat(a: &[f32], b: &[f32], c: &[f32], out: &mut [f32]) {
    let n = out.len();
    let (a, b, c) = (&a[..n], &b[..n], &c[..n]);
    for i in 0..n {
        out[i] = 0.25 * (a[i] + c[i]) + 0.5 * b[i];
    }
}

/// The same along a row, between values `step` apart; the outermost `step` of `out` on both sides are left as they are.
#[inline(always)]
pub(super) fn hat_along(row: &[f32], step: usize, out: &mut [f32]) {
    let n = out.len();
    if n > 2 * step {
        hat(&row[..n - 2 * step], &row[step..n - step], &row[2 * step..n], &mut out[step..n - step]);
    }
}

/// Sums over pairs of columns of the squares of two rows.
#[inline(always)]
pub(super) fn power_of_pairs(upper: &[f32], lower: &[f32], sums: &mut [f32], out: &mut [f32]) {
    let n = upper.len();
    let (lower, sums) = (&lower[..n], &mut sums[..n]);
    for i in 0..n {
        sums[i] = upper[i] * upper[i] + lower[i] * lower[i];
    }
    for (out, pair) in out.iter_mut().zip(sums.chunks_exact(2)) {
        *out = 0.25 * (pair[0] + pair[1]);
    }
}

/// Each value twice.
#[inline(always)]
pub(super) fn twice(values: &[f32], out: &mut [f32]) {
    for (pair, v) in out.chunks_exact_mut(2).zip(values) {
        pair[0] = *v;
        pair[1] = *v;
    }
}

/// Each value, and after it the mean of it and the next: the last one of `values` only serves as a next.
#[inline(always)]
pub(super) fn between(values: &[f32], out: &mut [f32]) {
    for (pair, v) in out.chunks_exact_mut(2).zip(values.windows(2)) {
        pair[0] = v[0];
        pair[1] = 0.5 * (v[0] + v[1]);
    }
}
