//! Pictures of the still life against what it is made of: colours of the chart, through files and decoders.

use darkroot_colour::difference::de2000;
use darkroot_colour::{RgbSpace, Spectrum, Vector3, Xyz, white};
use darkroot_develop::{Bits, CameraMatrix, Output, OutputSpace, Recipe};
use darkroot_photo::{Capture, Orientation, Rect, Size};
use darkroot_raw::{Decoder, Limits};
use darkroot_simulate::camera::filters;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, chart, dng, nef};
use darkroot_tests::{camera, develop, exact, lab, layouts, mean, measuring, root};

const SIZE: Size = Size { width: 360, height: 240 };

/// How far the patches of a developed chart are from what they should be, in dE2000.
struct Differences {
    /// Mean over the patches, from the colours of the reflectances under D50.
    mean: f64,
    /// Largest, from the same.
    most: f64,
    /// Largest, from what the camera's matrix makes of the sensor's answer to each patch: what files, decoders
    /// and stages add.
    added: f64,
}

/// One factor for the whole picture stands for its exposure.
fn differences(capture: &Capture, scene: &Scene, camera: &Camera, light: &Spectrum) -> Differences {
    let picture = develop(capture, None, &measuring());
    // Patches count from the corner of the active area.
    let (area, crop) = (capture.active_area, capture.default_crop);
    let margin = (crop.x - area.x, crop.y - area.y);
    assert_eq!(picture.size, capture.orientation.applied_to(crop.size()));
    let d50 = Spectrum::daylight(5003.0);
    let paper = Spectrum::constant(1.0).reflected_xyz(&d50);
    let neutral = camera.neutral(light);
    let matrices = CameraMatrix::of(capture).unwrap();
    let matrix = matrices.to_xyz_d50(neutral, matrices.white_of(neutral));
    let (mut shown, mut truth, mut ideal) = (Vec::new(), Vec::new(), Vec::new());
    for patch in &scene.patches()[..24] {
        let inside = patch.inside(0.6).unwrap();
        let seen = mean(&picture, Rect { x: inside.x - margin.0, y: inside.y - margin.1, ..inside });
        shown.push(Xyz::from(RgbSpace::SRGB.to_xyz_under(white::D50) * Vector3::from(seen)));
        truth.push(patch.xyz(&d50));
        let rgb = Vector3::from(camera.response(&patch.reflectance, light));
        ideal.push(Xyz::from(matrix * rgb.component_div(&Vector3::from(neutral))));
    }
    let sum = |colours: &[Xyz]| colours.iter().map(|c| c.y).sum::<f64>();
    let off = |right: &[Xyz], paper: Xyz| -> Vec<f64> {
        let gain = sum(right) / sum(&shown);
        shown.iter().zip(right).map(|(s, r)| de2000(s.scaled(gain).lab(white::D50), r.lab(paper))).collect()
    };
    // The matrix is for light of any unit; the paper that it calls white has Y = 1.
    let scale = sum(&truth) / sum(&ideal);
    let ideal: Vec<Xyz> = ideal.into_iter().map(|c| c.scaled(scale)).collect();
    let (from_truth, from_ideal) = (off(&truth, paper), off(&ideal, white::D50));
    let largest = |v: &[f64]| v.iter().copied().fold(0.0, f64::max);
    Differences {
        mean: from_truth.iter().sum::<f64>() / 24.0,
        most: largest(&from_truth),
        added: largest(&from_ideal),
    }
}

/// Fails unless the chart is within the limits; nothing but the camera's matrix may make a visible difference.
fn check(
    capture: &Capture,
    scene: &Scene,
    camera: &Camera,
    light: &Spectrum,
    limits: (f64, f64),
    what: &str,
) {
    let Differences { mean, most, added } = differences(capture, scene, camera, light);
    assert!(mean < limits.0 && most < limits.1, "{what}: mean {mean}, largest {most}");
    assert!(added < 0.3, "{what}: {added} more than the matrix explains");
}

/// Limits for the simulated camera, whose forward matrices leave a mean of 0.74 and at most 3.04 in daylight.
const DAY: (f64, f64) = (0.85, 3.4);

fn day() -> Spectrum {
    Exposure::default().light
}

fn decoded(bytes: &[u8]) -> Capture {
    darkroot_raw::decode(bytes, Decoder::Flashraw, &Limits::default()).unwrap()
}

#[test]
fn the_chart_in_a_dng_has_its_colours_under_any_filters() {
    let scene = Scene::still_life(SIZE);
    let storages = [dng::Storage::Uncompressed, dng::Storage::JpegStrip, dng::Storage::JpegTiles];
    for (i, (name, layout)) in layouts().into_iter().enumerate() {
        // How samples are stored is known not to matter for their colours: each way in turn.
        let storage = storages[i % 3];
        let camera = Camera { layout, ..Camera::simulated_one() };
        let capture = decoded(&dng::write(&expose(&scene, &camera, &Exposure::default()), storage));
        check(&capture, &scene, &camera, &day(), DAY, &format!("{name} {storage:?}"));
    }
}

