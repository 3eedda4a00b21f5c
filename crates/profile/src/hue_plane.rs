//! A matrix for each hue: hue-plane preserving colour correction (Andersen and Connah, "Weighted Constrained
//! Hue-Plane Preserving Camera Characterization", IEEE TIP 25(9), 2016).

use darkroot_colour::{Matrix3, Vector3, Xyz};

use crate::model::Part;

/// Hue positions that every table is a multiple of: the corners of the RGB hexagon.
pub const CORNERS: usize = 6;

/// A 3x3 matrix at hues all round, linear in between. Colours of one hue (a plane through the grey axis) share one
/// matrix, so the plane stays a plane, and the correction is homogeneous of degree one.
#[derive(Debug, Clone, PartialEq)]
pub struct HuePlane {
    /// Matrices at [`position`] 0, 6/n, 12/n ...; n is a multiple of [`CORNERS`].
    knots: Vec<Matrix3>,
}

/// Where a colour stands on the RGB hexagon: 0 red, 1 yellow, 2 green, 3 cyan, 4 blue, 5 magenta, always less than
/// 6; greys stand at 0. Colours of one hue plane share it: it does not change when grey is added or the light
/// grows.
pub fn position([r, g, b]: [f64; 3]) -> f64 {
    let (low, high) = (r.min(g).min(b), r.max(g).max(b));
    let chroma = high - low;
    if chroma <= 0.0 {
        return 0.0;
    }
    let position = if r >= g && r >= b {
        (g - b) / chroma
    } else if g >= b {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    if position < 0.0 { position + 6.0 } else { position }
}

/// A colour with that [`position`] and no grey in it.
pub fn at_position(position: f64) -> [f64; 3] {
    let ramp = |centre: f64| {
        let away = (position - centre).rem_euclid(6.0);
        (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0)
    };
    [ramp(0.0), ramp(2.0), ramp(4.0)]
}

impl HuePlane {
    /// A table of matrices at equal distances round the hexagon, the first at red. `None` when there are not 6,
    /// 12, 18 ... of them or a value is not finite.
    pub fn new(knots: Vec<Matrix3>) -> Option<Self> {
        let sound = !knots.is_empty()
            && knots.len().is_multiple_of(CORNERS)
            && knots.iter().flat_map(|m| m.iter()).all(|v| v.is_finite());
        sound.then_some(Self { knots })
    }

    /// The matrices, from red on.
    pub fn knots(&self) -> &[Matrix3] {
        &self.knots
    }

    fn at(&self, position: f64) -> Matrix3 {
        let count = self.knots.len();
        let place = position * count as f64 / CORNERS as f64;
        let first = (place as usize).min(count - 1);
        let share = place - first as f64;
        self.knots[first] * (1.0 - share) + self.knots[(first + 1) % count] * share
    }
}

impl Part for HuePlane {
    fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        (self.at(position(rgb)) * Vector3::from(rgb)).into()
    }

    fn then(&self, matrix: &Matrix3) -> Self {
        Self { knots: self.knots.iter().map(|m| matrix * m).collect() }
    }

    /// Tables of different lengths meet on the longer one; where its length is no multiple of the shorter, the
    /// shorter is read between its knots.
    fn plus(&self, other: &Self) -> Self {
        let count = self.knots.len().max(other.knots.len());
        let at = |i: usize| {
            let position = i as f64 * CORNERS as f64 / count as f64;
            self.at(position) + other.at(position)
        };
        Self { knots: (0..count).map(at).collect() }
    }

    fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        Self { knots: self.knots.iter().map(|m| m.map(&change)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_corners_of_the_hexagon_stand_where_they_should() {
        for (rgb, expected) in [
            ([1.0, 0.0, 0.0], 0.0),
            ([1.0, 1.0, 0.0], 1.0),
            ([0.0, 1.0, 0.0], 2.0),
            ([0.0, 1.0, 1.0], 3.0),
            ([0.0, 0.0, 1.0], 4.0),
            ([1.0, 0.0, 1.0], 5.0),
        ] {
            assert!((position(rgb) - expected).abs() < 1e-12, "{rgb:?}");
        }
    }

    proptest! {
        #[test]
        fn a_position_belongs_to_its_colour(p in 0f64..6.0, grey in 0f64..2.0, k in 1e-3f64..1e3) {
            let rgb = at_position(p).map(|v| (v + grey) * k);
            let back = position(rgb);
            let apart = (back - p).abs();
            prop_assert!(apart.min(6.0 - apart) < 1e-9, "{p} {rgb:?} {back}");
        }
    }
}
