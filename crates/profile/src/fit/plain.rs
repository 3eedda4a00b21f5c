//! Plain least squares in XYZ, as the papers have it: matrices, polynomials, root polynomials.

use colour::Xyz;
use nalgebra::DMatrix;

use super::least_squares::{Problem, Solution};
use super::{Fit, FitError, Samples};
use crate::{Kind, Model, Order, Polynomial, RootPolynomial, polynomial};

/// A matrix (order 1) or a root polynomial with the least sum of squared errors in XYZ.
///
/// # Errors
/// Too few colours, or colours that do not determine the terms.
pub fn root(samples: &Samples, order: Order) -> Result<Fit, FitError> {
    let value = |rgb: [f64; 3], term: usize| order.terms()[term].value(rgb);
    let (triples, left_out) = solve(samples, Kind::plain(order), order.terms().len(), value)?;
    let model = RootPolynomial::new(order, triples).map(Model::from);
    let model = model.ok_or(FitError::Undetermined { kind: Kind::plain(order) })?;
    Ok(Fit { model, left_out, settings: String::new() })
}

/// A plain polynomial of degree 2, 3 or 4 with the least sum of squared errors in XYZ.
///
/// # Errors
/// Too few colours, or colours that do not determine the terms.
pub fn polynomial(samples: &Samples, degree: u8) -> Result<Fit, FitError> {
    let kind = Kind::Polynomial(degree);
    let terms = polynomial::terms(degree);
    let value = |rgb: [f64; 3], term: usize| polynomial::value(terms[term], rgb);
    let (triples, left_out) = solve(samples, kind, terms.len(), value)?;
    let model = Polynomial::new(degree, triples).map(Model::from).ok_or(FitError::Undetermined { kind })?;
    Ok(Fit { model, left_out, settings: String::new() })
}

fn solve(
    samples: &Samples,
    kind: Kind,
    terms: usize,
    value: impl Fn([f64; 3], usize) -> f64,
) -> Result<(Vec<[f64; 3]>, Vec<Xyz>), FitError> {
    // One more than the terms: left out, each colour must still find as many as there are terms.
    let (have, need) = (samples.len(), terms + 1);
    if have < need {
        return Err(FitError::TooFew { kind, need, have });
    }
    let rows = DMatrix::from_fn(have, terms, |i, term| value(samples.rgb()[i], term));
    let problem = Problem { rows, targets: targets(samples.xyz()), data: have, block: 1 };
    let Solution { unknowns, left_out } =
        problem.solve_and_leave_out().ok_or(FitError::Undetermined { kind })?;
    let estimate = |(i, c): (usize, &Xyz)| {
        Xyz::new(c.x - left_out[(i, 0)], c.y - left_out[(i, 1)], c.z - left_out[(i, 2)])
    };
    Ok((triples(&unknowns), samples.xyz().iter().enumerate().map(estimate).collect()))
}

/// Colours as rows of X, Y, Z.
pub(super) fn targets(xyz: &[Xyz]) -> DMatrix<f64> {
    DMatrix::from_fn(xyz.len(), 3, |i, k| [xyz[i].x, xyz[i].y, xyz[i].z][k])
}

/// Rows of X, Y, Z as triples.
pub(super) fn triples(unknowns: &DMatrix<f64>) -> Vec<[f64; 3]> {
    unknowns.row_iter().map(|row| [row[0], row[1], row[2]]).collect()
}
