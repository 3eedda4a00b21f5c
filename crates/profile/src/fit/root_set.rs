//! A root polynomial of order 4 on a virtual set, in CIEDE2000, that does not fold over.
//!
//! In the neutral-anchored basis (see [`super::anchored`]) the fit is linear least squares. Three penalties keep the
//! psi part small: a ridge on its coefficients, its value at saturated colours, and its slope at every colour of the
//! set, since slopes amplify noise.
//!
//! A model folds where the determinant of its Jacobian changes sign: two camera colours become one. So the determinant,
//! relative to that of the model's matrix near grey, must stay above a margin. It is looked at over a grid of
//! chromaticities, which stand for all colours because the model is homogeneous. Where it is below the margin, what is
//! missing is penalised, with a weight that grows from round to round, by the Gauss-Newton method.

use std::sync::OnceLock;

use darkroot_colour::{Matrix3, Vector3, Xyz};
use nalgebra::{DMatrix, DVector, RowDVector};

use super::FitError;
use super::anchored::{features, psi_slopes, root_polynomial, saturated_points};
use super::least_squares::Problem;
use super::virtual_set::Rendered;
use crate::{Kind, Model, Order};

const ORDER: Order = Order::Four;
/// Ridges on the psi coefficients, as shares of the squared length of their columns. The first is taken, and the next
/// larger one as long as the model still folds.
const RIDGES: [f64; 7] = [3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 1e-2];
/// Weight of the pull of psi to zero at saturated colours, as a share of the data's.
const ANCHORS: f64 = 1e-4;
/// Weight of the slope of psi.
const SLOPE: f64 = 0.02;
/// Weight of an ideal band or edge.
const IDEAL: f64 = 0.003;
/// Share of plain XYZ in the metric, the rest being CIEDE2000.
const PLAIN: f64 = 0.1;
/// Least determinant, relative to the matrix's.
const MARGIN: f64 = 0.3;
/// A determinant that reaches this share of the margin passes.
const ENOUGH: f64 = 0.5;
/// Growth of the penalty's weight from round to round, and how many rounds and steps there are at most.
const GROWTH: f64 = 4.0;
const ROUNDS: usize = 12;
const STEPS: usize = 4;

/// Fits the model to a rendered virtual set.
///
/// # Errors
/// Colours that do not determine it.
pub fn fit(set: &Rendered) -> Result<Model, FitError> {
    let undetermined = FitError::Undetermined { kind: Kind::Spectral };
    let colours = Colours::new(set).ok_or(undetermined.clone())?;
    let mut last = None;
    for ridge in RIDGES {
        let goal = colours.goal(ridge).ok_or(undetermined.clone())?;
        let start = goal.solve(&[]).ok_or(undetermined.clone())?;
        let folds = Folds::new(set.samples.white(), &start);
        let moved = folds.remove(&goal, start);
        let done = folds.are_gone(&moved);
        last = Some((folds, moved));
        if done {
            break;
        }
    }
    let (folds, moved) = last.ok_or(undetermined.clone())?;
    let unfolded = folds.shrunk(moved);
    let rows: Vec<[f64; 3]> = (0..unfolded.len() / 3)
        .map(|i| [unfolded[3 * i], unfolded[3 * i + 1], unfolded[3 * i + 2]])
        .collect();
    root_polynomial(ORDER, set.samples.white(), &rows).map(Model::from).ok_or(undetermined)
}

/// The colours of the set as least squares, by their normal equations. Unknowns are X, Y and Z of the first feature, then
/// of the second, and so on.
struct Colours {
    /// Sum of the squares of the colours' own rows.
    data: DMatrix<f64>,
    /// Of those of the penalties.
    penalties: DMatrix<f64>,
    /// Rows times targets.
    targets: DVector<f64>,
    /// Sum of the colours' weights.
    weight: f64,
}

/// The least squares problem without folds in it, reduced to a triangle: a row for each unknown. The rows that keep folds
/// away are steep, so that with them only the triangle is exact enough, not its square.
struct Goal {
    rows: DMatrix<f64>,
    targets: DVector<f64>,
    weight: f64,
}

