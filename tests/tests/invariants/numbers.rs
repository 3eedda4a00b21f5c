//! Every value is finite and in its range.

use darkroot_colour::RgbSpace;
use darkroot_develop::{Bits, Highlights, Look, Output, OutputSpace, Recipe};
use darkroot_photo::{Capture, Counts, Layout, Size};
use darkroot_simulate::camera::filters;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{bent_profile, camera, develop, exact, layouts, output, pixels, with_light};

const SIZE: Size = Size { width: 48, height: 32 };
const LOOKS: [Look; 4] = [Look::Neutral, Look::Vivid, Look::Flat, Look::Linear];
const SPACES: [RgbSpace; 2] = [RgbSpace::SRGB, RgbSpace::ECIRGB_V2];

/// Noise, counts from none to the largest that 16 bits hold, black level above many of them.
fn wild(layout: Layout) -> Capture {
    let mut capture = expose(&Scene::gradient(SIZE), &camera(layout), &Exposure::default());
    let Counts::U16(mosaic) = &mut capture.counts else { panic!("counts are integers") };
    for (i, v) in mosaic.samples.iter_mut().enumerate() {
        let bits = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        *v = match bits % 4 {
            0 => 0,
            1 => u16::MAX,
            2 => (bits >> 2) as u16,
            _ => *v,
        };
    }
    capture
}

#[test]
fn every_value_is_finite_and_a_look_keeps_it_between_black_and_white() {
    for (name, layout) in layouts() {
        let capture = wild(layout);
        let profiles = [None, Some(bent_profile(&capture, 4))];
        for profile in &profiles {
            for look in LOOKS {
                for highlights in [Highlights::Rebuild, Highlights::Clip, Highlights::Keep] {
                    for space in SPACES {
                        let output = output(space, Bits::Float);
                        let recipe = Recipe { look, highlights, output, ..Recipe::default() };
                        for p in pixels(&develop(&capture, profile.as_ref(), &recipe)) {
                            let what = || format!("{name} {look:?} {highlights:?} {}: {p:?}", space.name);
                            assert!(p.iter().all(|v| v.is_finite()), "{}", what());
                            let shown = p.iter().all(|v| (0.0..=1.0).contains(v));
                            assert!(look == Look::Linear || shown, "{}", what());
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn samples_that_are_no_numbers_do_not_spread() {
    // Floating-point DNG files can hold them.
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -1e30] {
        let light = |x: usize, y: usize| if (x, y) == (11, 9) { [bad; 3] } else { [0.2, 0.4, 0.3] };
        let template = expose(&Scene::gradient(SIZE), &camera(filters("RGGB")), &Exposure::default());
        let capture = with_light(template.clone(), light);
        let sound = with_light(template, |_, _| [0.2, 0.4, 0.3]);
        let recipe = Recipe { output: output(RgbSpace::SRGB, Bits::Sixteen), ..Recipe::default() };
        let (damaged, whole) = (develop(&capture, None, &recipe), develop(&sound, None, &recipe));
        let (damaged, whole) = (pixels(&damaged), pixels(&whole));
        for (i, (damaged, whole)) in damaged.iter().zip(&whole).enumerate() {
            let (x, y) = (i % SIZE.width, i / SIZE.width);
            if x.abs_diff(11) > 16 || y.abs_diff(9) > 16 {
                assert_eq!(damaged, whole, "{bad} is seen at {x},{y}");
            }
        }
    }
}

#[test]
fn integers_are_the_floating_point_values_rounded() {
    let capture = exact(&Scene::still_life(SIZE), &camera(filters("RGGB")), &Exposure::default());
    let at = |bits| {
        pixels(&develop(
            &capture,
            None,
            &Recipe { output: output(RgbSpace::SRGB, bits), ..Recipe::default() },
        ))
    };
    let (eight, sixteen, float) = (at(Bits::Eight), at(Bits::Sixteen), at(Bits::Float));
    for ((eight, sixteen), float) in eight.iter().zip(&sixteen).zip(&float) {
        for c in 0..3 {
            assert!((eight[c] - float[c]).abs() <= 0.501 / 255.0, "{eight:?} {float:?}");
            assert!((sixteen[c] - float[c]).abs() <= 0.8 / 65535.0, "{sixteen:?} {float:?}");
        }
    }
}

#[test]
fn linear_light_beyond_white_stays_in_floating_point_and_is_cut_in_integers() {
    // From a deep green to a bright grey.
    let template = exact(&Scene::gradient(SIZE), &camera(Layout::Rgb), &Exposure::default());
    let capture = with_light(template, |x, _| if x < 20 { [0.01, 0.5, 0.01] } else { [1.0, 2.0, 1.4] });
    let linear = |bits| Recipe {
        look: Look::Linear,
        output: output(RgbSpace::SRGB.linear(), bits),
        ..Recipe::default()
    };
    let float = pixels(&develop(&capture, None, &linear(Bits::Float)));
    let integers = pixels(&develop(&capture, None, &linear(Bits::Sixteen)));
    let (low, high) = float.iter().flatten().fold((0f64, 0f64), |(low, high), v| (low.min(*v), high.max(*v)));
    assert!(low < -1e-3 && high > 1.5, "{low} {high}");
    for (float, integer) in float.iter().flatten().zip(integers.iter().flatten()) {
        assert!((float.clamp(0.0, 1.0) - integer).abs() <= 1.0 / 65535.0, "{float} {integer}");
    }
}

#[test]
fn camera_rgb_is_the_balanced_samples_themselves() {
    let camera = camera(Layout::Rgb);
    let capture = exact(&Scene::gradient(SIZE), &camera, &Exposure::default());
    let Counts::F32(mosaic) = &capture.counts else { panic!("exact captures are floating-point") };
    let output = Output { space: OutputSpace::Camera, bits: Bits::Float };
    let plan =
        darkroot_tests::plan(&capture, None, &Recipe { look: Look::Linear, output, ..Recipe::default() })
            .unwrap();
    let picture = pixels(&darkroot_tests::rendered(&plan));
    for (pixel, seen) in picture.iter().zip(mosaic.samples.chunks_exact(3)) {
        for c in 0..3 {
            let balanced = f64::from(seen[c] * plan.multipliers()[c]);
            assert!((pixel[c] - balanced).abs() < 1e-6, "{pixel:?} {seen:?}");
        }
    }
}
