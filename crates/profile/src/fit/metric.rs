//! What a small error in XYZ means in CIEDE2000.

use darkroot_colour::difference::de2000;
use darkroot_colour::{Lab, Matrix3, Xyz};

/// (6/29)^3 and (29/3)^3, where CIELAB turns linear (CIE 015:2018, 8.2.1).
const EPSILON: f64 = 216.0 / 24389.0;
const KAPPA: f64 = 24389.0 / 27.0;

/// A matrix W for each colour with |W d| = CIEDE2000 between the colour and the colour + d, for small d in XYZ.
///
/// The metric of CIEDE2000 in CIELAB comes from second differences over 0.02 units, its Cholesky factor times the
/// derivatives of CIELAB is W.
pub fn de2000_weights(xyz: &[Xyz], white: Xyz) -> Vec<Matrix3> {
    xyz.iter().map(|c| metric_root(c.lab(white)) * lab_derivatives(*c, white)).collect()
}

/// Derivatives of L\*, a\*, b\* (rows) by X, Y, Z (columns).
pub fn lab_derivatives(xyz: Xyz, white: Xyz) -> Matrix3 {
    let slope = |value: f64, white: f64| {
        let t = value / white;
        let slope = if t > EPSILON { 1.0 / (3.0 * t.cbrt().powi(2)) } else { KAPPA / 116.0 };
        slope / white
    };
    let (x, y, z) = (slope(xyz.x, white.x), slope(xyz.y, white.y), slope(xyz.z, white.z));
    Matrix3::new(0.0, 116.0 * y, 0.0, 500.0 * x, -500.0 * y, 0.0, 0.0, 200.0 * y, -200.0 * z)
}

/// The upper Cholesky factor U of the metric: CIEDE2000 is about |U d| for a small d in CIELAB.
fn metric_root(lab: Lab) -> Matrix3 {
    const STEP: f64 = 0.02;
    let squared = |d: [f64; 3]| {
        let moved = |k: f64| Lab { l: lab.l + k * d[0], a: lab.a + k * d[1], b: lab.b + k * d[2] };
        de2000(moved(-0.5), moved(0.5)).powi(2)
    };
    let unit = |i: usize| {
        let mut d = [0.0; 3];
        d[i] = STEP;
        d
    };
    let own = [0, 1, 2].map(|i| squared(unit(i)));
    let metric = Matrix3::from_fn(|i, j| {
        if i == j {
            return own[i] / (STEP * STEP) + 1e-6;
        }
        let (one, other) = (unit(i), unit(j));
        let both = squared([0, 1, 2].map(|k| one[k] + other[k]));
        (both - own[i] - own[j]) / (2.0 * STEP * STEP)
    });
    // The metric of a difference is positive definite; rounding cannot take that from it, 1e-6 sees to it.
    metric.cholesky().map_or_else(Matrix3::identity, |c| c.l().transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::{Vector3, white};

    #[test]
    fn a_small_step_is_as_long_as_its_colour_difference() {
        for c in [Xyz::new(0.3, 0.2, 0.05), Xyz::new(0.02, 0.03, 0.1), Xyz::new(0.003, 0.004, 0.002)] {
            let w = de2000_weights(&[c], white::D50)[0];
            for d in [[1.0, 0.0, 0.0], [0.0, 1.0, -0.4], [-0.3, 0.2, 1.0]] {
                let d = Vector3::from(d) * 1e-4 * c.y;
                let moved = Xyz::from(Vector3::from(c) + d);
                let real = de2000(c.lab(white::D50), moved.lab(white::D50));
                assert!(((w * d).norm() / real - 1.0).abs() < 0.02, "{c:?} {d:?}");
            }
        }
    }
}
