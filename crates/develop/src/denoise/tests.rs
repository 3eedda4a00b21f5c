//! The fast filter against the slow one, and what it promises.

use std::sync::Arc;

use darkroot_photo::{BlackLevel, Capture, Cfa, Counts, Layout, Mosaic, Rect, Size, WhiteLevel};

use super::{Asked, Denoiser, Line, NoiseModel, Scratch, Strength, slow};
use crate::light::LinearLight;
use crate::recipe::DenoiseBy;
use crate::view::Cancel;

/// Numbers between 0 and 1, the same on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn uniform(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 40) as f32 + 0.5) / (1u64 << 24) as f32
    }

    /// Normal, of variance 1.
    pub(crate) fn normal(&mut self) -> f32 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (std::f32::consts::TAU * self.uniform()).cos()
    }
}

const LINE: Line = Line { slope: 2e-4, floor: 4e-7 };

fn model() -> NoiseModel {
    NoiseModel { channels: [LINE; 3] }
}

/// Light as `scene` says for a column and row, with noise.
fn capture(letters: &str, size: Size, seed: u64, scene: impl Fn(usize, usize) -> f32) -> Capture {
    let mut random = Random::new(seed);
    let sample = |i: usize| {
        let light = scene(i % size.width, i / size.width);
        light + LINE.at(light).sqrt() * random.normal()
    };
    let samples = (0..size.area()).map(sample).collect();
    let layout = Layout::Cfa(Cfa::parse(letters).unwrap());
    let counts = Counts::F32(Mosaic { size, layout, samples });
    Capture { black: BlackLevel::uniform(0.0), white: WhiteLevel([1.0; 3]), ..Capture::bare(counts) }
}

/// Both ways.
const WAYS: [DenoiseBy; 2] = [DenoiseBy::Scales, DenoiseBy::Likeness];

fn filter(capture: &Capture, by: DenoiseBy, strength: f32) -> Denoiser {
    let strength = Strength { luma: strength, chroma: strength };
    let mends = Arc::default();
    let asked =
        Asked { by, model: model(), multipliers: [2.0, 1.0, 1.5], strength, limits: [0.98; 3], mends };
    Denoiser::of(capture, asked).unwrap()
}

/// A rectangle of the frame, denoised.
fn denoised(filter: &Denoiser, capture: &Capture, rect: Rect) -> Vec<f32> {
    let light = LinearLight::of(capture);
    let of_frame = filter.of_frame((capture, &light), rect, &Cancel::default()).unwrap();
    let mut scratch = Scratch::default();
    filter.denoise((capture, &light), &of_frame, rect, &mut scratch);
    let mut out = vec![0.0; rect.width * rect.height];
    for (i, row) in out.chunks_exact_mut(rect.width).enumerate() {
        scratch.row(rect.x, rect.y + i, row);
    }
    out
}

/// Shading, an edge and texture.
fn scene(x: usize, y: usize) -> f32 {
    let edge = if x + y / 2 > 60 { 0.3 } else { 0.05 };
    edge + 0.001 * x as f32 + 0.02 * ((x * x + 3 * y) as f32 * 0.7).sin()
}

#[test]
fn the_fast_filter_does_what_the_slow_one_does() {
    for (i, letters) in ["RGGB", "GRBG", "GBRG", "BGGR"].into_iter().enumerate() {
        let size = Size { width: 90 + i, height: 75 - i };
        let mut capture = capture(letters, size, i as u64, scene);
        // An area that begins at an odd place, and a sample that clips.
        capture.active_area = Rect { x: 1 + i % 2, y: i / 2, width: size.width - 4, height: size.height - 3 };
        if let Counts::F32(mosaic) = &mut capture.counts {
            mosaic.samples[40 * size.width + 41] = 0.99;
        }
        for strength in [1.0, 0.4] {
            let filter = filter(&capture, DenoiseBy::Scales, strength);
            let fast = denoised(&filter, &capture, capture.active_area);
            let slow = slow::denoised(&filter, &capture, &LinearLight::of(&capture));
            for (i, (fast, slow)) in fast.iter().zip(&slow).enumerate() {
                assert!((fast - slow).abs() < 3e-6, "{letters} {strength} at {i}: {fast} {slow}");
            }
        }
    }
}

