//! Twice the light is twice the picture (architecture, invariants 1 and 10).

use darkroot_develop::{Balance, Bits, Demosaic, Exposure as Brightness, Look, Output, OutputSpace, Recipe};
use darkroot_photo::{Capture, Layout, Picture, Size};
use darkroot_profile::Profile;
use darkroot_simulate::camera::filters;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene};
use darkroot_tests::{
    bent_profile, brighter, camera, develop, exact, flat_grey, layouts, measuring, pixels, profiles,
};

const SIZE: Size = Size { width: 120, height: 80 };

/// Largest difference of `two` from `factor` times `one`, as a share of the largest channel of the pixel.
fn miss(one: &Picture, two: &Picture, factor: f64) -> f64 {
    let (one, two) = (pixels(one), pixels(two));
    assert_eq!(one.len(), two.len());
    let pairs = one.iter().zip(&two);
    pairs
        .map(|(one, two)| {
            let largest = one.iter().map(|v| v.abs()).fold(1e-6, f64::max) * factor;
            (0..3).map(|c| (one[c] * factor - two[c]).abs() / largest).fold(0.0, f64::max)
        })
        .fold(0.0, f64::max)
}

fn still_life(layout: Layout) -> Capture {
    exact(&Scene::still_life(SIZE), &camera(layout), &Exposure { white: 0.1, ..Exposure::default() })
}

/// The largest miss over all profiles.
fn worst(layout: Layout, factor: f32) -> f64 {
    let capture = still_life(layout);
    let miss = |profile: &Option<Profile>| {
        let one = develop(&capture, profile.as_ref(), &measuring());
        let two = develop(&brighter(capture.clone(), factor), profile.as_ref(), &measuring());
        miss(&one, &two, f64::from(factor))
    };
    profiles(&capture).iter().map(miss).fold(0.0, f64::max)
}

#[test]
fn twice_the_light_is_twice_the_picture() {
    for (name, layout) in layouts() {
        let miss = worst(layout, 2.0);
        assert!(miss < 1e-4, "{name}: {miss:e}");
    }
}

#[test]
fn any_factor_of_the_light_is_that_factor_of_the_picture() {
    for (name, layout) in layouts() {
        for factor in [0.3, 1.2, 5.0] {
            let miss = worst(layout.clone(), factor);
            assert!(miss < 1e-4, "{name}, times {factor}: {miss:e}");
        }
    }
}

#[test]
fn twice_the_light_is_twice_the_picture_for_bilinear_and_for_camera_rgb() {
    let capture = still_life(filters("RGGB"));
    let bilinear = Recipe { demosaic: Demosaic::Bilinear, ..measuring() };
    let sensor = Recipe { output: Output { space: OutputSpace::Camera, bits: Bits::Float }, ..measuring() };
    for recipe in [bilinear, sensor] {
        let one = develop(&capture, None, &recipe);
        let two = develop(&brighter(capture.clone(), 2.0), None, &recipe);
        assert!(miss(&one, &two, 2.0) < 1e-4, "{}", miss(&one, &two, 2.0));
    }
}

#[test]
fn a_white_balance_from_the_picture_does_not_depend_on_the_light() {
    let capture = still_life(filters("RGGB"));
    let recipe = Recipe { balance: Balance::Auto, ..measuring() };
    let one = develop(&capture, None, &recipe);
    let two = develop(&brighter(capture.clone(), 2.0), None, &recipe);
    // Blocks that are too dark or clipped may be others; the still life has none of either at these exposures
    // but the window in the ball.
    assert!(miss(&one, &two, 2.0) < 0.02, "{}", miss(&one, &two, 2.0));
}

#[test]
fn one_stop_more_light_through_counts_is_twice_the_picture_to_their_rounding() {
    let camera = Camera { bits: 16, white: 65535, ..camera(filters("GRBG")) };
    let scene = Scene::still_life(SIZE);
    let shot = |stops| expose(&scene, &camera, &Exposure { white: 0.05, stops, ..Exposure::default() });
    let one = pixels(&develop(&shot(0.0), None, &measuring()));
    let two = pixels(&develop(&shot(1.0), None, &measuring()));
    // Half a count at each exposure, three times amplified by white balance and matrix, and once more by the
    // interpolation, which follows other directions where they are equally good.
    let rounding = 1.5 * 2.0 * 3.0 / (65535.0 - 512.0);
    let mut off = 0;
    for (one, two) in one.iter().zip(&two) {
        off += usize::from((0..3).any(|c| (2.0 * one[c] - two[c]).abs() > rounding));
    }
    assert!(off * 100 < one.len(), "{off} of {}", one.len());
}

#[test]
fn the_linear_look_ignores_the_makers_brightening() {
    let capture = still_life(filters("RGGB"));
    let brightened = Capture { baseline_exposure: 1.5, ..capture.clone() };
    assert!(develop(&capture, None, &measuring()) == develop(&brightened, None, &measuring()));
    let look = Recipe { look: Look::Neutral, ..measuring() };
    assert!(develop(&capture, None, &look) != develop(&brightened, None, &look));
}

#[test]
fn a_stop_of_the_recipe_is_a_stop_of_light() {
    let capture = still_life(filters("RGGB"));
    let profile = bent_profile(&capture, 2);
    let recipe = Recipe { exposure: Brightness { stops: 1.0, auto: false }, ..measuring() };
    let asked = develop(&capture, Some(&profile), &recipe);
    let lit = develop(&brighter(capture, 2.0), Some(&profile), &measuring());
    assert!(miss(&asked, &lit, 1.0) < 1e-4, "{}", miss(&asked, &lit, 1.0));
}

#[test]
fn automatic_exposure_takes_dark_and_bright_pictures_to_the_same_brightness() {
    let scene = Scene::gradient(SIZE);
    let camera = camera(filters("RGGB"));
    let recipe = Recipe { exposure: Brightness { stops: 0.0, auto: true }, ..measuring() };
    let shown = |stops| {
        let capture = exact(&scene, &camera, &Exposure { white: 0.4, stops, ..Exposure::default() });
        pixels(&develop(&capture, None, &recipe)).iter().map(|p| p[1]).sum::<f64>()
    };
    let usual = shown(0.0);
    for stops in [-3.0, -1.0, 1.0] {
        assert!((shown(stops) / usual - 1.0).abs() < 0.01, "{stops}: {} {usual}", shown(stops));
    }
}

#[test]
fn an_even_field_has_the_brightness_of_its_counts() {
    for (name, layout) in layouts() {
        let capture = flat_grey(layout, SIZE, 0.25);
        // The smallest multiplier is 1, so the brightest channel keeps its value.
        for pixel in pixels(&develop(&capture, None, &measuring())) {
            assert!(pixel.iter().all(|v| (v - 0.25).abs() < 1e-4), "{name}: {pixel:?}");
        }
    }
}
