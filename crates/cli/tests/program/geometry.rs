//! Pictures are cropped, turned, straightened and made smaller as people ask.

use darkroot_photo::metadata::{Directory, Value as Field, tag};

use super::*;

fn size(desk: &Desk, name: &str) -> (u32, u32) {
    image::image_dimensions(desk.path(name)).unwrap()
}

#[test]
fn a_picture_has_the_size_that_was_asked_for() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "whole.png"]);
    let (width, height) = size(&desk, "whole.png");
    for (options, expected) in [
        (&["--resize", "long:40"][..], (40, (40.0 * f64::from(height) / f64::from(width)).round() as u32)),
        (&["--resize", "50%"], (width.div_ceil(2), height.div_ceil(2))),
        (&["--resize", "long:4000"], (width, height)),
        (
            &["--resize", "long:200", "--enlarge"],
            (200, (200.0 * f64::from(height) / f64::from(width)).round() as u32),
        ),
        (&["--crop", "10,5,31,20"], (31, 20)),
        (&["--crop", "1:1"], (height, height)),
        (&["--rotate", "90"], (height, width)),
        (&["--crop", "10,5,31,20", "--rotate", "270", "--resize", "20x10"], (16, 10)),
    ] {
        desk.develop(&[&["a.dng", "-o", "o.png", "--overwrite"], options].concat());
        assert_eq!(size(&desk, "o.png"), expected, "{options:?}");
    }
    desk.develop(&["a.dng", "-o", "s.png", "--straighten", "5"]);
    let straight = size(&desk, "s.png");
    assert!(straight.0 < width && straight.1 < height, "{straight:?}");
    // What the metadata say of the size follows.
    desk.develop(&["a.dng", "-o", "o.jpg", "--resize", "long:40"]);
    let exif =
        exif::Reader::new().read_from_container(&mut std::io::Cursor::new(desk.read("o.jpg"))).unwrap();
    let across =
        exif.get_field(exif::Tag::PixelXDimension, exif::In::PRIMARY).and_then(|f| f.value.get_uint(0));
    assert!(across.is_none_or(|across| across == 40), "{across:?}");
}

#[test]
fn a_picture_that_leans_is_straightened_by_its_lines() {
    let desk = Desk::new();
    for degrees in ["2.5", "-1.2"] {
        let turn = format!("--straighten={degrees}");
        desk.develop(&[
            sample("still-life.dng").to_str().unwrap(),
            &turn,
            "-o",
            "leaning.dng",
            "--overwrite",
        ]);
        let run = desk.run(&[
            "develop",
            "leaning.dng",
            "-o",
            "o.jpg",
            "--straighten",
            "auto",
            "--overwrite",
            "--json",
        ]);
        assert_eq!(run.code, 0, "{}", run.err);
        let found = run.out.split("straightened by ").nth(1).and_then(|rest| rest.split(' ').next());
        let found: f64 = found.unwrap_or_else(|| panic!("{}", run.out)).parse().unwrap();
        let right = -degrees.parse::<f64>().unwrap();
        assert!((found - right).abs() < 0.15, "{degrees}: {found}");
    }
    // A scene of slopes has no lines.
    let flat = expose(&Scene::gradient(FRAME), &Camera::simulated_one(), &Exposure::default());
    desk.put("slope.dng", dng::write(&flat, dng::Storage::Uncompressed));
    let run = desk.run(&["develop", "slope.dng", "-o", "slope.png", "--straighten", "auto", "--json"]);
    assert!(run.code == 0 && run.out.contains("was not straightened"), "{} {}", run.out, run.err);
    assert_eq!(size(&desk, "slope.png"), (WIDTH, HEIGHT));
}

