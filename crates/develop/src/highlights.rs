//! Clipped highlights: samples at the sensor's limit say only "at least this much".
//!
//! After balancing, the channels clip at different values (their multipliers), so that a white surface that is
//! too bright turns pink or green. Rebuilding estimates a clipped sample from the channels around it that are not
//! clipped, and from the colour that the picture has where it is not (`clipped_colours.rs`): as strong as those channels
//! say where two of them are left, and with their light where one is. Clipped samples lie on the bright side of an edge,
//! so bright samples around them tell more than dark ones. While the last channel goes towards its limit, the result
//! becomes neutral (`whiten.rs`); where every channel is clipped there is nothing left to estimate from.
//!
//! Nothing switches: how far a sample is trusted, and how neutral the result is, are smooth functions of the light.

use std::array::from_fn;
use std::sync::Arc;

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Cfa, Layout, Mosaic};

use crate::clipped_colours::ClippedColours;
use crate::stage::{Stage, WhenSmaller};

mod whiten;
pub use whiten::{Whitening, whiten};

/// Pixels around a sample that rebuilding looks at.
pub const BORDER: usize = 2;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "highlights", border: BORDER, when_smaller: WhenSmaller::Same };

/// Share of the clipping level at which a sample counts as clipped: noise makes saturated samples scatter.
pub const CLIPPED: f32 = 0.985;
/// Share of the clipping level up to which a sample is trusted entirely.
const TRUSTED: f32 = 0.93;
/// Samples that are looked at together, as most of them are not clipped.
const RUN: usize = 64;
/// Difference of two channels beyond what a clipped one allows that excludes a colour.
const EXCLUDED: f32 = 0.2;
/// How much stronger a colour may be than that of the picture around.
const STRONGEST: f32 = 2.0;
/// How much of the light counts that only a clipped channel tells of: the colour around may be that of something else.
const TOLD: f32 = 0.7;
/// How much more light clipped channels may tell of than the trusted ones do.
const BEYOND: f32 = 3.0;
/// Shares of its limit between which a last channel ends: what is rebuilt from it becomes neutral before (`whiten.rs`).
const ENDED: (f32, f32) = (0.96, 1.0);
/// Weight of samples that are not trusted, beside 1, where none is trusted entirely.
const GUESS: f32 = 0.02;
/// What two channels say about the strength of a colour counts from about the square root of this on.
const FAINT: f32 = 0.003;

/// How to treat clipped samples, prepared for one capture.
#[derive(Debug, Clone, PartialEq)]
pub enum Treatment {
    /// Estimate from the other channels.
    Rebuild(Rebuild),
    /// Cut every channel where the first one clips.
    Clip {
        /// Balanced value at which the first channel clips.
        limit: f32,
    },
    /// Leave the samples alone.
    Keep,
}

/// What rebuilding knows of a capture.
#[derive(Debug, Clone, PartialEq)]
pub struct Rebuild {
    /// Balanced value at which each channel clips (its multiplier), before the file's corrections.
    pub limits: [f32; 3],
    /// Colours where the picture is not clipped.
    pub colours: Arc<ClippedColours>,
    /// Whether corrections of the file make the limits differ from place to place.
    pub uneven: bool,
}

/// Treats the samples of a balanced mosaic, whose first one lies in column and row `begin` of the frame. The outermost
/// [`BORDER`] pixels are left as they are. `ends` has the value at which each sample clips where the file's corrections
/// make that differ from place to place; else it is empty.
pub fn treat(mosaic: &mut Mosaic<f32>, begin: (isize, isize), treatment: &Treatment, ends: &[f32]) {
    match (treatment, &mosaic.layout) {
        (Treatment::Keep, _) | (_, Layout::Monochrome) => {}
        (Treatment::Clip { limit }, _) => {
            for v in &mut mosaic.samples {
                *v = v.min(*limit);
            }
        }
        (Treatment::Rebuild(rebuild), Layout::Cfa(cfa)) => {
            let cfa = cfa.clone();
            rebuild_mosaic(mosaic, begin, &cfa, rebuild, ends);
        }
        (Treatment::Rebuild(rebuild), Layout::Rgb) => rebuild_pixels(mosaic, begin, rebuild, ends),
    }
}

