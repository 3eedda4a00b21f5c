//! Gamut: from what a look shows to the primaries of the output.
//!
//! A colour that the output can show is left as it is. Another one loses chroma until the output can show it, along the line
//! of its hue in Oklab (`cones.rs`) at its lightness.

use darkroot_colour::simd::vectorised_widely;
use darkroot_colour::{Matrix3, RgbSpace};
use darkroot_photo::{Display, Rgb, Scene, Toned};

use crate::cones::{self, Rows, along_hue, from_rgb, from_scene, greater, lesser, rows, times};
use crate::recipe::Gamut;

/// What becomes of colours that the output cannot show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mapping {
    /// Nothing: floating point keeps them.
    Kept,
    /// They are cut, and counted.
    Clipped,
    /// They are moved inside.
    Mapped,
}

impl Mapping {
    /// As asked, or as suits the look.
    pub(crate) fn of(asked: Gamut, linear: bool, reproduced: bool) -> Self {
        match asked {
            _ if linear => Self::Kept,
            Gamut::Clip => Self::Clipped,
            Gamut::Auto if reproduced => Self::Clipped,
            Gamut::Auto | Gamut::Map => Self::Mapped,
        }
    }
}

/// To the linear RGB of an output space, white to white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Primaries {
    /// From linear Rec. 2020.
    from_scene: Rows,
    /// From the responses that a look gives.
    from_cones: Rows,
    /// From linear Rec. 2020 to responses.
    scene_to_cones: Rows,
}

/// Pixels that are looked at together: in most runs the output can show all of them.
const RUN: usize = 64;
/// What rounding may put white and black beyond the output's.
const ROUNDING: f32 = 1e-6;

impl Primaries {
    /// Prepares the conversion to `space`.
    pub fn new(space: &RgbSpace) -> Self {
        // Primaries of real spaces are three different colours, so the inverse exists.
        let from_cones = from_rgb(space).try_inverse().unwrap_or_else(Matrix3::identity);
        Self {
            from_scene: rows(&from_scene(space)),
            from_cones: rows(&from_cones),
            scene_to_cones: rows(&from_rgb(&RgbSpace::REC2020)),
        }
    }

    /// A colour moved towards grey at its hue until the output can show it.
    #[inline(always)]
    fn fitted(&self, cones: [f32; 3]) -> [f32; 3] {
        let grey = greater(lesser(cones::grey(cones), 1.0), f32::MIN_POSITIVE);
        let found = times(self.from_cones, cones);
        let chroma = keep(found, grey);
        // Lines of one hue are bent in RGB, but little: what is left is moved straight.
        let bent = along_hue(cones, grey, chroma).map(|distance| grey + grey * distance);
        let bent = times(self.from_cones, bent);
        let straight = keep(bent, grey);
        let moved = bent.map(|v| grey + (v - grey) * straight);
        [0, 1, 2].map(|c| shown(if chroma < 1.0 { moved[c] } else { found[c] }))
    }
}

/// The share of a colour's distance from grey that ends at black or white.
#[inline(always)]
fn keep(v: [f32; 3], grey: f32) -> f32 {
    let (high, low) = (greater(greater(v[0], v[1]), v[2]), lesser(lesser(v[0], v[1]), v[2]));
    let up = if high > 1.0 + ROUNDING { (1.0 - grey) / (high - grey) } else { 1.0 };
    let down = if low < -ROUNDING { grey / (grey - low) } else { 1.0 };
    lesser(up, down)
}

#[inline(always)]
fn shown(v: f32) -> f32 {
    lesser(greater(v, 0.0), 1.0)
}

/// Converts, and moves what the output cannot show towards the grey of the same lightness until it can.
pub fn fit(mut picture: Rgb<Toned>, primaries: &Primaries) -> Rgb<Display> {
    let [r, g, b] = picture.planes_mut();
    vectorised_widely(
        #[inline(always)]
        || {
            let mut converted = [[0f32; RUN]; 3];
            for ((r, g), b) in r.chunks_mut(RUN).zip(g.chunks_mut(RUN)).zip(b.chunks_mut(RUN)) {
                let [red, green, blue] = &mut converted;
                let out = red.iter_mut().zip(green.iter_mut()).zip(blue.iter_mut());
                let mut outside = 0u32;
                for (((r, g), b), ((red, green), blue)) in r.iter().zip(g.iter()).zip(b.iter()).zip(out) {
                    let v = times(primaries.from_cones, [*r, *g, *b]);
                    let (high, low) = (greater(greater(v[0], v[1]), v[2]), lesser(lesser(v[0], v[1]), v[2]));
                    outside |= u32::from(high > 1.0 + ROUNDING) | u32::from(low < -ROUNDING);
                    [*red, *green, *blue] = v.map(shown);
                }
                if outside == 0 {
                    r.copy_from_slice(&red[..r.len()]);
                    g.copy_from_slice(&green[..g.len()]);
                    b.copy_from_slice(&blue[..b.len()]);
                } else {
                    for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                        [*r, *g, *b] = primaries.fitted([*r, *g, *b]);
                    }
                }
            }
        },
    );
    picture.into_space()
}

/// Converts what a look shows, and changes nothing else.
pub fn unfitted(mut picture: Rgb<Toned>, primaries: &Primaries) -> Rgb<Display> {
    let [r, g, b] = picture.planes_mut();
    for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
        [*r, *g, *b] = times(primaries.from_cones, [*r, *g, *b]);
    }
    picture.into_space()
}

