//! Folders that are watched: what is developed, when, and what is said.

#![cfg(unix)]

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

use serde_json::Value;

use super::*;

/// Long enough for the slowest machine; nothing waits so long where things work.
const DEADLINE: Duration = Duration::from_secs(120);

/// A program that watches, and what it has said so far.
struct Watching {
    child: Child,
    events: Arc<Mutex<Vec<Value>>>,
    err: Option<JoinHandle<String>>,
    out: Option<JoinHandle<()>>,
}

/// How it ended.
struct Ended {
    code: i32,
    events: Vec<Value>,
    err: String,
}

impl Watching {
    fn start(desk: &Desk, arguments: &[&str]) -> Self {
        let fixed = ["watch", "-o", "out", "--json"];
        let settle = if arguments.contains(&"--settle") { &[][..] } else { &["--settle", "300ms"] };
        let mut command = desk.command(&[&fixed, settle, arguments].concat());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (stdout, mut stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let events = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&events);
        let out = std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines() {
                kept.lock().unwrap().push(serde_json::from_str(&line.unwrap()).unwrap());
            }
        });
        let err = std::thread::spawn(move || {
            let mut text = String::new();
            stderr.read_to_string(&mut text).unwrap();
            text
        });
        Self { child, events, err: Some(err), out: Some(out) }
    }

    fn events(&self) -> Vec<Value> {
        self.events.lock().unwrap().clone()
    }

    /// Waits for an event about an input; its name is enough.
    fn until(&self, event: &str, input: &str) {
        let start = Instant::now();
        while count(&self.events(), event, input) == 0 {
            assert!(start.elapsed() < DEADLINE, "no {event} of `{input}` in {:#?}", self.events());
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn signal(&self, names: &[&str]) {
        let kills: Vec<String> = names.iter().map(|n| format!("kill -{n} {}", self.child.id())).collect();
        assert!(Command::new("sh").args(["-c", &kills.join("; ")]).status().unwrap().success());
    }

    /// Tells it to end, and waits for that.
    fn end(mut self) -> Ended {
        self.signal(&["TERM"]);
        self.wait()
    }

    fn wait(&mut self) -> Ended {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < DEADLINE, "it does not end");
            std::thread::sleep(Duration::from_millis(10));
        };
        self.out.take().unwrap().join().unwrap();
        let err = self.err.take().unwrap().join().unwrap();
        assert!(!err.contains("panicked"), "{err}");
        Ended { code: status.code().unwrap_or(-1), events: self.events(), err }
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        // Of a test that failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// How many events of a kind there are about an input: the end of its path.
fn count(events: &[Value], event: &str, input: &str) -> usize {
    let about = |e: &Value| e["input"].as_str().is_none_or(|name| Path::new(name).ends_with(input));
    events.iter().filter(|e| e["event"] == event && about(e)).count()
}

/// A desk with an empty folder `in`, whose settings are its own.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.put("darkroot.toml", "root = true\n");
    std::fs::create_dir(desk.path("in")).unwrap();
    desk
}

/// A file that is changed last an hour ago: a damaged one is not taken for one that still grows.
fn put_old(desk: &Desk, name: &str, bytes: &[u8]) {
    let path = desk.path("in/hidden.tmp");
    std::fs::write(&path, bytes).unwrap();
    let file = std::fs::OpenOptions::new().append(true).open(&path).unwrap();
    file.set_modified(SystemTime::now() - Duration::from_secs(3600)).unwrap();
    drop(file);
    std::fs::rename(path, desk.path(name)).unwrap();
}

/// Nothing but pictures lies in `out`, and nothing unfinished.
fn assert_tidy(desk: &Desk, pictures: &[&str]) {
    let mut expected = vec![".darkroot"];
    expected.extend(pictures);
    assert_eq!(names(&desk.path("out")), expected);
    assert_eq!(names(&desk.path("out/.darkroot")), ["journal.jsonl"]);
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
