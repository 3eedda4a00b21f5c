//! How far a picture leans: by edges that are nearly level or nearly upright.
//!
//! When edges are projected along their own direction, all of a line falls onto one place: of all angles the one with the largest
//! sum of squares of what falls together is that of most lines (as in W. Postl, "Detection of linear oblique structures and skew
//! scan in digitized documents", ICPR 1986). Level and upright edges are projected apart and must agree, or one of them must
//! be clear on its own.

use darkroot_photo::{Picture, Samples, Size};

/// How far a picture leans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tilt {
    /// Degrees by which it is to be turned clockwise to stand straight.
    pub degrees: f64,
    /// How far the angle stands out among others: times the usual spread between them.
    pub clearness: f64,
    /// Whether level lines (a horizon) tell it.
    pub level: bool,
    /// Whether upright lines (buildings) tell it.
    pub upright: bool,
}

/// Largest lean that is looked for, and steps between angles, degrees.
const MOST: f64 = 8.0;
const STEP: f64 = 0.1;
const ANGLES: usize = 161;
/// Edges must run this near to level or upright, degrees.
const NEAR: f64 = 12.0;
/// What the angle of an edge, by its own pixels, may differ from that of its line, degrees.
const SPREAD: f32 = 3.0;
/// Least clearness of an angle that is believed.
const CLEAR: f64 = 6.0;
/// Spread between angles that there is at least, as a share: at 0 whole rows fall together, which is no line.
const USUAL: f64 = 0.1;
/// An angle that stands out further is as clear as can be.
const CLEAREST: f64 = 40.0;
/// How much clearer one angle must be than another that contradicts it.
const MUCH: f64 = 4.0;
/// The same of one half of the picture.
const CLEAR_IN_HALF: f64 = 4.0;
const SAME_IN_HALF: f64 = 0.5;
/// What two angles may differ, degrees, to be the same.
const SAME: f64 = 0.4;
/// Rows and columns next to the borders that are not looked at, as a share.
const BORDER: f64 = 0.02;

/// Edges of one kind: where each is, and how strong.
struct Edges {
    /// Along the direction in which it runs, across it, its strength, and its own angle in degrees.
    at: Vec<[f32; 4]>,
    /// Pixels across.
    span: usize,
}

/// The lean of a picture of 300 to 3000 pixels a side in a space with a curve; `None` where nothing is sure.
pub fn tilt(picture: &Picture) -> Option<Tilt> {
    let light = lightness(picture)?;
    let edges = edges(&light, picture.size);
    let [level, upright] = [0, 1].map(|kind| peak(&edges[kind].at, edges[kind].span, CLEAR));
    let agree = level.zip(upright).filter(|(a, b)| (a.0 - b.0).abs() <= SAME);
    if let Some((a, b)) = agree {
        let degrees = (a.0 * a.1 + b.0 * b.1) / (a.1 + b.1);
        return Some(Tilt { degrees, clearness: a.1.max(b.1), level: true, upright: true });
    }
    // Where they contradict each other, one must be much clearer; and a wall that is seen from the side has its lines in one half
    // of the picture, or others in the other.
    let single = |found: Option<(f64, f64)>, other: Option<(f64, f64)>, kind: usize| {
        let (degrees, clearness) = found?;
        let beside = other.map_or(0.0, |(_, clearness)| clearness);
        let all_over = edges[kind].halves().iter().all(|half| {
            let found = peak(half, edges[kind].span, CLEAR_IN_HALF);
            found.is_some_and(|(of_half, _)| (of_half - degrees).abs() <= SAME_IN_HALF)
        });
        let found = Tilt { degrees, clearness, level: kind == 0, upright: kind == 1 };
        (all_over && clearness >= MUCH * beside).then_some(found)
    };
    single(level, upright, 0).or_else(|| single(upright, level, 1))
}

impl Edges {
    /// Those before the middle along the direction in which they run, and those behind it.
    fn halves(&self) -> [Vec<[f32; 4]>; 2] {
        let (before, behind) = self.at.iter().partition(|[along, ..]| *along < 0.0);
        [before, behind]
    }
}

fn lightness(picture: &Picture) -> Option<Vec<f32>> {
    let Samples::U8(samples) = &picture.samples else { return None };
    Some(
        samples
            .chunks_exact(3)
            .map(|p| 0.3 * f32::from(p[0]) + 0.6 * f32::from(p[1]) + 0.1 * f32::from(p[2]))
            .collect(),
    )
}

