//! Says which tests cannot run here, so that they are reported as ignored instead of passing unseen.

#![allow(clippy::print_stdout)] // That is how a build script speaks to cargo.

use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=DARKROOT_DATA");
    let data = std::env::var_os("DARKROOT_DATA").map(PathBuf::from);
    // The variable is meant from the top of the repository.
    let data = data.map(|data| Path::new("..").join(data));
    let there = |below: &str| data.as_ref().is_some_and(|data| data.join(below).exists());
    set("has_broken_files", there("broken"));
    set("has_spectra", there("spectra"));
}

/// Tests may ask for this with `cfg`; set if `yes`.
fn set(name: &str, yes: bool) {
    println!("cargo::rustc-check-cfg=cfg({name})");
    if yes {
        println!("cargo::rustc-cfg={name}");
    }
}
