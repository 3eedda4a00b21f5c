//! White balance: as shot, by temperature, from a grey card, from the picture, by multipliers.

use darkroot_colour::difference::de2000;
use darkroot_colour::temperature::{Temperature, daylight_xy};
use darkroot_colour::{RgbSpace, Spectrum, Xy, white};
use darkroot_develop::{Balance, Bits, Crop, Error, Recipe, SpotFault};
use darkroot_photo::{AsShot, Capture, Layout, Orientation, Rect, Size};
use darkroot_simulate::camera::filters;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene};
use darkroot_tests::{camera, develop, exact, flat_grey, lab, mean, measuring, output, pixels, with_light};

const SIZE: Size = Size { width: 360, height: 240 };

fn still_life(light: Spectrum, orientation: Orientation) -> Capture {
    // Every dimension of the chart is known upright, whatever way the camera was held.
    let scene = Scene::still_life(SIZE);
    exact(&scene, &camera(filters("RGGB")), &Exposure { light, orientation, ..Exposure::default() })
}

fn day() -> Spectrum {
    Spectrum::daylight(5500.0)
}

/// Where the grey card lies in the upright picture.
fn grey_card() -> Rect {
    Scene::still_life(SIZE).patches().iter().find(|p| p.name == "grey card").unwrap().inside(0.6).unwrap()
}

fn spot() -> Balance {
    let card = grey_card();
    Balance::Spot {
        x: card.x + card.width / 2,
        y: card.y + card.height / 2,
        side: card.width.min(card.height),
    }
}

/// Red over green and blue over green of the multipliers, as shares of the right ones.
fn off(capture: &Capture, balance: Balance, right: [f64; 3]) -> (f64, f64) {
    let plan = darkroot_tests::plan(capture, None, &Recipe { balance, ..Recipe::default() }).unwrap();
    let m = plan.multipliers().map(f64::from);
    (m[0] / m[1] * right[0] / right[1] - 1.0, m[2] / m[1] * right[2] / right[1] - 1.0)
}

#[test]
fn as_shot_is_the_neutral_of_the_file() {
    let capture = still_life(day(), Orientation::Upright);
    let neutral = camera(filters("RGGB")).neutral(&day());
    let (red, blue) = off(&capture, Balance::AsShot, neutral);
    assert!(red.abs() < 1e-6 && blue.abs() < 1e-6, "{red} {blue}");
    let plan = darkroot_tests::plan(&capture, None, &Recipe::default()).unwrap();
    assert!(plan.multipliers().iter().all(|&m| m >= 1.0) && plan.multipliers().contains(&1.0));
}

#[test]
fn the_white_that_a_file_names_by_chromaticity_is_the_same_white() {
    let capture = still_life(day(), Orientation::Upright);
    let by_white = Capture { as_shot: Some(AsShot::White(daylight_xy(5500.0))), ..capture.clone() };
    let (red, blue) = off(&by_white, Balance::AsShot, camera(filters("RGGB")).neutral(&day()));
    assert!(red.abs() < 0.03 && blue.abs() < 0.03, "{red} {blue}");
}

#[test]
fn the_temperature_of_the_light_gives_its_neutral() {
    for kelvin in [4000.0, 5500.0, 6504.0, 9000.0] {
        let light = Spectrum::daylight(kelvin);
        let capture = still_life(light.clone(), Orientation::Upright);
        let seen = Temperature::of(daylight_xy(kelvin));
        let balance = Balance::Kelvin { kelvin: seen.kelvin, tint: seen.tint() };
        let (red, blue) = off(&capture, balance, camera(filters("RGGB")).neutral(&light));
        // Between two calibrations, and for spectra that they were not made with, matrices are only so good.
        assert!(red.abs() < 0.03 && blue.abs() < 0.03, "{kelvin} K: {red} {blue}");
    }
}

