//! What a process gives up before it reads its input. What a decoder that is led astray then cannot do is tried in
//! `crates/sandbox/tests` and `crates/batch/tests/astray.rs`; here is that the program's commands really begin with it.

#![cfg(target_os = "linux")]

use std::io::Write;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use super::*;

/// Starts the program, which then waits for its standard input.
fn waiting(desk: &Desk, arguments: &[&str]) -> Child {
    let mut command = desk.command(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// The filters and the threads of a process, when it has come to waiting for its input.
fn state(child: &Child) -> (String, bool) {
    let file = |name: &str| format!("/proc/{}/{name}", child.id());
    let begun = Instant::now();
    loop {
        // It reads descriptor 0.
        let reads = std::fs::read_to_string(file("syscall")).unwrap_or_default().starts_with("0 0x0 ");
        let status = std::fs::read_to_string(file("status")).unwrap_or_default();
        let field = |name: &str| status.lines().find_map(|l| l.strip_prefix(name)).unwrap_or_default().trim();
        if reads || begun.elapsed() > Duration::from_secs(20) {
            return (field("Seccomp:").to_owned(), field("NoNewPrivs:") == "1");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn finish(mut child: Child, bytes: &[u8]) -> std::process::Output {
    child.stdin.take().unwrap().write_all(bytes).unwrap();
    child.wait_with_output().unwrap()
}

fn is_offered() -> bool {
    darkroot_sandbox::offered().missing().inspect(|missing| eprintln!("skipped: {missing}")).is_none()
}

#[test]
fn develop_and_inspect_give_up_system_calls_before_they_read() {
    if !is_offered() {
        return;
    }
    let desk = Desk::new();
    for command in [&["develop", "-", "-o", "a.jpg", "--overwrite"][..], &["inspect", "-"]] {
        let child = waiting(&desk, command);
        // 2: a filter.
        assert_eq!(state(&child), ("2".to_owned(), true), "{command:?}");
        assert!(finish(child, small_dng()).status.success());
        let child = waiting(&desk, &[command, &["--no-sandbox"]].concat());
        assert_eq!(state(&child), ("0".to_owned(), false), "{command:?}");
        assert!(finish(child, small_dng()).status.success());
    }
}

/// The profile is read when the camera is known. If by then its name leads elsewhere, that is out of reach.
#[test]
fn develop_gives_up_paths_before_it_reads() {
    if !is_offered() {
        return;
    }
    for (options, is_in_reach) in [(&[][..], false), (&["--no-sandbox"], true)] {
        let desk = Desk::new();
        let profile = built_in_profile();
        desk.put("p.toml", &profile);
        desk.put("other.toml", &profile);
        let child =
            waiting(&desk, &[&["develop", "-", "-o", "a.jpg", "--profile", "p.toml"], options].concat());
        let _ = state(&child);
        std::fs::remove_file(desk.path("p.toml")).unwrap();
        std::os::unix::fs::symlink("other.toml", desk.path("p.toml")).unwrap();
        let output = finish(child, small_dng());
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        let is_closed = words.contains("ermission denied");
        assert_eq!(is_closed, !is_in_reach, "{words}");
    }
}

/// The text of some profile; that it is for another camera does not matter, as it is read first.
fn built_in_profile() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../profiles/nikon");
    let path = std::fs::read_dir(folder).unwrap().next().unwrap().unwrap().path();
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn what_holds_is_said() {
    let desk = Desk::with_dng();
    let run = desk.develop(&["a.dng", "--verbose"]);
    let said = run.err.contains("sandbox: paths by Landlock") || run.err.contains("note: this system");
    assert!(said, "{}", run.err);
    let quiet = desk.develop(&["a.dng", "-o", "b.jpg", "--no-sandbox", "--verbose"]);
    assert!(!quiet.err.contains("sandbox"), "{}", quiet.err);
}

#[test]
fn names_that_come_out_of_files_and_very_many_files_work_as_well() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "out/{camera}/{stem}.jpg"]);
    assert!(desk.path("out/Darkroot_Simulated_One/a.jpg").is_file());
    let names: Vec<String> = (0..70).map(|n| format!("{n}.dng")).collect();
    names.iter().for_each(|name| desk.put(name, small_dng()));
    let arguments: Vec<&str> = names.iter().map(String::as_str).chain(["-o", "many/"]).collect();
    desk.develop(&arguments);
    assert_eq!(super::names(&desk.path("many")).len(), 70);
}
