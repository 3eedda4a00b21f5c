use super::*;
use darkroot_photo::{CameraSpace, Rgb, Scene, Size};

const LIMITS: [f32; 3] = [2.0, 1.0, 1.5];

fn treatment() -> Treatment {
    Treatment::Rebuild(Rebuild { limits: LIMITS, colours: Arc::default(), uneven: false })
}

/// A rebuilt colour of a camera whose RGB is the scene's, made as white as it is to become.
fn whitened(colour: [f32; 3]) -> [f32; 3] {
    let picture = |v: [f32; 3]| v.map(|v| vec![v]);
    let camera: Rgb<CameraSpace> = Rgb::from_planes(Size { width: 1, height: 1 }, picture(colour)).unwrap();
    let whitening = Whitening::of(&camera, &treatment());
    let mut scene: Rgb<Scene> = camera.into_space();
    whiten(&mut scene, &whitening);
    scene.at(0, 0)
}

/// A grey surface of the given light under an RGGB array, clipped by the sensor.
fn grey(light: f32) -> Mosaic<f32> {
    let cfa = Cfa::parse("RGGB").unwrap();
    let size = Size { width: 10, height: 10 };
    let sample = |i: usize| light.min(LIMITS[cfa.at(i % 10, i / 10).plane().unwrap()]);
    Mosaic { size, samples: (0..100).map(sample).collect(), layout: Layout::Cfa(cfa) }
}

#[test]
fn a_grey_that_clips_in_green_only_is_grey_again() {
    let mut mosaic = grey(1.3);
    treat(&mut mosaic, (0, 0), &treatment(), &[]);
    for y in 2..8 {
        for x in 2..8 {
            assert!((mosaic.samples[y * 10 + x] - 1.3).abs() < 1e-5);
        }
    }
}

#[test]
fn what_is_not_clipped_is_not_touched() {
    let (before, mut after) = (grey(0.9), grey(0.9));
    treat(&mut after, (0, 0), &treatment(), &[]);
    assert_eq!(before, after);
}

#[test]
fn corrections_that_move_the_limits_move_what_counts_as_clipped() {
    // As bright as a clipped grey of 1.3, but the file's gain map doubled it: nothing is clipped.
    let (before, mut after) = (grey(1.3), grey(1.3));
    let cfa = Cfa::parse("RGGB").unwrap();
    let ends: Vec<f32> = (0..100).map(|i| 2.0 * LIMITS[cfa.at(i % 10, i / 10).plane().unwrap()]).collect();
    treat(&mut after, (0, 0), &treatment(), &ends);
    assert_eq!(before, after);
}

#[test]
fn a_surface_that_clips_in_every_channel_is_neutral() {
    let [r, g, b] = rebuilt(LIMITS, LIMITS, [1.4, 0.9, 0.7]);
    assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6 && r >= 2.0 - 1e-6, "{r} {g} {b}");
    let [r, g, b] = whitened(LIMITS);
    assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6 && r >= 2.0 - 1e-6, "{r} {g} {b}");
}

#[test]
fn a_saturated_red_light_keeps_its_hue() {
    assert_eq!(whitened([2.0, 0.2, 0.1]), [2.0, 0.2, 0.1]);
}

/// Colours (mean 1) of twelve hues, three strengths.
fn colours() -> impl Iterator<Item = [f32; 3]> {
    (0..36).map(|i| {
        let (hue, strength) = ((i % 12) as f32 * std::f32::consts::TAU / 12.0, 0.25 + 0.25 * (i / 12) as f32);
        [0.0, 1.0, 2.0].map(|c: f32| 1.0 + strength * (hue - c * std::f32::consts::TAU / 3.0).cos())
    })
}

#[test]
fn a_colour_that_the_picture_has_is_found_as_long_as_two_channels_are_left() {
    for colour in colours() {
        let ends: [f32; 3] = from_fn(|c| LIMITS[c] / colour[c]);
        let mut sorted = ends;
        sorted.sort_by(f32::total_cmp);
        // Just before the second channel is no longer trusted.
        let light = 0.92 * sorted[1];
        let truth = colour.map(|v| v * light);
        let seen = from_fn(|c| truth[c].min(LIMITS[c]));
        let found = rebuilt(seen, LIMITS, colour);
        let clipped = (0..3).filter(|&c| truth[c] > LIMITS[c]);
        for c in clipped {
            assert!((found[c] / truth[c] - 1.0).abs() < 0.35, "{colour:?}: {found:?}, not {truth:?}");
        }
    }
}

#[test]
fn light_that_grows_makes_every_channel_grow_in_small_steps() {
    for colour in colours() {
        let at = |stops: f32| {
            let seen = from_fn(|c| (colour[c] * stops.exp2()).min(LIMITS[c]));
            whitened(rebuilt(seen, LIMITS, colour))
        };
        let mut before = at(-2.0);
        for i in 1..600 {
            let now = at(-2.0 + 0.01 * i as f32);
            for c in 0..3 {
                // A hundredth of a stop is 0.7 %; what becomes neutral may grow faster, and where the last channel ends
                // the guess of how bright it is may fall.
                let (least, most) = (0.85 * before[c], 1.08 * before[c] + 0.1 * super::most(before));
                assert!((least..most).contains(&now[c]), "{colour:?} {i}: {before:?} {now:?}");
            }
            before = now;
        }
    }
}
