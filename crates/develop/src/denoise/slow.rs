//! The filter as its definition says, sample by sample: what the fast one is tested against.

use darkroot_photo::Capture;

use super::Denoiser;
use super::shrink::{FINE, SCALES, UnitNoise, removed, threshold};
use crate::light::LinearLight;

const TAPS: [(isize, f32); 3] = [(-1, 0.25), (0, 0.5), (1, 0.25)];

/// A plane as a function of column and row, which may lie anywhere.
type Plane<'a> = dyn Fn(isize, isize) -> f32 + 'a;

fn low_pass(plane: &Plane<'_>, step: isize, x: isize, y: isize) -> f32 {
    let at = |(i, w): (isize, f32), (j, v): (isize, f32)| w * v * plane(x + i * step, y + j * step);
    TAPS.into_iter().flat_map(|row| TAPS.map(|column| at(column, row))).sum()
}

/// Mean square of a block of 2 x 2, and of those around it with weights 1 2 1.
fn power(details: &Plane<'_>, x: isize, y: isize) -> f32 {
    let (x, y) = (x.div_euclid(2), y.div_euclid(2));
    let of_block = |x: isize, y: isize| {
        let square = |i: isize, j: isize| details(2 * x + i, 2 * y + j).powi(2);
        0.25 * (square(0, 0) + square(1, 0) + square(0, 1) + square(1, 1))
    };
    TAPS.into_iter().flat_map(|(j, v)| TAPS.map(|(i, w)| w * v * of_block(x + i, y + j))).sum()
}

/// What to take from a plane of the coarse scales, beyond whose edges details and low-passes are mirrored.
fn coarse_noise(plane: &[f32], columns: usize, thresholds: &[f32]) -> Vec<f32> {
    let rows = plane.len() / columns;
    let Some((&threshold, further)) = thresholds.split_first() else { return vec![0.0; plane.len()] };
    if columns < 8 || rows < 8 {
        return vec![0.0; plane.len()];
    }
    let mirror = |at: isize, count: usize| {
        let at = at.unsigned_abs();
        if at < count { at } else { 2 * (count - 1) - at }
    };
    let at = |x: isize, y: isize| plane[mirror(y, rows) * columns + mirror(x, columns)];
    let smooth = |x: isize, y: isize| low_pass(&at, 2, x, y);
    // In the power the last column or row of an odd number stands for its missing neighbour, the outermost block for the
    // one beyond it.
    let blocks = |count: usize| count.div_ceil(2) as isize;
    let detail = |x: isize, y: isize| {
        let hold = |at: isize, count: usize| {
            let block = at.div_euclid(2).clamp(0, blocks(count) - 1);
            (2 * block + at.rem_euclid(2)).min(count as isize - 1)
        };
        let (x, y) = (hold(x, columns), hold(y, rows));
        at(x, y) - smooth(x, y)
    };
    let (half, half_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let every_second: Vec<f32> =
        (0..half * half_rows).map(|i| smooth(2 * (i % half) as isize, 2 * (i / half) as isize)).collect();
    let deeper = coarse_noise(&every_second, half, further);
    let deep = |x: usize, y: usize| deeper[y.min(half_rows - 1) * half + x.min(half - 1)];
    (0..plane.len())
        .map(|i| {
            let (x, y) = (i % columns, i / columns);
            let share = removed(threshold, power(&detail, x as isize, y as isize));
            let (left, right, up, down) = (x / 2, x.div_ceil(2), y / 2, y.div_ceil(2));
            let fill = 0.25 * (deep(left, up) + deep(right, up) + deep(left, down) + deep(right, down));
            share * detail(x as isize, y as isize) + fill
        })
        .collect()
}

/// The light of the whole active area without noise.
pub(super) fn denoised(filter: &Denoiser, capture: &Capture, light: &LinearLight) -> Vec<f32> {
    let area = capture.active_area;
    let source = filter.source(capture, light);
    let sample = |x: isize, y: isize| {
        let mut one = [0.0];
        source.row(x, y, &mut one);
        one[0]
    };
    // All planes with a margin, so that nothing is computed twice.
    const MARGIN: isize = 16;
    let (width, height) = (area.width.div_ceil(2) + 32, area.height.div_ceil(2) + 32);
    let places = [(0, 0), (1, 0), (0, 1), (1, 1)];
    let rotated: Vec<Vec<f32>> = (0..4)
        .map(|k| {
            let at = |i: usize| {
                let (x, y) = ((i % width) as isize - MARGIN, (i / width) as isize - MARGIN);
                let root = |p: usize| {
                    let (u, v) = places[p];
                    filter.rotation.rows[k][p] * filter.stabilisers[p].root(sample(2 * x + u, 2 * y + v))
                };
                (0..4).map(root).sum()
            };
            (0..width * height).map(at).collect()
        })
        .collect();
    let unit = UnitNoise::new();
    let mut clean = vec![vec![0f32; width * height]; 4];
    let mut left = clean.clone();
    for k in 0..4 {
        let strength = filter.strengths[k];
        let at = |x: isize, y: isize| rotated[k][(y + MARGIN) as usize * width + (x + MARGIN) as usize];
        let first = |x: isize, y: isize| low_pass(&at, 1, x, y);
        let second = |x: isize, y: isize| low_pass(&first, 2, x, y);
        let details: [&Plane<'_>; FINE] =
            [&|x, y| at(x, y) - first(x, y), &|x, y| first(x, y) - second(x, y)];
        let (columns, rows) = (area.width.div_ceil(4) + 1, area.height.div_ceil(4) + 1);
        let kept: Vec<f32> = (0..columns * rows)
            .map(|i| second(2 * (i % columns) as isize, 2 * (i / columns) as isize))
            .collect();
        let thresholds: Vec<f32> =
            unit.variances[FINE..SCALES].iter().map(|v| threshold(*v, strength)).collect();
        let coarse = coarse_noise(&kept, columns, &thresholds);
        for y in 0..area.height.div_ceil(2) {
            for x in 0..area.width.div_ceil(2) {
                let (u, v) = (x as isize, y as isize);
                let shares =
                    [0, 1].map(|j| removed(threshold(unit.variances[j], strength), power(details[j], u, v)));
                let at_place = |x: usize, y: usize| coarse[y * columns + x];
                let (west, east, north, south) = (x / 2, x.div_ceil(2), y / 2, y.div_ceil(2));
                let of_coarse = 0.25
                    * (at_place(west, north)
                        + at_place(east, north)
                        + at_place(west, south)
                        + at_place(east, south));
                let place = (y + 16) * width + x + 16;
                clean[k][place] =
                    at(u, v) - shares[0] * details[0](u, v) - shares[1] * details[1](u, v) - of_coarse;
                left[k][place] = unit.left(shares);
            }
        }
    }
    (0..area.width * area.height)
        .map(|i| {
            let (x, y) = (i % area.width, i / area.width);
            let (p, place) = (y % 2 * 2 + x % 2, (y / 2 + 16) * width + x / 2 + 16);
            let own = sample(x as isize, y as isize);
            let weight = |k: usize| filter.rotation.rows[k][p];
            let root: f32 = (0..4).map(|k| weight(k) * clean[k][place]).sum();
            let left: f32 = (0..4).map(|k| weight(k).powi(2) * left[k][place]).sum();
            if own < filter.limits[p] { filter.stabilisers[p].light(root, 1.0 - left) } else { own }
        })
        .collect()
}
