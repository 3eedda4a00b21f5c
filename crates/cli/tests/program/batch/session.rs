//! One shot of a chart colours the whole session.

use darkroot_colour::illuminant::Illuminant;

use super::*;

const SIZE: Size = Size { width: 488, height: 328 };
const CORNERS: [[f64; 2]; 4] = [[60.0, 50.0], [420.0, 66.0], [410.0, 290.0], [70.0, 276.0]];

fn under(light: &str) -> Exposure {
    Exposure { light: Illuminant::by_name(light).unwrap().spectrum(), noise: Some(7), ..Exposure::default() }
}

/// A scene by the simulated camera under a light.
fn dng_of(scene: &Scene, light: &str) -> Vec<u8> {
    dng::write(&expose(scene, &Camera::simulated_one(), &under(light)), dng::Storage::Uncompressed)
}

/// Two days: the first with a chart under daylight, the second without one, and a file of another camera.
fn desk() -> Desk {
    let desk = Desk::new();
    let chart = Scene::chart(SIZE, CORNERS, &darkroot_simulate::chart::reflectances(), 6, 0.15);
    desk.put("in/day 1/chart.dng", dng_of(&chart, "D50"));
    desk.put("in/day 1/still.dng", dng_of(&Scene::gradient(SIZE), "D50"));
    desk.put("in/day 1/nikon.nef", small_nef());
    desk.put("in/day 2/still.dng", dng_of(&Scene::gradient(SIZE), "D50"));
    desk
}

#[test]
fn the_folders_chart_gives_white_balance_and_profile() {
    let desk = desk();
    let run = desk.batch(&["--chart-shot", "auto", "--json"]);
    assert_eq!((run.code, summary(&run)), (0, [4, 0, 0, 0]), "{}", run.err);
    assert!(run.err.contains("day 1: white balance and profile for Darkroot Simulated One"), "{}", run.err);
    assert!(run.err.contains("day 1/chart.dng"), "{}", run.err);
    let noted: Vec<String> = events(&run, "done")
        .iter()
        .filter(|v| v["notes"].to_string().contains("from the chart in day 1/chart.dng"))
        .map(|v| v["input"].as_str().unwrap().to_owned())
        .collect();
    let mut noted = noted;
    noted.sort();
    assert_eq!(noted, ["day 1/chart.dng", "day 1/still.dng"]);
    // The other camera and the other day are as without a chart.
    desk.develop(&["in/day 2/still.dng", "-o", "plain.jpg"]);
    assert_eq!(desk.read("plain.jpg"), desk.read("out/day 2/still.jpg"));
    assert_ne!(desk.read("out/day 1/still.jpg"), desk.read("out/day 2/still.jpg"));

    // Looked at once and calibrated once: nothing is done again.
    let journal = desk.read("out/.darkroot/journal.jsonl");
    let again = desk.batch(&["--chart-shot", "auto", "--json"]);
    assert_eq!(summary(&again), [0, 4, 0, 0], "{}", again.err);
    assert_eq!(desk.read("out/.darkroot/journal.jsonl"), journal);
    // Another light is another profile, and other pictures of its camera.
    let other = desk.batch(&["--chart-shot", "auto", "--light", "D65", "--json"]);
    assert_eq!(summary(&other), [2, 2, 0, 0], "{}", other.err);
}

#[test]
fn the_shot_that_is_named_colours_everything() {
    let desk = desk();
    let run = desk.batch(&["--chart-shot", "in/day 1/chart.dng", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(desk.read("out/day 1/still.jpg"), desk.read("out/day 2/still.jpg"));
    // It is nearly the profile that `darkroot profile` makes.
    let session = below(&desk.path("out/.darkroot/session"));
    assert_eq!(session.len(), 1);
    let path = format!("out/.darkroot/session/{}", session[0]);
    assert_eq!(desk.run(&["profile", "lint", &path]).code, 0);
    desk.fails(
        2,
        &["batch", "in", "-o", "other", "--chart-shot", "in/day 2/still.dng"],
        &["no colour chart"],
    );
}

#[test]
fn without_a_chart_it_says_so_and_goes_on() {
    let desk = Desk::with_tree();
    let run = desk.batch(&["--chart-shot", "auto"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("no colour chart was found"), "{}", run.err);
}

#[test]
fn the_light_of_a_session_is_the_one_that_its_chart_shows() {
    let desk = Desk::new();
    let chart = Scene::chart(SIZE, CORNERS, &darkroot_simulate::chart::reflectances(), 6, 0.15);
    desk.put("in/chart.dng", dng_of(&chart, "A"));
    let free = desk.batch(&["--chart-shot", "auto", "--json"]);
    assert_eq!((free.code, summary(&free)), (0, [1, 0, 0, 0]), "{}", free.err);
    let session = below(&desk.path("out/.darkroot/session"));
    let shown = desk.run(&["profile", "show", &format!("out/.darkroot/session/{}", session[0])]).out;
    let kelvin = shown.lines().find_map(|l| l.split_once(" K: xy")).unwrap().0.trim().parse::<f64>().unwrap();
    assert!((1e6 / kelvin - 1e6 / 2856.0).abs() < 40.0, "{shown}");
    // A light that was named and is another is not taken on trust.
    let wrong = desk.batch(&["--chart-shot", "auto", "--light", "D50", "--json"]);
    assert!(wrong.err.contains("mired from D50") && wrong.err.contains("colours nothing"), "{}", wrong.err);
}
