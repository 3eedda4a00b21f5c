//! A tile of the mosaic with a border: what the neighbourhood stages work on.
//!
//! Beyond the active area the border continues the mosaic: mirrored for Bayer (which keeps the phase of its
//! 2x2 block), shifted by whole periods for larger arrays.

use darkroot_photo::{Capture, Cfa, Counts, Layout, Mosaic, Rect, Size};
use darkroot_profile::simd::vectorised;

use crate::corrections::{self, Run};
use crate::level::Levels;
use crate::{balance, plan::Plan};

/// Linear, corrected, balanced samples of `rect` (in frame coordinates, inside the active area) and of a border
/// of `border` pixels around it.
pub(crate) fn tile(capture: &Capture, plan: &Plan, rect: Rect, border: usize) -> Mosaic<f32> {
    match &capture.counts {
        Counts::U16(counts) => cut(capture, counts, plan, rect, border),
        Counts::F32(counts) => cut(capture, counts, plan, rect, border),
    }
}

fn cut<T: Copy + Into<f32>>(
    capture: &Capture,
    counts: &Mosaic<T>,
    plan: &Plan,
    rect: Rect,
    border: usize,
) -> Mosaic<f32> {
    let area = capture.active_area;
    let planes = counts.layout.planes();
    let period = match &counts.layout {
        Layout::Cfa(cfa) => (cfa.width(), cfa.height()),
        Layout::Monochrome | Layout::Rgb => (1, 1),
    };
    let size = Size { width: rect.width + 2 * border, height: rect.height + 2 * border };
    let columns: Vec<usize> =
        (0..size.width).map(|i| inside(rect.x + i, border, area.x, area.width, period.0)).collect();
    let (Some(&first), Some(&last)) = (columns.iter().min(), columns.iter().max()) else {
        return Mosaic { size, layout: counts.layout.clone(), samples: Vec::new() };
    };
    // Columns that stand in the tile as they stand in the frame.
    let straight = columns.windows(2).all(|w| w[1] == w[0] + 1);
    let mut samples = vec![0f32; size.area() * planes];
    let mut light = vec![0f32; (last - first + 1) * planes];
    for (i, out) in samples.chunks_exact_mut(size.width * planes).enumerate() {
        let y = inside(rect.y + i, border, area.y, area.height, period.1);
        let start = (y * counts.size.width + first) * planes;
        let stored = &counts.samples[start..start + light.len()];
        linear(&plan.levels, stored, first * planes, y, &mut light);
        if !plan.mosaic_corrections.is_empty() {
            let run = Run { x: first - area.x, y: y - area.y, planes, active: area.size() };
            corrections::row(&mut light, &plan.mosaic_corrections, run);
        }
        balance::row(&mut light, &counts.layout, plan.multipliers, first, y);
        if straight {
            out.copy_from_slice(&light);
        } else {
            for (pixel, &x) in out.chunks_exact_mut(planes).zip(&columns) {
                pixel.copy_from_slice(&light[(x - first) * planes..][..planes]);
            }
        }
    }
    let layout = match &counts.layout {
        Layout::Cfa(cfa) => Layout::Cfa(shifted_back(cfa, rect, border)),
        other => other.clone(),
    };
    Mosaic { size, layout, samples }
}

fn linear<T: Copy + Into<f32>>(levels: &Levels, stored: &[T], first: usize, y: usize, light: &mut [f32]) {
    vectorised(
        #[inline(always)]
        || levels.row(stored, first, y, light),
    );
}

/// The array as seen from `border` pixels left of and above `rect`.
fn shifted_back(cfa: &Cfa, rect: Rect, border: usize) -> Cfa {
    let back = |at: usize, period: usize| at + border.div_ceil(period) * period - border;
    cfa.shifted(back(rect.x, cfa.width()), back(rect.y, cfa.height()))
}

/// The column (row) inside an area that stands for column `at - border`; `start` and `length` are the area's.
fn inside(at: usize, border: usize, start: usize, length: usize, period: usize) -> usize {
    // Distance from the area's start, as a signed number.
    let mut d = at as isize - border as isize - start as isize;
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
            for at in 0..length + 24 {
                let x = inside(10 + at, 12, 10, length, 2);
                assert!((10..10 + length).contains(&x));
                if length > 2 {
                    assert_eq!(x % 2, (10 + at) % 2, "{at} of {length}");
                }
            }
        }
    }

    #[test]
    fn the_border_of_an_x_trans_mosaic_keeps_the_phase() {
        for at in 0..60 {
            let x = inside(at, 12, 0, 36, 6);
            assert_eq!(x % 6, at % 6, "{at}");
        }
    }
}
