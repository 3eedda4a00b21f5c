//! Golden pictures: each folder of `golden/` is one, `recipe.toml` says how it is made and `expected.png` what it
//! shall look like.
//!
//! Pictures are compared in dE2000, pixel by pixel. After a change that is meant to be seen, run
//! `UPDATE_GOLDEN=1 cargo test -p darkroot-tests --test golden`, look at the pictures and commit them. A picture
//! that differs leaves `failed-actual.png` and `failed-difference.png` in its folder.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.

use std::path::{Path, PathBuf};

use darkroot_colour::difference::de2000;
use darkroot_colour::{RgbSpace, Spectrum, TransferCurve};
use darkroot_develop::{Balance, Bits, Exposure as Brightness, Highlights, Look, Recipe};
use darkroot_photo::{Layout, Orientation, Picture, Size};
use darkroot_profile::Profile;
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene};
use darkroot_tests::{lab, output, pixels, root, space_of};
use image::RgbImage;
use serde::Deserialize;

/// Largest difference of a pixel and of the mean of all, dE2000.
const MOST: f64 = 1.0;
const MEAN: f64 = 0.1;

/// Upright size of every picture; the simulated camera leaves four pixels out on each side.
const SIZE: Size = Size { width: 188, height: 128 };

/// `recipe.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// What the picture shows, for people.
    shows: String,
    #[serde(default)]
    capture: Shot,
    #[serde(default)]
    develop: Settings,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Shot {
    /// Filter array by its letters, "X-Trans", "linear" or "monochrome".
    filters: String,
    /// Temperature of the light: daylight from 4000 K on, a black body below.
    kelvin: f64,
    /// Stops over an exposure whose white is at 0.65 of saturation.
    stops: f64,
    /// Exif orientation.
    orientation: u32,
}

