//! What the camera wrote about the shot is in the picture, and what no longer holds is not.

use darkroot_photo::Orientation;
use darkroot_photo::metadata::{Directory, Value as Field, tag};
use exif::{Exif, In, Reader, Tag, Value};

use super::*;

const CONTAINERS: [&str; 4] = ["jpg", "tif", "png", "webp"];

fn read(desk: &Desk, name: &str) -> Exif {
    let bytes = desk.read(name);
    Reader::new()
        .read_from_container(&mut std::io::Cursor::new(bytes))
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn text(exif: &Exif, tag: Tag) -> String {
    match &exif.get_field(tag, In::PRIMARY).unwrap_or_else(|| panic!("no {tag}")).value {
        Value::Ascii(lines) => String::from_utf8(lines[0].clone()).unwrap(),
        other => panic!("{tag}: {other:?}"),
    }
}

fn number(exif: &Exif, tag: Tag) -> f64 {
    match &exif.get_field(tag, In::PRIMARY).unwrap_or_else(|| panic!("no {tag}")).value {
        Value::Rational(v) => v[0].to_f64(),
        other => f64::from(other.get_uint(0).unwrap_or_else(|| panic!("{tag}: {other:?}"))),
    }
}

/// A camera held upright, with a photographer whose name is not ASCII.
fn turned() -> darkroot_simulate::Exposure {
    let mut metadata = darkroot_simulate::expose::metadata();
    let text = |s: &str| Field::Text(s.to_owned());
    metadata.set(Directory::Image, tag::ARTIST, text("Zoë Müller"));
    metadata.set(Directory::Image, tag::COPYRIGHT, text("(c) 2026 Zoë Müller"));
    metadata.set(Directory::Exif, tag::EXPOSURE_TIME, Field::Rationals(vec![(1, 250)]));
    metadata.set(Directory::Exif, tag::ISO, Field::Shorts(vec![400]));
    Exposure { metadata, orientation: Orientation::Rotate90, ..Exposure::default() }
}

#[test]
fn the_shot_is_described_in_every_container_that_has_a_place_for_it() {
    let desk = Desk::new();
    let scene = Scene::still_life(FRAME);
    let dng = dng::write(&expose(&scene, &Camera::simulated_one(), &turned()), dng::Storage::JpegStrip);
    let nef = nef::write(&expose(&scene, &Camera::nikon_d750(), &turned()), nef::Storage::Lossless).unwrap();
    desk.put("a.dng", dng);
    desk.put("b.nef", nef);
    for (input, make, model) in
        [("a.dng", "Darkroot", "Simulated One"), ("b.nef", "NIKON CORPORATION", "NIKON D750")]
    {
        for ending in CONTAINERS {
            let name = format!("o.{ending}");
            desk.develop(&[input, "-o", &name, "--overwrite"]);
            let exif = read(&desk, &name);
            assert_eq!(text(&exif, Tag::Make), make, "{name}");
            assert_eq!(text(&exif, Tag::Model), model, "{name}");
            assert_eq!(text(&exif, Tag::LensModel), "Simulated 85mm f/1.8", "{name}");
            assert_eq!(text(&exif, Tag::DateTimeOriginal), "2026:01:01 12:00:00", "{name}");
            assert_eq!(text(&exif, Tag::Artist), "Zoë Müller", "{name}");
            assert_eq!(text(&exif, Tag::Copyright), "(c) 2026 Zoë Müller", "{name}");
            let software = text(&exif, Tag::Software);
            assert_eq!(software, format!("Darkroot {}", env!("CARGO_PKG_VERSION")), "{name}");
            assert!((number(&exif, Tag::ExposureTime) - 0.004).abs() < 1e-9, "{name}");
            assert!((number(&exif, Tag::FNumber) - 8.0).abs() < 1e-9, "{name}");
            assert!((number(&exif, Tag::PhotographicSensitivity) - 400.0).abs() < 1e-9, "{name}");
            assert!((number(&exif, Tag::FocalLength) - 85.0).abs() < 1e-9, "{name}");
            assert!((number(&exif, Tag::ColorSpace) - 1.0).abs() < 1e-9, "{name}");
        }
    }
}

#[test]
fn a_picture_that_was_turned_says_that_it_is_upright() {
    let desk = Desk::new();
    let capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &turned());
    assert_eq!(capture.counts.size().width, FRAME.height);
    desk.put("a.dng", dng::write(&capture, dng::Storage::JpegStrip));
    desk.put("straight.dng", small_dng());
    desk.develop(&["straight.dng", "-o", "straight.png"]);
    let straight = image::open(desk.path("straight.png")).unwrap().to_rgb8();
    for ending in CONTAINERS {
        let name = format!("o.{ending}");
        desk.develop(&["a.dng", "-o", &name]);
        let exif = read(&desk, &name);
        assert!((number(&exif, Tag::Orientation) - 1.0).abs() < 1e-9, "{name}");
        let upright = image::open(desk.path(&name)).unwrap().to_rgb8();
        assert_eq!(upright.dimensions(), (WIDTH, HEIGHT), "{name}");
        let sum: u64 = upright.iter().zip(straight.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        // The filters stand in another phase, which shows a little in a picture so small.
        assert!(sum < 10 * upright.len() as u64, "{name}: {}", sum as f64 / upright.len() as f64);
    }
}

#[test]
fn a_picture_in_another_space_than_srgb_does_not_say_srgb() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "--space", "adobe-rgb"]);
    assert!((number(&read(&desk, "a.jpg"), Tag::ColorSpace) - 65535.0).abs() < 1e-9);
}

