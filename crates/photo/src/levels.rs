//! Black and white level: which stored numbers mean no light and saturation.

use serde::{Deserialize, Serialize};

/// Stored value of no light. It repeats over a small block of pixels and may drift by row and column
/// (DNG 1.7, BlackLevel, BlackLevelRepeatDim, BlackLevelDeltaV and H). Anchored at the first stored sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlackLevel {
    /// Columns of the repeating block, at least 1.
    pub columns: usize,
    /// Rows of the repeating block, at least 1.
    pub rows: usize,
    /// Samples a pixel: 1 or 3.
    pub planes: usize,
    /// `rows * columns * planes` values.
    pub values: Vec<f32>,
    /// Added to every sample of a row; empty, or one for each row of the frame.
    pub row_deltas: Vec<f32>,
    /// Added to every sample of a column; empty, or one for each column of the frame.
    pub column_deltas: Vec<f32>,
}

impl BlackLevel {
    /// The same value for every sample.
    pub fn uniform(value: f32) -> Self {
        Self {
            columns: 1,
            rows: 1,
            planes: 1,
            values: vec![value],
            row_deltas: Vec::new(),
            column_deltas: Vec::new(),
        }
    }

    /// Black level of sample `plane` of the pixel in column `x` of row `y`.
    pub fn at(&self, x: usize, y: usize, plane: usize) -> f32 {
        let i = ((y % self.rows) * self.columns + x % self.columns) * self.planes + plane % self.planes;
        self.values[i]
            + self.row_deltas.get(y).copied().unwrap_or(0.0)
            + self.column_deltas.get(x).copied().unwrap_or(0.0)
    }

    /// Mean over the repeating block, without the deltas.
    pub fn mean(&self) -> f32 {
        self.values.iter().sum::<f32>() / self.values.len().max(1) as f32
    }
}

/// Stored value at which a sample is saturated, for red, green and blue (all three the same for monochrome).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WhiteLevel(pub [f32; 3]);
