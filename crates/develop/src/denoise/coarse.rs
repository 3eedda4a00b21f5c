//! The noise of the coarse scales, for a whole frame.

use darkroot_colour::simd::vectorised;
use darkroot_photo::Capture;
use rayon::prelude::*;

use super::Denoiser;
use super::pyramid;
use super::rows::{Places, Source, between, hat};
use super::shrink::{FINE, SCALES, threshold};
use crate::light::LinearLight;
use crate::view::{Cancel, Cancelled};

/// Rows of the result that one task makes.
const ROWS: usize = 32;
/// Columns of a plane that are looked at beyond the area on each side; whole pairs.
const MARGIN: usize = 4;

/// What to take from the rotated planes for the noise of the coarse scales, at every second row and column of them.
#[derive(Debug)]
pub(crate) struct Coarse {
    columns: usize,
    rows: usize,
    planes: [Vec<f32>; 4],
}

impl Coarse {
    /// Looks at the whole active area.
    pub(super) fn of(
        filter: &Denoiser,
        capture: &Capture,
        light: &LinearLight,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let area = capture.active_area;
        let (columns, rows) = (area.width.div_ceil(4) + 1, area.height.div_ceil(4) + 1);
        let mut planes = [0; 4].map(|_| vec![0f32; columns * rows]);
        let [a, b, c, d] = planes.each_mut().map(|p| p.par_chunks_mut(columns * ROWS));
        let source = filter.source(capture, light);
        a.zip(b).zip(c.zip(d)).enumerate().try_for_each(|(i, ((a, b), (c, d)))| {
            if cancel.is_cancelled() {
                return Err(Cancelled);
            }
            strip(filter, source, i * ROWS, columns, [a, b, c, d]);
            Ok(())
        })?;
        planes.par_iter_mut().zip(filter.strengths).for_each(|(plane, strength)| {
            let thresholds: Vec<f32> =
                filter.unit.variances[FINE..SCALES].iter().map(|&v| threshold(v, strength)).collect();
            pyramid::noise(plane, columns, &thresholds);
        });
        Ok(Self { columns, rows, planes })
    }

    /// What to take from row `y` of a plane from column `x` on, both even or odd and counted from the active area's corner.
    /// Columns are even in number, and the first is even; `line` has room for one more than half of them.
    #[inline(always)]
    pub(super) fn row(&self, plane: usize, x: isize, y: isize, line: &mut [f32], out: &mut [f32]) {
        let row = |y: isize| {
            let y = y.clamp(0, self.rows as isize - 1) as usize;
            &self.planes[plane][y * self.columns..][..self.columns]
        };
        let (first, needed) = (x.div_euclid(2), out.len() / 2 + 1);
        let upper = row(y.div_euclid(2));
        let lower = if y.rem_euclid(2) == 0 { upper } else { row(y.div_euclid(2) + 1) };
        if first >= 0 && first as usize + needed <= self.columns {
            let (upper, lower) = (&upper[first as usize..][..needed], &lower[first as usize..][..needed]);
            for i in 0..needed {
                line[i] = 0.5 * (upper[i] + lower[i]);
            }
        } else {
            for (i, v) in line.iter_mut().enumerate() {
                let x = (first + i as isize).clamp(0, self.columns as isize - 1) as usize;
                *v = 0.5 * (upper[x] + lower[x]);
            }
        }
        between(line, out);
    }
}

/// Rows of the planes from `top` on after the low-passes of the fine scales, at every second row and column.
fn strip(filter: &Denoiser, source: Source<'_>, top: usize, columns: usize, planes: [&mut [f32]; 4]) {
    let width = 2 * columns + 2 * MARGIN;
    let mut mosaic = [0; 2].map(|_| vec![0f32; 2 * width]);
    let mut places = Places::new(width);
    // Rows of the planes: three in turn, of which the last is the next one's first; and what became of three.
    let mut rotated = [0; 3].map(|_| [0; 4].map(|_| vec![0f32; width]));
    let mut down = vec![0f32; width];
    let mut smooth = [0; 3].map(|_| [0; 4].map(|_| vec![0f32; columns + 2]));
    let count = planes[0].len() / columns;
    let mut planes = planes;
    let mut load = |y: isize, rows: &mut [Vec<f32>; 4]| {
        for (i, row) in mosaic.iter_mut().enumerate() {
            source.row(-2 * MARGIN as isize, 2 * y + i as isize, row);
        }
        vectorised(
            #[inline(always)]
            || places.rotated(filter, (&mosaic[0], &mosaic[1]), rows.each_mut().map(|r| &mut r[..])),
        );
    };
    let row_of = |i: usize| 2 * (top as isize + i as isize - 1);
    load(row_of(0) - 1, &mut rotated[2]);
    for i in 0..count + 2 {
        rotated.swap(0, 2);
        load(row_of(i), &mut rotated[1]);
        load(row_of(i) + 1, &mut rotated[2]);
        smooth.rotate_left(1);
        vectorised(
            #[inline(always)]
            || {
                for k in 0..4 {
                    hat(&rotated[0][k], &rotated[1][k], &rotated[2][k], &mut down);
                    // Two columns beyond the area's, every second one.
                    let pairs = down[MARGIN - 3..].chunks_exact(2).zip(down[MARGIN - 1..].chunks_exact(2));
                    for (out, (left, right)) in smooth[2][k].iter_mut().zip(pairs) {
                        *out = 0.25 * (left[0] + right[0]) + 0.5 * left[1];
                    }
                    if i >= 2 {
                        let down = &mut down[..columns + 2];
                        hat(&smooth[0][k], &smooth[1][k], &smooth[2][k], down);
                        let out = &mut planes[k][(i - 2) * columns..][..columns];
                        hat(&down[..columns], &down[1..=columns], &down[2..], out);
                    }
                }
            },
        );
    }
}
