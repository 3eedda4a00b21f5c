//! `darkroot inspect`.

use serde_json::Value;

use super::*;

fn inspected(desk: &Desk, arguments: &[&str]) -> Value {
    let run = desk.run(&[&["inspect", "--json"], arguments].concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_eq!(run.out.lines().count(), 1);
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn the_text_names_what_a_photographer_asks_for() {
    let desk = Desk::with_dng();
    let run = desk.run(&["inspect", "a.dng"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    for fact in [
        "Darkroot Simulated One",
        "DNG",
        "16 bits",
        "96 x 64",
        "RGGB",
        "black level     512",
        "white level     15892",
        "f/8.0",
        "1/60 s",
        "ISO 100",
        "85 mm",
        "Simulated 85mm f/1.8",
        "2026:01:01 12:00:00",
        "CC0-1.0",
        "color matrix",
        "forward matrix",
        "clipped",
        "matrix serves",
    ] {
        assert!(run.out.contains(fact), "no `{fact}` in:\n{}", run.out);
    }
}

#[test]
fn json_has_the_same_facts() {
    let desk = Desk::with_dng();
    let facts = inspected(&desk, &["a.dng"]);
    assert_eq!(facts["camera"], "Darkroot Simulated One");
    assert_eq!((facts["format"].as_str(), facts["bits"].as_u64()), (Some("DNG"), Some(16)));
    assert_eq!(facts["frame"], serde_json::json!([104, 72]));
    assert_eq!(facts["crop"], serde_json::json!([4, 4, 96, 64]));
    assert_eq!((facts["filters"].as_str(), facts["orientation"].as_u64()), (Some("RGGB"), Some(1)));
    assert_eq!(facts["calibrations"].as_array().unwrap().len(), 2);
    assert_eq!(facts["shot"]["lens"], "Simulated 85mm f/1.8");
    assert!((facts["shot"]["exposure_time"].as_f64().unwrap() - 1.0 / 60.0).abs() < 1e-9);
    assert!((facts["kelvin"].as_f64().unwrap() / 5500.0 - 1.0).abs() < 0.05, "{}", facts["kelvin"]);
    let counted: u64 = facts["histogram"][1].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).sum();
    assert!(counted > 104 * 72 / 2 - 300 && counted <= 104 * 72 / 2, "{counted}");
    assert!(facts["samples_hash"].is_null());
}

#[test]
fn each_of_several_files_has_its_line_of_json() {
    let desk = Desk::with_dng();
    desk.put("b.nef", small_nef());
    let run = desk.run(&["inspect", "--json", "a.dng", "b.nef"]);
    let lines: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((lines[0]["input"].as_str(), lines[1]["input"].as_str()), (Some("a.dng"), Some("b.nef")));
    assert_eq!(lines[1]["camera"], "Nikon D750");
}

#[test]
fn the_hash_of_the_samples_is_that_of_the_library() {
    let desk = Desk::with_dng();
    desk.put("b.nef", small_nef());
    for (name, bytes) in [("a.dng", small_dng()), ("b.nef", small_nef())] {
        let capture =
            darkroot_raw::decode(bytes, darkroot_raw::Decoder::Flashraw, &darkroot_raw::Limits::default())
                .unwrap();
        let right = format!("{:016x}", darkroot_raw::samples_hash(&capture.counts));
        assert_eq!(inspected(&desk, &["--samples-hash", name])["samples_hash"], right.as_str());
        assert!(desk.run(&["inspect", "--samples-hash", name]).out.contains(&right));
    }
}

#[test]
fn the_hash_does_not_depend_on_how_the_samples_are_stored() {
    let desk = Desk::new();
    let capture = expose(&Scene::gradient(FRAME), &Camera::simulated_one(), &Exposure::default());
    let storages = [dng::Storage::Uncompressed, dng::Storage::JpegStrip, dng::Storage::JpegTiles];
    let hashes = storages.map(|storage| {
        desk.put("a.dng", dng::write(&capture, storage));
        inspected(&desk, &["--samples-hash", "a.dng"])["samples_hash"].as_str().unwrap().to_owned()
    });
    assert!(hashes[0] == hashes[1] && hashes[1] == hashes[2], "{hashes:?}");
}

/// The DNG with a JPEG at its end in place of its own uncompressed preview.
fn with_preview(jpeg: &[u8]) -> Vec<u8> {
    let mut bytes = small_dng().to_vec();
    let (offset, length) = (bytes.len() as u32, jpeg.len() as u32);
    bytes.extend_from_slice(jpeg);
    let at = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let entries = usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
    for entry in 0..entries {
        let entry = at + 2 + 12 * entry;
        let value = match u16::from_le_bytes([bytes[entry], bytes[entry + 1]]) {
            259 => 7, // Compression: JPEG.
            262 => 6, // PhotometricInterpretation: YCbCr.
            273 => offset,
            279 => length,
            _ => continue,
        };
        // As one LONG, whatever it was.
        bytes[entry + 2..entry + 8].copy_from_slice(&[4, 0, 1, 0, 0, 0]);
        bytes[entry + 8..entry + 12].copy_from_slice(&value.to_le_bytes());
    }
    bytes
}

#[test]
fn the_embedded_preview_is_written_as_it_is_stored() {
    let mut jpeg = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(40, 30, image::Rgb([200, 100, 50]))
        .write_to(&mut jpeg, image::ImageFormat::Jpeg)
        .unwrap();
    let jpeg = jpeg.into_inner();
    let desk = Desk::new();
    desk.put("a.dng", with_preview(&jpeg));
    let run = desk.run(&["inspect", "a.dng", "--preview", "p.jpg"]);
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    assert!(desk.read("p.jpg") == jpeg);
    assert!(run.err.contains("p.jpg"), "{}", run.err);

    desk.put("p.jpg", "precious");
    desk.fails(1, &["inspect", "a.dng", "--preview", "p.jpg"], &["p.jpg", "exists already", "--overwrite"]);
    assert_eq!(desk.read("p.jpg"), b"precious");
    assert_eq!(desk.run(&["inspect", "a.dng", "--preview", "p.jpg", "--overwrite"]).code, 0);
    assert!(desk.read("p.jpg") == jpeg);
    assert_eq!(desk.names(), ["a.dng", "p.jpg"]);
}

#[test]
fn a_preview_over_its_own_raw_file_is_refused() {
    let mut jpeg = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(40, 30).write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let bytes = with_preview(&jpeg.into_inner());
    let desk = Desk::new();
    desk.put("a.dng", &bytes);
    let run = desk.run(&["inspect", "a.dng", "--preview", "./a.dng", "--overwrite"]);
    assert!(desk.read("a.dng") == bytes, "the raw file is gone: {}", run.err);
    assert_ne!(run.code, 0);
}

#[test]
fn a_file_without_a_preview_says_so() {
    let desk = Desk::with_dng();
    desk.fails(
        1,
        &["inspect", "a.dng", "--preview", "p.jpg"],
        &["a.dng", "no embedded JPEG preview", "develop"],
    );
    desk.fails(2, &["inspect", "a.dng", "a.dng", "--preview", "p.jpg"], &["one file"]);
    desk.fails(2, &["inspect", "a.dng", "--overwrite"], &["--preview"]);
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn the_other_files_are_inspected_after_a_bad_one() {
    let desk = Desk::with_dng();
    desk.put("bad.nef", "text");
    let run = desk.run(&["inspect", "--json", "bad.nef", "a.dng"]);
    assert_eq!((run.code, run.out.lines().count()), (1, 1));
    assert!(run.err.contains("bad.nef"), "{}", run.err);
}

#[test]
#[cfg_attr(not(has_fixtures), ignore = "needs `fixtures` in DARKROOT_DATA")]
fn real_raw_files_are_inspected_and_developed() {
    let folder = real_files("fixtures");
    let desk = Desk::new();
    let files: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "dng" || e == "nef"))
        .map(|p| p.display().to_string())
        .collect();
    assert!(!files.is_empty());
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let run = desk.run(&[&["inspect", "--json"], &files[..]].concat());
    assert!(run.code <= 1, "{}", run.err);
    assert_eq!(
        run.out.lines().count() + run.err.lines().filter(|l| l.starts_with("error: ")).count(),
        files.len()
    );
    let run = desk.run(&[&["develop", "-o", "{stem}-{seq}.jpg", "--json"], &files[..]].concat());
    assert!(run.code <= 1, "{}", run.err);
    assert_eq!(run.out.lines().count(), files.len());
}
