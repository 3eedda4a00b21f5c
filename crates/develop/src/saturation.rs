//! Where a channel really clips.
//!
//! The white level of a file or of a list of cameras is often above the value at which this specimen's samples
//! pile up at this ISO. Taken at its word, it leaves clipped highlights unseen and pink. So the picture is asked:
//! where a channel's brightest samples stand in one heap, there it may clip, or there is a bright, even wall. Two things
//! tell them apart. Light that is counted has the noise of its photons, which the rest of the picture shows; where the
//! counting ends, noise ends. And a wall is of three heights in red, green and blue, while the end of the converter is
//! one.
//!
//! Samples are counted as they were stored, before the file's gain maps and curves.

use std::array::from_fn;

use darkroot_photo::Layout;

use crate::highlights::reaches;
use crate::noise::{self, Window};

/// Light below this share of the white level is never taken for clipped.
const LOWEST: f32 = 0.5;
/// Width of a bin, as a share of the white level.
const BIN: f32 = 0.001;
/// Bins from `LOWEST` to a little above the white level.
const BINS: usize = 556;

/// Samples that are looked at together.
const RUN: usize = 128;

/// A heap this close to the white level is at the white level.
const SAME: f32 = 0.995;

/// Stands for filters of other colours: none of the three.
pub(crate) const NO_CHANNEL: usize = 3;

/// Fewest samples that make a heap.
const FEWEST: u64 = 50;
/// Bins on each side of the middle of a heap: lossy compression spreads it.
const HEAP: usize = 12;
/// How much a heap stands above as many samples of light as are below it.
const STEEPNESS: u64 = 4;
/// One sample in so many may lie above a heap: hot pixels, and what compression overshoots.
const ABOVE: u64 = 8;
/// A heap has less than this share of the variance of photons.
const QUIET: f32 = 0.4;
/// Without windows that show noise: a heap that is clipped has less than this standard deviation.
const NARROW: f32 = 0.0012;
/// Bins below a heap in which light that runs into it shows.
const BELOW: usize = 100;
/// Heaps of three channels that lie so near each other are the end of one converter.
const ALIKE: f32 = 0.008;

/// Number of samples of each channel by light, from `LOWEST` on.
#[derive(Debug, Clone)]
pub(crate) struct BrightSamples([[u64; BINS]; 3]);

impl BrightSamples {
    pub(crate) fn none() -> Self {
        Self([[0; BINS]; 3])
    }

    /// Counts levelled samples of a row, whose channels repeat.
    pub(crate) fn count(&mut self, light: &[f32], channels: &[usize]) {
        // In runs, most of which hold no bright sample.
        let run = RUN.next_multiple_of(channels.len());
        for light in light.chunks(run).filter(|light| reaches(light, LOWEST)) {
            for (&v, &channel) in light.iter().zip(channels.iter().cycle()) {
                if v >= LOWEST
                    && let Some(bins) = self.0.get_mut(channel)
                {
                    bins[(((v - LOWEST) / BIN) as usize).min(BINS - 1)] += 1;
                }
            }
        }
    }

    /// Adds what was counted elsewhere.
    #[must_use]
    pub(crate) fn and(mut self, other: &Self) -> Self {
        for (sum, part) in self.0.iter_mut().flatten().zip(other.0.iter().flatten()) {
            *sum += part;
        }
        self
    }

    /// Share of the white level at which red, green and blue clip: 1 where the picture shows nothing else. Windows that
    /// show noise are asked for where a channel has a heap.
    pub(crate) fn saturation<'a>(&self, layout: &Layout, windows: impl FnOnce() -> &'a [Window]) -> [f32; 3] {
        let heaps = self.0.each_ref().map(heap);
        if heaps.iter().flatten().all(|heap| heap.level > SAME) {
            return [1.0; 3];
        }
        let photons = noise::of_photons(windows());
        // Samples of linear files are balanced: there a grey wall is of one height, too.
        let of_one_converter = match (layout, heaps) {
            (Layout::Cfa(_), [Some(r), Some(g), Some(b)]) => {
                let levels = [r, g, b].map(|heap| heap.middle);
                let most = levels.iter().copied().fold(0.0, f32::max);
                levels.iter().all(|level| most - level < ALIKE)
            }
            _ => false,
        };
        from_fn(|c| match heaps[c] {
            Some(heap) if of_one_converter || heap.is_quiet(photons.map(|p| p[c])) => {
                if heap.level > SAME {
                    1.0
                } else {
                    heap.level
                }
            }
            _ => 1.0,
        })
    }
}

