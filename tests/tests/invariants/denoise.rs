//! Noise is taken away, and nothing else (architecture, decisions).

use darkroot_colour::{RgbSpace, Spectrum};
use darkroot_develop::{Bits, Cancel, Crop, Denoise, Look, Recipe, View};
use darkroot_photo::{Capture, Counts, Picture, Rect, Samples, Size};
use darkroot_simulate::camera::filters;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{camera, develop, exact, measuring, output, pixels, plan, rendered, rendered_in_tiles};

const SIZE: Size = Size { width: 331, height: 247 };

fn shot(scene: &Scene, stops: f64, noise: Option<u64>) -> Capture {
    expose(scene, &camera(filters("RGGB")), &Exposure { stops, noise, ..Exposure::default() })
}

fn asked(amount: Option<f32>) -> Recipe {
    let denoise = Denoise { amount, ..Denoise::default() };
    Recipe { denoise, output: output(RgbSpace::SRGB, Bits::Float), ..Recipe::default() }
}

fn linear(amount: Option<f32>) -> Recipe {
    Recipe { denoise: asked(amount).denoise, ..measuring() }
}

/// Root of the mean square of differences.
fn off(one: &Picture, two: &Picture) -> f64 {
    let (one, two) = (pixels(one), pixels(two));
    let square = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>();
    (one.iter().zip(&two).map(square).sum::<f64>() / (3 * one.len()) as f64).sqrt()
}

#[test]
fn a_clean_picture_is_left_alone_bit_for_bit() {
    let scene = Scene::still_life(SIZE);
    let floats = exact(&scene, &camera(filters("GRBG")), &Exposure::default());
    for capture in [shot(&scene, 0.0, None), shot(&scene, -3.0, None), floats] {
        assert!(develop(&capture, None, &asked(Some(1.0))) == develop(&capture, None, &asked(Some(0.0))));
    }
}

#[test]
fn most_of_the_noise_goes_unless_somebody_measures() {
    let scene = Scene::gradient(SIZE);
    let (clean, noisy) = (shot(&scene, -4.0, None), shot(&scene, -4.0, Some(3)));
    let truth = develop(&clean, None, &asked(None));
    let before = off(&develop(&noisy, None, &asked(Some(0.0))), &truth);
    let after = off(&develop(&noisy, None, &asked(None)), &truth);
    assert!(after < before / 3.0, "{before} {after}");
    assert!(develop(&noisy, None, &linear(None)) == develop(&noisy, None, &linear(Some(0.0))));
    let truth = develop(&clean, None, &linear(None));
    let before = off(&develop(&noisy, None, &linear(None)), &truth);
    let after = off(&develop(&noisy, None, &linear(Some(1.0))), &truth);
    assert!(after < before / 3.0, "{before} {after}");
}

#[test]
fn an_even_field_keeps_its_brightness() {
    for stops in [-2.0, -5.0] {
        let noisy = shot(&Scene::flat(SIZE, Spectrum::constant(0.3)), stops, Some(8));
        let mean = |amount: f32| {
            let all = pixels(&develop(&noisy, None, &linear(Some(amount))));
            [0, 1, 2].map(|c| all.iter().map(|p| p[c]).sum::<f64>() / all.len() as f64)
        };
        let (before, after) = (mean(0.0), mean(1.0));
        for c in 0..3 {
            assert!((after[c] / before[c] - 1.0).abs() < 1e-3, "{stops}: {before:?} {after:?}");
        }
    }
}

#[test]
fn the_profile_of_the_file_is_believed() {
    let mut noisy = shot(&Scene::gradient(SIZE), -3.0, Some(4));
    let measured = develop(&noisy, None, &asked(None));
    noisy.noise_profile = vec![[1e-12, 1e-14]];
    let off = develop(&noisy, None, &asked(Some(0.0)));
    assert!(develop(&noisy, None, &asked(None)) == off && measured != off);
}

#[test]
fn tiles_and_rectangles_have_no_seams() {
    let noisy = shot(&Scene::still_life(SIZE), -4.0, Some(5));
    let recipe = Recipe { crop: Crop::Active, ..Recipe::default() };
    let plan = plan(&noisy, None, &recipe).unwrap();
    let whole = rendered(&plan);
    for (columns, rows) in [(37, 19), (128, 5), (1, 64)] {
        assert!(rendered_in_tiles(&plan, columns, rows) == whole, "{columns} x {rows}");
    }
    let rect = Rect { x: 101, y: 67, width: 90, height: 71 };
    let part = plan.render(View::of(rect), &Cancel::default()).unwrap();
    let (Samples::U8(part), Samples::U8(whole)) = (&part.samples, &whole.samples) else { panic!("8 bits") };
    for (y, row) in part.chunks_exact(3 * rect.width).enumerate() {
        let start = 3 * ((rect.y + y) * SIZE.width + rect.x);
        assert!(row == &whole[start..start + row.len()], "row {y}");
    }
}

#[test]
fn a_hot_pixel_goes_but_not_from_a_measurement() {
    let mut noisy = shot(&Scene::gradient(SIZE), -4.0, Some(6));
    let clean = develop(&noisy, None, &asked(None));
    if let Counts::U16(mosaic) = &mut noisy.counts {
        mosaic.samples[120 * SIZE.width + 150] = 9000;
    }
    let red = |picture: &Picture| pixels(picture)[120 * SIZE.width + 150].into_iter().fold(0.0, f64::max);
    let mended = develop(&noisy, None, &asked(None));
    assert!((red(&mended) - red(&clean)).abs() < 0.05, "{} {}", red(&mended), red(&clean));
    let kept = Recipe { hot_pixels: darkroot_develop::Mending::Off, ..asked(None) };
    assert!(red(&develop(&noisy, None, &kept)) > red(&clean) + 0.2);
    let linear = Recipe { look: Look::Linear, ..measuring() };
    assert!(red(&develop(&noisy, None, &linear)) > 0.3);
    let notes = plan(&noisy, None, &asked(None)).unwrap().notes;
    assert!(notes.iter().any(|note| note.ends_with("around them: 1")), "{notes:?}");
}
