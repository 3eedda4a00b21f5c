//! One step over the frame: blocks are grouped by their likeness, each group is cleaned as a whole, and where the blocks of
//! many groups overlap, their mean counts.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Rect, Size};
use rayon::prelude::*;

use super::alike::{Alike, Compared, REACH, SPAN};
use super::planes::Planes;
use super::sums::{Rows, Sums};
use super::transform::{Cosines, SIDE, Stack};
use crate::view::{Cancel, Cancelled};

/// Rows and columns from one block to the next for which others are looked for.
const STEP: usize = 3;
/// Rows of blocks that one task works on.
const STRIP: usize = 16 * STEP;
/// How far from a result samples lie that have a say in it, in blocks of 2 x 2.
pub(super) const AROUND: usize = 2 * (REACH + SIDE);

/// What becomes of the numbers of a stack of noise of variance `strength` squared; the stack of a first estimate tells a way
/// more than itself. Gives the share of the variance that is left.
pub(super) trait Clean<const N: usize> {
    /// Whether there is a first estimate.
    const GUIDED: bool;
    fn clean(stack: &mut Stack<N>, guide: &Stack<N>, strength: f32) -> f32;
}

/// Goes over the rectangle `needed` of the frame.
pub(super) fn over<const N: usize, C: Clean<N>>(
    noisy: &Planes,
    guide: &Planes,
    (frame, needed): (Size, Rect),
    strengths: [f32; 4],
    cancel: &Cancel,
) -> Result<Sums, Cancelled> {
    let mut sums = Sums::new(around(needed, AROUND, frame));
    let columns = begins(needed.x, needed.right(), frame.width);
    let rows = begins(needed.y, needed.bottom(), frame.height);
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return Ok(sums) };
    let cosines = Cosines::new();
    // Strips that have others between them touch different rows.
    for turn in 0..2 {
        let strips: Vec<usize> = (first / STRIP..=last / STRIP).filter(|strip| strip % 2 == turn).collect();
        let ends: Vec<usize> = strips.iter().skip(1).map(|strip| strip * STRIP - STRIP / 2).collect();
        let parts = sums.parts(&ends);
        strips.par_iter().zip(parts).try_for_each(|(strip, mut part)| {
            let rows = rows.iter().filter(|y| *y / STRIP == *strip);
            if cancel.is_cancelled() {
                return Err(Cancelled);
            }
            vectorised(
                #[inline(always)]
                || {
                    let mut work =
                        Work::<N> { noisy, guide, frame, strengths, cosines: &cosines, out: &mut part };
                    work.strip::<C>(&columns, rows.clone());
                },
            );
            Ok(())
        })?;
    }
    Ok(sums)
}

/// A rectangle and so much around it, within the frame.
pub(super) fn around(rect: Rect, border: usize, frame: Size) -> Rect {
    let (x, y) = (rect.x.saturating_sub(border), rect.y.saturating_sub(border));
    let (right, bottom) =
        ((rect.right() + border).min(frame.width), (rect.bottom() + border).min(frame.height));
    Rect { x, y, width: right - x, height: bottom - y }
}

/// Where blocks begin that have a say in what lies between `begin` and `end`: every few, and at the frame's end.
fn begins(begin: usize, end: usize, length: usize) -> Vec<usize> {
    let last = length - SIDE;
    let (least, most) = (begin.saturating_sub(REACH + SIDE - 1), (end + REACH).min(last + 1));
    let all = (0..last).step_by(STEP).chain([last]);
    all.filter(|at| (least..most).contains(at)).collect()
}

struct Work<'a, 'b, const N: usize> {
    noisy: &'a Planes,
    guide: &'a Planes,
    frame: Size,
    strengths: [f32; 4],
    cosines: &'a Cosines,
    out: &'a mut Rows<'b>,
}

impl<const N: usize> Work<'_, '_, N> {
    #[inline(always)]
    fn strip<'r, C: Clean<N>>(&mut self, columns: &[usize], rows: impl Iterator<Item = &'r usize> + Clone) {
        let mut compared = Compared::new();
        let mut alike = vec![Alike::<N>::ITSELF; SPAN / STEP + 2];
        for at in columns.chunk_by(|a, b| a / SPAN == b / SPAN) {
            for y in rows.clone() {
                let alike = &mut alike[..at.len()];
                let frame = (self.frame.width, self.frame.height);
                compared.find(&self.guide.plane(0), frame, (at, *y), alike);
                for (x, alike) in at.iter().zip(alike.iter()) {
                    let place = |(across, down): (i16, i16)| {
                        (x.wrapping_add_signed(across.into()), y.wrapping_add_signed(down.into()))
                    };
                    self.group::<C>(&alike.shifts.map(place));
                }
            }
        }
    }

    /// Cleans one group.
    #[inline(always)]
    fn group<C: Clean<N>>(&mut self, places: &[(usize, usize); N]) {
        let mut stack = Stack::<N>::EMPTY;
        let mut guide = Stack::<N>::EMPTY;
        self.out.count(places);
        for k in 0..4 {
            fill(&mut stack, self.noisy, k, places);
            stack.forth(self.cosines);
            if C::GUIDED {
                fill(&mut guide, self.guide, k, places);
                guide.forth(self.cosines);
            }
            let left = C::clean(&mut stack, &guide, self.strengths[k]);
            stack.back(self.cosines);
            self.out.add(k, &stack, places, 1.0 / left);
        }
    }
}

#[inline(always)]
fn fill<const N: usize>(stack: &mut Stack<N>, planes: &Planes, k: usize, places: &[(usize, usize); N]) {
    let plane = planes.plane(k);
    for (r, row) in stack.0.iter_mut().enumerate() {
        for (block, (x, y)) in row.iter_mut().zip(places) {
            *block = plane.row_of_block(*x, y + r);
        }
    }
}
