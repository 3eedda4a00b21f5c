//! A white-preserving matrix for each hue, by least squares in CIEDE2000 with weights that fall with the distance
//! in hue (Andersen and Connah, IEEE TIP 25(9), 2016, weighted constrained form).

use std::f64::consts::PI;

use darkroot_colour::{Matrix3, Vector3, Xyz};
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::least_squares::Problem;
use super::metric::de2000_weights;
use super::{Fit, FitError, Samples};
use crate::hue_plane::at_position;
use crate::{HuePlane, Kind};

/// Matrices round the hues: one every 3 degrees of the hexagon.
const KNOTS: usize = 120;
/// Exponents of the weights that are tried.
const EXPONENTS: [i32; 6] = [1, 2, 3, 4, 6, 8];
/// Weight of colours of the opposite hue: not 0, so that every hue has enough colours to fit to.
const LEAST_WEIGHT: f64 = 1e-4;

/// The best of several exponents by leave-one-out.
///
/// # Errors
/// Fewer than 4 colours, or colours that do not determine a matrix.
pub fn fit(samples: &Samples) -> Result<Fit, FitError> {
    let mut best: Option<(f64, i32, Vec<Xyz>)> = None;
    let data = Data::new(samples)?;
    for exponent in EXPONENTS {
        let left_out = data.left_out(exponent)?;
        let score: f64 = left_out.iter().map(|(_, error)| error * error).sum();
        if best.as_ref().is_none_or(|(least, ..)| score < *least) {
            best = Some((score, exponent, left_out.into_iter().map(|(xyz, _)| xyz).collect()));
        }
    }
    let (_, exponent, left_out) = best.ok_or(FitError::Undetermined { kind: Kind::HuePlane })?;
    let model = data.table(exponent)?.into();
    Ok(Fit { model, left_out, settings: format!("exponent {exponent}") })
}

/// The table with a given exponent.
///
/// # Errors
/// Fewer than 4 colours, or colours that do not determine a matrix.
pub fn fit_with(samples: &Samples, exponent: i32) -> Result<HuePlane, FitError> {
    Data::new(samples)?.table(exponent)
}

/// Angle of a colour round the grey axis, radians.
fn angle([r, g, b]: [f64; 3]) -> f64 {
    (3f64.sqrt() * (g - b)).atan2(2.0 * r - g - b)
}

struct Data<'a> {
    samples: &'a Samples,
    angles: Vec<f64>,
    /// Three rows for each sample: of r - g and b - g, for X, Y and Z, in units of CIEDE2000.
    rows: DMatrix<f64>,
    targets: DMatrix<f64>,
    weights: Vec<Matrix3>,
}

impl<'a> Data<'a> {
    fn new(samples: &'a Samples) -> Result<Self, FitError> {
        let (have, need) = (samples.len(), 4);
        if have < need {
            return Err(FitError::TooFew { kind: Kind::HuePlane, need, have });
        }
        let weights = de2000_weights(samples.xyz(), samples.white());
        let mut rows = DMatrix::zeros(3 * have, 6);
        let mut targets = DMatrix::zeros(3 * have, 1);
        let white = Vector3::from(samples.white());
        for (i, (&[r, g, b], xyz)) in samples.rgb().iter().zip(samples.xyz()).enumerate() {
            rows.view_mut((3 * i, 0), (3, 3)).copy_from(&(weights[i] * (r - g)));
            rows.view_mut((3 * i, 3), (3, 3)).copy_from(&(weights[i] * (b - g)));
            targets.rows_mut(3 * i, 3).copy_from(&(weights[i] * (Vector3::from(*xyz) - white * g)));
        }
        let angles = samples.rgb().iter().map(|rgb| angle(*rgb)).collect();
        Ok(Self { samples, angles, rows, targets, weights })
    }

    /// The matrix for a hue, all samples taking part but one.
    fn matrix(&self, hue: f64, exponent: i32, left_out: Option<usize>) -> Result<Matrix3, FitError> {
        let (mut rows, mut targets) = (self.rows.clone(), self.targets.clone());
        for (i, angle) in self.angles.iter().enumerate() {
            let apart = ((angle - hue + PI).rem_euclid(2.0 * PI) - PI).abs();
            let weight = ((PI - apart) / PI).powi(exponent) + LEAST_WEIGHT;
            let weight = if left_out == Some(i) { 0.0 } else { weight.sqrt() };
            rows.rows_mut(3 * i, 3).scale_mut(weight);
            targets.rows_mut(3 * i, 3).scale_mut(weight);
        }
        let problem = Problem { rows, targets, data: 0, block: 1 };
        let c = problem.solve().ok_or(FitError::Undetermined { kind: Kind::HuePlane })?;
        let red = Vector3::new(c[0], c[1], c[2]);
        let blue = Vector3::new(c[3], c[4], c[5]);
        Ok(Matrix3::from_columns(&[red, Vector3::from(self.samples.white()) - red - blue, blue]))
    }

    fn table(&self, exponent: i32) -> Result<HuePlane, FitError> {
        let knot = |i: usize| {
            let position = i as f64 * crate::hue_plane::CORNERS as f64 / KNOTS as f64;
            self.matrix(angle(at_position(position)), exponent, None)
        };
        let knots = (0..KNOTS).into_par_iter().map(knot).collect::<Result<Vec<_>, _>>()?;
        HuePlane::new(knots).ok_or(FitError::Undetermined { kind: Kind::HuePlane })
    }

    /// Every sample by the matrix of its hue, fitted without it, and how far that is off in CIEDE2000.
    fn left_out(&self, exponent: i32) -> Result<Vec<(Xyz, f64)>, FitError> {
        let estimate = |i: usize| {
            let matrix = self.matrix(self.angles[i], exponent, Some(i))?;
            let xyz = matrix * Vector3::from(self.samples.rgb()[i]);
            let error = self.weights[i] * (xyz - Vector3::from(self.samples.xyz()[i]));
            Ok((xyz.into(), error.norm()))
        };
        (0..self.samples.len()).into_par_iter().map(estimate).collect()
    }
}
