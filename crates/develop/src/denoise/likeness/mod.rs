//! Noise told from what it lies on by likeness: collaborative filtering.
//!
//! Blocks that are alike are stacked, and the stack is transformed as a whole: what they share becomes few large numbers, and
//! noise stays spread over all of them. A first step cuts off small numbers. A second one looks for likeness in what the first
//! one made, and weighs each number by its power there (Wiener). Where blocks overlap, their mean counts, each weighed by how
//! little noise is left in it. The noise of the coarse scales (`coarse.rs`), for which blocks are too small, goes before.
//!
//! ```text
//! alike      which blocks are like others, in the plane of brightness
//! transform  Haar's wavelet along a stack, cosines along the rows and columns of its blocks
//! shrink     what is noise in a stack: the two steps
//! sums       weighted means of blocks that overlap
//! groups     one step over a part of the frame, in strips
//! ```
//!
//! K. Dabov, A. Foi, V. Katkovnik and K. Egiazarian, "Image denoising by sparse 3-D transform-domain collaborative filtering",
//! IEEE Transactions on Image Processing 16(8), 2007; for one plane that tells what is alike in all, the same, "Color image
//! denoising via sparse 3D collaborative filtering with grouping constraint in luminance-chrominance space", ICIP 2007.
//!
//! Blocks begin at places that are counted from the active area's corner, and lie inside of it. So whatever part of the frame
//! is looked at, it becomes the same, bit for bit.

mod alike;
mod groups;
mod planes;
mod shrink;
mod sums;
mod transform;

#[cfg(test)]
mod slow;

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Rect, Size};
use rayon::prelude::*;

use super::coarse::Coarse;
use super::rows::{Places, Source};
use super::{Denoiser, Scratch};
use crate::light::LinearLight;
use crate::view::{Cancel, Cancelled};
use groups::{AROUND, Step, around};
use planes::Planes;
use shrink::{Cut, Weigh};
use sums::Sums;

/// Columns or rows of the active area below which there is too little to be alike.
pub(super) const SMALLEST: usize = 64;
/// Rows of the planes that are worked on at once: so much less memory is needed, and some around them are looked at twice.
const SLAB: usize = 512;

/// Share of the variance that is left where there is nothing but noise, as was measured (a test has the figures).
pub(super) fn left_of_noise(strength: f32) -> f32 {
    (1.0 - strength * strength).max(0.0).powf(1.0 + 4.0 * strength)
}

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
        let (x, y) = ((rect.x - area.x) / 2, (rect.y - area.y) / 2);
        let (right, bottom) = ((rect.right() - area.x).div_ceil(2), (rect.bottom() - area.y).div_ceil(2));
        let rect = Rect {
            x: area.x + 2 * x,
            y: area.y + 2 * y,
            width: (2 * right).min(area.width) - 2 * x,
            height: (2 * bottom).min(area.height) - 2 * y,
        };
        let coarse = Coarse::of(filter, capture, light, cancel)?;
        let frame = Size { width: area.width.div_ceil(2), height: area.height.div_ceil(2) };
        let work = Work { filter, source: filter.source(capture, light), coarse: &coarse, frame, cancel };
        let mut clean = vec![0f32; rect.width * rect.height];
        for (i, light) in clean.chunks_mut(2 * SLAB * rect.width).enumerate() {
            let y = y + i * SLAB;
            let slab = Rect { x, y, width: right - x, height: SLAB.min(bottom - y) };
            work.clean(slab, light, rect.width)?;
        }
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

/// What the work on a part of the frame needs. Parts and the frame are counted in blocks of 2 x 2 samples from the active
/// area's corner on, as places of the planes are.
struct Work<'a> {
    filter: &'a Denoiser,
    source: Source<'a>,
    coarse: &'a Coarse,
    frame: Size,
    cancel: &'a Cancel,
}

impl Work<'_> {
    /// The light of a part, whose rows of samples are so wide.
    fn clean(&self, part: Rect, light: &mut [f32], width: usize) -> Result<(), Cancelled> {
        let first = around(part, AROUND, self.frame);
        let noisy = self.planes(around(first, AROUND, self.frame));
        let step = Step { noisy: &noisy, guide: &noisy, frame: self.frame, strengths: self.filter.strengths };
        let sums = step.over::<{ Cut::GROUP }, Cut>(first, self.cancel)?;
        let mut guide = Planes::empty(first);
        guide.by_rows(|y, planes| {
            for (k, row) in planes.into_iter().enumerate() {
                sums.means(k, (first.x, y), row);
            }
        });
        drop(sums);
        let step = Step { guide: &guide, ..step };
        let sums = step.over::<{ Weigh::GROUP }, Weigh>(part, self.cancel)?;
        light.par_chunks_mut(2 * width).enumerate().for_each(|(i, rows)| {
            let y = part.y + i;
            for (row, y) in rows.chunks_exact_mut(width).zip(2 * y as isize..) {
                self.source.row(2 * part.x as isize, y, row);
            }
            vectorised(
                #[inline(always)]
                || back(self.filter, &sums, (part.x, y, part.width), rows, width),
            );
        });
        Ok(())
    }

    /// The rotated planes of a part, without the noise of the coarse scales.
    fn planes(&self, part: Rect) -> Planes {
        // Those begin and end at even columns.
        let before = part.x % 2;
        let width = (before + part.width).next_multiple_of(2);
        let mut all = Planes::empty(part);
        all.by_rows(|y, planes| {
            let mut mosaic = [0; 2].map(|_| vec![0f32; 2 * part.width]);
            for (row, y) in mosaic.iter_mut().zip(2 * y as isize..) {
                self.source.row(2 * part.x as isize, y, row);
            }
            let mut places = Places::new(part.width);
            let (mut line, mut coarse) = (vec![0f32; width / 2 + 1], vec![0f32; width]);
            let mut planes = planes;
            vectorised(
                #[inline(always)]
                || {
                    let rows = planes.each_mut().map(|row| &mut **row);
                    places.rotated(self.filter, (&mosaic[0], &mosaic[1]), rows);
                    for (k, row) in planes.iter_mut().enumerate() {
                        self.coarse.row(k, (part.x - before) as isize, y as isize, &mut line, &mut coarse);
                        for (v, noise) in row.iter_mut().zip(&coarse[before..]) {
                            *v -= noise;
                        }
                    }
                },
            );
        });
        all
    }
}

/// Two rows of samples (or the last one), so wide, of `count` blocks of 2 x 2 from the means of planes. Clipped samples stay as
/// they are.
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