#[test]
fn a_temperature_asked_for_is_the_temperature_reported() {
    let capture = still_life(day(), Orientation::Upright);
    for (kelvin, tint) in [(2500.0, 0.0), (3200.0, 12.0), (5200.0, -8.0), (7500.0, 30.0), (12000.0, 0.0)] {
        let balance = Balance::Kelvin { kelvin, tint };
        let plan = darkroot_tests::plan(&capture, None, &Recipe { balance, ..Recipe::default() }).unwrap();
        let white = plan.white.unwrap();
        assert!((white.kelvin / kelvin - 1.0).abs() < 2e-3, "{kelvin}, {tint}: {white:?}");
        assert!((white.tint() - tint).abs() < 0.5, "{kelvin}, {tint}: {}", white.tint());
    }
}

/// a* and b* of a grey field balanced as asked.
fn tinge(balance: Balance) -> (f64, f64) {
    let capture = flat_grey(Layout::Rgb, Size { width: 16, height: 16 }, 0.3);
    let picture = develop(&capture, None, &Recipe { balance, ..measuring() });
    let lab = lab(&RgbSpace::SRGB.linear(), pixels(&picture)[0]);
    (lab.a, lab.b)
}

#[test]
fn a_higher_temperature_makes_the_picture_warmer() {
    let b = |kelvin| tinge(Balance::Kelvin { kelvin, tint: 0.0 }).1;
    assert!(
        b(3000.0) < b(4500.0) - 5.0 && b(4500.0) < b(7000.0) - 5.0,
        "{} {} {}",
        b(3000.0),
        b(4500.0),
        b(7000.0)
    );
}

#[test]
fn a_positive_tint_makes_the_picture_more_magenta() {
    let a = |tint| tinge(Balance::Kelvin { kelvin: 5500.0, tint }).0;
    assert!(a(40.0) > a(0.0) + 3.0 && a(0.0) > a(-40.0) + 3.0, "{} {} {}", a(-40.0), a(0.0), a(40.0));
}

#[test]
fn daylight_is_right_for_daylight() {
    let light = Spectrum::daylight(5503.0);
    let capture = still_life(light.clone(), Orientation::Upright);
    let (red, blue) = off(&capture, Balance::Daylight, camera(filters("RGGB")).neutral(&light));
    assert!(red.abs() < 0.03 && blue.abs() < 0.03, "{red} {blue}");
}

#[test]
fn a_spot_on_the_grey_card_is_the_neutral_in_every_orientation() {
    for exif in 1..=8 {
        let orientation = Orientation::from_exif(exif);
        let capture = still_life(day(), orientation);
        let response = camera(filters("RGGB")).response(
            &Scene::still_life(SIZE).patches().iter().find(|p| p.name == "grey card").unwrap().reflectance,
            &day(),
        );
        let (red, blue) = off(&capture, spot(), response);
        assert!(red.abs() < 1e-3 && blue.abs() < 1e-3, "orientation {exif}: {red} {blue}");
    }
}

#[test]
fn a_spot_counts_from_the_corner_of_what_is_shown() {
    let mut capture = still_life(day(), Orientation::Upright);
    let whole =
        darkroot_tests::plan(&capture, None, &Recipe { balance: spot(), ..Recipe::default() }).unwrap();
    let (dx, dy) = (10, 6);
    capture.default_crop = Rect { x: dx, y: dy, width: SIZE.width - 2 * dx, height: SIZE.height - 2 * dy };
    let Balance::Spot { x, y, side } = spot() else { panic!("a spot") };
    let moved = Balance::Spot { x: x - dx, y: y - dy, side };
    let cropped =
        darkroot_tests::plan(&capture, None, &Recipe { balance: moved, ..Recipe::default() }).unwrap();
    assert_eq!(whole.multipliers(), cropped.multipliers());
    let recipe = Recipe { balance: spot(), crop: Crop::Active, ..Recipe::default() };
    assert_eq!(darkroot_tests::plan(&capture, None, &recipe).unwrap().multipliers(), whole.multipliers());
}

