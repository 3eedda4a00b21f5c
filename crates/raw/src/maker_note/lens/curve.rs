//! A smooth curve through points.

/// Through points in order of `x`, without corners; beyond the first and the last it stays as it is there.
#[derive(Debug)]
pub(super) struct Curve {
    points: Vec<[f64; 2]>,
    slopes: Vec<f64>,
}

impl Curve {
    /// `None` unless there are two points at least, numbers all, each to the right of the one before.
    pub(super) fn through(points: Vec<[f64; 2]>) -> Option<Self> {
        let sound = points.len() >= 2
            && points.iter().flatten().all(|v| v.is_finite())
            && points.is_sorted_by(|a, b| a[0] < b[0]);
        let slopes = sound.then(|| slopes(&points))?;
        Some(Self { points, slopes })
    }

    pub(super) fn at(&self, x: f64) -> f64 {
        let (points, slopes) = (&self.points, &self.slopes);
        let next = points.partition_point(|point| point[0] <= x);
        let Some(i) = next.checked_sub(1) else { return points[0][1] };
        let ([x0, y0], Some(&[x1, y1])) = (points[i], points.get(next)) else { return points[i][1] };
        // Hermite's cubic over one interval.
        let width = x1 - x0;
        let t = (x - x0) / width;
        let (a, b) = (1.0 - t, t * t * (3.0 - 2.0 * t));
        y0 + (y1 - y0) * b + width * t * a * (slopes[i] * a - slopes[next] * t)
    }
}

/// At each point the slope of the parabola through it and its neighbours; at the ends that of the line.
fn slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let line = |i: usize| (points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]);
    let last = points.len() - 1;
    let of_parabola = |i: usize| {
        let (before, after) = (points[i][0] - points[i - 1][0], points[i + 1][0] - points[i][0]);
        (line(i - 1) * after + line(i) * before) / (before + after)
    };
    let slope = |i: usize| match i {
        0 => line(0),
        i if i == last => line(last - 1),
        i => of_parabola(i),
    };
    (0..=last).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_met_between_uneven_points_and_ends_stay() {
        let f = |x: f64| 1.0 + 0.3 * x * x;
        let points = [0.0, 0.1, 0.35, 0.5, 0.7, 1.0].map(|x| [x, f(x)]).to_vec();
        let curve = Curve::through(points).unwrap();
        for x in [0.12, 0.3, 0.4, 0.6] {
            assert!((curve.at(x) - f(x)).abs() < 1e-12, "{x}");
        }
        assert!((curve.at(2.0) - f(1.0)).abs() < 1e-12 && (curve.at(-1.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn points_that_make_no_curve_are_none() {
        for points in [
            vec![],
            vec![[0.0, 1.0]],
            vec![[0.0, 1.0], [0.0, 2.0]],
            vec![[1.0, 1.0], [0.0, 2.0]],
            vec![[0.0, f64::NAN], [1.0, 2.0]],
            vec![[0.0, 1.0], [f64::INFINITY, 2.0]],
        ] {
            assert!(Curve::through(points.clone()).is_none(), "{points:?}");
        }
    }
}
