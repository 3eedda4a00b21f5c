//! No file, however broken, panics (architecture, invariant 4): it is developed or it is an error in words.

use darkroot_colour::RgbSpace;
use darkroot_develop::{Balance, Bits, Crop, Exposure as Brightness, Highlights, Recipe};
use darkroot_photo::{BlackLevel, Capture, Layout, Rect, Size, WhiteLevel};
use darkroot_raw::{Decoder, Limits};
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, dng, nef};
use darkroot_tests::{output, real_files};

const SIZE: Size = Size { width: 48, height: 32 };
const SMALL: Limits = Limits { max_samples: 1 << 22, max_side: 1 << 14 };

fn capture(layout: Layout) -> Capture {
    expose(&Scene::gradient(SIZE), &Camera { layout, ..Camera::simulated_one() }, &Exposure::default())
}

fn files() -> Vec<(&'static str, Vec<u8>)> {
    let bayer = capture(filters("RGGB"));
    let nikon = expose(&Scene::gradient(SIZE), &Camera::nikon_d750(), &Exposure::default());
    vec![
        ("tiled DNG", dng::write(&bayer, dng::Storage::JpegTiles)),
        ("uncompressed DNG", dng::write(&bayer, dng::Storage::Uncompressed)),
        ("X-Trans DNG", dng::write(&capture(x_trans()), dng::Storage::JpegStrip)),
        ("linear DNG", dng::write(&capture(Layout::Rgb), dng::Storage::JpegStrip)),
        ("NEF", nef::write(&nikon, nef::Storage::Lossless).unwrap()),
        ("uncompressed NEF", nef::write(&nikon, nef::Storage::Uncompressed).unwrap()),
    ]
}

/// Keeps what decoders say of their own panics, which `raw` catches, out of the report of the tests.
fn keep_decoders_quiet() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        let report = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let place = info.location().map_or("", |l| l.file());
            if !["rawloader", "flashraw"].iter().any(|decoder| place.contains(decoder)) {
                report(info);
            }
        }));
    });
}

/// Decodes with both decoders and develops everything that decodes, in every way that looks at other numbers.
/// A panic fails the test. Whether the default decoder took the file comes back.
fn survive(bytes: &[u8]) -> bool {
    keep_decoders_quiet();
    let mut decoded = false;
    for decoder in [Decoder::Flashraw, Decoder::Rawloader] {
        match darkroot_raw::decode(bytes, decoder, &SMALL) {
            Ok(capture) => {
                decoded |= decoder == Decoder::Flashraw;
                for recipe in recipes() {
                    if let Ok(plan) = darkroot_tests::plan(&capture, None, &recipe) {
                        assert_eq!(darkroot_tests::rendered(&plan).size, plan.size());
                    }
                }
            }
            Err(error) => assert!(error.to_string().contains(' '), "{error}"),
        }
    }
    assert_eq!(darkroot_raw::decode(bytes, Decoder::Flashraw, &SMALL).is_ok(), decoded);
    if let Ok(Some(preview)) = darkroot_raw::preview(bytes) {
        assert!(preview.jpeg.len() <= bytes.len());
    }
    decoded
}

/// Recipes that between them look at every number of a capture.
fn recipes() -> [Recipe; 2] {
    let auto = Brightness { stops: 0.0, auto: true };
    let linear = output(RgbSpace::SRGB.linear(), Bits::Sixteen);
    [
        Recipe { exposure: auto, crop: Crop::Active, output: linear, ..Recipe::default() },
        Recipe {
            balance: Balance::Kelvin { kelvin: 3000.0, tint: 0.0 },
            highlights: Highlights::Clip,
            output: linear,
            ..Recipe::default()
        },
    ]
}

#[test]
fn a_file_with_a_byte_changed_is_developed_or_refused() {
    for (name, bytes) in files() {
        assert!(survive(&bytes), "{name} is sound to begin with");
        for at in (0..bytes.len()).step_by(STEP) {
            let mut broken = bytes.clone();
            broken[at] = match at % 3 {
                0 => 0,
                1 => 0xff,
                _ => bytes[at].wrapping_add(1),
            };
            survive(&broken);
        }
    }
}

