//! Noise is taken away, and nothing else (architecture, decisions).

use darkroot_colour::{RgbSpace, Spectrum};
use darkroot_develop::{
    Bits, Cancel, Crop, Denoise, DenoiseBy, Geometry, Look, Mending, Recipe, Scale, View,
};
use darkroot_photo::{Capture, Counts, Orientation, Picture, Rect, Samples, Size};
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

/// By comparing parts of the picture.
fn best(recipe: Recipe) -> Recipe {
    let denoise = Denoise { by: DenoiseBy::Likeness, amount: Some(1.0), ..recipe.denoise };
    Recipe { denoise, ..recipe }
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
        let kept = develop(&capture, None, &asked(Some(0.0)));
        assert!(develop(&capture, None, &asked(Some(1.0))) == kept);
        assert!(develop(&capture, None, &best(asked(None))) == kept);
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
    let better = off(&develop(&noisy, None, &best(linear(None))), &truth);
    assert!(better < 0.8 * after, "{better} {after}");
}

#[test]
fn an_even_field_keeps_its_brightness() {
    for stops in [-2.0, -5.0] {
        let noisy = shot(&Scene::flat(SIZE, Spectrum::constant(0.3)), stops, Some(8));
        let mean = |recipe: &Recipe| {
            let all = pixels(&develop(&noisy, None, recipe));
            [0, 1, 2].map(|c| all.iter().map(|p| p[c]).sum::<f64>() / all.len() as f64)
        };
        let before = mean(&linear(Some(0.0)));
        for recipe in [linear(Some(1.0)), best(linear(None))] {
            let after = mean(&recipe);
            for c in 0..3 {
                assert!((after[c] / before[c] - 1.0).abs() < 1e-3, "{stops}: {before:?} {after:?}");
            }
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
    let by_scales = Recipe { crop: Crop::Active, ..Recipe::default() };
    for recipe in [by_scales.clone(), best(by_scales)] {
        let known = plan(&noisy, None, &recipe).unwrap();
        let whole = rendered(&known);
        for (columns, rows) in [(37, 19), (128, 5), (1, 64)] {
            assert!(rendered_in_tiles(&known, columns, rows) == whole, "{columns} x {rows}");
        }
        // Planned anew, so that nothing is known of the frame.
        let fresh = plan(&noisy, None, &recipe).unwrap();
        let rect = Rect { x: 101, y: 67, width: 90, height: 71 };
        let part = fresh.render(View::of(rect), &Cancel::default()).unwrap();
        let (Samples::U8(part), Samples::U8(whole)) = (&part.samples, &whole.samples) else {
            panic!("8 bits")
        };
        for (y, row) in part.chunks_exact(3 * rect.width).enumerate() {
            let start = 3 * ((rect.y + y) * SIZE.width + rect.x);
            assert!(row == &whole[start..start + row.len()], "row {y}");
        }
    }
}

#[test]
fn views_turned_reduced_and_warped_are_those_of_the_whole_frame() {
    let mut noisy = shot(&Scene::still_life(SIZE), -4.0, Some(9));
    noisy.orientation = Orientation::Rotate90;
    let straight = Recipe { crop: Crop::Active, ..best(Recipe::default()) };
    let geometry = Geometry { straighten: 3.0, ..straight.geometry };
    for recipe in [straight.clone(), Recipe { geometry, crop: Crop::Default, ..straight }] {
        for scale in [Scale::FULL, Scale::QUARTER] {
            let known = plan(&noisy, None, &recipe).unwrap();
            let whole = known.render(known.whole(scale), &Cancel::default()).unwrap();
            let rect = Rect { x: 20, y: 23, width: 30, height: 28 };
            let part = plan(&noisy, None, &recipe).unwrap();
            let part = part.render(View { scale, rect }, &Cancel::default()).unwrap();
            let (Samples::U8(samples), Samples::U8(of)) = (&part.samples, &whole.samples) else {
                panic!("8 bits")
            };
            for (y, row) in samples.chunks_exact(3 * rect.width).enumerate() {
                let start = 3 * ((rect.y + y) * whole.size.width + rect.x);
                assert!(row == &of[start..start + row.len()], "{scale:?} row {y}");
            }
        }
    }
}

#[test]
fn banding_goes_but_not_from_a_measurement_and_not_from_a_clean_picture() {
    let noisy = shot(&Scene::gradient(SIZE), -5.0, Some(7));
    let mut banded = noisy.clone();
    let Counts::U16(mosaic) = &mut banded.counts else { panic!("counts") };
    for (y, row) in mosaic.samples.chunks_exact_mut(SIZE.width).enumerate() {
        // Of the same size as the noise, and without order.
        let mixed = (y as u32 + 1).wrapping_mul(0x9E37_79B1);
        let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x85EB_CA6B);
        let offset = ((mixed >> 16) % 24) as u16;
        row.iter_mut().for_each(|v| *v += offset);
    }
    let kept = |recipe: Recipe| Recipe { banding: Mending::Off, ..recipe };
    let rough = |capture: &Capture, recipe: &Recipe| {
        let all = pixels(&develop(capture, None, recipe));
        let means: Vec<f64> =
            all.chunks_exact(SIZE.width).map(|row| row.iter().map(|p| p[1]).sum::<f64>()).collect();
        means.windows(2).map(|v| (v[1] - v[0]).powi(2)).sum::<f64>()
    };
    let recipe = asked(Some(0.0));
    let [before, after, none] =
        [(&banded, kept(recipe.clone())), (&banded, recipe.clone()), (&noisy, recipe.clone())]
            .map(|(capture, recipe)| rough(capture, &recipe));
    assert!(after < 0.15 * before, "{before} {after} {none}");
    let notes = plan(&banded, None, &recipe).unwrap().notes;
    assert!(notes.iter().any(|note| note.starts_with("banding of rows")), "{notes:?}");
    assert!(develop(&noisy, None, &recipe) == develop(&noisy, None, &kept(recipe)));
    assert!(develop(&banded, None, &linear(None)) == develop(&banded, None, &kept(linear(None))));
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
    let kept = Recipe { hot_pixels: Mending::Off, ..asked(None) };
    assert!(red(&develop(&noisy, None, &kept)) > red(&clean) + 0.2);
    let linear = Recipe { look: Look::Linear, ..measuring() };
    assert!(red(&develop(&noisy, None, &linear)) > 0.3);
    let notes = plan(&noisy, None, &asked(None)).unwrap().notes;
    assert!(notes.iter().any(|note| note.ends_with("around them: 1")), "{notes:?}");
}
