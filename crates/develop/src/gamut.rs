//! Gamut: from Rec. 2020 to the primaries of the output.

use darkroot_colour::simd::vectorised;
use darkroot_colour::{Matrix3, RgbSpace, white};
use darkroot_photo::{Display, Rgb, Scene, Toned};

/// Linear Rec. 2020 to the linear RGB of another space, white to white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Primaries {
    matrix: [[f32; 3]; 3],
    /// Weights of the output's channels in luminance.
    luminance: [f32; 3],
}

impl Primaries {
    /// Prepares the conversion to `space`.
    pub fn new(space: &RgbSpace) -> Self {
        let matrix = space.from_xyz_under(white::D50) * RgbSpace::REC2020.to_xyz_under(white::D50);
        let y = space.to_xyz_under(white::D50);
        Self { matrix: rows(&matrix), luminance: [0, 1, 2].map(|c| y[(1, c)] as f32) }
    }

    #[inline(always)]
    fn convert(&self, v: [f32; 3]) -> [f32; 3] {
        self.matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }
}

fn rows(m: &Matrix3) -> [[f32; 3]; 3] {
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| m[(r, c)] as f32))
}

/// Converts, and moves what the output cannot show towards the grey of the same luminance until it can.
pub fn fit(mut picture: Rgb<Toned>, primaries: &Primaries) -> Rgb<Display> {
    let [r, g, b] = picture.planes_mut();
    let weights = primaries.luminance;
    vectorised(
        #[inline(always)]
        || {
            for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                let v = primaries.convert([*r, *g, *b]);
                let grey = (weights[0] * v[0] + weights[1] * v[1] + weights[2] * v[2]).clamp(0.0, 1.0);
                let (high, low) = (v[0].max(v[1]).max(v[2]), v[0].min(v[1]).min(v[2]));
                let up = if high > 1.0 { (1.0 - grey) / (high - grey) } else { 1.0 };
                let down = if low < 0.0 { grey / (grey - low) } else { 1.0 };
                let keep = up.min(down);
                [*r, *g, *b] = v.map(|v| (grey + (v - grey) * keep).clamp(0.0, 1.0));
            }
        },
    );
    picture.into_space()
}

/// Converts and changes nothing else: for the linear look.
pub fn convert(mut picture: Rgb<Scene>, primaries: &Primaries) -> Rgb<Display> {
    let [r, g, b] = picture.planes_mut();
    for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
        [*r, *g, *b] = primaries.convert([*r, *g, *b]);
    }
    picture.into_space()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Size;

    fn one<S>(v: [f32; 3]) -> Rgb<S> {
        Rgb::from_planes(Size { width: 1, height: 1 }, v.map(|v| vec![v])).unwrap()
    }

    #[test]
    fn white_and_grey_stay() {
        let srgb = Primaries::new(&RgbSpace::SRGB);
        for grey in [0.0f32, 0.18, 1.0] {
            let out = fit(one([grey; 3]), &srgb).at(0, 0);
            assert!(out.iter().all(|v| (v - grey).abs() < 1e-5), "{grey} {out:?}");
        }
    }

    #[test]
    fn a_colour_outside_srgb_is_moved_inside_at_its_luminance() {
        let srgb = Primaries::new(&RgbSpace::SRGB);
        let green = [0.05, 0.9, 0.1];
        let out = fit(one(green), &srgb).at(0, 0);
        assert!(out.iter().all(|v| (0.0..=1.0).contains(v)));
        let y = 0.2126 * out[0] + 0.7152 * out[1] + 0.0722 * out[2];
        assert!((y - crate::tone::luminance(green)).abs() < 2e-3, "{out:?}");
        assert!(out[1] > 0.8 && out[0] < 0.2);
    }

    #[test]
    fn the_linear_look_keeps_what_lies_outside() {
        let out = convert(one([0.0, 2.0, 0.0]), &Primaries::new(&RgbSpace::SRGB)).at(0, 0);
        assert!(out[0] < 0.0 && out[1] > 2.0, "{out:?}");
    }
}
