//! RGB colour spaces: primaries, white point, transfer curve.

use crate::adaptation::bradford;
use crate::{Matrix3, Vector3, Xy, Xyz, white};

/// How linear light is encoded as numbers, and back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TransferCurve {
    /// No encoding.
    Linear,
    /// IEC 61966-2-1 (sRGB, Display P3).
    Srgb,
    /// A plain power: encoded = linear^(1 / gamma).
    Gamma(f64),
    /// ROMM RGB (ISO 22028-2): 1.8 with a linear foot.
    Romm,
    /// ITU-R BT.2020-2, table 4, with the exact constants.
    Rec2020,
    /// CIE lightness: encoded = L\* / 100 (eciRGB v2, ISO 22028-4).
    LStar,
}

impl TransferCurve {
    /// Encodes linear light; 0 -> 0, 1 -> 1. Negative light is encoded as its mirror image.
    pub fn encode(self, linear: f64) -> f64 {
        let v = linear.abs();
        let encoded = match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.003_130_8 => 12.92 * v,
            Self::Srgb => 1.055 * v.powf(1.0 / 2.4) - 0.055,
            Self::Gamma(gamma) => v.powf(1.0 / gamma),
            Self::Romm if v < ROMM_FOOT => 16.0 * v,
            Self::Romm => v.powf(1.0 / 1.8),
            Self::Rec2020 if v < REC2020_BETA => 4.5 * v,
            Self::Rec2020 => REC2020_ALPHA * v.powf(0.45) - (REC2020_ALPHA - 1.0),
            Self::LStar if v <= LSTAR_FOOT => v * LSTAR_KAPPA / 100.0,
            Self::LStar => 1.16 * v.cbrt() - 0.16,
        };
        encoded.copysign(linear)
    }

    /// Linear light of an encoded value: the inverse of [`TransferCurve::encode`].
    pub fn decode(self, encoded: f64) -> f64 {
        let v = encoded.abs();
        let linear = match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.040_45 => v / 12.92,
            Self::Srgb => ((v + 0.055) / 1.055).powf(2.4),
            Self::Gamma(gamma) => v.powf(gamma),
            Self::Romm if v < 16.0 * ROMM_FOOT => v / 16.0,
            Self::Romm => v.powf(1.8),
            Self::Rec2020 if v < 4.5 * REC2020_BETA => v / 4.5,
            Self::Rec2020 => ((v + REC2020_ALPHA - 1.0) / REC2020_ALPHA).powf(1.0 / 0.45),
            Self::LStar if v <= 0.08 => v * 100.0 / LSTAR_KAPPA,
            Self::LStar => ((v + 0.16) / 1.16).powi(3),
        };
        linear.copysign(encoded)
    }
}

/// Et of ISO 22028-2: 16^(1.8 / (1 - 1.8)) = 1/512.
const ROMM_FOOT: f64 = 1.0 / 512.0;
/// Constants of BT.2020 to the precision at which the curve is smooth.
const REC2020_ALPHA: f64 = 1.099_296_826_809_442;
const REC2020_BETA: f64 = 0.018_053_968_510_807;
/// (6/29)^3 and (29/3)^3 of CIELAB.
const LSTAR_FOOT: f64 = 216.0 / 24389.0;
const LSTAR_KAPPA: f64 = 24389.0 / 27.0;

/// An additive RGB space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RgbSpace {
    /// Name as people write it.
    pub name: &'static str,
    /// Chromaticities of the red, green and blue primaries.
    pub primaries: [Xy; 3],
    /// Chromaticity of the white, RGB = (1,1,1).
    pub white: Xy,
    /// Transfer curve of encoded values.
    pub curve: TransferCurve,
}

impl Default for RgbSpace {
    /// sRGB, which holds where nobody names a space.
    fn default() -> Self {
        Self::SRGB
    }
}

impl RgbSpace {
    /// sRGB, IEC 61966-2-1.
    pub const SRGB: Self = Self {
        name: "sRGB",
        primaries: [Xy::new(0.64, 0.33), Xy::new(0.30, 0.60), Xy::new(0.15, 0.06)],
        white: white::D65_XY,
        curve: TransferCurve::Srgb,
    };
    /// Display P3: the primaries of SMPTE RP 431-2 with D65 and sRGB's curve.
    pub const DISPLAY_P3: Self = Self {
        name: "Display P3",
        primaries: [Xy::new(0.680, 0.320), Xy::new(0.265, 0.690), Xy::new(0.150, 0.060)],
        white: white::D65_XY,
        curve: TransferCurve::Srgb,
    };
    /// Adobe RGB (1998), version 2005-05: gamma 2 + 51/256.
    pub const ADOBE_RGB: Self = Self {
        name: "Adobe RGB (1998)",
        primaries: [Xy::new(0.64, 0.33), Xy::new(0.21, 0.71), Xy::new(0.15, 0.06)],
        white: white::D65_XY,
        curve: TransferCurve::Gamma(2.0 + 51.0 / 256.0),
    };
    /// ProPhoto RGB, that is ROMM RGB, ISO 22028-2.
    pub const PROPHOTO: Self = Self {
        name: "ProPhoto RGB",
        primaries: [Xy::new(0.7347, 0.2653), Xy::new(0.1596, 0.8404), Xy::new(0.0366, 0.0001)],
        white: white::D50_XY,
        curve: TransferCurve::Romm,
    };
    /// ITU-R BT.2020-2.
    pub const REC2020: Self = Self {
        name: "Rec. 2020",
        primaries: [Xy::new(0.708, 0.292), Xy::new(0.170, 0.797), Xy::new(0.131, 0.046)],
        white: white::D65_XY,
        curve: TransferCurve::Rec2020,
    };
    /// eciRGB v2, ISO 22028-4.
    pub const ECIRGB_V2: Self = Self {
        name: "eciRGB v2",
        primaries: [Xy::new(0.67, 0.33), Xy::new(0.21, 0.71), Xy::new(0.14, 0.08)],
        white: white::D50_XY,
        curve: TransferCurve::LStar,
    };
    /// ACES2065-1 (AP0 primaries, linear), SMPTE ST 2065-1:2021.
    pub const ACES2065_1: Self = Self {
        name: "ACES2065-1",
        primaries: [Xy::new(0.7347, 0.2653), Xy::new(0.0, 1.0), Xy::new(0.0001, -0.0770)],
        white: white::ACES_XY,
        curve: TransferCurve::Linear,
    };