/// Light of the scene as responses, as it is: what is to be fitted without a look.
pub fn untoned(mut picture: Rgb<Scene>, primaries: &Primaries) -> Rgb<Toned> {
    let [r, g, b] = picture.planes_mut();
    for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
        [*r, *g, *b] = times(primaries.scene_to_cones, [*r, *g, *b]);
    }
    picture.into_space()
}

/// Converts and changes nothing else: for the linear look.
pub fn convert(mut picture: Rgb<Scene>, primaries: &Primaries) -> Rgb<Display> {
    let [r, g, b] = picture.planes_mut();
    for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
        [*r, *g, *b] = times(primaries.from_scene, [*r, *g, *b]);
    }
    picture.into_space()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::{Oklab, Vector3, Xyz, white};
    use darkroot_photo::Size;

    const SPACES: [RgbSpace; 3] = [RgbSpace::SRGB, RgbSpace::DISPLAY_P3, RgbSpace::ADOBE_RGB];

    fn one<S>(v: [f32; 3]) -> Rgb<S> {
        Rgb::from_planes(Size { width: 1, height: 1 }, v.map(|v| vec![v])).unwrap()
    }

    /// Linear RGB of a space as responses.
    fn seen(space: &RgbSpace, rgb: [f32; 3]) -> [f32; 3] {
        times(rows(&from_rgb(space)), rgb)
    }

    fn oklab(space: &RgbSpace, rgb: [f32; 3]) -> Oklab {
        let xyz = space.to_xyz_under(white::D65) * Vector3::from(rgb.map(f64::from));
        Oklab::of(Xyz::from(xyz))
    }

    #[test]
    fn white_and_grey_stay() {
        for space in SPACES {
            for grey in [0.0f32, 0.18, 1.0] {
                let out = fit(one([grey; 3]), &Primaries::new(&space)).at(0, 0);
                assert!(out.iter().all(|v| (v - grey).abs() < 1e-5), "{grey} {out:?}");
            }
        }
    }

    #[test]
    fn what_the_output_can_show_is_left_as_it_is() {
        let levels = [0.0f32, 0.02, 0.3, 0.7, 1.0];
        for space in SPACES {
            for i in 0..125 {
                let rgb = [levels[i % 5], levels[i / 5 % 5], levels[i / 25]];
                let out = fit(one(seen(&space, rgb)), &Primaries::new(&space)).at(0, 0);
                assert!(rgb.iter().zip(out).all(|(a, b)| (a - b).abs() < 1e-5), "{rgb:?} {out:?}");
            }
        }
    }

    #[test]
    fn a_colour_outside_is_moved_inside_at_its_hue() {
        let srgb = Primaries::new(&RgbSpace::SRGB);
        for rgb in [[0.05f32, 0.9, 0.1], [0.9, 0.1, 0.05], [0.3, 0.9, 0.9], [0.9, 0.85, 0.1], [0.6, 0.1, 0.8]]
        {
            let out = fit(one(seen(&RgbSpace::REC2020, rgb)), &srgb).at(0, 0);
            assert!(out.iter().all(|v| (0.0..=1.0).contains(v)));
            let (before, after) = (oklab(&RgbSpace::REC2020, rgb), oklab(&RgbSpace::SRGB, out));
            assert!(after.hue_difference(before) < 3.0, "{rgb:?}: {before:?} {after:?}");
            assert!((after.l - before.l).abs() < 0.06 && after.chroma() > 0.1, "{before:?} {after:?}");
        }
    }

    #[test]
    fn what_lies_next_to_each_other_does_so_after_it() {
        // From grey through the border of sRGB to the pure colours of Rec. 2020, in small steps.
        let srgb = Primaries::new(&RgbSpace::SRGB);
        for pure in [[1.0f32, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]] {
            let at = |i: usize| {
                let t = i as f32 / 1000.0;
                fit(one(seen(&RgbSpace::REC2020, pure.map(|p| 0.4 + (p - 0.4) * t))), &srgb).at(0, 0)
            };
            for i in 0..1000 {
                let (here, next) = (at(i), at(i + 1));
                assert!(here.iter().zip(next).all(|(a, b)| (a - b).abs() < 0.015), "{pure:?} {i}");
            }
        }
    }

    #[test]
    fn light_that_is_not_toned_is_the_same_by_both_ways() {
        let primaries = Primaries::new(&RgbSpace::ECIRGB_V2);
        for rgb in [[0.2f32, 0.3, 0.4], [0.9, 0.1, 0.2], [0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.1, 0.9, 0.1]] {
            let plain = convert(one(rgb), &primaries).at(0, 0);
            let seen = unfitted(untoned(one(rgb), &primaries), &primaries).at(0, 0);
            assert!(plain.iter().zip(seen).all(|(a, b)| (a - b).abs() < 1e-5), "{rgb:?}: {plain:?} {seen:?}");
        }
    }

    #[test]
    fn the_linear_look_keeps_what_lies_outside() {
        let out = convert(one([0.0, 2.0, 0.0]), &Primaries::new(&RgbSpace::SRGB)).at(0, 0);
        assert!(out[0] < 0.0 && out[1] > 2.0, "{out:?}");
    }
}
