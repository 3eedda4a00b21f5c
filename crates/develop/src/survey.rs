//! One look at the whole frame: mean light of small blocks, where channels clip, and which blocks are clipped.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Rect};
use rayon::prelude::*;

use crate::highlights::CLIPPED;
use crate::light::{LinearLight, channels, period};
use crate::noise::Window;
use crate::saturation::{BrightSamples, NO_CHANNEL};

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
    /// Pixels along the side of a block.
    pub side: usize,
    /// All blocks, row by row.
    pub blocks: Vec<Block>,
    /// Share of the white level at which each channel clips.
    pub saturation: [f32; 3],
}

/// Looks at the active area of a capture. What windows of noise show is asked for where channels may clip below the white
/// level.
pub(crate) fn survey<'a>(
    capture: &Capture,
    linear: &LinearLight,
    noise: impl FnOnce() -> &'a [Window],
) -> Survey {
    let area = capture.active_area;
    let side = block_side(capture, area);
    let (columns, rows) = (area.width / side, area.height / side);
    // What is left over below the last row of blocks has a say in where channels clip, too.
    let strips: Vec<Strip> = (0..area.height.div_ceil(side))
        .into_par_iter()
        .map(|row| {
            let y = area.y + row * side;
            let height = side.min(area.bottom() - y);
            let columns = if row < rows { columns } else { 0 };
            strip(capture, linear, Rect { x: area.x, y, width: area.width, height }, side, columns)
        })
        .collect();
    let bright = strips.iter().map(|s| &s.bright).fold(BrightSamples::none(), BrightSamples::and);
    let saturation = bright.saturation(capture.counts.layout(), noise);
    let limits = saturation.map(|s| CLIPPED * s);
    let block =
        |seen: &Seen| Block { mean: seen.mean, clipped: [0, 1, 2].map(|c| seen.most[c] >= limits[c]) };
    let blocks: Vec<Block> = strips.iter().flat_map(|s| s.blocks.iter().map(block)).collect();
    Survey { columns, side, blocks, saturation }
}

/// Mean linear light of each channel in a rectangle of the frame (inside the active area).
pub fn mean(capture: &Capture, linear: &LinearLight, rect: Rect) -> [f64; 3] {
    let side = block_side(capture, rect);
    let (columns, rows) = (rect.width / side, rect.height / side);
    let mut sums = [0f64; 3];
    for row in 0..rows {
        let place = Rect { y: rect.y + row * side, height: side, ..rect };
        for seen in strip(capture, linear, place, side, columns).blocks {
            sums = [0, 1, 2].map(|c| sums[c] + f64::from(seen.mean[c]));
        }
    }
    sums.map(|sum| sum / (columns * rows).max(1) as f64)
}

/// A block is a whole number of periods of the filter array, and no larger than the area.
fn block_side(capture: &Capture, area: Rect) -> usize {
    let (x, y) = period(capture.counts.layout());
    let period = x.max(y);
    (BLOCK.div_ceil(period) * period).min(area.width.min(area.height)).max(1)
}

/// One block before it is known where channels clip.
#[derive(Debug, Clone, Copy)]
struct Seen {
    mean: [f32; 3],
    /// Brightest sample, before the file's corrections.
    most: [f32; 3],
}

/// What one row of blocks holds.
struct Strip {
    blocks: Vec<Seen>,
    bright: BrightSamples,
}

fn strip(capture: &Capture, linear: &LinearLight, place: Rect, side: usize, columns: usize) -> Strip {
    let layout = capture.counts.layout();
    let planes = layout.planes();
    let mut bright = BrightSamples::none();
    let mut light = vec![0f32; place.width * planes];
    // Sums and brightest samples of columns, apart for each row of the filter array.
    let rows = period(layout).1;
    let mut of_columns = vec![(vec![0f32; light.len()], vec![f32::MIN; light.len()]); rows];
    for (i, y) in (place.y..place.bottom()).enumerate() {
        linear.levelled(&capture.counts, place.x, y, &mut light);
        bright.count(&light, &channels(layout, place.x, y, NO_CHANNEL));
        let (sums, most) = &mut of_columns[i % rows];
        // What is clipped shows before the file's corrections, how bright it is after them.
        vectorised(
            #[inline(always)]
            || {
                for (&v, most) in light.iter().zip(most.iter_mut()) {
                    *most = if v > *most { v } else { *most };
                }
            },
        );
        linear.correct(place.x, y, &mut light);
        vectorised(
            #[inline(always)]
            || {
                for (&v, sum) in light.iter().zip(sums.iter_mut()) {
                    *sum += v;
                }
            },
        );
    }
    // A fourth channel takes the samples under filters of other colours.
    let mut blocks = vec![([0f32; 4], [f32::MIN; 4]); columns];
    let mut numbers = [0f32; 4];
    for (i, (sums, most)) in of_columns.iter().enumerate() {
        let of_row = channels(layout, place.x, place.y + i, NO_CHANNEL);
        let of_block: Vec<usize> = of_row.iter().copied().cycle().take(side * planes).collect();
        for &c in &of_block {
            numbers[c] += (place.height - i.min(place.height)).div_ceil(rows) as f32;
        }
        let (sums, most) = (sums.chunks_exact(side * planes), most.chunks_exact(side * planes));
        for ((sums, most), block) in sums.zip(most).zip(&mut blocks) {
            for ((sum, most), &c) in sums.iter().zip(most).zip(&of_block) {
                block.0[c] += sum;
                block.1[c] = block.1[c].max(*most);
            }
        }
    }
    // The one sample of a monochrome pixel stands for all three channels.
    let source = if planes == 1 && numbers[1] + numbers[2] + numbers[3] < 0.5 { [0; 3] } else { [0, 1, 2] };
    let blocks = blocks.iter().map(|(sums, most)| Seen {
        mean: source.map(|c| sums[c] / numbers[c].max(1.0)),
        most: source.map(|c| most[c]),
    });
    Strip { blocks: blocks.collect(), bright }
}
