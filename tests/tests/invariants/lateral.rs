//! Lateral chromatic aberration: what the mosaic shows for certain is undone, everything else is left bit for bit.

use std::sync::Arc;

use darkroot_develop::{Analysis, Bits, Geometry, Lens, Recipe};
use darkroot_photo::{Capture, Counts, Layout, Picture, Size};
use darkroot_simulate::Exposure;
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_tests::{
    camera, develop, flat_grey, measuring, output, pixels, plan, rendered, rendered_in_tiles, with_light,
};

const SIZE: Size = Size { width: 960, height: 640 };
const HALF: [f64; 2] = [480.0, 320.0];

/// What a scene is made of.
#[derive(Clone, Copy)]
struct Simulated {
    /// Seed of its shapes and colours.
    seed: u64,
    /// How strong its colours are, 0 (grey) to 1.
    colour: f64,
    /// Displacement of red over the distance from the middle: k0 + k1 r^2 pixels, r = 1 in the corners; that of blue is -0.6
    /// times as large.
    lens: [f64; 2],
    /// Electrons at saturation; 0 for no noise.
    electrons: f64,
}

/// Even numbers in 0..1 (Steele, Lea and Flood, OOPSLA 2014: SplitMix64).
fn even(seed: u64) -> f64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Shapes with edges of about a pixel, of colours that differ from place to place, with fine texture.
fn scene(Simulated { seed, colour, .. }: &Simulated, [x, y]: [f64; 2]) -> [f64; 3] {
    let of = |i: u64| even(seed * 1000 + i);
    let wave = |i: u64, period: f64| {
        let turn = std::f64::consts::TAU * of(i);
        let along = x * turn.cos() + y * turn.sin();
        (std::f64::consts::TAU * (along / (period * (0.8 + 0.4 * of(i + 50))) + of(i + 100))).sin()
    };
    let shape = |i: u64| 0.5 + 0.5 * (3.5 * (0..3).map(|k| wave(i + k, 37.0)).sum::<f64>()).tanh();
    let shapes = [shape(0), shape(10), shape(20)];
    let texture = 1.0 + 0.06 * wave(30, 6.0) * wave(31, 7.0);
    [0, 1, 2].map(|c| {
        let slow = 0.5 + 0.5 * wave(40 + c, 500.0);
        let own = |i: u64| 1.0 + colour * (even(seed * 77 + 10 * i + c) - 0.5) * 1.2;
        let light = 0.06 + 0.3 * shapes[0] * own(1) + 0.15 * shapes[1] * own(2) * slow.powf(*colour);
        light * (1.0 - 0.6 * shapes[2] * own(3)).max(0.1) * texture
    })
}

impl Simulated {
    fn displaced(&self, c: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let (u, v) = ((x - HALF[0]) / HALF[0].hypot(HALF[1]), (y - HALF[1]) / HALF[0].hypot(HALF[1]));
        let factor = [1.0, 0.0, -0.6][c] * (self.lens[0] + self.lens[1] * (u * u + v * v));
        [x + factor * u, y + factor * v]
    }

    fn capture(&self, layout: Layout) -> Capture {
        let neutral = camera(layout.clone()).neutral(&Exposure::default().light);
        with_light(flat_grey(layout.clone(), SIZE, 0.5), |x, y| {
            // The others are behind no filter here.
            let own = |c: usize| matches!(&layout, Layout::Cfa(cfa) if cfa.at(x, y).plane() == Some(c));
            let at = [x as f64 + 0.5, y as f64 + 0.5];
            let [red, green, blue] = [0, 1, 2].map(|c| {
                if !own(c) {
                    return 0.0;
                }
                let back = self.displaced(c, at);
                // What lies here came from where the lens displaces it from.
                let from = [2.0 * at[0] - back[0], 2.0 * at[1] - back[1]];
                let light = scene(self, from)[c] * neutral[c];
                if self.electrons <= 0.0 {
                    return light;
                }
                let at = (self.seed << 40) + ((y * SIZE.width + x) as u64) * 64 + 16 * c as u64;
                let normal = (0..12).map(|i| even(at + i)).sum::<f64>() - 6.0;
                light + normal * (light / self.electrons + 9.0 / self.electrons.powi(2)).sqrt()
            });
            [red as f32, green as f32, blue as f32]
        })
    }
}

