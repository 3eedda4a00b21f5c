use darkroot_colour::RgbSpace;
use darkroot_photo::{Picture, PictureSpace, Samples, Size};

use super::*;

fn picture(size: Size, of: impl Fn(f64, f64) -> [f32; 3]) -> Picture {
    let at = |i: usize| {
        let (x, y) = (i % size.width, i / size.width);
        of((x as f64 + 0.5) / size.width as f64, (y as f64 + 0.5) / size.height as f64)
    };
    let samples = Samples::F32((0..size.area()).flat_map(at).collect());
    Picture { size, samples, space: PictureSpace::Rgb(RgbSpace::SRGB.linear()) }
}

const OURS: Size = Size { width: 256, height: 171 };

/// Tones of all kinds in soft shapes, some of them coloured, and a hard edge.
fn scene(x: f64, y: f64) -> [f32; 3] {
    let tone = 0.5 + 0.5 * (5.0 * x + 1.5 * (4.0 * y).sin()).sin();
    let light = (tone * tone * 0.9 + 0.002) * if x > 0.6 && y > 0.6 { 0.3 } else { 1.0 };
    let colour = 0.3 * (7.0 * y).cos();
    [light * (1.0 + colour), light, light * (1.0 - 0.8 * colour)].map(|v| v.min(1.0) as f32)
}

/// What a camera makes of it: an S-shaped curve of lightness.
fn camera(light: f64) -> f64 {
    let l = TransferCurve::LStar.encode(light.clamp(0.0, 1.0));
    TransferCurve::LStar
        .decode((l + 0.12 * (l * std::f64::consts::TAU / 2.0).sin() * (2.0 * l - 0.7)).clamp(0.0, 1.0))
}

fn rendered(x: f64, y: f64) -> [f32; 3] {
    let rgb = scene(x, y).map(f64::from);
    let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    rgb.map(|v| (v * camera(luminance) / luminance).min(1.0) as f32)
}

use darkroot_colour::TransferCurve;

/// The scene with its chroma times a factor, and all of it warmer.
fn coloured(factor: f64, warmer: f64) -> Picture {
    picture(OURS, |x, y| {
        let [r, g, b] = scene(x, y).map(f64::from);
        let grey = (r + g + b) / 3.0;
        let of = |v: f64, gain: f64| (gain * (grey + factor * (v - grey))).clamp(0.0, 1.0) as f32;
        [of(r, 1.0 + warmer), of(g, 1.0), of(b, 1.0 - warmer)]
    })
}

#[test]
fn chroma_is_told_where_whites_agree() {
    let told = |factor, warmer| {
        let (ours, theirs) =
            Cells::of_whole(&coloured(factor, warmer)).beside(&picture(OURS, scene)).unwrap();
        saturation(&ours, &theirs)
    };
    assert!(
        (told(1.0, 0.0) - 1.0).abs() < 0.02 && (1.15..1.35).contains(&told(1.3, 0.0)),
        "{}",
        told(1.3, 0.0)
    );
    assert!((told(1.3, 0.4) - 1.0).abs() < 1e-9);
}

fn found(preview: &Picture) -> Result<CameraLook, NoCameraLook> {
    let (ours, theirs) = Cells::of_whole(preview).beside(&picture(OURS, scene)).ok_or(NoCameraLook::Shape)?;
    curve(&ours, &theirs)
}

/// Largest difference of a fitted curve to the camera's, L*, over the tones of the scene.
fn miss(look: &CameraLook) -> f64 {
    let curve = Points::new(&look.points).unwrap();
    let miss = |l: u32| {
        let wanted =
            100.0 * TransferCurve::LStar.encode(camera(TransferCurve::LStar.decode(0.01 * f64::from(l))));
        (curve.lightness(f64::from(l)) - wanted).abs()
    };
    (5..93).map(miss).fold(0.0, f64::max)
}

#[test]
fn the_curve_of_the_camera_is_found_whatever_lies_around_the_preview() {
    let plain = picture(Size { width: 200, height: 134 }, rendered);
    // A thumbnail with black bars above and below.
    let bars = picture(Size { width: 160, height: 120 }, |x, y| {
        let y = (y - 0.0556) / 0.8888;
        if (0.0..1.0).contains(&y) { rendered(x, y) } else { [0.0; 3] }
    });
    // Of another shape, cut from the middle.
    let cut = picture(Size { width: 200, height: 150 }, |x, y| rendered(0.0555 + 0.889 * x, y));
    // Two per cent are missing at each side.
    let inner = picture(OURS, |x, y| rendered(0.02 + 0.96 * x, 0.02 + 0.96 * y));
    for (name, preview) in [("plain", plain), ("bars", bars), ("cut", cut), ("inner", inner)] {
        let look = found(&preview).unwrap();
        assert!(miss(&look) < 3.0 && look.left < 1.5, "{name}: {} {look:?}", miss(&look));
        assert!(look.points.windows(2).all(|pair| pair[0][1] <= pair[1][1]), "{look:?}");
    }
}

#[test]
fn what_was_changed_in_one_place_changes_the_curve_little() {
    // A fifth of the picture was brightened.
    let local = picture(OURS, |x, y| {
        let gain = if x < 0.2 { 1.8 } else { 1.0 };
        rendered(x, y).map(|v| (v * gain).min(1.0))
    });
    let look = found(&local).unwrap();
    assert!(miss(&look) < 6.0, "{} {look:?}", miss(&look));
}

#[test]
fn previews_that_tell_no_look_are_refused() {
    let turned = picture(OURS, |x, y| rendered(1.0 - x, 1.0 - y));
    assert!(matches!(found(&turned), Err(NoCameraLook::Apart { .. })));
    let tall = picture(Size { width: 130, height: 200 }, rendered);
    assert_eq!(found(&tall), Err(NoCameraLook::Shape));
    let tiny = picture(Size { width: 40, height: 30 }, rendered);
    assert_eq!(found(&tiny), Err(NoCameraLook::Shape));
    let grey = picture(OURS, |_, _| [0.2; 3]);
    let (ours, theirs) = Cells::of_whole(&grey).beside(&grey).unwrap();
    assert_eq!(curve(&ours, &theirs), Err(NoCameraLook::FewTones));
}
