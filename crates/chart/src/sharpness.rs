//! How sharp a shot of a chart is: the width of the edges of its patches, from the samples of the sensor.
//!
//! Between the middles of two neighbouring patches there are two edges: from the patch to the gap and from the gap to
//! the next patch. Two blurred steps (integrals of a Gaussian) are fitted to the light along that way. The layout gives
//! the distance between them; their common shift, their heights and their common width are fitted. So gaps that blur
//! has filled tell as much as open ones.

use darkroot_colour::statistics::median_by;
use darkroot_photo::Mosaic;
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use crate::measure::{CLIPPED, for_each_inside};
use crate::{Homography, Quad};

/// Width of the edges of a chart's patches, from 10 to 90 % of the step, in the direction in which they are wider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeWidth {
    /// In pixels of the sensor.
    pub pixels: f64,
    /// As a share of a patch's side.
    pub patch: f64,
}

/// Width of a Gaussian step from 10 to 90 % of its height, over its standard deviation.
const TEN_TO_NINETY: f64 = 2.563;
/// The part of a patch's side, about its middle, over which a profile is averaged.
const BAND: f64 = 0.4;
/// Share of a profile's variance that the steps must explain.
const EXPLAINED: f64 = 0.95;
/// Fewest profiles in a direction that tell a width.
const FEWEST: usize = 3;
/// Bins of a profile, at most.
const BINS: usize = 160;

/// Measures the edges between neighbours. `patches` are whole patches, row by row, in pixels of the frame. `None` where
/// too few edges can be read: patches of one colour, noise, clipping, or corners that are far off.
pub fn edge_width(
    light: &Mosaic<f32>,
    saturation: [f32; 3],
    patches: &[Quad],
    columns: usize,
) -> Option<EdgeWidth> {
    let along = |step: usize, down: bool| {
        let mut widths: Vec<EdgeWidth> = (0..patches.len())
            .into_par_iter()
            .filter(|i| down || (i + 1) % columns.max(1) != 0)
            .filter_map(|i| width(light, saturation, &patches[i], patches.get(i + step)?, down))
            .collect();
        let told = widths.len() >= FEWEST;
        if told { median_by(&mut widths, |a, b| a.patch.total_cmp(&b.patch)) } else { None }
    };
    match (along(1, false), along(columns, true)) {
        (Some(across), Some(down)) => Some(if across.patch > down.patch { across } else { down }),
        (one, other) => one.or(other),
    }
}

/// Width of the edges between two patches, one right of or below the other.
fn width(
    light: &Mosaic<f32>,
    saturation: [f32; 3],
    one: &Quad,
    other: &Quad,
    down: bool,
) -> Option<EdgeWidth> {
    // Along the way from patch to patch, and across it.
    let point = |quad: &Quad, along: f64, across: f64| {
        let [x, y] = if down { [across, along] } else { [along, across] };
        let mix = |k: usize| {
            let (top, bottom) =
                (quad[0][k] + x * (quad[1][k] - quad[0][k]), quad[3][k] + x * (quad[2][k] - quad[3][k]));
            top + y * (bottom - top)
        };
        [mix(0), mix(1)]
    };
    let (low, high) = (0.5 - BAND / 2.0, 0.5 + BAND / 2.0);
    let strip =
        [point(one, 0.5, low), point(other, 0.5, low), point(other, 0.5, high), point(one, 0.5, high)];
    let back = Homography::onto(&strip)?.inverse()?;
    let edges = [back.apply(point(one, 1.0, 0.5))[0], back.apply(point(other, 0.0, 0.5))[0]];
    let length = distance(point(one, 0.5, 0.5), point(other, 0.5, 0.5));
    let side = distance(point(one, 0.0, 0.5), point(one, 1.0, 0.5));
    if !(length > 2.0 && side > 2.0 && edges[0] < edges[1]) {
        return None;
    }
    let profile = profile(light, saturation, &strip, &back, length)?;
    let deviation = spread(&profile, edges, length)?;
    let pixels = TEN_TO_NINETY * deviation * length;
    Some(EdgeWidth { pixels, patch: pixels / side })
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    (bx - ax).hypot(by - ay)
}

