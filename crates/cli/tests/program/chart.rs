//! From shots of a chart to a profile, and a new shot against it.

use colour::Spectrum;
use colour::illuminant::Illuminant;

use super::*;

const SIZE: Size = Size { width: 488, height: 328 };
/// Corners of the chart in the frame; four pixels are left out on each side of the developed picture.
const CORNERS: [[f64; 2]; 4] = [[60.0, 50.0], [420.0, 66.0], [410.0, 290.0], [70.0, 276.0]];

fn corners() -> String {
    CORNERS.iter().flatten().map(|v| (v - 4.0).to_string()).collect::<Vec<_>>().join(",")
}

/// A shot of the chart by the simulated camera.
fn shot(exposure: &Exposure) -> Vec<u8> {
    let scene = Scene::chart(SIZE, CORNERS, &simulate::chart::reflectances(), 6, 0.15);
    dng::write(&expose(&scene, &Camera::simulated_one(), exposure), dng::Storage::Uncompressed)
}

fn light(name: &str) -> Spectrum {
    Illuminant::by_name(name).unwrap().spectrum()
}

fn daylight() -> Exposure {
    Exposure { light: light("D50"), noise: Some(7), ..Exposure::default() }
}

/// A desk with `chart.dng`.
fn desk(exposure: &Exposure) -> Desk {
    let desk = Desk::new();
    desk.put("chart.dng", shot(exposure));
    desk
}

fn profile(desk: &Desk, arguments: &[&str]) -> Run {
    let corners = corners();
    desk.run(&[&["profile", "chart.dng", "--light", "D50", "--corners", &corners], arguments].concat())
}

/// The JSON line of a run.
fn figures(run: &Run) -> serde_json::Value {
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_str(run.out.lines().next().unwrap()).unwrap()
}

fn mean(figures: &serde_json::Value, model: &str) -> f64 {
    let all = figures["models"].as_array().unwrap();
    all.iter().find(|m| m["model"] == model).unwrap()["leave_one_out"]["mean"].as_f64().unwrap()
}

#[test]
fn one_shot_makes_a_profile_that_beats_the_matrix() {
    let desk = desk(&daylight());
    let run = profile(&desk, &["-o", "p.toml", "--report", "report.html", "--json"]);
    let found = figures(&run);
    let chosen = found["model"].as_str().unwrap().to_owned();
    assert!(mean(&found, &chosen) < 0.8 * mean(&found, "linear"), "{found}");
    assert!(run.err.contains("profile for Darkroot Simulated One"), "{}", run.err);
    assert!(run.err.contains("-> ") && run.err.contains("polynomial-2"), "{}", run.err);

    let report = String::from_utf8(desk.read("report.html")).unwrap();
    for part in ["<svg", "data:image/jpeg;base64,", "left out", "dark skin", "Where it comes from"] {
        assert!(report.contains(part), "{part}");
    }
    assert!(!report.contains("http"), "the report needs the network");

    // It serves the camera, and passes the lint.
    assert_eq!(desk.run(&["profile", "lint", "p.toml"]).code, 0);
    let developed = desk.develop(&["chart.dng", "--profile", "p.toml"]);
    assert!(developed.err.contains("profile for Darkroot Simulated One (D50)"), "{}", developed.err);
}

#[test]
fn a_profile_from_a_shot_is_nearly_one_from_true_values() {
    let desk = desk(&Exposure { glare: 0.0, ..daylight() });
    let run = profile(&desk, &["-o", "p.toml", "--model", "anchored", "--json"]);
    let patches = figures(&run)["patches"].as_array().unwrap().clone();
    // What the camera makes of each patch without noise, balanced by the true white.
    let (camera, light) = (Camera::simulated_one(), light("D50"));
    let white = camera.response(&Spectrum::constant(1.0), &light);
    for (patch, reflectance) in patches.iter().zip(simulate::chart::reflectances()) {
        let truth = camera.response(&reflectance, &light);
        for c in 0..3 {
            let found = patch["rgb"][c].as_f64().unwrap();
            let expected = truth[c] / white[c];
            assert!((found / expected - 1.0).abs() < 0.02, "{}: {found} {expected}", patch["name"]);
        }
    }
}

