//! Plain polynomials: what root polynomials were made to replace. They are here to be compared with.

use darkroot_colour::{Matrix3, Vector3, Xyz};

use crate::model::Part;

/// Exponents of r, g and b of every term up to degree 4, in the sequence of Finlayson, Mackiewicz and Hurlbert,
/// "Root-Polynomial Colour Correction", CIC 19, 2011 (their p4).
const TERMS: [[u8; 3]; 34] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    // Degree 2.
    [2, 0, 0],
    [0, 2, 0],
    [0, 0, 2],
    [1, 1, 0],
    [0, 1, 1],
    [1, 0, 1],
    // Degree 3.
    [3, 0, 0],
    [0, 3, 0],
    [0, 0, 3],
    [1, 2, 0],
    [0, 1, 2],
    [1, 0, 2],
    [2, 1, 0],
    [0, 2, 1],
    [2, 0, 1],
    [1, 1, 1],
    // Degree 4.
    [4, 0, 0],
    [0, 4, 0],
    [0, 0, 4],
    [3, 1, 0],
    [3, 0, 1],
    [1, 3, 0],
    [0, 3, 1],
    [1, 0, 3],
    [0, 1, 3],
    [2, 2, 0],
    [0, 2, 2],
    [2, 0, 2],
    [2, 1, 1],
    [1, 2, 1],
    [1, 1, 2],
];

/// Terms of a polynomial of degree 1, 2, 3 or 4; other degrees count as the nearest.
pub fn terms(degree: u8) -> &'static [[u8; 3]] {
    match degree {
        0 | 1 => &TERMS[..3],
        2 => &TERMS[..9],
        3 => &TERMS[..19],
        _ => &TERMS,
    }
}

/// Value of a term for one colour.
pub fn value(term: [u8; 3], rgb: [f64; 3]) -> f64 {
    (0..3).map(|c| rgb[c].powi(i32::from(term[c]))).product()
}

/// Name of a term in profile files: "r", "rg", "r^2gb".
pub fn name(term: [u8; 3]) -> String {
    ["r", "g", "b"]
        .iter()
        .zip(term)
        .map(|(letter, power)| match power {
            0 => String::new(),
            1 => (*letter).to_owned(),
            n => format!("{letter}^{n}"),
        })
        .collect()
}

/// Camera RGB to XYZ by a polynomial without constant term. Not homogeneous: it holds for one exposure only.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial {
    degree: u8,
    /// X, Y and Z of each of `terms(degree)`.
    coefficients: Vec<[f64; 3]>,
}

impl Polynomial {
    /// A polynomial of degree 1 to 4 with X, Y and Z coefficients for each of `terms(degree)`. `None` when their
    /// number or the degree is wrong or one is not finite.
    pub fn new(degree: u8, coefficients: Vec<[f64; 3]>) -> Option<Self> {
        let sound = (1..=4).contains(&degree)
            && coefficients.len() == terms(degree).len()
            && coefficients.iter().flatten().all(|c| c.is_finite());
        sound.then_some(Self { degree, coefficients })
    }

    /// Its degree, 1 to 4.
    pub fn degree(&self) -> u8 {
        self.degree
    }

    /// Each term with its coefficients for X, Y and Z.
    pub fn terms(&self) -> impl Iterator<Item = ([u8; 3], [f64; 3])> + '_ {
        terms(self.degree).iter().copied().zip(self.coefficients.iter().copied())
    }
}

impl Part for Polynomial {
    fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        let sum = self.terms().fold(Vector3::zeros(), |sum, (t, c)| sum + Vector3::from(c) * value(t, rgb));
        sum.into()
    }

    fn then(&self, matrix: &Matrix3) -> Self {
        let through = |c: &[f64; 3]| (matrix * Vector3::from(*c)).into();
        Self { degree: self.degree, coefficients: self.coefficients.iter().map(through).collect() }
    }

    fn plus(&self, other: &Self) -> Self {
        let degree = self.degree.max(other.degree);
        let of = |part: &Self, i: usize| part.coefficients.get(i).copied().unwrap_or_default();
        let sum = |i: usize| [0, 1, 2].map(|k| of(self, i)[k] + of(other, i)[k]);
        Self { degree, coefficients: (0..terms(degree).len()).map(sum).collect() }
    }

    fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        Self { degree: self.degree, coefficients: self.coefficients.iter().map(|c| c.map(&change)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_of_a_degree_is_there_once() {
        for (degree, count) in [(1, 3), (2, 9), (3, 19), (4, 34)] {
            let mut names: Vec<String> = terms(degree).iter().map(|t| name(*t)).collect();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), count);
            assert!(terms(degree).iter().all(|t| (1..=degree).contains(&t.iter().sum::<u8>())));
        }
    }

    #[test]
    fn a_polynomial_is_the_sum_of_its_terms() {
        let coefficients = (0..9).map(|i| [f64::from(i), 1.0, 0.0]).collect();
        let xyz = Polynomial::new(2, coefficients).unwrap().xyz([2.0, 3.0, 5.0]);
        // r g b r2 g2 b2 rg gb rb
        let values = [2.0, 3.0, 5.0, 4.0, 9.0, 25.0, 6.0, 15.0, 10.0];
        let x: f64 = values.iter().enumerate().map(|(i, v)| i as f64 * v).sum();
        assert!((xyz.x - x).abs() < 1e-12 && (xyz.y - values.iter().sum::<f64>()).abs() < 1e-12);
        assert!(xyz.z.abs() < 1e-12);
    }
}
