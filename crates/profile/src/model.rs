//! A model of one camera under one light: a sum of parts, applied to single colours in `f64`.

use darkroot_colour::{Matrix3, Vector3, Xyz};

use crate::{HuePlane, Order, Polynomial, Residual, RootPolynomial};

/// Balanced camera RGB to XYZ, the sum of the parts that are there.
///
/// Every part but [`Polynomial`] is homogeneous of degree one: `model(k rgb) = k model(rgb)` for every k > 0. Parts
/// make sums so that two models can always be mixed, be it between two lights or for a fit that is the mean of two.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// A matrix or a root polynomial.
    pub root: Option<RootPolynomial>,
    /// A matrix for each hue.
    pub hue_plane: Option<HuePlane>,
    /// A smooth function of chromaticity.
    pub residual: Option<Residual>,
    /// A plain polynomial, which breaks when the exposure changes: for comparison only.
    pub polynomial: Option<Polynomial>,
}

/// What every part can do.
pub trait Part: Sized {
    /// Its share of the XYZ of one colour.
    fn xyz(&self, rgb: [f64; 3]) -> Xyz;

    /// The same part followed by a matrix on XYZ.
    #[must_use]
    fn then(&self, matrix: &Matrix3) -> Self;

    /// The part that gives the sum of both.
    #[must_use]
    fn plus(&self, other: &Self) -> Self;

    /// The part with every coefficient replaced.
    #[must_use]
    fn map(&self, change: impl Fn(f64) -> f64) -> Self;
}

impl Model {
    /// A matrix. Values that are not finite count as 0.
    pub fn linear(matrix: &Matrix3) -> Self {
        RootPolynomial::linear(matrix).into()
    }

    /// XYZ of one colour.
    pub fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        fn share<P: Part>(part: Option<&P>, rgb: [f64; 3]) -> Vector3 {
            part.map_or_else(Vector3::zeros, |part| part.xyz(rgb).into())
        }
        let sum = share(self.root.as_ref(), rgb)
            + share(self.hue_plane.as_ref(), rgb)
            + share(self.residual.as_ref(), rgb)
            + share(self.polynomial.as_ref(), rgb);
        sum.into()
    }

    /// Whether twice the light gives twice the colour.
    pub fn is_exposure_invariant(&self) -> bool {
        self.polynomial.is_none()
    }

    /// Order of the root polynomial; 1 where there is none.
    pub fn order(&self) -> Order {
        self.root.as_ref().map_or(Order::One, RootPolynomial::order)
    }

    /// The same model followed by a matrix on XYZ.
    #[must_use]
    pub fn then(&self, matrix: &Matrix3) -> Self {
        Self {
            root: self.root.as_ref().map(|part| part.then(matrix)),
            hue_plane: self.hue_plane.as_ref().map(|part| part.then(matrix)),
            residual: self.residual.as_ref().map(|part| part.then(matrix)),
            polynomial: self.polynomial.as_ref().map(|part| part.then(matrix)),
        }
    }

    /// Weighted mean of two models: `weight` of `other`, 0..=1.
    #[must_use]
    pub fn mix(&self, other: &Self, weight: f64) -> Self {
        fn mixed<P: Part>(one: Option<&P>, other: Option<&P>, weight: f64) -> Option<P> {
            let scaled = |part: &P, k: f64| part.then(&(Matrix3::identity() * k));
            match (one.map(|p| scaled(p, 1.0 - weight)), other.map(|p| scaled(p, weight))) {
                (Some(a), Some(b)) => Some(a.plus(&b)),
                (a, b) => a.or(b),
            }
        }
        Self {
            root: mixed(self.root.as_ref(), other.root.as_ref(), weight),
            hue_plane: mixed(self.hue_plane.as_ref(), other.hue_plane.as_ref(), weight),
            residual: mixed(self.residual.as_ref(), other.residual.as_ref(), weight),
            polynomial: mixed(self.polynomial.as_ref(), other.polynomial.as_ref(), weight),
        }
    }

    /// The same model with coefficients of ten decimals: shorter files, which do not depend on the last bits of a
    /// machine's arithmetic.
    #[must_use]
    pub fn rounded(&self) -> Self {
        const DECIMALS: f64 = 1e10;
        // Adding 0 makes a negative zero positive.
        let round = |v: f64| (v * DECIMALS).round() / DECIMALS + 0.0;
        Self {
            root: self.root.as_ref().map(|part| part.map(round)),
            hue_plane: self.hue_plane.as_ref().map(|part| part.map(round)),
            residual: self.residual.as_ref().map(|part| part.map(round)),
            polynomial: self.polynomial.as_ref().map(|part| part.map(round)),
        }
    }

    /// Derivatives at a colour: column c is the change of XYZ with channel c. By central differences, a step of
    /// 1e-5 of the largest channel wide.
    pub fn jacobian(&self, rgb: [f64; 3]) -> Matrix3 {
        let step = 1e-5 * rgb.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let column = |c: usize| {
            let at = |h: f64| {
                let mut moved = rgb;
                moved[c] += h;
                Vector3::from(self.xyz(moved))
            };
            (at(step) - at(-step)) / (2.0 * step)
        };
        Matrix3::from_columns(&[column(0), column(1), column(2)])
    }
}

