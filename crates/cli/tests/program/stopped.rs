//! A program that is stopped in its midst leaves the old output, or none: never half of one.

#![cfg(unix)]

use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use super::*;

/// Runs the program under a limit on the size of files, as on a disk that fills up: `blocks` of at most 1 KiB.
fn on_a_small_disk(desk: &Desk, blocks: usize, arguments: &[&str]) -> Run {
    let script = format!("ulimit -f {blocks}; trap '' XFSZ; exec \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &script, "sh", env!("CARGO_BIN_EXE_darkroot")]).args(arguments);
    desk.prepare(&mut command);
    Run::of(&command.output().unwrap(), arguments)
}

#[test]
fn a_disk_that_fills_up_leaves_nothing_half_written() {
    for ending in ["jpg", "png", "tif", "webp", "exr", "jxl", "avif", "dng"] {
        let desk = Desk::new();
        let name = format!("o.{ending}");
        let path = sample("still-life.dng");
        let arguments = ["develop", path.to_str().unwrap(), "-o", &name, "--overwrite"];
        let run = on_a_small_disk(&desk, 8, &arguments);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{name}: {}", run.err);
        assert!(run.err.contains(&name) && run.err.contains("cannot be written"), "{}", run.err);
        assert!(desk.names().is_empty(), "{name} left {:?}", desk.names());

        desk.put(&name, "precious");
        assert_eq!(on_a_small_disk(&desk, 8, &arguments).code, 1);
        assert_eq!(desk.read(&name), b"precious");
        assert_eq!(desk.names(), [name]);
    }
}

#[test]
fn a_disk_with_room_takes_the_picture() {
    // So that the test above fails for the right reason.
    let desk = Desk::with_dng();
    let run = on_a_small_disk(&desk, 4096, &["develop", "a.dng"]);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(not(has_dev_full), ignore = "there is no /dev/full")]
fn a_disk_that_is_full_says_so() {
    // The device that is always full cannot be renamed onto: that, too, is an error and no panic.
    let desk = Desk::with_dng();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let arguments = ["inspect", "a.dng"];
    let run = Run::of(&desk.command(&arguments).stdout(full).output().unwrap(), &arguments);
    assert!(run.code == 1 && run.err.contains("space"), "{} {}", run.code, run.err);
    assert!(run.err.contains("standard output cannot be written"), "{}", run.err);
}

/// Whether a process has an unfinished output open: one without a name, or a hidden one where there are none such.
fn is_writing(desk: &Desk, process: u32) -> bool {
    let open = std::fs::read_dir(format!("/proc/{process}/fd")).into_iter().flatten().flatten();
    let folder = desk.folder.path().canonicalize().unwrap();
    let nameless = |path: PathBuf| path.starts_with(&folder) && path.to_string_lossy().ends_with("(deleted)");
    let named = |name: &String| name.starts_with(".darkroot-");
    let is_open = open.filter_map(|e| std::fs::read_link(e.path()).ok()).any(nameless)
        || desk.names().iter().any(named);
    is_open && hears_signals(process)
}

/// Whether a process has a say in what a SIGTERM does to it. The output is open before that.
fn hears_signals(process: u32) -> bool {
    const SIGTERM: u64 = 1 << 14;
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap_or_default();
    u64::from_str_radix(caught.trim(), 16).is_ok_and(|caught| caught & SIGTERM != 0)
}

/// Starts the program on a picture that takes long to write and waits until it has begun to write.
fn writing(desk: &Desk, output: &str) -> Option<Child> {
    let path = sample("still-life.dng");
    let mut command = desk.command(&["develop", path.to_str().unwrap(), "-o", output, "--overwrite"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    loop {
        if is_writing(desk, child.id()) {
            return Some(child);
        }
        if child.try_wait().unwrap().is_some() || start.elapsed() > Duration::from_secs(30) {
            let _ = child.kill(); // It may be at its end already.
            child.wait().unwrap();
            return None;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_program_that_is_told_to_stop_while_writing_leaves_the_old_output() {
    for signal in ["TERM", "INT"] {
        let desk = Desk::new();
        desk.put("o.avif", "precious");
        // AVIF takes longest to write.
        let Some(child) = writing(&desk, "o.avif") else {
            eprintln!("skipped: the picture was written too fast");
            continue;
        };
        let told =
            Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        let run = Run::of(&output, &[signal]);
        if run.code == 0 || !told.success() {
            eprintln!("skipped: the picture was finished first");
            continue;
        }
        assert_eq!((run.code, run.out.as_str()), (130, ""), "{}", run.err);
        assert_eq!(desk.names(), ["o.avif"]);
        assert_eq!(desk.read("o.avif"), b"precious");
    }
}

#[test]
fn a_program_that_is_killed_while_writing_leaves_the_old_output() {
    let desk = Desk::new();
    desk.put("o.avif", "precious");
    let Some(mut child) = writing(&desk, "o.avif") else {
        eprintln!("skipped: the picture was written too fast");
        return;
    };
    child.kill().unwrap();
    child.wait().unwrap();
    // Nobody can tidy up after that; but what bears the name of the output is whole.
    let bytes = desk.read("o.avif");
    assert!(bytes == b"precious" || bytes[4..].starts_with(b"ftypavif"));
    // What has no name goes with its process.
    #[cfg(target_os = "linux")]
    assert_eq!(desk.names(), ["o.avif"]);
}
