//! Clipped highlights: samples at the sensor's limit say only "at least this much".
//!
//! After balancing, the channels clip at different values (their multipliers), so that a white surface that is
//! too bright turns pink or green. Rebuilding estimates a clipped sample from the other two channels around it:
//! their mean, plus the typical difference between this channel and that mean where the picture begins to clip
//! (measured once over the frame). Clipped samples lie on the bright side of an edge, so bright samples around
//! them tell more than dark ones. Where every channel is clipped there is nothing left to estimate from, and the
//! result is made neutral.

use std::array::from_fn;

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Cfa, Layout, Mosaic, Rgb};

use crate::stage::{Stage, WhenSmaller};

/// Pixels around a sample that rebuilding looks at.
pub const BORDER: usize = 2;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "highlights", border: BORDER, when_smaller: WhenSmaller::Same };

/// Share of the clipping level at which a sample counts as clipped: noise makes saturated samples scatter.
pub const CLIPPED: f32 = 0.985;
/// Samples that are looked at together, as most of them are not clipped.
const RUN: usize = 64;
/// Share of the clipping level at which a fully clipped colour begins to be made neutral.
const NEARLY: f32 = 0.9;

/// How to treat clipped samples, prepared for one capture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Treatment {
    /// Estimate from the other channels.
    Rebuild {
        /// Balanced value at which each channel clips (its multiplier).
        limits: [f32; 3],
        /// Typical difference between a channel and the mean of the two others near clipped areas.
        offsets: [f32; 3],
    },
    /// Cut every channel where the first one clips.
    Clip {
        /// Balanced value at which the first channel clips.
        limit: f32,
    },
    /// Leave the samples alone.
    Keep,
}

/// Treats the samples of a balanced mosaic. The outermost [`BORDER`] pixels are left as they are.
pub fn treat(mosaic: &mut Mosaic<f32>, treatment: &Treatment) {
    match (treatment, &mosaic.layout) {
        (Treatment::Keep, _) | (_, Layout::Monochrome) => {}
        (Treatment::Clip { limit }, _) => {
            for v in &mut mosaic.samples {
                *v = v.min(*limit);
            }
        }
        (Treatment::Rebuild { limits, offsets }, Layout::Cfa(cfa)) => {
            let cfa = cfa.clone();
            rebuild_mosaic(mosaic, &cfa, *limits, *offsets);
        }
        (Treatment::Rebuild { limits, offsets }, Layout::Rgb) => {
            for pixel in mosaic.samples.chunks_exact_mut(3) {
                let seen = [pixel[0], pixel[1], pixel[2]];
                for c in 0..3 {
                    if seen[c] >= CLIPPED * limits[c] {
                        let others = (seen[(c + 1) % 3] + seen[(c + 2) % 3]) / 2.0;
                        pixel[c] = seen[c].max(others + offsets[c]);
                    }
                }
            }
        }
    }
}

