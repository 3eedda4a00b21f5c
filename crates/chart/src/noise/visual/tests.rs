use super::*;
use darkroot_colour::Spectrum;
use darkroot_photo::{Counts, Size};
use darkroot_simulate::{Camera, Exposure, Scene, expose::expose};

const SIDE: usize = 128;
const WHOLE: Quad = [[0.0, 0.0], [127.0, 0.0], [127.0, 127.0], [0.0, 127.0]];
/// Light that is XYZ itself.
const PLAIN: Matrix3 = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);

fn picture(pixel: impl Fn(usize, usize) -> [f64; 3]) -> Mosaic<f32> {
    let size = Size { width: SIDE, height: SIDE };
    let samples = (0..size.area()).flat_map(|i| pixel(i % SIDE, i / SIDE).map(|v| v as f32)).collect();
    Mosaic { size, layout: Layout::Rgb, samples }
}

/// A grey of luminance `y` under D50 with `x` of luminance and `c` of red against green in waves across.
fn waves(y: f64, luminance: f64, red: f64, count: usize) -> Mosaic<f32> {
    let from_e = bradford(EQUAL_ENERGY, white::D50);
    picture(|x, _| {
        let wave = (std::f64::consts::TAU * (count * x) as f64 / SIDE as f64).cos();
        let level = y + luminance * wave;
        let d50: [f64; 3] = (from_e * Vector3::new(level + red * wave, level, level)).into();
        d50
    })
}

/// L* a unit of Y.
fn lightness_slope(y: f64) -> f64 {
    116.0 / 3.0 * y.powf(-2.0 / 3.0)
}

#[test]
fn a_wave_of_light_is_seen_by_the_sensitivity_at_its_frequency() {
    // 12 waves over 128 pixels are 0.09375 cycles a pixel, at 40 pixels a degree 3.75 cycles a degree.
    let found = visual_noise(&waves(0.3, 0.004, 0.0, 12), &PLAIN, &WHOLE, 40.0).unwrap();
    let truth = 0.004 / 2f64.sqrt() * lightness_slope(0.3) * achromatic(3.75);
    assert!((found.l / truth - 1.0).abs() < 0.01, "{found:?} {truth}");
    assert!((achromatic(4.0) - 3.0).abs() < 0.001);
    // A grey that gets lighter keeps its chromaticity.
    assert!(found.u < 0.01 && found.v < 0.01, "{found:?}");
    // The same wave from four times as far is too fine to be seen.
    let far = visual_noise(&waves(0.3, 0.004, 0.0, 12), &PLAIN, &WHOLE, 320.0).unwrap();
    assert!(far.l < 0.2 * found.l, "{far:?}");
}

#[test]
fn a_wave_of_colour_is_seen_by_the_sensitivity_to_colour() {
    let found = visual_noise(&waves(0.3, 0.0, 0.004, 12), &PLAIN, &WHOLE, 40.0).unwrap();
    // X of illuminant E to u* under D65, by differences.
    let out = bradford(EQUAL_ENERGY, white::D65);
    let u = |x: f64| Xyz::from(out * Vector3::new(0.3 + x, 0.3, 0.3)).luv(white::D65).u;
    let truth = (u(0.001) - u(-0.001)) / 0.002 * 0.004 / 2f64.sqrt() * red_green(3.75);
    assert!((found.u / truth - 1.0).abs() < 0.01, "{found:?} {truth}");
    // Bradford's transform to D65 moves a little of X into Y.
    assert!(found.l < 0.1 * found.u, "{found:?}");
}

#[test]
fn a_simulated_shot_has_the_visual_noise_of_its_electrons() {
    let camera = Camera { layout: Layout::Monochrome, crop: 0, full_well: 8000.0, ..Camera::simulated_one() };
    let exposure = Exposure { noise: Some(11), ..Exposure::default() };
    let size = Size { width: SIDE, height: SIDE };
    let Counts::U16(counts) = expose(&Scene::flat(size, Spectrum::constant(0.4)), &camera, &exposure).counts
    else {
        panic!("whole numbers")
    };
    let level = |count: u16| (f64::from(count) - 512.0) / (15_892.0 - 512.0);
    let from_e = bradford(EQUAL_ENERGY, white::D50);
    let shot = picture(|x, y| {
        let v = level(counts.samples[y * SIDE + x]);
        (from_e * Vector3::new(v, v, v)).into()
    });
    let found = visual_noise(&shot, &PLAIN, &WHOLE, 41.0).unwrap();
    let mean = counts.samples.iter().map(|count| level(*count)).sum::<f64>() / size.area() as f64;
    let electrons = mean * 8000.0;
    let deviation = (electrons + camera.read_noise.powi(2)).sqrt() / 8000.0;
    // The mean of the squared sensitivity over all frequencies of the square.
    let cycles = |i: usize| i.min(SIDE - i) as f64 / SIDE as f64 * 41.0;
    let square = |i: usize| achromatic(cycles(i % SIDE).hypot(cycles(i / SIDE))).powi(2);
    let seen = (0..size.area()).map(square).sum::<f64>() / size.area() as f64;
    let truth = deviation * lightness_slope(mean) * seen.sqrt();
    assert!((found.l / truth - 1.0).abs() < 0.03, "{found:?} {truth}");
    // Grey noise has the chromaticity of the grey, and so no colour.
    assert!((found.weighted() / found.l - 1.0).abs() < 0.02, "{found:?}");
}

#[test]
fn an_even_patch_and_a_slope_of_light_have_none() {
    let slope = picture(|x, y| [0.3 + 0.0004 * x as f64 + 0.0002 * y as f64; 3]);
    assert!(visual_noise(&slope, &PLAIN, &WHOLE, 41.0).unwrap().weighted() < 0.01);
    let black = picture(|_, _| [0.0; 3]);
    assert!(visual_noise(&black, &PLAIN, &WHOLE, 41.0).unwrap().weighted() < 1e-9);
}

#[test]
fn a_window_that_is_small_or_lies_outside_tells_nothing() {
    let grey = picture(|_, _| [0.3; 3]);
    let small = [[10.0, 10.0], [30.0, 10.0], [30.0, 30.0], [10.0, 30.0]];
    let outside = [[200.0, 10.0], [300.0, 10.0], [300.0, 90.0], [200.0, 90.0]];
    let nowhere = [[f64::NAN, 10.0], [300.0, 10.0], [300.0, 90.0], [200.0, 90.0]];
    for window in [small, outside, nowhere] {
        assert_eq!(visual_noise(&grey, &PLAIN, &window, 41.0), None);
    }
}