/// Every how many bytes one is changed: all of them in turn would take minutes.
const STEP: usize = 307;

#[test]
fn a_file_cut_off_anywhere_is_developed_or_refused() {
    for (name, bytes) in files() {
        for length in (0..bytes.len()).step_by(bytes.len() / 60 + 1) {
            survive(&bytes[..length]);
        }
        let error = darkroot_raw::decode(&bytes[..bytes.len() / 2], Decoder::Flashraw, &SMALL).unwrap_err();
        assert!(!error.to_string().is_empty(), "{name}");
    }
}

#[test]
fn headers_that_contradict_each_other_are_developed_or_refused() {
    let sound = capture(filters("RGGB"));
    let frame = Rect::full(SIZE);
    let small = Rect { x: 20, y: 14, width: 9, height: 7 };
    let contradictions = [
        Capture {
            active_area: small,
            default_crop: Rect { x: 20, y: 14, width: 30, height: 30 },
            ..sound.clone()
        },
        Capture {
            active_area: small,
            default_crop: Rect { x: 60, y: 40, width: 4, height: 8 },
            ..sound.clone()
        },
        Capture {
            active_area: frame,
            default_crop: Rect { x: 0, y: 0, width: 900, height: 900 },
            ..sound.clone()
        },
        Capture {
            active_area: frame,
            default_crop: Rect { x: 10, y: 10, width: 0, height: 0 },
            ..sound.clone()
        },
        Capture {
            active_area: Rect { x: 0, y: 0, width: 1, height: 1 },
            default_crop: frame,
            ..sound.clone()
        },
        Capture { white: WhiteLevel([0.0; 3]), ..sound.clone() },
        Capture { white: WhiteLevel([100.0; 3]), ..sound.clone() },
        Capture { black: BlackLevel::uniform(65000.0), ..sound.clone() },
        Capture { pixel_aspect: 1e9, ..sound.clone() },
        Capture { baseline_exposure: 2e9, ..sound.clone() },
        Capture { analog_balance: [0.0; 3], ..sound.clone() },
        Capture { as_shot: Some(darkroot_photo::AsShot::Neutral([0.0, 1.0, 0.0])), ..sound.clone() },
        Capture { as_shot: Some(darkroot_photo::AsShot::Neutral([1e-9, 1.0, 1e9])), ..sound.clone() },
        Capture {
            as_shot: Some(darkroot_photo::AsShot::White(darkroot_colour::Xy::new(0.01, 0.98))),
            ..sound.clone()
        },
        Capture {
            calibrations: sound
                .calibrations
                .iter()
                .map(|c| darkroot_photo::Calibration {
                    color_matrix: darkroot_colour::Matrix3::zeros(),
                    ..c.clone()
                })
                .collect(),
            ..sound.clone()
        },
    ];
    for capture in &contradictions {
        for storage in [dng::Storage::Uncompressed, dng::Storage::JpegTiles] {
            survive(&dng::write(capture, storage));
        }
    }
}

#[test]
fn a_file_that_asks_for_more_than_the_limit_is_refused_in_words() {
    let (_, bytes) = files().remove(0);
    let tight = Limits { max_samples: 100, max_side: 65_535 };
    let narrow = Limits { max_samples: u64::MAX, max_side: 10 };
    for limits in [tight, narrow] {
        let message = darkroot_raw::decode(&bytes, Decoder::Flashraw, &limits).unwrap_err().to_string();
        assert!(message.contains("too large") && message.contains("limit"), "{message}");
    }
}

#[test]
#[cfg_attr(not(has_broken_files), ignore = "needs `broken` in DARKROOT_DATA")]
fn real_broken_files_are_developed_or_refused() {
    let folder = real_files("broken");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            survive(&std::fs::read(path).unwrap());
            seen += 1;
        }
    }
    assert!(seen > 0);
}