#[test]
fn automatic_white_balance_shows_a_grey_card_as_nearly_grey() {
    let lights = [day(), Spectrum::daylight(7500.0), Spectrum::illuminant_a()];
    for light in lights {
        let capture = still_life(light, Orientation::Upright);
        let srgb = output(RgbSpace::SRGB, Bits::Float);
        let shown = |balance| {
            let picture = develop(&capture, None, &Recipe { balance, output: srgb, ..Recipe::default() });
            lab(&RgbSpace::SRGB, mean(&picture, grey_card()))
        };
        let (auto, right) = (shown(Balance::Auto), shown(Balance::AsShot));
        let difference = de2000(auto, right);
        assert!(difference < AUTO_LIMIT, "{auto:?} {right:?}: {difference}");
    }
}

/// Limit in dE2000. The still life is mostly wood, fruit and warm walls, which any estimate takes for a part of the
/// light: 15 to 17 are measured, far from good.
const AUTO_LIMIT: f64 = 19.0;

#[test]
fn automatic_white_balance_finds_the_light_of_a_grey_scene() {
    for light in [day(), Spectrum::daylight(7500.0), Spectrum::illuminant_a()] {
        let scene = Scene::ramp(SIZE, Spectrum::constant(0.5), -3.0, 0.5);
        let camera = camera(filters("RGGB"));
        let capture = exact(&scene, &camera, &Exposure { light: light.clone(), ..Exposure::default() });
        let (red, blue) = off(&capture, Balance::Auto, camera.neutral(&light));
        assert!(red.abs() < 0.02 && blue.abs() < 0.02, "{red} {blue}");
    }
}

#[test]
fn only_the_ratios_of_multipliers_count() {
    let capture = still_life(day(), Orientation::Upright);
    let at = |m| develop(&capture, None, &Recipe { balance: Balance::Multipliers(m), ..Recipe::default() });
    assert!(at([2.0, 1.0, 1.5]) == at([4.0, 2.0, 3.0]));
    assert!(at([2.0, 1.0, 1.5]) != at([2.0, 1.0, 1.6]));
}

#[test]
fn the_multipliers_of_the_neutral_are_the_balance_as_shot() {
    let capture = still_life(day(), Orientation::Upright);
    let neutral = camera(filters("RGGB")).neutral(&day());
    let as_shot = develop(&capture, None, &measuring());
    let balance = Balance::Multipliers(neutral.map(|v| 1.0 / v));
    let by_hand = develop(&capture, None, &Recipe { balance, ..measuring() });
    let (one, two) = (pixels(&as_shot), pixels(&by_hand));
    assert!(one.iter().flatten().zip(two.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-4));
}

fn error(capture: &Capture, balance: Balance) -> Error {
    darkroot_tests::plan(capture, None, &Recipe { balance, ..Recipe::default() }).unwrap_err()
}

