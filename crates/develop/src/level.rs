//! Black level and white level: from counts to linear light, 0 = black, 1 = saturated.

use darkroot_photo::{Capture, Layout};

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
        // The scale is that of the channel's largest black level (DNG 1.7, chapter 5, "Rescaling"): a pattern in
        // the black level is an offset, not a gain.
        let channel_of = |x: usize, y: usize, plane: usize| match layout {
            Layout::Cfa(cfa) => cfa.at(x, y).plane().unwrap_or(1),
            Layout::Monochrome => 0,
            Layout::Rgb => plane,
        };
        let base_of = |x: usize, y: usize, plane: usize| {
            let i = ((y % black.rows) * black.columns + x % black.columns) * black.planes;
            black.values[i + plane % black.planes]
        };
        let cfa_columns = if let Layout::Cfa(cfa) = layout { cfa.width() } else { 1 };
        let mut largest = [f32::MIN; 3];
        for y in 0..period {
            for x in 0..lcm(black.columns.max(1), cfa_columns).min(size.width.max(1)) {
                for plane in 0..planes {
                    let largest = &mut largest[channel_of(x, y, plane)];
                    *largest = largest.max(base_of(x, y, plane));
                }
            }
        }
        let mut offsets = Vec::with_capacity(period);
        let mut scales = Vec::with_capacity(period);
        for y in 0..period {
            let (mut offset, mut scale) = (Vec::new(), Vec::new());
            for x in 0..size.width {
                for plane in 0..planes {
                    let channel = channel_of(x, y, plane);
                    let delta = black.column_deltas.get(x).copied().unwrap_or(0.0);
                    offset.push(base_of(x, y, plane) + delta);
                    scale.push(1.0 / (capture.white.0[channel] - largest[channel]).max(f32::MIN_POSITIVE));
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
