//! Light, glare, exposure and focus of a shot are measured; bad ones are warned of or refused.

use super::*;

#[test]
fn uneven_light_is_taken_out_by_a_flat() {
    let exposure = Exposure { falloff: 0.5, ..daylight() };
    let desk = desk(&exposure);
    let flat = expose(&Scene::flat(SIZE, Spectrum::constant(0.5)), &Camera::simulated_one(), &exposure);
    desk.put("flat.dng", dng::write(&flat, dng::Storage::Uncompressed));
    let plain = figures(&profile(&desk, &["--accept", "--even-out=never", "-o", "a.toml", "--json"]));
    let even = figures(&profile(&desk, &["--flat", "flat.dng", "-o", "b.toml", "--json"]));
    assert!(
        mean(&even, "linear") < 0.7 * mean(&plain, "linear"),
        "{} {}",
        mean(&even, "linear"),
        mean(&plain, "linear")
    );
}

#[test]
fn glare_is_measured_and_taken_out_where_that_helps() {
    let desk = desk(&Exposure { glare: 0.02, noise: None, ..daylight() });
    let plain = profile(&desk, &["--correct-glare=never", "-o", "a.toml", "--json"]);
    let veil = figures(&plain)["shots"][0]["glare"].as_f64().unwrap();
    // Two percent of the scene's mean, which is about a fifth of white.
    assert!((0.002..0.01).contains(&veil), "{veil}");
    let asked = figures(&profile(&desk, &["--correct-glare", "-o", "b.toml", "--json"]));
    assert!(mean(&asked, "linear") < mean(&figures(&plain), "linear"));
    // Patches that had no part in finding it decide, and here they bear it out.
    let unasked = profile(&desk, &["-o", "c.toml", "--json"]);
    assert!(unasked.err.contains("glare was taken out: "), "{}", unasked.err);
    assert!(mean(&figures(&unasked), "linear") < mean(&figures(&plain), "linear"));
    let wrong = desk.run(&["profile", "chart.dng", "--light", "D50", "--correct-glare=sometimes"]);
    assert!(wrong.code == 2 && wrong.err.contains("auto, always, never"), "{}", wrong.err);
}

#[test]
fn a_slope_of_light_is_taken_out_where_that_helps() {
    let desk = desk(&Exposure { falloff: 0.5, ..daylight() });
    let run = |arguments: &[&str]| figures(&profile(&desk, &[arguments, &["--accept", "--json"]].concat()));
    let plain = run(&["--even-out=never", "-o", "a.toml"]);
    let best = run(&["-o", "b.toml"]);
    let asked = run(&["--even-out", "-o", "c.toml"]);
    let [plain, best, asked] = [plain, best, asked].map(|figures| mean(&figures, "linear"));
    assert!(best <= plain.min(asked) + 1e-9, "{plain} {best} {asked}");
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
fn a_reference_with_a_patch_darker_than_numbers_reach_is_judged_and_not_pondered_for_ever() {
    let desk = desk(&daylight());
    let mut rows = String::new();
    for (i, reflectance) in darkroot_simulate::chart::reflectances().iter().enumerate() {
        let colour = reflectance.reflected_xyz(&light("D50")).scaled(100.0);
        // So little light that a share of it is infinite.
        let y = if i == 5 { 1e-320 } else { colour.y };
        let row = char::from(b'A' + i as u8 / 6);
        rows += &format!("{row}{} {:.4} {y:e} {:.4}\n", 1 + i % 6, colour.x, colour.z);
    }
    let names = "BEGIN_DATA_FORMAT\nSAMPLE_LOC XYZ_X XYZ_Y XYZ_Z\nEND_DATA_FORMAT";
    desk.put("dark.cie", format!("CTI2\n\n{names}\n\nBEGIN_DATA\n{rows}END_DATA\n"));
    let run = profile(&desk, &["-o", "p.toml", "--reference", "dark.cie"]);
    assert!(run.code == 0 && run.err.contains("dE2000"), "{}", run.err);
}