#[test]
fn a_balance_that_is_impossible_is_an_error() {
    let capture = still_life(day(), Orientation::Upright);
    for (kelvin, tint) in [
        (1999.0, 0.0),
        (25001.0, 0.0),
        (5000.0, 151.0),
        (5000.0, -151.0),
        (f64::NAN, 0.0),
        (5000.0, f64::NAN),
    ] {
        assert!(
            matches!(error(&capture, Balance::Kelvin { kelvin, tint }), Error::Temperature { .. }),
            "{kelvin} {tint}"
        );
    }
    for m in [
        [0.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
        [f64::NAN, 1.0, 1.0],
        [f64::INFINITY, 1.0, 1.0],
        [1.0, 101.0, 1.0],
        [0.0; 3],
    ] {
        assert_eq!(error(&capture, Balance::Multipliers(m)), Error::Multipliers, "{m:?}");
    }
    for (x, y) in [(SIZE.width, 0), (0, SIZE.height), (usize::MAX, usize::MAX)] {
        assert!(matches!(error(&capture, Balance::Spot { x, y, side: 16 }), Error::Spot { .. }), "{x},{y}");
    }
}

#[test]
fn a_spot_that_is_too_dark_clipped_or_too_small_is_an_error() {
    let why = |capture: &Capture| match error(capture, Balance::Spot { x: 2, y: 2, side: 16 }) {
        Error::Spot { fault, .. } => fault,
        other => panic!("{other}"),
    };
    let size = Size { width: 32, height: 32 };
    let flat = |level| flat_grey(filters("RGGB"), size, level);
    assert_eq!(why(&flat(1e-4)), SpotFault::TooDark);
    assert_eq!(why(&flat(1.0)), SpotFault::Clipped);
    let tiny = flat_grey(filters("RGGB"), Size { width: 5, height: 5 }, 0.5);
    assert_eq!(why(&tiny), SpotFault::TooSmall);
}

#[test]
fn a_temperature_means_nothing_without_matrices_but_everything_else_still_works() {
    let blind = Capture { calibrations: Vec::new(), ..still_life(day(), Orientation::Upright) };
    let kelvin = Balance::Kelvin { kelvin: 5000.0, tint: 0.0 };
    assert_eq!(error(&blind, kelvin), Error::NoMatrix);
    assert_eq!(error(&blind, Balance::Daylight), Error::NoMatrix);
    for balance in [Balance::AsShot, Balance::Auto, spot(), Balance::Multipliers([2.0, 1.0, 1.5])] {
        let plan = darkroot_tests::plan(&blind, None, &Recipe { balance, ..Recipe::default() }).unwrap();
        assert!(plan.notes.iter().any(|n| n.contains("no colour matrix")), "{:?}", plan.notes);
    }
}

#[test]
fn a_file_without_a_white_balance_gets_one_from_the_picture_and_says_so() {
    let capture = Capture { as_shot: None, ..still_life(day(), Orientation::Upright) };
    let plan = darkroot_tests::plan(&capture, None, &Recipe::default()).unwrap();
    assert!(plan.notes.iter().any(|n| n.contains("estimated")), "{:?}", plan.notes);
    let auto = darkroot_tests::plan(&capture, None, &Recipe { balance: Balance::Auto, ..Recipe::default() })
        .unwrap();
    assert_eq!(plan.multipliers(), auto.multipliers());
}

#[test]
fn samples_that_are_balanced_already_are_not_balanced_again() {
    let size = Size { width: 24, height: 16 };
    let neutral = camera(Layout::Rgb).neutral(&day());
    let template =
        expose(&Scene::flat(size, Spectrum::constant(0.5)), &camera(Layout::Rgb), &Exposure::default());
    let balanced = Capture { balance_applied: true, ..with_light(template, |_, _| [0.4; 3]) };
    assert_eq!(balanced.as_shot, Some(AsShot::Neutral(neutral)));
    for balance in [Balance::AsShot, Balance::Spot { x: 8, y: 8, side: 8 }] {
        let p = pixels(&develop(&balanced, None, &Recipe { balance, ..measuring() }))[0];
        assert!((p[0] - p[1]).abs() < 1e-4 && (p[2] - p[1]).abs() < 1e-4, "{p:?}");
    }
    // A temperature is relative to the white that was balanced for.
    let seen = Temperature::of(darkroot_develop::CameraMatrix::of(&balanced).unwrap().white_of(neutral));
    let balance = Balance::Kelvin { kelvin: seen.kelvin, tint: seen.tint() };
    let p = pixels(&develop(&balanced, None, &Recipe { balance, ..measuring() }))[0];
    assert!((p[0] - p[1]).abs() < 1e-3 && (p[2] - p[1]).abs() < 1e-3, "{p:?}");
}

#[test]
fn a_sensor_with_other_filters_says_which() {
    let camera = Camera { layout: filters("RGEB"), ..camera(filters("RGGB")) };
    let capture = expose(&Scene::gradient(Size { width: 16, height: 16 }), &camera, &Exposure::default());
    let message = darkroot_tests::plan(&capture, None, &Recipe::default()).unwrap_err().to_string();
    assert!(message.contains("RGEB"), "{message}");
}

#[test]
fn the_tint_of_daylight_is_what_raw_developers_show_for_it() {
    // Adobe's Camera Raw and Lightroom have "Daylight" at 5500 K with tint +10: daylight lies above the
    // Planckian locus (duv +0.003), and a positive tint answers light that is greener than a black body.
    let tint = Temperature::of(daylight_xy(5500.0)).tint();
    assert!((tint - 10.0).abs() < 3.0, "{tint}");
    let d50: Xy = white::D50_XY;
    assert!(Temperature::of(d50).tint() > 0.0);
}
