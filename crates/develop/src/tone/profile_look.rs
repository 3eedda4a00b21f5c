//! The look that a profile brings along: look table and tone curve of a DCP, as the DNG specification has them applied
//! (1.7.1, chapter 6): linear ProPhoto RGB after exposure goes through the table, then through the curve, which is applied to the
//! largest and the smallest channel; the one between keeps its share of the way from one to the other, and with it the hue.

use std::sync::Arc;

use darkroot_colour::simd::vectorised;
use darkroot_colour::{RgbSpace, TransferCurve};
use darkroot_photo::{Rgb, Scene, Toned};
use darkroot_profile::{LookTable, Rendering};

use super::adjust::{Table, Tones};
use super::{Base, METERED_GREY};
use crate::cones::{self, Rows, along_hue, from_rgb, from_scene, greater, lesser, rows, times};
use crate::lut::Overlay;
use crate::transfer::Octaves;

/// A profile's look, with what a person changed about it, made ready for loops.
#[derive(Debug, Clone)]
pub struct ProfileLook {
    table: Option<Coded>,
    curve: Table,
    /// Factor on chroma, and how much more pale colours get.
    chroma: f32,
    vibrance: f32,
    /// Linear Rec. 2020 to ProPhoto RGB, and that to responses.
    from_scene: Rows,
    to_cones: Rows,
}

/// A look table, and the curve by which it takes values.
#[derive(Debug, Clone)]
struct Coded {
    table: Arc<LookTable>,
    encode: Arc<Octaves>,
    decode: Arc<Octaves>,
}

/// Pixels that are worked on together.
const RUN: usize = 64;

impl ProfileLook {
    /// The look of a rendering. Where that has no curve, the neutral look's serves.
    pub fn of(rendering: &Rendering, tones: &Tones, lut: Option<&Overlay>) -> Self {
        let lut = lut.filter(|overlay| overlay.lut.is_one_curve());
        let neutral = Base::neutral();
        let mut last = 0f32;
        let curve = Table::of(tones, METERED_GREY, |light| {
            let shown = match &rendering.curve {
                Some(curve) => curve.at(f64::from(light)) as f32,
                None => neutral.at(light),
            };
            // A spline may swing; brighter light is never shown darker.
            last = shown.max(last);
            let shown = tones.curve.map_or(last, |points| points.light(last));
            lut.map_or(shown, |overlay| overlay.grey(shown))
        });
        let srgb = TransferCurve::Srgb;
        let coded = |table: &LookTable| Coded {
            table: Arc::new(table.clone()),
            encode: Arc::new(Octaves::of(|v| srgb.encode(v))),
            decode: Arc::new(Octaves::of(|v| srgb.decode(v))),
        };
        Self {
            table: rendering.table.as_ref().map(coded),
            curve,
            chroma: tones.saturation,
            vibrance: tones.vibrance,
            from_scene: rows(&from_scene(&RgbSpace::PROPHOTO)),
            to_cones: rows(&from_rgb(&RgbSpace::PROPHOTO)),
        }
    }

    #[inline(always)]
    fn shown(&self, scene: [f32; 3]) -> [f32; 3] {
        let mut rgb = times(self.from_scene, scene).map(|v| lesser(greater(v, 0.0), super::BRIGHTEST));
        if let Some(Coded { table, encode, decode }) = &self.table {
            rgb = table.apply(rgb, |v| encode.at(v), |v| decode.at(v));
        }
        let high = greater(greater(rgb[0], rgb[1]), rgb[2]);
        let low = lesser(lesser(rgb[0], rgb[1]), rgb[2]);
        let (to_high, to_low) = (self.curve.at(high), self.curve.at(low));
        let slope = if high > low { (to_high - to_low) / (high - low) } else { 0.0 };
        let seen = times(self.to_cones, rgb.map(|v| to_low + slope * (v - low)));
        self.coloured(seen, low / greater(high, f32::MIN_POSITIVE))
    }

    /// With what a person changed about chroma.
    #[inline(always)]
    fn coloured(&self, seen: [f32; 3], pale: f32) -> [f32; 3] {
        let factor = self.chroma * (1.0 + self.vibrance * pale * pale);
        if (factor - 1.0).abs() < f32::EPSILON {
            return seen;
        }
        let grey = greater(cones::grey(seen), f32::MIN_POSITIVE);
        along_hue(seen, grey, factor).map(|distance| grey + grey * distance)
    }
}