/// A further row of the problem.
struct Row {
    row: RowDVector<f64>,
    target: f64,
}

impl Colours {
    fn new(set: &Rendered) -> Option<Self> {
        let samples = &set.samples;
        let weights = set.weights_with(IDEAL);
        let metric: Vec<Matrix3> = set.metric.iter().zip(&weights).map(|(m, w)| mixed(m) * *w).collect();
        let width = features(ORDER, [0.0; 3]).len();
        let mut data = DMatrix::zeros(3 * width, 3 * width);
        let mut targets = DVector::zeros(3 * width);
        let mut total = Matrix3::zeros();
        let white = Vector3::from(samples.white());
        for ((rgb, xyz), metric) in samples.rgb().iter().zip(samples.xyz()).zip(&metric) {
            let values = features(ORDER, *rgb);
            add_square(&mut data, &values, metric);
            let rest = Vector3::from(*xyz) - white * rgb[1];
            let weighted = metric * rest;
            for (f, value) in values.iter().enumerate() {
                let mut target = targets.fixed_rows_mut::<3>(3 * f);
                target += weighted * *value;
            }
            total += metric;
        }
        let mut pull = DMatrix::zeros(width, width);
        let points = saturated_points();
        for rgb in &points {
            let mut bent = DVector::from_vec(features(ORDER, *rgb));
            bent.rows_mut(0, 2).fill(0.0);
            pull.ger(ANCHORS / points.len() as f64, &bent, &bent, 1.0);
        }
        let mut steep = DMatrix::zeros(width, width);
        for (rgb, metric) in samples.rgb().iter().zip(&metric) {
            let size = SLOPE * rgb[0].max(rgb[1]).max(rgb[2]);
            let slopes = psi_slopes(ORDER, *rgb);
            let by_channel =
                |c: usize| DVector::from_fn(width, |f, _| if f < 2 { 0.0 } else { slopes[f - 2][c] });
            for slope in [by_channel(0), by_channel(1), by_channel(2)] {
                steep.ger(size * size * metric.trace() / 3.0, &slope, &slope, 1.0);
            }
        }
        let even = total * (3.0 / total.trace());
        let penalties = pull.kronecker(&total) + steep.kronecker(&even);
        Some(Self { data, penalties, targets, weight: weights.iter().sum() })
    }

    /// The problem with a ridge on the psi coefficients, which keeps its condition below 1e8.
    fn goal(&self, ridge: f64) -> Option<Goal> {
        let mut square = &self.data + &self.penalties;
        for c in 6..square.ncols() {
            square[(c, c)] += ridge * self.data[(c, c)];
        }
        let lower = square.cholesky()?.unpack();
        let targets = lower.solve_lower_triangular(&self.targets)?;
        Some(Goal { rows: lower.transpose(), targets, weight: self.weight })
    }
}

/// Adds the square of a feature vector, each entry times a 3 x 3 block.
fn add_square(sum: &mut DMatrix<f64>, values: &[f64], block: &Matrix3) {
    for (j, column) in values.iter().enumerate() {
        for (i, row) in values.iter().enumerate() {
            let mut place = sum.fixed_view_mut::<3, 3>(3 * i, 3 * j);
            place += block * (row * column);
        }
    }
}

impl Goal {
    /// The unknowns with the least sum of squares, further rows included.
    fn solve(&self, further: &[Row]) -> Option<DVector<f64>> {
        let own = self.rows.nrows();
        let mut rows = self.rows.clone().resize_vertically(own + further.len(), 0.0);
        let mut targets = DMatrix::from_column_slice(own, 1, self.targets.as_slice())
            .resize_vertically(own + further.len(), 0.0);
        for (i, Row { row, target }) in further.iter().enumerate() {
            rows.row_mut(own + i).copy_from(row);
            targets[own + i] = *target;
        }
        let unknowns = Problem { rows, targets, data: 0, block: 1 }.solve()?;
        Some(unknowns.column(0).into_owned())
    }

