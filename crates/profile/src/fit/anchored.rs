//! Root polynomials in the neutral-anchored basis, regularised.
//!
//! A term of the paper is r^e1 g^e2 b^e3, with exponents e that sum to 1: a weighted geometric mean of the channels.
//! Here it is replaced by psi_e = e.rgb - r^e1 g^e2 b^e3, the weighted arithmetic mean less the geometric one. Together
//! with r, g and b these span the same functions, but psi and its gradient are 0 on the grey axis. So white is exact
//! whatever the coefficients, the linear part alone decides about greys, and a penalty on the coefficients of psi
//! shrinks the model towards the best white-preserving matrix:
//!
//! XYZ = g * white + (r - g) c1 + (b - g) c2 + sum over e of psi_e c_e

use darkroot_colour::Xyz;
use nalgebra::DMatrix;

use super::least_squares::{Problem, Solution};
use super::plain::{targets, triples};
use super::{Fit, FitError, Samples};
use crate::{Kind, Order, RootPolynomial, Term};

/// Errors weigh more in the dark, but below this luminance no more than at it: there CIELAB becomes linear.
const DARKEST: f64 = 0.0089;
/// Fewest colours for orders 3 and 4.
const MANY: usize = 20;
/// Ridges that are tried, as shares of the squared length of the psi columns. There is no 0 among them: with 24 patches
/// leave-one-out would choose it at times, and single colours would be off by dE 9.
const RIDGES: [f64; 7] = [1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0];
/// Weights of the pull at saturated colours (the anchors) that are tried.
const ANCHORS: [f64; 3] = [1e-4, 1e-3, 1e-2];
/// A lower order within this factor of the best one is taken.
const AS_GOOD: f64 = 1.01;

/// How strongly the psi part is held back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Order of the root polynomial, 2 to 4 (1 leaves the best white-preserving matrix).
    pub order: Order,
    /// Ridge on the psi coefficients, as a share of the squared length of their columns.
    pub ridge: f64,
    /// Weight of the pull of psi to zero at saturated colours, as a share of the data's.
    pub anchors: f64,
}

/// Value of psi for one colour; 0 for linear terms.
pub fn psi(term: Term, rgb: [f64; 3]) -> f64 {
    let mean: f64 = (0..3).map(|c| f64::from(term.powers[c]) * rgb[c].max(0.0)).sum();
    mean / f64::from(term.root) - term.value(rgb.map(|v| v.max(0.0)))
}

/// The 18 most saturated points of {0, 1/2, 1}^3: one channel at 0, not all equal.
pub fn saturated_points() -> Vec<[f64; 3]> {
    let level = |i: usize| i as f64 / 2.0;
    (0..27)
        .map(|i| [level(i / 9), level(i / 3 % 3), level(i % 3)])
        .filter(|rgb| rgb.contains(&0.0) && rgb.iter().any(|v| *v > 0.0))
        .filter(|rgb| rgb[0].to_bits() != rgb[1].to_bits() || rgb[1].to_bits() != rgb[2].to_bits())
        .collect()
}

/// The best of all settings by leave-one-out; a lower order that is within 1 % of the best is taken instead.
///
/// # Errors
/// Fewer than 7 colours, or colours that do not determine the terms.
pub fn fit(samples: &Samples) -> Result<Fit, FitError> {
    let orders: &[Order] =
        if samples.len() >= MANY { &[Order::Two, Order::Three, Order::Four] } else { &[Order::Two] };
    let mut best: Vec<(f64, Fit)> = Vec::new();
    for &order in orders {
        let mut of_order: Option<(f64, Fit)> = None;
        for ridge in RIDGES {
            for anchors in ANCHORS {
                let (score, fit) = fit_with(samples, Settings { order, ridge, anchors })?;
                if of_order.as_ref().is_none_or(|(least, _)| score < *least) {
                    of_order = Some((score, fit));
                }
            }
        }
        best.extend(of_order);
    }
    let least = best.iter().map(|(score, _)| *score).fold(f64::INFINITY, f64::min);
    let simplest = best.into_iter().find(|(score, _)| *score <= AS_GOOD * least);
    simplest.map(|(_, fit)| fit).ok_or(FitError::Undetermined { kind: Kind::Anchored })
}

/// The fit with given settings, and its leave-one-out error: the root of the mean square of the weighted XYZ errors.
///
/// # Errors
/// Fewer than 7 colours, or colours that do not determine the terms.
pub fn fit_with(samples: &Samples, settings: Settings) -> Result<(f64, Fit), FitError> {
    let kind = Kind::Anchored;
    let (have, need) = (samples.len(), 7);
    if have < need {
        return Err(FitError::TooFew { kind, need, have });
    }
    let weights: Vec<f64> = samples.xyz().iter().map(|c| c.y.max(DARKEST).powf(-1.0 / 3.0)).collect();
    let mean_square = weights.iter().map(|w| w * w).sum::<f64>() / have as f64;
    let problem = problem(samples, &weights, mean_square, settings);
    let Solution { unknowns, left_out } =
        problem.solve_and_leave_out().ok_or(FitError::Undetermined { kind })?;
    let score = (left_out.norm_squared() / have as f64).sqrt();
    let estimate = |(i, c): (usize, &Xyz)| {
        let off = |k: usize| left_out[(i, k)] / weights[i];
        Xyz::new(c.x - off(0), c.y - off(1), c.z - off(2))
    };
    let Settings { order, ridge, anchors } = settings;
    let model = root_polynomial(order, samples.white(), &triples(&unknowns));
    let fit = Fit {
        model: model.ok_or(FitError::Undetermined { kind })?.into(),
        left_out: samples.xyz().iter().enumerate().map(estimate).collect(),
        settings: format!("order {}, ridge {ridge}, anchors {anchors}", order.number()),
    };
    Ok((score, fit))
}

