//! Files that wait for something: a name, a place, a recipe without faults.

use super::*;

#[test]
fn names_that_collide_wait_and_say_so_once() {
    let desk = desk();
    desk.put("in/a.dng", small_dng());
    let watching = Watching::start(&desk, &["in"]);
    watching.until("done", "a.dng");
    let before = desk.read("out/a.jpg");
    desk.put("in/a.nef", small_nef());
    watching.until("held", "a.nef");
    desk.put("in/b.dng", small_dng());
    watching.until("done", "b.dng");
    let ended = watching.end();
    assert_eq!((ended.code, count(&ended.events, "held", "")), (0, 1), "{}", ended.err);
    assert!(
        ended.err.contains("a.dng, a.nef") && ended.err.contains("--on-collision suffix"),
        "{}",
        ended.err
    );
    assert!(desk.read("out/a.jpg") == before);
    // What was developed keeps its name.
    let watching = Watching::start(&desk, &["in", "--on-collision", "suffix"]);
    watching.until("done", "a.nef");
    assert_eq!(count(&watching.end().events, "done", ""), 1);
    assert!(desk.read("out/a.jpg") == before);
    assert_tidy(&desk, &["a-nef.jpg", "a.jpg", "b.jpg"]);
}

#[test]
fn a_picture_in_the_way_is_left_and_its_file_waits() {
    let desk = desk();
    desk.put("out/a.jpg", "precious");
    desk.put("in/a.dng", small_dng());
    let watching = Watching::start(&desk, &["in"]);
    watching.until("held", "a.dng");
    assert_eq!(desk.read("out/a.jpg"), b"precious");
    std::fs::remove_file(desk.path("out/a.jpg")).unwrap();
    watching.until("done", "a.dng");
    let ended = watching.end();
    assert_eq!(count(&ended.events, "held", ""), 1, "{}", ended.err);
    assert!(ended.err.contains("out/a.jpg: exists already"), "{}", ended.err);
}

#[test]
fn settings_count_as_they_are_when_a_file_comes() {
    let desk = desk();
    desk.put("in/a.dng", small_dng());
    desk.put("in/same.dng", small_dng());
    let watching = Watching::start(&desk, &["in"]);
    watching.until("done", "a.dng");
    watching.until("done", "same.dng");
    // A recipe with a fault holds up what comes, and nothing else.
    desk.put("in/darkroot.toml", "look = \"film\"");
    desk.put("in/b.dng", small_dng());
    desk.put("in/c.dng", small_dng());
    watching.until("held", "b.dng");
    desk.put("in/darkroot.toml", "look = \"vivid\"");
    watching.until("done", "b.dng");
    watching.until("done", "c.dng");
    let ended = watching.end();
    assert_eq!(count(&ended.events, "held", ""), 1, "one word for both files: {}", ended.err);
    assert!(ended.err.contains("in/darkroot.toml:1:"), "{}", ended.err);
    assert_eq!(count(&ended.events, "done", ""), 4);
    assert!(desk.read("out/a.jpg") == desk.read("out/same.jpg"));
    assert!(desk.read("out/a.jpg") != desk.read("out/b.jpg"));

    // Not even a restart makes the old ones anew; it says so.
    let watching = Watching::start(&desk, &["in"]);
    watching.until("outdated", "");
    desk.put("in/d.dng", small_dng());
    watching.until("done", "d.dng");
    let ended = watching.end();
    assert_eq!(count(&ended.events, "done", ""), 1, "{}", ended.err);
    assert!(ended.err.contains("2 pictures were made with other settings"), "{}", ended.err);
}
