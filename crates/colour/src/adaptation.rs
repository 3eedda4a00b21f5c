//! Chromatic adaptation: what a colour seen under one white looks like under another.

use crate::{Matrix3, Vector3, Xyz};

/// A chromatic adaptation transform of von Kries' kind: the cone responses in which whites are scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cat {
    /// Linear Bradford (Lam 1985; ICC.1:2022, annex E), what profiles of the ICC and of DNG use.
    #[default]
    Bradford,
    /// CAT02 of CIECAM02 (CIE 159:2004), with full adaptation.
    Cat02,
    /// CAT16 of CIECAM16 (Li et al., Color Research and Application 42(6), 2017; CIE 248:2022), with full adaptation.
    Cat16,
}

impl Cat {
    /// XYZ to the sharpened cone responses of this transform.
    #[rustfmt::skip]
    pub const fn cones(self) -> Matrix3 {
        match self {
            Self::Bradford => Matrix3::new(
                0.8951, 0.2664, -0.1614,
                -0.7502, 1.7135, 0.0367,
                0.0389, -0.0685, 1.0296,
            ),
            Self::Cat02 => Matrix3::new(
                0.7328, 0.4296, -0.1624,
                -0.7036, 1.6975, 0.0061,
                0.0030, 0.0136, 0.9834,
            ),
            Self::Cat16 => Matrix3::new(
                0.401_288, 0.650_173, -0.051_461,
                -0.250_268, 1.204_414, 0.045_854,
                -0.002_079, 0.048_952, 0.953_127,
            ),
        }
    }

    /// Full adaptation as a matrix on XYZ: takes `from` to `to` exactly.
    ///
    /// Both whites need positive cone responses; real lights have them.
    pub fn matrix(self, from: Xyz, to: Xyz) -> Matrix3 {
        let cones = self.cones();
        let source = cones * Vector3::from(from);
        let target = cones * Vector3::from(to);
        let gains = Matrix3::from_diagonal(&target.component_div(&source));
        match cones.try_inverse() {
            Some(inverse) => inverse * gains * cones,
            None => Matrix3::identity(), // The constant matrices above are regular.
        }
    }

    /// The colour that looks under the white `to` as `colour` does under `from`.
    pub fn adapt(self, colour: Xyz, from: Xyz, to: Xyz) -> Xyz {
        (self.matrix(from, to) * Vector3::from(colour)).into()
    }
}

/// Linear Bradford adaptation as a matrix on XYZ: [`Cat::Bradford`]'s [`Cat::matrix`].
pub fn bradford(from: Xyz, to: Xyz) -> Matrix3 {
    Cat::Bradford.matrix(from, to)
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

    #[test]
    fn a_to_d65_is_the_matrix_of_colour_science() {
        // colour.adaptation.matrix_chromatic_adaptation_VonKries(A, D65, transform="Bradford" | "CAT02" | "CAT16") with
        // A = xy_to_XYZ([0.44758, 0.40745]), D65 = xy_to_XYZ([0.3127, 0.3290]), colour-science 0.4.7.
        #[rustfmt::skip]
        let published = [
            (Cat::Bradford, Matrix3::new(
                0.844668978036, -0.117950090108, 0.395013385542,
                -0.136649657868, 1.104126625275, 0.129235430781,
                0.079893692238, -0.134977859728, 3.193588264617,
            )),
            (Cat::Cat02, Matrix3::new(
                0.86875010385, -0.141662283467, 0.387310432465,
                -0.10301409659, 1.058399180935, 0.15390979568,
                0.007818763108, 0.026796083385, 2.961433361247,
            )),
            (Cat::Cat16, Matrix3::new(
                0.950681464212, -0.187406099716, 0.262922487785,
                -0.025669886638, 1.032313565915, -0.011566769476,
                -0.002742428144, 0.091014391099, 2.813549167982,
            )),
        ];
        for (cat, expected) in published {
            let found = cat.matrix(white::A_XY.xyz(), white::D65);
            assert!((found - expected).amax() < 1e-11, "{cat:?}: {found}");
        }
    }
}
