//! A new shot against a profile.

use super::*;

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
    let line = |number: usize| log.lines().nth(number).unwrap();
    assert!(line(1).starts_with("2026-05-01,later.dng,"), "{log}");
    assert!(line(1).ends_with("pass,p.toml,fadgi-4star,\"mean 2; mean 2, 90 % below 4\""), "{log}");
    // Without a date it is the camera's; a shot that nobody set limits for is not said to have kept them.
    assert!(line(2).starts_with("2026-01-01,") && line(2).ends_with("fail,p.toml,,mean 0.01"), "{log}");
    assert_eq!(verify(&["--log", "free.csv"]).code, 0);
    let free = String::from_utf8(desk.read("free.csv")).unwrap();
    assert!(free.trim_end().ends_with(",unjudged,p.toml,,"), "{free}");
    assert_eq!(desk.run(&["verify", "--history", "log.csv", "-o", "history.html"]).code, 0);
    let page = String::from_utf8(desk.read("history.html")).unwrap();
    assert!(page.contains("2 shots, 1 failed") && page.contains("<svg"));
    desk.fails(2, &["verify", "p.toml", "later.dng", "--preset", "vogue"], &["vogue", "metamorfoze-full"]);
}

#[test]
fn the_light_of_a_shot_is_measured_not_believed() {
    let desk = desk(&daylight());
    let corners = corners();
    assert_eq!(profile(&desk, &["-o", "p.toml"]).code, 0);
    let d65 = Exposure { light: light("D65"), noise: Some(9), ..Exposure::default() };
    desk.put("d65.dng", shot(&d65));
    let verify =
        |more: &[&str]| desk.run(&[&["verify", "p.toml", "d65.dng", "--corners", &corners], more].concat());
    let wrong = verify(&["--light", "A"]);
    assert_eq!(wrong.code, 1, "{}", wrong.err);
    for word in ["d65.dng", "mired from A", "--light 6", "--accept"] {
        assert!(wrong.err.contains(word), "no `{word}` in {}", wrong.err);
    }
    assert_eq!(verify(&["--light", "A", "--accept"]).code, 0);
    assert_eq!(verify(&["--light", "D65"]).code, 0);
    let free = verify(&["--log", "log.csv"]);
    assert!(free.code == 0 && free.err.contains("as the shot's white shows"), "{}", free.err);
    let log = String::from_utf8(desk.read("log.csv")).unwrap();
    let kelvin = log.lines().nth(1).unwrap().split(',').nth(3).unwrap().strip_suffix(" K").unwrap();
    let kelvin: f64 = kelvin.parse().unwrap();
    assert!((1e6 / kelvin - 1e6 / 6504.0).abs() < 25.0, "{kelvin}");
}

#[test]
fn two_lights_behind_one_option_are_two_lights() {
    let desk = desk(&daylight());
    desk.put("lamp.dng", shot(&Exposure { light: light("A"), noise: Some(9), ..Exposure::default() }));
    let corners = corners();
    let own = ["profile", "chart.dng", "lamp.dng", "--corners", &corners];
    for (lights, name) in
        [(&["--light", "D50", "A"][..], "a.toml"), (&["--light", "D50", "--light", "A"], "b.toml")]
    {
        let run = desk.run(&[&own, lights, &["-o", name]].concat());
        assert_eq!(run.code, 0, "{}", run.err);
    }
    assert_eq!(desk.read("a.toml"), desk.read("b.toml"));
    let shown = desk.run(&["profile", "show", "a.toml"]).out;
    assert!(shown.contains("D50: xy") && shown.contains("A: xy"), "{shown}");
}
