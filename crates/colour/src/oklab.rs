//! Oklab, an opponent space in which lines of one hue are straight (B. Ottosson, "A perceptual color space for image
//! processing", 2020): cone-like responses, their cube roots, and lightness and two opponents of these.

use crate::{Matrix3, Vector3, Xyz};

/// XYZ under D65 to the responses; those of the white are 1.
pub const CONES: Matrix3 = Matrix3::new(
    0.818_933_010_1,
    0.361_866_742_4,
    -0.128_859_713_7, //
    0.032_984_543_6,
    0.929_311_871_5,
    0.036_145_638_7, //
    0.048_200_301_8,
    0.264_366_269_1,
    0.633_851_707_0,
);

/// Cube roots of the responses to lightness, green-red and blue-yellow.
pub const OPPONENTS: Matrix3 = Matrix3::new(
    0.210_454_255_3,
    0.793_617_785_0,
    -0.004_072_046_8, //
    1.977_998_495_1,
    -2.428_592_205_0,
    0.450_593_709_9, //
    0.025_904_037_1,
    0.782_771_766_2,
    -0.808_675_766_0,
);

/// What each response has in the lightness of greys, which is all of it together.
pub const LIGHTNESS: [f64; 3] = [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8];

/// A colour in Oklab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oklab {
    /// Lightness: 0 black, 1 white.
    pub l: f64,
    /// Green (negative) to red.
    pub a: f64,
    /// Blue (negative) to yellow.
    pub b: f64,
}

impl Oklab {
    /// Of XYZ under D65.
    pub fn of(xyz: Xyz) -> Self {
        let cones = CONES * Vector3::from(xyz);
        let lab = OPPONENTS * cones.map(f64::cbrt);
        Self { l: lab[0], a: lab[1], b: lab[2] }
    }

    /// Distance from grey.
    pub fn chroma(self) -> f64 {
        self.a.hypot(self.b)
    }

    /// Hue, -180..=180 degrees.
    pub fn hue(self) -> f64 {
        self.b.atan2(self.a).to_degrees()
    }

    /// How far the hue is from another one, 0..=180 degrees.
    pub fn hue_difference(self, other: Self) -> f64 {
        let difference = (self.hue() - other.hue()).rem_euclid(360.0);
        difference.min(360.0 - difference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{RgbSpace, white};

    #[test]
    fn the_white_has_no_colour_and_the_primaries_of_srgb_have_theirs() {
        let of = |rgb: [f64; 3]| {
            Oklab::of(Xyz::from(RgbSpace::SRGB.to_xyz_under(white::D65) * Vector3::from(rgb)))
        };
        let white = of([1.0; 3]);
        assert!((white.l - 1.0).abs() < 1e-3 && white.chroma() < 1e-3, "{white:?}");
        // Ottosson's page has L 0.628, C 0.258, h 29.2 for red and 0.452, 0.313, 264.1 for blue.
        for (rgb, l, chroma, hue) in
            [([1.0, 0.0, 0.0], 0.628, 0.258, 29.2), ([0.0, 0.0, 1.0], 0.452, 0.313, 264.1 - 360.0)]
        {
            let seen = of(rgb);
            assert!((seen.l - l).abs() < 2e-3 && (seen.chroma() - chroma).abs() < 2e-3, "{seen:?}");
            assert!((seen.hue() - hue).abs() < 0.3, "{seen:?}");
        }
    }

    #[test]
    fn hues_are_a_circle() {
        let at =
            |degrees: f64| Oklab { l: 0.5, a: degrees.to_radians().cos(), b: degrees.to_radians().sin() };
        assert!((at(179.0).hue_difference(at(-179.0)) - 2.0).abs() < 1e-9);
        assert!((at(10.0).hue_difference(at(50.0)) - 40.0).abs() < 1e-9);
    }
}