fn recipe(geometry: Geometry) -> Recipe {
    let space = darkroot_colour::RgbSpace::SRGB;
    Recipe { geometry, output: output(space, Bits::Float), ..Recipe::default() }
}

fn kept() -> Recipe {
    recipe(Geometry { keep_fringes: true, ..Geometry::default() })
}

fn corrected(capture: &Capture) -> Picture {
    develop(capture, None, &recipe(Geometry::default()))
}

/// By how much a colour lies outside of where it lies in another picture, along the radius, where r is in a range: the shift
/// that explains most of the difference.
fn outside(picture: &Picture, truth: &Picture, c: usize, radii: std::ops::Range<f64>) -> f64 {
    let (picture, truth) = (pixels(picture), pixels(truth));
    let (mut sum, mut slopes) = (0.0, 0.0);
    for y in 2..SIZE.height - 2 {
        for x in 2..SIZE.width - 2 {
            let (u, v) = (x as f64 + 0.5 - HALF[0], y as f64 + 0.5 - HALF[1]);
            let r = u.hypot(v);
            if !radii.contains(&(r / HALF[0].hypot(HALF[1]))) {
                continue;
            }
            let at = y * SIZE.width + x;
            let across = 0.5 * (truth[at + 1][c] - truth[at - 1][c]);
            let down = 0.5 * (truth[at + SIZE.width][c] - truth[at - SIZE.width][c]);
            let slope = (u * across + v * down) / r;
            sum -= slope * (picture[at][c] - truth[at][c]);
            slopes += slope * slope;
        }
    }
    sum / slopes
}

