//! Where a homogeneous model folds, and how to unfold it.
//!
//! A model folds where the determinant of its Jacobian changes sign: two camera colours become one. So the determinant,
//! relative to that of the model's matrix near grey, must stay above a margin. It is looked at over a grid of
//! chromaticities, which stand for all colours because the model is homogeneous. Where it is below the margin, what is
//! missing is penalised, with a weight that grows from round to round, by the Gauss-Newton method.

use std::sync::OnceLock;

use darkroot_colour::simd::vectorised;
use darkroot_colour::{Matrix3, Vector3, Xyz};
use nalgebra::DVector;

use super::anchored::psi_slopes;
use super::goal::{Goal, Row};
use super::root_set::ORDER;

/// Least determinant, relative to the matrix's.
const MARGIN: f64 = 0.3;
/// A determinant that reaches this share of the margin passes.
const ENOUGH: f64 = 0.5;
/// Growth of the penalty's weight from round to round, and how many rounds and steps there are at most.
const GROWTH: f64 = 4.0;
const ROUNDS: usize = 12;
const STEPS: usize = 4;

/// Where the model must not fold.
pub(super) struct Folds {
    white: Vector3,
    /// For each grid point and channel, the derivative of every feature.
    slopes: &'static [Vec<[f64; 3]>],
    /// Determinant of the matrix near grey.
    norm: f64,
}

impl Folds {
    pub(super) fn new(white: Xyz, start: &DVector<f64>) -> Self {
        let slopes = grid_slopes();
        let mut folds = Self { white: white.into(), slopes, norm: 1.0 };
        // At grey the slopes of psi vanish, so the first two features alone give the matrix.
        folds.norm = folds.jacobian(&folds.slopes[0][..2], start).determinant();
        folds
    }

    /// Derivatives of XYZ by the channels where the features have these derivatives.
    fn jacobian(&self, slopes: &[[f64; 3]], unknowns: &DVector<f64>) -> Matrix3 {
        let mut columns = [[0.0; 3], self.white.into(), [0.0; 3]];
        for (xyz, slope) in unknowns.as_slice().chunks_exact(3).zip(slopes) {
            for (column, s) in columns.iter_mut().zip(slope) {
                for (sum, v) in column.iter_mut().zip(xyz) {
                    *sum += v * s;
                }
            }
        }
        Matrix3::from_columns(&columns.map(Vector3::from))
    }

    /// Relative determinants over the grid.
    fn determinants(&self, unknowns: &DVector<f64>) -> Vec<f64> {
        let mut found = vec![0.0; self.slopes.len().next_multiple_of(SIDE_BY_SIDE)];
        let white: [f64; 3] = self.white.into();
        let blocks = blocks();
        vectorised(
            #[inline(always)]
            || {
                for (block, out) in blocks.iter().zip(found.chunks_exact_mut(SIDE_BY_SIDE)) {
                    block_of_determinants(block, unknowns.as_slice(), white, out);
                }
            },
        );
        found.truncate(self.slopes.len());
        found.iter_mut().for_each(|d| *d /= self.norm);
        found
    }

    /// Moves from `start` towards unknowns whose determinants are all large enough; it may not get there.
    pub(super) fn remove(&self, goal: &Goal, start: DVector<f64>) -> DVector<f64> {
        let mut unknowns = start;
        let mut determinants = self.determinants(&unknowns);
        let mut weight = goal.weight / self.slopes.len() as f64;
        for _ in 0..ROUNDS {
            if least(&determinants) >= ENOUGH * MARGIN {
                return unknowns;
            }
            for _ in 0..STEPS {
                let Some((next, at)) = self.step(goal, weight, &unknowns, &determinants) else { break };
                (unknowns, determinants) = (next, at);
            }
            weight *= GROWTH;
        }
        unknowns
    }

    pub(super) fn are_gone(&self, unknowns: &DVector<f64>) -> bool {
        least(&self.determinants(unknowns)) >= ENOUGH * MARGIN
    }

    /// One step of Gauss and Newton's method, shortened until the cost falls. `None` when it does not.
    fn step(
        &self,
        goal: &Goal,
        weight: f64,
        unknowns: &DVector<f64>,
        determinants: &[f64],
    ) -> Option<(DVector<f64>, Vec<f64>)> {
        let cost = |x: &DVector<f64>, d: &[f64]| {
            goal.cost(x) + weight * d.iter().map(|d| (MARGIN - d).max(0.0).powi(2)).sum::<f64>()
        };
        let lacking = determinants.iter().zip(self.slopes).filter(|(d, _)| **d < MARGIN);
        let rows: Vec<Row> = lacking
            .map(|(d, slopes)| {
                let slope = self.determinant_slope(slopes, unknowns);
                let row: Vec<f64> = slope.iter().map(|s| s * weight.sqrt()).collect();
                let now: f64 = row.iter().zip(unknowns).map(|(r, x)| r * x).sum();
                Row { row, target: (MARGIN - d) * weight.sqrt() + now }
            })
            .collect();
        let wanted = goal.solve(&rows)?;
        let before = cost(unknowns, determinants);
        (0..10).find_map(|halvings| {
            let next = unknowns + (&wanted - unknowns) * 0.5f64.powi(halvings);
            let at = self.determinants(&next);
            (cost(&next, &at) < before * (1.0 - 1e-6)).then_some((next, at))
        })
    }

