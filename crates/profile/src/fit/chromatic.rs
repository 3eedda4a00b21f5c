//! The full model of the spectral prior: a hue-plane model and a residual over chromaticity, fitted to a virtual
//! set.

use darkroot_colour::{Matrix3, Vector3};
use nalgebra::{Cholesky, DMatrix};

use super::least_squares::Problem;
use super::virtual_set::Rendered;
use super::{FitError, hue_plane};
use crate::model::Part;
use crate::residual::{Centre, Residual, direction, white_exact_kernel};
use crate::{Kind, Model};

/// Exponent of the hue-plane model's weights.
const EXPONENT: i32 = 8;
/// Bumps of the residual.
const CENTRES: usize = 40;
/// Weight of the residual's own size (in the kernel's norm), for a set of [`SET`] colours.
const RIDGE: f64 = 0.05;
const SET: f64 = 700.0;
/// Weight of the pull to zero at saturated colours.
const ANCHORS: f64 = 0.003;
/// Weight of the residual's slope, which is what amplifies noise and folds colours over.
const SLOPE: f64 = 0.12;
/// Weight of an ideal band or edge.
const IDEAL: f64 = 0.03;
/// Step over which the slope is taken, relative to the largest channel.
const STEP: f64 = 1e-3;

/// Fits the model to a rendered virtual set.
///
/// # Errors
/// Colours that do not determine it.
pub fn fit(set: &Rendered) -> Result<Model, FitError> {
    let base = hue_plane::fit_with(&set.real_samples()?, EXPONENT)?;
    let undetermined = FitError::Undetermined { kind: Kind::Chromatic };
    let directions: Vec<Vector3> = set.samples.rgb().iter().map(|rgb| direction(*rgb)).collect();
    let centres = farthest(&directions, CENTRES);
    let weights = row_weights(set);
    let count = set.samples.len() as f64;

    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut targets: Vec<[f64; 3]> = Vec::new();
    for ((rgb, xyz), weight) in set.samples.rgb().iter().zip(set.samples.xyz()).zip(&weights) {
        rows.push(features(*rgb, &centres).iter().map(|f| f * weight).collect());
        let rest = Vector3::from(*xyz) - Vector3::from(base.xyz(*rgb));
        targets.push((rest * *weight).into());
    }
    let data = rows.len();
    for (rgb, weight) in set.samples.rgb().iter().zip(&weights) {
        let here = features(*rgb, &centres);
        let largest = rgb[0].max(rgb[1]).max(rgb[2]);
        for channel in 0..3 {
            let mut moved = *rgb;
            moved[channel] += STEP * largest;
            let there = features(moved, &centres);
            let slope = |(t, h): (&f64, &f64)| (t - h) / STEP * SLOPE * weight;
            rows.push(there.iter().zip(&here).map(slope).collect());
        }
    }
    let anchors = saturated();
    let pull = (ANCHORS * count / anchors.len() as f64).sqrt();
    for rgb in &anchors {
        let x = direction(*rgb);
        rows.push(centres.iter().map(|z| pull * white_exact_kernel(&x, z)).collect());
    }
    let size = DMatrix::from_fn(centres.len(), centres.len(), |i, j| {
        let own = if i == j { 1e-9 } else { 0.0 };
        RIDGE * count / SET * white_exact_kernel(&centres[i], &centres[j]) + own
    });
    let root = Cholesky::new(size).ok_or(undetermined.clone())?.l().transpose();
    rows.extend(root.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()));

    targets.resize(rows.len(), [0.0; 3]);
    let problem = Problem {
        rows: DMatrix::from_fn(rows.len(), centres.len(), |i, j| rows[i][j]),
        targets: DMatrix::from_fn(rows.len(), 3, |i, k| targets[i][k]),
        data,
        block: 1,
    };
    let unknowns = problem.solve().ok_or(undetermined.clone())?;
    let bump = |(z, row): (&Vector3, nalgebra::RowDVector<f64>)| Centre {
        rgb: z.map(|v| v * v).into(),
        weight: [row[0], row[1], row[2]],
    };
    let bumps = centres.iter().zip(unknowns.row_iter().map(|r| r.into_owned())).map(bump).collect();
    let residual = Residual::new(bumps).ok_or(undetermined)?;
    Ok(Model { hue_plane: Some(base), residual: Some(residual), ..Model::default() })
}

/// The share of each centre in the XYZ of a colour.
fn features(rgb: [f64; 3], centres: &[Vector3]) -> Vec<f64> {
    let x = direction(rgb);
    let mean = rgb.iter().sum::<f64>() / 3.0;
    centres.iter().map(|z| mean * white_exact_kernel(&x, z)).collect()
}

/// How much an error in XYZ counts at each colour (root mean square of the weights of X, Y and Z in CIEDE2000), scaled
/// so that a residual of the size of the colours weighs 1 in the mean.
fn row_weights(set: &Rendered) -> Vec<f64> {
    let square = |w: &Matrix3| w.norm_squared() / 3.0;
    let squares: Vec<f64> =
        set.metric.iter().zip(set.weights_with(IDEAL)).map(|(w, k)| square(w) * k).collect();
    let mean = |rgb: &[f64; 3]| rgb.iter().sum::<f64>() / 3.0;
    let total: f64 = squares.iter().zip(set.samples.rgb()).map(|(s, rgb)| s * mean(rgb).powi(2)).sum();
    let norm = total / squares.len() as f64;
    squares.iter().map(|s| (s / norm).sqrt()).collect()
}

/// Colours far apart: the one farthest from grey, then always the one farthest from those taken.
fn farthest(directions: &[Vector3], count: usize) -> Vec<Vector3> {
    let grey = crate::residual::grey();
    let mut distance: Vec<f64> = directions.iter().map(|d| (d - grey).norm_squared()).collect();
    let mut taken = Vec::with_capacity(count);
    while taken.len() < count.min(directions.len()) {
        let largest = |a: &usize, b: &usize| distance[*a].total_cmp(&distance[*b]).then(b.cmp(a));
        let Some(next) = (0..directions.len()).max_by(largest) else { break };
        let chosen = directions[next];
        let fresh = taken.is_empty();
        taken.push(chosen);
        for (d, x) in distance.iter_mut().zip(directions) {
            let own = (x - chosen).norm_squared();
            *d = if fresh { own } else { d.min(own) };
        }
    }
    taken
}

/// Colours with one channel at 0 and another at 1.
fn saturated() -> Vec<[f64; 3]> {
    const LEVELS: [f64; 5] = [0.0, 0.1, 0.4, 0.7, 1.0];
    (0..125)
        .map(|i| [LEVELS[i / 25], LEVELS[i / 5 % 5], LEVELS[i % 5]])
        .filter(|rgb| rgb.contains(&0.0) && rgb.contains(&1.0))
        .collect()
}
