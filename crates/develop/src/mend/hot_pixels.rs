//! Pixels that are hot or dead: far from all of their surroundings, while nothing reaches their neighbours.
//!
//! A star is as far from the samples of its colour as a hot pixel, because the nearest of them lie two pixels away. But a lens
//! spreads it: a star of 1.2 pixels (full width at half of the maximum) gives each of the four pixels beside its own 15 % of
//! its light. So a pixel is hot only if those four, all together, rise by less than a tenth of what it rises by.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Cfa, Counts};
use rayon::prelude::*;

use crate::denoise::NoiseModel;
use crate::light::LinearLight;

/// How many standard deviations of noise a pixel must be from all samples of its colour around it.
const FAR: f32 = 15.0;
/// Share of the brightest of them by which it must rise, or of the darkest by which it must fall.
const SHARE: f32 = 0.5;
/// Largest difference between the samples of its colour around it, as a share of its rise, and in standard deviations of noise:
/// among details a bright dot may be one of them.
const CALM: f32 = 0.1;
const CALM_NOISE: f32 = 5.0;
/// Largest rise of the four pixels beside it together, as a share of its own.
const SPREAD: f32 = 0.1;
/// Rise of those four beside the sharpest star, whatever its colour, and three standard deviations of its noise (of four
/// samples, less a mean of twelve): it must be certain that it is less than that.
const SHARPEST: f32 = 0.3;
const UNCERTAIN: f32 = 8.0;
/// Rows and columns at the edges that are left as they are: as far as is looked.
const EDGE: usize = 3;
/// More than one pixel in so many are no faults of a sensor but a texture that looks like them.
const RARE: usize = 1000;
/// Rows that one task looks at.
const ROWS: usize = 64;
/// Pixels that are looked at together.
const RUN: usize = 64;

/// Hot and dead pixels of the active area, in rising order of their index in the frame, with the light that they get: the
/// median of the samples of their colour around them.
pub(super) fn found(
    capture: &Capture,
    light: &LinearLight,
    model: &NoiseModel,
    cfa: &Cfa,
) -> Vec<(usize, f32)> {
    let Counts::U16(counts) = &capture.counts else { return Vec::new() };
    let (area, width) = (capture.active_area, counts.size.width);
    if area.width <= 2 * EDGE || area.height <= 2 * EDGE {
        return Vec::new();
    }
    let rows: Vec<usize> = (area.y + EDGE..area.bottom() - EDGE).collect();
    let columns = area.x + EDGE..area.right() - EDGE;
    // In counts, less than any outlier rises by.
    let black = model.channels.iter().map(|line| line.at(0.0)).fold(f32::MAX, f32::min).sqrt();
    let scale = capture.white.0.iter().fold(f32::MAX, |a, &b| a.min(b)) - capture.black.mean();
    let least = (FAR * black * scale * 0.5).clamp(1.0, 60_000.0) as u16;
    let darkest = capture.black.values.iter().fold(0f32, |a, &b| a.max(b)).ceil() as u16;
    let of_rows = |rows: &[usize]| {
        let mut found = Vec::new();
        let mut flags = vec![0u16; columns.len()];
        for &y in rows {
            let row = |y: usize, shift: isize| {
                let begin = (y * width + columns.start).wrapping_add_signed(shift);
                &counts.samples[begin..begin + columns.len()]
            };
            let around = [row(y, -2), row(y, 2), row(y - 2, 0), row(y + 2, 0)];
            outliers(row(y, 0), around, (least, darkest), &mut flags);
            for (run, flags) in flags.chunks(RUN).enumerate() {
                if flags.iter().fold(0, |any, flag| any | flag) == 0 {
                    continue;
                }
                for x in (0..flags.len()).filter(|i| flags[*i] > 0).map(|i| columns.start + run * RUN + i) {
                    let at = |dx: isize, dy: isize| {
                        let mut one = [0.0];
                        let (x, y) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                        light.levelled(&capture.counts, x, y, &mut one);
                        one[0]
                    };
                    let channel = cfa.at(x - area.x, y - area.y).plane().unwrap_or(1);
                    if let Some(light) = mended(at, |light| model.channels[channel].at(light)) {
                        found.push((y * width + x, light));
                    }
                }
            }
        }
        found
    };
    let found: Vec<(usize, f32)> = rows.par_chunks(ROWS).flat_map_iter(of_rows).collect();
    if found.len() * RARE > area.width * area.height { Vec::new() } else { found }
}

/// Marks samples that lie more than `least` counts above all of these or below all of them, and by nearly half ([`SHARE`]) of
/// the light of the nearest, whose black is at most `black`.
fn outliers(samples: &[u16], around: [&[u16]; 4], (least, black): (u16, u16), flags: &mut [u16]) {
    vectorised(
        #[inline(always)]
        || {
            let n = flags.len();
            let [a, b, c, d] = around.map(|row| &row[..n]);
            let samples = &samples[..n];
            for i in 0..n {
                let most = a[i].max(b[i]).max(c[i].max(d[i]));
                let fewest = a[i].min(b[i]).min(c[i].min(d[i]));
                let (rise, fall) = (samples[i].saturating_sub(most), fewest.saturating_sub(samples[i]));
                // A little less than half: whatever is rounded, nothing is missed.
                let share = |edge: u16| edge.saturating_sub(black) / 32 * 15;
                let far = rise.saturating_sub(share(most)).max(fall.saturating_sub(share(fewest)));
                flags[i] = far.min(rise.max(fall).saturating_sub(least));
            }
        },
    );
}

/// The light that a pixel gets if it is hot or dead. `at` tells the light so many columns and rows from it, `variance` the
/// noise of its colour.
fn mended(at: impl Fn(isize, isize) -> f32, variance: impl Fn(f32) -> f32) -> Option<f32> {
    let own = at(0, 0);
    let places = [(-2, -2), (0, -2), (2, -2), (-2, 0), (2, 0), (-2, 2), (0, 2), (2, 2)];
    let mut around = places.map(|(x, y)| at(x, y));
    around.sort_unstable_by(f32::total_cmp);
    let (least, most) = (around[0], around[7]);
    let median = 0.5 * (around[3] + around[4]);
    let edge = if own > most { most } else { least };
    if (least..=most).contains(&own) {
        return None;
    }
    let rise = own - edge;
    let noise = variance(edge).sqrt();
    let calm = most - least < CALM * rise.abs() + CALM_NOISE * noise;
    if rise.abs() < FAR * noise || rise.abs() < SHARE * edge || !calm {
        return None;
    }
    // Beside it, against samples of the same colours two pixels on: along the row and along the column.
    // Their median, not their mean: other stars may lie among them.
    let beside = at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1);
    let middle = |places: [(isize, isize); 6]| {
        let mut light = places.map(|(x, y)| at(x, y));
        light.sort_unstable_by(f32::total_cmp);
        0.5 * (light[2] + light[3])
    };
    let along = middle([(-3, 0), (3, 0), (-1, -2), (1, -2), (-1, 2), (1, 2)]);
    let down = middle([(0, -3), (0, 3), (-2, -1), (-2, 1), (2, -1), (2, 1)]);
    let spread = beside - 2.0 * (along + down);
    // To the same side as the pixel.
    let most = (SPREAD * rise.abs()).min(SHARPEST * rise.abs() - UNCERTAIN * noise);
    (spread * rise.signum() < most).then_some(median)
}
