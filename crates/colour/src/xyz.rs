//! Tristimulus values, chromaticities and CIELAB.

use serde::{Deserialize, Serialize};

use crate::Vector3;

/// CIE 1931 tristimulus values, relative: Y = 1 is the white.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Xyz {
    /// X, roughly red plus some blue.
    pub x: f64,
    /// Y, luminance factor.
    pub y: f64,
    /// Z, roughly blue.
    pub z: f64,
}

/// CIE 1931 chromaticity coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Xy {
    /// x = X / (X + Y + Z).
    pub x: f64,
    /// y = Y / (X + Y + Z); more than 0 for any real light.
    pub y: f64,
}

/// CIE 1976 L\*a\*b\*.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lab {
    /// Lightness, 0 (black) to 100 (the white).
    pub l: f64,
    /// Green (negative) to red (positive).
    pub a: f64,
    /// Blue (negative) to yellow (positive).
    pub b: f64,
}

/// (6/29)^3: below this ratio to the white CIELAB is linear (CIE 015:2018, 8.2.1).
const LAB_EPSILON: f64 = 216.0 / 24389.0;
/// (29/3)^3: slope of the linear part, in L\* per unit of Y.
const LAB_KAPPA: f64 = 24389.0 / 27.0;

impl Xyz {
    /// Tristimulus values from their three coordinates.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    /// The same light, `k` times as strong.
    #[must_use]
    pub fn scaled(self, k: f64) -> Self {
        Self::new(self.x * k, self.y * k, self.z * k)
    }

    /// Chromaticity; `None` when X + Y + Z is not positive.
    pub fn xy(self) -> Option<Xy> {
        let sum = self.x + self.y + self.z;
        (sum > 0.0).then(|| Xy { x: self.x / sum, y: self.y / sum })
    }

    /// CIELAB relative to `white` (CIE 015:2018, 8.2.1).
    pub fn lab(self, white: Self) -> Lab {
        let f = |t: f64| if t > LAB_EPSILON { t.cbrt() } else { (LAB_KAPPA * t + 16.0) / 116.0 };
        let (fx, fy, fz) = (f(self.x / white.x), f(self.y / white.y), f(self.z / white.z));
        Lab { l: 116.0 * fy - 16.0, a: 500.0 * (fx - fy), b: 200.0 * (fy - fz) }
    }
}

impl From<Vector3> for Xyz {
    fn from(v: Vector3) -> Self {
        Self::new(v[0], v[1], v[2])
    }
}

impl From<Xyz> for Vector3 {
    fn from(c: Xyz) -> Self {
        Self::new(c.x, c.y, c.z)
    }
}

impl From<[f64; 3]> for Xyz {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self::new(x, y, z)
    }
}

impl From<Xyz> for [f64; 3] {
    fn from(c: Xyz) -> Self {
        [c.x, c.y, c.z]
    }
}

impl From<[f64; 3]> for Lab {
    fn from([l, a, b]: [f64; 3]) -> Self {
        Self { l, a, b }
    }
}

impl From<Lab> for [f64; 3] {
    fn from(c: Lab) -> Self {
        [c.l, c.a, c.b]
    }
}

impl Xy {
    /// Chromaticity from its two coordinates.
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Tristimulus values of this chromaticity with Y = 1.
    pub fn xyz(self) -> Xyz {
        Xyz::new(self.x / self.y, 1.0, (1.0 - self.x - self.y) / self.y)
    }
}

impl Lab {
    /// Tristimulus values relative to `white`: the inverse of [`Xyz::lab`].
    pub fn xyz(self, white: Xyz) -> Xyz {
        let fy = (self.l + 16.0) / 116.0;
        let inverse = |f: f64| {
            let cube = f * f * f;
            if cube > LAB_EPSILON { cube } else { (116.0 * f - 16.0) / LAB_KAPPA }
        };
        Xyz::new(
            white.x * inverse(fy + self.a / 500.0),
            white.y * inverse(fy),
            white.z * inverse(fy - self.b / 200.0),
        )
    }

    /// Chroma C\*ab = sqrt(a\*^2 + b\*^2).
    pub fn chroma(self) -> f64 {
        self.a.hypot(self.b)
    }

    /// Hue angle h_ab in degrees, 0 (red) up to 360, 90 is yellow; 0 for greys.
    pub fn hue(self) -> f64 {
        self.b.atan2(self.a).to_degrees().rem_euclid(360.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::white;

    #[test]
    fn the_white_has_lightness_100_and_no_chroma() {
        let lab = white::D50.lab(white::D50);
        assert!((lab.l - 100.0).abs() < 1e-12 && lab.chroma() < 1e-12);
    }

    #[test]
    fn lab_and_back_is_the_same_colour() {
        for c in [Xyz::new(0.2, 0.1, 0.7), Xyz::new(0.001, 0.002, 0.0005), Xyz::new(0.9, 1.0, 0.8)] {
            let back = c.lab(white::D65).xyz(white::D65);
            assert!((back.x - c.x).abs() + (back.y - c.y).abs() + (back.z - c.z).abs() < 1e-12);
        }
    }

    #[test]
    fn black_has_no_chromaticity() {
        assert_eq!(Xyz::default().xy(), None);
    }
}
