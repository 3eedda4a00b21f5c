//! Black level and white level: from counts to linear light, 0 = black, 1 = saturated.

use photo::{Capture, Layout};

/// Offsets and scales of every sample of a frame, prepared once.
#[derive(Debug, Clone)]
pub struct Levels {
    /// For each row of the repeating pattern: what to subtract from each sample of a row.
    offsets: Vec<Vec<f32>>,
    /// For each row of the repeating pattern: what to multiply each sample of a row by.
    scales: Vec<Vec<f32>>,
    /// Black level deltas of the rows; empty when there are none.
    row_deltas: Vec<f32>,
}

impl Levels {
    /// Prepares the levels of a capture: black level with its repeat pattern and deltas, white level by filter.
    pub fn new(capture: &Capture) -> Self {
        let (black, layout, size) = (&capture.black, capture.counts.layout(), capture.counts.size());
        let planes = layout.planes();
        let cfa_rows = if let Layout::Cfa(cfa) = layout { cfa.height() } else { 1 };
        let period = lcm(black.rows.max(1), cfa_rows);
        let mut offsets = Vec::with_capacity(period);
        let mut scales = Vec::with_capacity(period);
        for y in 0..period {
            let (mut offset, mut scale) = (Vec::new(), Vec::new());
            for x in 0..size.width {
                for plane in 0..planes {
                    let channel = match layout {
                        Layout::Cfa(cfa) => cfa.at(x, y).plane().unwrap_or(1),
                        Layout::Monochrome => 0,
                        Layout::Rgb => plane,
                    };
                    let delta = black.column_deltas.get(x).copied().unwrap_or(0.0);
                    let base = black.values[((y % black.rows) * black.columns + x % black.columns)
                        * black.planes
                        + plane % black.planes];
                    offset.push(base + delta);
                    scale.push(1.0 / (capture.white.0[channel] - base).max(f32::MIN_POSITIVE));
                }
            }
            offsets.push(offset);
            scales.push(scale);
        }
        Self { offsets, scales, row_deltas: black.row_deltas.clone() }
    }

    /// Linear light of a run of samples of row `y`, of which the first is sample `first` of the row (column
    /// times samples a pixel).
    #[inline(always)]
    pub fn row<T: Copy + Into<f32>>(&self, counts: &[T], first: usize, y: usize, light: &mut [f32]) {
        let pattern = y % self.offsets.len();
        let delta = self.row_deltas.get(y).copied().unwrap_or(0.0);
        let run = first..first + counts.len();
        let (offsets, scales) = (&self.offsets[pattern][run.clone()], &self.scales[pattern][run]);
        for (((light, &count), offset), scale) in light.iter_mut().zip(counts).zip(offsets).zip(scales) {
            *light = (count.into() - (offset + delta)) * scale;
        }
    }
}

fn lcm(a: usize, b: usize) -> usize {
    let mut multiple = a.max(1);
    while !multiple.is_multiple_of(b.max(1)) {
        multiple += a.max(1);
    }
    multiple
}
