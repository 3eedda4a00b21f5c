//! Banding: rows whose samples all lie a little too high or too low, as an amplifier left them.
//!
//! Masked columns beside the picture show it best (`masked.rs`): no light falls there. Without them, in flat windows the mean of a
//! row is compared with a line through those of its colour above and below. What is so found is called banding only if nothing
//! else could be it:
//!
//! - windows beside each other say the same, far more than their noise allows, and so do the left and the right half;
//! - it is as strong where there is much light as where there is little: stripes of a scene grow with its light;
//! - it says nothing about the next rows: what a lens has drawn does.
//!
//! Rows are then moved by what is certain of their offset (Wiener). The mean of every few rows stays as it is.

use darkroot_photo::{Capture, Cfa};
use rayon::prelude::*;

use super::masked;
use crate::denoise::NoiseModel;
use crate::light::LinearLight;

/// Rows and columns of a window.
pub(super) const ROWS: usize = 32;
const COLUMNS: usize = 64;
/// Samples of one colour in a column of a window, and in a row of it.
pub(super) const TALL: usize = ROWS / 2;
const WIDE: usize = COLUMNS / 2;
/// Most windows beside each other that are looked at.
const MOST_WINDOWS: usize = 24;
/// Windows are flat along rows up to so many times the variance of noise, and clip below so many times it.
const FLAT: (f32, f32) = (0.6, 1.3);
/// Brighter windows have too much noise of their own.
const BRIGHTEST: f32 = 0.25;
/// One window in so many is dark: its noise is what offsets are seen against.
const DARK: usize = 20;
/// Share of the rows of a picture that must have an offset.
const COVERED: f64 = 0.5;
/// How many standard errors the agreement of windows must be from none.
pub(super) const CERTAIN: f64 = 8.0;
/// Standard deviation of offsets that is seen, against that of the noise of dark samples.
const VISIBLE: f64 = 0.04;
/// How much brighter the brighter half of the windows must be than the darker one to tell offsets from stripes of a scene.
const APART: f64 = 1.5;
/// How far the agreement of the two halves may be from that within one, against what stripes of a scene would show.
const ADDED: f64 = 0.3;
/// The same for left and right.
const ALIKE: f64 = 0.3;
/// Offsets so strong against the light are none of a scene's stripes: rows of a scene do not differ as much at random.
const NO_SCENE: f64 = 0.5;
/// Largest dependence of a row's offset on those so many rows on.
const DEPENDENT: f64 = 0.3;
const LAGS: usize = 6;

/// Offsets of rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Banding {
    /// What to take from the light of each row of the active area.
    pub(super) offsets: Vec<f32>,
    /// Their standard deviation, as a share of that of the noise of dark samples.
    pub(super) strength: f32,
}

/// One colour of one window.
struct Window {
    /// Which one of those beside each other.
    number: usize,
    /// The first row of the active area in which it has samples; they lie in every second one.
    first: usize,
    light: f32,
    /// Means of rows less the line through them.
    rows: [f32; TALL],
    /// One by the variance of those.
    weight: f32,
}

/// Kinds of windows, each half of them: numbered odd, brighter, to the right.
const ODD: usize = 1;
const BRIGHT: usize = 2;
const RIGHT: usize = 4;
const KINDS: usize = 8;

/// Weighted sums over windows of a kind, and their weights.
type Row = [(f64, f64); KINDS];