/// Samples of about one light at the bright end of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Heap {
    /// Its lower edge, as a share of the white level.
    level: f32,
    /// Where most of its samples are.
    middle: f32,
    /// Standard deviation.
    spread: f32,
    /// Whether there is light of every brightness below it, as where light runs into an end.
    is_run_into: bool,
}

impl Heap {
    /// Whether it has less noise than photons, whose variance is that of the square roots of light, would make.
    fn is_quiet(self, photons: Option<f32>) -> bool {
        photons.map_or(self.spread < NARROW && self.is_run_into, |variance| {
            let of_roots = self.spread / (2.0 * self.middle.sqrt());
            of_roots * of_roots < QUIET * variance
        })
    }
}

/// The heap at the bright end.
fn heap(bins: &[u64; BINS]) -> Option<Heap> {
    let sum = |from: usize, to: usize| bins[from.min(BINS)..to.min(BINS)].iter().sum::<u64>();
    let found = (3 * HEAP..BINS).rev().find(|&i| {
        let heap = sum(i - HEAP, i + HEAP + 1);
        let around = i - HEAP..(i + HEAP + 1).min(BINS);
        bins[i] > 0
            && heap >= FEWEST
            && around.clone().all(|k| bins[k] <= bins[i])
            && sum(i + HEAP + 1, BINS) * ABOVE <= heap
            && heap >= STEEPNESS * sum(i - 3 * HEAP, i - HEAP)
    })?;
    let around = found - HEAP..(found + HEAP + 1).min(BINS);
    let light = |bin: usize| LOWEST + bin as f32 * BIN;
    // The darkest bin of the heap that still holds a good part of it.
    let first = around.clone().find(|&i| bins[i] * 10 >= bins[found]).unwrap_or(found);
    // Of a normal distribution two thirds lie within one standard deviation.
    let total = sum(around.start, around.end);
    let rank = |share: f64| {
        let (mut below, wanted) = (0, (share * total as f64) as u64);
        let mut bins = around.clone().map(|i| (i, bins[i]));
        bins.find(|(_, n)| {
            below += n;
            below > wanted
        })
        .map_or(found, |(i, _)| i)
    };
    let spread = 0.5 * (light(rank(0.841)) - light(rank(0.159))).max(0.5 * BIN);
    let below = found.saturating_sub(BELOW)..found - HEAP;
    let is_run_into = 2 * bins[below.clone()].iter().filter(|&&n| n > 0).count() > below.len();
    Some(Heap { level: light(first), middle: light(found) + 0.5 * BIN, spread, is_run_into })
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Cfa;

    fn bayer() -> Layout {
        Layout::Cfa(Cfa::parse("RGGB").unwrap())
    }

    /// Even slopes of light, ten samples a bin, up to some bin.
    fn slope(end: usize) -> [u64; BINS] {
        from_fn(|i| if i < end { 10 } else { 0 })
    }

    fn found(bins: [[u64; BINS]; 3]) -> [f32; 3] {
        BrightSamples(bins).saturation(&bayer(), || &[])
    }

    #[test]
    fn a_narrow_heap_below_the_white_level_is_where_the_channel_clips() {
        let mut bins = slope(277);
        (bins[276], bins[277], bins[278]) = (300, 40_000, 500);
        bins[500] = 3; // Hot pixels.
        let level = found([bins, slope(200), slope(200)])[0];
        assert!((level - (LOWEST + 277.0 * BIN)).abs() < 1.5 * BIN, "{level}");
    }

    #[test]
    fn a_broad_heap_is_a_wall_unless_all_three_channels_have_it_at_one_height() {
        let broad = |middle: usize| {
            let mut bins = slope(middle - 8);
            for i in 0..17 {
                bins[middle + i - 8] = 4000 - 50 * (i as u64).abs_diff(8).pow(2);
            }
            bins
        };
        assert_eq!(found([broad(300), slope(100), slope(100)]), [1.0; 3]);
        assert_eq!(found([broad(300), broad(200), broad(250)]), [1.0; 3]);
        for level in found([broad(300), broad(301), broad(299)]) {
            assert!((level - 0.797).abs() < 0.01, "{level}");
        }
    }

    #[test]
    fn a_heap_at_or_above_the_white_level_is_the_white_level() {
        for bin in [500, BINS - 14, BINS - 1] {
            let mut bins = slope(400);
            bins[bin] = 90_000;
            assert_eq!(found([bins; 3]), [1.0; 3], "{bin}");
        }
    }

    #[test]
    fn a_picture_that_just_ends_does_not_clip() {
        let bins = from_fn(|i| 2000u64.saturating_sub(5 * i as u64));
        assert_eq!(found([bins; 3]), [1.0; 3]);
        assert_eq!(found([[0; BINS]; 3]), [1.0; 3]);
    }
}
