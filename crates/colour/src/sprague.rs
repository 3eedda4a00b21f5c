//! Sprague's interpolation of evenly spaced samples by polynomials of the fifth degree (Sprague 1880; CIE 167:2005,
//! "Recommended practice for tabulating spectral data for use in colour computations").

/// What two samples before the first would be, from the first six; mirrored for the end. In 1/209 (CIE 167:2005).
const BEFORE: [[f64; 6]; 2] =
    [[884.0, -1960.0, 3033.0, -2648.0, 1080.0, -180.0], [508.0, -540.0, 488.0, -367.0, 144.0, -24.0]];
const BEFORE_DIVISOR: f64 = 209.0;

/// Coefficients of the powers 1 to 5 from the six samples around an interval, in 1/24 (CIE 167:2005).
const POWERS: [[f64; 6]; 5] = [
    [2.0, -16.0, 0.0, 16.0, -2.0, 0.0],
    [-1.0, 16.0, -30.0, 16.0, -1.0, 0.0],
    [-9.0, 39.0, -70.0, 66.0, -33.0, 7.0],
    [13.0, -64.0, 126.0, -124.0, 61.0, -12.0],
    [-5.0, 25.0, -50.0, 50.0, -25.0, 5.0],
];
const POWERS_DIVISOR: f64 = 24.0;

/// Evenly spaced samples with two more at each end.
pub(crate) struct Sprague {
    first: f64,
    step: f64,
    padded: Vec<f64>,
}

impl Sprague {
    /// `None` unless there are at least six samples at equal distances.
    pub(crate) fn new(positions: &[f64], values: &[f64]) -> Option<Self> {
        let (&first, &second) = (positions.first()?, positions.get(1)?);
        let step = second - first;
        let even =
            |(i, x): (usize, &f64)| (x - (first + step * i as f64)).abs() <= 1e-6 * step * (i + 1) as f64;
        if values.len() != positions.len() || !positions.iter().enumerate().all(even) {
            return None;
        }
        let front = values.first_chunk::<6>()?;
        let mut back = *values.last_chunk::<6>()?;
        back.reverse();
        let outside = |row: usize, six: &[f64; 6]| dot(&BEFORE[row], six) / BEFORE_DIVISOR;
        let mut padded = vec![outside(0, front), outside(1, front)];
        padded.extend_from_slice(values);
        padded.extend([outside(1, &back), outside(0, &back)]);
        Some(Self { first, step, padded })
    }

    /// Value at `x`; the nearest sample outside of the range.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let intervals = self.padded.len() - 5;
        let position = ((x - self.first) / self.step).clamp(0.0, intervals as f64);
        let interval = (position as usize).min(intervals - 1);
        let t = position - interval as f64;
        let around = &self.padded[interval..interval + 6];
        let higher = POWERS.iter().rev().fold(0.0, |sum, row| (sum + dot(row, around) / POWERS_DIVISOR) * t);
        around[2] + higher
    }
}

fn dot(coefficients: &[f64; 6], samples: &[f64]) -> f64 {
    coefficients.iter().zip(samples).map(|(c, s)| c * s).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst_error(f: impl Fn(f64) -> f64, quarters: std::ops::RangeInclusive<i32>) -> f64 {
        let positions: Vec<f64> = (0..12).map(|i| 2.0 * f64::from(i)).collect();
        let values: Vec<f64> = positions.iter().map(|&x| f(x)).collect();
        let curve = Sprague::new(&positions, &values).unwrap();
        quarters.map(|i| f64::from(i) / 4.0).map(|x| (curve.at(x) - f(x)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn straight_lines_stay_straight_to_the_ends() {
        assert!(worst_error(|x| 0.3 - 0.01 * x, 0..=88) < 1e-13);
    }

    #[test]
    fn polynomials_of_the_fourth_degree_are_exact_away_from_the_ends() {
        // The samples that CIE 167:2005 adds at the ends are exact for straight lines only.
        let f = |x: f64| 0.3 + 0.01 * x - 2e-3 * x * x + 1e-4 * x.powi(3) - 3e-6 * x.powi(4);
        assert!(worst_error(f, 16..=72) < 1e-12);
    }

    #[test]
    fn values_between_are_those_of_colour_science() {
        // colour.SpragueInterpolator(range(400, 480, 10), y)([405, 415, 438, 468]), colour-science 0.4.7.
        let positions: Vec<f64> = (40..48).map(|i| f64::from(i) * 10.0).collect();
        let curve = Sprague::new(&positions, &[0.05, 0.08, 0.22, 0.31, 0.30, 0.42, 0.55, 0.57]).unwrap();
        for (nm, expected) in SPRAGUE_EXPECTED {
            assert!((curve.at(nm) - expected).abs() < 1e-11, "{} at {nm}", curve.at(nm));
        }
    }

    const SPRAGUE_EXPECTED: [(f64, f64); 4] =
        [(405.0, 0.053157894737), (415.0, 0.144640213816), (438.0, 0.294928000000), (468.0, 0.571333435407)];

    #[test]
    fn uneven_or_few_samples_are_refused() {
        assert!(Sprague::new(&[0.0, 1.0, 2.0, 3.0, 4.0, 6.0], &[0.0; 6]).is_none());
        assert!(Sprague::new(&[0.0, 1.0, 2.0, 3.0, 4.0], &[0.0; 5]).is_none());
    }
}
