//! What the tests across the crates share: captures whose light is known exactly, profiles, pictures as numbers.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // Helpers of tests; a panic is a failed test.

pub mod small_raws;
pub mod tiff_mutator;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot_colour::{Lab, RgbSpace, Spectrum, Vector3, Xyz, white};
use darkroot_develop::{Analysis, Bits, Cancel, Look, Output, OutputSpace, Plan, Recipe, Scale};
use darkroot_photo::{
    BlackLevel, Capture, Counts, Layout, Mosaic, Picture, PictureSpace, Rect, Samples, Size, WhiteLevel,
};
use darkroot_profile::{Calibration, Kind, Light, Order, Origin, Profile, ProfileCamera, RootPolynomial};
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, chart};

/// The folder of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// A folder of real files. Tests that need one are ignored where it is not (`tests/build.rs`).
pub fn real_files(folder: &str) -> PathBuf {
    root().join(std::env::var_os("DARKROOT_DATA").unwrap()).join(folder)
}

/// A plan for a capture that nothing is known of yet.
///
/// # Errors
/// What does not fit.
pub fn plan(
    capture: &Capture,
    profile: Option<&Profile>,
    recipe: &Recipe,
) -> Result<Plan, darkroot_develop::Error> {
    darkroot_develop::plan(&Analysis::deferred(Arc::new(capture.clone())), profile, recipe)
}

/// The whole picture of a plan.
pub fn rendered(plan: &Plan) -> Picture {
    plan.render(plan.whole(Scale::FULL), &Cancel::default()).unwrap()
}

/// The whole picture of a plan, made in tiles of this size.
pub fn rendered_in_tiles(plan: &Plan, columns: usize, rows: usize) -> Picture {
    plan.render_in_tiles(plan.whole(Scale::FULL), &Cancel::default(), columns, rows).unwrap()
}

/// The simulated camera with another filter array, without a margin around its crop.
pub fn camera(layout: Layout) -> Camera {
    Camera { layout, crop: 0, ..Camera::simulated_one() }
}

/// The four phases of Bayer, X-Trans, linear RGB.
pub fn layouts() -> Vec<(&'static str, Layout)> {
    let bayer = ["RGGB", "GRBG", "GBRG", "BGGR"].map(|letters| (letters, filters(letters)));
    [&bayer[..], &[("X-Trans", x_trans()), ("linear RGB", Layout::Rgb)]].concat()
}

/// The capture with other light: `light` gives unbalanced camera RGB (1 = saturated) for a column and row of the
/// frame. Stored as floating point with black 0 and white 1, so nothing is rounded and nothing is cut.
#[must_use]
pub fn with_light(mut capture: Capture, light: impl Fn(usize, usize) -> [f32; 3]) -> Capture {
    let (size, layout) = (capture.counts.size(), capture.counts.layout().clone());
    let mut samples = Vec::with_capacity(size.area() * layout.planes());
    for y in 0..size.height {
        for x in 0..size.width {
            let seen = light(x, y);
            match &layout {
                Layout::Cfa(cfa) => samples.push(seen[cfa.at(x, y).plane().unwrap_or(1)]),
                Layout::Monochrome => samples.push(seen[1]),
                Layout::Rgb => samples.extend(seen),
            }
        }
    }
    capture.counts = Counts::F32(Mosaic { size, layout, samples });
    capture.black = BlackLevel::uniform(0.0);
    capture.white = WhiteLevel([1.0; 3]);
    capture
}

/// What `camera` would see of `scene` if it counted without rounding and never saturated: no noise, falloff or glare.
pub fn exact(scene: &Scene, camera: &Camera, exposure: &Exposure) -> Capture {
    let reference = camera.response(&chart::white(), &exposure.light).into_iter().fold(0.0, f64::max);
    let gain = exposure.white / reference * exposure.stops.exp2();
    let picture = scene.seen_by(|r| camera.response(r, &exposure.light).map(|v| v * gain));
    let capture = expose(scene, camera, exposure);
    let (area, upright) = (capture.active_area, scene.size());
    let orientation = capture.orientation;
    with_light(capture, |x, y| {
        if x < area.x || y < area.y {
            return [0.0; 3];
        }
        let (u, v) = orientation.place(x - area.x, y - area.y, area.size());
        picture[v * upright.width + u]
    })
}

/// An evenly lit grey of `level` of saturation in the brightest channel, under the default light.
pub fn flat_grey(layout: Layout, size: Size, level: f32) -> Capture {
    let camera = camera(layout);
    let neutral = camera.neutral(&Exposure::default().light).map(|v| v as f32 * level);
    with_light(expose(&Scene::flat(size, Spectrum::constant(0.5)), &camera, &Exposure::default()), |_, _| {
        neutral
    })
}

