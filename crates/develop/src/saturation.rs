//! Where a channel really clips.
//!
//! The white level of a file or of a list of cameras is often above the value at which this specimen's samples
//! pile up at this ISO. Taken at its word, it leaves clipped highlights unseen and pink. So the picture is asked:
//! where its brightest samples stand in one heap, there the channel clips.

use crate::highlights::reaches;

/// Light below this share of the white level is never taken for clipped.
const LOWEST: f32 = 0.8;
/// Width of a bin, as a share of the white level.
const BIN: f32 = 0.001;
/// Bins from `LOWEST` to a little above the white level.
const BINS: usize = 256;

/// Samples that are looked at together.
const RUN: usize = 128;

/// A heap this close to the white level is at the white level.
const SAME: f32 = 0.995;

/// Stands for filters of other colours: none of the three.
pub(crate) const NO_CHANNEL: usize = 3;

/// Fewest samples that make a heap.
const FEWEST: u64 = 50;
/// Width of a heap and of the slope below it that it is compared with, in bins: the noise of saturated samples.
const HEAP: usize = 12;
/// How much a heap stands above the slope below it.
const STEEPNESS: u64 = 4;

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

    /// Share of the white level at which red, green and blue clip: 1 where the picture shows nothing else.
    pub(crate) fn saturation(&self) -> [f32; 3] {
        common(self.0.each_ref().map(top_of_heap), &self.0)
    }
}

/// Keeps the heaps that lie at the converter's limit, which is one for all channels: a heap below which another
/// channel goes on is only an even surface.
fn common(levels: [f32; 3], histogram: &[[u64; BINS]; 3]) -> [f32; 3] {
    const TOLERANCE: f32 = 0.015;
    let brightest = |channel: &[u64; BINS]| {
        let mut above = 0;
        let top = channel.iter().rposition(|&n| {
            above += n;
            above >= FEWEST
        });
        top.map_or(0.0, |top| LOWEST + top as f32 * BIN)
    };
    let limit = histogram.iter().map(brightest).fold(0.0, f32::max);
    levels.map(|level| if level + TOLERANCE < limit { 1.0 } else { level })
}

/// The lower edge of the heap at the bright end, as a share of the white level; 1 when there is none.
fn top_of_heap(bins: &[u64; BINS]) -> f32 {
    let mut above = 0;
    // A few hot pixels above the heap do not count.
    let top = bins.iter().rposition(|&n| {
        above += n;
        above >= FEWEST
    });
    let Some(top) = top.filter(|&top| top >= 3 * HEAP) else { return 1.0 };
    let sum = |from: usize, to: usize| bins[from..to].iter().sum::<u64>();
    let heap = sum(top + 1 - HEAP, BINS.min(top + HEAP));
    let slope = sum(top + 1 - 3 * HEAP, top + 1 - HEAP) / 2;
    if heap < FEWEST || heap < STEEPNESS * slope {
        return 1.0;
    }
    // The darkest bin of the heap that still holds a good part of it.
    let highest = bins[top + 1 - HEAP..].iter().copied().max().unwrap_or(0);
    let first = (top + 1 - HEAP..BINS).find(|&i| bins[i] * 10 >= highest).unwrap_or(top);
    let level = LOWEST + first as f32 * BIN;
    if level > SAME { 1.0 } else { level }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heap_below_the_white_level_is_where_the_channel_clips() {
        let mut bins = [10u64; BINS];
        for n in &mut bins[131..] {
            *n = 0;
        }
        (bins[128], bins[129], bins[130]) = (300, 4000, 500);
        bins[180] = 3; // Hot pixels.
        let found = top_of_heap(&bins);
        assert!((found - (LOWEST + 129.0 * BIN)).abs() < 1.5 * BIN, "{found}");
    }

    #[test]
    fn a_picture_that_just_ends_does_not_clip() {
        let mut bins = [0u64; BINS];
        for (i, n) in bins.iter_mut().take(200).enumerate() {
            *n = 2000 - 5 * i as u64;
        }
        assert!((top_of_heap(&bins) - 1.0).abs() < 1e-6);
        assert!((top_of_heap(&[0; BINS]) - 1.0).abs() < 1e-6);
    }
}
