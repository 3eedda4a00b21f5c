//! Scale after scale of a plane, each on every second row and column of the one before.

use darkroot_colour::simd::vectorised;

use super::rows::{hat, hat_along, power_of_pairs, twice};
use super::shrink::removed;

/// Columns and rows below which a plane holds no further scale.
const SMALLEST: usize = 8;

/// Puts the noise of a plane in its place: of the scales whose thresholds are given, beginning with details between this
/// plane and its low-pass with taps two apart.
pub(super) fn noise(plane: &mut [f32], columns: usize, thresholds: &[f32]) {
    let rows = plane.len() / columns.max(1);
    let Some((&threshold, further)) = thresholds.split_first() else { return plane.fill(0.0) };
    if columns < SMALLEST || rows < SMALLEST {
        return plane.fill(0.0);
    }
    let mut smooth = vec![0f32; plane.len()];
    vectorised(
        #[inline(always)]
        || low_pass(plane, columns, &mut smooth),
    );
    let half = columns.div_ceil(2);
    let mut deeper: Vec<f32> =
        smooth.chunks_exact(columns).step_by(2).flat_map(|row| row.iter().step_by(2).copied()).collect();
    noise(&mut deeper, half, further);
    vectorised(
        #[inline(always)]
        || {
            for (v, smooth) in plane.iter_mut().zip(&smooth) {
                *v -= smooth;
            }
            shrink(plane, columns, threshold, &deeper);
        },
    );
}

/// The low-pass with taps two apart; beyond its edges the plane is mirrored.
#[inline(always)]
fn low_pass(plane: &[f32], columns: usize, out: &mut [f32]) {
    let rows = plane.len() / columns;
    let mut line = vec![0f32; columns];
    for (y, out) in out.chunks_exact_mut(columns).enumerate() {
        let row = |y: usize| &plane[y * columns..][..columns];
        let [above, below] = beside(y, rows);
        hat(row(above), row(y), row(below), &mut line);
        hat_along(&line, 2, out);
        for x in [0, 1, columns - 2, columns - 1] {
            let [left, right] = beside(x, columns);
            out[x] = 0.25 * (line[left] + line[right]) + 0.5 * line[x];
        }
    }
}

/// Two before and two after, mirrored.
#[inline(always)]
fn beside(at: usize, count: usize) -> [usize; 2] {
    let before = at.abs_diff(2);
    let after = if at + 2 < count { at + 2 } else { 2 * (count - 1) - (at + 2) };
    [before, after]
}

/// Puts what is to be taken in the place of details, and adds what is to be taken at deeper scales, which is known at every
/// second row and column.
#[inline(always)]
fn shrink(details: &mut [f32], columns: usize, threshold: f32, deeper: &[f32]) {
    let rows = details.len() / columns;
    let (half, pairs) = (columns.div_ceil(2), rows.div_ceil(2));
    let even = columns / 2 * 2;
    let (mut sums, mut line) = (vec![0f32; columns], vec![0f32; half]);
    let mut power = vec![0f32; half * pairs];
    for (pair, power) in power.chunks_exact_mut(half).enumerate() {
        let upper = &details[2 * pair * columns..][..columns];
        let lower = if 2 * pair + 1 < rows { &details[(2 * pair + 1) * columns..][..columns] } else { upper };
        power_of_pairs(&upper[..even], &lower[..even], &mut sums, power);
        if even < columns {
            power[half - 1] = 0.5 * (upper[even] * upper[even] + lower[even] * lower[even]);
        }
    }
    let mut factors = vec![0f32; 2 * half];
    let mut shares = vec![0f32; half];
    let mut fill = vec![0f32; 2 * half];
    for pair in 0..pairs {
        let row = |p: usize| &power[p.min(pairs - 1) * half..][..half];
        hat(row(pair.saturating_sub(1)), row(pair), row(pair + 1), &mut line);
        hat_along(&line, 1, &mut shares);
        shares[0] = 0.75 * line[0] + 0.25 * line[1];
        shares[half - 1] = 0.75 * line[half - 1] + 0.25 * line[half - 2];
        for share in &mut shares {
            *share = removed(threshold, *share);
        }
        twice(&shares, &mut factors);
        for (y, row) in (2 * pair..).zip(details[2 * pair * columns..].chunks_exact_mut(columns).take(2)) {
            let deep = |y: usize| &deeper[y.min(pairs - 1) * half..][..half];
            let (upper, lower) = (deep(y / 2), deep(y.div_ceil(2)));
            for i in 0..half {
                line[i] = 0.5 * (upper[i] + lower[i]);
            }
            for (pair, v) in fill.chunks_exact_mut(2).zip(line.windows(2)) {
                pair[0] = v[0];
                pair[1] = 0.5 * (v[0] + v[1]);
            }
            fill[2 * half - 2..].fill(line[half - 1]);
            for ((v, factor), fill) in row.iter_mut().zip(&factors).zip(&fill) {
                *v = *v * factor + fill;
            }
        }
    }
}
