//! Grey stays grey (architecture, invariant 2).

use darkroot_colour::{RgbSpace, Spectrum};
use darkroot_develop::{Bits, Look, Recipe};
use darkroot_photo::{Layout, Size};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{camera, develop, flat_grey, layouts, output, pixels, profiles};

const SIZE: Size = Size { width: 20, height: 14 };
const LOOKS: [Look; 4] = [Look::Neutral, Look::Vivid, Look::Flat, Look::Linear];
const SPACES: [RgbSpace; 7] = [
    RgbSpace::SRGB,
    RgbSpace::DISPLAY_P3,
    RgbSpace::ADOBE_RGB,
    RgbSpace::PROPHOTO,
    RgbSpace::REC2020,
    RgbSpace::ECIRGB_V2,
    RgbSpace::ACES2065_1,
];

#[test]
fn grey_stays_grey_in_every_look_space_and_profile() {
    for (name, layout) in layouts() {
        for level in [0.002, 0.18, 0.8] {
            let capture = flat_grey(layout.clone(), SIZE, level);
            for (order, profile) in profiles(&capture).iter().enumerate() {
                for look in LOOKS {
                    // Spaces come after everything that knows of the sensor.
                    for space in &SPACES[..if layout == Layout::Rgb { SPACES.len() } else { 1 }] {
                        let space = *space;
                        let recipe = Recipe { look, output: output(space, Bits::Float), ..Recipe::default() };
                        for p in pixels(&develop(&capture, profile.as_ref(), &recipe)) {
                            assert!(
                                (p[0] - p[1]).abs() < 1e-4 && (p[2] - p[1]).abs() < 1e-4,
                                "{name}, level {level}, profile {order}, {look:?}, {}: {p:?}",
                                space.name
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_grey_card_under_any_light_is_grey_as_shot() {
    let lights = [
        Spectrum::illuminant_a(),
        Spectrum::daylight(4000.0),
        Spectrum::daylight(6504.0),
        Spectrum::daylight(15000.0),
    ];
    for light in lights {
        for (name, layout) in layouts() {
            let exposure = Exposure { light: light.clone(), ..Exposure::default() };
            let scene = Scene::flat(SIZE, Spectrum::constant(0.4));
            let capture = expose(&scene, &camera(layout), &exposure);
            let recipe = Recipe { output: output(RgbSpace::SRGB, Bits::Float), ..Recipe::default() };
            for p in pixels(&develop(&capture, None, &recipe)) {
                // Counts are whole numbers: half of one in a few hundred of the weakest channel.
                assert!((p[0] - p[1]).abs() < 2e-3 && (p[2] - p[1]).abs() < 2e-3, "{name}: {p:?}");
            }
        }
    }
}

#[test]
fn a_monochrome_sensor_gives_grey_pictures() {
    let scene = Scene::gradient(SIZE);
    let capture = expose(&scene, &camera(Layout::Monochrome), &Exposure::default());
    for look in LOOKS {
        for space in SPACES {
            let recipe = Recipe { look, output: output(space, Bits::Float), ..Recipe::default() };
            let pixels = pixels(&develop(&capture, None, &recipe));
            assert!(
                pixels.iter().all(|p| (p[0] - p[1]).abs() < 1e-5 && (p[2] - p[1]).abs() < 1e-5),
                "{look:?}"
            );
            assert!(pixels.iter().any(|p| p[0] > 0.1));
        }
    }
}
