//! A local tone map as its writer stored it: what a phone's own rendering does to each part of the picture.

use serde::{Deserialize, Serialize};

/// Gains that depend on the place and on the light there (DNG ProfileGainTableMap and ProfileGainTableMap2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LocalToneMap {
    /// Tables along the height and the width of the active area; at least 1.
    pub points: [usize; 2],
    /// From one table to the next, as shares of the height and the width; more than 0 where there are several.
    pub spacing: [f64; 2],
    /// Where the first table lies, in the same shares; may lie outside.
    pub origin: [f64; 2],
    /// Entries of each table; at least 1.
    pub entries: usize,
    /// What red, green and blue (linear RIMM, 1 = white at the maker's exposure), the least and the most of them add to the light
    /// that a table is asked for.
    pub weights: [f32; 5],
    /// Exponent of that light, 0.25..=4.
    pub gamma: f32,
    /// Factors on light, 0..=1000, row by row of tables, table by table.
    pub gains: Vec<f32>,
}

impl LocalToneMap {
    /// Largest factor that is kept; more stops than this no rendering adds.
    pub const LARGEST: f32 = 1000.0;

    /// Whether the fields agree and all numbers are in their ranges.
    pub fn is_sound(&self) -> bool {
        let [down, across] = self.points;
        let count = down.checked_mul(across).and_then(|tables| tables.checked_mul(self.entries));
        let spaced = |axis: usize| self.points[axis] == 1 || self.spacing[axis] > 1e-6;
        count.is_some_and(|count| count > 0 && count == self.gains.len())
            && spaced(0)
            && spaced(1)
            && self.spacing.iter().chain(&self.origin).all(|v| v.is_finite() && v.abs() < 1e6)
            && self.weights.iter().all(|v| v.is_finite() && v.abs() < 1e6)
            && (0.25..=4.0).contains(&self.gamma)
            && self.gains.iter().all(|gain| (0.0..=Self::LARGEST).contains(gain))
    }
}
