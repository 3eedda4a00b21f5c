//! What an even surface gives: the shading of lens, light and sensor, and dust, as gains over small blocks.

use darkroot_photo::correction::{Area, GainMap};
use darkroot_photo::{Capture, Correction, Rect};
use rayon::prelude::*;

use super::Medians;
use crate::light::{LinearLight, channels, period};

/// Pixels along a block, at least: smaller than a speck of dust at small apertures, and enough samples against noise.
const BLOCK: usize = 16;
/// Light of the brightest blocks below which a flat tells little.
const DARK: f32 = 0.02;
/// Light from which on samples may be clipped.
const CLIPPED: f32 = 0.97;
/// Share of the blocks that may be as bright as that: lamps in the corner of a frame.
const FEW: f64 = 0.001;
/// Largest gain.
const MOST: f32 = 32.0;

/// Why flat frames even nothing out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FlatFault {
    /// Nearly black.
    #[error(
        "is too dark to even anything out: its brightest part has less than 2 % of the light that the sensor takes; expose more"
    )]
    Dark,
    /// Clipped.
    #[error("is clipped: its brightest part tells nothing; expose less")]
    Clipped,
}

/// Puts the median of flat frames, of which there is at least one, behind the corrections of a capture, as gains
/// for each position of the filter array and each block of at least 16 pixels. The frames [fit](super::fits) the capture.
///
/// # Errors
/// Flats that are too dark or too bright.
pub fn even_out(capture: &mut Capture, frames: &[Capture]) -> Result<(), FlatFault> {
    let lights: Vec<LinearLight> = frames.iter().map(LinearLight::of).collect();
    let (layout, area) = (capture.counts.layout().clone(), capture.active_area);
    let (columns_of, rows_of) = period(&layout);
    let planes = layout.planes();
    let (columns, rows) = ((area.width / BLOCK).max(1), (area.height / BLOCK).max(1));
    let positions = columns_of * rows_of * planes;
    let of_row = |row: usize| {
        let mut sums = vec![(0f64, 0u32); columns * positions];
        let mut medians = Medians::new(frames.len(), area.width * planes);
        let mut light = vec![0f32; area.width * planes];
        for y in (row * area.height).div_ceil(rows)..((row + 1) * area.height).div_ceil(rows) {
            let of_frame = |i: usize, out: &mut [f32]| {
                lights[i].row(&frames[i].counts, area.x, area.y + y, out);
            };
            medians.row(of_frame, &mut light);
            for (i, v) in light.iter().enumerate() {
                let x = i / planes;
                let position = (y % rows_of * columns_of + x % columns_of) * planes + i % planes;
                let (sum, n) = &mut sums[x * columns / area.width * positions + position];
                *sum += f64::from(*v);
                *n += 1;
            }
        }
        sums.into_iter().map(|(sum, n)| (sum / f64::from(n.max(1))) as f32).collect::<Vec<f32>>()
    };
    let blocks: Vec<f32> = (0..rows).into_par_iter().flat_map_iter(of_row).collect();

    let channel_of = |position: usize| {
        let (pixel, plane) = (position / planes, position % planes);
        let channels = channels(&layout, area.x + pixel % columns_of, area.y + pixel / columns_of, 1);
        channels[plane]
    };
    let channel: Vec<usize> = (0..positions).map(channel_of).collect();
    let brightest = [0, 1, 2].map(|c| {
        let of_channel = |(i, v): (usize, &f32)| (channel[i % positions] == c).then_some(*v);
        brightest(blocks.iter().enumerate().filter_map(of_channel).collect())
    });
    let found = brightest.iter().flatten().fold(f32::MAX, |a, &b| a.min(b));
    if found < DARK {
        return Err(FlatFault::Dark);
    }
    let limit = |v: &&f32| **v > CLIPPED;
    if blocks.iter().filter(limit).count() as f64 > FEW * blocks.len() as f64 {
        return Err(FlatFault::Clipped);
    }
    let size = area.size();
    let places = |blocks: usize| (0.5 / blocks as f64, 1.0 / blocks as f64);
    for position in 0..positions {
        let (pixel, plane) = (position / planes, position % planes);
        let reference = brightest[channel[position]].unwrap_or(1.0);
        let gain = |v: &f32| reference / v.max(reference / MOST);
        let map = GainMap {
            rows,
            columns,
            planes: 1,
            vertical: places(rows),
            horizontal: places(columns),
            gains: blocks.iter().skip(position).step_by(positions).map(gain).collect(),
        };
        let (x, y) = (pixel % columns_of, pixel / columns_of);
        let rect = Rect { x, y, width: size.width.saturating_sub(x), height: size.height.saturating_sub(y) };
        let of = Area { rect, plane, planes: 1, row_pitch: rows_of, column_pitch: columns_of };
        capture.mosaic_corrections.push(Correction::Gain(of, map));
    }
    Ok(())
}

/// The light that one block in two hundred exceeds; `None` of no blocks.
fn brightest(mut blocks: Vec<f32>) -> Option<f32> {
    let rank = blocks.len().checked_sub(1)? * 199 / 200;
    Some(*blocks.select_nth_unstable_by(rank, f32::total_cmp).1)
}
