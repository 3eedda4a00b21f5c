//! `darkroot profile`, on the simulated camera and its chart.

use std::io::Write as _;
use std::process::Stdio;

use darkroot_colour::Spectrum;

use super::*;

/// Spectra as a CSV file has them.
pub(super) fn csv<'a>(spectra: impl IntoIterator<Item = (&'a str, &'a Spectrum)>) -> String {
    let nm: Vec<String> = (0..81).map(|i| Spectrum::wavelength(i).to_string()).collect();
    let mut text = format!("name,{}\n", nm.join(","));
    for (name, spectrum) in spectra {
        let values: Vec<String> = spectrum.0.iter().map(ToString::to_string).collect();
        text += &format!("{name},{}\n", values.join(","));
    }
    text
}

/// A desk with the spectra of the simulated camera and of its chart.
pub(super) fn desk() -> Desk {
    let desk = Desk::new();
    let camera = Camera::simulated_one().sensitivities;
    desk.put("camera.csv", csv(["red", "green", "blue"].into_iter().zip(&camera)));
    let chart = darkroot_simulate::chart::reflectances();
    desk.put("chart.csv", csv(darkroot_simulate::chart::PATCHES.iter().map(|(name, _)| *name).zip(&chart)));
    desk
}

const FROM_SPECTRA: [&str; 10] = [
    "profile",
    "from-spectra",
    "--sensitivities",
    "camera.csv",
    "--reflectances",
    "chart.csv",
    "--make",
    "Darkroot",
    "--camera-model",
    "Simulated One",
];

/// Makes a profile and fails unless that worked.
fn make(desk: &Desk, arguments: &[&str]) -> Run {
    let run = desk.run(&[&FROM_SPECTRA[..], arguments].concat());
    assert_eq!(run.code, 0, "{arguments:?}: {}", run.err);
    run
}

/// Runs `profile apply` with a text on stdin.
fn apply(desk: &Desk, arguments: &[&str], input: &str) -> Run {
    let mut child = desk
        .command(&[&["profile", "apply"], arguments].concat())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that refuses its input may have closed it.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    Run::of(&child.wait_with_output().unwrap(), arguments)
}

fn rows(text: &str) -> Vec<[f64; 3]> {
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        [values[0], values[1], values[2]]
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn a_profile_from_spectra_can_be_applied_shown_and_listed() {
    let desk = desk();
    let said = make(&desk, &["--light", "D65", "A", "--model", "anchored", "-o", "p.toml"]).err;
    assert!(said.contains("D65: dE2000 left out mean 0."), "{said}");

    let run = apply(&desk, &["p.toml", "--light", "D65"], "r,g,b\n1,1,1\n 0.2,0.4,0.1\n0.4,0.8,0.2\n");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.starts_with("X,Y,Z\n"));
    let [white, one, two] = rows(&run.out)[..] else { panic!("{}", run.out) };
    for (found, d50) in white.into_iter().zip([0.9642, 1.0, 0.8249]) {
        assert!((found - d50).abs() < 1e-4, "{white:?}");
    }
    for (one, two) in one.into_iter().zip(two) {
        assert!((2.0 * one - two).abs() < 1e-12, "{one} {two}");
    }

    let shown = desk.run(&["profile", "show", "p.toml"]).out;
    for word in ["Darkroot Simulated One", "leave-one-out", "(rg)^1/2", "residuals", "worst:", "2856 K"] {
        assert!(shown.contains(word), "{word}: {shown}");
    }

    let folder = desk.data.path().join("darkroot/profiles");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::copy(desk.path("p.toml"), folder.join("mine.toml")).unwrap();
    let listed = desk.run(&["profile", "list"]).out;
    let own = listed.lines().find(|l| l.contains("Simulated One")).unwrap();
    assert!(own.contains("anchored") && own.contains("D65, A") && own.contains("mine.toml"), "{own}");
    let json = desk.run(&["profile", "list", "--json"]).out;
    let first: serde_json::Value = serde_json::from_str(json.lines().next().unwrap()).unwrap();
    assert_eq!(first["lights"], serde_json::json!(["D65", "A"]));
    // By the name of the camera, too.
    let by_name = apply(&desk, &["darkroot simulated one", "--light", "A"], "r,g,b\n1,1,1\n");
    assert_eq!(by_name.code, 0, "{}", by_name.err);
}

#[test]
fn between_two_lights_a_temperature_interpolates() {
    let desk = desk();
    make(&desk, &["--light", "D65", "A", "--model", "root-2", "-o", "p.toml"]);
    let at = |light: &str| {
        let run = apply(&desk, &["p.toml", "--light", light], "r,g,b\n0.1,0.2,0.8\n");
        assert_eq!(run.code, 0, "{}", run.err);
        rows(&run.out)[0][0]
    };
    let (cold, warm, between) = (at("D65"), at("A"), at("4000K"));
    assert!(between > cold.min(warm) && between < cold.max(warm), "{cold} {between} {warm}");
    assert!((at("20000K") - cold).abs() < 1e-12 && (at("2000K") - warm).abs() < 1e-12);
}

#[test]
fn the_same_spectra_make_the_same_file_to_the_last_byte() {
    let desk = desk();
    for kind in ["spectral", "chromatic", "half"] {
        for name in ["one.toml", "two.toml"] {
            make(
                &desk,
                &["--light", "D50", "--model", kind, "--date", "2026-01-02", "-o", name, "--overwrite"],
            );
        }
        assert_eq!(desk.read("one.toml"), desk.read("two.toml"), "{kind}");
        let text = String::from_utf8(desk.read("one.toml")).unwrap();
        assert!(text.contains("date = \"2026-01-02\"") && text.contains(&format!("model = \"{kind}\"")));
    }
}

