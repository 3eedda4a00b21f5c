//! Looks that a file brings along.

use super::*;

/// Mean L* of a picture.
fn lightness(desk: &Desk, name: &str) -> f64 {
    let picture = image::open(desk.path(name)).unwrap().thumbnail(300, 300).into_rgb8();
    let light = |v: u8| darkroot_colour::RgbSpace::SRGB.curve.decode(f64::from(v) / 255.0);
    let of = |p: &image::Rgb<u8>| {
        let y = 0.2126 * light(p[0]) + 0.7152 * light(p[1]) + 0.0722 * light(p[2]);
        100.0 * darkroot_colour::TransferCurve::LStar.encode(y)
    };
    picture.pixels().map(of).sum::<f64>() / f64::from(picture.width() * picture.height())
}

#[test]
#[cfg_attr(not(has_raw_files), ignore = "needs `raw` in DARKROOT_DATA")]
fn the_look_of_the_camera_is_as_bright_as_its_preview() {
    let desk = Desk::new();
    for (file, neutral_is_off) in [("canon_30d.cr2", 2.0), ("lg_g4_adobe_lossy.dng", 0.5)] {
        let raw = real_files("raw").join(file);
        let raw = raw.to_str().unwrap();
        let run = desk.run(&["inspect", raw, "--preview", "p.jpg", "--overwrite"]);
        assert_eq!(run.code, 0, "{}", run.err);
        let picture = |name, look| {
            desk.develop(&[raw, "-o", name, "--look", look, "--resize", "long:600", "--overwrite"])
        };
        picture("n.png", "neutral");
        let run = picture("c.png", "camera");
        assert!(run.err.contains("the look is that of the embedded preview, as --curve "), "{}", run.err);
        let preview = lightness(&desk, "p.jpg");
        let [neutral, camera] = ["n.png", "c.png"].map(|name| (lightness(&desk, name) - preview).abs());
        assert!(neutral > neutral_is_off && camera < 0.6 * neutral, "{file}: {neutral} {camera}");
        // What the note says makes the same picture, but for its rounding.
        let said = run.err.split("as --curve ").nth(1).unwrap();
        let curve = said.split_whitespace().next().unwrap();
        let saturation = said.split("--saturation ").nth(1).unwrap().split_whitespace().next().unwrap();
        let options = ["--curve", curve, "--saturation", saturation, "--resize", "long:600", "--overwrite"];
        desk.develop(&[&[raw, "-o", "s.png"], &options[..]].concat());
        assert!((lightness(&desk, "s.png") - lightness(&desk, "c.png")).abs() < 0.5, "{file}");
    }
}

#[test]
fn a_camera_without_a_preview_has_no_look_and_has_one_curve_only() {
    let desk = Desk::with_dng();
    desk.fails(
        1,
        &["develop", "a.dng", "-o", "o.png", "--look", "camera"],
        &["a.dng", "no embedded preview"],
    );
    let curve = ["develop", "a.dng", "-o", "o.png", "--look", "camera", "--curve", "50:40"];
    desk.fails(2, &curve, &["has a curve of its own"]);
    assert!(!desk.path("o.png").exists());
}

#[test]
fn one_look_is_made_of_the_previews_of_several_photographs() {
    let desk = Desk::new();
    let nef = sample("still-life.nef");
    // The preview of a linear DNG has the look that was asked for.
    for (name, exposure) in [("roll/a.dng", "0"), ("roll/b.dng", "-0.7"), ("roll/c.dng", "0.4")] {
        std::fs::create_dir_all(desk.path("roll")).unwrap();
        desk.develop(&[
            nef.to_str().unwrap(),
            "-o",
            name,
            "--contrast=-0.6",
            "--saturation=1.2",
            &format!("--exposure={exposure}"),
        ]);
    }
    let run = desk.run(&["recipe", "roll/a.dng", "roll/b.dng", "roll/c.dng", "--camera-look"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("by the previews of 3 photographs"), "{}", run.out);
    let number = |after: &str| -> f64 {
        let rest = run.out.split(after).nth(1).unwrap();
        rest.trim_start_matches([' ', '=']).split_whitespace().next().unwrap().parse().unwrap()
    };
    assert!((number("saturation") - 1.2).abs() < 0.1, "{}", run.out);
    // Less contrast: what is dark becomes brighter, and what is bright darker.
    let points = run.out.split('"').nth(3).unwrap();
    let points: Vec<[f64; 2]> = points
        .split(',')
        .map(|pair| {
            let (before, after) = pair.split_once(':').unwrap();
            [before.parse().unwrap(), after.parse().unwrap()]
        })
        .collect();
    let (dark, bright) = (points[1], points[points.len() - 1]);
    assert!(dark[1] > dark[0] && bright[1] < bright[0], "{points:?}");
    // It is a recipe that a batch takes.
    desk.put("roll/darkroot.toml", &run.out);
    let run = desk.run(&["batch", "roll", "-o", "out"]);
    assert_eq!(run.code, 0, "{}", run.err);
    desk.put("d.dng", small_dng());
    let other = desk.run(&["recipe", "roll/a.dng", "d.dng", "--camera-look"]);
    assert!(other.code == 0 && other.err.contains("left out"), "{} {}", other.out, other.err);
    let none = desk.run(&["recipe", "d.dng", "--camera-look"]);
    assert!(none.code != 0 && none.err.contains("no file has"), "{}", none.err);
}

#[test]
#[cfg_attr(not(has_raw_files), ignore = "needs `raw` in DARKROOT_DATA")]
fn the_local_tone_map_of_a_dng_is_applied_however_it_is_stored() {
    let desk = Desk::new();
    // The same grey and the same map, its gains as whole and as floating-point numbers: 4 in the middle, 1 at the edges.
    let pixel = |kind: &str, place: (u32, u32), options: &[&str]| {
        let raw = real_files("raw").join(format!("pgtm2_{kind}.dng"));
        let name = format!("{kind}.png");
        let run = desk.develop(&[&[raw.to_str().unwrap(), "-o", &name, "--overwrite"], options].concat());
        (image::open(desk.path(&name)).unwrap().into_rgb8().get_pixel(place.0, place.1)[1], run.err)
    };
    let (off, said) = pixel("u8", (100, 100), &["--local-tone", "off"]);
    assert!(said.contains("the file's local tone map is not applied"), "{said}");
    let mut middles = Vec::new();
    for kind in ["u8", "u16", "f16", "f32"] {
        let (middle, said) = pixel(kind, (100, 100), &[]);
        assert!(said.contains("the file's local tone map is applied"), "{said}");
        let (corner, _) = pixel(kind, (0, 0), &[]);
        assert!(middle > off + 60 && corner.abs_diff(off) <= 2, "{kind}: {middle} {corner} {off}");
        middles.push(middle);
    }
    assert!(middles.iter().all(|m| m.abs_diff(middles[0]) <= 1), "{middles:?}");
}
