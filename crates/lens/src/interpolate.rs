//! Between measurements, as lensfun does it: splines over focal lengths, and for vignetting a mean weighted by how near
//! the measurements are (manual of lensfun 0.3, "Lens calibration database", `lfLens::InterpolateDistortion`,
//! `InterpolateTCA`, `InterpolateVignetting`).

/// Coefficients at a focal length in mm from rows of focal length and coefficients, each focal length once. Between the nearest rows on both
/// sides runs a cubic Hermite spline whose slopes are those of Catmull and Rom, one-sided at the ends; beyond the last
/// row its values hold. A coefficient that is `scaled` is interpolated as its product with the focal length: it belongs
/// to a power of the angle rather than of the radius.
///
/// `None` without rows or if the focal length is no number.
pub(crate) fn at_focal<const N: usize>(
    rows: &[[f64; N]],
    focal: f64,
    scaled: impl Fn(usize) -> bool,
) -> Option<[f64; N]> {
    let mut rows: Vec<&[f64; N]> = rows.iter().filter(|row| row[0].is_finite()).collect();
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if focal.is_nan() {
        return None;
    }
    let above = rows.partition_point(|row| row[0] < focal);
    let (Some(left), Some(right)) = (above.checked_sub(1).map(|i| rows[i]), rows.get(above)) else {
        return rows.get(above).or(rows.last()).map(|row| **row);
    };
    let before = above.checked_sub(2).map(|i| rows[i]);
    let after = rows.get(above + 1);
    let t = (focal - left[0]) / (right[0] - left[0]);
    let mut found = [focal; N];
    for i in 1..N {
        let value = |row: &[f64; N]| if scaled(i) { row[i] * row[0] } else { row[i] };
        let (start, end) = (value(left), value(right));
        let slope_there = before.map_or(end - start, |row| (end - value(row)) / 2.0);
        let slope_here = after.map_or(end - start, |row| (value(row) - start) / 2.0);
        let mixed = hermite(start, slope_there, end, slope_here, t);
        found[i] = if scaled(i) { mixed / focal } else { mixed };
    }
    Some(found)
}

/// Cubic polynomial with the given values and slopes at 0 and 1.
fn hermite(start: f64, start_slope: f64, end: f64, end_slope: f64, t: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    start * (2.0 * t3 - 3.0 * t2 + 1.0)
        + start_slope * (t3 - 2.0 * t2 + t)
        + end * (3.0 * t2 - 2.0 * t3)
        + end_slope * (t3 - t2)
}

/// Coefficients of vignetting at a focal length in mm, an f-number and a distance in m, from rows of those three and
/// three coefficients: the mean of all rows, weighted by the power -3.5 of how far they are. `range` is the lens's range
/// of focal lengths. `None` where no row is nearer than 1, or a number is not above 0.
pub(crate) fn vignetting(
    rows: &[[f64; 6]],
    range: (f64, f64),
    focal: f64,
    aperture: f64,
    distance: f64,
) -> Option<[f64; 3]> {
    if ![focal, aperture, distance].iter().all(|n| *n > 0.0) {
        return None;
    }
    let whole = if range.1 > range.0 { range.1 - range.0 } else { 1.0 };
    let mut sum = [0.0; 3];
    let mut weights = 0.0;
    let mut nearest = f64::INFINITY;
    for row in rows {
        let away = (row[0] - focal) / whole;
        let stops = 4.0 / row[1] - 4.0 / aperture;
        let depth = 0.1 / row[2] - 0.1 / distance;
        let far = (away * away + stops * stops + depth * depth).sqrt();
        if far < 1e-4 {
            return Some([row[3], row[4], row[5]]);
        }
        let weight = far.powf(-3.5);
        nearest = nearest.min(far);
        weights += weight;
        for (sum, value) in sum.iter_mut().zip(&row[3..]) {
            *sum += weight * value;
        }
    }
    (nearest <= 1.0 && weights.is_finite() && weights > 0.0).then(|| sum.map(|s| s / weights))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [[f64; 2]; 4] = [[10.0, 1.0], [20.0, 2.0], [40.0, 4.0], [80.0, 8.0]];

    #[test]
    fn measurements_are_kept_and_the_last_ones_hold_beyond() {
        for row in ROWS {
            let found = at_focal(&ROWS, row[0], |_| false).unwrap();
            assert!((found[1] - row[1]).abs() < 1e-12, "{row:?}");
        }
        assert_eq!(at_focal(&ROWS, 5.0, |_| false), Some(ROWS[0]));
        assert_eq!(at_focal(&ROWS, 500.0, |_| true), Some(ROWS[3]));
    }

    #[test]
    fn two_measurements_are_joined_by_a_line() {
        let found = at_focal(&ROWS[..2], 15.0, |_| false).unwrap();
        assert!((found[1] - 1.5).abs() < 1e-12);
        // As a product with the focal length: 10 and 40, 25 in the middle.
        let found = at_focal(&ROWS[..2], 15.0, |_| true).unwrap();
        assert!((found[1] - 25.0 / 15.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_number_gives_nothing() {
        assert_eq!(at_focal(&ROWS, f64::NAN, |_| false), None);
        assert_eq!(at_focal::<2>(&[], 20.0, |_| false), None);
        let rows = [[50.0, 4.0, 10.0, -0.5, 0.1, 0.0]];
        for bad in [f64::NAN, 0.0, -1.0] {
            assert_eq!(vignetting(&rows, (50.0, 50.0), bad, 4.0, 10.0), None);
            assert_eq!(vignetting(&rows, (50.0, 50.0), 50.0, bad, 10.0), None);
            assert_eq!(vignetting(&rows, (50.0, 50.0), 50.0, 4.0, bad), None);
        }
    }

    #[test]
    fn vignetting_is_a_mean_of_what_is_near_and_none_where_all_is_far() {
        let rows = [[50.0, 4.0, 10.0, -0.5, 0.1, 0.0], [50.0, 8.0, 10.0, -0.1, 0.0, 0.0]];
        let found = vignetting(&rows, (50.0, 50.0), 50.0, 5.6, 10.0).unwrap();
        assert!(found[0] > -0.5 && found[0] < -0.1);
        assert_eq!(vignetting(&rows, (50.0, 50.0), 50.0, 4.0, 10.0), Some([-0.5, 0.1, 0.0]));
        assert_eq!(vignetting(&rows, (50.0, 50.0), 50.0, 1.4, 10.0), None);
    }
}
