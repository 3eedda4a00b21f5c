//! The linear light of a whole frame, for measuring: samples as the sensor has them, before anything is interpolated.

use darkroot_photo::{Capture, Counts, Layout, Mosaic, Rect};
use rayon::prelude::*;

use crate::corrections::{self, Run, is_supported};
use crate::level::Levels;
use crate::saturation::saturation;

/// A frame's light and where it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The active area, 0 = black, 1 = the white level; its filters begin at its own top left.
    pub light: Mosaic<f32>,
    /// Light at which red, green and blue really clip.
    pub saturation: [f32; 3],
}

/// Subtracts black, scales to the white level and applies the corrections that the file carries for its samples.
pub fn frame(capture: &Capture) -> Frame {
    let levels = Levels::new(capture);
    let light = match &capture.counts {
        Counts::U16(counts) => light(capture, counts, &levels),
        Counts::F32(counts) => light(capture, counts, &levels),
    };
    Frame { light, saturation: saturation(capture, &levels) }
}

fn light<T: Copy + Into<f32> + Sync>(capture: &Capture, counts: &Mosaic<T>, levels: &Levels) -> Mosaic<f32> {
    let area: Rect = capture.active_area;
    let planes = counts.layout.planes();
    let supported: Vec<_> = capture.mosaic_corrections.iter().filter(|c| is_supported(c)).cloned().collect();
    let mut samples = vec![0f32; area.width * area.height * planes];
    samples.par_chunks_mut(area.width * planes).enumerate().for_each(|(row, light)| {
        let y = area.y + row;
        let start = (y * counts.size.width + area.x) * planes;
        levels.row(&counts.samples[start..start + light.len()], area.x * planes, y, light);
        corrections::row(light, &supported, Run { x: 0, y: row, planes, active: area.size() });
    });
    let layout = match &counts.layout {
        Layout::Cfa(cfa) => Layout::Cfa(cfa.shifted(area.x, area.y)),
        other => other.clone(),
    };
    Mosaic { size: area.size(), layout, samples }
}
