//! A still life: fruit, a bowl, a vase and a steel ball on an oak table, with a colour chart, a grey card and a
//! resolution target.
//!
//! A ray tracer of one bounce. The table is z = 0, the camera looks along +y from above with an upright image plane
//! (a view camera), so what stands upright and faces it keeps its shape. Lengths are decimetres, more or less.

mod card;
mod room;
mod skin;
mod solid;

use darkroot_colour::{Spectrum, Vector3};
use darkroot_photo::Size;

use crate::chart;
use crate::exact::{gaussian, smoothstep};
use crate::scene::Patch;

use card::{Card, Face};
use room::{KEY, KEY_LIGHT, WINDOW, canvas, window, wood};
use skin::{Body, Gloss, Material, Skin};
use solid::{Hit, Solid};

/// Place of the camera.
const EYE: [f64; 3] = [0.0, -12.0, 5.0];
/// Height of the picture at unit distance.
const FIELD: f64 = 0.6;
/// Where the horizon would lie, in picture heights from the top.
const HORIZON: f64 = -0.085;
/// Depth at which the backdrop stands.
const BACKDROP: f64 = 4.0;
/// Irradiance from the room on a surface that faces up.
const ROOM_LIGHT: f64 = 0.34;

type Rgb = [f32; 3];

/// The objects and the camera, for one size of picture.
#[derive(Debug, Clone)]
pub(crate) struct StillLife {
    size: Size,
    solids: Vec<Solid>,
    /// Where each solid can be seen: left, top, right and bottom, pixels.
    frames: Vec<[f64; 4]>,
    cards: Vec<Card>,
}

/// What lies in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Seen {
    Table,
    Backdrop,
    Fruit(Skin),
    /// Something with edges of its own: a card, a mirror.
    Detail,
}

/// Its reflectances.
pub(crate) fn materials() -> Vec<Spectrum> {
    skin::palette()
}

impl StillLife {
    pub(crate) fn new(size: Size) -> Self {
        let ball = |skin, x, y, r: f64| Solid::new(skin, [x, y, r], [r; 3]);
        let solids = vec![
            Solid::new(Skin::Bowl, [-2.35, -0.6, 1.2], [1.75, 1.75, 1.05]).open_above(0.98),
            Solid::new(Skin::Foot, [-2.35, -0.6, 0.2], [0.85, 0.85, 0.3]).open_above(0.26),
            Solid::new(Skin::Orange, [-2.95, -1.0, 1.35], [0.76, 0.76, 0.72]),
            Solid::new(Skin::RedApple, [-1.72, -1.05, 1.42], [0.80, 0.80, 0.73]),
            Solid::new(Skin::GreenApple, [-2.42, 0.05, 1.75], [0.78, 0.78, 0.72]),
            Solid::new(Skin::Stem, [-1.70, -1.03, 2.16], [0.035, 0.035, 0.20]),
            Solid::new(Skin::Stem, [-2.40, 0.05, 2.50], [0.035, 0.035, 0.20]),
            Solid::new(Skin::Leaf, [-2.12, 0.02, 2.6], [0.30, 0.11, 0.035]).turned(0.96, -0.28),
            Solid::new(Skin::Lemon, [-0.62, -2.7, 0.45], [0.63, 0.45, 0.45]).turned(0.8, -0.6),
            Solid::new(Skin::Lemon, [-0.14, -3.06, 0.45], [0.13, 0.10, 0.10]).turned(0.8, -0.6),
            ball(Skin::Plum, 0.10, -1.9, 0.42),
            ball(Skin::Plum, 0.62, -2.55, 0.42),
            ball(Skin::Chrome, 2.25, -3.15, 0.5),
            Solid::new(Skin::Vase, [-4.2, 1.4, 1.45], [0.72, 0.72, 1.5]).open_above(2.62),
        ];
        let pixel = FIELD * (-1.2 - EYE[1]) / size.height.max(1) as f64;
        let card = |left, width, height, y, face| Card { left, bottom: 0.0, width, height, y, face };
        let cards = vec![
            card(0.45, 4.5, 3.06, 1.5, Face::Chart),
            card(3.0, 1.1, 0.9, -1.0, Face::Grey),
            card(1.0, 1.62, 0.86, -1.2, Face::Resolution(pixel)),
        ];
        let mut this = Self { size, solids, frames: Vec::new(), cards };
        this.frames = this.solids.iter().map(|solid| this.frame_of(solid)).collect();
        this
    }

