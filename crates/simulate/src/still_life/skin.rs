//! What the surfaces of the still life are made of: reflectances, mixtures of them, and gloss.

use darkroot_colour::{Lab, Spectrum, Vector3};

use crate::exact::smoothstep;
use crate::random::smooth_noise;
use crate::{chart, reflectance};

use super::solid::Hit;

/// Kinds of surface of the solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Skin {
    Orange,
    RedApple,
    GreenApple,
    Lemon,
    Plum,
    Stem,
    Leaf,
    Bowl,
    Foot,
    Vase,
    Chrome,
}

/// Places of the reflectances in the palette, after the 24 patches of the chart.
#[derive(Debug, Clone, Copy)]
#[repr(usize)]
pub(super) enum Material {
    Perfect = chart::PATCHES.len(),
    Grey18,
    Paper,
    Ink,
    Frame,
    OakLight,
    OakDark,
    WallLight,
    WallDark,
    OrangeLight,
    OrangeDeep,
    AppleRed,
    AppleYellow,
    AppleGreen,
    AppleLime,
    LemonLight,
    LemonDeep,
    PlumDark,
    PlumBloom,
    Bark,
    LeafGreen,
    Glaze,
    Cobalt,
    Terracotta,
    Clay,
}

/// The palette, in the order of [`Material`].
pub(super) fn palette() -> Vec<Spectrum> {
    let mut palette = chart::reflectances();
    palette.extend([Spectrum::constant(1.0), Spectrum::constant(0.18)]);
    let colours = [
        (94.0, -0.5, 2.0),   // Paper
        (16.0, 0.0, 0.0),    // Ink
        (14.0, 0.0, -0.5),   // Frame
        (60.0, 11.0, 27.0),  // OakLight
        (33.0, 13.0, 19.0),  // OakDark
        (47.0, -7.0, -9.0),  // WallLight
        (33.0, -5.0, -9.0),  // WallDark
        (68.0, 36.0, 70.0),  // OrangeLight
        (57.0, 44.0, 60.0),  // OrangeDeep
        (36.0, 54.0, 33.0),  // AppleRed
        (74.0, 6.0, 52.0),   // AppleYellow
        (58.0, -28.0, 50.0), // AppleGreen
        (75.0, -18.0, 54.0), // AppleLime
        (86.0, -3.0, 74.0),  // LemonLight
        (76.0, 6.0, 72.0),   // LemonDeep
        (17.0, 18.0, -9.0),  // PlumDark
        (45.0, 9.0, -15.0),  // PlumBloom
        (27.0, 7.0, 13.0),   // Bark
        (40.0, -24.0, 30.0), // LeafGreen
        (90.0, -1.0, 5.0),   // Glaze
        (27.0, 18.0, -46.0), // Cobalt
        (46.0, 29.0, 30.0),  // Terracotta
        (58.0, 22.0, 27.0),  // Clay
    ];
    palette.extend(colours.map(|(l, a, b)| reflectance::of_lab(Lab { l, a, b })));
    palette
}

/// Body colour of a point: `share` of the second material, the rest of the first, times `depth`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    pub(super) first: Material,
    pub(super) second: Material,
    pub(super) share: f64,
    pub(super) depth: f64,
}

/// How a surface mirrors: reflectance at normal incidence and blur of the mirrored edges.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gloss {
    pub(super) strength: f64,
    pub(super) blur: f64,
}

impl Body {
    pub(super) fn plain(material: Material) -> Self {
        Self::mix(material, material, 0.0)
    }

    pub(super) fn mix(first: Material, second: Material, share: f64) -> Self {
        Self { first, second, share: share.clamp(0.0, 1.0), depth: 1.0 }
    }
}

impl Skin {
    pub(super) fn gloss(self) -> Gloss {
        let (strength, blur) = match self {
            Self::Orange => (0.03, 0.18),
            Self::RedApple | Self::GreenApple => (0.045, 0.035),
            Self::Lemon => (0.03, 0.12),
            Self::Plum => (0.03, 0.10),
            Self::Leaf => (0.03, 0.2),
            Self::Stem | Self::Vase | Self::Foot => (0.01, 0.4),
            Self::Bowl => (0.055, 0.015),
            Self::Chrome => (0.75, 0.01),
        };
        Gloss { strength, blur }
    }