#[test]
fn a_rectangle_is_that_rectangle_of_the_whole() {
    let mut capture = capture("GRBG", Size { width: 633, height: 393 }, 7, scene);
    capture.active_area = Rect { x: 1, y: 2, width: 631, height: 391 };
    let (left, top, width, _) = (1, 2, 631, 391);
    for by in WAYS {
        let whole = denoised(&filter(&capture, by, 1.0), &capture, capture.active_area);
        for rect in [
            Rect { x: 1, y: 2, width: 5, height: 3 },
            Rect { x: 237, y: 141, width: 30, height: 22 },
            Rect { x: 500, y: 2, width: 132, height: 391 },
            Rect { x: 631, y: 392, width: 1, height: 1 },
        ] {
            let part = denoised(&filter(&capture, by, 1.0), &capture, rect);
            for (y, row) in part.chunks_exact(rect.width).enumerate() {
                let start = (rect.y + y - top) * width + rect.x - left;
                assert_eq!(row, &whole[start..start + rect.width], "{by:?} {rect:?} row {y}");
            }
        }
    }
}

#[test]
fn a_frame_of_several_slabs_has_no_seams() {
    // One slab is 1024 rows.
    let capture = capture("BGGR", Size { width: 72, height: 1250 }, 19, scene);
    let all = denoised(&filter(&capture, DenoiseBy::Likeness, 1.0), &capture, capture.active_area);
    let rect = Rect { x: 0, y: 950, width: 72, height: 200 };
    let part = denoised(&filter(&capture, DenoiseBy::Likeness, 1.0), &capture, rect);
    assert_eq!(part, all[950 * 72..1150 * 72]);
}

#[test]
fn threads_have_no_say() {
    let capture = capture("RGGB", Size { width: 300, height: 420 }, 2, scene);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| denoised(&filter(&capture, DenoiseBy::Likeness, 1.0), &capture, capture.active_area))
    };
    assert!(with(1) == with(5));
}

#[test]
fn what_is_known_of_a_part_serves_what_lies_inside_of_it() {
    let capture = capture("RGGB", Size { width: 300, height: 200 }, 2, scene);
    let filter = filter(&capture, DenoiseBy::Likeness, 1.0);
    let light = LinearLight::of(&capture);
    let known = |x: usize, width: usize| {
        let rect = Rect { x, y: 20, width, height: 40 };
        match filter.of_frame((&capture, &light), rect, &Cancel::default()).unwrap() {
            super::OfFrame::Clean(clean) => Arc::as_ptr(&clean),
            _ => panic!("Bayer frames of this size are compared"),
        }
    };
    let first = known(100, 80);
    assert!(known(121, 33) == first && known(99, 10) != first);
}

#[test]
fn a_cancelled_search_ends() {
    let capture = capture("RGGB", Size { width: 300, height: 200 }, 2, scene);
    let cancel = Cancel::default();
    cancel.cancel();
    let filter = filter(&capture, DenoiseBy::Likeness, 1.0);
    let of_frame = filter.of_frame((&capture, &LinearLight::of(&capture)), capture.active_area, &cancel);
    assert!(of_frame.is_err());
}

#[test]
fn likeness_tells_more_than_scales() {
    // Stripes, an edge, and even places.
    let stripes = |x: usize, y: usize| {
        let wave = if y < 128 { 0.03 * (0.5 * x as f32 + 0.2 * y as f32).sin() } else { 0.0 };
        if x > 128 { 0.2 + wave } else { 0.06 + wave }
    };
    let size = Size { width: 256, height: 256 };
    let capture = capture("RGGB", size, 31, stripes);
    let error = |by: DenoiseBy| {
        let clean = denoised(&filter(&capture, by, 1.0), &capture, capture.active_area);
        let square = |(i, v): (usize, &f32)| f64::from(v - stripes(i % 256, i / 256)).powi(2);
        clean.iter().enumerate().map(square).sum::<f64>()
    };
    let [scales, likeness] = WAYS.map(error);
    assert!(likeness < 0.6 * scales, "{likeness} {scales}");
}

