//! Folders that come, go away and come again.

use super::*;

#[test]
fn folders_that_appear_later_are_watched_too() {
    let desk = desk();
    let watching = Watching::start(&desk, &["in"]);
    watching.until("watching", "");
    desk.put("in/later/deep/a.dng", small_dng());
    watching.until("done", "a.dng");
    // By now the system tells of changes in there.
    desk.put("in/later/deep/b.dng", small_dng());
    watching.until("done", "b.dng");
    assert_eq!(watching.end().code, 0);
    assert_eq!(names(&desk.path("out/later/deep")), ["a.jpg", "b.jpg"]);
}

#[test]
fn a_share_is_watched_by_looking() {
    let desk = desk();
    let watching = Watching::start(&desk, &["in", "--poll", "200ms"]);
    watching.until("watching", "");
    assert_eq!(watching.events()[0]["polling_seconds"], 0.2);
    desk.put("in/roll/a.dng", small_dng());
    watching.until("done", "a.dng");
    let ended = watching.end();
    assert!(ended.code == 0 && ended.err.contains("looking every 200ms"), "{}", ended.err);
}

#[test]
fn a_folder_that_goes_away_is_waited_for() {
    let desk = desk();
    desk.put("in/a.dng", small_dng());
    let watching = Watching::start(&desk, &["in", "--poll", "100ms"]);
    watching.until("done", "a.dng");
    std::fs::rename(desk.path("in"), desk.path("away")).unwrap();
    watching.until("away", "in");
    desk.put("away/b.dng", small_dng());
    std::fs::rename(desk.path("away"), desk.path("in")).unwrap();
    watching.until("done", "b.dng");
    let ended = watching.end();
    let numbers = ["away", "back", "done", "failed"].map(|event| count(&ended.events, event, ""));
    assert_eq!((ended.code, numbers), (0, [1, 1, 2, 0]), "{}", ended.err);
    assert_eq!(ended.err.matches("waiting for it").count(), 1, "{}", ended.err);
}

#[test]
fn one_of_two_folders_may_be_away() {
    let desk = desk();
    desk.put("in/a.dng", small_dng());
    desk.put("card/a.dng", small_dng());
    let watching = Watching::start(&desk, &["in", "card"]);
    watching.until("done", "in/a.dng");
    watching.until("done", "card/a.dng");
    assert_eq!(watching.end().code, 0);
    std::fs::rename(desk.path("card"), desk.path("away")).unwrap();
    desk.put("in/b.dng", small_dng());
    let watching = Watching::start(&desk, &["in", "card"]);
    watching.until("done", "in/b.dng");
    // A card that comes while it watches.
    desk.put("away/c.dng", small_dng());
    std::fs::rename(desk.path("away"), desk.path("card")).unwrap();
    watching.until("done", "card/c.dng");
    let ended = watching.end();
    // Nothing got another name by it.
    assert_eq!(count(&ended.events, "done", ""), 2, "{:#?}", ended.events);
    assert_tidy(&desk, &["card", "in"]);
    assert_eq!(names(&desk.path("out/card")), ["a.jpg", "c.jpg"]);
}
