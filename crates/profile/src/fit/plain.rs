//! Plain least squares in XYZ, as the papers have it: matrices, polynomials, root polynomials.

use darkroot_colour::Xyz;
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

/// Value of a term for one colour.
type Value = dyn Fn([f64; 3], usize) -> f64;

/// What matrices, polynomials and root polynomials that were fitted at exposure 1 make of the colours at `exposure`
/// (a factor), each colour left out of its fit: the protocol of the paper's second table.
///
/// # Errors
/// Too few colours, colours that do not determine the terms, or another kind of model.
pub fn left_out_at_exposure(samples: &Samples, kind: Kind, exposure: f64) -> Result<Vec<Xyz>, FitError> {
    let scaled: Vec<[f64; 3]> = samples.rgb().iter().map(|rgb| rgb.map(|v| v * exposure)).collect();
    left_out_seen_as(samples, kind, &scaled)
}

/// What they make of the same colours as the camera saw them another time, each colour left out of its fit: the protocol of
/// the paper's third table. `seen` has camera RGB of each colour of the samples.
///
/// # Errors
/// As [`left_out_at_exposure`].
pub fn left_out_seen_as(samples: &Samples, kind: Kind, seen: &[[f64; 3]]) -> Result<Vec<Xyz>, FitError> {
    let (count, value): (usize, Box<Value>) = match kind {
        Kind::Polynomial(degree) => {
            let terms = polynomial::terms(degree);
            (terms.len(), Box::new(|rgb, term| polynomial::value(terms[term], rgb)))
        }
        Kind::Linear => (3, Box::new(|rgb, term| rgb[term])),
        Kind::Root(order) => (order.terms().len(), Box::new(move |rgb, term| order.terms()[term].value(rgb))),
        _ => return Err(FitError::Undetermined { kind }),
    };
    let have = samples.len().min(seen.len());
    if have < count + 1 {
        return Err(FitError::TooFew { kind, need: count + 1, have });
    }
    let features = |rgb: &[[f64; 3]]| DMatrix::from_fn(have, count, |i, term| value(rgb[i], term));
    let problem =
        Problem { rows: features(samples.rgb()), targets: targets(samples.xyz()), data: have, block: 1 };
    let estimates = problem.left_out_at(&features(seen)).ok_or(FitError::Undetermined { kind })?;
    Ok(triples(&estimates).into_iter().map(|[x, y, z]| Xyz::new(x, y, z)).collect())
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
