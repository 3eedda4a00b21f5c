//! Clipping is found where it is, and a bright wall is not taken for it.

use std::sync::Arc;

use darkroot_colour::{RgbSpace, Spectrum};
use darkroot_develop::{Analysis, Bits, Recipe};
use darkroot_photo::correction::{Area, GainMap};
use darkroot_photo::{Capture, Correction, Counts, Layout, Rect, Size};
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Exposure, Scene, chart, reflectance};
use darkroot_tests::{camera, develop, lab, output, pixels};

const SIZE: Size = Size { width: 480, height: 320 };

fn found(capture: &Capture) -> [f32; 3] {
    Analysis::deferred(Arc::new(capture.clone())).survey().saturation
}

/// The capture of a sensor whose channels end at these shares of the white level, with a little noise of its electronics.
fn ending_at(mut capture: Capture, ends: [f32; 3]) -> Capture {
    let (black, white) = (512.0, 15_892.0);
    let width = capture.counts.size().width;
    let Counts::U16(mosaic) = &mut capture.counts else { return capture };
    let layout = mosaic.layout.clone();
    for (i, v) in mosaic.samples.iter_mut().enumerate() {
        let plane = match &layout {
            Layout::Cfa(cfa) => cfa.at(i % width, i / width).plane().unwrap(),
            _ => i % 3,
        };
        let jitter = (i.wrapping_mul(2_654_435_761) >> 7) % 13;
        let end = black + ends[plane] * (white - black) + jitter as f32 - 6.0;
        *v = (*v).min(end as u16);
    }
    capture
}

#[test]
fn a_bright_even_wall_with_the_noise_of_its_photons_is_not_clipped() {
    let white = chart::white();
    let pale = reflectance::of_lab(darkroot_colour::Lab { l: 85.0, a: 8.0, b: 12.0 });
    let blue = reflectance::of_lab(darkroot_colour::Lab { l: 70.0, a: -5.0, b: -30.0 });
    for (name, layout) in [("RGGB", filters("RGGB")), ("X-Trans", x_trans())] {
        for (i, wall) in [&white, &pale, &blue].into_iter().enumerate() {
            let scene = Scene::flat(SIZE, wall.clone());
            // The brightest channel at 0.8 of the white level.
            let camera = camera(layout.clone());
            let light = Exposure::default().light;
            let most = |r: &Spectrum| camera.response(r, &light).into_iter().fold(0.0, f64::max);
            let share = 0.8 * most(&white) / most(wall);
            let exposure = Exposure { white: share, noise: Some(7), ..Exposure::default() };
            let capture = expose(&scene, &camera, &exposure);
            assert_eq!(found(&capture), [1.0; 3], "{name}, wall {i}");
        }
    }
}

/// A grey from five stops below saturation to three over it.
fn ramp(layout: Layout) -> Capture {
    let scene = Scene::ramp(SIZE, Spectrum::constant(0.9), -5.0, 3.0);
    expose(&scene, &camera(layout), &Exposure { white: 1.0, noise: Some(3), ..Exposure::default() })
}

#[test]
fn plateaus_below_the_white_level_are_found_also_where_each_channel_has_its_own() {
    for (name, layout) in [("RGGB", filters("RGGB")), ("X-Trans", x_trans())] {
        for ends in [[0.777f32; 3], [0.75, 0.777, 0.8], [0.95, 0.6, 0.9]] {
            let seen = found(&ending_at(ramp(layout.clone()), ends));
            let near = seen.iter().zip(ends).all(|(a, b)| (a - b).abs() < 0.004);
            assert!(near, "{name}: {seen:?}, not {ends:?}");
        }
        assert_eq!(found(&ramp(layout)), [1.0; 3], "{name}");
    }
}

/// A gain map that doubles the corners.
fn with_gain_map(mut capture: Capture) -> Capture {
    let map = GainMap {
        rows: 3,
        columns: 3,
        planes: 1,
        vertical: (0.0, 0.5),
        horizontal: (0.0, 0.5),
        gains: vec![2.0, 1.5, 2.0, 1.5, 1.0, 1.5, 2.0, 1.5, 2.0],
    };
    let rect = Rect::full(capture.active_area.size());
    let area = Area { rect, plane: 0, planes: 1, row_pitch: 1, column_pitch: 1 };
    capture.mosaic_corrections = vec![Correction::Gain(area, map)];
    capture
}

#[test]
fn a_gain_map_hides_no_plateau_and_makes_none() {
    let capture = with_gain_map(ending_at(ramp(filters("RGGB")), [0.777; 3]));
    let seen = found(&capture);
    assert!(seen.iter().all(|v| (v - 0.777).abs() < 0.004), "{seen:?}");
    // What is bright only by the map has its colour; what is clipped is neutral all over the picture.
    let recipe = Recipe { output: output(RgbSpace::SRGB, Bits::Float), ..Recipe::default() };
    let shown = pixels(&develop(&capture, None, &recipe));
    let colours = shown.into_iter().map(|p| lab(&RgbSpace::SRGB, p));
    let (mut worst, mut sum) = (0f64, 0.0);
    for colour in colours.filter(|c| c.l > 60.0) {
        worst = worst.max(colour.chroma());
        sum += colour.chroma();
    }
    assert!(worst < 8.0, "chroma {worst}, sum {sum}");
}