    /// The patches of the chart and the grey card.
    pub(crate) fn patches(&self, materials: &[Spectrum]) -> Vec<Patch> {
        let patch = |name, [left, bottom, width, height]: [f64; 4], y: f64, material: usize| Patch {
            name,
            corners: [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]
                .map(|(u, v)| self.pixel_of(Vector3::new(left + u * width, y, bottom + v * height))),
            reflectance: materials[material].clone(),
        };
        let mut patches = Vec::new();
        for card in &self.cards {
            match card.face {
                Face::Chart => patches.extend(
                    chart::PATCHES
                        .iter()
                        .enumerate()
                        .map(|(i, (name, _))| patch(name, card.patch(i), card.y, i)),
                ),
                Face::Grey => {
                    let whole = [card.left, card.bottom, card.width, card.height];
                    patches.push(patch("grey card", whole, card.y, Material::Grey18 as usize));
                }
                Face::Resolution(_) => {}
            }
        }
        patches
    }

    /// Colour of the pixel in column `x` of row `y`: the mean of 2x2 points, or of the two on a diagonal where both
    /// show the same smooth thing.
    pub(crate) fn pixel(&self, x: usize, y: usize, palette: &[Rgb]) -> Rgb {
        let (x, y) = (x as f64, y as f64);
        let (one, seen_first) = self.point(x + 0.25, y + 0.25, palette);
        let (two, seen_last) = self.point(x + 0.75, y + 0.75, palette);
        let mean = blend(one, 0.5, two, 0.5);
        if seen_first == seen_last && seen_first != Seen::Detail {
            return mean;
        }
        let (three, _) = self.point(x + 0.75, y + 0.25, palette);
        let (four, _) = self.point(x + 0.25, y + 0.75, palette);
        blend(mean, 0.5, blend(three, 0.5, four, 0.5), 0.5)
    }

    /// Colour of the point (`x`, `y`) of the picture, in pixels, and what is there.
    fn point(&self, x: f64, y: f64, palette: &[Rgb]) -> (Rgb, Seen) {
        let height = self.size.height as f64;
        let (u, v) = ((x - self.size.width as f64 / 2.0) / height, y / height);
        let along = Vector3::new(FIELD * u, 1.0, FIELD * (HORIZON - v)).normalize();
        let seen = self
            .solids
            .iter()
            .zip(&self.frames)
            .filter_map(|(solid, f)| (f[0] <= x && x <= f[2] && f[1] <= y && y <= f[3]).then_some(solid));
        self.trace(EYE.into(), along, seen, palette)
    }

    fn pixel_of(&self, place: Vector3) -> (f64, f64) {
        let seen = place - Vector3::from(EYE);
        let (height, depth) = (self.size.height as f64, FIELD * seen[1]);
        (self.size.width as f64 / 2.0 + height * seen[0] / depth, height * (HORIZON - seen[2] / depth))
    }

    fn frame_of(&self, solid: &Solid) -> [f64; 4] {
        let far = f64::INFINITY;
        solid
            .corners()
            .into_iter()
            .map(|corner| self.pixel_of(corner))
            .fold([far, far, -far, -far], |f, (x, y)| [f[0].min(x), f[1].min(y), f[2].max(x), f[3].max(y)])
    }

