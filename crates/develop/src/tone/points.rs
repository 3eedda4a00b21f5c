//! A tone curve by points: lightness as a look shows it, and lightness as it shall be.
//!
//! Between the points runs the cubic of Fritsch and Carlson (SIAM Journal on Numerical Analysis 17, 1980), which rises
//! wherever they do and never overshoots.

use darkroot_colour::TransferCurve;

/// A curve over lightness L\* (CIE 15), 0 to 100. It does not depend on the space of the picture, and middle grey is 50.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Points {
    count: usize,
    /// Before, after, and the slope there; `count` of them hold.
    points: [[f64; 3]; MOST],
}

/// Points that make no curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PointsError {
    /// More than fit.
    #[error("a curve has at most {most} points besides black and white", most = MOST - 2)]
    TooMany,
    /// A number outside of lightness.
    #[error("lightness runs from 0 to 100")]
    Range,
    /// Points in disorder, or a curve that falls: light would be shown darker than less light.
    #[error("a curve goes from left to right and does not fall")]
    Falls,
}

/// Points with those of black and white.
const MOST: usize = 18;

impl Points {
    /// A curve through points of lightness before and after, from left to right. Black (0, 0) and white (100, 100) belong to
    /// it where nothing else is said of 0 and 100.
    ///
    /// # Errors
    /// Too many points, numbers outside of 0..=100, or a curve that falls.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, PointsError> {
        if !points.iter().flatten().all(|v| (0.0..=100.0).contains(v)) {
            return Err(PointsError::Range);
        }
        let mut all = points.to_vec();
        if all.first().is_none_or(|[before, _]| *before > 0.0) {
            all.insert(0, [0.0, 0.0]);
        }
        if all.last().is_none_or(|[before, _]| *before < 100.0) {
            all.push([100.0, 100.0]);
        }
        if all.len() > MOST {
            return Err(PointsError::TooMany);
        }
        if !all.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1]) {
            return Err(PointsError::Falls);
        }
        let slopes = slopes(&all);
        let mut kept = [[0.0; 3]; MOST];
        for ((place, [before, after]), slope) in kept.iter_mut().zip(&all).zip(slopes) {
            *place = [*before, *after, slope];
        }
        Ok(Self { count: all.len(), points: kept })
    }

    /// Lightness after the curve of lightness before it.
    pub fn lightness(&self, before: f64) -> f64 {
        let points = &self.points[..self.count];
        let right = points.partition_point(|[x, ..]| *x <= before).clamp(1, self.count - 1);
        let ([x0, y0, m0], [x1, y1, m1]) = (points[right - 1], points[right]);
        let width = x1 - x0;
        let t = ((before - x0) / width).clamp(0.0, 1.0);
        // Hermite's cubic.
        let (square, cube) = (t * t, t * t * t);
        let ends = y0 * (1.0 - 3.0 * square + 2.0 * cube) + y1 * (3.0 * square - 2.0 * cube);
        ends + width * (m0 * (t - 2.0 * square + cube) + m1 * (cube - square))
    }

    /// Display light after the curve of display light before it, 0 to 1.
    pub(super) fn light(&self, before: f32) -> f32 {
        let before = TransferCurve::LStar.encode(f64::from(before));
        TransferCurve::LStar.decode(0.01 * self.lightness(100.0 * before).clamp(0.0, 100.0)) as f32
    }
}

/// Slopes at the points with which the cubics between them rise (Fritsch and Carlson, 1980, section 4).
fn slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let secants: Vec<f64> =
        points.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).collect();
    let (first, last) = (secants[0], secants[secants.len() - 1]);
    let inner = secants.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let mut slopes: Vec<f64> = std::iter::once(first).chain(inner).chain([last]).collect();
    for (i, secant) in secants.iter().enumerate() {
        if *secant <= 0.0 {
            (slopes[i], slopes[i + 1]) = (0.0, 0.0);
            continue;
        }
        let (a, b) = (slopes[i] / secant, slopes[i + 1] / secant);
        let length = a.hypot(b);
        if length > 3.0 {
            (slopes[i], slopes[i + 1]) = (3.0 * slopes[i] / length, 3.0 * slopes[i + 1] / length);
        }
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_its_points_and_never_falls() {
        for given in [
            vec![],
            vec![[25.0, 15.0], [75.0, 85.0]],
            vec![[0.0, 10.0], [50.0, 50.0], [51.0, 90.0], [100.0, 90.0]],
            (1..17).map(|i| [f64::from(i) * 5.0, f64::from(i * i) / 3.0]).collect(),
        ] {
            let curve = Points::new(&given).unwrap();
            for [before, after] in &given {
                assert!((curve.lightness(*before) - after).abs() < 1e-9, "{given:?} at {before}");
            }
            let all: Vec<f64> = (0..=2000).map(|i| curve.lightness(f64::from(i) * 0.05)).collect();
            assert!(all.is_sorted_by(|a, b| *a <= b + 1e-12), "{given:?}");
            assert!(all.iter().all(|v| (-1e-9..=100.0 + 1e-9).contains(v)), "{given:?}");
        }
        let nothing = Points::new(&[]).unwrap();
        assert!((0..=100).all(|i| (nothing.lightness(f64::from(i)) - f64::from(i)).abs() < 1e-9));
    }

    #[test]
    fn what_makes_no_curve_is_refused() {
        for (points, error) in [
            (vec![[50.0, 101.0]], PointsError::Range),
            (vec![[f64::NAN, 1.0]], PointsError::Range),
            (vec![[50.0, 60.0], [60.0, 50.0]], PointsError::Falls),
            (vec![[50.0, 50.0], [50.0, 60.0]], PointsError::Falls),
            ((1..18).map(|i| [f64::from(i), f64::from(i)]).collect(), PointsError::TooMany),
        ] {
            assert_eq!(Points::new(&points), Err(error), "{points:?}");
        }
    }
}
