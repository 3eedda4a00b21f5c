//! One step over a part of the frame: blocks are grouped by their likeness, each group is cleaned as a whole, and where the
//! blocks of many groups overlap, their mean counts.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Rect, Size};
use rayon::prelude::*;

use super::alike::{Alike, Compared, REACH, SPAN};
use super::planes::Planes;
use super::sums::{Rows, Sums};
use super::transform::{Cosines, SIDE, Stack};
use crate::view::{Cancel, Cancelled};

/// Rows and columns from one block to the next for which others are looked for.
const STEP: usize = 4;
/// Rows of the frame whose blocks one task works on.
const STRIP: usize = 32;
/// How far from a result there are samples that have a say in it: a block that covers it is in the group of one that lies this
/// far away, and so is another one on the far side of that.
pub(super) const AROUND: usize = 2 * REACH + 2 * SIDE;

const _: () = assert!(STRIP.is_multiple_of(STEP) && SPAN.is_multiple_of(STEP));
// Strips that have another one between them touch different rows.
const _: () = assert!(STRIP / 2 >= REACH + SIDE);

/// A way to take noise from a stack.
pub(super) trait TakeNoise<const N: usize> {
    /// Whether it looks at a first estimate.
    const GUIDED: bool;

    /// Takes noise of this standard deviation away, and gives the share of its variance that is left. The first estimate is
    /// used up.
    fn take(stack: &mut Stack<N>, guide: &mut Stack<N>, strength: f32, cosines: &Cosines) -> f32;
}

/// What a step looks at.
#[derive(Clone, Copy)]
pub(super) struct Step<'a> {
    pub(super) noisy: &'a Planes,
    /// The first estimate; for the first step the noisy planes.
    pub(super) guide: &'a Planes,
    /// Columns and rows of the planes of the whole frame.
    pub(super) frame: Size,
    /// Standard deviation of the noise of each plane.
    pub(super) strengths: [f32; 4],
}

impl Step<'_> {
    /// Goes over a part of the frame. The sums reach beyond it, where they are not whole.
    ///
    /// # Errors
    /// Somebody cancelled it.
    pub(super) fn over<const N: usize, T: TakeNoise<N>>(
        &self,
        part: Rect,
        cancel: &Cancel,
    ) -> Result<Sums, Cancelled> {
        let mut sums = Sums::new(around(part, AROUND, self.frame));
        let columns = begins(part.x, part.right(), self.frame.width);
        let rows = begins(part.y, part.bottom(), self.frame.height);
        let strips: Vec<&[usize]> = rows.chunk_by(|a, b| a / STRIP == b / STRIP).collect();
        let cosines = Cosines::new();
        // Every second strip, then the others: so sums are added to in the same order whoever works on them.
        for turn in 0..2 {
            let strips: Vec<&[usize]> =
                strips.iter().copied().filter(|rows| rows[0] / STRIP % 2 == turn).collect();
            let ends: Vec<usize> =
                strips.iter().skip(1).map(|rows| rows[0] / STRIP * STRIP - STRIP / 2).collect();
            strips.par_iter().zip(sums.parts(&ends)).try_for_each(|(rows, mut sums)| {
                if cancel.is_cancelled() {
                    return Err(Cancelled);
                }
                vectorised(
                    #[inline(always)]
                    || self.strip::<N, T>(&columns, rows, &cosines, &mut sums),
                );
                Ok(())
            })?;
        }
        Ok(sums)
    }

    /// Blocks that begin at these columns and rows.
    #[inline(always)]
    fn strip<const N: usize, T: TakeNoise<N>>(
        &self,
        columns: &[usize],
        rows: &[usize],
        cosines: &Cosines,
        sums: &mut Rows<'_>,
    ) {
        let mut compared = Compared::new();
        let mut alike = vec![Alike::<N>::ITSELF; columns.len()];
        for columns in columns.chunk_by(|a, b| a / SPAN == b / SPAN) {
            for y in rows {
                let alike = &mut alike[..columns.len()];
                compared.find(&self.guide.plane(0), self.frame, (columns, *y), alike);
                for (x, alike) in columns.iter().zip(alike) {
                    self.group::<N, T>(&alike.places(*x, *y), cosines, sums);
                }
            }
        }
    }

    /// Cleans the group of blocks that begin at these places.
    #[inline(always)]
    fn group<const N: usize, T: TakeNoise<N>>(
        &self,
        places: &[(usize, usize); N],
        cosines: &Cosines,
        sums: &mut Rows<'_>,
    ) {
        let mut stack = Stack::<N>::EMPTY;
        let mut guide = Stack::<N>::EMPTY;
        sums.count(places);
        for k in 0..4 {
            fill(&mut stack, self.noisy, k, places);
            if T::GUIDED {
                fill(&mut guide, self.guide, k, places);
            }
            let left = T::take(&mut stack, &mut guide, self.strengths[k], cosines);
            sums.add(k, &stack, places, 1.0 / left);
        }
    }
}

/// A part of the frame and so much around it, within the frame.
pub(super) fn around(part: Rect, border: usize, frame: Size) -> Rect {
    let (x, y) = (part.x.saturating_sub(border), part.y.saturating_sub(border));
    let right = (part.right() + border).min(frame.width);
    let bottom = (part.bottom() + border).min(frame.height);
    Rect { x, y, width: right - x, height: bottom - y }
}

/// Where blocks begin whose groups have a say in what lies between `begin` and `end`: every few, and at the frame's end.
fn begins(begin: usize, end: usize, length: usize) -> Vec<usize> {
    let last = length - SIDE;
    let near = begin.saturating_sub(REACH + SIDE - 1)..end + REACH;
    (0..last).step_by(STEP).chain([last]).filter(|at| near.contains(at)).collect()
}

#[inline(always)]
fn fill<const N: usize>(stack: &mut Stack<N>, planes: &Planes, k: usize, places: &[(usize, usize); N]) {
    let plane = planes.plane(k);
    for (block, (x, y)) in stack.0.iter_mut().zip(places) {
        for (r, row) in block.iter_mut().enumerate() {
            row.copy_from_slice(plane.row(*x, y + r, SIDE));
        }
    }
}
