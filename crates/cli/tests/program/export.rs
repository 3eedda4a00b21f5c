//! `darkroot profile export`: each file is what was asked for, and what is missing is said.

use darkroot_colour::{Vector3, white};
use darkroot_profile::export::clf::Clf;
use darkroot_profile::export::dcp::Dcp;
use darkroot_profile::export::icc::Icc;

use super::*;

/// A linear profile of the simulated camera under one light.
const SIMULATED: &str = r#"format = "darkroot profile"
version = 1

[camera]
make = "Darkroot"
model = "Simulated One"

[[calibration]]
light = "D65"
xy = [0.3127, 0.3290]
model = "linear"

[calibration.terms]
r = [0.7, 0.28, 0.02]
g = [0.16, 0.8, -0.1]
b = [0.1042, -0.08, 0.9049]
"#;

const D700: [&str; 3] = ["profile", "export", "Nikon D700"];

/// Exports and fails unless that worked.
fn export(desk: &Desk, arguments: &[&str]) -> Run {
    let run = desk.run(&[&["profile", "export"], arguments].concat());
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{arguments:?}: {}", run.err);
    run
}

/// Mean and largest deviation of each line that says one.
fn figures(err: &str) -> Vec<[f64; 2]> {
    let number = |line: &str, word: &str| {
        let (_, rest) = line.split_once(word)?;
        rest.split([',', ' ']).next()?.parse().ok()
    };
    err.lines().filter_map(|line| Some([number(line, "mean ")?, number(line, "max ")?])).collect()
}

#[test]
fn every_format_says_how_far_it_is_from_the_profile() {
    let desk = Desk::new();
    for (format, options) in [
        ("icc", &["--light", "D50"][..]),
        ("icc", &["--light", "D50", "--icc-version", "2"]),
        ("clf", &["--light", "4000K"]),
        ("cube", &["--light", "a"]),
        ("dcp", &["--neutral", "0.47,1,0.68", "--neutral", "0.75,1,0.35"]),
    ] {
        let run = export(
            &desk,
            &[&["Nikon D700", "--to", format, "-o", "out"], options, &["--overwrite"]].concat(),
        );
        let figures = figures(&run.err);
        assert_eq!(figures.len(), if format == "dcp" { 2 } else { 1 }, "{format}: {}", run.err);
        assert!(figures.iter().all(|[mean, max]| *mean < 0.1 && *max < 2.0), "{format}: {}", run.err);
        let first = desk.read("out");
        let quiet = &["--overwrite", "--quiet"][..];
        let run = export(&desk, &[&["Nikon D700", "--to", format, "-o", "out"], options, quiet].concat());
        assert!(run.err.is_empty() && desk.read("out") == first, "{format}");
    }
}

#[test]
fn what_is_in_the_files_is_the_camera_s_colour() {
    let desk = Desk::new();
    desk.put("p.toml", SIMULATED);
    let rgb = [0.2, 0.4, 0.1];
    let truth = [0.7 * 0.2 + 0.16 * 0.4 + 0.010_42, 0.056 + 0.32 - 0.008, 0.004 - 0.04 + 0.090_49];
    let near = |found: darkroot_colour::Xyz, what: &str| {
        let off = Vector3::from(found) - Vector3::from(truth);
        assert!(off.amax() < 1e-4, "{what}: {found:?}");
    };
    export(&desk, &["p.toml", "--to", "icc", "-o", "a.icc"]);
    near(Icc::read(&desk.read("a.icc")).unwrap().xyz(rgb), "icc");
    export(&desk, &["p.toml", "--to", "icc", "--icc-version", "2", "-o", "two.icc"]);
    near(Icc::read(&desk.read("two.icc")).unwrap().xyz(rgb), "icc of version 2");
    assert_eq!((desk.read("a.icc")[8], desk.read("two.icc")[8]), (4, 2));
    export(&desk, &["p.toml", "--to", "clf", "--space", "rec2020-linear", "--grid", "40", "-o", "a.clf"]);
    let text = String::from_utf8(desk.read("a.clf")).unwrap();
    assert!(text.contains("dim=\"40 40 40 3\"") && text.contains("Rec. 2020, linear"));
    near(Clf::read(&text).unwrap().xyz(&darkroot_colour::RgbSpace::REC2020, rgb), "clf");
    export(&desk, &["p.toml", "--to", "cube", "--shaper", "none", "--space", "srgb", "-o", "a.cube"]);
    let text = String::from_utf8(desk.read("a.cube")).unwrap();
    assert!(text.contains("# in:  balanced camera RGB, linear") && text.contains("# out: sRGB, coded"));
    export(&desk, &["p.toml", "--to", "dcp", "--neutral", "1,2,1", "-o", "a.dcp"]);
    near(Dcp::read(&desk.read("a.dcp")).unwrap().lights[0].xyz(rgb), "dcp");
}