impl Default for Shot {
    fn default() -> Self {
        Self { filters: "RGGB".into(), kelvin: 5500.0, stops: 0.0, orientation: 1 }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Settings {
    look: String,
    highlights: String,
    exposure: f64,
    auto_exposure: bool,
    /// Temperature and tint.
    kelvin: Option<[f64; 2]>,
    space: String,
    bits: Option<u8>,
    /// Profile file in the same folder.
    profile: Option<PathBuf>,
}

impl Settings {
    fn recipe(&self) -> Recipe {
        let space = match self.space.as_str() {
            "" | "srgb" => RgbSpace::SRGB,
            "srgb-linear" => RgbSpace::SRGB.linear(),
            "display-p3" => RgbSpace::DISPLAY_P3,
            other => panic!("space `{other}`"),
        };
        let bits = match self.bits {
            None | Some(8) => Bits::Eight,
            Some(16) => Bits::Sixteen,
            Some(other) => panic!("{other} bits"),
        };
        Recipe {
            look: match self.look.as_str() {
                "" | "neutral" => Look::Neutral,
                "vivid" => Look::Vivid,
                "flat" => Look::Flat,
                "reproduction" => Look::Reproduction,
                "linear" => Look::Linear,
                other => panic!("look `{other}`"),
            },
            highlights: match self.highlights.as_str() {
                "" | "rebuild" => Highlights::Rebuild,
                "clip" => Highlights::Clip,
                "keep" => Highlights::Keep,
                other => panic!("highlights `{other}`"),
            },
            exposure: Brightness { stops: self.exposure, auto: self.auto_exposure },
            balance: match self.kelvin {
                Some([kelvin, tint]) => Balance::Kelvin { kelvin, tint },
                None => Balance::AsShot,
            },
            output: output(space, bits),
            ..Recipe::default()
        }
    }
}

fn developed(case: &Case, folder: &Path) -> Picture {
    let shot = &case.capture;
    let layout = match shot.filters.as_str() {
        "X-Trans" => x_trans(),
        "linear" => Layout::Rgb,
        "monochrome" => Layout::Monochrome,
        letters => filters(letters),
    };
    let exposure = Exposure {
        light: if shot.kelvin < 4000.0 {
            Spectrum::black_body(shot.kelvin)
        } else {
            Spectrum::daylight(shot.kelvin)
        },
        stops: shot.stops,
        orientation: Orientation::from_exif(shot.orientation),
        ..darkroot_simulate::samples::exposure(1)
    };
    let capture = expose(&Scene::still_life(SIZE), &Camera { layout, ..Camera::simulated_one() }, &exposure);
    let profile: Option<Profile> = case.develop.profile.as_ref().map(|name| {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        darkroot_profile::file::parse(&text).unwrap_or_else(|e| panic!("{}: {e}", name.display()))
    });
    darkroot_tests::develop(&capture, profile.as_ref(), &case.develop.recipe())
}

/// The picture in 8 bits as a screen shows it, and the space that its numbers are in: linear light is shown in sRGB.
fn shown(picture: &Picture) -> (RgbImage, RgbSpace) {
    let stored = space_of(picture);
    let space = match stored.curve {
        TransferCurve::Linear => RgbSpace { curve: TransferCurve::Srgb, ..stored },
        _ => stored,
    };
    let bytes = pixels(picture).into_iter().flatten().map(|v| {
        let encoded = space.curve.encode(stored.curve.decode(v));
        (encoded.clamp(0.0, 1.0) * 255.0).round() as u8
    });
    let Size { width, height } = picture.size;
    (RgbImage::from_raw(width as u32, height as u32, bytes.collect()).unwrap(), space)
}

/// Difference of each pixel, dE2000; `None` when the sizes differ.
fn differences(actual: &RgbImage, expected: &RgbImage, space: &RgbSpace) -> Option<Vec<f64>> {
    let lab = |p: &image::Rgb<u8>| lab(space, p.0.map(|v| f64::from(v) / 255.0));
    (actual.dimensions() == expected.dimensions()).then(|| {
        let pairs = actual.pixels().zip(expected.pixels());
        pairs.map(|(a, e)| if a == e { 0.0 } else { de2000(lab(a), lab(e)) }).collect()
    })
}

/// What is wrong with a picture, in words, and the differences to draw.
fn judge(actual: &RgbImage, expected: &RgbImage, space: &RgbSpace) -> Result<(), (String, Vec<f64>)> {
    let Some(differences) = differences(actual, expected, space) else {
        let sizes = format!("is {:?} pixels, expected {:?}", actual.dimensions(), expected.dimensions());
        return Err((sizes, Vec::new()));
    };
    let most = differences.iter().copied().fold(0.0, f64::max);
    let mean = differences.iter().sum::<f64>() / differences.len() as f64;
    if most <= MOST && mean <= MEAN {
        return Ok(());
    }
    Err((format!("differs by {most:.2} dE2000 at most and {mean:.3} in the mean"), differences))
}

/// One golden picture. The error says what differs and where to look.
fn check(folder: &Path) -> Result<(), String> {
    let name = folder.file_name().unwrap().to_string_lossy().into_owned();
    let file = |name: &str| folder.join(name);
    let text =
        std::fs::read_to_string(file("recipe.toml")).map_err(|e| format!("{name}/recipe.toml: {e}"))?;
    let case: Case = toml::from_str(&text).map_err(|e| format!("{name}/recipe.toml: {e}"))?;
    assert!(case.shows.len() > 10, "{name}/recipe.toml: `shows` is for people");
    let (actual, space) = shown(&developed(&case, folder));
    for stale in ["failed-actual.png", "failed-difference.png"] {
        let _ = std::fs::remove_file(file(stale)); // Most often there is none.
    }
    if std::env::var_os("UPDATE_GOLDEN").is_some_and(|v| v == "1") {
        return actual.save(file("expected.png")).map_err(|e| format!("{name}: {e}"));
    }
    let expected = image::open(file("expected.png")).map_err(|e| format!("{name}/expected.png: {e}"))?;
    judge(&actual, &expected.to_rgb8(), &space).map_err(|(words, differences)| {
        actual.save(file("failed-actual.png")).unwrap();
        if !differences.is_empty() {
            // White is a difference of 5 or more.
            let bytes = differences.iter().map(|d| (d * 51.0).min(255.0) as u8).collect();
            let (width, height) = actual.dimensions();
            let drawn = image::GrayImage::from_raw(width, height, bytes).unwrap();
            drawn.save(file("failed-difference.png")).unwrap();
        }
        format!("{name}: {words}; see tests/golden/{name}/failed-*.png, or UPDATE_GOLDEN=1 if it is meant")
    })
}

#[test]
fn the_golden_pictures_look_as_they_did() {
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(root().join("tests/golden")).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.retain(|path| path.is_dir());
    folders.sort();
    assert!(folders.len() >= 12, "{folders:?}");
    let failures: Vec<String> = folders.iter().filter_map(|folder| check(folder).err()).collect();
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

#[test]
fn a_difference_that_can_be_seen_is_a_failure() {
    let even = |v: u8| RgbImage::from_pixel(20, 20, image::Rgb([v; 3]));
    assert!(judge(&even(120), &even(120), &RgbSpace::SRGB).is_ok());
    // One step of 8 bits everywhere is more than 0.1 in the mean, three steps in one pixel are more than 1.
    assert!(judge(&even(121), &even(120), &RgbSpace::SRGB).unwrap_err().0.contains("in the mean"));
    let mut spot = even(120);
    spot.put_pixel(3, 4, image::Rgb([120, 123, 120]));
    assert!(judge(&spot, &even(120), &RgbSpace::SRGB).unwrap_err().0.contains("at most"));
    let other_size = RgbImage::new(20, 19);
    assert!(judge(&other_size, &even(120), &RgbSpace::SRGB).unwrap_err().0.contains("expected"));
}