/// Looks for banding in a Bayer capture; `cfa` are the filters from the active area's corner on.
pub(super) fn found(
    capture: &Capture,
    light: &LinearLight,
    model: &NoiseModel,
    cfa: &Cfa,
) -> Option<Banding> {
    let area = capture.active_area;
    let beside = area.width / COLUMNS;
    if area.height < 2 * ROWS || beside < 4 {
        return None;
    }
    let tops = tops(area.height);
    let windows: Vec<Window> =
        tops.par_iter().flat_map_iter(|top| of_band(capture, light, model, cfa, *top)).collect();
    let mut lights: Vec<f32> = windows.iter().map(|w| w.light).collect();
    lights.sort_unstable_by(f32::total_cmp);
    let (dark, middle) = (*lights.get(lights.len() / DARK)?, *lights.get(lights.len() / 2)?);
    let mut rows: Vec<Row> = vec![[(0.0, 0.0); KINDS]; area.height];
    let mut lights = [(0.0, 0.0); 2];
    for window in &windows {
        let is_bright = window.light > middle;
        let is_right = 2 * window.number >= beside.min(MOST_WINDOWS);
        let kind =
            ODD * (window.number % 2) + BRIGHT * usize::from(is_bright) + RIGHT * usize::from(is_right);
        let weight = f64::from(window.weight);
        for (i, v) in window.rows.iter().enumerate() {
            let sums = &mut rows[window.first + 2 * i][kind];
            *sums = (sums.0 + weight * f64::from(*v), sums.1 + weight);
        }
        let of = &mut lights[usize::from(is_bright)];
        *of = (of.0 + weight * f64::from(window.light), of.1 + weight);
    }
    let shown: Vec<Option<(f64, f64)>> = rows.iter().map(|row| mean(row, |_| true)).collect();
    let (offsets, strength) = match masked::offsets(capture, light, &shown) {
        Some(found) => found,
        None => {
            let strength = certain(&rows, lights.map(|(sum, weight)| sum / weight))?;
            let offset = |(offset, variance): (f64, f64)| offset * strength / (strength + variance);
            (shown.into_iter().map(|shown| shown.map_or(0.0, offset) as f32).collect(), strength)
        }
    };
    let noise = model.channels.iter().map(|line| f64::from(line.at(dark))).sum::<f64>() / 3.0;
    let strength = (strength / noise.max(f64::MIN_POSITIVE)).sqrt();
    (strength >= VISIBLE).then_some(Banding { offsets, strength: strength as f32 })
}

/// Where bands begin, of [`ROWS`] each, in even rows of the active area. The last one may lie over part of the one before.
pub(super) fn tops(height: usize) -> Vec<usize> {
    let last = height.saturating_sub(ROWS) / 2 * 2;
    (0..last).step_by(ROWS).chain([last]).collect()
}

/// The flat windows of the band of rows that begins there.
fn of_band(capture: &Capture, light: &LinearLight, model: &NoiseModel, cfa: &Cfa, top: usize) -> Vec<Window> {
    let area = capture.active_area;
    let beside = area.width / COLUMNS;
    let count = beside.min(MOST_WINDOWS);
    let mut windows = Vec::new();
    let mut samples = vec![0f32; ROWS * COLUMNS];
    for number in 0..count {
        let x = number * beside / count * COLUMNS;
        for (i, row) in samples.chunks_exact_mut(COLUMNS).enumerate() {
            light.levelled(&capture.counts, area.x + x, area.y + top + i, row);
        }
        for (across, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let line = model.channels[cfa.at(across, down).plane().unwrap_or(1)];
            let rows = samples.chunks_exact(COLUMNS).skip(down).step_by(2);
            let (mut means, mut rough) = ([0f32; TALL], 0.0);
            for (mean, row) in means.iter_mut().zip(rows) {
                let of_colour: [f32; WIDE] = std::array::from_fn(|i| row[2 * i + across]);
                *mean = of_colour.iter().sum::<f32>() / WIDE as f32;
                rough += of_colour.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).powi(2)).sum::<f32>();
            }
            // The variance of a sample: the mask has six times that.
            let variance = rough / (6 * TALL * (WIDE - 2)) as f32;
            let level = means.iter().sum::<f32>() / TALL as f32;
            let expected = line.at(level);
            let is_flat = variance > FLAT.0 * expected && variance < FLAT.1 * expected;
            if is_flat && level < BRIGHTEST {
                let rows = less_line(means);
                // Two of the numbers went into the line.
                let weight = WIDE as f32 / expected * TALL as f32 / (TALL - 2) as f32;
                windows.push(Window { number, first: top + down, light: level, rows, weight });
            }
        }
    }
    windows
}

