//! A night sky with stars and hot pixels, and greens that differ.

use darkroot_photo::{BlackLevel, Capture, Cfa, Counts, Layout, Mosaic, Size, WhiteLevel};

use super::{Mends, Wanted};
use crate::denoise::{Line, NoiseModel, Random, measured};
use crate::light::LinearLight;

pub(super) const SIZE: Size = Size { width: 600, height: 400 };
/// 3 electrons of read noise, 0.25 counts an electron.
pub(super) const ELECTRON: f32 = 0.25 / 16000.0;
const LINE: Line = Line { slope: ELECTRON, floor: 9.0 * ELECTRON * ELECTRON };
pub(super) const BLACK: f32 = 200.0;
const EVERYTHING: Wanted = Wanted { hot_pixels: true, banding: true };

/// Electrons as counts of a 14-bit sensor.
pub(super) fn capture(electrons: &[f32], seed: u64) -> Capture {
    let mut random = Random::new(seed);
    let count = |&n: &f32| {
        let noisy = n + (n.max(0.0) + 9.0).sqrt() * random.normal();
        (BLACK + 0.25 * noisy).round().clamp(0.0, BLACK + 16000.0) as u16
    };
    let samples = electrons.iter().map(count).collect();
    let counts =
        Counts::U16(Mosaic { size: SIZE, layout: Layout::Cfa(Cfa::parse("RGGB").unwrap()), samples });
    let (black, white) = (BlackLevel::uniform(BLACK), WhiteLevel([BLACK + 16000.0; 3]));
    Capture { black, white, ..Capture::bare(counts) }
}

pub(super) fn mends(capture: &Capture) -> Mends {
    let light = LinearLight::of(capture);
    let measured = measured(capture, &light, [1.0; 3]).unwrap();
    Mends::of((capture, &light), (&NoiseModel { channels: [LINE; 3] }, &measured), EVERYTHING)
}

/// Sky of 40 electrons with stars of some width (full, at half of the maximum) and colours at random places; the electrons, and
/// which pixels have light of a star.
fn sky(width: f32, seed: u64) -> (Vec<f32>, Vec<bool>) {
    let mut random = Random::new(seed);
    let (mut electrons, mut lit) = (vec![40f32; SIZE.area()], vec![false; SIZE.area()]);
    let sigma = width / 2.354_82;
    for _ in 0..500 {
        let (x, y) = (8.0 + 584.0 * random.uniform(), 8.0 + 384.0 * random.uniform());
        let peak = 100.0 * (7.0 * random.uniform()).exp();
        // Red, white or blue.
        let warmth = 0.6 + 0.8 * random.uniform();
        let colour = [0.5 * warmth, 1.0, 0.6 / warmth];
        for v in y as usize - 6..=y as usize + 6 {
            for u in x as usize - 6..=x as usize + 6 {
                let (dx, dy) = (u as f32 - x, v as f32 - y);
                let light = peak * (-(dx * dx + dy * dy) / (2.0 * sigma * sigma)).exp();
                electrons[v * SIZE.width + u] += light * colour[u % 2 + v % 2];
                lit[v * SIZE.width + u] |= light > 1.0;
            }
        }
    }
    (electrons, lit)
}

#[test]
fn stars_stay_and_hot_pixels_go() {
    for (i, width) in [1.2f32, 1.5, 2.0, 3.0].into_iter().enumerate() {
        let (mut electrons, lit) = sky(width, 3 + i as u64);
        let mut random = Random::new(77);
        let mut hot = Vec::new();
        while hot.len() < 150 {
            let (x, y) = (5 + (590.0 * random.uniform()) as usize, 5 + (390.0 * random.uniform()) as usize);
            let around = (y - 4..=y + 4).flat_map(|v| (x - 4..=x + 4).map(move |u| v * SIZE.width + u));
            let place = y * SIZE.width + x;
            if around.clone().any(|p| lit[p] || hot.contains(&p)) {
                continue;
            }
            electrons[place] += 400.0 * (4.0 * random.uniform()).exp();
            hot.push(place);
        }
        let mends = mends(&capture(&electrons, 9));
        let of_stars: Vec<_> = mends.pixels.iter().filter(|(place, _)| lit[*place]).collect();
        let found = mends.pixels.iter().filter(|(place, _)| hot.contains(place)).count();
        assert!(of_stars.is_empty(), "{width}: {of_stars:?}");
        assert_eq!(found, mends.pixels(), "{width}: others are no faults");
        assert!(found >= 140, "{width}: {found} of 150");
        for (place, light) in &mends.pixels {
            assert!((light / ELECTRON - 40.0).abs() < 20.0, "{place}: {}", light / ELECTRON);
        }
    }
}

#[test]
fn dead_pixels_go_and_an_even_field_is_left_alone() {
    let mut electrons = vec![4000f32; SIZE.area()];
    assert_eq!(mends(&capture(&electrons, 1)), Mends { width: SIZE.width, ..Mends::default() });
    for place in [60 * 600 + 31, 61 * 600 + 200, 300 * 600 + 500] {
        electrons[place] = 0.0;
    }
    let capture = capture(&electrons, 1);
    let mends = mends(&capture);
    assert_eq!(mends.pixels(), 3);
    let mut row = vec![0.0; 40];
    LinearLight::of(&capture).levelled(&capture.counts, 20, 60, &mut row);
    mends.row(20, 60, &mut row);
    assert!(row.iter().all(|v| (v / ELECTRON - 4000.0).abs() < 400.0), "{row:?}");
}

#[test]
fn greens_that_differ_become_alike_and_others_stay() {
    let field = |gain: f32| {
        let green = |x: usize, y: usize| if y.is_multiple_of(2) && !x.is_multiple_of(2) { gain } else { 1.0 };
        let electrons = |i: usize| {
            let (x, y) = (i % SIZE.width, i / SIZE.width);
            (2000.0 + 3.0 * x as f32 + 200.0 * (y as f32 * 0.3).sin()) * green(x, y)
        };
        mends(&capture(&(0..SIZE.area()).map(electrons).collect::<Vec<_>>(), 5))
    };
    assert_eq!(field(1.0).greens(), None);
    for gain in [0.97f32, 1.02] {
        let mends = field(gain);
        let factor = mends.greens().unwrap();
        assert!((factor * gain - 1.0).abs() < 2e-3, "{gain}: {factor}");
        // Greens of the first row lie on odd columns.
        let mut row = [1.0; 4];
        mends.row(2, 0, &mut row);
        assert!(row[0] == 1.0 && row[2] == 1.0 && (row[1] - gain.powf(-0.5)).abs() < 1e-3, "{row:?}");
    }
}
