//! When a file is developed, and how often.

use super::*;

/// A file that is changed last an hour ago: a damaged one is not taken for one that still grows.
fn put_old(desk: &Desk, name: &str, bytes: &[u8]) {
    let path = desk.path("in/hidden.tmp");
    std::fs::write(&path, bytes).unwrap();
    let file = std::fs::OpenOptions::new().append(true).open(&path).unwrap();
    file.set_modified(SystemTime::now() - Duration::from_secs(3600)).unwrap();
    drop(file);
    std::fs::rename(path, desk.path(name)).unwrap();
}

#[test]
fn a_file_that_is_written_in_bursts_is_developed_once_and_whole() {
    use std::io::Write;
    let bytes = small_nef();
    // On a machine that stalls between bursts there is nothing to learn; then again.
    for _ in 0..10 {
        let desk = desk();
        let watching = Watching::start(&desk, &["in", "--settle", "2s"]);
        watching.until("watching", "");
        let mut file = std::fs::File::create(desk.path("in/a.NEF")).unwrap();
        let mut longest = Duration::ZERO;
        let mut last = Instant::now();
        for part in bytes.chunks(bytes.len() / 11) {
            file.write_all(part).unwrap();
            longest = longest.max(last.elapsed());
            last = Instant::now();
            std::thread::sleep(Duration::from_millis(300));
        }
        drop(file);
        if longest > Duration::from_secs(1) {
            continue;
        }
        watching.until("done", "a.NEF");
        assert!(last.elapsed() >= Duration::from_secs(2));
        let ended = watching.end();
        assert_eq!(count(&ended.events, "begun", "a.NEF"), 1, "{:#?}", ended.events);
        assert_eq!(count(&ended.events, "failed", ""), 0, "{:#?}", ended.events);
        assert_tidy(&desk, &["a.jpg"]);
        return;
    }
    eprintln!("skipped: this machine is too busy");
}

#[test]
fn a_file_is_developed_when_it_is_renamed_into_place() {
    let desk = desk();
    let watching = Watching::start(&desk, &["in"]);
    desk.put("in/x.part", small_nef());
    desk.put("in/other.dng", small_dng());
    watching.until("done", "other.dng");
    assert_eq!(count(&watching.events(), "begun", "x.part"), 0);
    std::fs::rename(desk.path("in/x.part"), desk.path("in/x.NEF")).unwrap();
    watching.until("done", "x.NEF");
    let ended = watching.end();
    assert_eq!((ended.code, count(&ended.events, "done", "")), (0, 2), "{}", ended.err);
    assert_tidy(&desk, &["other.jpg", "x.jpg"]);
}

#[test]
fn a_file_that_is_renamed_while_it_waits_is_developed_under_its_new_name() {
    let desk = desk();
    for name in ["in/a.dng", "in/b.dng", "in/c.dng", "in/d.dng"] {
        desk.put(name, std::fs::read(sample("still-life.dng")).unwrap());
    }
    desk.put("in/z.dng", small_dng());
    let arguments = ["in", "--jobs", "1", "--threads", "1", "--format", "avif", "--settle", "1s"];
    let watching = Watching::start(&desk, &arguments);
    watching.until("begun", "a.dng");
    std::fs::rename(desk.path("in/z.dng"), desk.path("in/zz.dng")).unwrap();
    watching.until("done", "zz.dng");
    let ended = watching.end();
    if count(&ended.events, "done", "z.dng") > 0 {
        eprintln!("skipped: it was developed before it was renamed");
        return;
    }
    assert_eq!(count(&ended.events, "gone", "z.dng"), 1, "{:#?}", ended.events);
    assert_eq!((ended.code, count(&ended.events, "failed", "")), (0, 0), "{}", ended.err);
    assert_tidy(&desk, &["a.avif", "b.avif", "c.avif", "d.avif", "zz.avif"]);
    let status = desk.run(&["batch", "status", "out"]);
    assert!(status.out.contains("together: 5 done, 0 failed, 0 begun"), "{}", status.out);
}

#[test]
fn a_restart_goes_on_where_it_was() {
    let desk = desk();
    desk.put("in/a.dng", small_dng());
    let watching = Watching::start(&desk, &["in"]);
    watching.until("done", "a.dng");
    assert_eq!(watching.end().code, 0);
    let before = std::fs::metadata(desk.path("out/a.jpg")).unwrap().modified().unwrap();
    desk.put("in/b.dng", small_dng());
    // It changed, so it is developed again.
    desk.put("in/c.dng", small_dng());
    let watching = Watching::start(&desk, &["in"]);
    watching.until("done", "b.dng");
    watching.until("done", "c.dng");
    desk.put("in/c.dng", std::fs::read(sample("still-life.dng")).unwrap());
    let start = Instant::now();
    while count(&watching.events(), "done", "c.dng") < 2 {
        assert!(start.elapsed() < DEADLINE, "{:#?}", watching.events());
        std::thread::sleep(Duration::from_millis(20));
    }
    let ended = watching.end();
    assert_eq!(count(&ended.events, "begun", "a.dng"), 0, "{:#?}", ended.events);
    assert_eq!(std::fs::metadata(desk.path("out/a.jpg")).unwrap().modified().unwrap(), before);
    // What is done for the watch is done for a batch.
    let batch = desk.run(&["batch", "in", "-o", "out", "--json"]);
    assert!(batch.out.contains("\"unchanged\":3"), "{}", batch.out);
}

#[test]
fn a_bad_file_is_reported_once_until_it_changes() {
    let desk = desk();
    let watching = Watching::start(&desk, &["in", "--poll", "100ms"]);
    put_old(&desk, "in/bad.dng", b"II*\0 is all that is right about it");
    watching.until("failed", "bad.dng");
    // Some looks later it is still only once.
    for name in ["one.dng", "two.dng"] {
        desk.put(&format!("in/{name}"), small_dng());
        watching.until("done", name);
    }
    assert_eq!(count(&watching.events(), "begun", "bad.dng"), 1, "{:#?}", watching.events());
    desk.put("in/bad.dng", small_dng());
    watching.until("done", "bad.dng");
    let ended = watching.end();
    assert_eq!((ended.code, count(&ended.events, "failed", "")), (0, 1), "{}", ended.err);
    assert_eq!(ended.err.matches("bad.dng: ").count(), 1, "{}", ended.err);
    assert_tidy(&desk, &["bad.jpg", "one.jpg", "two.jpg"]);
}
