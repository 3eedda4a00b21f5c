//! Says which tests cannot run here, so that they are reported as ignored instead of passing unseen: the build script
//! of every package that has such tests.

#![allow(clippy::print_stdout)] // That is how a build script speaks to cargo.

use std::path::{Path, PathBuf};

fn main() {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let root = package.ancestors().find(|folder| folder.join("Cargo.lock").exists()).unwrap_or(&package);
    println!("cargo::rerun-if-changed={}", root.join("tests/build.rs").display());
    println!("cargo::rerun-if-env-changed=DARKROOT_DATA");
    // The variable is meant from the top of the repository.
    let data = std::env::var_os("DARKROOT_DATA").map(|data| root.join(data));
    let there = |below: &str| data.as_ref().is_some_and(|data| data.join(below).exists());
    set("has_broken_files", there("broken"));
    set("has_fixtures", there("fixtures"));
    set("has_raw_files", there("raw"));
    set("has_labelled_charts", there("charts/labels.json"));
    set("has_spectra", there("spectra"));
    println!("cargo::rerun-if-env-changed=PATH");
    set("has_bash", runs("bash", &["--version"], ""));
    set("has_parallel", runs("parallel", &["--version"], "GNU parallel"));
    set("can_mount", runs("unshare", &["-rm", "sh", "-c", "mount -t tmpfs tmpfs /mnt"], ""));
    set("has_dev_full", Path::new("/dev/full").exists());
    set("rights_count", rights_count());
}

/// Tests may ask for this with `cfg`; set if `yes`.
fn set(name: &str, yes: bool) {
    println!("cargo::rustc-check-cfg=cfg({name})");
    if yes {
        println!("cargo::rustc-cfg={name}");
    }
}

/// Whether a program is there, succeeds and says this.
fn runs(program: &str, arguments: &[&str], says: &str) -> bool {
    let output = std::process::Command::new(program).args(arguments).output();
    output.is_ok_and(|o| o.status.success() && String::from_utf8_lossy(&o.stdout).contains(says))
}

/// Whether a file that nobody may read cannot be read: not so for the owner of everything.
#[cfg(unix)]
fn rights_count() -> bool {
    use std::os::unix::fs::PermissionsExt;
    let Some(folder) = std::env::var_os("OUT_DIR") else { return false };
    let path = Path::new(&folder).join("closed");
    let made = std::fs::write(&path, b"x")
        .and_then(|()| std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o000)));
    let counts = made.is_ok() && std::fs::read(&path).is_err();
    // What cannot be removed is overwritten or fails the next time, and the tests are ignored.
    let _ = std::fs::remove_file(&path);
    counts
}

#[cfg(not(unix))]
fn rights_count() -> bool {
    false
}
