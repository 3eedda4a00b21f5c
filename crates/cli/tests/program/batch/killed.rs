//! Whatever ends a run, the next one goes on, and no half of a picture is ever seen.

#![cfg(target_os = "linux")]

use std::collections::BTreeMap;
use std::process::{Child, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::*;

const FILES: usize = 60;

fn desk() -> Desk {
    let desk = Desk::new();
    for i in 0..FILES {
        let bytes = if i % 2 == 0 { small_nef() } else { small_dng() };
        desk.put(&format!("in/{}/{i:02}.{}", i % 3, if i % 2 == 0 { "nef" } else { "dng" }), bytes);
    }
    desk
}

fn start(desk: &Desk) -> Child {
    let mut command = desk.command(&["batch", "in", "-o", "out", "-q", "--jobs", "2"]);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

fn pictures(desk: &Desk, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let names = below(&desk.path(folder)).into_iter().filter(|n| n.ends_with(".jpg"));
    names.map(|name| (name.clone(), desk.read(&format!("{folder}/{name}")))).collect()
}

/// Number of lines of the journal that say an output is done, by output.
fn done(desk: &Desk) -> BTreeMap<String, usize> {
    let mut done = BTreeMap::new();
    let text = std::fs::read(desk.path("out/.darkroot/journal.jsonl")).unwrap_or_default();
    for line in String::from_utf8_lossy(&text).lines() {
        let Ok(value) = serde_json::from_str::<serde_json::Value>(line) else { continue };
        if value["event"] == "done" {
            *done.entry(value["output"].as_str().unwrap().to_owned()).or_default() += 1;
        }
    }
    done
}

#[test]
fn killed_twenty_times_it_ends_as_if_never_disturbed() {
    let desk = desk();
    let calm = desk.run(&["batch", "in", "-o", "calm", "-q"]);
    assert_eq!(calm.code, 0, "{}", calm.err);
    let expected = pictures(&desk, "calm");
    assert_eq!(expected.len(), FILES);

    // Whoever looks at any moment sees whole pictures.
    let over = AtomicBool::new(false);
    let looks = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !over.load(Ordering::SeqCst) {
                for name in below(&desk.path("out")).into_iter().filter(|n| !n.starts_with(".darkroot/")) {
                    let bytes = std::fs::read(desk.path("out").join(&name)).unwrap_or_default();
                    if bytes.is_empty() && !desk.path("out").join(&name).exists() {
                        continue;
                    }
                    assert_eq!(Some(&bytes), expected.get(&name), "{name} is partial or wrong");
                    looks.fetch_add(1, Ordering::SeqCst);
                }
            }
        });
        // Moments spread by a fixed rule: the n-th run is killed after some more milliseconds than the last.
        let mut kills = 0;
        for n in 0u64.. {
            let mut child = start(&desk);
            let pause = 15 + (n * 7919) % 90;
            std::thread::sleep(Duration::from_millis(pause));
            let ended = child.try_wait().unwrap().is_some();
            child.kill().unwrap();
            child.wait().unwrap();
            if ended || kills == 40 {
                break;
            }
            kills += 1;
        }
        eprintln!("killed {kills} times, {} looks", looks.load(Ordering::SeqCst));
        let last = wait_for("the end", || {
            // Workers of the killed run end with it, at once.
            let run = desk.run(&["batch", "in", "-o", "out", "-q"]);
            (run.code == 0).then_some(run)
        });
        assert_eq!(last.code, 0);
        over.store(true, Ordering::SeqCst);
    });
    assert_eq!(pictures(&desk, "out"), expected);
    assert!(desk.left_over().is_empty(), "{:?}", desk.left_over());
    let done = done(&desk);
    assert_eq!(done.len(), FILES);
    assert!(done.values().all(|n| *n == 1), "developed again after it was journaled: {done:?}");
}

#[test]
fn told_to_stop_it_finishes_what_it_has_begun() {
    for signal in ["INT", "TERM"] {
        let desk = desk();
        let mut command = desk.command(&["batch", "in", "-o", "out", "--jobs", "2"]);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        wait_for("the first picture", || (!done(&desk).is_empty()).then_some(()));
        Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().unwrap();
        let run = Run::of(&child.wait_with_output().unwrap(), &[signal]);
        if run.code == 0 {
            eprintln!("skipped: all pictures were finished first");
            continue;
        }
        assert_eq!(run.code, 130, "{}", run.err);
        assert!(run.err.contains("does what is left"), "{}", run.err);
        assert!(!run.err.contains("error: "), "{}", run.err);
        assert!(desk.left_over().is_empty(), "{:?}", desk.left_over());
        // Everything that is there is in the journal.
        assert_eq!(pictures(&desk, "out").len(), done(&desk).len());
        let run = desk.batch(&["--json"]);
        assert_eq!((run.code, summary(&run)[3]), (0, 0), "{}", run.err);
        assert_eq!(pictures(&desk, "out").len(), FILES);
    }
}

#[test]
fn two_runs_at_once_do_not_disturb_each_other() {
    let desk = desk();
    let mut first = start(&desk);
    wait_for("the journal", || desk.path("out/.darkroot/journal.jsonl").exists().then_some(()));
    let second = desk.batch(&[]);
    let first_was_running = first.try_wait().unwrap().is_none();
    first.wait().unwrap();
    if first_was_running {
        assert_eq!(second.code, 2, "{}", second.err);
        assert!(second.err.contains("another run") && second.err.contains("--shard"), "{}", second.err);
    }
    assert_eq!(summary(&desk.batch(&["--json"])), [0, FILES as u64, 0, 0]);
}
