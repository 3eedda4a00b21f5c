//! From shots of a chart to a profile, and a new shot against it.

use darkroot_colour::Spectrum;
use darkroot_colour::illuminant::Illuminant;

use super::*;

const SIZE: Size = Size { width: 488, height: 328 };
/// Corners of the chart in the frame; four pixels are left out on each side of the developed picture.
const CORNERS: [[f64; 2]; 4] = [[60.0, 50.0], [420.0, 66.0], [410.0, 290.0], [70.0, 276.0]];

fn corners() -> String {
    CORNERS.iter().flatten().map(|v| (v - 4.0).to_string()).collect::<Vec<_>>().join(",")
}

/// A shot of the chart by the simulated camera.
fn shot(exposure: &Exposure) -> Vec<u8> {
    let scene = Scene::chart(SIZE, CORNERS, &darkroot_simulate::chart::reflectances(), 6, 0.15);
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
    for (patch, reflectance) in patches.iter().zip(darkroot_simulate::chart::reflectances()) {
        let truth = camera.response(&reflectance, &light);
        for c in 0..3 {
            let found = patch["rgb"][c].as_f64().unwrap();
            let expected = truth[c] / white[c];
            assert!((found / expected - 1.0).abs() < 0.02, "{}: {found} {expected}", patch["name"]);
        }
    }
}

