//! What a confined process can still do, tried out in a process of its own: this test program, started again.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used)] // A test may stop.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, ExitStatus};

use darkroot_sandbox::{Access, Breach, Reach, confine, offered};

const SIGSYS: i32 = 31;
const FOLDER: &str = "DARKROOT_CONFINED_FOLDER";
const DEED: &str = "DARKROOT_CONFINED_DEED";
const NAME: &str = "the_process_that_is_confined";

/// Starts this program again, to do one thing in a folder once it is confined.
fn confined(folder: &Path, deed: &str) -> ExitStatus {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", NAME, "--ignored", "--quiet"])
        .env(FOLDER, folder)
        .env(DEED, deed)
        .output()
        .unwrap()
        .status
}

/// What succeeds ends well, what fails does not.
#[test]
#[ignore = "started by the other tests, as a process of its own"]
fn the_process_that_is_confined() {
    let (Some(folder), Ok(deed)) = (std::env::var_os(FOLDER), std::env::var(DEED)) else { return };
    let folder = Path::new(&folder);
    let breach = if deed.starts_with("fails-") { Breach::Fails } else { Breach::Ends };
    let deed = deed.trim_start_matches("fails-").to_owned();
    // A test runs in a thread beside another one that waits for it, and it is this one that is confined.
    let out = folder.join("out");
    let written = if deed == "write-in-folder" { Access::Write } else { Access::Name };
    let reach = Reach::default().with(folder.join("in"), Access::Read).with(out, written);
    let held = confine(&reach, breach).unwrap();
    assert!(held.paths && held.calls);
    let worked = match deed.as_str() {
        "read-in-reach" => fs::read(folder.join("in/a")).is_ok(),
        "read-elsewhere" => fs::read(folder.join("secret")).is_ok(),
        "list-elsewhere" => fs::read_dir(folder).is_ok(),
        "write-elsewhere" => fs::OpenOptions::new().write(true).open(folder.join("secret")).is_ok(),
        "make" => fs::write(folder.join("out/new"), "x").is_ok(),
        "write-in-reach" => fs::OpenOptions::new().write(true).open(folder.join("in/a")).is_ok(),
        "replace" => fs::rename(folder.join("out/b"), folder.join("out/there")).is_ok(),
        "remove" => fs::remove_file(folder.join("out/there")).is_ok(),
        "write-in-folder" => fs::write(folder.join("out/new"), "x").is_ok(),
        "threads" => std::thread::spawn(|| 7).join().is_ok(),
        "thread-reads" => {
            let secret = folder.join("secret");
            std::thread::spawn(move || fs::read(secret).is_ok()).join().unwrap()
        }
        "socket" => std::net::UdpSocket::bind("127.0.0.1:0").is_ok(),
        "local-socket" => std::os::unix::net::UnixStream::pair().is_ok(),
        "program" => Command::new("/bin/true").status().is_ok(),
        "rights" => {
            fs::set_permissions(folder.join("in/a"), fs::metadata(folder).unwrap().permissions()).is_ok()
        }
        "abort" => std::process::abort(),
        _ => false,
    };
    assert!(worked);
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["in", "out"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    for name in ["in/a", "secret", "out/there", "out/b"] {
        fs::write(folder.path().join(name), "x").unwrap();
    }
    folder
}

/// Nothing below can be tried where the kernel offers nothing.
fn is_offered() -> bool {
    offered().missing().inspect(|missing| eprintln!("skipped: {missing}")).is_none()
}

#[test]
fn what_is_in_reach_works() {
    for deed in ["read-in-reach", "write-in-folder", "threads"] {
        assert!(!is_offered() || confined(folder().path(), deed).success(), "{deed}");
    }
}

#[test]
fn paths_out_of_reach_are_closed_to_every_thread() {
    for deed in [
        "read-elsewhere",
        "list-elsewhere",
        "write-elsewhere",
        "write-in-reach",
        "replace",
        "remove",
        "thread-reads",
    ] {
        let folder = folder();
        if is_offered() {
            let status = confined(folder.path(), deed);
            assert!(status.code().is_some_and(|c| c != 0), "{deed}: {status}");
            assert!(folder.path().join("out/there").is_file() && !folder.path().join("new").exists());
        }
    }
}

#[test]
fn a_socket_a_program_or_a_new_file_ends_the_process() {
    for deed in ["socket", "local-socket", "program", "rights", "make"] {
        assert!(!is_offered() || confined(folder().path(), deed).signal() == Some(SIGSYS), "{deed}");
    }
}

#[test]
fn or_it_fails_where_the_process_is_to_go_on() {
    for deed in ["fails-socket", "fails-local-socket", "fails-program", "fails-rights", "fails-make"] {
        let folder = folder();
        let status = confined(folder.path(), deed);
        assert!(!is_offered() || status.code().is_some_and(|c| c != 0), "{deed}: {status}");
        assert!(!is_offered() || !folder.path().join("out/new").exists());
    }
}

#[test]
fn an_abort_is_an_abort() {
    const SIGABRT: i32 = 6;
    assert!(!is_offered() || confined(folder().path(), "abort").signal() == Some(SIGABRT));
}