#[test]
fn a_raw_file_of_the_camera_gives_the_neutral() {
    let desk = Desk::with_dng();
    desk.put("p.toml", SIMULATED);
    export(&desk, &["p.toml", "--to", "dcp", "--for", "a.dng", "-o", "a.dcp"]);
    let read = Dcp::read(&desk.read("a.dcp")).unwrap();
    assert_eq!((read.camera.as_str(), read.lights.len()), ("Darkroot Simulated One", 1));
    let d65 = darkroot_colour::illuminant::Illuminant::by_name("D65").unwrap().spectrum();
    let real =
        Vector3::from(Camera::simulated_one().response(&darkroot_colour::Spectrum::constant(1.0), &d65));
    let found = read.lights[0].color_matrix * Vector3::from(white::D65_XY.xyz());
    assert!((found / found.max() - real / real.max()).amax() < 0.03, "{found} is not {real}");

    desk.put("b.nef", small_nef());
    let other = ["profile", "export", "p.toml", "--to", "dcp", "--for", "b.nef", "-o", "b.dcp"];
    desk.fails(2, &other, &["b.nef", "D750", "not with Darkroot Simulated One"]);
}

#[test]
fn a_dcp_without_the_white_of_its_lights_is_refused() {
    let desk = Desk::new();
    let to = ["--to", "dcp", "-o", "a.dcp"];
    desk.fails(2, &[&D700[..], &to].concat(), &["D65, A", "--for", "--neutral"]);
    let one = ["--neutral", "0.47,1,0.68"];
    desk.fails(2, &[&D700[..], &to, &one].concat(), &["once for each", "D65, A"]);
    let none = ["--neutral", "0,1,1"];
    desk.fails(2, &[&D700[..], &to, &none].concat(), &["`0,1,1` is no neutral"]);
    assert!(desk.names().is_empty());
}

#[test]
fn options_that_do_not_belong_to_the_format_are_refused() {
    let desk = Desk::new();
    desk.put("there.icc", "mine");
    for (arguments, words) in [
        (&["--to", "icc", "--space", "srgb", "-o", "a"][..], &["`--space` belongs to cube and clf"][..]),
        (&["--to", "clf", "--shaper", "sqrt", "-o", "a"], &["`--shaper` belongs to cube"]),
        (&["--to", "dcp", "--grid", "33", "-o", "a"], &["`--grid` belongs to icc"]),
        (&["--to", "clf", "--icc-version", "2", "-o", "a"], &["`--icc-version` belongs to icc"]),
        (&["--to", "icc", "--icc-version", "3", "-o", "a"], &["possible values: 2, 4"]),
        (&["--to", "icc", "--neutral", "1,1,1", "-o", "a"], &["`--neutral` belongs to dcp"]),
        (&["--to", "icc", "-o", "a"], &["D65, D50, A; choose one", "`--light`"]),
        (&["--to", "icc", "--light", "D65", "A", "-o", "a"], &["one light"]),
        (&["--to", "dcp", "--light", "A", "D50", "D65", "-o", "a"], &["at most two"]),
        (&["--to", "clf", "--light", "A", "--space", "srgb", "-o", "a"], &["linear spaces"]),
        (&["--to", "cube", "--light", "A", "--space", "camera", "-o", "a"], &["another `--space`"]),
        (&["--to", "icc", "--light", "A", "-o", "there.icc"], &["exists already"]),
    ] {
        desk.fails(2, &[&D700[..], arguments].concat(), words);
    }
    assert_eq!(desk.names(), ["there.icc"]);
}

#[test]
fn a_dcp_serves_as_a_profile() {
    let desk = Desk::with_dng();
    desk.put("p.toml", SIMULATED);
    export(&desk, &["p.toml", "--to", "dcp", "--for", "a.dng", "-o", "p.dcp"]);
    let shown = desk.run(&["profile", "show", "p.dcp"]);
    assert!(
        shown.out.contains("DCP \"Darkroot Darkroot Simulated One D65\", dE2000 from it"),
        "{}",
        shown.out
    );
    let run = desk.run(&["develop", "a.dng", "--profile", "p.dcp", "-o", "dcp.png"]);
    assert!(run.code == 0 && run.err.contains("profile for Darkroot Simulated One"), "{}", run.err);
    desk.develop(&["a.dng", "--profile", "p.toml", "-o", "toml.png"]);
    let picture = |name: &str| image::open(desk.path(name)).unwrap().into_rgb8();
    let (one, two) = (picture("dcp.png"), picture("toml.png"));
    let off = one.iter().zip(two.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(off <= Some(3), "{off:?}"); // Of 255, where the table clips a colour.

    desk.put("broken.dcp", &desk.read("p.dcp")[..300]);
    desk.fails(
        2,
        &["profile", "apply", "broken.dcp"],
        &["broken.dcp", "is not a DCP file that this program reads"],
    );
}
