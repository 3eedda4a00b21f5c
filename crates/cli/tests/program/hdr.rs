//! Light above white, for screens that show it.

use super::*;

/// A picture whose brightest places are four times as bright as the sensor's limit in the neutral look.
const BRIGHT: [&str; 4] = ["--exposure", "2", "--sharpen", "off"];

/// Whether a file has these bytes.
fn has(file: &[u8], part: &[u8]) -> bool {
    file.windows(part.len()).any(|w| w == part)
}

#[test]
fn a_jpeg_shows_the_same_as_without_and_says_what_is_brighter() {
    let desk = Desk::with_dng();
    desk.develop(&[&["a.dng", "-o", "plain.jpg"], &BRIGHT[..]].concat());
    desk.develop(&[&["a.dng", "-o", "hdr.jpg", "--hdr", "2"], &BRIGHT[..]].concat());
    let [plain, hdr] = ["plain.jpg", "hdr.jpg"].map(|name| desk.read(name));
    let pixels = |file: &[u8]| image::load_from_memory(file).unwrap().into_rgb8().into_raw();
    assert_eq!(pixels(&plain), pixels(&hdr));
    assert!(
        has(&hdr, b"hdrgm:GainMapMax") && has(&hdr, b"urn:iso:std:iso:ts:21496:-1") && !has(&plain, b"hdrgm")
    );
    // The second picture: a quarter as wide, dark where nothing is above white, bright where all is.
    let second = (2..hdr.len()).rev().find(|at| hdr[*at..].starts_with(&[0xff, 0xd8, 0xff])).unwrap();
    let map = image::load_from_memory(&hdr[second..]).unwrap().into_luma8();
    assert_eq!(map.dimensions(), (WIDTH / 4, HEIGHT / 4));
    let (least, most) = map.pixels().fold((255, 0), |(l, m), p| (p.0[0].min(l), p.0[0].max(m)));
    assert!(least < 10 && most > 240, "{least} {most}");
}

#[test]
fn an_avif_is_in_absolute_light() {
    let desk = Desk::with_dng();
    let run = desk.run(&["develop", "a.dng", "-o", "hdr.avif", "--hdr", "3", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("Rec. 2100, PQ"), "{}", run.out);
    // Primaries of Rec. 2020, PQ, its matrix.
    assert!(has(&desk.read("hdr.avif"), b"nclx\0\x09\0\x10\0\x09\x80"));
}

#[test]
fn a_batch_writes_them_with_a_sheet_that_can_be_seen() {
    let desk = Desk::new();
    desk.put("roll/a.dng", small_dng());
    for format in ["jpeg", "avif"] {
        let run = desk.run(&[
            "batch",
            "roll",
            "-o",
            format,
            "--format",
            format,
            "--hdr",
            "2",
            "--report",
            "sheet.html",
        ]);
        assert_eq!(run.code, 0, "{}", run.err);
    }
    assert!(has(&desk.read("jpeg/a.jpg"), b"MPF\0"));
    assert!(has(&desk.read("avif/a.avif"), b"nclx\0\x09\0\x10\0\x09\x80"));
}

#[test]
fn what_has_no_light_above_white_says_so() {
    let desk = Desk::with_dng();
    let note = desk.run(&["develop", "a.dng", "-o", "dark.jpg", "--hdr", "2", "--exposure=-4"]);
    assert!(
        note.code == 0 && note.err.contains("no gain map") || note.out.contains("no gain map"),
        "{} {}",
        note.out,
        note.err
    );
    desk.put("a.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
    for (options, word) in [
        (&["-o", "o.png"][..], "JPEG and AVIF only"),
        (&["-o", "o.jpg", "--look", "reproduction"], "tone curve"),
        (&["-o", "o.jpg", "--lut", "a.cube"], "table"),
        (&["-o", "o.avif", "--space", "display-p3"], "Rec. 2020"),
    ] {
        let run = desk.run(&[&["develop", "a.dng", "--hdr", "2"], options].concat());
        assert!(run.code != 0 && run.err.contains(word), "{options:?}: {}", run.err);
    }
    let run = desk.run(&["develop", "a.dng", "-o", "o.jpg", "--hdr", "9"]);
    assert!(run.code != 0 && run.err.contains("0.5 to 4"), "{}", run.err);
}
