//! Ramps into clipping: what is rebuilt, toned and fitted is continuous in light and keeps its hue.

use darkroot_colour::difference::de2000;
use darkroot_colour::{Lab, Oklab, RgbSpace, Spectrum, Vector3, Xyz, white};
use darkroot_develop::{Bits, Recipe};
use darkroot_photo::{Capture, Layout, Size};
use darkroot_simulate::camera::filters;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{camera, develop, exact, lab, output, pixels, saturated, with_light};

/// Stops of a ramp, its brightest channel clipping at 0, and columns for each.
const STOPS: (f64, f64) = (-2.5, 4.5);
const COLUMNS: f64 = 1.0 / 0.0275;
/// Columns that are 0.055 stops apart.
const STEP: usize = 2;
const ROWS: usize = 16;

fn stops(x: usize) -> f64 {
    STOPS.0 + x as f64 / COLUMNS
}

/// Standard normal numbers, the same each time.
fn normal(index: usize) -> f64 {
    let hashed = |i: u64| {
        let mut v = i.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        v = (v ^ (v >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (v ^ (v >> 29)) as f64 / u64::MAX as f64
    };
    (0..12).map(|k| hashed(12 * index as u64 + k + 1)).sum::<f64>() - 6.0
}

/// A colour (balanced camera RGB) that grows brighter from left to right, clipped by the sensor.
fn ramp(layout: Layout, light: &Spectrum, colour: [f64; 3], noise: bool) -> Capture {
    let size = Size { width: ((STOPS.1 - STOPS.0) * COLUMNS) as usize, height: ROWS };
    let neutral = camera(Layout::Rgb).neutral(light);
    let brightest = (0..3).map(|c| colour[c] * neutral[c]).fold(0.0, f64::max);
    let exposure = Exposure { light: light.clone(), ..Exposure::default() };
    let template = exact(&Scene::gradient(size), &camera(layout), &exposure);
    saturated(with_light(template, |x, y| {
        let scale = stops(x).exp2() / brightest;
        [0, 1, 2].map(|c| {
            let v = colour[c] * neutral[c] * scale;
            let electrons = 40_000.0;
            let error =
                if noise { normal(3 * (y * size.width + x) + c) * (v / electrons).sqrt() } else { 0.0 };
            (v + error) as f32
        })
    }))
}

/// Colours of the ramp in the developed picture, means of its middle rows.
fn shown(capture: &Capture) -> Vec<[f64; 3]> {
    let width = capture.active_area.width;
    let recipe = Recipe { output: output(RgbSpace::SRGB.linear(), Bits::Float), ..Recipe::default() };
    let picture = pixels(&develop(capture, None, &recipe));
    let rows = 4..ROWS - 4;
    let mean =
        |x: usize, c: usize| rows.clone().map(|y| picture[y * width + x][c]).sum::<f64>() / rows.len() as f64;
    (0..width).map(|x| [0, 1, 2].map(|c| mean(x, c))).collect()
}

fn lab_of(rgb: [f64; 3]) -> Lab {
    lab(&RgbSpace::SRGB.linear(), rgb)
}

fn oklab_of(rgb: [f64; 3]) -> Oklab {
    Oklab::of(Xyz::from(RgbSpace::SRGB.to_xyz_under(white::D65) * Vector3::from(rgb)))
}

/// Largest step within 0.055 stops from a stop below clipping on, and how far the hue goes from that of two stops below.
fn figures(shown: &[[f64; 3]]) -> (f64, f64) {
    let inner = 8..shown.len() - 8;
    let from = |stop: f64| inner.clone().filter(move |&x| stops(x) > stop);
    let steps = from(-1.0).filter(|x| inner.contains(&(x + STEP)));
    let steps = steps.map(|x| de2000(lab_of(shown[x]), lab_of(shown[x + STEP])));
    let below: Vec<usize> = from(-2.2).take_while(|&x| stops(x) < -1.8).collect();
    let mean = [0, 1, 2].map(|c| below.iter().map(|&x| shown[x][c]).sum::<f64>() / below.len() as f64);
    let hue = oklab_of(mean);
    let coloured = from(-1.5).map(|x| oklab_of(shown[x])).filter(|c| c.chroma() > 0.02);
    (steps.fold(0.0, f64::max), coloured.map(|c| c.hue_difference(hue)).fold(0.0, f64::max))
}

/// Steps and skews of ramps of twelve hues: the largest step, the mean of largest steps, the mean of largest skews.
fn of_hues(layout: &Layout, light: &Spectrum, strength: f64, noise: bool) -> (f64, f64, f64) {
    let found: Vec<(f64, f64)> = (0..12)
        .map(|i| {
            let hue = f64::from(i) * std::f64::consts::TAU / 12.0;
            let third = std::f64::consts::TAU / 3.0;
            let colour = [0.0, 1.0, 2.0].map(|c: f64| 1.0 + strength * (hue - c * third).cos());
            figures(&shown(&ramp(layout.clone(), light, colour, noise)))
        })
        .collect();
    let mean = |v: fn(&(f64, f64)) -> f64| found.iter().map(v).sum::<f64>() / found.len() as f64;
    (found.iter().map(|f| f.0).fold(0.0, f64::max), mean(|f| f.0), mean(|f| f.1))
}

#[test]
fn ramps_of_every_hue_run_into_clipping_without_steps_and_keep_their_hue() {
    let mut wrong = Vec::new();
    for (layout, letters) in [(filters("RGGB"), "RGGB"), (Layout::Rgb, "linear RGB")] {
        for (kelvin, light) in [(6504, Spectrum::daylight(6504.0)), (2856, Spectrum::illuminant_a())] {
            for (strength, most, mean, skew) in BOUNDS {
                let found = of_hues(&layout, &light, strength, false);
                if found.0 > most || found.1 > mean || found.2 > skew {
                    wrong.push(format!("{letters}, {kelvin} K, strength {strength}: {found:.2?}"));
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "largest step, mean of largest steps, mean of largest skews:\n{}",
        wrong.join("\n")
    );
}

/// Strength of the colours; largest step, mean of the largest steps of each hue, mean of their largest skews.
///
/// Measured: 1.7, 0.94 and 0.2 degrees; 2.3, 1.11 and 0.5; 2.3, 1.32 and 0.8. The curve alone, of a sensor without an end,
/// takes 1.8 and 0.9; the largest one of 0.4 is its own, of a yellow before it clips.
const BOUNDS: [(f64, f64, f64, f64); 3] = [(0.2, 1.8, 1.0, 1.0), (0.4, 2.4, 1.2, 1.0), (0.7, 2.5, 1.4, 1.5)];

#[test]
fn noise_makes_no_steps() {
    let clean = of_hues(&filters("RGGB"), &Spectrum::daylight(6504.0), 0.4, false);
    let noisy = of_hues(&filters("RGGB"), &Spectrum::daylight(6504.0), 0.4, true);
    assert!(
        noisy.0 < clean.0 + 1.0 && noisy.1 < clean.1 + 0.5 && noisy.2 < clean.2 + 4.0,
        "{clean:?} {noisy:?}"
    );
}