    /// ACEScg (AP1 primaries, linear), Academy S-2014-004.
    pub const ACESCG: Self = Self {
        name: "ACEScg",
        primaries: [Xy::new(0.713, 0.293), Xy::new(0.165, 0.830), Xy::new(0.128, 0.044)],
        white: white::ACES_XY,
        curve: TransferCurve::Linear,
    };

    /// Linear RGB to XYZ relative to this space's own white (SMPTE RP 177).
    pub fn to_xyz(&self) -> Matrix3 {
        let columns = self.primaries.map(|p| Vector3::new(p.x, p.y, 1.0 - p.x - p.y));
        let primaries = Matrix3::from_columns(&columns);
        let white = Vector3::from(self.white.xyz());
        let scale = primaries.try_inverse().map_or(white, |inverse| inverse * white);
        primaries * Matrix3::from_diagonal(&scale)
    }

    /// Linear RGB to XYZ adapted to `white` by Bradford, so that RGB = (1,1,1) gives `white` exactly.
    pub fn to_xyz_under(&self, white: Xyz) -> Matrix3 {
        bradford(self.white.xyz(), white) * self.to_xyz()
    }

    /// The inverse of [`RgbSpace::to_xyz_under`].
    pub fn from_xyz_under(&self, white: Xyz) -> Matrix3 {
        // Primaries of real spaces span XYZ, so the inverse exists.
        self.to_xyz_under(white).try_inverse().unwrap_or_else(Matrix3::identity)
    }

    /// The same space with linear numbers.
    #[must_use]
    pub fn linear(self) -> Self {
        Self { curve: TransferCurve::Linear, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACES: [RgbSpace; 8] = [
        RgbSpace::SRGB,
        RgbSpace::DISPLAY_P3,
        RgbSpace::ADOBE_RGB,
        RgbSpace::PROPHOTO,
        RgbSpace::REC2020,
        RgbSpace::ECIRGB_V2,
        RgbSpace::ACES2065_1,
        RgbSpace::ACESCG,
    ];

    #[test]
    fn srgb_to_xyz_is_the_matrix_of_the_standard() {
        #[rustfmt::skip]
        let published = Matrix3::new(
            0.4124, 0.3576, 0.1805,
            0.2126, 0.7152, 0.0722,
            0.0193, 0.1192, 0.9505,
        );
        assert!((RgbSpace::SRGB.to_xyz() - published).amax() < 1e-4);
    }

    #[test]
    fn aces_to_xyz_is_the_matrix_of_the_standard() {
        #[rustfmt::skip]
        let published = Matrix3::new(
            0.952_552_395_9, 0.0, 0.000_093_678_6,
            0.343_966_449_8, 0.728_166_096_6, -0.072_132_546_4,
            0.0, 0.0, 1.008_825_184_4,
        );
        assert!((RgbSpace::ACES2065_1.to_xyz() - published).amax() < 1e-4);
    }

    #[test]
    fn white_is_white_in_every_space() {
        for space in SPACES {
            let white = space.to_xyz_under(white::D50) * Vector3::new(1.0, 1.0, 1.0);
            assert!((white - Vector3::from(white::D50)).norm() < 1e-12, "{}", space.name);
        }
    }

    #[test]
    fn every_curve_runs_from_0_to_1_and_back() {
        for space in SPACES {
            let curve = space.curve;
            assert!((curve.encode(1.0) - 1.0).abs() < 1e-12 && curve.encode(0.0).abs() < 1e-12, "{curve:?}");
            for i in -100..=2000 {
                let v = f64::from(i) / 1000.0;
                assert!((curve.decode(curve.encode(v)) - v).abs() < 1e-6, "{curve:?} at {v}");
            }
        }
    }

    #[test]
    fn published_encodings_of_middle_grey() {
        // 18 % grey in sRGB is 0.4614, in L* 0.4950 (L* = 49.50).
        assert!((TransferCurve::Srgb.encode(0.18) - 0.4614).abs() < 1e-4);
        assert!((TransferCurve::LStar.encode(0.18) - 0.4950).abs() < 1e-4);
    }
}
