//! What a shot makes: a profile, its figures, its report; and what is refused.

use super::*;

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
fn a_shot_can_be_kept_as_a_camera_that_knows_every_light() {
    let desk = desk(&daylight());
    let run = profile(&desk, &["-o", "p.toml", "--as-camera"]);
    assert!(run.err.contains("the camera under D50, left out"), "{}", run.err);
    let text = String::from_utf8(desk.read("p.toml")).unwrap();
    assert!(text.contains("[sensitivities]") && text.contains("the camera by 1 shot of a chart"), "{text}");
    assert_eq!(desk.run(&["profile", "lint", "p.toml"]).code, 0);
    let developed = desk.develop(&["chart.dng", "--profile", "p.toml", "--illuminant", "FL11"]);
    assert!(developed.err.contains("profile for Darkroot Simulated One"), "{}", developed.err);
    let by_chromaticity = profile(&desk, &["-o", "q.toml", "--as-camera", "--light", "0.36,0.37"]);
    assert!(by_chromaticity.code != 0, "{}", by_chromaticity.err);
}

#[test]
fn a_reference_may_name_its_patches_by_another_custom() {
    let desk = desk(&daylight());
    let d50 = light("D50");
    let table = |name: &dyn Fn(usize) -> String| {
        let row = |(i, s): (usize, Spectrum)| {
            let lab = s.reflected_xyz(&d50).lab(d50.white());
            format!("{},{:.3},{:.3},{:.3}\n", name(i), lab.l, lab.a, lab.b)
        };
        let rows = darkroot_simulate::chart::reflectances().into_iter().enumerate().map(row);
        let rows: Vec<String> = rows.collect();
        (format!("name,L,a,b\n{}", rows.concat()), rows)
    };
    let cell = |across: usize, down: usize| format!("{}{}", ["A", "B", "C", "D", "E", "F"][across], down + 1);
    // From the last to the first, so that only the names tell which is which.
    let backwards = |mut rows: Vec<String>| {
        rows.reverse();
        format!("name,L,a,b\n{}", rows.concat())
    };
    desk.put("rows.csv", backwards(table(&|i| cell(i / 6, i % 6)).1));
    desk.put("columns.csv", backwards(table(&|i| cell(i % 6, i / 6)).1));
    desk.put("mixed.csv", table(&|i| format!("x{}", i / 2)).0);
    for (file, words) in [
        ("rows.csv", "letters for rows"),
        ("columns.csv", "letters for columns"),
        ("mixed.csv", "sequence of the file"),
    ] {
        let run = profile(&desk, &["-o", "p.toml", "--overwrite", "--reference", file]);
        assert!(run.code == 0 && run.err.contains(words), "{file}: {}", run.err);
    }
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