#[test]
fn small_frames_are_cleaned_too() {
    for (width, height) in [(4, 4), (63, 200), (64, 64), (65, 67)] {
        let capture = capture("RGGB", Size { width, height }, 6, |_, _| 0.1);
        let clean = denoised(&filter(&capture, DenoiseBy::Likeness, 1.0), &capture, capture.active_area);
        let power = clean.iter().map(|v| (v - 0.1).powi(2)).sum::<f32>() / clean.len() as f32;
        assert!(power < 0.8 * LINE.at(0.1), "{width} x {height}: {power}");
    }
}

#[test]
fn flat_patches_keep_their_mean_and_lose_their_noise() {
    let size = Size { width: 512, height: 512 };
    // 5000, 250, 25 and 5 electrons.
    for (light, most) in [(0.9, 0.001), (0.05, 0.001), (5e-3, 0.003), (1e-3, 0.02)] {
        let capture = capture("RGGB", size, 11, |_, _| light);
        let Counts::F32(noisy) = &capture.counts else { panic!() };
        let mean = |v: &[f32]| v.iter().map(|v| f64::from(*v)).sum::<f64>() / v.len() as f64;
        for (by, share) in WAYS.into_iter().zip([0.05, 0.01]) {
            let clean = denoised(&filter(&capture, by, 1.0), &capture, capture.active_area);
            let (before, after) = (mean(&noisy.samples), mean(&clean));
            assert!((after / before - 1.0).abs() < most, "{by:?} {light}: {before} {after}");
            let variance = mean(&clean.iter().map(|v| (v - after as f32).powi(2)).collect::<Vec<_>>());
            assert!(variance < share * f64::from(LINE.at(light)), "{by:?} {light}: {variance:e}");
        }
    }
}

#[test]
fn what_is_left_of_noise_is_known() {
    let capture = capture("RGGB", Size { width: 256, height: 256 }, 41, |_, _| 0.3);
    for strength in [0.25, 0.5, 0.75, 1.0] {
        let filter = filter(&capture, DenoiseBy::Likeness, strength);
        let clean = denoised(&filter, &capture, capture.active_area);
        let power = clean.iter().map(|v| (v - 0.3).powi(2)).sum::<f32>() / clean.len() as f32;
        let left = power / LINE.at(0.3);
        assert!((left - filter.left()).abs() < 0.05, "{strength}: {left} {}", filter.left());
    }
}

#[test]
fn texture_keeps_its_mean_too() {
    // Far above the noise: nearly nothing is taken away, and nothing is added for it.
    let texture = |x: usize, y: usize| if (x / 2 + y / 2).is_multiple_of(2) { 0.02 } else { 0.08 };
    let capture = capture("RGGB", Size { width: 256, height: 256 }, 3, texture);
    for by in WAYS {
        let clean = denoised(&filter(&capture, by, 1.0), &capture, capture.active_area);
        let mean = clean.iter().map(|v| f64::from(*v)).sum::<f64>() / clean.len() as f64;
        assert!((mean / 0.05 - 1.0).abs() < 0.001, "{by:?}: {mean}");
    }
}

#[test]
fn twice_the_light_with_its_noise_is_twice_the_result() {
    let size = Size { width: 96, height: 80 };
    let one = capture("BGGR", size, 5, scene);
    let mut two = one.clone();
    let Counts::F32(mosaic) = &mut two.counts else { panic!() };
    mosaic.samples.iter_mut().for_each(|v| *v *= 4.0);
    let filter_of = |capture: &Capture, by: DenoiseBy, factor: f32| {
        let line = Line { slope: LINE.slope * factor, floor: LINE.floor * factor * factor };
        let asked = Asked {
            by,
            model: NoiseModel { channels: [line; 3] },
            multipliers: [2.0, 1.0, 1.5],
            strength: Strength { luma: 1.0, chroma: 1.0 },
            limits: [factor; 3],
            mends: Arc::default(),
        };
        Denoiser::of(capture, asked).unwrap()
    };
    for by in WAYS {
        let [before, after] = [(&one, 1.0), (&two, 4.0)]
            .map(|(capture, factor)| denoised(&filter_of(capture, by, factor), capture, capture.active_area));
        for (before, after) in before.iter().zip(&after) {
            assert!((4.0 * before - after).abs() < 1e-5, "{by:?} {before} {after}");
        }
    }
}

