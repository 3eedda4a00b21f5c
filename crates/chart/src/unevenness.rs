//! Uneven light over a chart, from the chart's own patches.

use darkroot_colour::decomposition::least_squares;
use nalgebra::{DMatrix, DVector};

/// Rounds of reweighting, which keep single patches from bending the plane.
const ROUNDS: usize = 5;
/// Relative residual at which a patch begins to lose weight.
const SOFT: f64 = 0.02;

/// Light over a chart, relative to its middle: exp(x a + y b), with x and y from -1 (left, top) to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slope {
    /// Change from the middle to the right edge, as a natural logarithm.
    pub across: f64,
    /// Change from the middle to the bottom edge.
    pub down: f64,
}

impl Slope {
    /// Light at a place, relative to the middle.
    pub fn at(self, [x, y]: [f64; 2]) -> f64 {
        (x * self.across + y * self.down).exp()
    }

    /// Largest relative difference of light over the chart.
    pub fn range(self) -> f64 {
        (2.0 * (self.across.abs() + self.down.abs())).exp() - 1.0
    }

    /// The slope that explains measured light against expected light best, robustly. `places` are those of the
    /// patches; `None` for fewer than six patches with light.
    pub fn of(places: &[[f64; 2]], measured: &[f64], expected: &[f64]) -> Option<Self> {
        let rows: Vec<([f64; 2], f64)> = places
            .iter()
            .zip(measured.iter().zip(expected))
            .filter(|(_, (m, e))| **m > 0.0 && **e > 0.0)
            .map(|(p, (m, e))| (*p, (m / e).ln()))
            .collect();
        if rows.len() < 6 {
            return None;
        }
        let mut weights = vec![1.0; rows.len()];
        let mut found = DVector::zeros(3);
        for _ in 0..ROUNDS {
            let design = DMatrix::from_fn(rows.len(), 3, |i, k| {
                let ([x, y], _) = rows[i];
                weights[i] * [1.0, x, y][k]
            });
            let target = DVector::from_fn(rows.len(), |i, _| weights[i] * rows[i].1);
            found = least_squares(design, &target)?;
            for (weight, ([x, y], value)) in weights.iter_mut().zip(&rows) {
                let off = value - found[0] - found[1] * x - found[2] * y;
                *weight = (1.0 / (1.0 + (off / SOFT).powi(2))).sqrt();
            }
        }
        let slope = Self { across: found[1], down: found[2] };
        slope.range().is_finite().then_some(slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_without_measure_has_no_slope() {
        let places: Vec<[f64; 2]> = (0..24).map(|i| [f64::from(i % 6), f64::from(i / 6)]).collect();
        let mut expected = vec![0.2; 24];
        // The light of a patch over the smallest number that there is is infinite.
        expected[3] = 5e-324;
        assert_eq!(Slope::of(&places, &[0.2; 24], &expected), None);
    }

    #[test]
    fn a_slope_is_found_in_spite_of_some_wrong_patches() {
        let places: Vec<[f64; 2]> =
            (0..24).map(|i| [(i % 6) as f64 / 2.5 - 1.0, (i / 6) as f64 / 1.5 - 1.0]).collect();
        let slope = Slope { across: 0.1, down: -0.05 };
        let expected: Vec<f64> = (0..24).map(|i| 0.05 + f64::from(i) / 30.0).collect();
        let mut measured: Vec<f64> =
            places.iter().zip(&expected).map(|(p, e)| 0.7 * e * slope.at(*p)).collect();
        measured[7] *= 1.3;
        measured[20] *= 0.8;
        let found = Slope::of(&places, &measured, &expected).unwrap();
        assert!((found.across - 0.1).abs() < 0.01 && (found.down + 0.05).abs() < 0.01, "{found:?}");
        assert!((slope.range() - (0.3f64.exp() - 1.0)).abs() < 1e-12);
    }
}
