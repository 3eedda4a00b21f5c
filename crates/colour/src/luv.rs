//! CIELUV and its uniform chromaticity.

use crate::{Xy, Xyz};

/// CIE 1976 uniform chromaticity coordinates (CIE 015:2018, 8.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvPrime {
    /// u' = 4X / (X + 15Y + 3Z), 0 to 0.63 for real lights.
    pub u: f64,
    /// v' = 9Y / (X + 15Y + 3Z), 0 to 0.6 for real lights.
    pub v: f64,
}

/// CIE 1976 L\*u\*v\* (CIE 015:2018, 8.2.2).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Luv {
    /// Lightness, 0 (black) to 100 (the white); the same as that of CIELAB.
    pub l: f64,
    /// Green (negative) to red (positive).
    pub u: f64,
    /// Blue (negative) to yellow (positive).
    pub v: f64,
}

impl Xyz {
    /// CIE 1976 u', v'; `None` when X + 15Y + 3Z is not positive.
    pub fn uv_prime(self) -> Option<UvPrime> {
        let sum = self.x + 15.0 * self.y + 3.0 * self.z;
        (sum > 0.0).then(|| UvPrime { u: 4.0 * self.x / sum, v: 9.0 * self.y / sum })
    }

    /// CIELUV relative to `white` (CIE 015:2018, 8.2.2). What has no chromaticity is given that of the white.
    pub fn luv(self, white: Self) -> Luv {
        let l = self.lab(white).l;
        match (self.uv_prime(), white.uv_prime()) {
            (Some(c), Some(n)) => Luv { l, u: 13.0 * l * (c.u - n.u), v: 13.0 * l * (c.v - n.v) },
            _ => Luv { l, u: 0.0, v: 0.0 },
        }
    }
}

impl Luv {
    /// Tristimulus values relative to `white`: the inverse of [`Xyz::luv`]; black for L\* = 0, where the
    /// chromaticity is lost.
    pub fn xyz(self, white: Xyz) -> Xyz {
        let y = crate::Lab { l: self.l, a: 0.0, b: 0.0 }.xyz(white).y;
        match white.uv_prime() {
            Some(n) if self.l != 0.0 => {
                let (u, v) = (self.u / (13.0 * self.l) + n.u, self.v / (13.0 * self.l) + n.v);
                Xyz::new(y * 9.0 * u / (4.0 * v), y, y * (12.0 - 3.0 * u - 20.0 * v) / (4.0 * v))
            }
            _ => Xyz::default(),
        }
    }

    /// Chroma C\*uv = sqrt(u\*^2 + v\*^2).
    pub fn chroma(self) -> f64 {
        self.u.hypot(self.v)
    }
}

impl UvPrime {
    /// The same chromaticity as CIE 1931 x, y.
    pub fn xy(self) -> Xy {
        let sum = 6.0 * self.u - 16.0 * self.v + 12.0;
        Xy::new(9.0 * self.u / sum, 4.0 * self.v / sum)
    }
}

impl Xy {
    /// The same chromaticity as CIE 1976 u', v'.
    pub fn uv_prime(self) -> UvPrime {
        let sum = -2.0 * self.x + 12.0 * self.y + 3.0;
        UvPrime { u: 4.0 * self.x / sum, v: 9.0 * self.y / sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::white;

    #[test]
    fn values_are_those_of_colour_science() {
        // colour.XYZ_to_Luv(XYZ, [0.3127, 0.3290]) and colour.Luv_to_uv, colour-science 0.4.7.
        for (xyz, luv, uv) in [
            (
                [0.20654008, 0.12197225, 0.05136952],
                [41.527875294398, 96.83626054463, 17.752101485865],
                [0.377202128766, 0.501202637223],
            ),
            (
                [0.14222010, 0.23042768, 0.10495772],
                [55.11636304499, -37.593081764605, 44.137684577807],
                [0.145363273343, 0.52992069423],
            ),
            (
                [0.001, 0.002, 0.0005],
                [1.806592592593, -1.755628771567, 2.008642027014],
                [0.123076923077, 0.553846153846],
            ),
        ] {
            let c = Xyz::from(xyz);
            let found = c.luv(white::D65);
            let difference = crate::difference::de_uv(found, Luv { l: luv[0], u: luv[1], v: luv[2] });
            assert!(difference < 1e-9, "{found:?}");
            let UvPrime { u, v } = c.uv_prime().unwrap();
            assert!((u - uv[0]).abs() < 1e-11 && (v - uv[1]).abs() < 1e-11, "{u} {v}");
        }
    }

    #[test]
    fn chromaticities_of_illuminant_a_agree() {
        // colour.xy_to_Luv_uv([0.44758, 0.40745]), colour-science 0.4.7.
        let UvPrime { u, v } = white::A_XY.uv_prime();
        assert!((u - 0.255970627259).abs() < 1e-11 && (v - 0.524295706181).abs() < 1e-11);
        let back = UvPrime { u, v }.xy();
        assert!((back.x - 0.44758).abs() < 1e-12 && (back.y - 0.40745).abs() < 1e-12);
    }

    #[test]
    fn black_has_no_chroma_and_stays_black() {
        let black = Xyz::default().luv(white::D65);
        assert_eq!(black, Luv::default());
        assert_eq!(black.xyz(white::D65), Xyz::default());
    }
}
