//! The linear light of a whole frame, for measuring: samples as the sensor has them, before anything is interpolated.

use darkroot_photo::{Capture, Mosaic};
use rayon::prelude::*;

use crate::light::{LinearLight, layout_from};
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
    let (linear, area) = (LinearLight::of(capture), capture.active_area);
    let layout = capture.counts.layout();
    let planes = layout.planes();
    let mut samples = vec![0f32; area.width * area.height * planes];
    samples.par_chunks_mut(area.width * planes).enumerate().for_each(|(row, light)| {
        linear.row(&capture.counts, area.x, area.y + row, light);
    });
    let layout = layout_from(layout, area.x as isize, area.y as isize);
    let light = Mosaic { size: area.size(), layout, samples };
    Frame { light, saturation: saturation(capture, &linear) }
}
