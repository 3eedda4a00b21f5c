//! A root polynomial of order 4 on a virtual set, in CIEDE2000, that does not fold over.
//!
//! In the neutral-anchored basis (see [`super::anchored`]) the fit is linear least squares. Three penalties keep the
//! psi part small: a ridge on its coefficients, its value at saturated colours, and its slope at every colour of the
//! set, since slopes amplify noise.
//!
//! Where that model folds, it is moved until it no longer does (`folds.rs`).

use darkroot_colour::{Matrix3, Vector3};
use nalgebra::{DMatrix, DVector};

use super::FitError;
use super::anchored::{features, psi_slopes, root_polynomial, saturated_points};
use super::folds::Folds;
use super::goal::Goal;
use super::virtual_set::Rendered;
use crate::{Kind, Model, Order};

pub(super) const ORDER: Order = Order::Four;
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
        data.fill_lower_triangle_with_upper_triangle();
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

/// Adds the square of a feature vector, each entry times a symmetric 3 x 3 block: the blocks on the diagonal and above it.
fn add_square(sum: &mut DMatrix<f64>, values: &[f64], block: &Matrix3) {
    for (j, column) in values.iter().enumerate() {
        for (i, row) in values[..=j].iter().enumerate() {
            let product = row * column;
            for c in 0..3 {
                for r in 0..3 {
                    sum[(3 * i + r, 3 * j + c)] += block[(r, c)] * product;
                }
            }
        }
    }
}

/// The metric of CIEDE2000, W'W, with a share of plain XYZ of the same size.
fn mixed(w: &Matrix3) -> Matrix3 {
    let metric = w.transpose() * w;
    metric * (1.0 - PLAIN) + Matrix3::identity() * (PLAIN * metric.trace() / 3.0)
}
