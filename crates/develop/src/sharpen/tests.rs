use darkroot_photo::{CameraSpace, Rgb, Size};

use super::{BORDER, Scratch, Sharpener, sharpen, slow};
use crate::denoise::{Line, NoiseModel};

const SIZE: Size = Size { width: 45, height: 38 };

/// Evenly spread numbers from 0 to 1.
fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// Edges, lines, dots, noise, and places without light or with less.
fn busy() -> Rgb<CameraSpace> {
    let mut random = numbers(5);
    let mut picture = Rgb::black(SIZE);
    for (c, plane) in picture.planes_mut().into_iter().enumerate() {
        for (i, v) in plane.iter_mut().enumerate() {
            let (x, y) = (i % SIZE.width, i / SIZE.width);
            let edge = if x * 3 + y > 70 { 0.6 } else { 0.02 };
            let line = if (x + 2 * y) % 17 == c { 0.2 } else { 0.0 };
            let black = if y > 30 { -0.05 } else { 0.0 };
            *v = edge + line + black + 0.02 * (random() - 0.5);
        }
    }
    picture
}

fn noise() -> NoiseModel {
    NoiseModel { channels: [Line { slope: 1e-5, floor: 1e-6 }; 3] }
}

fn sharpened(picture: &Rgb<CameraSpace>, sharpener: &Sharpener) -> Rgb<CameraSpace> {
    let mut out = Rgb::black(Size { width: 0, height: 0 });
    sharpen(picture, sharpener, &mut Scratch::default(), &mut out);
    out
}

#[test]
fn the_stage_is_what_its_definition_says() {
    let picture = busy();
    for (blur, amount, noise, white) in [
        (0.5, 1.0, None, f32::INFINITY),
        (0.8, 1.7, Some(noise()), 0.7),
        (0.35, 0.4, Some(noise()), f32::INFINITY),
    ] {
        let sharpener = Sharpener::of(blur, amount, noise, [2.1, 1.0, 1.6], white);
        let fast = sharpened(&picture, &sharpener);
        assert_eq!(fast.size(), Size { width: SIZE.width - 2 * BORDER, height: SIZE.height - 2 * BORDER });
        for y in 0..fast.size().height {
            for x in 0..fast.size().width {
                let slow = slow::sharpened(&picture, &sharpener, (x + BORDER, y + BORDER));
                for (plane, slow) in fast.planes().into_iter().zip(slow) {
                    let v = plane[y * fast.size().width + x];
                    assert!((v - slow).abs() < 2e-5, "{x} {y}: {v} {slow}");
                }
            }
        }
    }
}

#[test]
fn twice_the_light_is_twice_the_picture() {
    let picture = busy();
    let mut twice = picture.clone();
    twice.planes_mut().into_iter().flatten().for_each(|v| *v *= 2.0);
    let sharpener = Sharpener::of(0.6, 1.0, None, [1.0; 3], f32::INFINITY);
    let (one, two) = (sharpened(&picture, &sharpener), sharpened(&twice, &sharpener));
    for (one, two) in one.planes().into_iter().flatten().zip(two.planes().into_iter().flatten()) {
        assert_eq!(2.0 * one, *two);
    }
}

#[test]
fn an_even_field_stays() {
    let mut picture = Rgb::black(SIZE);
    for (plane, v) in picture.planes_mut().into_iter().zip([0.2, 0.4, 0.3]) {
        plane.fill(v);
    }
    let out = sharpened(&picture, &Sharpener::of(0.8, 2.0, None, [1.0; 3], f32::INFINITY));
    for (plane, v) in out.planes().into_iter().zip([0.2, 0.4, 0.3]) {
        assert!(plane.iter().all(|w| (w / v - 1.0).abs() < 1e-5));
    }
}

#[test]
fn guessed_highlights_give_no_dark_dots() {
    // Between rebuilt highlights of many times white lie pixels that are just white, or a little darker.
    let mut picture = Rgb::black(SIZE);
    for plane in picture.planes_mut() {
        plane.fill(6.0);
        for (i, v) in [(700, 1.0), (745, 1.1), (990, 0.8)] {
            plane[i] = v;
        }
    }
    let out = sharpened(&picture, &Sharpener::of(0.8, 1.0, None, [1.0; 3], 1.0));
    let darkest = out.planes()[1].iter().copied().fold(f32::MAX, f32::min);
    assert!(darkest > 0.65, "{darkest}");
    // Nor where nobody knows what is white.
    let out = sharpened(&picture, &Sharpener::of(0.8, 1.0, None, [1.0; 3], f32::INFINITY));
    let darkest = out.planes()[1].iter().copied().fold(f32::MAX, f32::min);
    assert!(darkest > 0.25, "{darkest}");
}
