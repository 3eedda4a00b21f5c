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
    assert!(log.lines().nth(1).unwrap().ends_with("pass") && log.lines().nth(2).unwrap().ends_with("fail"));
    assert_eq!(desk.run(&["verify", "--history", "log.csv", "-o", "history.html"]).code, 0);
    let page = String::from_utf8(desk.read("history.html")).unwrap();
    assert!(page.contains("2 shots, 1 failed") && page.contains("<svg"));
    desk.fails(2, &["verify", "p.toml", "later.dng", "--preset", "vogue"], &["vogue", "metamorfoze-full"]);
}