#[test]
fn the_size_in_the_exif_is_that_of_the_picture() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng"]);
    let exif = read(&desk, "a.jpg");
    assert!((number(&exif, Tag::PixelXDimension) - f64::from(WIDTH)).abs() < 1e-9);
    assert!((number(&exif, Tag::PixelYDimension) - f64::from(HEIGHT)).abs() < 1e-9);
}

#[test]
fn other_formats_carry_the_name_of_the_camera_in_their_bytes() {
    let desk = Desk::with_dng();
    for name in ["o.avif", "o.jxl"] {
        desk.develop(&["a.dng", "-o", name]);
        let bytes = desk.read(name);
        assert!(bytes.windows(13).any(|w| w == b"Simulated One"), "{name}");
    }
}

#[test]
fn the_size_on_paper_is_stated_as_asked() {
    let desk = Desk::with_dng();
    for ending in CONTAINERS {
        let name = format!("o.{ending}");
        desk.develop(&["a.dng", "-o", &name, "--dpi", "300"]);
        let exif = read(&desk, &name);
        assert_eq!(number(&exif, Tag::XResolution) as u32, 300, "{name}");
        assert_eq!(number(&exif, Tag::YResolution) as u32, 300, "{name}");
        assert_eq!(number(&exif, Tag::ResolutionUnit) as u32, 2, "{name}");
    }
    desk.fails(2, &["develop", "a.dng", "--dpi", "0"], &["--dpi", "1 to 10000"]);
}

/// As a program for sorting photographs writes it beside them.
const SIDECAR: &str = r#"<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
<rdf:Description rdf:about="" xmlns:xmp="http://ns.adobe.com/xap/1.0/" xmlns:dc="http://purl.org/dc/elements/1.1/"
 xmlns:crs="http://ns.adobe.com/camera-raw-settings/1.0/" xmlns:exif="http://ns.adobe.com/exif/1.0/"
 xmp:Rating="4" crs:Exposure2012="+1.5" exif:GPSLatitude="47,22.5N" exif:GPSLongitude="8,30W">
<dc:subject><rdf:Bag><rdf:li>fog</rdf:li><rdf:li>lake</rdf:li></rdf:Bag></dc:subject>
<dc:creator><rdf:Seq><rdf:li>Ann</rdf:li><rdf:li>Bob</rdf:li></rdf:Seq></dc:creator>
</rdf:Description></rdf:RDF></x:xmpmeta>"#;

fn holds(desk: &Desk, name: &str, text: &[u8]) -> bool {
    desk.read(name).windows(text.len()).any(|at| at == text)
}

#[test]
fn what_stands_in_a_sidecar_goes_into_every_format() {
    let desk = Desk::with_dng();
    desk.put("a.dng.xmp", SIDECAR);
    for ending in CONTAINERS {
        let name = format!("o.{ending}");
        desk.develop(&["a.dng", "-o", &name]);
        let exif = read(&desk, &name);
        assert_eq!(text(&exif, Tag::Artist), "Ann; Bob", "{name}");
        assert_eq!(text(&exif, Tag::GPSLongitudeRef), "W", "{name}");
        for wanted in ["<rdf:li>lake</rdf:li>", "<xmp:Rating>4</xmp:Rating>"] {
            assert!(holds(&desk, &name, wanted.as_bytes()), "{name}: {wanted}");
        }
        assert!(!holds(&desk, &name, b"Exposure2012"), "{name}");
        // IPTC has a place in two of them: keywords are dataset 25 of record 2.
        let keyword = b"\x1c\x02\x19\x00\x04lake";
        assert_eq!(holds(&desk, &name, keyword), ["jpg", "tif"].contains(&ending), "{name}");
    }
    desk.develop(&["a.dng", "-o", "o.jxl"]);
    assert!(holds(&desk, "o.jxl", b"<rdf:li>lake</rdf:li>"));
}

