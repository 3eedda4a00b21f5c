//! A model of one camera under one light, applied to single colours in `f64`.

use colour::{Matrix3, Vector3, Xyz};

use crate::{Order, Term};

/// Balanced camera RGB to XYZ relative to D50, homogeneous of degree one.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    order: Order,
    /// One column of X, Y, Z per term of the order.
    coefficients: Vec<[f64; 3]>,
}

impl Model {
    /// A root polynomial of `order` with X, Y and Z coefficients for each of `order.terms()`. `None` when their
    /// number is wrong or one is not finite.
    pub fn new(order: Order, coefficients: Vec<[f64; 3]>) -> Option<Self> {
        let sound =
            coefficients.len() == order.terms().len() && coefficients.iter().flatten().all(|c| c.is_finite());
        sound.then_some(Self { order, coefficients })
    }

    /// A matrix as a model of order 1. Values that are not finite count as 0.
    pub fn linear(matrix: &Matrix3) -> Self {
        let finite = |v: f64| if v.is_finite() { v } else { 0.0 };
        let column = |c: usize| [0, 1, 2].map(|row| finite(matrix[(row, c)]));
        Self { order: Order::One, coefficients: vec![column(0), column(1), column(2)] }
    }

    /// Its order.
    pub fn order(&self) -> Order {
        self.order
    }

    /// Each term with its coefficients for X, Y and Z.
    pub fn terms(&self) -> impl Iterator<Item = (Term, [f64; 3])> + '_ {
        self.order.terms().iter().copied().zip(self.coefficients.iter().copied())
    }

    /// XYZ of one colour.
    pub fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        let sum =
            self.terms().fold(Vector3::zeros(), |sum, (term, c)| sum + Vector3::from(c) * term.value(rgb));
        sum.into()
    }

    /// The same model followed by a matrix on XYZ.
    #[must_use]
    pub fn then(&self, matrix: &Matrix3) -> Self {
        let through = |c: &[f64; 3]| (matrix * Vector3::from(*c)).into();
        Self { order: self.order, coefficients: self.coefficients.iter().map(through).collect() }
    }

    /// Weighted mean of two models: `weight` of `other`, 0..=1. The result has the higher of the two orders.
    #[must_use]
    pub fn mix(&self, other: &Self, weight: f64) -> Self {
        let order = self.order.max(other.order);
        let of = |model: &Self, i: usize| model.coefficients.get(i).copied().unwrap_or_default();
        let coefficients = (0..order.terms().len())
            .map(|i| {
                let (a, b) = (of(self, i), of(other, i));
                [0, 1, 2].map(|k| a[k] + weight * (b[k] - a[k]))
            })
            .collect();
        Self { order, coefficients }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn bent(order: Order) -> Model {
        let coefficients = (0..order.terms().len())
            .map(|i| [0.3 / (1.0 + i as f64), 0.4 / (2.0 + i as f64), 0.1 * (i as f64 - 3.0)])
            .collect();
        Model::new(order, coefficients).unwrap()
    }

    #[test]
    fn twice_the_light_is_twice_the_colour() {
        for order in [Order::One, Order::Two, Order::Three, Order::Four] {
            let model = bent(order);
            for k in [2f64.powi(-20), 0.01, 3.0, 2f64.powi(20)] {
                let (one, two) = (model.xyz([0.2, 0.5, 0.1]), model.xyz([0.2 * k, 0.5 * k, 0.1 * k]));
                for (a, b) in [(one.x, two.x), (one.y, two.y), (one.z, two.z)] {
                    assert!((a * k - b).abs() < 1e-12 * (a * k).abs().max(k), "{order:?} {k}");
                }
            }
        }
    }

    #[test]
    fn halfway_between_two_models_is_the_mean_colour() {
        let (one, two) = (bent(Order::Two), bent(Order::Four));
        let rgb = [0.7, 0.2, 0.4];
        let mean = one.mix(&two, 0.5).xyz(rgb);
        assert!((mean.y - (one.xyz(rgb).y + two.xyz(rgb).y) / 2.0).abs() < 1e-14);
    }

    #[test]
    fn wrong_numbers_of_coefficients_are_refused() {
        assert_eq!(Model::new(Order::Two, vec![[0.0; 3]; 5]), None);
        assert_eq!(Model::new(Order::One, vec![[f64::NAN; 3]; 3]), None);
    }
}
