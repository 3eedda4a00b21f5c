//! Corrections that a DNG asks its reader to make (DNG 1.7, chapter 7, "Opcode List Processing").

use crate::Rect;

/// The samples that a correction is for.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    /// Rectangle, in pixels from the top left corner of the active area.
    pub rect: Rect,
    /// First plane.
    pub plane: usize,
    /// Number of planes.
    pub planes: usize,
    /// Every how many rows (at least 1).
    pub row_pitch: usize,
    /// Every how many columns (at least 1).
    pub column_pitch: usize,
}

/// One correction, in the order of the list that holds it. Values are linear: 0 = black, 1 = saturated.
#[derive(Debug, Clone, PartialEq)]
pub enum Correction {
    /// Opcode 7, MapTable: stored value (0..=65535) -> table entry; the last entry serves all beyond it.
    Table(Area, Vec<u16>),
    /// Opcode 8, MapPolynomial: sum of `coefficients[i] * v^i`.
    Polynomial(Area, Vec<f64>),
    /// Opcode 9, GainMap: a coarse map of gains, interpolated.
    Gain(Area, GainMap),
    /// Opcode 10, DeltaPerRow: added to each row.
    RowDelta(Area, Vec<f32>),
    /// Opcode 11, DeltaPerColumn: added to each column.
    ColumnDelta(Area, Vec<f32>),
    /// Opcode 12, ScalePerRow: multiplied into each row.
    RowScale(Area, Vec<f32>),
    /// Opcode 13, ScalePerColumn: multiplied into each column.
    ColumnScale(Area, Vec<f32>),
    /// Opcode 3, FixVignetteRadial.
    Vignette(Vignette),
    /// Opcodes 1 and 2, WarpRectilinear and WarpFisheye: lens distortion and lateral chromatic aberration.
    Warp(Warp),
}

/// A coarse map of gains over the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct GainMap {
    /// Rows of the map.
    pub rows: usize,
    /// Columns of the map.
    pub columns: usize,
    /// Planes of the map.
    pub planes: usize,
    /// Vertical place of the first row and distance of rows, as a fraction of the active area's height.
    pub vertical: (f64, f64),
    /// Horizontal place of the first column and distance of columns, as a fraction of the width.
    pub horizontal: (f64, f64),
    /// `rows * columns * planes` gains.
    pub gains: Vec<f32>,
}

/// Gain 1 + k0 r^2 + k1 r^4 + ... + k4 r^10, r = distance from the centre over that of the farthest corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Vignette {
    /// k0..k4.
    pub coefficients: [f64; 5],
    /// Centre as a fraction of width and height.
    pub centre: (f64, f64),
}

/// How a lens draws straight lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    /// Straight, but for its distortion.
    Rectilinear,
    /// As a fisheye does.
    Fisheye,
}

/// Where each point of the corrected picture comes from, by plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Warp {
    /// What lens the coefficients are for.
    pub projection: Projection,
    /// kr0..kr3 (radial) and kt0, kt1 (tangential, 0 for a fisheye) for each plane; one set serves all planes.
    pub planes: Vec<[f64; 6]>,
    /// Centre as a fraction of width and height.
    pub centre: (f64, f64),
}
