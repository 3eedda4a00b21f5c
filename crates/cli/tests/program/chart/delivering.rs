//! From a chart's shot to a delivered picture, and that picture judged.

use super::*;

/// A desk with a shot of the chart, its profile, and what `develop` is told for a reproduction.
fn laboratory(exposure: &Exposure, light: &str) -> Desk {
    let desk = desk(exposure);
    let corners = corners();
    let made = desk.run(&[
        "profile",
        "chart.dng",
        "--light",
        light,
        "--corners",
        &corners,
        "--accept",
        "-o",
        "p.toml",
    ]);
    assert_eq!(made.code, 0, "{}", made.err);
    desk
}

const REPRODUCTION: [&str; 9] = [
    "--look",
    "reproduction",
    "--profile",
    "p.toml",
    "--white-balance",
    "chart",
    "--exposure-from-chart",
    "auto",
    "--overwrite",
];

fn reproduced(desk: &Desk, output: &str, more: &[&str]) -> Run {
    desk.develop(&[&["chart.dng", "-o", output][..], &REPRODUCTION, more].concat())
}

/// Mean and largest dE2000 that the log of one picture has.
fn logged(desk: &Desk, picture: &str, more: &[&str]) -> [f64; 2] {
    let log = format!("{picture}.csv");
    let run = desk.run(&[&["verify", picture, "--log", &log][..], more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    // Its XMP says so, in every format.
    assert!(run.err.contains("(as the picture says)"), "{}", run.err);
    let text = String::from_utf8(desk.read(&log)).unwrap();
    let cells: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    [4, 7].map(|i| cells[i].parse().unwrap())
}

/// Errors of L* that a run of `verify` tells of the greys.
fn greys(run: &Run) -> Vec<f64> {
    let line = run.err.lines().find(|line| line.contains("greys, L* (error)")).unwrap();
    let errors = line.split('(').skip(2).map(|rest| rest.split(')').next().unwrap().parse().unwrap());
    errors.collect()
}

#[test]
fn a_reproduction_is_as_good_as_the_profile_in_every_space_and_number_of_bits() {
    let desk = laboratory(&daylight(), "D50");
    let promised = desk.run(&["verify", "p.toml", "chart.dng", "--light", "D50", "--log", "raw.csv"]);
    assert_eq!(promised.code, 0, "{}", promised.err);
    let text = String::from_utf8(desk.read("raw.csv")).unwrap();
    let own: f64 = text.lines().nth(1).unwrap().split(',').nth(4).unwrap().parse().unwrap();
    for (space, output, within, more) in [
        ("ecirgb-v2", "eci.tif", 0.1, &["--compression", "none", "--dpi", "chart:3.81"][..]),
        ("prophoto", "prophoto.tif", 0.1, &["--bits", "8"]),
        ("adobe-rgb", "adobe.tif", 0.1, &["--bits", "8", "--gamut", "map"]),
        ("display-p3", "p3.jpg", 0.1, &["--quality", "100"]),
        // The chart's cyan lies outside of sRGB.
        ("srgb", "srgb.png", 0.2, &["--bits", "16"]),
    ] {
        let made = reproduced(&desk, output, &[&["--space", space], more].concat());
        let clipped = made.err.contains("they were clipped");
        assert!(clipped || space != "srgb", "{}", made.err);
        assert!(!clipped || space != "adobe-rgb", "mapped: {}", made.err);
        let [mean, _] = logged(&desk, output, &[]);
        assert!((mean - own).abs() < within, "{space}: {mean}, the profile {own}");
    }
    let run = desk.run(&[
        "verify",
        "eci.tif",
        "--preset",
        "fadgi-4star",
        "--report",
        "r.html",
        "--chart-pitch",
        "3.81",
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    // Patches that are 61 pixels and 3.81 mm from each other have about 400 an inch.
    let scale = run.err.split("scale: ").nth(1).unwrap().split(' ').next().unwrap();
    let scale: f64 = scale.parse().unwrap();
    let [[x0, y0], [x1, y1], ..] = CORNERS;
    let truth = ((x1 - x0).hypot(y1 - y0) / (6.0 + 5.0 * 0.15) * 1.15) / (3.81 / 25.4);
    assert!((scale / truth - 1.0).abs() < 0.03, "{scale} {truth}");
    let greys = greys(&run);
    assert!(greys.len() == 6 && greys.iter().all(|error| error.abs() < 0.5), "{greys:?}");
    for words in [
        "eciRGB v2, 16 bits",
        "D50 (as the picture says)",
        "PASS tone response",
        "secondary:",
        "4 stars",
        "stated 398",
    ] {
        assert!(run.err.contains(words), "no `{words}` in {}", run.err);
    }
    let page = String::from_utf8(desk.read("r.html")).unwrap();
    for words in ["<b>PASS</b>", "ISO 19264-1:2021", "neutral 6.5", "data:image/jpeg;base64,"] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn noise_that_is_seen_range_and_bands_are_told_in_words_as_json_and_on_the_page() {
    let desk = laboratory(&daylight(), "D50");
    reproduced(&desk, "chart.tif", &["--space", "ecirgb-v2"]);
    let even = Exposure { noise: Some(4), ..daylight() };
    let flat = expose(&Scene::flat(SIZE, Spectrum::constant(0.5)), &Camera::simulated_one(), &even);
    desk.put("flat.dng", dng::write(&flat, dng::Storage::Uncompressed));
    desk.develop(&["flat.dng", "-o", "flat.tif", "--look", "reproduction", "--profile", "p.toml"]);
    let asked = ["verify", "chart.tif", "--flat", "flat.tif"];
    let run = desk.run(&[&asked[..], &["--report", "r.html", "--json"]].concat());
    for words in [
        "visual noise (ISO 15739:2013, 41 pixels a degree)",
        "dynamic range: ",
        "banding, L* over lines: rows none above",
    ] {
        assert!(run.err.contains(words), "no `{words}` in {}", run.err);
    }
    let told = figures(&run);
    let seen = |told: &serde_json::Value| {
        let greys = told["greys"].as_array().unwrap().clone();
        greys.iter().map(|grey| grey["visual_noise"]["weighted"].as_f64().unwrap()).fold(0.0, f64::max)
    };
    let range = &told["dynamic_range"];
    let [stops, least, shown] = ["stops", "least", "shown"].map(|name| range[name].as_f64().unwrap());
    // The camera has 13.5 stops in a pixel, and interpolation averages some of its noise away.
    assert!(least <= stops && stops < 17.0 && shown < 6.0 && least > shown, "{range}");
    let metrics = told["metrics"].as_array().unwrap();
    let of = |name: &str| metrics.iter().find(|m| m["metric"].as_str().unwrap().starts_with(name)).unwrap();
    assert!((of("visual noise")["found"][1].as_f64().unwrap() - seen(&told)).abs() < 1e-9);
    assert_eq!(of("banding")["found"], serde_json::json!([0.0, 0.0]));
    // From farther away less of it is seen.
    let far = desk.run(&[&asked[..], &["-q", "--json", "--pixels-per-degree", "160"]].concat());
    let far = figures(&far);
    assert!(seen(&far) < 0.6 * seen(&told), "{} {}", seen(&far), seen(&told));
    let page = String::from_utf8(desk.read("r.html")).unwrap();
    for words in [
        "Measured without a limit",
        "ISO 15739:2013, annex B",
        "dynamic range, stops that can be relied on",
        "banding of rows",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let explained = desk.run(&["verify", "--explain"]);
    assert!(explained.out.contains("measured without a limit") && explained.out.contains("visual noise"));
    desk.fails(2, &["verify", "chart.tif", "--pixels-per-degree", "1"], &["pixels"]);
    desk.fails(2, &["verify", "p.toml", "chart.dng", "--json"], &["--json"]);
}

#[test]
fn what_does_not_keep_its_limits_fails_and_says_by_how_much() {
    let desk = laboratory(&daylight(), "D50");
    desk.develop(&["chart.dng", "-o", "neutral.tif", "--profile", "p.toml", "--space", "ecirgb-v2"]);
    let run = desk.run(&["verify", "neutral.tif", "--preset", "iso19264-c", "--report", "r.html"]);
    assert_eq!(run.code, 3, "{}", run.err);
    for words in ["FAIL tone response", "limit at most 4", "neutral.tif: FAIL (ISO 19264-1:2021, C)"] {
        assert!(run.err.contains(words), "no `{words}` in {}", run.err);
    }
    assert!(String::from_utf8(desk.read("r.html")).unwrap().contains("<b>FAIL</b>"));
    // A day's work: one table, and the exit code of the worst.
    desk.put("day/note.txt", "no picture");
    reproduced(&desk, "day/a.tif", &["--space", "ecirgb-v2"]);
    desk.put("day/b.tif", desk.read("neutral.tif"));
    let run = desk.run(&["verify", "day", "--preset", "iso19264-a", "--report", "day.html"]);
    assert_eq!(run.code, 3, "{}", run.err);
    let page = String::from_utf8(desk.read("day.html")).unwrap();
    assert!(page.contains("2 pictures, 1 failed") && page.contains("<polyline"), "{page}");
    desk.fails(2, &["verify", "neutral.tif", "chart.dng"], &["chart.dng", "no finished picture"]);
    desk.fails(2, &["verify", "chart.dng"], &["profile"]);
}

#[test]
fn a_wrong_light_is_refused_or_the_reference_is_adapted() {
    let lamp = Exposure { light: light("A"), ..daylight() };
    let desk = laboratory(&lamp, "A");
    reproduced(&desk, "a.tif", &["--space", "prophoto"]);
    let told = desk.run(&["verify", "a.tif"]);
    assert!(told.code == 0 && told.err.contains("judged under A (as the picture says)"), "{}", told.err);
    desk.fails(1, &["verify", "a.tif", "--light", "D65"], &["a.tif", "under A, not under D65", "--accept"]);
    // Balanced for daylight, the greys of the lamp are orange.
    desk.develop(&["chart.dng", "-o", "orange.tif", "--white-balance", "daylight", "--look", "reproduction"]);
    desk.fails(1, &["verify", "orange.tif"], &["orange.tif", "balanced for another light"]);
    assert_eq!(desk.run(&["verify", "orange.tif", "--accept"]).code, 0);
}

#[test]
fn stray_light_and_black_are_taken_off_as_the_chart_shows_them() {
    // A profile of a clean shot, and a shot with a veil.
    let desk = laboratory(&daylight(), "D50");
    desk.put("chart.dng", shot(&Exposure { glare: 0.04, ..daylight() }));
    let plain = reproduced(&desk, "veiled.tif", &["--space", "prophoto"]);
    let clear = reproduced(&desk, "clear.tif", &["--space", "prophoto", "--black-from-chart"]);
    assert!(!plain.err.contains("stray light"), "{}", plain.err);
    assert!(clear.err.contains("stray light was taken off"), "{}", clear.err);
    let worst =
        |file: &str| greys(&desk.run(&["verify", file])).iter().map(|error| error.abs()).fold(0.0, f64::max);
    let (veiled, clear) = (worst("veiled.tif"), worst("clear.tif"));
    assert!(clear < 0.5 && veiled > 2.0 * clear, "{veiled} {clear}");
}

#[test]
fn another_shot_gives_the_exposure_and_says_so_where_it_does_not_hold() {
    let desk = laboratory(&daylight(), "D50");
    desk.put("object.dng", shot(&Exposure { noise: Some(11), ..daylight() }));
    let of_shot = ["--look", "reproduction", "--profile", "p.toml", "--exposure-from-chart", "chart.dng"];
    let run =
        desk.develop(&[&["object.dng", "-o", "o.tif", "--white-balance", "chart"][..], &of_shot].concat());
    assert!(run.err.contains("white in chart.dng") && run.err.contains("L* 95.19"), "{}", run.err);
    let file = desk.read("o.tif");
    let find = |words: &str| file.windows(words.len()).any(|w| w == words.as_bytes());
    for words in [
        "<darkroot:ProfileSha256>",
        "<darkroot:ChartShot>chart.dng<",
        "<darkroot:ChartShotSha256>",
        "<darkroot:Light>D50<",
        "look=reproduction",
        "<xmp:CreatorTool>Darkroot ",
    ] {
        assert!(find(words), "no `{words}` in the XMP");
    }
    desk.fails(
        2,
        &["develop", "object.dng", "--white-balance", "chart"],
        &["white-balance", "exposure-from-chart"],
    );
    desk.fails(1, &["develop", "object.dng", "--exposure-from-chart", "none.dng"], &["none.dng"]);
    desk.put(
        "plain.dng",
        dng::write(
            &expose(&Scene::gradient(SIZE), &Camera::simulated_one(), &daylight()),
            dng::Storage::Uncompressed,
        ),
    );
    desk.fails(
        1,
        &["develop", "plain.dng", "--exposure-from-chart", "auto"],
        &["plain.dng", "no chart was found"],
    );
}

#[test]
fn pictures_and_profiles_that_are_broken_are_errors_in_a_sentence() {
    let desk = laboratory(&daylight(), "D50");
    reproduced(&desk, "good.tif", &["--space", "ecirgb-v2", "--compression", "none"]);
    let good = desk.read("good.tif");
    desk.put("cut.tif", &good[..good.len() / 2]);
    desk.fails(1, &["verify", "cut.tif"], &["cut.tif", "cannot be read as a picture"]);
    let profile = good.windows(4).position(|w| w == b"acsp").unwrap() - 36;
    let mut lies = good.clone();
    lies[profile + 16..profile + 20].copy_from_slice(b"CMYK");
    desk.put("cmyk.tif", &lies);
    desk.fails(1, &["verify", "cmyk.tif"], &["cmyk.tif", "not for RGB"]);
    let mut broken = good.clone();
    broken[profile + 128..profile + 160].fill(0xff);
    desk.put("broken.tif", &broken);
    desk.fails(1, &["verify", "broken.tif"], &["broken.tif", "ICC profile"]);
    let explained = desk.run(&["verify", "--explain"]);
    for words in ["--preset metamorfoze-extra-light", "tone response", "secondary:", "FADGI 2010"] {
        assert!(explained.code == 0 && explained.out.contains(words), "{words}: {}", explained.out);
    }
}