/// The capture with every sample multiplied: more light on the same sensor, without an end to its range.
#[must_use]
pub fn brighter(mut capture: Capture, factor: f32) -> Capture {
    match &mut capture.counts {
        Counts::F32(mosaic) => mosaic.samples.iter_mut().for_each(|v| *v *= factor),
        Counts::U16(_) => panic!("only floating-point captures have no end to their range"),
    }
    capture
}

/// The capture cut at saturation, as a sensor does.
#[must_use]
pub fn saturated(mut capture: Capture) -> Capture {
    match &mut capture.counts {
        Counts::F32(mosaic) => mosaic.samples.iter_mut().for_each(|v| *v = v.min(1.0)),
        Counts::U16(_) => {}
    }
    capture
}

/// A profile for the capture's camera: its forward matrix, bent by every term of the order, with coefficients that
/// sum to the white of D50.
pub fn bent_profile(capture: &Capture, order: u8) -> Profile {
    let order = Order::new(order).unwrap();
    let forward = capture.calibrations.last().unwrap().forward_matrix.unwrap();
    let mut coefficients: Vec<[f64; 3]> = (0..3).map(|c| [0, 1, 2].map(|row| forward[(row, c)])).collect();
    for i in 3..order.terms().len() {
        let bend = [0.05, -0.03, 0.04].map(|b| b * if i % 2 == 0 { 1.0 } else { -0.7 } / (i as f64 - 1.0));
        coefficients.push(bend);
        for (k, b) in bend.into_iter().enumerate() {
            coefficients[i % 3][k] -= b;
        }
    }
    let light = Light { name: "D55".into(), xy: darkroot_colour::temperature::daylight_xy(5503.0) };
    let model = RootPolynomial::new(order, coefficients).unwrap().into();
    let calibration = Calibration::new(light, Kind::plain(order), model);
    let camera = ProfileCamera {
        make: capture.camera.common_make.clone(),
        model: capture.camera.common_model.clone(),
        aliases: Vec::new(),
    };
    let origin = Origin { summary: "written by hand for a test".into(), ..Origin::default() };
    Profile::new(camera, vec![calibration], origin).unwrap()
}

/// The profiles that facts about colour must hold for: the camera's matrices and root polynomials of each order.
pub fn profiles(capture: &Capture) -> [Option<Profile>; 4] {
    [None, Some(bent_profile(capture, 2)), Some(bent_profile(capture, 3)), Some(bent_profile(capture, 4))]
}

/// A recipe for measuring: linear sRGB in floating point.
pub fn measuring() -> Recipe {
    Recipe { look: Look::Linear, output: output(RgbSpace::SRGB.linear(), Bits::Float), ..Recipe::default() }
}

/// An output in an RGB space.
pub fn output(space: RgbSpace, bits: Bits) -> Output {
    Output { space: OutputSpace::Rgb(space), bits }
}

/// Plans and renders.
pub fn develop(capture: &Capture, profile: Option<&Profile>, recipe: &Recipe) -> Picture {
    rendered(&plan(capture, profile, recipe).unwrap())
}

/// Pixels as numbers, 0 = black, 1 = white.
pub fn pixels(picture: &Picture) -> Vec<[f64; 3]> {
    let triples = |v: Vec<f64>| v.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    match &picture.samples {
        Samples::U8(v) => triples(v.iter().map(|&v| f64::from(v) / 255.0).collect()),
        Samples::U16(v) => triples(v.iter().map(|&v| f64::from(v) / 65535.0).collect()),
        Samples::F32(v) => triples(v.iter().map(|&v| f64::from(v)).collect()),
    }
}

/// Mean of the pixels of a rectangle.
pub fn mean(picture: &Picture, rect: Rect) -> [f64; 3] {
    let pixels = pixels(picture);
    let mut sum = [0.0; 3];
    for y in rect.y..rect.bottom() {
        for pixel in &pixels[y * picture.size.width + rect.x..][..rect.width] {
            (0..3).for_each(|c| sum[c] += pixel[c]);
        }
    }
    sum.map(|s| s / rect.size().area() as f64)
}

/// CIELAB under D50 of encoded numbers of an RGB space.
pub fn lab(space: &RgbSpace, encoded: [f64; 3]) -> Lab {
    let linear = Vector3::from(encoded.map(|v| space.curve.decode(v)));
    Xyz::from(space.to_xyz_under(white::D50) * linear).lab(white::D50)
}

/// Colour space of a picture that has one.
pub fn space_of(picture: &Picture) -> RgbSpace {
    match picture.space {
        PictureSpace::Rgb(space) => space,
        PictureSpace::Camera | PictureSpace::Raw => panic!("camera RGB is no RGB space"),
    }
}
