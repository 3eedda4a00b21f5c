//! The same command again does what is left, and nothing else.

use super::*;

/// The journal's text.
fn journal(desk: &Desk) -> String {
    String::from_utf8(desk.read("out/.darkroot/journal.jsonl")).unwrap()
}

/// Reasons of a dry run, by output.
fn reasons(desk: &Desk, arguments: &[&str]) -> Vec<(String, String)> {
    let run = desk.batch(&[&["--dry-run", "--json"], arguments].concat());
    let text = |v: &serde_json::Value| v.as_str().unwrap_or("-").to_owned();
    let planned = events(&run, "planned");
    planned
        .iter()
        .filter(|v| v["action"] != "unchanged")
        .map(|v| (text(&v["output"]), text(&v["why"])))
        .collect()
}

fn done_once() -> Desk {
    let desk = Desk::with_tree();
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (0, [4, 0, 0, 0]), "{}", run.err);
    desk
}

#[test]
fn what_is_done_and_unchanged_is_left_alone() {
    let desk = done_once();
    let before = (journal(&desk), std::fs::metadata(desk.path("out/a.jpg")).unwrap().modified().unwrap());
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (0, [0, 4, 0, 0]), "{}", run.err);
    let after = (journal(&desk), std::fs::metadata(desk.path("out/a.jpg")).unwrap().modified().unwrap());
    assert_eq!(before, after);
    // Another time of change with the same content is no change.
    let bytes = desk.read("in/a.dng");
    std::thread::sleep(Duration::from_millis(20));
    desk.put("in/a.dng", bytes);
    assert!(reasons(&desk, &[]).is_empty());
}

#[test]
fn changed_inputs_settings_and_profiles_are_done_again() {
    let desk = done_once();
    let mut bytes = small_dng().to_vec();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    desk.put("in/a.dng", &bytes);
    assert_eq!(reasons(&desk, &[]), [("a.jpg".into(), "input-changed".into())]);
    assert_eq!(reasons(&desk, &["--exposure", "1"]).iter().filter(|r| r.1 == "settings-changed").count(), 3);
    // A spelling is no change.
    assert_eq!(reasons(&desk, &["--exposure", "+0.0"]).len(), 1);
    assert_eq!(summary(&desk.batch(&["--json"])), [1, 3, 0, 0]);

    // A profile for one of the cameras comes to the user's folder.
    let folder = desk.data.path().join("darkroot/profiles");
    let profile = profiles::profile("Darkroot", "Simulated One");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("one.toml"), &profile).unwrap();
    let expected = [("a.jpg", "profile-changed"), ("day 2/ü.jpg", "profile-changed")];
    assert_eq!(reasons(&desk, &[]), expected.map(|(a, b)| (a.to_owned(), b.to_owned())));
    assert_eq!(summary(&desk.batch(&["--json"])), [2, 2, 0, 0]);
    std::fs::write(folder.join("one.toml"), profile.replace("by hand", "anew")).unwrap();
    assert_eq!(reasons(&desk, &[]).len(), 2);
}

#[test]
fn outputs_that_are_gone_changed_or_rotten_are_told_apart() {
    let desk = done_once();
    std::fs::remove_file(desk.path("out/a.jpg")).unwrap();
    assert_eq!(reasons(&desk, &[]), [("a.jpg".into(), "output-missing".into())]);
    assert_eq!(summary(&desk.batch(&["--json"])), [1, 3, 0, 0]);

    // Somebody works on a picture: it is not replaced when its settings change.
    desk.put("out/a.jpg", "edited");
    assert!(reasons(&desk, &[]).is_empty());
    let run = desk.batch(&["--exposure", "1", "--json"]);
    assert_eq!((run.code, summary(&run)), (1, [3, 0, 1, 0]), "{}", run.err);
    assert!(run.err.contains("a.jpg: was changed after Darkroot wrote it"), "{}", run.err);
    assert_eq!(desk.read("out/a.jpg"), b"edited");
    assert_eq!(summary(&desk.batch(&["--exposure", "1", "--json", "--overwrite"])), [1, 3, 0, 0]);

    // A bit rots: the time of change stays.
    let path = desk.path("out/day 1/b.jpg");
    let (whole, time) = (desk.read("out/day 1/b.jpg"), std::fs::metadata(&path).unwrap().modified().unwrap());
    let mut rotten = whole.clone();
    rotten[whole.len() / 2] ^= 4;
    std::fs::write(&path, &rotten).unwrap();
    std::fs::File::options().write(true).open(&path).unwrap().set_modified(time).unwrap();
    assert!(reasons(&desk, &["--exposure", "1"]).is_empty());
    let found = reasons(&desk, &["--exposure", "1", "--verify"]);
    assert_eq!(found, [("day 1/b.jpg".into(), "output-damaged".into())]);
    let run = desk.batch(&["--exposure", "1", "--verify"]);
    assert!(run.code == 0 && run.err.contains("was damaged on the disk"), "{}", run.err);
    assert_eq!(desk.read("out/day 1/b.jpg"), whole);
}

#[test]
fn failures_are_tried_again_and_everything_when_asked() {
    let desk = done_once();
    desk.put("in/bad.nef", "no raw file");
    assert_eq!(summary(&desk.batch(&["--json"])), [0, 4, 1, 0]);
    assert_eq!(reasons(&desk, &[]), [("bad.jpg".into(), "failed-before".into())]);
    desk.put("in/bad.nef", small_nef());
    assert_eq!(summary(&desk.batch(&["--json"])), [1, 4, 0, 0]);
    assert_eq!(summary(&desk.batch(&["--json", "--redo"])), [5, 0, 0, 0]);
    assert_eq!(desk.run(&["batch", "status", "out"]).code, 0);
}

#[test]
fn a_torn_journal_costs_its_last_line_at_most() {
    let desk = done_once();
    let path = desk.path("out/.darkroot/journal.jsonl");
    let whole = desk.read("out/.darkroot/journal.jsonl");
    std::fs::write(&path, &whole[..whole.len() - 40]).unwrap();
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (0, [1, 3, 0, 0]), "{}", run.err);
    assert!(run.err.contains("1 torn or damaged lines"), "{}", run.err);
    // What is no journal at all is not written to.
    std::fs::write(&path, "my notes\nof today\n").unwrap();
    desk.fails(2, &["batch", "in", "-o", "out"], &["is no journal"]);
    assert_eq!(desk.read("out/.darkroot/journal.jsonl"), b"my notes\nof today\n");
}