fn rebuild_pixels(mosaic: &mut Mosaic<f32>, begin: (isize, isize), rebuild: &Rebuild, ends: &[f32]) {
    let lowest = lowest(rebuild, ends);
    let width = mosaic.size.width;
    for (y, row) in mosaic.samples.chunks_exact_mut(3 * width).enumerate() {
        if !reaches(row, lowest) {
            continue;
        }
        for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
            let at = 3 * (y * width + x);
            let limits = from_fn(|c| ends.get(at + c).copied().unwrap_or(rebuild.limits[c]));
            let seen = [pixel[0], pixel[1], pixel[2]];
            if (0..3).any(|c| seen[c] >= TRUSTED * limits[c]) {
                let colour = rebuild.colours.at(begin.0 + x as isize, begin.1 + y as isize);
                pixel.copy_from_slice(&rebuilt(seen, limits, colour));
            }
        }
    }
}

/// Light that no sample which is changed is below.
fn lowest(rebuild: &Rebuild, ends: &[f32]) -> f32 {
    let limits = if ends.is_empty() { &rebuild.limits[..] } else { ends };
    TRUSTED * limits.iter().fold(f32::MAX, |a, &b| a.min(b))
}

fn rebuild_mosaic(
    mosaic: &mut Mosaic<f32>,
    begin: (isize, isize),
    cfa: &Cfa,
    rebuild: &Rebuild,
    ends: &[f32],
) {
    let (width, height) = (mosaic.size.width, mosaic.size.height);
    if width <= 2 * BORDER || height <= 2 * BORDER {
        return;
    }
    let lowest = lowest(rebuild, ends);
    let bright: Vec<bool> = mosaic.samples.chunks_exact(width).map(|row| reaches(row, lowest)).collect();
    if !bright.contains(&true) {
        return;
    }
    let surroundings = surroundings(cfa, width);
    let plane = |x: usize, y: usize| cfa.at(x, y).plane().unwrap_or(1);
    // Places and values of what was rebuilt: nothing is to be estimated from estimates.
    let mut changed: Vec<(usize, f32)> = Vec::new();
    for y in (BORDER..height - BORDER).filter(|y| bright[*y]) {
        let planes: Vec<usize> = (0..cfa.width()).map(|x| plane(x, y)).collect();
        for first in (BORDER..width - BORDER).step_by(RUN) {
            let run = first..(first + RUN).min(width - BORDER);
            if !reaches(&mosaic.samples[y * width + run.start..y * width + run.end], lowest) {
                continue;
            }
            for x in run {
                let place = x % cfa.width();
                let (own, centre) = (planes[place], y * width + x);
                let v = mosaic.samples[centre];
                if v < lowest {
                    continue;
                }
                let around = &surroundings[y % cfa.height() * cfa.width() + place];
                let (mut sums, mut weights, mut limits) = ([0f32; 3], [0f32; 3], rebuild.limits);
                for &(c, offset) in around {
                    let at = centre.wrapping_add_signed(offset);
                    let light = mosaic.samples[at].max(0.0);
                    // Fourth power (a Lehmer mean): of a reflex and its dark surroundings only the reflex counts.
                    let weight = light * light * light * light;
                    sums[c] += weight * light;
                    weights[c] += weight;
                    if let Some(&end) = ends.get(at) {
                        limits[c] = end;
                    }
                }
                let mut around: [f32; 3] = from_fn(|c| sums[c] / weights[c].max(f32::MIN_POSITIVE));
                around[own] = v;
                if let Some(&end) = ends.get(centre) {
                    limits[own] = end;
                }
                if v >= TRUSTED * limits[own] {
                    let colour = rebuild.colours.at(begin.0 + x as isize, begin.1 + y as isize);
                    changed.push((centre, v.max(rebuilt(around, limits, colour)[own])));
                }
            }
        }
    }
    for (place, v) in changed {
        mosaic.samples[place] = v;
    }
}

/// For each place of the array: the channels of the samples around it, and how far from it they are stored.
fn surroundings(cfa: &Cfa, width: usize) -> Vec<Vec<(usize, isize)>> {
    // Bayer shows every colour within one pixel, larger arrays within two.
    let reach = if cfa.width() <= 2 { 1 } else { BORDER } as isize;
    // Whole periods are added so that places left of and above the first one count from 0.
    let (px, py) = ((cfa.width() * BORDER) as isize, (cfa.height() * BORDER) as isize);
    let at = |x: isize, y: isize| cfa.at((x + px) as usize, (y + py) as usize).plane().unwrap_or(1);
    let places = (0..cfa.height() as isize).flat_map(|y| (0..cfa.width() as isize).map(move |x| (x, y)));
    let around = |(x, y): (isize, isize)| {
        let offsets = (-reach..=reach).flat_map(|v| (-reach..=reach).map(move |u| (u, v)));
        offsets.map(|(u, v)| (at(x + u, y + v), v * width as isize + u)).collect()
    };
    places.map(around).collect()
}

