//! Files whose samples nobody can decode, and the JPEG that the camera embedded.

use darkroot_photo::Orientation;
use serde_json::Value;

use super::*;

/// A High Efficiency file on the desk as `he.nef`, and its embedded JPEG as `camera.jpg`: what this program makes of the same
/// scene.
fn high_efficiency(orientation: Orientation) -> Desk {
    let desk = Desk::new();
    let scene = Scene::still_life(FRAME);
    let exposed =
        |orientation| expose(&scene, &Camera::nikon_d750(), &Exposure { orientation, ..Exposure::default() });
    desk.put("a.nef", nef::write(&exposed(Orientation::Upright), nef::Storage::Lossless).unwrap());
    desk.develop(&["a.nef", "-o", "camera.jpg", "--quality", "100", "--exposure", "-1"]);
    let jpeg = without_exif(&desk.read("camera.jpg"));
    desk.put("he.nef", nef::write_high_efficiency(&exposed(orientation), jpeg).unwrap());
    desk
}

/// A JPEG as cameras embed it: nothing in it says how it was held.
fn without_exif(jpeg: &[u8]) -> Vec<u8> {
    let mut rest = &jpeg[2..];
    while rest[1] & 0xf0 == 0xe0 {
        rest = &rest[2 + usize::from(u16::from_be_bytes([rest[2], rest[3]]))..];
    }
    [&jpeg[..2], rest].concat()
}

fn picture(desk: &Desk, name: &str) -> image::RgbImage {
    image::open(desk.path(name)).unwrap().to_rgb8()
}

/// Develops `he.nef` to a PNG; the picture and the report.
fn developed(desk: &Desk, arguments: &[&str]) -> (image::RgbImage, Value) {
    let fixed = ["develop", "he.nef", "-o", "o.png", "--overwrite", "--json", "--from-preview"];
    let run = desk.run(&[&fixed, arguments].concat());
    assert_eq!(run.code, 0, "{arguments:?}: {}", run.err);
    (picture(desk, "o.png"), serde_json::from_str(&run.out).unwrap())
}

#[test]
fn high_efficiency_is_refused_with_the_ways_that_there_are() {
    let desk = high_efficiency(Orientation::Upright);
    let words = ["High Efficiency (HE)", "convert it to DNG", "--from-preview", "inspect --preview"];
    for decoder in ["flashraw", "rawloader"] {
        desk.fails(1, &["develop", "he.nef", "-o", "o.png", "--decoder", decoder], &words);
    }
    assert!(!desk.names().contains(&"o.png".to_owned()));
}

#[test]
fn the_embedded_jpeg_is_developed_as_the_camera_rendered_it_and_says_so() {
    let desk = high_efficiency(Orientation::Upright);
    let (own, report) = developed(&desk, &[]);
    let camera = picture(&desk, "camera.jpg");
    assert_eq!(own.dimensions(), camera.dimensions());
    let most = own.iter().zip(camera.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(1), "{most:?}");
    assert_eq!((&report["from_preview"], &report["camera"]), (&true.into(), &"Nikon D750".into()));
    assert!(report["colours"].as_str().unwrap().contains("camera's own"), "{report}");
    let note = report["notes"][0].as_str().unwrap();
    assert!(note.contains("embedded JPEG") && note.contains("8 bits"), "{note}");
    // In the picture, too.
    let file = std::io::Cursor::new(desk.read("o.png"));
    let exif = exif::Reader::new().read_from_container(&mut file.clone()).unwrap();
    let software =
        exif.get_field(exif::Tag::Software, exif::In::PRIMARY).unwrap().display_value().to_string();
    assert!(software.contains("from the camera's embedded JPEG"), "{software}");
    assert!(exif.get_field(exif::Tag::LensModel, exif::In::PRIMARY).is_some());
}

