//! What is no regular file is neither read nor written over; `-` is standard input and output.

use std::io::Write;
use std::process::Stdio;

use super::*;

/// Runs with these bytes on standard input, and gives what came to standard output as it is.
fn piped(desk: &Desk, arguments: &[&str], bytes: &[u8]) -> std::process::Output {
    let mut command = desk.command(arguments);
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Whoever refuses the input closes it.
    let _ = child.stdin.take().unwrap().write_all(bytes);
    child.wait_with_output().unwrap()
}

#[test]
fn a_picture_goes_from_standard_input_to_standard_output() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "whole.png"]);
    for arguments in [
        &["develop", "-", "-o", "-", "--format", "png"][..],
        &["develop", "a.dng", "-o", "-", "--format", "png"],
    ] {
        let output = piped(&desk, arguments, small_dng());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.stdout, desk.read("whole.png"), "{arguments:?}");
    }
    let named = piped(&desk, &["develop", "-", "-o", "named.png"], small_dng());
    assert!(named.status.success() && desk.read("named.png") == desk.read("whole.png"));
    let looked = piped(&desk, &["inspect", "-"], small_dng());
    assert!(looked.status.success() && String::from_utf8_lossy(&looked.stdout).contains("Simulated One"));
    assert_eq!(desk.names(), ["a.dng", "named.png", "whole.png"]);
}

#[test]
fn what_has_no_name_must_be_given_one() {
    let desk = Desk::with_dng();
    for arguments in
        [&["develop", "-"][..], &["develop", "-", "-o", "out/"], &["develop", "-", "-o", "{stem}.{ext}"]]
    {
        let output = piped(&desk, arguments, small_dng());
        let run = Run::of(&output, arguments);
        assert!(run.code == 2 && run.err.contains("-o FILE") && run.err.contains("`-o -`"), "{}", run.err);
    }
    desk.fails(2, &["develop", "a.dng", "a.dng", "-o", "-"], &["one picture"]);
    desk.fails(2, &["develop", "a.dng", "--json", "-o", "-"], &["--json"]);
    assert_eq!(desk.names(), ["a.dng"]);
}

#[cfg(unix)]
mod on_unix {
    use super::*;
    use std::time::{Duration, Instant};

    fn pipe(desk: &Desk, name: &str) {
        std::fs::create_dir_all(desk.path(name).parent().unwrap()).unwrap();
        assert!(Command::new("mkfifo").arg(desk.path(name)).status().unwrap().success());
    }

    /// Runs the program, which must be at its end soon.
    fn soon(desk: &Desk, arguments: &[&str]) -> Run {
        let mut command = desk.command(arguments);
        let mut child =
            command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let start = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if start.elapsed() > Duration::from_secs(60) {
                child.kill().unwrap();
                panic!("{arguments:?} waits for ever");
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        Run::of(&child.wait_with_output().unwrap(), arguments)
    }

    #[test]
    fn a_pipe_is_no_file_wherever_a_file_is_named() {
        let desk = Desk::with_dng();
        pipe(&desk, "p");
        pipe(&desk, "p.toml");
        pipe(&desk, "p.png");
        let runs: [(&[&str], i32); 9] = [
            (&["develop", "p"], 1),
            (&["inspect", "p"], 1),
            (&["inspect", "p", "--preview", "o.jpg"], 1),
            (&["chart", "p.png"], 1),
            (&["develop", "a.dng", "--recipe", "p"], 2),
            (&["develop", "a.dng", "--profile", "p.toml"], 1),
            (&["profile", "show", "p.toml"], 2),
            (&["verify", "--history", "p", "-o", "h.html"], 2),
            (&["develop", "a.dng", "-o", "p.png", "--overwrite"], 1),
        ];
        for (arguments, code) in runs {
            let run = soon(&desk, arguments);
            assert!(
                run.code == code && run.err.contains("a pipe, not a file"),
                "{arguments:?}: {} {}",
                run.code,
                run.err
            );
        }
        assert_eq!(desk.names(), ["a.dng", "p", "p.png", "p.toml"]);
    }

    #[test]
    fn pipes_among_journals_and_inputs_stop_nobody_for_ever() {
        let desk = Desk::new();
        desk.put("in/a.dng", small_dng());
        pipe(&desk, "in/b.dng");
        let run = soon(&desk, &["batch", "in", "-o", "out"]);
        assert!(run.code == 0 && desk.path("out/a.jpg").is_file(), "{}", run.err);
        let named = soon(&desk, &["batch", "in/b.dng", "-o", "other"]);
        assert!(named.code == 1 && named.err.contains("a pipe, not a file"), "{}", named.err);
        pipe(&desk, "out/.darkroot/journal-1-of-2.jsonl");
        for arguments in [
            &["batch", "in", "-o", "out", "--shard", "1/2"][..],
            &["batch", "in", "-o", "out"],
            &["batch", "status", "out"],
        ] {
            let run = soon(&desk, arguments);
            assert!(run.code == 2 && run.err.contains("a pipe, not a file"), "{}", run.err);
        }
    }

    #[test]
    fn devices_are_neither_read_nor_replaced() {
        let desk = Desk::with_dng();
        let start = Instant::now();
        let run = soon(&desk, &["develop", "/dev/zero", "-o", "o.jpg"]);
        assert!(run.code == 1 && run.err.contains("a device, not a file"), "{}", run.err);
        assert!(start.elapsed() < Duration::from_secs(30));
        let beside = soon(&desk, &["develop", "/dev/stdin"]);
        assert!(beside.code == 2 && beside.err.contains("name the picture"), "{}", beside.err);
        assert_eq!(desk.names(), ["a.dng"]);
    }
}
