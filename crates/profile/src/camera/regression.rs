//! The colour matrix that a camera would be published with: the least-squares fit of what its channels see of many
//! surfaces to the XYZ of these surfaces.
//!
//! A row of such a matrix is linear in the channel's sensitivity s: row = B s, with B = (X'WX)^-1 X'W R L, where the rows
//! of R are reflectances, L is the light, X are the XYZ of the surfaces and W their weights. So a published matrix is an
//! observation of the sensitivities. Its scale says nothing: a row is taken relative to its value at the light's white.

use darkroot_colour::spectrum::SAMPLES;
use darkroot_colour::{Matrix3, Spectrum, Vector3};
use nalgebra::{DVector, OMatrix, SVector, U3};

use crate::spectra::Sensitivities;

/// Three numbers for every sample of a spectrum.
pub(super) type Operator = OMatrix<f64, U3, nalgebra::Const<SAMPLES>>;

/// Sensitivities of one channel to their row of the colour matrix under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Regression {
    /// B.
    pub(super) operator: Operator,
    /// XYZ of the light's white, Y = 1.
    pub(super) white: Vector3,
}

impl Regression {
    /// That of weighted surfaces under a light. `None` where their colours do not determine a matrix.
    pub fn under(light: &Spectrum, surfaces: &[(Spectrum, f64)]) -> Option<Self> {
        let mut square = Matrix3::zeros();
        let mut sums = Operator::zeros();
        for (surface, weight) in surfaces {
            let xyz = Vector3::from(surface.reflected_xyz(light));
            let weighted = xyz * *weight;
            square += weighted * xyz.transpose();
            sums += weighted * SVector::<f64, SAMPLES>::from(surface.times(light).0).transpose();
        }
        let operator = square.try_inverse()? * sums;
        let white = Vector3::from(light.white());
        (operator.iter().chain(white.iter()).all(|v| v.is_finite())).then_some(Self { operator, white })
    }

    /// The row of a channel of this sensitivity, scaled to 1 at white.
    pub fn row(&self, sensitivity: &DVector<f64>) -> Vector3 {
        let row = self.operator * sensitivity;
        row.column(0) / self.white.dot(&row.column(0))
    }

    /// The whole matrix of a camera: XYZ to camera RGB, each row scaled to 1 at white.
    pub fn matrix(&self, camera: &Sensitivities) -> Matrix3 {
        let row = |k: usize| self.row(&DVector::from_column_slice(&camera.0[k].0)).transpose();
        Matrix3::from_rows(&[row(0), row(1), row(2)])
    }

    /// The rows of a published matrix, each scaled to 1 at white. `None` where a channel is dark at white.
    pub fn scaled(&self, matrix: &Matrix3) -> Option<[Vector3; 3]> {
        let row = |k: usize| {
            let row = matrix.row(k).transpose();
            let at_white = row.dot(&self.white);
            (at_white.is_finite() && at_white > 0.0).then(|| row / at_white)
        };
        Some([row(0)?, row(1)?, row(2)?])
    }
}

/// The colour matrix of a camera that is fitted the other way round: the inverse of the least-squares fit of XYZ to camera
/// RGB over surfaces under a light. `None` where they do not determine it.
pub(super) fn inverse_fit(
    light: &Spectrum,
    camera: &Sensitivities,
    surfaces: &[Spectrum],
) -> Option<Matrix3> {
    let samples = camera.under(light)?.render(surfaces, light).ok()?;
    let (mut products, mut squares) = (Matrix3::zeros(), Matrix3::zeros());
    for (rgb, xyz) in samples.rgb().iter().zip(samples.xyz()) {
        let rgb = Vector3::from(*rgb);
        products += Vector3::from(*xyz) * rgb.transpose();
        squares += rgb * rgb.transpose();
    }
    (products * squares.try_inverse()?).try_inverse()
}
