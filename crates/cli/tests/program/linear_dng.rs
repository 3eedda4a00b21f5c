//! Linear DNG: what another raw developer gets.

use super::*;

/// The samples of a float TIFF.
fn floats(desk: &Desk, name: &str) -> Vec<f32> {
    let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(desk.read(name))).unwrap();
    match decoder.read_image().unwrap() {
        tiff::decoder::DecodingResult::F32(samples) => samples,
        _ => panic!("{name} has samples of another type"),
    }
}

/// What `inspect` says of a file.
fn inspected(desk: &Desk, name: &str) -> serde_json::Value {
    let run = desk.run(&["inspect", "--json", "--samples-hash", name]);
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_str(run.out.trim()).unwrap()
}

/// A field of the first directory.
fn field(desk: &Desk, name: &str, tag: u16) -> exif::Value {
    let exif = exif::Reader::new().read_raw(desk.read(name)).unwrap();
    let tag = exif::Tag(exif::Context::Tiff, tag);
    exif.get_field(tag, exif::In::PRIMARY).unwrap().value.clone()
}

const AS_SHOT_NEUTRAL: u16 = 50728;
const BASELINE_EXPOSURE: u16 = 50730;

#[test]
fn its_samples_are_the_camera_s_light() {
    let desk = Desk::with_dng();
    desk.put("a.nef", small_nef());
    for name in ["a.dng", "a.nef"] {
        let linear = ["--look", "linear", "--overwrite"];
        desk.develop(&[&[name, "-o", "o.dng"], &linear[..]].concat());
        desk.develop(&[&[name, "-o", "before.tif", "--space", "camera"], &linear[..]].concat());
        desk.develop(&[&["o.dng", "-o", "after.tif", "--space", "camera"], &linear[..]].concat());
        let (before, after) = (floats(&desk, "before.tif"), floats(&desk, "after.tif"));
        assert_eq!(before.len(), after.len());
        // What lies outside of what the sensor knows is cut; the rest is rounded to 16 bits before it is balanced.
        let inside = before.iter().zip(&after).filter(|(before, _)| (0.0..=1.0).contains(*before));
        let worst = inside.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 3.0 / 65_535.0, "{name}: {worst}");
        assert_eq!(inspected(&desk, "o.dng")["orientation"], 1);
    }
}

#[test]
fn colours_stay_when_it_is_developed_again() {
    let desk = Desk::new();
    desk.develop(&[sample("still-life.nef").to_str().unwrap(), "-o", "o.dng"]);
    for (name, output) in [(sample("still-life.nef").to_str().unwrap(), "before.png"), ("o.dng", "after.png")]
    {
        desk.develop(&[name, "-o", output, "--denoise", "off", "--sharpen", "off"]);
    }
    let [before, after] =
        ["before.png", "after.png"].map(|name| image::open(desk.path(name)).unwrap().into_rgb8());
    assert_eq!(before.dimensions(), after.dimensions());
    let apart = before.iter().zip(after.iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>();
    let mean = apart / before.len() as f64;
    assert!(mean < 1.5, "{mean} of 255");
}

#[test]
fn a_look_is_for_the_preview_and_exposure_is_said() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "plain.dng"]);
    desk.develop(&[
        "a.dng",
        "-o",
        "changed.dng",
        "--look",
        "vivid",
        "--contrast",
        "0.5",
        "--exposure",
        "1.5",
    ]);
    let [plain, changed] = ["plain.dng", "changed.dng"].map(|name| inspected(&desk, name));
    assert_eq!(plain["samples_hash"], changed["samples_hash"]);
    let exif::Value::SRational(stops) = field(&desk, "changed.dng", BASELINE_EXPOSURE) else { panic!() };
    assert!((stops[0].to_f64() - 1.5).abs() < 1e-5, "{stops:?}");
    for name in ["plain", "changed"] {
        desk.develop(&[&format!("{name}.dng"), "--from-preview", "-o", &format!("{name}.png")]);
    }
    let [plain, changed] =
        ["plain.png", "changed.png"].map(|name| image::open(desk.path(name)).unwrap().into_rgb8());
    let sum = |picture: &image::RgbImage| picture.iter().map(|v| u64::from(*v)).sum::<u64>();
    assert!(sum(&changed) > sum(&plain) * 6 / 5, "{} {}", sum(&changed), sum(&plain));
}

#[test]
fn another_white_is_another_neutral() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "warm.dng", "--white-balance", "3000K"]);
    desk.develop(&["a.dng", "-o", "cold.dng", "--white-balance", "8000K"]);
    let red_over_blue = |name| match field(&desk, name, AS_SHOT_NEUTRAL) {
        exif::Value::Rational(v) => v[0].to_f64() / v[2].to_f64(),
        other => panic!("{other:?}"),
    };
    assert!(red_over_blue("warm.dng") > 1.5 * red_over_blue("cold.dng"));
}

#[test]
fn what_has_no_meaning_in_it_is_a_sentence() {
    let desk = Desk::with_dng();
    for (options, word) in [
        (&["--bits", "8"][..], "only 16"),
        (&["--space", "adobe-rgb"], "leave out the space"),
        (&["--from-preview"], "no scene light"),
        (&["--engine", "imagepipe"], "space"),
    ] {
        let run = desk.run(&[&["develop", "a.dng", "-o", "o.dng"], options].concat());
        assert!(run.code != 0 && run.err.contains(word), "{options:?}: {}", run.err);
        assert!(!desk.path("o.dng").exists());
    }
    let run = desk.run(&["develop", "a.dng", "-o", "a.dng", "--overwrite"]);
    assert!(run.code != 0 && run.err.contains("would be overwritten"), "{}", run.err);
    assert_eq!(desk.read("a.dng"), small_dng());
}

#[test]
fn a_batch_makes_them_with_a_sheet() {
    let desk = Desk::new();
    desk.put("roll/a.dng", small_dng());
    desk.put("roll/b.nef", small_nef());
    let run = desk.run(&["batch", "roll", "-o", "out", "--format", "dng", "--report", "sheet.html"]);
    assert_eq!(run.code, 0, "{}", run.err);
    for name in ["out/a.dng", "out/b.dng"] {
        assert_eq!(inspected(&desk, name)["filters"], "linear RGB");
    }
    let again = desk.run(&["batch", "roll", "-o", "out", "--format", "dng", "--json"]);
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(!again.out.contains("\"begun\""), "{}", again.out);
}
