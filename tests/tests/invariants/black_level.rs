//! Black and white level: no light is black and saturation is white, whatever the numbers in the file.

use darkroot_photo::{BlackLevel, Capture, Counts, Layout, Picture, Size, WhiteLevel};
use darkroot_simulate::camera::filters;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{brighter, camera, develop, exact, flat_grey, layouts, measuring, pixels};

const SIZE: Size = Size { width: 46, height: 32 };

/// The capture as a sensor with this black level and this gain stores it (a count is black + gain x light).
fn stored(capture: &Capture, black: BlackLevel, gain: [f32; 3], white: [f32; 3]) -> Capture {
    let Counts::F32(mosaic) = &capture.counts else { panic!("exact captures are floating-point") };
    let (layout, width) = (mosaic.layout.clone(), mosaic.size.width);
    let mut counts = mosaic.clone();
    for (i, v) in counts.samples.iter_mut().enumerate() {
        let (pixel, plane) = (i / layout.planes(), i % layout.planes());
        let (x, y) = (pixel % width, pixel / width);
        let channel = match &layout {
            Layout::Cfa(cfa) => cfa.at(x, y).plane().unwrap_or(1),
            Layout::Monochrome => 1,
            Layout::Rgb => plane,
        };
        *v = black.at(x, y, plane) + gain[channel] * *v;
    }
    Capture { counts: Counts::F32(counts), black, white: WhiteLevel(white), ..capture.clone() }
}

/// Largest difference of any sample of two pictures.
fn difference(one: &Picture, two: &Picture) -> f64 {
    let (one, two) = (pixels(one), pixels(two));
    assert_eq!(one.len(), two.len());
    one.iter().flatten().zip(two.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn pattern(columns: usize, rows: usize, planes: usize, spread: f32) -> BlackLevel {
    let values = (0..columns * rows * planes).map(|i| 512.0 + spread * ((i * 7) % 5) as f32).collect();
    BlackLevel { columns, rows, planes, values, ..BlackLevel::uniform(0.0) }
}

#[test]
fn a_frame_without_light_is_black_under_every_pattern_of_black_levels() {
    for (name, layout) in layouts() {
        let dark = brighter(flat_grey(layout.clone(), SIZE, 0.5), 0.0);
        for (columns, rows) in [(1, 1), (2, 2), (1, 4), (3, 2), (6, 6)] {
            let mut black = pattern(columns, rows, layout.planes(), 40.0);
            black.row_deltas = (0..SIZE.height).map(|y| (y % 5) as f32 * 3.0 - 4.0).collect();
            black.column_deltas = (0..SIZE.width).map(|x| (x % 7) as f32 * 2.0 - 5.0).collect();
            let capture = stored(&dark, black, [15000.0; 3], [16000.0; 3]);
            let largest = pixels(&develop(&capture, None, &measuring()))
                .iter()
                .flatten()
                .fold(0.0, |m, v| v.abs().max(m));
            assert!(largest < 1e-6, "{name}, {columns} x {rows}: {largest:e}");
        }
    }
}

#[test]
fn drifts_of_the_black_level_by_row_and_column_are_removed() {
    for (name, layout) in layouts() {
        let bare = exact(&Scene::gradient(SIZE), &camera(layout), &Exposure::default());
        let mut black = BlackLevel::uniform(512.0);
        black.row_deltas = (0..SIZE.height).map(|y| (y % 5) as f32 * 9.0 - 12.0).collect();
        black.column_deltas = (0..SIZE.width).map(|x| (x % 7) as f32 * 6.0 - 15.0).collect();
        let capture = stored(&bare, black, [15488.0; 3], [16000.0; 3]);
        let difference =
            difference(&develop(&bare, None, &measuring()), &develop(&capture, None, &measuring()));
        assert!(difference < 2e-5, "{name}: {difference:e}");
    }
}

#[test]
fn a_pattern_of_black_levels_leaves_no_pattern_in_the_light() {
    // The gain of a sensor does not depend on the black level of a sample, so black levels that differ within a
    // channel must not scale its samples differently (DNG 1.7, chapter 5, "Rescaling": by the white level less
    // the largest black level of the plane).
    for (name, layout) in layouts() {
        let bare = flat_grey(layout.clone(), SIZE, 0.5);
        let capture = stored(&bare, pattern(2, 2, layout.planes(), 100.0), [15000.0; 3], [16000.0; 3]);
        let picture = pixels(&develop(&capture, None, &measuring()));
        for channel in 0..3 {
            let values = picture.iter().map(|p| p[channel]);
            let (low, high) = (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max));
            assert!((high - low) / high < 1e-4, "{name}: channel {channel} from {low} to {high}");
        }
    }
}

#[test]
fn the_black_level_of_each_filter_is_its_own() {
    // Red, both greens and blue: four values that lie over the four filters of a Bayer array.
    for letters in ["RGGB", "GRBG", "GBRG", "BGGR"] {
        let bare = exact(&Scene::gradient(SIZE), &camera(filters(letters)), &Exposure::default());
        let values = letters.chars().map(|c| match c {
            'R' => 300.0,
            'G' => 512.0,
            _ => 900.0,
        });
        let black = BlackLevel { columns: 2, rows: 2, values: values.collect(), ..BlackLevel::uniform(0.0) };
        let (gain, white) = ([15700.0, 15488.0, 15100.0], [16000.0; 3]);
        let capture = stored(&bare, black, gain, white);
        let difference =
            difference(&develop(&bare, None, &measuring()), &develop(&capture, None, &measuring()));
        assert!(difference < 2e-5, "{letters}: {difference:e}");
    }
}

#[test]
fn each_channel_is_saturated_at_its_own_white_level() {
    for (name, layout) in layouts() {
        let bare = exact(&Scene::gradient(SIZE), &camera(layout), &Exposure::default());
        let white = [9000.0, 16000.0, 12000.0];
        let gain = white.map(|w| w - 512.0);
        let capture = stored(&bare, BlackLevel::uniform(512.0), gain, white);
        let difference =
            difference(&develop(&bare, None, &measuring()), &develop(&capture, None, &measuring()));
        assert!(difference < 2e-5, "{name}: {difference:e}");
    }
}

#[test]
fn the_block_of_black_levels_counts_from_the_first_stored_sample() {
    let camera = darkroot_simulate::Camera { masked: (1, 3), ..camera(filters("RGGB")) };
    let bare = exact(&Scene::gradient(SIZE), &camera, &Exposure::default());
    let black = BlackLevel {
        columns: 2,
        rows: 2,
        values: vec![100.0, 400.0, 700.0, 1000.0],
        ..BlackLevel::uniform(0.0)
    };
    let dark = brighter(bare, 0.0);
    let capture = stored(&dark, black, [15000.0; 3], [16000.0; 3]);
    let largest =
        pixels(&develop(&capture, None, &measuring())).iter().flatten().fold(0.0, |m, v| v.abs().max(m));
    assert!(largest < 1e-6, "{largest:e}");
}