/// One bin of a profile.
#[derive(Debug, Clone, Copy, Default)]
struct Bin {
    /// Mean place, 0 in the middle of one patch, 1 in the middle of the other.
    place: f64,
    /// Mean light of green.
    value: f64,
    count: f64,
}

/// Light of green along a strip; `None` where it is clipped.
fn profile(
    light: &Mosaic<f32>,
    saturation: [f32; 3],
    strip: &Quad,
    back: &Homography,
    length: f64,
) -> Option<Vec<Bin>> {
    let mut bins = vec![Bin::default(); ((3.0 * length) as usize).clamp(1, BINS)];
    let mut clipped = false;
    for_each_inside(light, strip, |x, y, channel, value| {
        if channel != 1 {
            return;
        }
        clipped |= value >= CLIPPED * saturation[1];
        let place = back.apply([x as f64, y as f64])[0];
        let count = bins.len();
        if let Some(bin) = bins.get_mut((place.max(0.0) * count as f64) as usize) {
            bin.place += place;
            bin.value += f64::from(value);
            bin.count += 1.0;
        }
    });
    bins.retain(|bin| bin.count > 0.0);
    for bin in &mut bins {
        bin.place /= bin.count;
        bin.value /= bin.count;
    }
    (!clipped && bins.len() > 8).then_some(bins)
}

/// Standard deviation of the Gaussian steps that fit a profile best, in its own length.
fn spread(profile: &[Bin], edges: [f64; 2], length: f64) -> Option<f64> {
    let weight: f64 = profile.iter().map(|b| b.count).sum();
    let mean = profile.iter().map(|b| b.count * b.value).sum::<f64>() / weight;
    let total: f64 = profile.iter().map(|b| b.count * (b.value - mean).powi(2)).sum();
    let least = (0.2 / length).ln();
    let cost = |[log, shift]: [f64; 2]| residual(profile, edges, log.exp(), shift);
    let mut best = [least, 0.0];
    let mut least_cost = f64::INFINITY;
    for step in 0..12 {
        let log = least + f64::from(step) / 11.0 * (0.5f64.ln() - least);
        for shift in [-0.05, -0.025, 0.0, 0.025, 0.05] {
            let found = cost([log, shift]);
            if found < least_cost {
                (best, least_cost) = ([log, shift], found);
            }
        }
    }
    // A pattern search about the best of the grid: Hooke and Jeeves, 1961.
    let mut reach = [0.3, 0.015];
    for _ in 0..40 {
        let around = [[reach[0], 0.0], [-reach[0], 0.0], [0.0, reach[1]], [0.0, -reach[1]]];
        let mut better = false;
        for [log, shift] in around {
            let tried = [(best[0] + log).max(least), (best[1] + shift).clamp(-0.08, 0.08)];
            let found = cost(tried);
            if found < least_cost {
                (best, least_cost, better) = (tried, found, true);
            }
        }
        if !better {
            reach = reach.map(|r| r / 2.0);
        }
    }
    (least_cost < (1.0 - EXPLAINED) * total).then_some(best[0].exp())
}

/// Sum of squares that two Gaussian steps of this spread leave of a profile, their heights fitted.
fn residual(profile: &[Bin], edges: [f64; 2], deviation: f64, shift: f64) -> f64 {
    let rise = |place: f64, edge: f64| step((place - edge - shift) / deviation);
    let (mut normal, mut right, mut squares) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
    for bin in profile {
        let terms = Vector3::new(1.0, rise(bin.place, edges[0]), rise(bin.place, edges[1]));
        normal += bin.count * terms * terms.transpose();
        right += bin.count * bin.value * terms;
        squares += bin.count * bin.value * bin.value;
    }
    normal += Matrix3::from_diagonal_element(1e-9 * normal[(0, 0)]);
    match normal.cholesky() {
        Some(factor) => squares - right.dot(&factor.solve(&right)),
        None => f64::INFINITY,
    }
}

