//! A tile of the mosaic: what the neighbourhood stages work on.
//!
//! Beyond the active area the mosaic is continued: mirrored for Bayer (which keeps the phase of its 2x2 block),
//! shifted by whole periods for larger arrays.

use darkroot_photo::{Capture, Mosaic, Rect, Size};

use crate::balance;
use crate::base::Base;
use crate::highlights::Treatment;
use crate::light::{LinearLight, channels, layout_from, period};

/// Gives the levelled light of row `y` of the frame from column `x` on.
pub(crate) type Levelled<'a> = dyn Fn(usize, usize, &mut [f32]) + 'a;

/// Makes `tile` the linear, corrected, balanced samples of a rectangle whose top left corner lies in column `x` of row `y`
/// of the frame; it may reach beyond the active area on all sides. Their light before corrections is what `levelled` says.
pub(crate) fn tile(
    capture: &Capture,
    (linear, levelled): (&LinearLight, &Levelled<'_>),
    multipliers: [f32; 3],
    (x, y): (isize, isize),
    size: Size,
    tile: &mut Mosaic<f32>,
) {
    let area = capture.active_area;
    let stored = capture.counts.layout();
    let (planes, period) = (stored.planes(), period(stored));
    tile.layout = layout_from(stored, x, y);
    tile.size = size;
    tile.samples.resize(size.area() * planes, 0.0);
    let columns: Vec<usize> =
        (0..size.width).map(|i| inside(x + i as isize, area.x, area.width, period.0)).collect();
    let (Some(&first), Some(&last)) = (columns.iter().min(), columns.iter().max()) else {
        return;
    };
    // Columns that stand in the tile as they stand in the frame.
    let straight = columns.windows(2).all(|w| w[1] == w[0] + 1);
    let mut light = vec![0f32; if straight { 0 } else { (last - first + 1) * planes }];
    for (i, out) in tile.samples.chunks_exact_mut(size.width * planes).enumerate() {
        let y = inside(y + i as isize, area.y, area.height, period.1);
        let row = if straight { &mut *out } else { &mut light };
        levelled(first, y, row);
        linear.correct(first, y, row);
        balance::row(row, stored, multipliers, first, y);
        if !straight {
            for (pixel, &x) in out.chunks_exact_mut(planes).zip(&columns) {
                pixel.copy_from_slice(&light[(x - first) * planes..][..planes]);
            }
        }
    }
}

/// The rectangle of the active area whose samples a tile is made of.
pub(crate) fn covered(capture: &Capture, (x, y): (isize, isize), size: Size) -> Rect {
    let area = capture.active_area;
    let period = period(capture.counts.layout());
    let span = |at: isize, count: usize, start: usize, length: usize, period: usize| {
        let inside = (0..count as isize).map(|i| inside(at + i, start, length, period));
        let least = inside.clone().min().unwrap_or(start);
        (least, inside.max().map_or(0, |most| most + 1 - least))
    };
    let (x, width) = span(x, size.width, area.x, area.width, period.0);
    let (y, height) = span(y, size.height, area.y, area.height, period.1);
    Rect { x, y, width, height }
}

/// Makes `ends` the balanced light at which each sample of such a tile clips, where highlights are rebuilt and the file's
/// corrections make that differ from place to place; empties it elsewhere.
pub(crate) fn tile_ends(base: &Base, begin: (isize, isize), size: Size, ends: &mut Mosaic<f32>) {
    ends.samples.clear();
    let (Treatment::Rebuild(rebuild), true) = (&base.highlights, base.light.is_corrected()) else { return };
    let saturation = [0, 1, 2].map(|c| rebuild.limits[c] / base.multipliers[c]);
    let stored = base.capture.counts.layout();
    let saturated = |x: usize, y: usize, row: &mut [f32]| {
        for (end, c) in row.iter_mut().zip(channels(stored, x, y, 1).into_iter().cycle()) {
            *end = saturation[c];
        }
    };
    tile(&base.capture, (&base.light, &saturated), base.multipliers, begin, size, ends);
}

/// The column (row) inside an area that stands for column `at`; `start` and `length` are the area's.
pub(crate) fn inside(at: isize, start: usize, length: usize, period: usize) -> usize {
    // Distance from the area's start.
    let mut d = at - start as isize;
    let (length, period) = (length as isize, period as isize);
    if period <= 2 {
        while d < 0 || d >= length {
            if length == 1 {
                return start;
            }
            d = if d < 0 { -d } else { 2 * (length - 1) - d };
        }
    } else {
        let whole = (length / period).max(1) * period;
        if d < 0 || d >= length {
            // The nearest whole number of periods that leads inside.
            d = if d < 0 { d.rem_euclid(period) } else { whole - period + (d - whole).rem_euclid(period) };
            d = d.clamp(0, length - 1);
        }
    }
    start + d as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_of_a_bayer_mosaic_keeps_the_phase() {
        for length in 2..9usize {
            for at in -12..length as isize + 12 {
                let x = inside(10 + at, 10, length, 2);
                assert!((10..10 + length).contains(&x));
                if length > 2 {
                    assert_eq!(x as isize & 1, at & 1, "{at} of {length}");
                }
            }
        }
    }

    #[test]
    fn the_border_of_an_x_trans_mosaic_keeps_the_phase() {
        for at in -12..48isize {
            let x = inside(at, 0, 36, 6);
            assert_eq!(x as isize % 6, at.rem_euclid(6), "{at}");
        }
    }
}