/// Edges that run nearly level, and those that run nearly upright.
fn edges(light: &[f32], Size { width, height }: Size) -> [Edges; 2] {
    let mut found = [Edges { at: Vec::new(), span: height }, Edges { at: Vec::new(), span: width }];
    let (left, top) = ((BORDER * width as f64) as usize + 2, (BORDER * height as f64) as usize + 2);
    let tangent = NEAR.to_radians().tan() as f32;
    for y in top..height.saturating_sub(top) {
        for x in left..width.saturating_sub(left) {
            let at =
                |dx: isize, dy: isize| light[y.wrapping_add_signed(dy) * width + x.wrapping_add_signed(dx)];
            // Scharr's masks, whose direction is right to a fraction of a degree.
            let side = |a: f32, b: f32, c: f32| 3.0 * a + 10.0 * b + 3.0 * c;
            let across = side(at(1, -1), at(1, 0), at(1, 1)) - side(at(-1, -1), at(-1, 0), at(-1, 1));
            let down = side(at(-1, 1), at(0, 1), at(1, 1)) - side(at(-1, -1), at(0, -1), at(1, -1));
            let strength = across.hypot(down) / 32.0;
            if strength < 3.0 {
                continue;
            }
            // Strong edges count no more than clear ones: a lamp is no horizon.
            let weight = strength.min(12.0);
            let (u, v) = (x as f32 - 0.5 * width as f32, y as f32 - 0.5 * height as f32);
            if across.abs() < tangent * down.abs() {
                found[0].at.push([u, v, weight, (-across / down).atan().to_degrees()]);
            } else if down.abs() < tangent * across.abs() {
                // Turned by a quarter, so that upright lines lean as level ones do.
                found[1].at.push([-v, u, weight, (down / across).atan().to_degrees()]);
            }
        }
    }
    found
}

/// The angle of most lines, degrees clockwise to turn, and how far it stands out.
fn peak(edges: &[[f32; 4]], span: usize, least: f64) -> Option<(f64, f64)> {
    if edges.len() < span {
        return None;
    }
    let angle = |i: usize| i as f64 * STEP - MOST;
    let scores: Vec<f64> = (0..ANGLES).map(|i| concentration(edges, span, angle(i))).collect();
    let best = (1..ANGLES - 1).max_by(|a, b| scores[*a].total_cmp(&scores[*b]))?;
    let mut sorted = scores.clone();
    sorted.sort_by(f64::total_cmp);
    let (middle, quarter) = (sorted[ANGLES / 2], sorted[ANGLES / 4]);
    let spread = (middle - quarter).max(USUAL * middle);
    let clearness = ((scores[best] - middle) / spread).min(CLEAREST);
    let [before, at, after] = [best - 1, best, best + 1].map(|i| scores[i]);
    // The top of the parabola through three.
    let bend = before - 2.0 * at + after;
    let within = if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
    (clearness >= least && best > 2 && best < ANGLES - 3)
        .then_some((-(angle(best) + within.clamp(-0.5, 0.5) * STEP), clearness))
}