fn problem(samples: &Samples, weights: &[f64], mean_square: f64, settings: Settings) -> Problem {
    let count = samples.len();
    let columns = features(settings.order, [0.0; 3]).len();
    let rows: Vec<Vec<f64>> = samples
        .rgb()
        .iter()
        .zip(weights)
        .map(|(rgb, w)| features(settings.order, *rgb).iter().map(|f| f * w).collect())
        .collect();
    let length = |c: usize| rows.iter().map(|row| row[c] * row[c]).sum::<f64>().sqrt();
    let ridge = (2..columns).map(|c| {
        let mut row = vec![0.0; columns];
        row[c] = settings.ridge.sqrt() * length(c);
        row
    });
    let points = saturated_points();
    let pull = (settings.anchors * count as f64 / points.len() as f64 * mean_square).sqrt();
    let anchors = points.iter().map(|rgb| {
        let mut row: Vec<f64> = features(settings.order, *rgb).iter().map(|f| f * pull).collect();
        row[..2].fill(0.0);
        row
    });
    let all: Vec<Vec<f64>> = rows.iter().cloned().chain(ridge).chain(anchors).collect();
    let mut full = targets(samples.xyz());
    let white = [samples.white().x, samples.white().y, samples.white().z];
    for (i, rgb) in samples.rgb().iter().enumerate() {
        for k in 0..3 {
            full[(i, k)] = (full[(i, k)] - rgb[1] * white[k]) * weights[i];
        }
    }
    Problem {
        rows: DMatrix::from_fn(all.len(), columns, |i, c| all[i][c]),
        targets: full.resize_vertically(all.len(), 0.0),
        data: count,
        block: 1,
    }
}

/// r - g, b - g, then psi of every term above order 1.
pub(super) fn features(order: Order, rgb: [f64; 3]) -> Vec<f64> {
    let [r, g, b] = rgb;
    let bent = order.terms()[3..].iter().map(|term| psi(*term, rgb));
    [r - g, b - g].into_iter().chain(bent).collect()
}

/// Derivatives by r, g and b of psi of every term above order 1, for a colour whose channels are all positive:
/// e_c - e_c r^e1 g^e2 b^e3 / c.
pub(super) fn psi_slopes(order: Order, rgb: [f64; 3]) -> Vec<[f64; 3]> {
    let slopes = |term: &Term| {
        let value = term.value(rgb);
        [0, 1, 2].map(|c| {
            let e = f64::from(term.powers[c]) / f64::from(term.root);
            e - e * value / rgb[c]
        })
    };
    order.terms()[3..].iter().map(slopes).collect()
}

/// The root polynomial in the paper's terms that has these coefficients of [`features`] and maps (1,1,1) to white.
pub(super) fn root_polynomial(order: Order, white: Xyz, coefficients: &[[f64; 3]]) -> Option<RootPolynomial> {
    let mut terms = vec![[0.0; 3]; order.terms().len()];
    let white = [white.x, white.y, white.z];
    for k in 0..3 {
        let (red, blue) = (coefficients[0][k], coefficients[1][k]);
        let mut linear = [red, white[k] - red - blue, blue];
        for (i, term) in order.terms().iter().enumerate().skip(3) {
            let c = coefficients[i - 1][k];
            terms[i][k] = -c;
            for (channel, value) in linear.iter_mut().enumerate() {
                *value += c * f64::from(term.powers[channel]) / f64::from(term.root);
            }
        }
        for (channel, value) in linear.into_iter().enumerate() {
            terms[channel][k] = value;
        }
    }
    RootPolynomial::new(order, terms)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psi_and_its_slope_vanish_on_the_grey_axis() {
        for term in &Order::Four.terms()[3..] {
            assert!(psi(*term, [0.4; 3]).abs() < 1e-15);
            for c in 0..3 {
                let mut moved = [0.4; 3];
                moved[c] += 1e-6;
                assert!(psi(*term, moved).abs() < 1e-11, "{}", term.name());
            }
        }
    }

    #[test]
    fn slopes_of_psi_are_its_differences() {
        let rgb = [0.3, 0.7, 0.2];
        for (term, slopes) in Order::Four.terms()[3..].iter().zip(psi_slopes(Order::Four, rgb)) {
            for c in 0..3 {
                let at = |h: f64| {
                    let mut moved = rgb;
                    moved[c] += h;
                    psi(*term, moved)
                };
                let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((difference - slopes[c]).abs() < 1e-8, "{}", term.name());
            }
        }
    }

    #[test]
    fn there_are_eighteen_saturated_points() {
        assert_eq!(saturated_points().len(), 18);
    }
}
