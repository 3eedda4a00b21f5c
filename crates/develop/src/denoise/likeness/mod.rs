//! Noise told from what it lies on by likeness: collaborative filtering.
//!
//! Blocks that are alike are stacked, and the stack is transformed as a whole: what they share becomes few large numbers, and
//! noise stays spread over all of them. A first step cuts off small numbers. A second one looks for likeness in what the first
//! one made, and weighs each number by its power there (Wiener). Where blocks overlap, their mean counts, each weighed by how
//! little noise is left in it.
//!
//! K. Dabov, A. Foi, V. Katkovnik and K. Egiazarian, "Image denoising by sparse 3-D transform-domain collaborative filtering",
//! IEEE Transactions on Image Processing 16(8), 2007; of one rotated plane for all, as in their "Color image denoising via
//! sparse 3D collaborative filtering with grouping constraint in luminance-chrominance space", ICIP 2007.
//!
//! Blocks begin at places that are counted from the active area's corner, and lie inside of it. So whatever part of the frame
//! is looked at, it becomes the same, bit for bit.

mod alike;
mod groups;
mod planes;
mod shrink;
mod sums;
mod transform;

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Rect, Size};
use rayon::prelude::*;

use super::{Denoiser, Scratch};
use crate::light::LinearLight;
use crate::view::{Cancel, Cancelled};
use groups::{AROUND, around, over};
use planes::Planes;
use shrink::{Cut, Weigh};
use sums::Sums;

/// Columns or rows of the active area below which there is too little to be alike.
pub(super) const SMALLEST: usize = 64;

/// The light of a rectangle of the frame without noise.
#[derive(Debug)]
pub(crate) struct Clean {
    rect: Rect,
    light: Vec<f32>,
}

impl Clean {
    /// Of at least this rectangle of the frame, inside the active area.
    ///
    /// # Errors
    /// Somebody cancelled it.
    pub(super) fn of(
        filter: &Denoiser,
        (capture, light): (&Capture, &LinearLight),
        rect: Rect,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let area = capture.active_area;
        let frame = Size { width: area.width.div_ceil(2), height: area.height.div_ceil(2) };
        let (x, y) = ((rect.x - area.x) / 2, (rect.y - area.y) / 2);
        let needed = Rect {
            x,
            y,
            width: (rect.right() - area.x).div_ceil(2) - x,
            height: (rect.bottom() - area.y).div_ceil(2) - y,
        };
        let source = filter.source(capture, light);
        let first = around(needed, AROUND, frame);
        let noisy = Planes::of(filter, source, around(first, AROUND, frame));
        let sums = over::<{ Cut::GROUP }, Cut>(&noisy, &noisy, (frame, first), filter.strengths, cancel)?;
        let mut guide = Planes::empty(first);
        guide.by_rows(|y, planes| {
            for (k, row) in planes.into_iter().enumerate() {
                sums.means(k, (first.x, y), row);
            }
        });
        drop(sums);
        let sums =
            over::<{ Weigh::GROUP }, Weigh>(&noisy, &guide, (frame, needed), filter.strengths, cancel)?;
        drop((noisy, guide));
        let rect = Rect {
            x: area.x + 2 * needed.x,
            y: area.y + 2 * needed.y,
            width: (2 * needed.width).min(area.width - 2 * needed.x),
            height: (2 * needed.height).min(area.height - 2 * needed.y),
        };
        let mut clean = vec![0f32; rect.width * rect.height];
        clean.par_chunks_mut(2 * rect.width).enumerate().for_each(|(y, rows)| {
            for (i, row) in rows.chunks_exact_mut(rect.width).enumerate() {
                source.row((rect.x - area.x) as isize, (2 * (needed.y + y) + i) as isize, row);
            }
            vectorised(
                #[inline(always)]
                || back(filter, &sums, (needed.x, needed.y + y, needed.width), rows, rect.width),
            );
        });
        Ok(Self { rect, light: clean })
    }

    /// Whether it has all of a rectangle.
    pub(super) fn covers(&self, rect: Rect) -> bool {
        self.rect.intersection(rect) == Some(rect)
    }

    /// A rectangle of it, into `scratch`, which tells its rows.
    pub(super) fn denoise(&self, rect: Rect, scratch: &mut Scratch) {
        let mosaic = scratch.begin_at((rect.x as isize, rect.y as isize), rect.width, rect.height);
        for (y, row) in (rect.y - self.rect.y..).zip(mosaic.chunks_exact_mut(rect.width)) {
            row.copy_from_slice(&self.light[y * self.rect.width + rect.x - self.rect.x..][..rect.width]);
        }
    }
}

/// Two rows of the mosaic (or the last one) from `count` blocks of the means. Clipped samples stay as they are.
#[inline(always)]
fn back(
    filter: &Denoiser,
    sums: &Sums,
    (x, y, count): (usize, usize, usize),
    rows: &mut [f32],
    width: usize,
) {
    let mut planes = [0; 4].map(|_| vec![0f32; count]);
    let mut left = [0; 4].map(|_| vec![0f32; count]);
    for k in 0..4 {
        sums.means(k, (x, y), &mut planes[k]);
        sums.left(k, (x, y), &mut left[k]);
    }
    let (planes, left) = (planes.each_ref().map(|p| &p[..]), left.each_ref().map(|l| &l[..]));
    let (mut roots, mut shares) = (vec![0f32; count], vec![0f32; count]);
    for (down, row) in rows.chunks_exact_mut(width).enumerate() {
        for across in 0..2 {
            let place = 2 * down + across;
            filter.rotation.back(place, planes, &mut roots);
            filter.rotation.back_squared(place, left, &mut shares);
            let (stabiliser, limit) = (filter.stabilisers[place], filter.limits[place]);
            let samples = row.iter_mut().skip(across).step_by(2);
            for ((v, root), left) in samples.zip(&roots).zip(&shares) {
                let light = stabiliser.light(*root, 1.0 - left);
                *v = if *v < limit { light } else { *v };
            }
        }
    }
}
