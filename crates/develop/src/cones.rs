//! The space that looks are made in: Oklab's cone-like responses to linear light, white = 1 in each.
//!
//! Oklab takes their cube roots, in which colours of one hue lie on a straight line through grey. With
//! w(v) = (grey + 2 v) / (2 grey + v), which is the cube root to within 1 % from a third of grey to three times grey, that line
//! needs no root: a response v at `chroma` times its distance from grey along the line is
//!
//! ```text
//! grey + chroma (v - grey) / (1 + (1 - chroma) (v - grey) / (3 grey))
//! ```
//!
//! It is v itself for a chroma of 1, grey for 0, and undone by the inverse chroma.

use darkroot_colour::oklab::{CONES, LIGHTNESS};
use darkroot_colour::{Matrix3, RgbSpace, white};

/// Least denominator of the line, as a share of grey: more than four times the chroma of deep blue is not asked for.
const LEAST: f32 = 0.3;

/// A matrix for loops.
pub(crate) type Rows = [[f32; 3]; 3];

/// Linear RGB of a space to responses, white to white.
pub(crate) fn from_rgb(space: &RgbSpace) -> Matrix3 {
    let matrix = CONES * space.to_xyz_under(white::D65);
    // Oklab's own white is D65 to four digits; grey must be grey to all of them.
    let whites = matrix.column_sum();
    Matrix3::from_fn(|r, c| matrix[(r, c)] / whites[r])
}

/// Linear Rec. 2020, in which the scene is, to linear RGB of a space, white to white.
pub(crate) fn from_scene(space: &RgbSpace) -> Matrix3 {
    space.from_xyz_under(white::D50) * RgbSpace::REC2020.to_xyz_under(white::D50)
}

pub(crate) fn rows(m: &Matrix3) -> Rows {
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| m[(r, c)] as f32))
}

#[inline(always)]
pub(crate) fn times(rows: Rows, v: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The grey of about the same lightness: the responses by their weights in Oklab's lightness.
#[inline(always)]
pub(crate) fn grey(cones: [f32; 3]) -> f32 {
    const SUM: f64 = LIGHTNESS[0] + LIGHTNESS[1] + LIGHTNESS[2];
    const WEIGHTS: [f32; 3] =
        [(LIGHTNESS[0] / SUM) as f32, (LIGHTNESS[1] / SUM) as f32, (LIGHTNESS[2] / SUM) as f32];
    WEIGHTS[0] * cones[0] + WEIGHTS[1] * cones[1] + WEIGHTS[2] * cones[2]
}

/// Distances from grey, in units of grey, after the colour has got `chroma` times its chroma at the same hue. Grey must be
/// more than 0.
#[inline(always)]
pub(crate) fn along_hue(cones: [f32; 3], grey: f32, chroma: f32) -> [f32; 3] {
    let distance = cones.map(|v| v - grey);
    let bend = (1.0 - chroma) * (1.0 / 3.0);
    let under = distance.map(|d| greater(grey + bend * d, LEAST * grey));
    // One division for the three.
    let part = chroma / (under[0] * under[1] * under[2]);
    [
        distance[0] * part * under[1] * under[2],
        distance[1] * part * under[0] * under[2],
        distance[2] * part * under[0] * under[1],
    ]
}

/// The greater of two; `b` where one is no number. One instruction, which `f32::max` is not.
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser of two; `b` where one is no number.
#[inline(always)]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::oklab::OPPONENTS;
    use darkroot_colour::{Oklab, Vector3, Xyz};

    fn oklab(cones: [f32; 3]) -> Oklab {
        let lab = OPPONENTS * Vector3::from(cones.map(|v| f64::from(v).cbrt()));
        Oklab { l: lab[0], a: lab[1], b: lab[2] }
    }

    #[test]
    fn the_line_keeps_hue_ends_in_grey_and_can_be_walked_back() {
        let to_cones = rows(&from_rgb(&RgbSpace::SRGB));
        for rgb in [[0.8f32, 0.3, 0.2], [0.3, 0.7, 0.2], [0.2, 0.3, 0.8], [0.7, 0.7, 0.2], [0.6, 0.2, 0.6]] {
            let cones = times(to_cones, rgb);
            let grey = grey(cones);
            let at = |cones, chroma| along_hue(cones, grey, chroma).map(|d| grey + grey * d);
            assert!(at(cones, 0.0).iter().all(|v| (v - grey).abs() < 1e-6));
            for chroma in [0.1f32, 0.3, 0.6, 0.9, 1.0, 1.3] {
                let seen = at(cones, chroma);
                let skew = oklab(seen).hue_difference(oklab(cones));
                assert!(skew < 1.5, "{rgb:?} at {chroma}: {skew} degrees");
                let back = at(seen, 1.0 / chroma);
                assert!(back.iter().zip(cones).all(|(a, b)| (a - b).abs() < 1e-4), "{rgb:?} at {chroma}");
            }
        }
    }

    #[test]
    fn the_white_of_every_space_is_one_in_each_response() {
        for space in [RgbSpace::SRGB, RgbSpace::REC2020, RgbSpace::PROPHOTO] {
            let white = times(rows(&from_rgb(&space)), [1.0; 3]);
            assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-6), "{} {white:?}", space.name);
        }
        assert!((Oklab::of(Xyz::from(Vector3::from(white::D65))).l - 1.0).abs() < 1e-3);
    }
}
