//! Tone: from unbounded scene light to what a display can show.
//!
//! The curve is log-logistic (Naka and Rushton's form of a receptor's response, J. Physiol. 185, 1966):
//! f(x) = (1 + k) x^p / (x^p + k), so that 0 stays 0 and the level at which the sensor clips, 1, becomes white.
//! p sets the contrast of the middle tones, k how they are lifted. It is applied to the largest and the smallest of R, G and
//! B. Between them lies the grey of the colour's lightness, and how far its brightness and its chroma go, follows: bright
//! colours run to white, and where hardly anything is in the smallest channel a colour stays pure until it is brighter than
//! white. Chroma then changes along the line of one hue of Oklab (`cones.rs`), not of R, G and B, in which blue turns purple
//! and orange yellow on their way to white.

use darkroot_colour::RgbSpace;
use darkroot_colour::simd::vectorised_widely;
use darkroot_photo::{Rgb, Scene, Toned};

use crate::Look;
use crate::cones::{self, Rows, along_hue, from_rgb, greater, lesser, rows};
use crate::lut::Overlay;
use adjust::Table;

mod adjust;
pub use adjust::Tones;
mod headroom;
mod points;
pub use points::{Points, PointsError};
mod profile_look;
pub use profile_look::{ProfileLook, show};

/// The curve of a look, with what a person changed about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    base: Base,
    /// All of the curve, where brightness was changed.
    table: Option<Table>,
    colours: Colours,
}

/// What becomes of colours.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Colours {
    /// Factor on the chroma that the curve gives.
    chroma: f32,
    /// How much more chroma pale colours get.
    vibrance: f32,
    /// Rec. 2020 to responses.
    to_cones: Rows,
}

/// A log-logistic curve.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Base {
    /// Quarters of the exponent p: 5, 7 or 8.
    quarters: u8,
    k: f32,
}

/// How much light of its brightest channel a colour's darkest one gets: strong colours that are brighter than white go to
/// white as light grows, as on film, instead of standing still at what a display can show. Dark ones, blue first, wait longer.
const WHITER: f32 = 0.05;
/// Scene light of a grey card as cameras meter it: 12.7 % of the clipping level (ISO 12232).
const METERED_GREY: f64 = 0.127;
/// Brighter scene light counts as this.
const BRIGHTEST: f32 = 1e6;
/// Darker greys count as this where they divide.
const DARKEST: f32 = 1e-6;

impl Curve {
    /// The curve of a look, changed, and with a table over it that is a tone curve; `None` for those that show light in
    /// proportion, and for that of a profile ([`ProfileLook`]).
    pub fn of(look: Look, tones: &Tones, lut: Option<&Overlay>) -> Option<Self> {
        let lut = lut.filter(|overlay| overlay.lut.is_one_curve());
        let curve = |base: Base, chroma: f32| {
            let changed = !tones.keeps_curve() || lut.is_some();
            let table = changed.then(|| {
                Table::of(tones, METERED_GREY, |light| {
                    let shown = base.at(light);
                    let shown = tones.curve.map_or(shown, |points| points.light(shown));
                    lut.map_or(shown, |overlay| overlay.grey(shown))
                })
            });
            let to_cones = rows(&from_rgb(&RgbSpace::REC2020));
            let colours = Colours { chroma: chroma * tones.saturation, vibrance: tones.vibrance, to_cones };
            Self { base, table, colours }
        };
        match look {
            Look::Neutral | Look::Camera => Some(curve(Base::neutral(), 1.0)),
            Look::Vivid => Some(curve(Base::of(8, 0.28), 1.15)),
            Look::Flat => Some(curve(Base::of(5, 0.24), 1.0)),
            Look::Profile | Look::Reproduction | Look::Linear => None,
        }
    }

    /// Display light of scene light; 0 for negative, never more than 1.
    pub fn at(&self, scene: f32) -> f32 {
        match &self.table {
            None => self.base.at(scene),
            Some(table) => table.at(lesser(greater(scene, 0.0), BRIGHTEST)),
        }
    }
}