fn error(picture: &Picture, truth: &Picture) -> f64 {
    let pairs = pixels(picture).into_iter().zip(pixels(truth));
    let square = |(a, b): ([f64; 3], [f64; 3])| (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>() / 3.0;
    -10.0 * (pairs.map(square).sum::<f64>() / SIZE.area() as f64).log10()
}

#[test]
fn what_a_lens_moved_apart_is_brought_together() {
    for (letters, seed, lens, electrons) in [
        ("RGGB", 1, [0.5, 1.0], 0.0),
        ("GRBG", 2, [0.0, 0.4], 20_000.0),
        ("BGGR", 3, [2.0, -0.5], 4_000.0),
        ("GBRG", 4, [-0.4, 0.0], 4_000.0),
    ] {
        let simulated = Simulated { seed, colour: 0.3, lens, electrons };
        let capture = simulated.capture(filters(letters));
        let truth =
            develop(&Simulated { lens: [0.0; 2], ..simulated }.capture(filters(letters)), None, &kept());
        let (on, off) = (corrected(&capture), develop(&capture, None, &kept()));
        let found = Analysis::deferred(Arc::new(capture)).lateral().unwrap();
        let corner = lens[0] + lens[1];
        println!("{letters}: {corner}, found {:?}", found.corners());
        for (c, share) in [(0, 1.0), (2, -0.6)] {
            let radii = 0.8..1.0;
            let (before, after) = (outside(&off, &truth, c, radii.clone()), outside(&on, &truth, c, radii));
            println!("  colour {c}: {before} to {after}");
            // Colours are mixed in the picture, and interpolation lets them follow green.
            assert!(
                before * share * corner.signum() > 0.15 * corner.abs() * f64::abs(share),
                "{letters} {c}: {before}"
            );
            // What is small is not certain, and left.
            let most = if f64::abs(share) * corner.abs() < 0.3 { before.abs() + 0.05 } else { 0.11 };
            assert!(after.abs() < most, "{letters} {c}: {before} to {after}");
        }
        let (before, after) = (error(&off, &truth), error(&on, &truth));
        println!("  {before} dB to {after} dB");
        assert!(after > before + 2.0, "{letters}: {before} to {after}");
    }
}

#[test]
fn a_lens_without_it_is_left_bit_for_bit() {
    for (seed, colour, electrons) in [(5, 0.0, 0.0), (6, 0.4, 20_000.0), (7, 0.4, 2_000.0)] {
        let simulated = Simulated { seed, colour, lens: [0.0; 2], electrons };
        let capture = simulated.capture(filters("RGGB"));
        assert!(corrected(&capture) == develop(&capture, None, &kept()), "{seed}");
    }
}

#[test]
fn coloured_edges_are_no_aberration() {
    for seed in 10..18 {
        let colour = 0.5 + even(seed) / 2.0;
        let electrons = if seed % 2 == 0 { 0.0 } else { 5_000.0 };
        let capture = Simulated { seed, colour, lens: [0.0; 2], electrons }.capture(filters("RGGB"));
        let found = Analysis::deferred(Arc::new(capture)).lateral();
        assert!(found.is_none(), "{seed}: {found:?}");
    }
}

#[test]
fn grey_edges_get_grey() {
    let simulated = Simulated { seed: 30, colour: 0.0, lens: [0.3, 1.2], electrons: 0.0 };
    let capture = simulated.capture(filters("GRBG"));
    let colour = |picture: &Picture| {
        let of = |[r, g, b]: [f64; 3]| (r - g).powi(2) + (b - g).powi(2);
        (pixels(picture).into_iter().map(of).sum::<f64>() / SIZE.area() as f64).sqrt()
    };
    let (before, after) = (colour(&develop(&capture, None, &kept())), colour(&corrected(&capture)));
    println!("{before} to {after}");
    assert!(after < 0.35 * before, "{before} to {after}");
}

#[test]
fn tiles_of_a_corrected_picture_are_parts_of_it() {
    let simulated = Simulated { seed: 31, colour: 0.4, lens: [0.5, 1.0], electrons: 10_000.0 };
    let capture = simulated.capture(filters("GBRG"));
    let plan = plan(&capture, None, &recipe(Geometry::default())).unwrap();
    let whole = rendered(&plan);
    assert!(whole != develop(&capture, None, &kept()));
    for (columns, rows) in [(37, 91), (1000, 50)] {
        assert!(rendered_in_tiles(&plan, columns, rows) == whole, "{columns} {rows}");
    }
}

#[test]
fn who_measures_or_wants_none_gets_the_samples_where_they_are() {
    let simulated = Simulated { seed: 32, colour: 0.4, lens: [0.5, 1.0], electrons: 0.0 };
    let capture = simulated.capture(filters("RGGB"));
    let linear = Recipe { geometry: Geometry { keep_fringes: true, ..Geometry::default() }, ..measuring() };
    assert!(develop(&capture, None, &measuring()) == develop(&capture, None, &linear));
    let off = recipe(Geometry { lens: Lens::Off, ..Geometry::default() });
    assert!(develop(&capture, None, &off) == develop(&capture, None, &kept()));
    let noted = |recipe: &Recipe| {
        plan(&capture, None, recipe).unwrap().notes.iter().any(|note| note.contains("chromatic aberration"))
    };
    assert!(noted(&recipe(Geometry::default())) && !noted(&kept()) && !noted(&off));
}

#[test]
fn captures_that_tell_nothing_are_left() {
    let lens = Simulated { seed: 33, colour: 0.4, lens: [0.5, 1.0], electrons: 0.0 };
    let lateral = |capture: Capture| Analysis::deferred(Arc::new(capture)).lateral();
    assert!(lateral(lens.capture(x_trans())).is_none());
    for (width, height) in [(1, 1), (2, 2), (63, 64), (64, 64), (65, 700)] {
        let even = flat_grey(filters("RGGB"), Size { width, height }, 0.4);
        assert!(lateral(even).is_none());
    }
    let mut broken = lens.capture(filters("RGGB"));
    if let Counts::F32(mosaic) = &mut broken.counts {
        for (i, v) in mosaic.samples.iter_mut().enumerate() {
            *v = [*v, f32::NAN, f32::INFINITY, -1e30][i * 7 % 4];
        }
    }
    assert!(lateral(broken).is_none());
}
