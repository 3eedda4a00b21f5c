//! Chromatic adaptation: what a colour seen under one white looks like under another.

use crate::{Matrix3, Vector3, Xyz};

/// XYZ to the sharpened cone responses of the Bradford transform (Lam 1985; ICC.1:2022, annex E).
#[rustfmt::skip]
const BRADFORD: Matrix3 = Matrix3::new(
    0.8951, 0.2664, -0.1614,
    -0.7502, 1.7135, 0.0367,
    0.0389, -0.0685, 1.0296,
);

/// Linear Bradford adaptation as a matrix on XYZ: takes `from` to `to` exactly.
///
/// Both whites need positive tristimulus values; real lights have them.
pub fn bradford(from: Xyz, to: Xyz) -> Matrix3 {
    von_kries(&BRADFORD, from, to)
}

/// Scales the responses that `cones` gives so that `from` becomes `to`.
fn von_kries(cones: &Matrix3, from: Xyz, to: Xyz) -> Matrix3 {
    let source = cones * Vector3::from(from);
    let target = cones * Vector3::from(to);
    let gains = Matrix3::from_diagonal(&target.component_div(&source));
    match cones.try_inverse() {
        Some(inverse) => inverse * gains * cones,
        None => Matrix3::identity(), // The constant matrices of this file are regular.
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::white;

    #[test]
    fn the_source_white_becomes_the_target_white() {
        let adapted = bradford(white::D65, white::D50) * Vector3::from(white::D65);
        assert!((adapted - Vector3::from(white::D50)).norm() < 1e-12);
    }

    #[test]
    fn d65_to_d50_is_the_matrix_that_the_icc_publishes() {
        // The `chad` tag of sRGB v4 profiles (ICC.1:2022, annex E).
        #[rustfmt::skip]
        let published = Matrix3::new(
            1.047886, 0.022919, -0.050216,
            0.029582, 0.990484, -0.017079,
            -0.009252, 0.015073, 0.751678,
        );
        let difference = bradford(white::D65, white::D50) - published;
        assert!(difference.amax() < 2e-4, "{difference}");
    }
}