impl From<RootPolynomial> for Model {
    fn from(part: RootPolynomial) -> Self {
        Self { root: Some(part), ..Self::default() }
    }
}

impl From<HuePlane> for Model {
    fn from(part: HuePlane) -> Self {
        Self { hue_plane: Some(part), ..Self::default() }
    }
}

impl From<Polynomial> for Model {
    fn from(part: Polynomial) -> Self {
        Self { polynomial: Some(part), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples_for_tests::{all_parts, close};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn twice_the_light_is_twice_the_colour(
            exponent in -20i32..=20, r in 0f64..4.0, g in 0f64..4.0, b in 0f64..4.0,
        ) {
            let k = 2f64.powi(exponent);
            for model in all_parts().iter().filter(|m| m.is_exposure_invariant()) {
                let one = model.xyz([r, g, b]);
                prop_assert!(close(model.xyz([r * k, g * k, b * k]), one.scaled(k), 1e-11 * k), "{model:?}");
            }
        }

        #[test]
        fn halfway_between_two_models_is_the_mean_colour(r in 0f64..4.0, g in 0f64..4.0, b in 0f64..4.0) {
            let rgb = [r, g, b];
            for one in all_parts() {
                for other in all_parts() {
                    let mean = (Vector3::from(one.xyz(rgb)) + Vector3::from(other.xyz(rgb))) / 2.0;
                    prop_assert!(close(one.mix(&other, 0.5).xyz(rgb), mean.into(), 1e-9));
                }
            }
        }

        #[test]
        fn a_matrix_after_a_model_is_the_matrix_of_its_colour(
            r in 0f64..4.0, g in 0f64..4.0, b in 0f64..4.0,
        ) {
            let matrix = Matrix3::new(0.9, 0.1, -0.2, 0.3, 0.8, 0.1, 0.0, -0.1, 1.2);
            for model in all_parts() {
                let after = matrix * Vector3::from(model.xyz([r, g, b]));
                prop_assert!(close(model.then(&matrix).xyz([r, g, b]), after.into(), 1e-9));
            }
        }

        #[test]
        fn every_colour_of_every_model_is_finite(r in 0f64..=4.0, g in 0f64..=4.0, b in 0f64..=4.0) {
            let edges = [[0.0; 3], [r, 0.0, 0.0], [0.0, g, 0.0], [0.0, 0.0, b], [r, g, 0.0], [r, g, b]];
            for model in all_parts() {
                for rgb in edges {
                    let c = model.xyz(rgb);
                    prop_assert!(c.x.is_finite() && c.y.is_finite() && c.z.is_finite(), "{rgb:?}");
                }
            }
        }
    }
}
