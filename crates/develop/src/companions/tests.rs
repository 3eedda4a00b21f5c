use darkroot_photo::{BlackLevel, Capture, Cfa, Counts, Layout, Mosaic, Rect, Size, WhiteLevel};

use super::*;
use crate::light::LinearLight;

const SIZE: Size = Size { width: 96, height: 64 };
const BLACK: f32 = 256.0;
const WHITE: f32 = 16_000.0;

/// Random numbers of 0..1, the same every time.
fn random(seed: usize) -> f32 {
    let mixed = (seed as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40) as f32 / (1u64 << 24) as f32
}

fn capture(letters: &str, count: impl Fn(usize, usize) -> f32) -> Capture {
    let samples = (0..SIZE.area()).map(|i| count(i % SIZE.width, i / SIZE.width).round() as u16).collect();
    let layout = Layout::Cfa(Cfa::parse(letters).unwrap());
    let mut capture = Capture::bare(Counts::U16(Mosaic { size: SIZE, layout, samples }));
    capture.black = BlackLevel::uniform(BLACK);
    capture.white = WhiteLevel([WHITE; 3]);
    capture.active_area = Rect { x: 6, y: 6, width: 84, height: 54 };
    capture
}

const XTRANS: &str = "GBGGRGRGRBGBGBGGRGGRGGBGBGBRGRGRGGBG";
const ARRAYS: [&str; 2] = ["RGGB", XTRANS];

fn at(capture: &Capture, x: usize, y: usize) -> f32 {
    match &capture.counts {
        Counts::U16(m) => f32::from(m.samples[y * SIZE.width + x]),
        Counts::F32(m) => m.samples[y * SIZE.width + x],
    }
}

/// A fixed pattern in counts.
fn pattern(x: usize, y: usize) -> f32 {
    (60.0 * random(y * SIZE.width + x)).round() + x as f32
}

#[test]
fn the_pattern_of_the_sensor_is_gone_and_what_is_full_stays_full() {
    for letters in ARRAYS {
        let scene = |x: usize, y: usize| if x > 70 { WHITE } else { BLACK + 500.0 + 3.0 * y as f32 };
        let mut photo = capture(letters, |x, y| (scene(x, y) + pattern(x, y)).min(WHITE));
        // One of three frames was hit by a ray.
        let frames: Vec<Capture> = (0..3)
            .map(|i| {
                capture(letters, |x, y| BLACK + pattern(x, y) + if i == 1 && x == 20 { 3000.0 } else { 0.0 })
            })
            .collect();
        assert!(frames.iter().all(|frame| fits(frame, &photo)));
        assert_eq!(take_off(&mut photo, &frames), 0);
        for (x, y) in [(6, 6), (20, 30), (50, 59), (70, 20)] {
            assert_eq!(at(&photo, x, y), scene(x, y), "{letters} {x} {y}");
        }
        assert_eq!(at(&photo, 80, 30), WHITE);
        // Where no light falls, nothing is changed.
        assert_eq!(at(&photo, 2, 2), scene(2, 2) + pattern(2, 2));
    }
}

#[test]
fn a_pixel_that_is_hot_takes_the_light_of_its_own_colour_around() {
    for letters in ARRAYS {
        let cfa = Cfa::parse(letters).unwrap();
        let colour = |x, y| 1000.0 * (1.0 + cfa.at(x, y).plane().unwrap() as f32);
        let hot = |x, y| [(30, 30), (32, 30), (31, 41), (6, 6)].contains(&(x, y));
        let mut photo = capture(letters, |x, y| if hot(x, y) { WHITE } else { BLACK + colour(x, y) });
        let dark = capture(letters, |x, y| if hot(x, y) { 9000.0 } else { BLACK });
        assert_eq!(take_off(&mut photo, &[dark]), 4);
        for (x, y) in [(30, 30), (32, 30), (31, 41), (6, 6), (33, 33)] {
            assert_eq!(at(&photo, x, y), BLACK + colour(x, y), "{letters} {x} {y}");
        }
    }
}

/// Light of a capture after its corrections.
fn light(capture: &Capture, y: usize) -> Vec<f32> {
    let mut row = vec![0.0; capture.active_area.width];
    LinearLight::of(capture).row(&capture.counts, capture.active_area.x, y, &mut row);
    row
}

#[test]
fn shading_is_evened_out_channel_by_channel() {
    for letters in ARRAYS {
        let cfa = Cfa::parse(letters).unwrap();
        // Falls to the right, more so in blue, and has a white balance of its own.
        let shade = |x: usize, y: usize| {
            let plane = cfa.at(x, y).plane().unwrap() as f32;
            (0.9 - 0.2 * plane)
                * (1.0 - (0.3 + 0.1 * plane) * x as f32 / 96.0)
                * (1.0 - 0.2 * y as f32 / 64.0)
        };
        let range = WHITE - BLACK;
        let flat = |i: usize| {
            let noise = move |x, y| 40.0 * (random(i * 7919 + y * 96 + x) - 0.5);
            capture(letters, move |x, y| BLACK + 0.8 * range * shade(x, y) + noise(x, y))
        };
        let flats: Vec<Capture> = (0..3).map(flat).collect();
        let mut photo = capture(letters, |x, y| BLACK + 0.3 * range * shade(x, y));
        even_out(&mut photo, &flats).unwrap();
        let mut means = [[f32::MAX, 0f32]; 3];
        for y in 16..50 {
            for (x, v) in light(&photo, y).into_iter().enumerate().skip(9).take(66) {
                let [least, most] = &mut means[cfa.at(x + 6, y).plane().unwrap()];
                (*least, *most) = (least.min(v), most.max(v));
            }
        }
        for (plane, [least, most]) in means.into_iter().enumerate() {
            // Blocks are a fifth of this small frame, and hold samples of a position every six pixels under X-Trans.
            assert!(most < 1.04 * least, "{letters} {plane}: {least} {most}");
            // As bright as where the flat is brightest.
            let brightest = 0.3 * (0.9 - 0.2 * plane as f32);
            assert!(most < brightest * 1.01 && least > brightest * 0.8, "{letters} {plane}: {least} {most}");
        }
    }
}

#[test]
fn flats_that_tell_nothing_are_refused() {
    let flat = |light: f32| capture("RGGB", move |_, _| BLACK + light * (WHITE - BLACK));
    let mut photo = flat(0.3);
    assert_eq!(even_out(&mut photo, &[flat(0.005)]), Err(FlatFault::Dark));
    assert_eq!(even_out(&mut photo, &[flat(1.0)]), Err(FlatFault::Clipped));
    assert!(photo.mosaic_corrections.is_empty());
    assert_eq!(even_out(&mut photo, &[flat(0.5)]), Ok(()));
}
