//! Dark and flat frames that a person took for a photograph: what the sensor gives without light, and what it gives of an
//! even surface.
//!
//! They belong to the capture, before anything else looks at it: dark frames are taken off the counts, flats become a gain map
//! behind those of the file. Of several frames the median counts, sample by sample.

mod dark;
mod flat;

pub use dark::take_off;
pub use flat::{FlatFault, even_out};

use darkroot_photo::Capture;

/// Whether a frame can stand beside a capture: the same layout of samples, the same size.
pub fn fits(frame: &Capture, capture: &Capture) -> bool {
    frame.counts.layout() == capture.counts.layout()
        && frame.counts.size() == capture.counts.size()
        && frame.active_area == capture.active_area
}

/// The middle of values, of which there is at least one: the mean of the two in the middle where their number is even, since
/// frames are few.
fn middle(values: &mut [f32]) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    let n = values.len();
    0.5 * (values[(n - 1) / 2] + values[n / 2])
}

/// Rows of several frames, one after the other, and their median.
struct Medians {
    rows: Vec<Vec<f32>>,
    values: Vec<f32>,
}

impl Medians {
    /// For so many frames with so many samples in a row.
    fn new(frames: usize, samples: usize) -> Self {
        Self { rows: vec![vec![0.0; samples]; frames], values: vec![0.0; frames] }
    }

    /// The median of what `light` gives of each frame, sample by sample: the mean of the two in the middle where their number
    /// is even.
    fn row(&mut self, light: impl Fn(usize, &mut [f32]), out: &mut [f32]) {
        for (frame, row) in self.rows.iter_mut().enumerate() {
            light(frame, row);
        }
        for (x, out) in out.iter_mut().enumerate() {
            for (value, row) in self.values.iter_mut().zip(&self.rows) {
                *value = row[x];
            }
            *out = middle(&mut self.values);
        }
    }
}

#[cfg(test)]
mod tests;