/// A check by its name.
fn gate<'a>(gates: &'a serde_json::Value, name: &str) -> &'a serde_json::Value {
    gates.as_array().unwrap().iter().find(|g| g["name"] == name).unwrap_or_else(|| panic!("{name}: {gates}"))
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
        let scene = Scene::chart(SIZE, corners, &darkroot_simulate::chart::reflectances(), 6, 0.15);
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
        let centres = charts[0]["centres"].as_array().unwrap();
        assert_eq!((&charts[0]["grid"], centres.len()), (&serde_json::json!([6, 4]), 24));
        // Where the diagonals of the chart cross.
        let middle: f64 = [8, 9, 14, 15].iter().map(|i| centres[*i][0].as_f64().unwrap()).sum::<f64>() / 4.0;
        assert!((middle - (240.0 - 4.0)).abs() < 4.0, "{turned}: {middle}");
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
    let mirrored = Scene::chart(SIZE, [b, a, d, c], &darkroot_simulate::chart::reflectances(), 6, 0.15);
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
fn two_lights_make_one_profile_and_a_bracket_under_one_checks_the_sensor() {
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
    let linear = gate(&lines[0]["gates"], "linearity");
    assert!(linear["verdict"] == "good" && linear["value"].as_f64().unwrap() < 0.01, "{linear}");
    assert!(lines[1]["gates"].as_array().unwrap().iter().all(|g| g["name"] == "light"));
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
fn a_light_that_was_not_named_is_warned_of() {
    let desk = desk(&Exposure { light: light("A"), ..daylight() });
    let named = figures(&profile(&desk, &["-o", "a.toml", "--json"]));
    let found = gate(&named["gates"], "light");
    assert!(found["verdict"] == "warning" && found["value"].as_f64().unwrap() > 100.0, "{found}");
    assert!(found["words"].as_str().unwrap().contains("from D50"), "{found}");
    let corners = corners();
    let arguments = ["profile", "chart.dng", "--light", "A", "--corners", &corners, "-o", "b.toml", "--json"];
    let right = figures(&desk.run(&arguments));
    assert_eq!(gate(&right["gates"], "light")["verdict"], "good");
}

#[test]
fn a_veil_with_a_colour_is_told_by_channel() {
    let desk = desk(&Exposure { glare: 0.02, noise: None, ..daylight() });
    let run = profile(&desk, &["-o", "a.toml", "--json"]);
    let found = figures(&run)["shots"][0]["gates"].clone();
    let words = gate(&found, "glare")["words"].to_string();
    assert!(words.contains("(red)") && words.contains("(blue)"), "{words}");
    let clean = profile(&desk, &["--correct-glare", "-o", "b.toml"]);
    assert!(clean.err.contains("glare was taken out: "), "{}", clean.err);
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
fn blur_is_measured_warned_of_and_refused() {
    // Patches are about 53 x 49 pixels.
    let width = |json: &serde_json::Value| {
        let sharpness = gate(&json["shots"][0]["gates"], "sharpness");
        (sharpness["verdict"].as_str().unwrap().to_owned(), sharpness["value"].as_f64().unwrap())
    };
    for (blur, verdict) in [(0.0, "good"), (2.0, "good"), (5.0, "warning"), (9.0, "failed")] {
        let desk = desk(&Exposure { blur, ..daylight() });
        let report = ["-o", "p.toml", "--accept", "--report", "r.html", "--json"];
        let run = profile(&desk, &report);
        let (found, share) = width(&figures(&run));
        assert_eq!(found, verdict, "{blur}: {share}");
        if blur > 0.0 {
            assert!((share / (2.563 * blur / 49.0) - 1.0).abs() < 0.12, "{blur}: {share}");
        } else {
            assert!(share < 0.06, "{share}");
        }
        assert_eq!(verdict != "good", run.err.contains("focus on the chart"), "{}", run.err);
        let page = String::from_utf8(desk.read("r.html")).unwrap();
        assert!(page.contains("edges are") && page.contains("of a patch"));
        // Without `--accept`.
        let plain = profile(&desk, &["-o", "q.toml"]);
        assert_eq!(plain.code, i32::from(verdict == "failed"), "{}", plain.err);
        assert_eq!(verdict == "failed", plain.err.contains("add `--accept`"), "{}", plain.err);
    }
}

#[test]
fn the_report_tells_every_model_at_every_exposure() {
    let desk = desk(&daylight());
    let found = figures(&profile(&desk, &["-o", "p.toml", "--report", "r.html", "--json"]));
    let page = String::from_utf8(desk.read("r.html")).unwrap();
    let table = page.split("<h3>Exposure</h3>").nth(1).unwrap().split("</table>").next().unwrap();
    let at = |model: &str| {
        let all = found["models"].as_array().unwrap();
        let of = all.iter().find(|m| m["model"] == model).unwrap();
        let means: Vec<f64> =
            of["exposures"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        let cells: String = means.iter().map(|v| format!("<td>{v:.2}</td>")).collect();
        assert!(table.contains(&format!("<td>{model}</td>{cells}")), "{model}: {table}");
        assert!((means[3] - of["training"]["mean"].as_f64().unwrap()).abs() < 1e-9, "{model}");
        means
    };
    for model in ["linear", "root-2", "root-4", "anchored", "hue-plane", "half"] {
        let means = at(model);
        assert!(means.iter().all(|v| (v - means[3]).abs() < 1e-6), "{model}: {means:?}");
    }
    let polynomial = at("polynomial-3");
    assert!(polynomial[0] > 5.0 * polynomial[3] && polynomial[6] > 5.0 * polynomial[3], "{polynomial:?}");
}

/// A shot by a sensor that loses `loss` of the light at saturation, and half as much at half of it.
fn bent_shot(exposure: &Exposure, loss: f64) -> Vec<u8> {
    let scene = Scene::chart(SIZE, CORNERS, &darkroot_simulate::chart::reflectances(), 6, 0.15);
    let camera = Camera::simulated_one();
    let mut capture = expose(&scene, &camera, exposure);
    let darkroot_photo::Counts::U16(mosaic) = &mut capture.counts else { panic!("16 bits") };
    let black = f64::from(camera.black.at(0, 0, 0));
    for count in &mut mosaic.samples {
        let light = (f64::from(*count) - black) / (f64::from(camera.white) - black);
        *count = (f64::from(*count) * (1.0 - loss * light.max(0.0))).round() as u16;
    }
    dng::write(&capture, dng::Storage::Uncompressed)
}

#[test]
fn a_sensor_that_is_not_linear_is_told_by_a_bracket() {
    let bright = Exposure { white: 0.8, ..daylight() };
    let dark = Exposure { stops: -1.5, noise: Some(8), ..bright.clone() };
    for (loss, verdict) in [(0.0, "good"), (0.04, "warning"), (0.15, "failed")] {
        let desk = Desk::new();
        desk.put("chart.dng", bent_shot(&bright, loss));
        desk.put("dark.dng", bent_shot(&dark, loss));
        let run = profile(&desk, &["dark.dng", "-o", "p.toml", "--report", "r.html", "--accept", "--json"]);
        let found = figures(&run);
        let linearity = gate(&found["gates"], "linearity");
        assert_eq!(linearity["verdict"], verdict, "{loss}: {linearity}");
        assert_eq!(verdict != "good", run.err.contains("leave out dark.dng"), "{}", run.err);
        assert!(String::from_utf8(desk.read("r.html")).unwrap().contains("the sensor is linear to"));
        let plain = profile(&desk, &["dark.dng", "-o", "q.toml"]);
        assert_eq!(plain.code, i32::from(verdict == "failed"), "{}", plain.err);
        let says = plain.err.contains("in steady light") && plain.err.contains("add `--accept`");
        assert_eq!(verdict == "failed", says, "{}", plain.err);
        assert_eq!(verdict == "failed", !desk.names().contains(&"q.toml".to_owned()));
    }
}

#[test]
fn shots_at_one_exposure_are_averaged_only_when_asked() {
    let noisy = Exposure { stops: -3.5, ..daylight() };
    let desk = desk(&noisy);
    let mut several = vec!["-o", "p.toml", "--json", "--accept"];
    for (name, seed) in [("b.dng", 8), ("c.dng", 9), ("d.dng", 10)] {
        desk.put(name, shot(&Exposure { noise: Some(seed), ..noisy.clone() }));
        several.push(name);
    }
    let refused = profile(&desk, &several);
    assert!(refused.code == 2 && refused.out.is_empty(), "{}", refused.err);
    for word in ["chart.dng and b.dng were both taken under D50", "`--average`", "`--light`"] {
        assert!(refused.err.contains(word), "{word}: {}", refused.err);
    }
    assert!(!desk.names().contains(&"p.toml".to_owned()));

    let one = figures(&profile(&desk, &["-o", "one.toml", "--json", "--accept"]));
    several.push("--average");
    let mean = figures(&profile(&desk, &several));
    assert_eq!(mean["shots"].as_array().unwrap().len(), 4);
    assert_eq!(gate(&mean["gates"], "agreement")["verdict"], "good");
    // Four shots halve the uncertainty, and the departure from what the camera makes of the patch without noise.
    let (camera, light) = (Camera::simulated_one(), light("D50"));
    let white = camera.response(&Spectrum::constant(1.0), &light);
    let off = |found: &serde_json::Value| {
        let patches = found["patches"].as_array().unwrap();
        let all = patches.iter().zip(darkroot_simulate::chart::reflectances()).flat_map(|(patch, r)| {
            let truth = camera.response(&r, &light);
            [0, 1, 2].map(|c| (patch["rgb"][c].as_f64().unwrap() * white[c] / truth[c] - 1.0).powi(2))
        });
        all.sum::<f64>().sqrt()
    };
    let uncertain = |found: &serde_json::Value| found["patches"][0]["uncertainty"][0].as_f64().unwrap();
    let ratio = uncertain(&mean) / uncertain(&one);
    assert!((0.4..0.6).contains(&ratio), "{ratio}");
    assert!(off(&mean) < 0.8 * off(&one), "{} {}", off(&mean), off(&one));

    let alone = profile(&desk, &["--average", "-o", "x.toml"]);
    assert!(alone.code == 2 && alone.err.contains("several shots under one light"), "{}", alone.err);
}

#[test]
fn shots_that_do_not_agree_are_not_averaged() {
    let desk = desk(&daylight());
    desk.put("b.dng", shot(&Exposure { falloff: 0.2, noise: Some(8), ..daylight() }));
    let run = profile(&desk, &["b.dng", "--average", "-o", "p.toml", "--even-out"]);
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.err.contains("agree to") && run.err.contains("leave out b.dng"), "{}", run.err);
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