/// How much of the edges falls together when they are projected along an angle.
fn concentration(edges: &[[f32; 4]], span: usize, degrees: f64) -> f64 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let (sine, cosine) = (sine as f32, cosine as f32);
    let middle = span as f32;
    let mut sums = vec![0f64; 2 * span + 2];
    // Edges that run another way are no part of a line: round things would have most at 0.
    let same_way = edges.iter().filter(|[.., own]| (own - degrees as f32).abs() < SPREAD);
    for [u, v, weight, _] in same_way {
        let place = (v * cosine - u * sine + middle).max(0.0);
        let (i, part) = (place as usize, place.fract());
        if i + 1 < sums.len() {
            sums[i] += f64::from(weight * (1.0 - part));
            sums[i + 1] += f64::from(weight * part);
        }
    }
    // At no angle but 0 do whole rows fall onto whole places: that must not show.
    for _ in 0..3 {
        sums = sums.windows(3).map(|w| 0.25 * w[0] + 0.5 * w[1] + 0.25 * w[2]).collect();
    }
    // What lies beside a line counts against it.
    sums.windows(3).map(|w| (w[1] - 0.5 * (w[0] + w[2])).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::RgbSpace;
    use darkroot_photo::PictureSpace;

    const SIZE: Size = Size { width: 600, height: 400 };

    /// A picture of brightness at each place about its middle, with some texture.
    fn picture(bright: impl Fn(f64, f64) -> f64) -> Picture {
        let mut samples = Vec::new();
        for y in 0..SIZE.height {
            for x in 0..SIZE.width {
                let texture = ((x * 7919 + y * 104_729 + x * y * 31) % 23) as f64 / 6.0;
                let light = bright(x as f64 - 300.0, y as f64 - 200.0) + texture;
                samples.extend([light.clamp(0.0, 255.0) as u8; 3]);
            }
        }
        Picture { size: SIZE, samples: Samples::U8(samples), space: PictureSpace::Rgb(RgbSpace::SRGB) }
    }

    /// From 0 to 1 where a distance becomes positive, as soft as a lens draws it.
    fn edge(distance: f64) -> f64 {
        1.0 / (1.0 + (-1.8 * distance).exp())
    }

    /// Bands of this width, as far apart.
    fn band(at: f64, width: f64) -> f64 {
        let at = at.rem_euclid(2.0 * width);
        edge(at) * edge(width - at) + edge(at - 2.0 * width)
    }

    fn leaning(degrees: f64) -> impl Fn(f64, f64) -> (f64, f64) {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        move |x, y| (x * cosine + y * sine, y * cosine - x * sine)
    }

    #[test]
    fn a_horizon_is_found_to_a_tenth_of_a_degree() {
        for degrees in [-5.3, -1.0, 0.0, 0.45, 2.7, 6.0] {
            let turned = leaning(degrees);
            let sea = picture(|x, y| 180.0 - 110.0 * edge(turned(x, y).1 - 30.0));
            let found = tilt(&sea).unwrap();
            assert!((found.degrees + degrees).abs() < 0.1 && found.level, "{degrees}: {found:?}");
        }
    }

    #[test]
    fn houses_are_found_by_both_kinds_of_lines() {
        for degrees in [-3.2, 1.4] {
            let turned = leaning(degrees);
            let front = picture(|x, y| {
                let (u, v) = turned(x, y);
                160.0 - 100.0 * band(u, 28.0) * band(v, 37.0)
            });
            let found = tilt(&front).unwrap();
            assert!((found.degrees + degrees).abs() < 0.1, "{degrees}: {found:?}");
            assert!(found.level && found.upright, "{found:?}");
        }
    }

    #[test]
    fn what_has_no_lines_has_no_tilt() {
        // Fruit.
        // Places without a common measure, in which nothing is in line.
        let part = |i: u32, step: f64| (f64::from(i * i + i) * step).fract();
        let disc = |i: u32| {
            [600.0 * part(i, 0.7548) - 300.0, 400.0 * part(i, 0.5698) - 200.0, 8.0 + 30.0 * part(i, 0.3819)]
        };
        let discs: Vec<[f64; 3]> = (0..60).map(disc).collect();
        let fruit = picture(|x, y| {
            discs.iter().enumerate().fold(60.0, |below, (i, [u, v, r])| {
                let over = edge(r - (x - u).hypot(y - v));
                below + over * (80.0 + 23.0 * (i % 7) as f64 - below)
            })
        });
        assert_eq!(tilt(&fruit), None);
        let round = picture(|x, y| 90.0 + 60.0 * band(x.hypot(y), 25.0));
        assert_eq!(tilt(&round), None);
        assert_eq!(tilt(&picture(|_, _| 128.0)), None);
    }

    #[test]
    fn a_wall_that_is_seen_from_the_side_is_no_horizon() {
        // All its lines go to one point far on the right.
        let wall = picture(|x, y| 160.0 - 90.0 * band((y - 40.0) * 700.0 / (700.0 - x), 20.0));
        assert_eq!(tilt(&wall), None);
        // A board in one half of the picture.
        let turned = leaning(4.0);
        let board = picture(|x, y| 160.0 - 90.0 * edge(turned(x, y).1) * edge(x - 20.0));
        assert_eq!(tilt(&board), None);
    }

    #[test]
    fn lines_that_contradict_each_other_tell_nothing() {
        let (one, two) = (leaning(3.0), leaning(-2.0));
        let both = picture(|x, y| 90.0 + 50.0 * band(one(x, y).1, 25.0) + 50.0 * band(two(x, y).0, 25.0));
        assert_eq!(tilt(&both), None);
    }
}
