use super::*;
use darkroot_photo::{Layout, Size};

const SIZE: Size = Size { width: 160, height: 160 };
/// A patch that stands five degrees from the rows.
const PATCH: Quad = [[35.0, 45.0], [115.0, 38.0], [122.0, 118.0], [42.0, 125.0]];

/// Signed distance inside of a convex patch, pixels.
fn inside(x: f64, y: f64) -> f64 {
    let side = |i: usize| {
        let ([ax, ay], [bx, by]) = (PATCH[i], PATCH[(i + 1) % 4]);
        ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / (bx - ax).hypot(by - ay)
    };
    (0..4).map(side).fold(f64::INFINITY, f64::min)
}

/// The normal distribution's integral (Abramowitz and Stegun, 7.1.26: wrong by 1.5e-7).
fn normal(v: f64) -> f64 {
    let x = v.abs() / 2f64.sqrt();
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let series = t
        * (0.254_829_592
            + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    let half = 0.5 * (1.0 - series * (-x * x).exp());
    if v < 0.0 { 0.5 - half } else { 0.5 + half }
}

/// A picture of the patch under a Gaussian blur of `sigma` pixels, each channel moved along x.
fn picture(sigma: f64, shifts: [f64; 3], sharpened: f64) -> Mosaic<f32> {
    let mut samples = Vec::new();
    for y in 0..SIZE.height {
        for x in 0..SIZE.width {
            for shift in shifts {
                let at = |s: f64| normal(inside(x as f64 - shift, y as f64) / s);
                let light = at(sigma) + sharpened * (at(sigma) - at(2.5 * sigma));
                samples.push((0.1 + 0.7 * light) as f32);
            }
        }
    }
    Mosaic { size: SIZE, layout: Layout::Rgb, samples }
}

fn seen(picture: &Mosaic<f32>) -> Vec<EdgeResponse> {
    responses(picture, [0.2, 0.7, 0.1], &[PATCH], 0.3)
}

#[test]
fn the_response_is_that_of_the_blur() {
    for sigma in [0.5, 0.8, 1.2] {
        let edges = seen(&picture(sigma, [0.0; 3], 0.0));
        assert_eq!(edges.len(), 4, "{sigma}");
        for edge in &edges {
            for i in 0..=100 {
                let f = i as f64 / 200.0;
                let truth = (-2.0 * (PI * sigma * f).powi(2)).exp();
                assert!(
                    (edge.response[i] - truth).abs() < 0.025,
                    "{sigma} at {f}: {} {truth}",
                    edge.response[i]
                );
            }
            let half = (2f64.ln() / 2.0).sqrt() / (PI * sigma);
            assert!((edge.falls_to(0.5) - half).abs() < 0.01, "{sigma}: {} {half}", edge.falls_to(0.5));
            assert!(edge.peak() < 1.0 && edge.shifts.iter().all(|s| s.abs() < 1e-6), "{sigma}");
        }
    }
}

#[test]
fn sharpening_is_a_response_above_one() {
    let peaks: Vec<f64> = seen(&picture(0.8, [0.0; 3], 0.8)).iter().map(EdgeResponse::peak).collect();
    // 1.8 exp(-2 (pi 0.8 f)^2) - 0.8 exp(-2 (pi 2 f)^2) has its largest value near f = 0.16.
    let truth = (0..200)
        .map(|i| f64::from(i) / 400.0)
        .map(|f| 1.8 * (-2.0 * (PI * 0.8 * f).powi(2)).exp() - 0.8 * (-2.0 * (PI * 2.0 * f).powi(2)).exp());
    let truth = truth.fold(0.0, f64::max);
    assert!(peaks.iter().all(|peak| (peak - truth).abs() < 0.03), "{peaks:?} {truth}");
}

#[test]
fn channels_beside_each_other_are_told_by_how_much() {
    let edges = seen(&picture(0.8, [0.4, 0.0, -0.2], 0.0));
    let largest = |c: usize| edges.iter().map(|e| e.shifts[c].abs()).fold(0.0, f64::max);
    assert!((largest(0) - 0.4).abs() < 0.02 && (largest(1) - 0.2).abs() < 0.02, "{edges:?}");
}

#[test]
fn edges_that_stand_straight_or_have_no_contrast_do_not_tell() {
    let flat = Mosaic { size: SIZE, layout: Layout::Rgb, samples: vec![0.5; 3 * SIZE.area()] };
    assert!(seen(&flat).is_empty());
    let straight: Quad = [[40.0, 40.0], [120.0, 40.0], [120.0, 120.0], [40.0, 120.0]];
    let picture = picture(0.8, [0.0; 3], 0.0);
    let mut upright = flat.clone();
    for (i, v) in upright.samples.iter_mut().enumerate() {
        let inside = |v: usize| (40..120).contains(&v);
        *v = if inside(i / 3 % SIZE.width) && inside(i / 3 / SIZE.width) { 0.8 } else { 0.1 };
    }
    assert!(responses(&upright, [0.2, 0.7, 0.1], &[straight], 0.3).is_empty());
    assert!(responses(&picture, [0.2, 0.7, 0.1], &[PATCH.map(|p| p.map(|v| v * 0.1))], 0.3).is_empty());
    let wild: Quad = [[f64::NAN, 0.0], [1e9, 0.0], [1e9, 1e9], [0.0, 1e9]];
    assert!(responses(&picture, [0.2, 0.7, 0.1], &[wild], 0.3).is_empty());
}