fn rebuild_mosaic(mosaic: &mut Mosaic<f32>, cfa: &Cfa, limits: [f32; 3], offsets: [f32; 3]) {
    let (width, height) = (mosaic.size.width, mosaic.size.height);
    let clipped = limits.map(|l| l * CLIPPED);
    let lowest = clipped.iter().fold(f32::MAX, |a, &b| a.min(b));
    if width <= 2 * BORDER || height <= 2 * BORDER || !reaches(&mosaic.samples, lowest) {
        return;
    }
    let surroundings = surroundings(cfa, width);
    let plane = |x: usize, y: usize| cfa.at(x, y).plane().unwrap_or(1);
    let scale = limits.map(|l| 1.0 / l);
    // Places and values of what was rebuilt: nothing is to be estimated from estimates.
    let mut rebuilt: Vec<(usize, f32)> = Vec::new();
    for y in BORDER..height - BORDER {
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
                if v < clipped[own] {
                    continue;
                }
                let around = &surroundings[y % cfa.height() * cfa.width() + place];
                let (mut sums, mut weights) = ([0f32; 3], [0f32; 3]);
                for &(c, offset) in around {
                    let light = mosaic.samples[centre.wrapping_add_signed(offset)].max(0.0);
                    // Fourth power (a Lehmer mean): of a reflex and its dark surroundings only the reflex counts.
                    let weight = light * light * light * light;
                    sums[c] += weight * light;
                    weights[c] += weight;
                }
                let mut around: [f32; 3] = from_fn(|c| sums[c] / weights[c].max(f32::MIN_POSITIVE));
                around[own] = v;
                let others = (around[(own + 1) % 3] + around[(own + 2) % 3]) / 2.0;
                let white = around.iter().fold(v, |a, &b| a.max(b));
                let neutral = neutrality(around, scale);
                let estimate = others + offsets[own];
                rebuilt.push((centre, v.max(estimate + (white - estimate) * neutral)));
            }
        }
    }
    for (place, v) in rebuilt {
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

/// How neutral to make a colour: 0 when some channel is far from its limit, 1 when all are clipped.
#[inline(always)]
fn neutrality(rgb: [f32; 3], scale: [f32; 3]) -> f32 {
    let share = (rgb[0] * scale[0]).min(rgb[1] * scale[1]).min(rgb[2] * scale[2]);
    let t = ((share - NEARLY) * (1.0 / (CLIPPED - NEARLY))).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Makes neutral what is clipped in every channel.
pub fn neutralise(picture: &mut Rgb<CameraSpace>, treatment: &Treatment) {
    let Treatment::Rebuild { limits, .. } = treatment else { return };
    let [r, g, b] = picture.planes_mut();
    let scale = limits.map(|l| 1.0 / l);
    vectorised(
        #[inline(always)]
        || {
            for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                let weight = neutrality([*r, *g, *b], scale);
                // The brightest channel is the best guess of how bright the surface is at least.
                let white = r.max(*g).max(*b);
                *r += (white - *r) * weight;
                *g += (white - *g) * weight;
                *b += (white - *b) * weight;
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Size;

    const LIMITS: [f32; 3] = [2.0, 1.0, 1.5];
    const TREATMENT: Treatment = Treatment::Rebuild { limits: LIMITS, offsets: [0.0; 3] };

    /// A grey surface of the given light under an RGGB array, clipped by the sensor.
    fn grey(light: f32) -> Mosaic<f32> {
        let cfa = Cfa::parse("RGGB").unwrap();
        let size = Size { width: 10, height: 10 };
        let sample = |i: usize| light.min(LIMITS[cfa.at(i % 10, i / 10).plane().unwrap()]);
        Mosaic { size, samples: (0..100).map(sample).collect(), layout: Layout::Cfa(cfa) }
    }

    #[test]
    fn a_grey_that_clips_in_green_only_is_grey_again() {
        let mut mosaic = grey(1.3);
        treat(&mut mosaic, &TREATMENT);
        for y in 2..8 {
            for x in 2..8 {
                assert!((mosaic.samples[y * 10 + x] - 1.3).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn what_is_not_clipped_is_not_touched() {
        let (before, mut after) = (grey(0.9), grey(0.9));
        treat(&mut after, &TREATMENT);
        assert_eq!(before, after);
    }

    #[test]
    fn a_surface_that_clips_in_every_channel_is_neutral() {
        let planes = LIMITS.map(|l| vec![l]);
        let mut picture = Rgb::from_planes(Size { width: 1, height: 1 }, planes).unwrap();
        neutralise(&mut picture, &TREATMENT);
        let [r, g, b] = picture.at(0, 0);
        assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6 && r >= 2.0 - 1e-6, "{r} {g} {b}");
    }

    #[test]
    fn a_saturated_red_light_keeps_its_hue() {
        let mut picture =
            Rgb::from_planes(Size { width: 1, height: 1 }, [vec![2.0], vec![0.2], vec![0.1]]).unwrap();
        neutralise(&mut picture, &TREATMENT);
        assert_eq!(picture.at(0, 0), [2.0, 0.2, 0.1]);
    }
}
