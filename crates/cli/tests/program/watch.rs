//! Folders that are watched: what is developed, when, and what is said.

#![cfg(unix)]

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

use serde_json::Value;

use super::*;

mod files;
mod folders;
mod stopping;
mod waiting;

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

/// Nothing but pictures lies in `out`, and nothing unfinished.
fn assert_tidy(desk: &Desk, pictures: &[&str]) {
    let mut expected = vec![".darkroot"];
    expected.extend(pictures);
    assert_eq!(names(&desk.path("out")), expected);
    assert_eq!(names(&desk.path("out/.darkroot")), ["journal.jsonl", "running"]);
}