/// Corners of a chart in pixels of the developed picture, from `darkroot chart --json`.
fn found(desk: &Desk, file: &str) -> Vec<serde_json::Value> {
    let run = desk.run(&["chart", file, "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let line: serde_json::Value = serde_json::from_str(run.out.trim()).unwrap();
    line["charts"].as_array().unwrap().clone()
}

#[test]
fn a_chart_is_found_whichever_way_it_is_held() {
    let [a, b, c, d] = CORNERS;
    for (turned, corners) in [[a, b, c, d], [c, d, a, b]].into_iter().enumerate() {
        let scene = Scene::chart(SIZE, corners, &simulate::chart::reflectances(), 6, 0.15);
        let desk = Desk::new();
        let capture = expose(&scene, &Camera::simulated_one(), &daylight());
        desk.put("chart.dng", dng::write(&capture, dng::Storage::Uncompressed));
        let charts = found(&desk, "chart.dng");
        assert_eq!(charts.len(), 1, "{turned}");
        for (found, expected) in charts[0]["corners"].as_array().unwrap().iter().zip(corners) {
            for (f, e) in found.as_array().unwrap().iter().zip(expected) {
                assert!((f.as_f64().unwrap() - (e - 4.0)).abs() < 1.0, "{turned}: {charts:?}");
            }
        }
        // The profile needs no help either, and the developed picture can be searched as well.
        assert_eq!(desk.run(&["profile", "chart.dng", "--light", "D50", "-o", "p.toml"]).code, 0);
        desk.develop(&["chart.dng", "-o", "chart.jpg"]);
        assert_eq!(found(&desk, "chart.jpg").len(), 1);
        assert_eq!(desk.run(&["chart", "chart.dng", "--preview", "shown.png"]).code, 0);
        assert!(desk.read("shown.png").starts_with(b"\x89PNG"));
    }
}

#[test]
fn no_chart_is_invented_and_a_mirrored_one_is_refused() {
    let desk = Desk::new();
    let plain = expose(&Scene::gradient(SIZE), &Camera::simulated_one(), &daylight());
    desk.put("plain.dng", dng::write(&plain, dng::Storage::Uncompressed));
    let [a, b, c, d] = CORNERS;
    let mirrored = Scene::chart(SIZE, [b, a, d, c], &simulate::chart::reflectances(), 6, 0.15);
    let mirrored = expose(&mirrored, &Camera::simulated_one(), &daylight());
    desk.put("mirrored.dng", dng::write(&mirrored, dng::Storage::Uncompressed));
    let run = desk.run(&["chart", "plain.dng", "mirrored.dng"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let lines: Vec<&str> = run.out.lines().collect();
    assert!(lines[0].contains("no chart") && lines[1].contains("no chart"), "{lines:?}");
    assert!(lines[1].contains("mirrored"), "{lines:?}");
    let run = desk.run(&["profile", "plain.dng", "--light", "D50", "-o", "p.toml"]);
    assert!(run.code == 1 && run.err.contains("--corners"), "{}", run.err);
}

#[test]
fn two_lights_make_one_profile_and_shots_under_one_are_averaged() {
    let desk = desk(&daylight());
    desk.put("b.dng", shot(&Exposure { noise: Some(8), stops: -1.0, ..daylight() }));
    desk.put("a.dng", shot(&Exposure { light: light("A"), ..daylight() }));
    let corners = corners();
    let run = desk.run(&[
        "profile",
        "chart.dng",
        "b.dng",
        "a.dng",
        "--light",
        "D50",
        "--light",
        "D50",
        "--light",
        "A",
        "--corners",
        &corners,
        "-o",
        "p.toml",
        "--json",
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let lines: Vec<serde_json::Value> = run.out.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert_eq!((lines[0]["light"].as_str(), lines[1]["light"].as_str()), (Some("D50"), Some("A")));
    assert_eq!(lines[0]["shots"].as_array().unwrap().len(), 2);
    // A stop apart: the simulated sensor is linear.
    assert!(lines[0]["nonlinearity"].as_f64().unwrap() < 0.02, "{}", lines[0]["nonlinearity"]);
    let shown = desk.run(&["profile", "show", "p.toml"]).out;
    assert!(shown.contains("D50: xy") && shown.contains("A: xy"), "{shown}");
}

#[test]
fn uneven_light_is_taken_out_by_a_flat() {
    let exposure = Exposure { falloff: 0.5, ..daylight() };
    let desk = desk(&exposure);
    let flat = expose(&Scene::flat(SIZE, Spectrum::constant(0.5)), &Camera::simulated_one(), &exposure);
    desk.put("flat.dng", dng::write(&flat, dng::Storage::Uncompressed));
    let plain = figures(&profile(&desk, &["--accept", "-o", "a.toml", "--json"]));
    let even = figures(&profile(&desk, &["--flat", "flat.dng", "-o", "b.toml", "--json"]));
    assert!(
        mean(&even, "linear") < 0.7 * mean(&plain, "linear"),
        "{} {}",
        mean(&even, "linear"),
        mean(&plain, "linear")
    );
}

#[test]
fn glare_is_measured_and_taken_out_when_asked() {
    let desk = desk(&Exposure { glare: 0.02, noise: None, ..daylight() });
    let plain = profile(&desk, &["-o", "a.toml", "--json"]);
    let veil = figures(&plain)["shots"][0]["glare"].as_f64().unwrap();
    // Two percent of the scene's mean, which is about a fifth of white.
    assert!((0.002..0.01).contains(&veil), "{veil}");
    let clean = figures(&profile(&desk, &["--correct-glare", "-o", "b.toml", "--json"]));
    assert!(mean(&clean, "linear") < mean(&figures(&plain), "linear"));
}

#[test]
fn shots_that_are_not_good_enough_are_refused_with_advice() {
    for (exposure, words) in [
        (Exposure { stops: 2.0, ..daylight() }, ["one stop less light", "--accept"]),
        (Exposure { stops: -6.0, ..daylight() }, ["more light", "--accept"]),
    ] {
        let desk = desk(&exposure);
        let run = profile(&desk, &["-o", "p.toml"]);
        assert_eq!(run.code, 1, "{}", run.err);
        for word in words {
            assert!(run.err.contains(word), "{word}: {}", run.err);
        }
        assert!(!desk.names().contains(&"p.toml".to_owned()));
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let desk = desk(&daylight());
    desk.put("lab.csv", "name,L,a,b\nA1,50,0,0\n");
    desk.put("xyz.csv", "name,X,Y,Z\ndark skin,37,14,-15\n");
    desk.put("grey.csv", {
        let rows: String = (1..=24).map(|i| format!("{i},50,0,0\n")).collect();
        format!("name,L,a,b\n{rows}")
    });
    desk.put("other.dng", small_dng());
    desk.put("picture.jpg", b"\xff\xd8\xff\xe0 no raw file");
    let corners = corners();
    let own: &[&str] = &["profile", "chart.dng", "--light", "D50", "--corners", &corners, "-o", "p.toml"];
    let with = |more: &[&'static str]| [own, more].concat();
    for (arguments, code, words) in [
        (with(&["--reference", "lab.csv"]), 1, vec!["no patch", "another chart"]),
        (with(&["--reference", "xyz.csv"]), 2, vec!["xyz.csv", "are these columns Lab?"]),
        (with(&["--reference", "grey.csv"]), 1, vec!["not those of ColorChecker Classic"]),
        (with(&["--reference", "none.csv"]), 2, vec!["none.csv"]),
        (with(&["--flat", "other.dng"]), 1, vec!["other.dng", "pixels"]),
        (with(&["--exclude", "moon"]), 1, vec!["no patch `moon`"]),
        (with(&["--chart", "dartboard"]), 2, vec!["dartboard", "classic24"]),
        (with(&["--light", "A"]), 2, vec!["1 shots and 2 lights"]),
        (with(&["--model", "polynomial-3"]), 2, vec!["--force"]),
        (vec!["profile", "chart.dng", "-o", "p.toml"], 2, vec!["--light"]),
        (vec!["profile"], 2, vec!["shot of a chart"]),
        (
            vec!["profile", "picture.jpg", "--light", "D50", "--corners", &corners, "-o", "p.toml"],
            1,
            vec!["picture.jpg", "rendered", "--allow-rendered"],
        ),
        (
            vec![
                "profile",
                "chart.dng",
                "--light",
                "D50",
                "--corners",
                "0,0,900,0,900,300,0,300",
                "-o",
                "p.toml",
            ],
            1,
            vec!["outside of the picture", "take it whole"],
        ),
    ] {
        let run = desk.run(&arguments);
        assert_eq!(run.code, code, "{arguments:?}: {}", run.err);
        for word in words {
            assert!(run.err.contains(word), "{arguments:?} says nothing of `{word}`: {}", run.err);
        }
    }
    assert!(!desk.names().contains(&"p.toml".to_owned()));
}

#[test]
fn a_rendered_picture_is_taken_only_when_asked_and_loudly() {
    let desk = desk(&daylight());
    desk.develop(&["chart.dng", "-o", "chart.png"]);
    let corners = corners();
    let own: &[&str] = &["profile", "chart.png", "--light", "D50", "--corners", &corners, "-o", "p.toml"];
    assert_eq!(desk.run(own).code, 1);
    let run = desk.run(&[own, &["--allow-rendered", "--accept"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("WARNING"), "{}", run.err);
    // It does not pass for a profile of the camera.
    desk.fails(1, &["develop", "chart.dng", "--profile", "p.toml", "-o", "x.png"], &["rendered picture"]);
}

#[test]
fn a_new_shot_is_judged_by_the_profile_and_logged() {
    let desk = desk(&daylight());
    assert_eq!(profile(&desk, &["-o", "p.toml"]).code, 0);
    desk.put("later.dng", shot(&Exposure { noise: Some(9), stops: -0.5, ..daylight() }));
    let corners = corners();
    let verify = |more: &[&str]| {
        let own: &[&str] = &["verify", "p.toml", "later.dng", "--light", "D50", "--corners", &corners];
        desk.run(&[own, more].concat())
    };
    let good =
        verify(&["--max-mean", "2", "--preset", "fadgi-4star", "--log", "log.csv", "--date", "2026-05-01"]);
    assert_eq!(good.code, 0, "{}", good.err);
    assert!(good.err.contains("the profile promises mean") && good.err.contains("worst:"), "{}", good.err);
    let bad = verify(&["--max-mean", "0.01", "--log", "log.csv"]);
    assert_eq!(bad.code, 3, "{}", bad.err);
    assert!(bad.err.contains("more than 0.01"), "{}", bad.err);
    let log = String::from_utf8(desk.read("log.csv")).unwrap();
    assert_eq!(log.lines().count(), 3);
    assert!(log.lines().nth(1).unwrap().ends_with("pass") && log.lines().nth(2).unwrap().ends_with("fail"));
    assert_eq!(desk.run(&["verify", "--history", "log.csv", "-o", "history.html"]).code, 0);
    let page = String::from_utf8(desk.read("history.html")).unwrap();
    assert!(page.contains("2 shots, 1 failed") && page.contains("<svg"));
    desk.fails(2, &["verify", "p.toml", "later.dng", "--preset", "vogue"], &["vogue", "metamorfoze-full"]);
}