impl Colours {
    /// Responses to a colour of the scene, toned by a curve.
    #[inline(always)]
    fn shown<C: Shows, const VIBRANT: bool>(self, scene: [f32; 3], curve: C) -> [f32; 3] {
        let scene = scene.map(|v| lesser(v, BRIGHTEST));
        // Light below 0, of colours beyond Rec. 2020 and of noise, ends where light does; responses to it say more.
        let high = greater(greater(greater(scene[0], scene[1]), scene[2]), 0.0);
        let low = greater(lesser(lesser(scene[0], scene[1]), scene[2]), 0.0);
        let seen = cones::times(self.to_cones, scene).map(|v| greater(v, 0.0));
        let grey = greater(cones::grey(seen), DARKEST);
        // Grey has no span: it becomes `to_low`.
        let span = high - low;
        let (to_high, to_low) = (curve.light(high), curve.light(low + WHITER * high * grey.sqrt() * span));
        let slope = if span > 0.0 { (to_high - to_low) / span } else { 0.0 };
        let shown = greater(to_low + (grey - low) * slope, 0.0);
        // Where the curve is steep, chroma grows, half as much as channels apart would let it: less so that of pure
        // colours, which have nowhere to go.
        let (more, spread) = (slope * grey - shown, 0.5 * low);
        let chroma = if more > 0.0 { shown * grey + more * spread } else { slope * grey * grey };
        let mut factor = self.chroma;
        if VIBRANT {
            let pale = low / greater(high, f32::MIN_POSITIVE);
            factor *= 1.0 + self.vibrance * pale * pale;
        }
        let chroma = factor * chroma / greater(shown * grey, f32::MIN_POSITIVE);
        along_hue(seen, grey, chroma).map(|distance| shown + shown * distance)
    }
}

impl Base {
    /// The curve of an exponent, in quarters, that shows a metered grey as this display light.
    fn of(quarters: u8, shown_grey: f64) -> Self {
        // Solved for f(METERED_GREY) = shown_grey.
        let t = METERED_GREY.powf(f64::from(quarters) / 4.0);
        let k = t * (1.0 - shown_grey) / (shown_grey - t);
        Self { quarters, k: k as f32 }
    }

    /// A metered grey is shown so that pictures are as bright as those of cameras (tests/compare/brightness.py).
    fn neutral() -> Self {
        Self::of(7, 0.28)
    }

    #[inline(always)]
    fn at(self, scene: f32) -> f32 {
        let x = lesser(greater(scene, 0.0), BRIGHTEST);
        let power = match self.quarters {
            5 => x * x.sqrt().sqrt(),
            7 => {
                let root = x.sqrt();
                x * root * root.sqrt()
            }
            _ => x * x,
        };
        lesser((1.0 + self.k) * power / (power + self.k), 1.0)
    }
}

/// Applies a look's curve.
pub fn tone(picture: Rgb<Scene>, curve: &Curve) -> Rgb<Toned> {
    let Curve { base, table, colours } = curve;
    let (base, colours) = (*base, *colours);
    match (table, colours.vibrance == 0.0) {
        (None, true) => toned::<_, false>(picture, colours, base),
        (None, false) => toned::<_, true>(picture, colours, base),
        (Some(table), true) => toned::<_, false>(picture, colours, table),
        (Some(table), false) => toned::<_, true>(picture, colours, table),
    }
}

/// What shows light.
trait Shows: Copy {
    /// Display light of scene light, which is not negative.
    fn light(self, scene: f32) -> f32;
}

impl Shows for Base {
    #[inline(always)]
    fn light(self, scene: f32) -> f32 {
        self.at(scene)
    }
}

impl Shows for &Table {
    #[inline(always)]
    fn light(self, scene: f32) -> f32 {
        self.at(scene)
    }
}

#[inline(always)]
fn toned<C: Shows, const VIBRANT: bool>(mut picture: Rgb<Scene>, colours: Colours, curve: C) -> Rgb<Toned> {
    let [r, g, b] = picture.planes_mut();
    vectorised_widely(
        #[inline(always)]
        || {
            for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                [*r, *g, *b] = colours.shown::<C, VIBRANT>([*r, *g, *b], curve);
            }
        },
    );
    picture.into_space()
}

#[cfg(test)]
mod tests;
