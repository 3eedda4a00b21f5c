//! Where things come from: no file is from one machine, every dependency is from the one registry.

use std::path::PathBuf;
use std::process::Command;

use darkroot_tests::root;

use crate::files;

/// The files that belong to the repository: those that git knows or would know, else all outside `target`.
fn repository() -> Vec<PathBuf> {
    let listed = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard", "-z"])
        .current_dir(root())
        .output();
    match listed {
        Ok(out) if out.status.success() => {
            let names = String::from_utf8(out.stdout).unwrap();
            names.split('\0').filter(|n| !n.is_empty()).map(|n| root().join(n)).collect()
        }
        _ => {
            let outside = |path: &PathBuf| {
                let inside = path.strip_prefix(root()).unwrap();
                !(inside.starts_with("target") || inside.starts_with(".git"))
            };
            files(&root()).into_iter().filter(outside).collect()
        }
    }
}

/// What only stands in a file that was made on one machine: its folders and its mirrors of the registry. Each is
/// cut in two so that this file is clean.
const TRACES: [(&str, &str); 7] = [
    ("/work", "/"),
    ("/root", "/"),
    ("/tmp/tg", "t-"),
    ("/home/", "runner"),
    ("index.crates.io-", "1949"),
    (".cargo/", "registry/src"),
    ("replace-", "with"),
];

#[test]
fn no_file_has_traces_of_the_machine_that_it_was_made_on() {
    let all = repository();
    assert!(
        all.iter().any(|path| path.ends_with("tests/tests/tidy/origins.rs")),
        "the list of files is wrong"
    );
    for path in all {
        // A file may be deleted and still be known to git.
        let Ok(bytes) = std::fs::read(&path) else { continue };
        for (first, second) in TRACES {
            let trace = [first, second].concat();
            let found = bytes.windows(trace.len()).any(|w| w == trace.as_bytes());
            assert!(!found, "{} contains {trace}", path.display());
        }
    }
}

#[test]
fn every_dependency_comes_from_the_one_registry() {
    let lock: toml::Table = std::fs::read_to_string(root().join("Cargo.lock")).unwrap().parse().unwrap();
    for package in lock["package"].as_array().unwrap() {
        if let Some(source) = package.get("source").and_then(toml::Value::as_str) {
            let official = "registry+https://github.com/rust-lang/crates.io-index";
            assert_eq!(source, official, "{}", package["name"]);
        }
    }
}