    /// Derivative of the relative determinant by the unknowns: the cofactors of the Jacobian times the slopes.
    fn determinant_slope(&self, slopes: &[[f64; 3]], unknowns: &DVector<f64>) -> Vec<f64> {
        let j = self.jacobian(slopes, unknowns);
        let cofactor = |c: usize| j.column((c + 1) % 3).cross(&j.column((c + 2) % 3)) / self.norm;
        let cofactors = [cofactor(0), cofactor(1), cofactor(2)];
        let along = |slope: &[f64; 3], k: usize| (0..3).map(|c| cofactors[c][k] * slope[c]).sum();
        slopes.iter().flat_map(|slope| [0, 1, 2].map(|k| along(slope, k))).collect()
    }

    /// The largest share of the psi part with which the model does not fold; with none of it, a matrix, it never does.
    pub(super) fn shrunk(&self, unknowns: DVector<f64>) -> DVector<f64> {
        let scaled = |share: f64| {
            let mut x = unknowns.clone();
            x.rows_mut(6, unknowns.len() - 6).scale_mut(share);
            x
        };
        let stands = |share: f64| self.are_gone(&scaled(share));
        if stands(1.0) {
            return unknowns;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if stands(middle) { low = middle } else { high = middle }
        }
        scaled(low)
    }
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The derivatives of every feature over the grid; the same for every camera.
fn grid_slopes() -> &'static [Vec<[f64; 3]>] {
    static SLOPES: OnceLock<Vec<Vec<[f64; 3]>>> = OnceLock::new();
    let at = |rgb| {
        let linear = [[1.0, -1.0, 0.0], [0.0, -1.0, 1.0]];
        linear.into_iter().chain(psi_slopes(ORDER, rgb)).collect()
    };
    SLOPES.get_or_init(|| grid().into_iter().map(at).collect())
}

/// Points of the grid whose determinants are computed side by side.
const SIDE_BY_SIDE: usize = 8;

/// For each feature and channel, its derivative at some points of the grid.
type Block = Vec<[[f64; SIDE_BY_SIDE]; 3]>;

/// The same derivatives as [`grid_slopes`], side by side; what is left over at the end is zero.
fn blocks() -> &'static [Block] {
    static BLOCKS: OnceLock<Vec<Block>> = OnceLock::new();
    let block = |points: &[Vec<[f64; 3]>]| -> Block {
        let at = |f: usize, c: usize, i: usize| points.get(i).map_or(0.0, |slopes| slopes[f][c]);
        (0..points[0].len()).map(|f| [0, 1, 2].map(|c| std::array::from_fn(|i| at(f, c, i)))).collect()
    };
    BLOCKS.get_or_init(|| grid_slopes().chunks(SIDE_BY_SIDE).map(block).collect())
}

/// Determinants of the Jacobians at the points of a block.
#[inline(always)]
fn block_of_determinants(
    block: &[[[f64; SIDE_BY_SIDE]; 3]],
    unknowns: &[f64],
    white: [f64; 3],
    out: &mut [f64],
) {
    let [x, y, z] = [0, 1, 2].map(|k| row_of_jacobians(block, unknowns, k, white[k]));
    for (i, out) in out.iter_mut().enumerate() {
        let minor = |a: usize, b: usize| y[a][i] * z[b][i] - y[b][i] * z[a][i];
        *out = x[0][i] * minor(1, 2) - x[1][i] * minor(0, 2) + x[2][i] * minor(0, 1);
    }
}

/// Derivatives of X, Y or Z by the three channels at the points of a block. Sums are arrays of their own, which stay in the
/// processor's registers.
#[inline(always)]
fn row_of_jacobians(
    block: &[[[f64; SIDE_BY_SIDE]; 3]],
    unknowns: &[f64],
    k: usize,
    white: f64,
) -> [[f64; SIDE_BY_SIDE]; 3] {
    let (mut red, mut green, mut blue) = ([0.0; SIDE_BY_SIDE], [white; SIDE_BY_SIDE], [0.0; SIDE_BY_SIDE]);
    for (slopes, xyz) in block.iter().zip(unknowns.chunks_exact(3)) {
        let v = xyz[k];
        for i in 0..SIDE_BY_SIDE {
            red[i] += v * slopes[0][i];
            green[i] += v * slopes[1][i];
            blue[i] += v * slopes[2][i];
        }
    }
    [red, green, blue]
}

/// Chromaticities with the largest channel 1: 20 levels from 0.002 in equal ratios.
fn grid() -> Vec<[f64; 3]> {
    const LEVELS: i32 = 20;
    const FIRST: f64 = 0.002;
    let levels = (0..LEVELS).map(|i| FIRST.powf(1.0 - f64::from(i) / f64::from(LEVELS - 1)));
    let levels: Vec<f64> = levels.collect();
    let faces = |&a: &f64, &b: &f64| [[1.0, a, b], [a, 1.0, b], [a, b, 1.0]];
    levels.iter().flat_map(|a| levels.iter().flat_map(move |b| faces(a, b))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn determinants_side_by_side_are_those_of_each_point() {
        let width = 3 * grid_slopes()[0].len();
        let unknowns = DVector::from_fn(width, |i, _| {
            if i < 6 { [0.6, -0.1, 0.0, -0.1, 0.1, 0.9][i] } else { (i as f64).sin() * 0.02 }
        });
        let folds = Folds::new(Xyz::new(0.95, 1.0, 1.09), &unknowns);
        let all = folds.determinants(&unknowns);
        assert_eq!(all.len(), grid().len());
        for (d, slopes) in all.iter().zip(folds.slopes) {
            let slow = folds.jacobian(slopes, &unknowns).determinant() / folds.norm;
            assert!((d - slow).abs() < 1e-12 * (1.0 + slow.abs()), "{d} {slow}");
        }
    }
}
