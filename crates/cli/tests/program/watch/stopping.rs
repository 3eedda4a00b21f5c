//! How it ends.

use super::*;

#[test]
fn told_to_stop_it_finishes_what_it_has_begun() {
    for signal in ["TERM", "INT"] {
        let desk = desk();
        desk.put("in/a.dng", std::fs::read(sample("still-life.dng")).unwrap());
        let mut watching = Watching::start(&desk, &["in", "--format", "avif"]);
        watching.until("begun", "a.dng");
        watching.signal(&[signal]);
        let ended = watching.wait();
        assert_eq!((ended.code, count(&ended.events, "done", "a.dng")), (0, 1), "{}", ended.err);
        assert_eq!(ended.events.last().unwrap()["event"], "end");
        assert!(desk.read("out/a.avif")[4..].starts_with(b"ftypavif"));
        assert_tidy(&desk, &["a.avif"]);
    }
}

#[test]
fn told_twice_it_leaves_no_half_picture_and_the_next_one_makes_it() {
    let desk = desk();
    desk.put("in/a.dng", std::fs::read(sample("still-life.dng")).unwrap());
    let mut watching = Watching::start(&desk, &["in", "--format", "avif"]);
    watching.until("begun", "a.dng");
    watching.signal(&["TERM", "INT"]);
    let ended = watching.wait();
    if count(&ended.events, "done", "") > 0 {
        eprintln!("skipped: it was finished first");
        return;
    }
    assert_eq!(ended.code, 130, "{}", ended.err);
    assert_tidy(&desk, &[]);
    let watching = Watching::start(&desk, &["in", "--format", "avif"]);
    watching.until("done", "a.dng");
    assert_eq!(watching.end().code, 0);
    assert_tidy(&desk, &["a.avif"]);
}

#[test]
fn what_is_wrong_from_the_beginning_ends_it_at_once() {
    let desk = desk();
    desk.put("in/a.dng", small_dng());
    let watch = |more: &[&str], words: &[&str]| {
        desk.fails(2, &[&["watch", "-o", "out"], more].concat(), words);
    };
    watch(&["in/a.dng"], &["in/a.dng", "no folder", "--include"]);
    watch(&["in", "--name", "{what}.{ext}"], &["{what}"]);
    watch(&["in", "--bits", "16"], &["only 8"]);
    watch(&["in", "--include", "[a"], &["[a"]);
    watch(&["in", "--recipe", "none.toml"], &["none.toml"]);
    watch(&["in", "--settle", "0s"], &["--settle"]);
    assert!(!desk.path("out/a.jpg").exists());
}