#[test]
fn a_recipe_says_it_too_and_a_batch_follows() {
    let desk = Desk::new();
    desk.put("roll/a.dng", small_dng());
    desk.put("roll/darkroot.toml", "resize = \"long:40\"\nstraighten = 2\n");
    let run = desk.run(&["batch", "roll", "-o", "out", "--format", "png"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(size(&desk, "out/a.png").0, 40);
}

#[test]
fn what_cannot_be_is_said_and_nothing_is_written() {
    let desk = Desk::with_dng();
    for (options, words) in [
        (["--crop", "0,0,5000,20"], &["a.dng", "not inside"][..]),
        (["--crop", "5:0"], &["5:0", "3:2"]),
        (["--resize", "2048"], &["2048", "long:PIXELS"]),
        (["--straighten", "90"], &["90", "45"]),
        (["--perspective", "1,2,3"], &["1,2,3", "corners"]),
        (["--perspective", "0,0,9,9,9,0,0,9"], &["a.dng", "convex"]),
        (["--perspective", "vertical:1%,2"], &["vertical:1%,2", "lines"]),
        (["--perspective", "vertical:10,20,90,22"], &["a.dng", "45 degrees"]),
        (["--resize", "100000%"], &["a.dng", "65500"]),
    ] {
        let run = desk.run(&[&["develop", "a.dng", "-o", "o.png"], &options[..]].concat());
        assert_ne!(run.code, 0, "{options:?}");
        for word in words {
            assert!(run.err.contains(word), "{options:?} says nothing of `{word}`: {}", run.err);
        }
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn a_lens_that_lensfun_knows_is_named_and_corrected_and_another_one_is_named() {
    let desk = Desk::with_dng();
    let run = desk.develop(&["a.dng", "-o", "o.png", "--lens", "lensfun"]);
    assert!(run.err.contains("does not know `Simulated 85mm f/1.8`"), "{}", run.err);
    let run = desk.develop(&["a.dng", "-o", "p.png", "--lens", "lensfun", "--lens-name", "Other 85mm"]);
    assert!(run.err.contains("does not know `Other 85mm`"), "{}", run.err);
    let mut metadata = darkroot_simulate::expose::metadata();
    let text = |s: &str| Field::Text(s.to_owned());
    metadata.set(Directory::Exif, tag::LENS_MAKE, text("Canon"));
    metadata.set(Directory::Exif, tag::LENS_MODEL, text("EF24-105mm f/4L IS USM"));
    metadata.set(Directory::Exif, tag::FOCAL_LENGTH, Field::Rationals(vec![(24, 1)]));
    metadata.set(Directory::Exif, tag::F_NUMBER, Field::Rationals(vec![(4, 1)]));
    let camera = Camera { make: "Canon".into(), model: "Canon EOS 6D".into(), ..Camera::simulated_one() };
    let exposure = Exposure { metadata, ..Exposure::default() };
    let capture = expose(&Scene::still_life(FRAME), &camera, &exposure);
    desk.put("b.dng", dng::write(&capture, dng::Storage::Uncompressed));
    let run = desk.develop(&["b.dng", "-o", "b.png", "--lens", "lensfun"]);
    assert!(run.err.contains("24-105mm") && run.err.contains("(lensfun)"), "{}", run.err);
    let other = "Canon EF 24-70mm f/2.8L USM";
    let run = desk.develop(&["b.dng", "-o", "other.png", "--lens", "lensfun", "--lens-name", other]);
    assert!(
        run.err.contains("24-70mm f/2.8L") && desk.read("b.png") != desk.read("other.png"),
        "{}",
        run.err
    );
    desk.develop(&["b.dng", "-o", "plain.png"]);
    assert_ne!(desk.read("b.png"), desk.read("plain.png"));
    desk.develop(&["b.dng", "-o", "off.png", "--lens", "off"]);
    assert_eq!(desk.read("off.png"), desk.read("plain.png"));
}

#[test]
fn a_crop_that_the_file_says_is_honoured_and_can_be_undone() {
    let desk = Desk::new();
    let mut capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &Exposure::default());
    let whole = capture.default_crop;
    capture.user_crop = Some(darkroot_photo::Rect { x: whole.x + 12, y: whole.y + 8, width: 48, height: 32 });
    desk.put("a.dng", dng::write(&capture, dng::Storage::Uncompressed));
    let run = desk.develop(&["a.dng", "-o", "cut.png"]);
    assert!(run.err.contains("cut to what was chosen"), "{}", run.err);
    assert_eq!(size(&desk, "cut.png"), (48, 32));
    let run = desk.develop(&["a.dng", "-o", "all.png", "--crop", "100%"]);
    assert!(!run.err.contains("cut to what was chosen"), "{}", run.err);
    assert_eq!(size(&desk, "all.png"), (WIDTH, HEIGHT));
    let [cut, all] = ["cut.png", "all.png"].map(|name| image::open(desk.path(name)).unwrap().into_rgb8());
    let part = image::imageops::crop_imm(&all, 12, 8, 48, 32).to_image();
    assert!(cut == part);
}