    /// What the ray meets first of `seen`, the cards and the room.
    fn trace<'a>(
        &'a self,
        from: Vector3,
        along: Vector3,
        seen: impl Iterator<Item = &'a Solid>,
        palette: &[Rgb],
    ) -> (Rgb, Seen) {
        let mut nearest: Option<(Hit, &Solid)> = None;
        for solid in seen {
            if let Some(hit) = solid.hit(from, along)
                && nearest.is_none_or(|(best, _)| hit.distance < best.distance)
            {
                nearest = Some((hit, solid));
            }
        }
        let mut limit = nearest.map_or(f64::INFINITY, |(hit, _)| hit.distance);
        let mut print = None;
        for card in &self.cards {
            if let Some((distance, right, down)) = card.hit(from, along)
                && distance < limit
            {
                limit = distance;
                print = Some(card.print(right, down));
            }
        }
        match (print, nearest) {
            (Some((first, second, share)), _) => {
                (blend(palette[first], 1.0 - share, palette[second], share), Seen::Detail)
            }
            (None, Some((hit, solid))) => {
                let seen = if solid.skin.has_edges() { Seen::Detail } else { Seen::Fruit(solid.skin) };
                (self.solid_colour(&hit, solid, along, palette), seen)
            }
            (None, None) => self.room(from, along, palette),
        }
    }

    fn solid_colour(&self, hit: &Hit, solid: &Solid, along: Vector3, palette: &[Rgb]) -> Rgb {
        let normal = (hit.normal + solid.skin.bump(hit)).normalize();
        // Walls of a bowl light each other.
        let light = self.light(hit.point, normal, Some(solid)) + if hit.inside { 0.22 } else { 0.0 };
        let body = solid.skin.body(hit);
        let colour = body_colour(&body, light, palette);
        let mirrored = along - normal * (2.0 * along.dot(&normal));
        let Gloss { strength, blur } = solid.skin.gloss();
        // Schlick's approximation of Fresnel's law (Computer Graphics Forum 13(3), 1994).
        let grazing = 1.0 - (-along.dot(&normal)).clamp(0.0, 1.0);
        let grazing2 = grazing * grazing;
        let mirror =
            strength + (1.0 - strength) * grazing2 * grazing2 * grazing * if blur > 0.1 { 0.3 } else { 1.0 };
        let shine = mirror * window(mirrored, blur);
        let colour = blend(colour, 1.0, palette[Material::Perfect as usize], shine);
        if solid.skin == Skin::Chrome {
            let others = self.solids.iter().filter(|s| s.skin != Skin::Chrome);
            return blend(colour, 1.0, self.trace(hit.point, mirrored, others, palette).0, mirror);
        }
        let room = mirror * (0.10 + 0.12 * smoothstep(-0.2, 0.6, mirrored[2]));
        blend(colour, 1.0, palette[Material::Perfect as usize], room)
    }

    /// The table, the backdrop, and behind the camera the dark of the room.
    fn room(&self, from: Vector3, along: Vector3, palette: &[Rgb]) -> (Rgb, Seen) {
        let to_table = -from[2] / along[2];
        let table = from + along * to_table;
        if to_table > 0.0 && table[1] < BACKDROP && table[1] > EYE[1] - 4.0 {
            let edge = 1.0 - 0.5 * gaussian(table[1], BACKDROP, 0.35);
            let light = self.light(table, Vector3::z(), None) * edge;
            return (body_colour(&wood(table), light, palette), Seen::Table);
        }
        let to_wall = (BACKDROP - from[1]) / along[1];
        if to_wall > 0.0 {
            let wall = from + along * to_wall;
            let light = self.light(wall, -Vector3::y(), None);
            // The window lights the middle of the backdrop most.
            let (dx, dz) = ((wall[0] + 0.6) / 4.8, (wall[2] - 2.0) / 3.6);
            let pool = 0.40 + 0.70 * gaussian((dx * dx + dz * dz).sqrt(), 0.0, 0.75);
            return (body_colour(&canvas(wall), light * pool, palette), Seen::Backdrop);
        }
        let dark = 0.05 + 0.10 * smoothstep(-0.1, 0.9, along[2]);
        (palette[Material::Perfect as usize].map(|v| v * dark as f32), Seen::Detail)
    }

    /// Irradiance on a surface; 1 is what the cards get.
    fn light(&self, point: Vector3, normal: Vector3, own: Option<&Solid>) -> f64 {
        let key = Vector3::from(KEY);
        let softness = (WINDOW.0 + WINDOW.1) / 2.0;
        let (mut lit, mut open) = (1.0, 1.0);
        for solid in &self.solids {
            // Nothing shades itself here, and the foot of the bowl is beneath it.
            let beneath = |own: &Solid| own.skin == Skin::Bowl && solid.skin == Skin::Foot;
            if own.is_some_and(|own| std::ptr::eq(own, solid) || beneath(own)) {
                continue;
            }
            lit *= 1.0 - solid.shadow(point, key, softness);
            open *= 1.0 - 0.85 * solid.occlusion(point, normal);
        }
        for card in &self.cards {
            lit *= 1.0 - card.shadow(point, key, softness);
            if normal[2] > 0.9 {
                open *= 1.0 - card.occlusion(point);
            }
        }
        // A surface that turns away loses the window bit by bit.
        let facing = normal.dot(&key);
        let facing = if facing > softness {
            facing
        } else if facing > -softness {
            (facing + softness) * (facing + softness) / (4.0 * softness)
        } else {
            0.0
        };
        KEY_LIGHT * facing * lit + ROOM_LIGHT * (0.62 + 0.38 * normal[2]) * open
    }
}

fn body_colour(body: &Body, light: f64, palette: &[Rgb]) -> Rgb {
    let light = light * body.depth;
    blend(
        palette[body.first as usize],
        light * (1.0 - body.share),
        palette[body.second as usize],
        light * body.share,
    )
}

fn blend(first: Rgb, a: f64, second: Rgb, b: f64) -> Rgb {
    std::array::from_fn(|c| first[c] * a as f32 + second[c] * b as f32)
}