    /// Sum of squares for given unknowns, up to a constant.
    fn cost(&self, unknowns: &DVector<f64>) -> f64 {
        (&self.rows * unknowns - &self.targets).norm_squared()
    }
}

/// The metric of CIEDE2000, W'W, with a share of plain XYZ of the same size.
fn mixed(w: &Matrix3) -> Matrix3 {
    let metric = w.transpose() * w;
    metric * (1.0 - PLAIN) + Matrix3::identity() * (PLAIN * metric.trace() / 3.0)
}

/// Where the model must not fold.
struct Folds {
    white: Vector3,
    /// For each grid point and channel, the derivative of every feature.
    slopes: &'static [Vec<[f64; 3]>],
    /// Determinant of the matrix near grey.
    norm: f64,
}

impl Folds {
    fn new(white: Xyz, start: &DVector<f64>) -> Self {
        let slopes = grid_slopes();
        let mut folds = Self { white: white.into(), slopes, norm: 1.0 };
        // At grey the slopes of psi vanish, so the first two features alone give the matrix.
        folds.norm = folds.jacobian(&folds.slopes[0][..2], start).determinant();
        folds
    }

    /// Derivatives of XYZ by the channels where the features have these derivatives.
    fn jacobian(&self, slopes: &[[f64; 3]], unknowns: &DVector<f64>) -> Matrix3 {
        let mut jacobian = Matrix3::zeros();
        jacobian.set_column(1, &self.white);
        for (f, slope) in slopes.iter().enumerate() {
            let xyz = unknowns.fixed_rows::<3>(3 * f);
            for (c, s) in slope.iter().enumerate() {
                let mut column = jacobian.column_mut(c);
                column += xyz * *s;
            }
        }
        jacobian
    }

    /// Relative determinants over the grid.
    fn determinants(&self, unknowns: &DVector<f64>) -> Vec<f64> {
        self.slopes.iter().map(|s| self.jacobian(s, unknowns).determinant() / self.norm).collect()
    }

    /// Moves from `start` towards unknowns whose determinants are all large enough; it may not get there.
    fn remove(&self, goal: &Goal, start: DVector<f64>) -> DVector<f64> {
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

    fn are_gone(&self, unknowns: &DVector<f64>) -> bool {
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
                let row = self.determinant_slope(slopes, unknowns) * weight.sqrt();
                let target = (MARGIN - d) * weight.sqrt() + row.tr_dot(unknowns);
                Row { row, target }
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
    fn determinant_slope(&self, slopes: &[[f64; 3]], unknowns: &DVector<f64>) -> RowDVector<f64> {
        let j = self.jacobian(slopes, unknowns);
        let cofactor = |c: usize| j.column((c + 1) % 3).cross(&j.column((c + 2) % 3)) / self.norm;
        let cofactors = [cofactor(0), cofactor(1), cofactor(2)];
        RowDVector::from_fn(unknowns.len(), |_, u| {
            let (feature, k) = (u / 3, u % 3);
            (0..3).map(|c| cofactors[c][k] * slopes[feature][c]).sum()
        })
    }

    /// The largest share of the psi part with which the model does not fold; with none of it, a matrix, it never does.
    fn shrunk(&self, unknowns: DVector<f64>) -> DVector<f64> {
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

/// Chromaticities with the largest channel 1: 20 levels from 0.002 in equal ratios.
fn grid() -> Vec<[f64; 3]> {
    const LEVELS: i32 = 20;
    const FIRST: f64 = 0.002;
    let levels = (0..LEVELS).map(|i| FIRST.powf(1.0 - f64::from(i) / f64::from(LEVELS - 1)));
    let levels: Vec<f64> = levels.collect();
    let faces = |&a: &f64, &b: &f64| [[1.0, a, b], [a, 1.0, b], [a, b, 1.0]];
    levels.iter().flat_map(|a| levels.iter().flat_map(move |b| faces(a, b))).collect()
}