#[test]
fn exposure_and_white_balance_apply_to_it_and_looks_do_not() {
    let desk = high_efficiency(Orientation::Upright);
    let (plain, _) = developed(&desk, &[]);
    let mean = |p: &image::RgbImage, c: usize| {
        p.pixels().map(|p| f64::from(p.0[c])).sum::<f64>() / f64::from(WIDTH * HEIGHT)
    };
    assert_eq!(developed(&desk, &["--look", "vivid"]).0, plain);
    assert_eq!(developed(&desk, &["--highlights", "clip", "--profile", "auto"]).0, plain);
    let (brighter, _) = developed(&desk, &["--exposure", "1"]);
    assert!(mean(&brighter, 1) > mean(&plain, 1) * 1.15);
    let (warmer, _) = developed(&desk, &["--white-balance", "9000K"]);
    assert!(mean(&warmer, 0) > mean(&plain, 0) && mean(&warmer, 2) < mean(&plain, 2));
    let (wide, _) = developed(&desk, &["--space", "adobe-rgb"]);
    assert_ne!(wide, plain);
}

#[test]
fn it_is_no_scene_light() {
    let desk = high_efficiency(Orientation::Upright);
    for (arguments, word) in [
        (&["--look", "linear", "-o", "o.tif"][..], "--look"),
        (&["--space", "camera", "-o", "o.exr"], "--space"),
        (&["--profile", "Nikon D700", "-o", "o.jpg"], "--profile"),
    ] {
        let all = [&["develop", "he.nef", "--from-preview"], arguments].concat();
        desk.fails(2, &all, &["no scene light", word, "leave out"]);
    }
}

#[test]
fn it_is_shown_upright_whichever_way_it_is_stored() {
    // The sensor stands upright here, and so does the scene in `camera.jpg`: a camera that turned its JPEG already.
    let desk = high_efficiency(Orientation::Rotate90);
    let camera = picture(&desk, "camera.jpg");
    assert_eq!(developed(&desk, &[]).0.dimensions(), camera.dimensions());
    // Stored as the sensor saw it.
    let lying = image::imageops::rotate270(&camera);
    let mut jpeg = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 100).encode_image(&lying).unwrap();
    let exposure = Exposure { orientation: Orientation::Rotate90, ..Exposure::default() };
    let capture = expose(&Scene::still_life(FRAME), &Camera::nikon_d750(), &exposure);
    desk.put("he.nef", nef::write_high_efficiency(&capture, jpeg).unwrap());
    let (turned, _) = developed(&desk, &[]);
    assert_eq!(turned.dimensions(), camera.dimensions());
    let sum: u64 = turned.iter().zip(camera.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    assert!(sum < 4 * camera.len() as u64, "{sum}");
}

#[test]
fn it_is_taken_only_where_it_is_asked_for_and_there() {
    let desk = Desk::new();
    desk.put("a.nef", small_nef());
    let run = desk.run(&["develop", "a.nef", "-o", "o.png", "--json"]);
    let report: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(report["from_preview"], false);
    // Its preview is no JPEG.
    let words = ["a.nef", "has no embedded JPEG"];
    desk.fails(1, &["develop", "a.nef", "-o", "p.png", "--from-preview"], &words);
}

#[test]
fn a_batch_and_a_recipe_take_it() {
    let desk = high_efficiency(Orientation::Upright);
    desk.put("in/he.nef", desk.read("he.nef"));
    let refused = desk.run(&["batch", "in", "-o", "out"]);
    assert_ne!(refused.code, 0);
    assert!(
        refused.err.contains("High Efficiency") && refused.err.contains("--from-preview"),
        "{}",
        refused.err
    );
    let run = desk.run(&["batch", "in", "-o", "out", "--from-preview"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let camera = picture(&desk, "camera.jpg");
    assert_eq!(picture(&desk, "out/he.jpg").dimensions(), camera.dimensions());
    desk.put("r.toml", "from-preview = true\n");
    desk.develop(&["he.nef", "-o", "r.png", "--recipe", "r.toml"]);
    let recipe = picture(&desk, "r.png");
    assert!(recipe.iter().zip(camera.iter()).all(|(a, b)| a.abs_diff(*b) <= 1));
}