    /// Whether it mirrors or paints things with sharp edges.
    pub(super) fn has_edges(self) -> bool {
        matches!(self, Self::Chrome | Self::Bowl | Self::Leaf)
    }

    /// Body colour where a ray meets it.
    pub(super) fn body(self, hit: &Hit) -> Body {
        let p = hit.place;
        match self {
            Self::Orange => Body::mix(
                Material::OrangeLight,
                Material::OrangeDeep,
                0.5 + 0.25 * spots(p, 3.0, 11) + 0.2 * spots(p, 22.0, 12),
            ),
            Self::RedApple => {
                let streaks = 0.35 * meridians(p, 21) + 0.5 * spots(p, 1.7, 22);
                let blush = smoothstep(0.25, 1.0, 0.25 + 0.7 * p[2] + streaks - 0.5 * p[0]);
                dimpled(p, Body::mix(Material::AppleRed, Material::AppleYellow, blush))
            }
            Self::GreenApple => {
                let share = 0.4 + 0.3 * spots(p, 2.0, 31) + 0.2 * spots(p, 16.0, 32);
                dimpled(p, Body::mix(Material::AppleGreen, Material::AppleLime, share))
            }
            Self::Lemon => Body::mix(
                Material::LemonLight,
                Material::LemonDeep,
                0.35 + 0.25 * spots(p, 3.0, 41) + 0.15 * spots(p, 18.0, 42),
            ),
            Self::Plum => {
                let bloom = 0.15 + 0.35 * smoothstep(-0.2, 0.8, spots(p, 2.5, 51) + 0.3 * spots(p, 8.0, 52));
                Body::mix(Material::PlumDark, Material::PlumBloom, bloom)
            }
            Self::Stem => Body::plain(Material::Bark),
            Self::Foot => Body::plain(Material::Glaze),
            Self::Leaf => {
                Body { depth: if p[1].abs() < 0.06 { 1.3 } else { 1.0 }, ..Body::plain(Material::LeafGreen) }
            }
            Self::Bowl => {
                let band = smoothstep(-0.43, -0.42, p[2]) * (1.0 - smoothstep(-0.31, -0.30, p[2]));
                let share = if hit.inside { 0.0 } else { band * (0.93 + 0.07 * spots(p, 6.0, 61)) };
                Body::mix(Material::Glaze, Material::Cobalt, share)
            }
            Self::Vase => {
                let share = 0.4 + 0.25 * smooth_noise(71, 3.0 * p[0], 26.0 * p[2]) + 0.25 * spots(p, 5.0, 72);
                Body::mix(Material::Terracotta, Material::Clay, share)
            }
            Self::Chrome => Body { depth: 0.03, ..Body::plain(Material::Perfect) },
        }
    }

    /// How far the normal is tilted by pores, in x and z.
    pub(super) fn bump(self, hit: &Hit) -> Vector3 {
        let (height, size) = match self {
            Self::Orange => (0.10, 22.0),
            Self::Lemon => (0.06, 16.0),
            _ => return Vector3::zeros(),
        };
        let p = hit.place;
        Vector3::new(spots(p, size, 81), spots(p, size, 82), spots(p, size, 83)) * height
    }
}

/// Noise on the unit sphere, -1 to 1, with `size` features across a radius.
fn spots(p: Vector3, size: f64, seed: u64) -> f64 {
    let (x, y, z) = (p[0] * size, p[1] * size, p[2] * size);
    (smooth_noise(seed, x + 0.37 * z, y + 0.41 * z) + smooth_noise(seed + 500, z + 7.3, x - 0.29 * y)) / 1.4
}

/// Streaks from pole to pole.
fn meridians(p: Vector3, seed: u64) -> f64 {
    let across = (p[0] * p[0] + p[1] * p[1]).sqrt().max(1e-3);
    smooth_noise(seed, 14.0 * p[0] / across, 14.0 * p[1] / across)
}

/// Darker in the hollow around the stem.
fn dimpled(p: Vector3, body: Body) -> Body {
    let across = (p[0] * p[0] + p[1] * p[1]).sqrt();
    let hollow = if p[2] > 0.0 { 1.0 - smoothstep(0.02, 0.3, across) } else { 0.0 };
    Body { depth: 1.0 - 0.65 * hollow, ..body }
}