/// That a measured model tells the noise that was added, at some lights.
fn assert_is_line(model: &NoiseModel, lights: [f32; 3]) {
    for line in model.channels {
        for light in lights {
            let ratio = line.at(light) / LINE.at(light);
            assert!((ratio - 1.0).abs() < 0.25, "{light}: {ratio}");
        }
    }
}

#[test]
fn the_noise_that_was_added_is_measured() {
    let size = Size { width: 1024, height: 768 };
    // A ramp with a texture in half of it.
    let ramp = |x: usize, y: usize| {
        let texture = if y < 384 { 0.05 * ((x * 7 + y * 13) as f32).sin() } else { 0.0 };
        0.7 * x as f32 / 1024.0 * (1.0 + texture)
    };
    let capture = capture("RGGB", size, 23, ramp);
    let measured = super::measured(&capture, &LinearLight::of(&capture), [1.0; 3]).unwrap();
    assert_is_line(&measured.model, [0.01, 0.1, 0.6]);
}

#[test]
fn a_strength_of_0_has_no_filter() {
    let capture = Arc::new(capture("RGGB", Size { width: 16, height: 16 }, 1, |_, _| 0.1));
    let asked = Asked {
        by: DenoiseBy::Scales,
        model: model(),
        multipliers: [1.0; 3],
        strength: Strength { luma: 0.0, chroma: 0.0 },
        limits: [1.0; 3],
        mends: Arc::default(),
    };
    assert!(Denoiser::of(&capture, asked).is_none());
}

const X_TRANS: &str = "GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG";

#[test]
fn x_trans_loses_noise_keeps_means_and_has_no_seams() {
    let size = Size { width: 301, height: 203 };
    let mut noisy = capture(X_TRANS, size, 13, |_, _| 0.05);
    noisy.active_area = Rect { x: 1, y: 2, width: 299, height: 200 };
    let filter = filter(&noisy, DenoiseBy::Likeness, 1.0);
    let whole = denoised(&filter, &noisy, noisy.active_area);
    let Counts::F32(mosaic) = &noisy.counts else { panic!() };
    let mean = |v: &[f32]| v.iter().map(|v| f64::from(*v)).sum::<f64>() / v.len() as f64;
    assert!((mean(&whole) / mean(&mosaic.samples) - 1.0).abs() < 1e-3);
    let variance = mean(&whole.iter().map(|v| (v - 0.05f32).powi(2)).collect::<Vec<_>>());
    assert!(variance < 0.25 * f64::from(LINE.at(0.05)), "{}", variance / f64::from(LINE.at(0.05)));
    let rect = Rect { x: 97, y: 55, width: 31, height: 18 };
    for (y, row) in denoised(&filter, &noisy, rect).chunks_exact(rect.width).enumerate() {
        let start = (rect.y - 2 + y) * 299 + rect.x - 1;
        assert_eq!(row, &whole[start..start + rect.width], "row {y}");
    }
}

#[test]
fn the_noise_under_x_trans_is_measured() {
    let ramp = |x: usize, _: usize| 0.7 * x as f32 / 900.0;
    let capture = capture(X_TRANS, Size { width: 900, height: 600 }, 29, ramp);
    let measured = super::measured(&capture, &LinearLight::of(&capture), [1.0; 3]).unwrap();
    assert_is_line(&measured.model, [0.02, 0.1, 0.6]);
}

#[test]
fn a_frame_that_is_narrower_or_lower_than_a_window_tells_nothing() {
    for letters in ["RGGB", X_TRANS] {
        for (width, height) in [(1, 1000), (12, 2000), (1000, 1), (2000, 12)] {
            let seen = capture(letters, Size { width, height }, 4, scene);
            let light = LinearLight::of(&seen);
            assert!(super::measured(&seen, &light, [1.0; 3]).is_none(), "{letters} {width} x {height}");
        }
    }
}
