//! One look at the whole frame: mean light of small blocks, what is clipped, how the light is spread.

use darkroot_photo::{Capture, Counts, Layout, Mosaic, Rect};
use rayon::prelude::*;

use crate::corrections::{self, Run, is_supported};
use crate::highlights::CLIPPED;
use crate::level::Levels;
use crate::saturation::saturation;

/// Bins of a histogram; bin i holds light from (i / BINS)^2 to ((i + 1) / BINS)^2 of saturation.
pub const BINS: usize = 64;

/// Smallest side of a block, in pixels; rounded up to whole periods of the filter array.
const BLOCK: usize = 8;

/// What was seen in one block.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Block {
    /// Mean linear light, 1 = saturated, not balanced.
    pub mean: [f32; 3],
    /// Whether some sample of the channel is clipped.
    pub clipped: [bool; 3],
}

/// What was seen in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// Blocks in a row.
    pub columns: usize,
    /// All blocks, row by row.
    pub blocks: Vec<Block>,
    /// Share of the white level at which each channel clips.
    pub saturation: [f32; 3],
    /// Share of clipped samples of each channel, 0..=1.
    pub clipped: [f64; 3],
    /// Number of samples by square root of light, for each channel.
    pub histogram: [[u64; BINS]; 3],
}

/// Looks at the active area of a capture.
pub fn survey(capture: &Capture) -> Survey {
    whole(capture, &Levels::new(capture))
}

pub(crate) fn whole(capture: &Capture, levels: &Levels) -> Survey {
    look(capture, levels, saturation(capture, levels), capture.active_area)
}

/// Mean linear light of each channel in a rectangle of the frame (inside the active area).
pub(crate) fn mean(capture: &Capture, levels: &Levels, rect: Rect) -> [f64; 3] {
    let seen = look(capture, levels, [1.0; 3], rect);
    let count = seen.blocks.len().max(1) as f64;
    [0, 1, 2].map(|c| seen.blocks.iter().map(|b| f64::from(b.mean[c])).sum::<f64>() / count)
}

/// What one row of blocks holds.
struct Strip {
    blocks: Vec<Block>,
    clipped: [u64; 3],
    histogram: [[u64; BINS]; 3],
}

fn look(capture: &Capture, levels: &Levels, saturation: [f32; 3], area: Rect) -> Survey {
    match &capture.counts {
        Counts::U16(counts) => look_at(capture, counts, levels, saturation, area),
        Counts::F32(counts) => look_at(capture, counts, levels, saturation, area),
    }
}

fn look_at<T: Copy + Into<f32> + Sync>(
    capture: &Capture,
    counts: &Mosaic<T>,
    levels: &Levels,
    saturation: [f32; 3],
    area: Rect,
) -> Survey {
    let period = match &counts.layout {
        Layout::Cfa(cfa) => cfa.width().max(cfa.height()),
        Layout::Monochrome | Layout::Rgb => 1,
    };
    // A block is a whole number of periods, and no larger than the area.
    let side = BLOCK.div_ceil(period) * period;
    let side = side.min(area.width.min(area.height)).max(1);
    let (columns, rows) = (area.width / side, area.height / side);
    let supported: Vec<_> = capture.mosaic_corrections.iter().filter(|c| is_supported(c)).cloned().collect();
    let strips: Vec<Strip> = (0..rows)
        .into_par_iter()
        .map(|row| {
            let place = Rect { x: area.x, y: area.y + row * side, width: columns * side, height: side };
            strip(capture, counts, levels, &supported, saturation, place)
        })
        .collect();

    let mut survey = Survey {
        columns,
        blocks: Vec::with_capacity(columns * rows),
        saturation,
        clipped: [0.0; 3],
        histogram: [[0; BINS]; 3],
    };
    let mut clipped = [0u64; 3];
    for strip in strips {
        survey.blocks.extend(strip.blocks);
        for (sum, n) in clipped.iter_mut().zip(strip.clipped) {
            *sum += n;
        }
        for (sum, n) in survey.histogram.iter_mut().flatten().zip(strip.histogram.iter().flatten()) {
            *sum += n;
        }
    }
    let total = |c: usize| survey.histogram[c].iter().sum::<u64>().max(1) as f64;
    survey.clipped = [0, 1, 2].map(|c| clipped[c] as f64 / total(c));
    survey
}

fn strip<T: Copy + Into<f32>>(
    capture: &Capture,
    counts: &Mosaic<T>,
    levels: &Levels,
    supported: &[darkroot_photo::Correction],
    saturation: [f32; 3],
    place: Rect,
) -> Strip {
    let (planes, side, area) = (counts.layout.planes(), place.height, capture.active_area);
    let columns = place.width / side;
    let mut strip =
        Strip { blocks: vec![Block::default(); columns], clipped: [0; 3], histogram: [[0; BINS]; 3] };
    let mut numbers = vec![[0f32; 3]; columns];
    let mut light = vec![0f32; place.width * planes];
    for y in place.y..place.bottom() {
        let start = (y * counts.size.width + place.x) * planes;
        levels.row(&counts.samples[start..start + light.len()], place.x * planes, y, &mut light);
        if !supported.is_empty() {
            let run = Run { x: place.x - area.x, y: y - area.y, planes, active: area.size() };
            corrections::row(&mut light, supported, run);
        }
        for (i, &v) in light.iter().enumerate() {
            let x = i / planes;
            let block = x / side;
            let mut count = |c: usize| {
                strip.blocks[block].mean[c] += v;
                numbers[block][c] += 1.0;
                let bin = (v.clamp(0.0, 1.0).sqrt() * BINS as f32) as usize;
                strip.histogram[c][bin.min(BINS - 1)] += 1;
                if v >= CLIPPED * saturation[c] {
                    strip.blocks[block].clipped[c] = true;
                    strip.clipped[c] += 1;
                }
            };
            match &counts.layout {
                Layout::Cfa(cfa) => {
                    if let Some(c) = cfa.at(place.x + x, y).plane() {
                        count(c);
                    }
                }
                Layout::Rgb => count(i % 3),
                Layout::Monochrome => (0..3).for_each(count),
            }
        }
    }
    for (block, numbers) in strip.blocks.iter_mut().zip(numbers) {
        for (mean, n) in block.mean.iter_mut().zip(numbers) {
            *mean /= n.max(1.0);
        }
    }
    strip
}