/// The cumulative normal distribution to 0.00014 (Bowling, Khasawneh, Kaewkuekool and Cho, "A logistic approximation to
/// the cumulative normal distribution", 2009).
fn step(z: f64) -> f64 {
    1.0 / (1.0 + (-1.5976 * z - 0.070_56 * z.powi(3)).clamp(-40.0, 40.0).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::{Cfa, Layout, Size};

    const SIDE: f64 = 30.0;
    const GAP: f64 = 6.0;

    /// A chart of 4 x 3 patches whose edges are Gaussian steps of these deviations across and down, in pixels.
    fn chart(deviation: [f64; 2]) -> (Mosaic<f32>, Vec<Quad>) {
        let size = Size { width: 180, height: 140 };
        let low = |i: usize| 20.3 + i as f64 * (SIDE + GAP);
        let window = |v: f64, i: usize, s: f64| step((v - low(i)) / s) - step((v - low(i) - SIDE) / s);
        let value = |i: usize| {
            let (x, y) = ((i % size.width) as f64, (i / size.width) as f64);
            let patch = |p: usize| {
                let light = 0.1 + 0.7 * ((p * 5) % 12) as f64 / 12.0;
                light * window(x, p % 4, deviation[0]) * window(y, p / 4, deviation[1])
            };
            (0.02 + (0..12).map(patch).sum::<f64>()) as f32
        };
        let samples = (0..size.width * size.height).map(value).collect();
        let layout = Layout::Cfa(Cfa::parse("RGGB").unwrap());
        let quad = |p: usize| {
            let (x, y) = (low(p % 4), low(p / 4));
            [[x, y], [x + SIDE, y], [x + SIDE, y + SIDE], [x, y + SIDE]]
        };
        (Mosaic { size, layout, samples }, (0..12).map(quad).collect())
    }

    #[test]
    fn the_width_of_gaussian_edges_is_found_whether_gaps_are_open_or_filled() {
        // With the widest the far edges of the patches reach in, too, and the fit knows nothing of them.
        for (deviation, within) in [(0.8, 0.05), (2.0, 0.05), (4.0, 0.05), (8.0, 0.15)] {
            let (light, patches) = chart([deviation; 2]);
            let found = edge_width(&light, [1.0; 3], &patches, 4).unwrap();
            let expected = TEN_TO_NINETY * deviation;
            assert!((found.pixels / expected - 1.0).abs() < within, "{deviation}: {found:?}");
            assert!((found.patch - found.pixels / SIDE).abs() < 1e-9);
        }
    }

    #[test]
    fn blur_in_one_direction_counts() {
        for deviation in [[1.0, 5.0], [5.0, 1.0]] {
            let (light, patches) = chart(deviation);
            let found = edge_width(&light, [1.0; 3], &patches, 4).unwrap();
            assert!((found.pixels / (TEN_TO_NINETY * 5.0) - 1.0).abs() < 0.05, "{found:?}");
        }
    }

    #[test]
    fn corners_that_are_a_little_off_change_little() {
        let (light, patches) = chart([2.0; 2]);
        let moved: Vec<Quad> = patches.iter().map(|q| q.map(|p| p.map(|v| v + 1.2))).collect();
        let found = edge_width(&light, [1.0; 3], &moved, 4).unwrap();
        assert!((found.pixels / (TEN_TO_NINETY * 2.0) - 1.0).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn where_there_are_no_edges_there_is_no_width() {
        let (mut light, patches) = chart([1.0; 2]);
        let moved: Vec<Quad> = patches.iter().map(|q| q.map(|p| p.map(|v| v / 20.0))).collect();
        assert_eq!(edge_width(&light, [1.0; 3], &moved, 4), None);
        assert_eq!(edge_width(&light, [0.05; 3], &patches, 4), None, "clipped");
        light.samples.fill(0.3);
        assert_eq!(edge_width(&light, [1.0; 3], &patches, 4), None, "even");
        assert_eq!(edge_width(&light, [1.0; 3], &[], 0), None);
    }
}
