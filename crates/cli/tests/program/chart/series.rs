//! Several shots: lights, brackets and means.

use super::*;

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