#[test]
fn an_even_patch_is_what_the_sensor_saw_of_it() {
    let scene = Scene::still_life(SIZE);
    let output = Output { space: OutputSpace::Camera, bits: Bits::Float };
    for (name, layout) in layouts() {
        let camera = camera(layout);
        let capture = exact(&scene, &camera, &Exposure::default());
        let picture = develop(&capture, None, &Recipe { output, ..measuring() });
        let neutral = camera.neutral(&day());
        let patches = scene.patches();
        let balanced = |i: usize| {
            let rgb = camera.response(&patches[i].reflectance, &day());
            [0, 1, 2].map(|c| rgb[c] / neutral[c])
        };
        let seen = |i: usize| mean(&picture, patches[i].inside(0.6).unwrap());
        let gain = seen(chart::WHITE)[1] / balanced(chart::WHITE)[1];
        for (i, patch) in patches.iter().enumerate() {
            let (seen, right) = (seen(i), balanced(i).map(|v| v * gain));
            let largest = right.iter().copied().fold(0.0, f64::max);
            let off = (0..3).map(|c| (seen[c] - right[c]).abs() / largest).fold(0.0, f64::max);
            assert!(off < 2e-3, "{name}, {}: {seen:?}, not {right:?}: {off}", patch.name);
        }
    }
}

#[test]
fn the_chart_has_its_colours_under_other_lights() {
    let scene = Scene::still_life(SIZE);
    let lights = [
        ("A", Spectrum::illuminant_a(), (1.85, 7.0)),
        ("D40", Spectrum::daylight(4000.0), (1.3, 5.0)),
        ("D75", Spectrum::daylight(7500.0), (0.9, 3.0)),
    ];
    let camera = Camera::simulated_one();
    for (name, light, limits) in lights {
        let exposure = Exposure { light, ..Exposure::default() };
        let bytes = dng::write(&expose(&scene, &camera, &exposure), dng::Storage::JpegTiles);
        check(&decoded(&bytes), &scene, &camera, &exposure.light, limits, name);
    }
}

#[test]
fn borders_and_odd_places_in_a_dng_do_not_change_its_colours() {
    let scene = Scene::still_life(SIZE);
    for (masked, crop) in [((1, 0), 0), ((0, 1), 3), ((3, 5), 2), ((8, 8), 4)] {
        for letters in ["RGGB", "BGGR"] {
            let camera = Camera { masked, crop, layout: filters(letters), ..Camera::simulated_one() };
            let capture =
                decoded(&dng::write(&expose(&scene, &camera, &Exposure::default()), dng::Storage::JpegTiles));
            assert_eq!((capture.active_area.x, capture.active_area.y), masked);
            check(&capture, &scene, &camera, &day(), DAY, &format!("{letters}, border {masked:?}"));
        }
    }
}

#[test]
fn a_camera_held_upright_gives_an_upright_chart() {
    let scene = Scene::still_life(SIZE);
    for exif in 1..=8 {
        let orientation = Orientation::from_exif(exif);
        let camera = Camera { crop: 0, ..Camera::simulated_one() };
        let exposure = Exposure { orientation, ..Exposure::default() };
        let capture = decoded(&dng::write(&expose(&scene, &camera, &exposure), dng::Storage::JpegTiles));
        assert_eq!(capture.orientation, orientation);
        check(&capture, &scene, &camera, &day(), DAY, &format!("orientation {exif}"));
    }
}

#[test]
fn the_chart_in_a_nef_has_its_colours_as_far_as_one_matrix_goes() {
    let scene = Scene::still_life(SIZE);
    for camera in [Camera::nikon_d750(), Camera::nikon_d750_12_bit()] {
        for storage in [nef::Storage::Uncompressed, nef::Storage::Lossless] {
            let capture =
                decoded(&nef::write(&expose(&scene, &camera, &Exposure::default()), storage).unwrap());
            check(
                &capture,
                &scene,
                &camera,
                &day(),
                (2.5, 7.5),
                &format!("{} bits {storage:?}", camera.bits),
            );
        }
    }
}

#[test]
fn the_samples_of_the_repository_show_their_chart() {
    let scene = Scene::still_life(Size { width: 720, height: 480 });
    // With noise, falloff of light and glare, and for the NEF with a foreign matrix.
    for (name, camera, limit) in
        [("still-life.dng", Camera::simulated_one(), 1.2), ("still-life.nef", Camera::nikon_d750(), 2.7)]
    {
        let capture = decoded(&std::fs::read(root().join("samples").join(name)).unwrap());
        let Differences { mean, .. } = differences(&capture, &scene, &camera, &day());
        assert!(mean < limit, "{name}: {mean}");
    }
}

#[test]
fn both_decoders_give_the_same_picture() {
    let scene = Scene::still_life(Size { width: 300, height: 200 });
    let bytes =
        dng::write(&expose(&scene, &Camera::simulated_one(), &Exposure::default()), dng::Storage::JpegStrip);
    let capture = |decoder| darkroot_raw::decode(&bytes, decoder, &Limits::default()).unwrap();
    let (one, two) = (capture(Decoder::Flashraw), capture(Decoder::Rawloader));
    assert!(one.counts == two.counts);
    assert!(develop(&one, None, &Recipe::default()) == develop(&two, None, &Recipe::default()));
}

#[test]
fn the_white_of_the_chart_is_shown_almost_white_and_its_black_almost_black() {
    let scene = Scene::still_life(SIZE);
    let exposure = Exposure { white: 0.65, ..Exposure::default() };
    let capture = expose(&scene, &Camera { crop: 0, ..Camera::simulated_one() }, &exposure);
    let picture = develop(&capture, None, &Recipe::default());
    let shown = |i: usize| lab(&RgbSpace::SRGB, mean(&picture, scene.patches()[i].inside(0.6).unwrap()));
    assert!(shown(chart::WHITE).l > 80.0 && shown(chart::WHITE).chroma() < 6.0, "{:?}", shown(chart::WHITE));
    assert!(shown(23).l < 30.0 && shown(23).chroma() < 3.0, "{:?}", shown(23));
}
