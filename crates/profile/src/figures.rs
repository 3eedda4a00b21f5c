//! How far colours are off: the figures that stand beside every fit.

use darkroot_colour::Xyz;
use darkroot_colour::difference::{de_uv, de2000};

/// Mean, median, 95th percentile and largest of a set of colour differences.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    /// Arithmetic mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile by Hazen's rule (the value at n p + 1/2).
    pub p95: f64,
    /// Largest.
    pub max: f64,
}

impl Summary {
    /// Figures of a set of differences; all 0 for an empty one.
    pub fn of(differences: &[f64]) -> Self {
        let mut sorted = differences.to_vec();
        sorted.sort_by(f64::total_cmp);
        let Some(max) = sorted.last().copied() else { return Self::default() };
        Self {
            mean: sorted.iter().sum::<f64>() / sorted.len() as f64,
            median: hazen(&sorted, 0.5),
            p95: hazen(&sorted, 0.95),
            max,
        }
    }
}

/// The value below which the share `p` of a sorted set lies (Hazen 1914): linear between the values, of which the
/// i-th of n, counted from 1, stands at (i - 1/2) / n.
fn hazen(sorted: &[f64], p: f64) -> f64 {
    let place = (sorted.len() as f64 * p - 0.5).clamp(0.0, (sorted.len() - 1) as f64);
    let first = place as usize;
    let next = (first + 1).min(sorted.len() - 1);
    sorted[first] + (place - first as f64) * (sorted[next] - sorted[first])
}

/// Errors of a model over a set of colours, in two formulas.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// CIEDE2000.
    pub de2000: Summary,
    /// CIE 1976 L\*u\*v\*, which the root-polynomial papers use.
    pub de_uv: Summary,
}

impl Errors {
    /// The same errors with four decimals.
    #[must_use]
    pub fn rounded(self) -> Self {
        let round = |v: f64| (v * 1e4).round() / 1e4;
        let summary = |s: Summary| Summary {
            mean: round(s.mean),
            median: round(s.median),
            p95: round(s.p95),
            max: round(s.max),
        };
        Self { de2000: summary(self.de2000), de_uv: summary(self.de_uv) }
    }

    /// Errors of `estimates` against `truths`, XYZ relative to `white`.
    pub fn between(estimates: &[Xyz], truths: &[Xyz], white: Xyz) -> Self {
        let pairs = || estimates.iter().zip(truths);
        let lab: Vec<f64> = pairs().map(|(a, b)| de2000(a.lab(white), b.lab(white))).collect();
        let luv: Vec<f64> = pairs().map(|(a, b)| de_uv(a.luv(white), b.luv(white))).collect();
        Self { de2000: Summary::of(&lab), de_uv: Summary::of(&luv) }
    }
}

/// Errors on the colours of the fit, on each of them left out of it, and on colours that it never saw.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Figures {
    /// On the colours that the model was fitted to. It says little: any model fits what it has seen.
    pub training: Option<Errors>,
    /// On each colour by a model that was fitted without it.
    pub leave_one_out: Option<Errors>,
    /// On other colours, where there are some.
    pub held_out: Option<Errors>,
}

impl Figures {
    /// The same figures with four decimals, more than anybody can see.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self {
            training: self.training.map(Errors::rounded),
            leave_one_out: self.leave_one_out.map(Errors::rounded),
            held_out: self.held_out.map(Errors::rounded),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_those_of_hazen() {
        // numpy.percentile([0, 1, 2, 3, 10], [50, 95], method="hazen") is [2, 10].
        let summary = Summary::of(&[3.0, 10.0, 0.0, 2.0, 1.0]);
        assert!((summary.median - 2.0).abs() < 1e-12 && (summary.p95 - 10.0).abs() < 1e-12);
        // numpy.percentile(range(20), 95, method="hazen") is 18.5.
        let many: Vec<f64> = (0..20).map(f64::from).collect();
        let summary = Summary::of(&many);
        assert!((summary.p95 - 18.5).abs() < 1e-12 && (summary.median - 9.5).abs() < 1e-12);
        assert!((summary.mean - 9.5).abs() < 1e-12 && (summary.max - 19.0).abs() < 1e-12);
    }

    #[test]
    fn no_colours_have_no_errors() {
        assert_eq!(Summary::of(&[]), Summary::default());
    }
}
