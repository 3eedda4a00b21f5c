//! Sharpness that the camera took is given back: edges get steep, not rimmed, and noise is not raised.

use darkroot_develop::{Analysis, Denoise, Recipe};
use darkroot_photo::{Capture, Layout, Size};
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{camera, develop, flat_grey, measuring, pixels, with_light};
use std::sync::Arc;

use darkroot_colour::Spectrum;

const SIZE: Size = Size { width: 240, height: 200 };
/// Columns that the edge moves to the side in a row: 5 degrees.
const SLANT: f64 = 0.0875;

/// Columns right of a slanted edge through the middle.
fn beyond(x: f64, y: f64) -> f64 {
    let (x, y) = (x - SIZE.width as f64 / 2.0, y - SIZE.height as f64 / 2.0);
    (x + SLANT * y) / (1.0 + SLANT * SLANT).sqrt()
}

/// Grey bars of 60 columns and 3 stops with slanted edges, blurred by a Gaussian and seen by square pixels.
fn bars(layout: Layout, blur: f64) -> Capture {
    const PARTS: usize = 6;
    let neutral = camera(layout.clone()).neutral(&Exposure::default().light);
    with_light(flat_grey(layout, SIZE, 0.5), |x, y| {
        let part = |i: usize| (i as f64 + 0.5) / PARTS as f64 - 0.5;
        let parts = (0..PARTS * PARTS).map(|i| {
            let distance = beyond(x as f64 + part(i % PARTS), y as f64 + part(i / PARTS));
            let in_pair = (distance + 30.0).rem_euclid(120.0);
            share_below((30.0 - (in_pair - 60.0).abs()) / blur)
        });
        let share = parts.sum::<f64>() / (PARTS * PARTS) as f64;
        neutral.map(|v| (v * (0.05 + 0.35 * share)) as f32)
    })
}

/// Distribution function of the normal distribution: Abramowitz and Stegun 26.2.17, to 7.5e-8.
fn share_below(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * x.abs());
    let poly = [1.330_274_429, -1.821_255_978, 1.781_477_937, -0.356_563_782, 0.319_381_53];
    let tail = poly.into_iter().fold(0.0, |sum, c| (sum + c) * t) * (-0.5 * x * x).exp()
        / std::f64::consts::TAU.sqrt();
    if x > 0.0 { 1.0 - tail } else { tail }
}

/// Frequency (cycles a pixel) at which the edge in the middle keeps half of its contrast, by its spread over eighths of a pixel (after
/// ISO 12233), and by how much of its height it overshoots.
fn sharpness(capture: &Capture, sharpen: f32) -> (f64, f64) {
    const EIGHTHS: f64 = 8.0;
    const REACH: i64 = 160;
    let picture = develop(capture, None, &Recipe { sharpen: Some(sharpen), ..measuring() });
    let mut sums = vec![(0.0, 0.0); 2 * REACH as usize];
    for (i, pixel) in pixels(&picture).iter().enumerate() {
        let (x, y) = (i % SIZE.width, i / SIZE.width);
        let place = (beyond(x as f64, y as f64) * EIGHTHS).round() as i64 + REACH;
        if (20..SIZE.height - 20).contains(&y) && (0..2 * REACH).contains(&place) {
            sums[place as usize].0 += pixel[1];
            sums[place as usize].1 += 1.0;
        }
    }
    let spread: Vec<f64> = sums.iter().map(|(sum, n)| sum / n).collect();
    let (low, high) = (spread[REACH as usize / 2], spread[3 * REACH as usize / 2]);
    let most = spread.iter().fold(f64::MIN, |a, &b| a.max(b));
    let least = spread.iter().fold(f64::MAX, |a, &b| a.min(b));
    let over = (most - high).max(low - least) / (high - low);
    let contrast = |frequency: f64| {
        let wave = |i: usize| std::f64::consts::TAU * frequency * i as f64 / EIGHTHS;
        let steps = || spread.windows(2).map(|w| w[1] - w[0]).enumerate();
        let (re, im) = steps()
            .fold((0.0, 0.0), |(re, im), (i, step)| (re + step * wave(i).cos(), im + step * wave(i).sin()));
        re.hypot(im) / (high - low)
    };
    let half = (1..1000).map(|i| f64::from(i) / 1000.0).find(|&f| contrast(f) < 0.5).unwrap();
    (half, over)
}

#[test]
fn edges_get_steep_and_no_rims() {
    for (layout, blur, least) in [
        (filters("RGGB"), 0.5, 1.25),
        (filters("GBRG"), 0.65, 1.45),
        (filters("BGGR"), 0.8, 1.6),
        (x_trans(), 0.65, 1.3),
    ] {
        let capture = bars(layout.clone(), blur);
        let told = Analysis::of(Arc::new(capture.clone())).blur();
        println!(
            "{layout:?} {blur}: told {told:?}, off {:?}, on {:?}",
            sharpness(&capture, 0.0),
            sharpness(&capture, 1.0)
        );
        let told = f64::from(told.unwrap());
        assert!((told - blur).abs() < 0.06, "{blur}: {told}");
        let ((off, _), (on, over)) = (sharpness(&capture, 0.0), sharpness(&capture, 1.0));
        assert!(on > least * off && over < 0.05, "{blur}: {off} to {on}, over by {over}");
    }
}

#[test]
fn noise_of_even_fields_is_not_raised() {
    for (layout, stops) in [(filters("RGGB"), 0.0), (filters("GRBG"), -4.0), (x_trans(), -3.0)] {
        let exposure = Exposure { stops, noise: Some(9), ..Exposure::default() };
        let scene = Scene::flat(SIZE, Spectrum::constant(0.3));
        let capture = expose(&scene, &camera(layout.clone()), &exposure);
        for amount in [0.0, 1.0] {
            let spread = |sharpen: f32| {
                let denoise = Denoise { amount: Some(amount), ..Denoise::default() };
                let recipe = Recipe { denoise, sharpen: Some(sharpen), ..measuring() };
                let green: Vec<f64> =
                    pixels(&develop(&capture, None, &recipe)).iter().map(|p| p[1]).collect();
                let mean = green.iter().sum::<f64>() / green.len() as f64;
                (green.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / green.len() as f64).sqrt()
            };
            let (off, on) = (spread(0.0), spread(1.0));
            println!("{layout:?} {stops} {amount}: {}", on / off);
            assert!(on < 1.1 * off, "{layout:?} {stops} {amount}: {off} to {on}");
        }
    }
}

#[test]
fn who_measures_gets_what_the_sensor_saw() {
    let capture = bars(filters("RGGB"), 0.6);
    let off = develop(&capture, None, &Recipe { sharpen: Some(0.0), ..measuring() });
    assert!(develop(&capture, None, &measuring()) == off);
    let people = |sharpen| develop(&capture, None, &Recipe { sharpen, ..Recipe::default() });
    assert!(people(None) == people(Some(1.0)) && people(None) != people(Some(0.0)));
}
