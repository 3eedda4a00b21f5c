//! The rotated planes of a part of the frame.

use darkroot_photo::Rect;
use rayon::prelude::*;

/// The four rotated planes of a rectangle of the frame, in blocks of 2 x 2 from the active area's corner on.
pub(super) struct Planes {
    pub(super) rect: Rect,
    pub(super) planes: [Vec<f32>; 4],
}

/// One of them.
#[derive(Clone, Copy)]
pub(super) struct Plane<'a> {
    rect: Rect,
    samples: &'a [f32],
}

impl Planes {
    pub(super) fn empty(rect: Rect) -> Self {
        Self { rect, planes: [0; 4].map(|_| vec![0f32; rect.width * rect.height]) }
    }

    /// Does something to each row of all planes, in parallel: `work` gets its number in the frame.
    pub(super) fn by_rows(&mut self, work: impl Fn(usize, [&mut [f32]; 4]) + Sync) {
        let width = self.rect.width.max(1);
        let [a, b, c, d] = self.planes.each_mut().map(|p| p.par_chunks_exact_mut(width));
        let top = self.rect.y;
        a.zip(b).zip(c.zip(d)).enumerate().for_each(|(y, ((a, b), (c, d)))| work(top + y, [a, b, c, d]));
    }

    pub(super) fn plane(&self, k: usize) -> Plane<'_> {
        Plane { rect: self.rect, samples: &self.planes[k] }
    }
}

impl Plane<'_> {
    /// `count` samples of row `y` from column `x` on, counted from the active area's corner.
    #[inline(always)]
    pub(super) fn row(&self, x: usize, y: usize, count: usize) -> &[f32] {
        &self.samples[(y - self.rect.y) * self.rect.width + x - self.rect.x..][..count]
    }
}
