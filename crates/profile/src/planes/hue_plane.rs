//! A hue-plane model over planes.

use super::{Out, PlanePart};
use crate::HuePlane;
use crate::hue_plane::CORNERS;

/// The table of matrices in single precision.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HuePlanes {
    /// Rows of each matrix, the first matrix again at the end.
    knots: Vec<[[f32; 3]; 3]>,
    /// Knots to a unit of position.
    scale: f32,
}

impl HuePlanes {
    pub(super) fn new(part: &HuePlane) -> Self {
        let rows = |m: &darkroot_colour::Matrix3| [0, 1, 2].map(|r| [0, 1, 2].map(|c| m[(r, c)] as f32));
        let knots = part.knots();
        let scale = knots.len() as f32 / CORNERS as f32;
        Self { knots: knots.iter().chain(knots.first()).map(rows).collect(), scale }
    }
}

impl PlanePart for HuePlanes {
    #[inline(always)]
    fn add(&self, [r, g, b]: [&[f32]; 3], out: &mut Out) {
        let last = self.knots.len() - 2;
        let [x, y, z] = out;
        let pixels = r.iter().zip(g).zip(b).zip(x.iter_mut().zip(y).zip(z));
        for (((&r, &g), &b), ((x, y), z)) in pixels {
            let place = position(r, g, b) * self.scale;
            let first = (place as usize).min(last);
            let share = place - first as f32;
            let (low, high) = (&self.knots[first], &self.knots[first + 1]);
            let row = |i: usize| {
                let at = |c: usize| low[i][c] + share * (high[i][c] - low[i][c]);
                at(0) * r + at(1) * g + at(2) * b
            };
            *x += row(0);
            *y += row(1);
            *z += row(2);
        }
    }
}

/// [`crate::hue_plane::position`] in single precision.
#[inline(always)]
fn position(r: f32, g: f32, b: f32) -> f32 {
    let (low, high) = (r.min(g).min(b), r.max(g).max(b));
    let chroma = (high - low).max(f32::MIN_POSITIVE);
    let (from, difference) = if r >= g && r >= b {
        (0.0, g - b)
    } else if g >= b {
        (2.0, b - r)
    } else {
        (4.0, r - g)
    };
    let position: f32 = from + difference / chroma;
    if position < 0.0 { position + 6.0 } else { position }
}
