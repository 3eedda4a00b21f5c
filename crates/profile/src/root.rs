//! Root polynomials (Finlayson, Mackiewicz, Hurlbert 2015), applied to single colours in `f64`.

use darkroot_colour::{Matrix3, Vector3, Xyz};

use crate::model::Part;
use crate::{Order, Term};

/// Balanced camera RGB to XYZ relative to D50, homogeneous of degree one.
#[derive(Debug, Clone, PartialEq)]
pub struct RootPolynomial {
    order: Order,
    /// One column of X, Y, Z per term of the order.
    coefficients: Vec<[f64; 3]>,
}

impl RootPolynomial {
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
}

impl Part for RootPolynomial {
    fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        let sum =
            self.terms().fold(Vector3::zeros(), |sum, (term, c)| sum + Vector3::from(c) * term.value(rgb));
        sum.into()
    }

    fn then(&self, matrix: &Matrix3) -> Self {
        let through = |c: &[f64; 3]| (matrix * Vector3::from(*c)).into();
        Self { order: self.order, coefficients: self.coefficients.iter().map(through).collect() }
    }

    /// The result has the higher of the two orders.
    fn plus(&self, other: &Self) -> Self {
        let order = self.order.max(other.order);
        let of = |part: &Self, i: usize| part.coefficients.get(i).copied().unwrap_or_default();
        let sum = |i: usize| [0, 1, 2].map(|k| of(self, i)[k] + of(other, i)[k]);
        Self { order, coefficients: (0..order.terms().len()).map(sum).collect() }
    }

    fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        Self { order: self.order, coefficients: self.coefficients.iter().map(|c| c.map(&change)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_numbers_of_coefficients_are_refused() {
        assert_eq!(RootPolynomial::new(Order::Two, vec![[0.0; 3]; 5]), None);
        assert_eq!(RootPolynomial::new(Order::One, vec![[f64::NAN; 3]; 3]), None);
    }
}