#[test]
fn what_is_asked_for_counts_most_and_what_is_not_wanted_stays_out() {
    let desk = Desk::with_dng();
    desk.put("a.xmp", SIDECAR);
    let tags = "xmp:Rating=; dc:title=Fog & lake; photoshop:City=Zürich";
    desk.develop(&["a.dng", "-o", "asked.jpg", "--artist", "Cy", "--copyright", "(c) Cy", "--set-tag", tags]);
    let exif = read(&desk, "asked.jpg");
    assert_eq!((text(&exif, Tag::Artist), text(&exif, Tag::Copyright)), ("Cy".into(), "(c) Cy".into()));
    assert!(
        holds(&desk, "asked.jpg", b"Fog &amp; lake") && holds(&desk, "asked.jpg", b"\x1c\x02\x5a\x00\x07Z")
    );
    assert!(!holds(&desk, "asked.jpg", b"xmp:Rating") && holds(&desk, "asked.jpg", b"lake</rdf:li>"));
    desk.develop(&["a.dng", "-o", "no-gps.jpg", "--metadata", "no-gps"]);
    assert!(!holds(&desk, "no-gps.jpg", b"GPSLatitude") && holds(&desk, "no-gps.jpg", b"lake</rdf:li>"));
    assert!(read(&desk, "no-gps.jpg").get_field(Tag::GPSLatitude, In::PRIMARY).is_none());
    desk.develop(&["a.dng", "-o", "basic.jpg", "--metadata", "basic"]);
    assert!(!holds(&desk, "basic.jpg", b"lake") && holds(&desk, "basic.jpg", b"Simulated One"));
    desk.develop(&["a.dng", "-o", "none.jpg", "--metadata", "none"]);
    assert!(!holds(&desk, "none.jpg", b"Exif\0") && !holds(&desk, "none.jpg", b"xmpmeta"));
}

#[test]
fn a_sidecar_that_cannot_be_read_is_left_out_with_a_note() {
    let desk = Desk::with_dng();
    desk.put("a.dng.xmp", "<x:xmpmeta");
    let told = desk.run(&["develop", "a.dng", "-v"]);
    assert_eq!(told.code, 0, "{}", told.err);
    for words in ["a.dng.xmp", "no XMP", "mend"] {
        assert!(told.err.contains(words), "{words}: {}", told.err);
    }
    desk.develop(&["a.dng", "-o", "basic.jpg", "--metadata", "basic"]);
    desk.fails(2, &["develop", "a.dng", "--set-tag", "Rating=4"], &["set-tag", "PREFIX:NAME=VALUE"]);
}

#[test]
fn a_broken_sidecar_costs_a_batch_nothing_but_what_it_says() {
    let desk = Desk::with_dng();
    desk.put("b.dng", std::fs::read(desk.path("a.dng")).unwrap());
    desk.put("a.xmp", SIDECAR);
    desk.put("b.xmp", "no XMP at all");
    let batch = || desk.run(&["batch", "a.dng", "b.dng", "-o", "out", "-v"]);
    let told = batch();
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("b.xmp"), "{}", told.err);
    assert!(holds(&desk, "out/a.jpg", b"lake</rdf:li>") && !holds(&desk, "out/b.jpg", b"lake</rdf:li>"));
    desk.put("b.xmp", SIDECAR);
    assert_eq!(batch().code, 0);
    assert!(holds(&desk, "out/b.jpg", b"lake</rdf:li>"));
}

#[test]
fn a_batch_takes_sidecars_and_develops_anew_when_they_change() {
    let desk = Desk::with_dng();
    desk.put("a.xmp", SIDECAR);
    assert_eq!(desk.run(&["batch", "a.dng", "-o", "out", "-q"]).code, 0);
    assert!(holds(&desk, "out/a.jpg", b"lake</rdf:li>"));
    desk.put("a.xmp", SIDECAR.replace("lake", "pond"));
    assert_eq!(desk.run(&["batch", "a.dng", "-o", "out", "-q"]).code, 0);
    assert!(holds(&desk, "out/a.jpg", b"pond</rdf:li>"));
}
