//! Tone: from unbounded scene light to what a display can show.
//!
//! The curve is log-logistic (Naka and Rushton's form of a receptor's response, J. Physiol. 185, 1966):
//! f(x) = (1 + k) x^p / (x^p + k), so that 0 stays 0 and the level at which the sensor clips, 1, becomes white.
//! p sets the contrast of the middle tones, k how they are lifted. It is applied to the largest and the smallest
//! of R, G and B, and the middle one keeps its relative place between them: hue in the sense of HSV stays, and
//! bright colours run to white.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Rgb, Scene, Toned};

use crate::Look;

/// The curve of a look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Quarters of the exponent p: 4, 5 or 6.
    quarters: u8,
    k: f32,
    /// Factor on the distance of each channel from the grey of the same lightness, after the curve.
    chroma: f32,
}

/// Scene light of a grey card as cameras meter it (12.7 % of the clipping level, ISO 12232) and what it shall
/// become: 18 % and a little.
const METERED_GREY: f64 = 0.127;
const SHOWN_GREY: f64 = 0.19;

impl Curve {
    /// The curve of a look; `None` for the linear one.
    pub fn of(look: Look) -> Option<Self> {
        let curve = |quarters: u8, chroma: f32| {
            // Solved for f(METERED_GREY) = SHOWN_GREY.
            let t = METERED_GREY.powf(f64::from(quarters) / 4.0);
            let k = t * (1.0 - SHOWN_GREY) / (SHOWN_GREY - t);
            Self { quarters, k: k as f32, chroma }
        };
        match look {
            Look::Neutral => Some(curve(5, 1.0)),
            Look::Vivid => Some(curve(6, 1.15)),
            Look::Flat => Some(curve(4, 1.0)),
            Look::Linear => None,
        }
    }

    /// Display light of scene light; 0 for negative, never more than 1.
    #[inline(always)]
    pub fn at(self, scene: f32) -> f32 {
        let x = scene.clamp(0.0, 1e6);
        let power = match self.quarters {
            4 => x,
            5 => x * x.sqrt().sqrt(),
            _ => x * x.sqrt(),
        };
        ((1.0 + self.k) * power / (power + self.k)).min(1.0)
    }
}

/// Applies a look's curve.
pub fn tone(mut picture: Rgb<Scene>, curve: Curve) -> Rgb<Toned> {
    let [r, g, b] = picture.planes_mut();
    vectorised(
        #[inline(always)]
        || {
            for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                let (high, low) = (r.max(*g).max(*b), r.min(*g).min(*b));
                let (to_high, to_low) = (curve.at(high), curve.at(low));
                // Grey has no span: every channel is then `low` and becomes `to_low`.
                let span = high - low;
                let slope = if span > 0.0 { (to_high - to_low) / span } else { 0.0 };
                let mut toned = [*r, *g, *b].map(|v| to_low + (v - low) * slope);
                if curve.chroma > 1.0 {
                    let grey = luminance(toned);
                    toned = toned.map(|v| (grey + (v - grey) * curve.chroma).clamp(0.0, 1.0));
                }
                [*r, *g, *b] = toned.map(|v| v.min(1.0));
            }
        },
    );
    picture.into_space()
}

/// Luminance of linear Rec. 2020 (ITU-R BT.2020-2).
#[inline(always)]
pub(crate) fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2627 * r + 0.6780 * g + 0.0593 * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Size;

    const LOOKS: [Look; 3] = [Look::Neutral, Look::Vivid, Look::Flat];

    #[test]
    fn every_curve_rises_from_black_to_white() {
        for look in LOOKS {
            let curve = Curve::of(look).unwrap();
            let mut previous = curve.at(0.0);
            assert!(previous.abs() < 1e-9, "{look:?}");
            for i in 1..=2000 {
                let now = curve.at(i as f32 / 1000.0);
                assert!(now >= previous, "{look:?} at {i}");
                previous = now;
            }
            assert!((curve.at(1.0) - 1.0).abs() < 1e-6, "{look:?}");
            assert!((curve.at(METERED_GREY as f32) - SHOWN_GREY as f32).abs() < 1e-5, "{look:?}");
        }
    }

    #[test]
    fn grey_stays_grey_and_the_order_of_channels_stays() {
        let colours = [[0.2f32, 0.2, 0.2], [0.7, 0.1, 0.3], [3.0, 2.9, 2.8], [-0.1, 0.5, 0.2]];
        let plane = |c: usize| colours.iter().map(|v| v[c]).collect::<Vec<f32>>();
        let size = Size { width: 4, height: 1 };
        for look in LOOKS {
            let picture = Rgb::from_planes(size, [plane(0), plane(1), plane(2)]).unwrap();
            let toned = tone(picture, Curve::of(look).unwrap());
            let grey = toned.at(0, 0);
            assert!(
                (grey[0] - grey[1]).abs() < 1e-6 && (grey[1] - grey[2]).abs() < 1e-6,
                "{look:?} {grey:?}"
            );
            let red = toned.at(1, 0);
            assert!(red[0] > red[2] && red[2] > red[1], "{look:?} {red:?}");
            assert!((0..4).all(|x| toned.at(x, 0).iter().all(|v| (0.0..=1.0).contains(v))), "{look:?}");
        }
    }
}
