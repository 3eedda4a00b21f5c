//! Folders to folders: plans, resuming, faults of single files, shards, reports.

use std::time::{Duration, Instant};

use super::*;

mod faults;
mod killed;
mod plans;
mod resume;
mod session;
mod shards;
mod thousand;

impl Desk {
    /// A batch of `in` into `out`.
    fn batch(&self, arguments: &[&str]) -> Run {
        self.run(&[&["batch", "in", "-o", "out"], arguments].concat())
    }

    /// With a small tree of raw files below `in`.
    fn with_tree() -> Self {
        let desk = Self::new();
        desk.put("in/a.dng", small_dng());
        desk.put("in/day 1/b.nef", small_nef());
        desk.put("in/day 1/c.NEF", small_nef());
        desk.put("in/day 2/ü.dng", small_dng());
        desk.put("in/day 2/notes.txt", "not a picture");
        desk
    }

    /// What lies below `out`, without the journals' folder.
    fn outputs(&self) -> Vec<String> {
        below(&self.path("out")).into_iter().filter(|n| !n.starts_with(".darkroot/")).collect()
    }

    /// What lies below `out` besides pictures and journals.
    fn left_over(&self) -> Vec<String> {
        let journal =
            |n: &str| n.starts_with(".darkroot/journal") && n.ends_with(".jsonl") || n == ".darkroot/running";
        let picture = |n: &str| [".jpg", ".tif", ".png"].iter().any(|e| n.ends_with(e));
        let all = below(&self.path("out"));
        all.into_iter().filter(|n| !journal(n) && (!picture(n) || n.starts_with('.'))).collect()
    }
}

/// Paths of all files below a folder, sorted.
fn below(folder: &Path) -> Vec<String> {
    fn walk(at: &Path, prefix: &str, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(at).into_iter().flatten().flatten() {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                walk(&entry.path(), &format!("{name}/"), found);
            } else {
                found.push(name);
            }
        }
    }
    let mut found = Vec::new();
    walk(folder, "", &mut found);
    found.sort();
    found
}

/// The JSON lines of a run with one `event`.
fn events(run: &Run, event: &str) -> Vec<serde_json::Value> {
    let all = run.out.lines().map(|l| serde_json::from_str::<serde_json::Value>(l).unwrap());
    all.filter(|v| v["event"] == event).collect()
}

/// The summary of a run with `--json`: done, unchanged, failed, left.
fn summary(run: &Run) -> [u64; 4] {
    let last = events(run, "summary").pop().unwrap_or_else(|| panic!("no summary: {}", run.err));
    ["done", "unchanged", "failed", "left"].map(|name| last[name].as_u64().unwrap())
}

/// Waits for something, for a long time on a busy machine.
fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < Duration::from_secs(120), "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