/// Numbers less the line through them.
pub(super) fn less_line(numbers: [f32; TALL]) -> [f32; TALL] {
    let middle = (TALL - 1) as f32 / 2.0;
    let from_middle: [f32; TALL] = std::array::from_fn(|i| i as f32 - middle);
    let mean = numbers.iter().sum::<f32>() / TALL as f32;
    let along: f32 = numbers.iter().zip(from_middle).map(|(v, at)| v * at).sum();
    let slope = along / from_middle.iter().map(|at| at * at).sum::<f32>();
    std::array::from_fn(|i| numbers[i] - mean - slope * from_middle[i])
}

/// The mean of some kinds of windows, and its variance by their noise.
fn mean(row: &Row, of: impl Fn(usize) -> bool) -> Option<(f64, f64)> {
    let kinds = (0..KINDS).filter(|kind| of(*kind));
    let (sum, weight) = kinds.map(|kind| row[kind]).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    (weight > 0.0).then(|| (sum / weight, 1.0 / weight))
}

/// How two halves of the windows agree.
struct Agreement {
    /// Mean product of what they say.
    product: f64,
    /// In standard errors that their noise alone would give.
    certainty: f64,
    rows: usize,
}

/// Agreement of some kinds of windows in a row with others so many rows on, in the same band.
fn agreement(
    rows: &[Row],
    one: impl Fn(usize) -> bool,
    other: impl Fn(usize) -> bool,
    lag: usize,
) -> Agreement {
    let (mut product, mut variance, mut count) = (0.0, 0.0, 0);
    for band in rows.chunks(ROWS) {
        for (a, b) in band.iter().zip(band.iter().skip(lag)) {
            if let (Some(a), Some(b)) = (mean(a, &one), mean(b, &other)) {
                product += a.0 * b.0;
                variance += a.1 * b.1;
                count += 1;
            }
        }
    }
    Agreement {
        product: product / f64::from(count).max(1.0),
        certainty: product / variance.sqrt().max(f64::MIN_POSITIVE),
        rows: count as usize,
    }
}

/// The variance of offsets, if they are banding for certain. `lights` are those of the darker and of the brighter windows.
fn certain(rows: &[Row], lights: [f64; 2]) -> Option<f64> {
    let is = |half: usize| move |kind: usize| kind & half != 0;
    let is_not = |half: usize| move |kind: usize| kind & half == 0;
    let all = agreement(rows, is(ODD), is_not(ODD), 0);
    if all.certainty < CERTAIN || (all.rows as f64) < COVERED * rows.len() as f64 {
        return None;
    }
    let near = |one: f64, other: f64, share: f64| (one - other).abs() <= share * other;
    let sides = agreement(rows, is(RIGHT), is_not(RIGHT), 0);
    if !near(sides.product, all.product, ALIKE) {
        return None;
    }
    let [dark, bright] = lights;
    let is_deep = all.product > (NO_SCENE * bright).powi(2);
    if !is_deep {
        let within =
            agreement(rows, |kind| kind & (ODD | BRIGHT) == 0, |kind| kind & (ODD | BRIGHT) == ODD, 0);
        let between = agreement(rows, is_not(BRIGHT), is(BRIGHT), 0);
        let growth = bright / dark.max(f64::MIN_POSITIVE);
        let most = ADDED * (growth - 1.0).min(1.0);
        if growth < APART || !near(between.product, within.product, most) {
            return None;
        }
    }
    let dependent = |lag: usize| agreement(rows, is(ODD), is_not(ODD), lag).product.abs() / all.product;
    (1..=LAGS).all(|lag| dependent(lag) < DEPENDENT).then_some(all.product)
}