/// Whether some sample is as bright as that.
pub(crate) fn reaches(samples: &[f32], level: f32) -> bool {
    // In blocks, whose brightest sample is found without a branch.
    const LANES: usize = 32;
    let mut found = false;
    vectorised(
        #[inline(always)]
        || {
            found = samples.chunks(1024).any(|block| {
                let lanes = block.chunks_exact(LANES);
                let mut most = [f32::MIN; LANES];
                let rest = lanes.remainder().iter().any(|v| *v >= level);
                for lane in lanes {
                    for (most, &v) in most.iter_mut().zip(lane) {
                        *most = if v > *most { v } else { *most };
                    }
                }
                rest || most.iter().any(|v| *v >= level)
            });
        },
    );
    found
}

/// What a colour may be whose channels end at these limits. `colour` is that of the picture around, its mean 1. Channels
/// that are not clipped stay as they are; where all are, the result is neutral.
pub(crate) fn rebuilt(seen: [f32; 3], limits: [f32; 3], colour: [f32; 3]) -> [f32; 3] {
    let shares: [f32; 3] = from_fn(|c| seen[c].max(0.0) / limits[c]);
    let trust = shares.map(|share| 1.0 - smooth(share, TRUSTED, CLIPPED));
    let colour = as_strong_as(seen, trust, colour);
    // Where no channel is trusted, the one that clips last tells most.
    let ends: [f32; 3] = from_fn(|c| limits[c] / colour[c]);
    let last = ends.map(|end| end * end * end * end);
    let guess = GUESS * (1.0 - most(trust)) / (last[0] + last[1] + last[2]);
    let (mut light, mut weights) = (0.0, 0.0);
    for c in 0..3 {
        let weight = (trust[c] + guess * last[c]) * colour[c];
        light += weight * seen[c];
        weights += weight * colour[c];
    }
    let light = light / weights;
    // Clipped channels are at least as bright as they seem, and the others with them.
    let more = (0..3).map(|c| (1.0 - trust[c]) * (seen[c] / colour[c] - light).max(0.0));
    let light = light + (TOLD * more.fold(0.0, f32::max)).min(BEYOND * light);
    let estimates: [f32; 3] =
        from_fn(|c| seen[c] + (1.0 - trust[c]) * (colour[c] * light - seen[c]).max(0.0));
    // The brightest channel is the best guess of how bright the surface is at least.
    let white = most(estimates);
    let neutral = smooth(least(shares), ENDED.0, ENDED.1);
    from_fn(|c| estimates[c] + (white - estimates[c]) * neutral * (1.0 - trust[c]))
}

/// A colour (mean 1) of the hue of `colour`, as strong as the channels say: two trusted ones by their difference, one beside
/// a clipped one by what it excludes.
fn as_strong_as(seen: [f32; 3], trust: [f32; 3], colour: [f32; 3]) -> [f32; 3] {
    let (mut found, mut expected) = (FAINT, FAINT);
    for (k, l) in [(0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)] {
        let sum = (seen[k] + seen[l]).max(f32::MIN_POSITIVE);
        let difference = (seen[k] - seen[l]) / sum;
        let of_colour = (seen[l] * (colour[k] - 1.0) - seen[k] * (colour[l] - 1.0)) / sum;
        // A clipped `l` is at least as bright as it seems.
        let excluded = smooth(of_colour - difference, 0.0, EXCLUDED) * (1.0 - trust[l]);
        let weight = trust[k] * (0.5 * trust[l] + excluded) * of_colour;
        found += weight * difference;
        expected += weight * of_colour;
    }
    let strength = (found / expected).clamp(0.0, STRONGEST);
    colour.map(|v| (1.0 + (v - 1.0) * strength).max(0.05))
}

/// 0 up to one value, 1 from another one on, smooth between them.
#[inline(always)]
fn smooth(v: f32, from: f32, to: f32) -> f32 {
    let t = ((v - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[inline(always)]
fn most(v: [f32; 3]) -> f32 {
    v[0].max(v[1]).max(v[2])
}

#[inline(always)]
pub(crate) fn least(v: [f32; 3]) -> f32 {
    v[0].min(v[1]).min(v[2])
}

#[cfg(test)]
mod tests;
