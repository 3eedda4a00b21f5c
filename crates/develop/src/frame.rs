//! The linear light of a whole frame, for measuring: samples as the sensor has them, before anything is interpolated.

use darkroot_photo::Mosaic;
use rayon::prelude::*;

use crate::Analysis;
use crate::light::{channels, layout_from};
use crate::saturation::{BrightSamples, NO_CHANNEL};

/// Rows that are done at a time.
const ROWS: usize = 64;

/// A frame's light and where it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The active area, 0 = black, 1 = the white level; its filters begin at its own top left.
    pub light: Mosaic<f32>,
    /// Light at which red, green and blue really clip.
    pub saturation: [f32; 3],
}

impl Analysis {
    /// The light of the whole frame: black subtracted, the white level 1, the corrections applied that the file carries
    /// for its samples. Made anew each time.
    pub fn frame(&self) -> Frame {
        let (capture, linear, area) = (self.capture(), self.light(), self.capture().active_area);
        let layout = capture.counts.layout();
        let width = area.width * layout.planes();
        let mut samples = vec![0f32; width * area.height];
        let bright: Vec<BrightSamples> = samples
            .par_chunks_mut(width * ROWS)
            .enumerate()
            .map(|(i, rows)| {
                let mut bright = BrightSamples::none();
                for (y, light) in (area.y + i * ROWS..).zip(rows.chunks_mut(width)) {
                    linear.levelled(&capture.counts, area.x, y, light);
                    bright.count(light, &channels(layout, area.x, y, NO_CHANNEL));
                    linear.correct(area.x, y, light);
                }
                bright
            })
            .collect();
        let bright = bright.iter().fold(BrightSamples::none(), BrightSamples::and);
        let saturation = bright.saturation(layout, || self.noise());
        let layout = layout_from(layout, area.x as isize, area.y as isize);
        let light = Mosaic { size: area.size(), layout, samples };
        Frame { light, saturation }
    }
}