/// Shows light as a profile has it.
pub fn show(mut picture: Rgb<Scene>, look: &ProfileLook) -> Rgb<Toned> {
    let [r, g, b] = picture.planes_mut();
    for ((r, g), b) in r.chunks_mut(RUN).zip(g.chunks_mut(RUN)).zip(b.chunks_mut(RUN)) {
        vectorised(
            #[inline(always)]
            || {
                for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                    [*r, *g, *b] = look.shown([*r, *g, *b]);
                }
            },
        );
    }
    picture.into_space()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gamut::{self, Primaries};
    use darkroot_colour::{Vector3, white};
    use darkroot_photo::Size;
    use darkroot_profile::ToneCurve;

    fn rendering() -> Rendering {
        let node = |i: usize| {
            let (s, h, v) = (i % 3, i / 3 % 6, i / 18);
            [(h as f32 - 2.0) * s as f32 * 3.0, 1.0 + 0.1 * v as f32, 1.0 - 0.05 * s as f32]
        };
        let points = [0.0, 0.05, 0.2, 0.5, 1.0].map(|x: f64| [x, x.powf(0.55)]);
        Rendering {
            exposure: 0.0,
            table: LookTable::new([6, 3, 4], true, (0..72).map(node).collect()),
            curve: ToneCurve::new(points.to_vec()),
        }
    }

    /// Linear ProPhoto RGB of linear ProPhoto RGB, by the stage.
    fn shown(rgb: [f64; 3], rendering: &Rendering, tones: &Tones) -> [f64; 3] {
        let to_scene =
            RgbSpace::REC2020.from_xyz_under(white::D50) * RgbSpace::PROPHOTO.to_xyz_under(white::D50);
        let scene = to_scene * Vector3::from(rgb);
        let size = Size { width: 1, height: 1 };
        let picture = Rgb::from_planes(size, [0, 1, 2].map(|c| vec![scene[c] as f32])).unwrap();
        let look = ProfileLook::of(rendering, tones, None);
        gamut::unfitted(show(picture, &look), &Primaries::new(&RgbSpace::PROPHOTO)).at(0, 0).map(f64::from)
    }

    const COLOURS: [[f64; 3]; 7] = [
        [0.2, 0.3, 0.1],
        [0.7, 0.1, 0.05],
        [0.02, 0.03, 0.3],
        [0.9, 0.8, 0.2],
        [0.18, 0.18, 0.18],
        [0.3, 0.9, 0.9],
        [0.001, 0.002, 0.0005],
    ];

    #[test]
    fn the_table_comes_before_the_curve_and_the_middle_channel_keeps_its_share() {
        let rendering = rendering();
        let (table, curve) = (rendering.table.as_ref().unwrap(), rendering.curve.as_ref().unwrap());
        let srgb = TransferCurve::Srgb;
        for colour in COLOURS {
            let looked = table.apply(
                colour.map(|v| v as f32),
                |v| srgb.encode(f64::from(v)) as f32,
                |v| srgb.decode(f64::from(v)) as f32,
            );
            let looked = looked.map(f64::from);
            let (low, high) = looked.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
            let between = |v: f64| if high > low { (v - low) / (high - low) } else { 0.0 };
            let expected = looked.map(|v| curve.at(low) + between(v) * (curve.at(high) - curve.at(low)));
            let found = shown(colour, &rendering, &Tones::default());
            assert!(
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 3e-4),
                "{colour:?}: {found:?} {expected:?}"
            );
        }
    }

    #[test]
    fn changes_of_tone_and_chroma_go_over_it() {
        let rendering = rendering();
        let with = |tones| shown([0.2, 0.3, 0.1], &rendering, &tones);
        let plain = with(Tones::default());
        let grey = with(Tones { saturation: 0.0, ..Tones::default() });
        let brighter = with(Tones { shadows: 1.0, highlights: 1.0, ..Tones::default() });
        assert!(
            grey[0] > plain[2] && grey[0] < plain[1] && (grey[0] - grey[1]).abs() < 1e-3,
            "{plain:?} {grey:?}"
        );
        assert!(brighter.iter().zip(plain).all(|(a, b)| *a > b), "{plain:?} {brighter:?}");
    }

    #[test]
    fn brighter_light_is_never_shown_darker_and_white_is_white() {
        // A spline that swings.
        let points = vec![[0.0, 0.0], [0.45, 0.02], [0.5, 0.98], [1.0, 1.0]];
        let rendering = Rendering { table: None, curve: ToneCurve::new(points), exposure: 0.0 };
        let greys: Vec<f64> =
            (0..200).map(|i| shown([f64::from(i) * 0.01; 3], &rendering, &Tones::default())[1]).collect();
        assert!(greys.is_sorted_by(|a, b| *a <= b + 1e-6));
        assert!((greys[199] - 1.0).abs() < 1e-4 && greys[0].abs() < 1e-6, "{greys:?}");
    }

    #[test]
    fn without_a_curve_the_neutral_one_serves() {
        let rendering = Rendering { curve: None, ..rendering() };
        let grey = shown([METERED_GREY; 3], &rendering, &Tones::default());
        assert!((grey[1] - 0.28).abs() < 5e-3, "{grey:?}");
    }
}
