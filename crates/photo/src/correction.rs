//! Corrections that a DNG asks its reader to make (DNG 1.7, chapter 7, "Opcode List Processing").

use serde::{Deserialize, Serialize};

use crate::Rect;

/// The samples that a correction is for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Opcodes 1, 2 and 14, WarpRectilinear, WarpFisheye and WarpRectilinear2: lens distortion and lateral chromatic aberration.
    Warp(Warp),
}

impl Correction {
    /// Whether its parts fit together. Of what comes from another process that is not to be taken for granted.
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Table(area, _)
            | Self::Polynomial(area, _)
            | Self::RowDelta(area, _)
            | Self::ColumnDelta(area, _)
            | Self::RowScale(area, _)
            | Self::ColumnScale(area, _) => area.is_sound(),
            Self::Gain(area, map) => area.is_sound() && map.is_sound(),
            Self::Vignette(_) => true,
            Self::Warp(warp) => !warp.planes.is_empty(),
        }
    }
}

impl Area {
    fn is_sound(&self) -> bool {
        self.row_pitch > 0 && self.column_pitch > 0
    }
}

/// A coarse map of gains over the picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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

impl GainMap {
    fn is_sound(&self) -> bool {
        let count = self.rows.checked_mul(self.columns).and_then(|points| points.checked_mul(self.planes));
        count.is_some_and(|count| count > 0 && count == self.gains.len())
    }
}

/// Gain 1 + k0 r^2 + k1 r^4 + ... + k4 r^10, r = distance from the centre over that of the farthest corner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Vignette {
    /// k0..k4.
    pub coefficients: [f64; 5],
    /// Centre as a fraction of width and height.
    pub centre: (f64, f64),
}

/// How a lens draws straight lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Projection {
    /// Straight, but for its distortion.
    Rectilinear,
    /// The same, the distortion given the other way round: a point is divided by its factor.
    RectilinearInverse,
    /// As a fisheye does.
    Fisheye,
}

/// What a lens does to the points of one plane. Radii are distances from the centre over that of the farthest corner.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Distortion {
    /// By powers from 0 to 14 of the radius (of the angle, for a fisheye): their sum is the factor on a point's radius.
    pub radial: [f64; 15],
    /// kt0, kt1.
    pub tangential: [f64; 2],
    /// Least and largest radius for which that holds; what lies beyond is taken for it.
    pub valid: [f64; 2],
}

impl From<[f64; 6]> for Distortion {
    /// kr0..kr3, of even powers, and kt0, kt1, for all radii.
    fn from([k0, k1, k2, k3, t0, t1]: [f64; 6]) -> Self {
        let mut radial = [0.0; 15];
        (radial[0], radial[2], radial[4], radial[6]) = (k0, k1, k2, k3);
        Self { radial, tangential: [t0, t1], valid: [0.0, f64::MAX] }
    }
}

/// Where each point of the corrected picture comes from, by plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Warp {
    /// What lens the coefficients are for.
    pub projection: Projection,
    /// For each plane; one serves all planes.
    pub planes: Vec<Distortion>,
    /// Centre as a fraction of width and height.
    pub centre: (f64, f64),
}