#[test]
fn colours_through_a_profile_from_spectra_are_nearer_than_by_the_matrix() {
    let desk = desk();
    make(&desk, &["--light", "D50", "--model", "spectral", "-o", "p.toml"]);
    // What the camera makes of the chart, and what the chart is.
    let light = darkroot_colour::illuminant::Illuminant::by_name("D50").unwrap().spectrum();
    let camera = Camera::simulated_one();
    let white = camera.response(&Spectrum::constant(1.0), &light);
    let mut input = "r,g,b\n".to_owned();
    let mut truth = Vec::new();
    for patch in darkroot_simulate::chart::reflectances() {
        let rgb = camera.response(&patch, &light);
        input += &format!("{},{},{}\n", rgb[0] / white[0], rgb[1] / white[1], rgb[2] / white[2]);
        truth.push(patch.reflected_xyz(&light));
    }
    let run = apply(&desk, &["p.toml"], &input);
    let matrix = camera.calibration(&light, 5003.0).forward_matrix.unwrap();
    let d50 = darkroot_colour::white::D50;
    let error = |colours: Vec<[f64; 3]>| {
        let pairs = colours.into_iter().zip(&truth);
        let sum: f64 = pairs
            .map(|(c, t)| {
                darkroot_colour::difference::de2000(darkroot_colour::Xyz::from(c).lab(d50), t.lab(d50))
            })
            .sum();
        sum / 24.0
    };
    let by_matrix: Vec<[f64; 3]> =
        rows(&input).into_iter().map(|rgb| (matrix * darkroot_colour::Vector3::from(rgb)).into()).collect();
    let (own, other) = (error(rows(&run.out)), error(by_matrix));
    assert!(own < 0.6 * other, "{own} against {other}");
}

#[test]
fn rows_that_cannot_be_read_are_named() {
    let desk = desk();
    make(&desk, &["--light", "D65", "A", "--model", "root-2", "-o", "p.toml"]);
    for (arguments, input, words) in [
        (&["p.toml", "--light", "A"][..], "r,g\n1,1\n", "no column `b`"),
        (&["p.toml", "--light", "A"], "r,g,b\n1,1,1\n1,grey,1\n", "line 3: `grey`"),
        (&["p.toml", "--light", "A"], "r,g,b\n1,1,inf\n", "line 2: `inf`"),
        (&["p.toml", "--light", "A"], "", "no column `r`"),
        (&["p.toml"], "r,g,b\n1,1,1\n", "D65, A; choose one; `--light` names it"),
        (&["p.toml", "--light", "moon"], "r,g,b\n1,1,1\n", "no light `moon`"),
        (&["nothing.toml"], "r,g,b\n1,1,1\n", "there is no such file"),
        (&["Nothing D1"], "r,g,b\n1,1,1\n", "neither a profile file nor a camera"),
    ] {
        let run = apply(&desk, arguments, input);
        assert!(run.code == 2 && run.err.contains(words), "{arguments:?} {input:?}: {}", run.err);
    }
}

#[test]
fn faults_of_a_profile_end_with_code_3() {
    let desk = desk();
    make(&desk, &["--light", "D50", "--model", "spectral", "-o", "good.toml"]);
    let good = desk.run(&["profile", "lint", "good.toml"]);
    assert_eq!(good.code, 0, "{}", good.out);
    assert!(good.out.contains("the Jacobian changes its sign in 0.0 %"), "{}", good.out);

    let refused =
        [&FROM_SPECTRA[..], &["--light", "D50", "--model", "polynomial-2", "-o", "bad.toml"]].concat();
    desk.fails(2, &refused, &["change with exposure", "--force"]);
    make(&desk, &["--light", "D50", "--model", "polynomial-2", "--force", "-o", "bad.toml"]);
    let bad = desk.run(&["profile", "lint", "--json", "bad.toml", "good.toml"]);
    assert_eq!(bad.code, 3, "{}", bad.out);
    let failed: Vec<serde_json::Value> = bad
        .out
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .filter(|f: &serde_json::Value| f["severity"] == "failure")
        .collect();
    assert!(failed.iter().any(|f| f["check"] == "exposure" && f["profile"] == "bad.toml"), "{failed:?}");
    assert!(failed.iter().all(|f| f["profile"] != "good.toml"), "{failed:?}");
}

#[test]
fn spectra_that_cannot_be_used_are_named() {
    let desk = desk();
    desk.put("short.csv", "name,450,500,550\nr,1,2,3\ng,1,2,3\nb,1,2,3\n");
    desk.put("two.csv", csv([("r", &Spectrum::constant(1.0)), ("g", &Spectrum::constant(1.0))]));
    for (from, to, light, words) in [
        ("camera.csv", "short.csv", "D50", ["short.csv", "400"]),
        ("camera.csv", "two.csv", "D50", ["two.csv", "has 2 spectra"]),
        ("camera.csv", "none.csv", "D50", ["none.csv", "cannot be read"]),
        ("camera.csv", "camera.csv", "0.3,0.3", ["xy 0.3,0.3", "spectrum is not known"]),
        ("camera.csv", "camera.csv", "sunny", ["`sunny` is no light", "LED-B3"]),
    ] {
        let arguments = [&FROM_SPECTRA[..], &["--light", light, "-o", "p.toml"]].concat();
        let arguments: Vec<&str> = arguments.iter().map(|a| if *a == from { to } else { a }).collect();
        desk.fails(2, &arguments, &words);
    }
    assert!(!desk.names().contains(&"p.toml".to_owned()));
}
