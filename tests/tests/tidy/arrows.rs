//! Which of our crates uses which, and that their manifests agree.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use darkroot_tests::root;

use crate::files;

/// Which of our crates each crate uses, as `docs/architecture.md` has it. Tests and benches may use any.
const ARROWS: [(&str, &[&str]); 17] = [
    ("colour", &[]),
    ("photo", &["colour"]),
    ("sandbox", &[]),
    ("lens", &[]),
    ("profile", &["colour"]),
    ("raw", &["colour", "photo"]),
    ("encode", &["colour", "photo"]),
    ("chart", &["colour", "photo"]),
    ("simulate", &["colour", "encode", "photo"]),
    ("develop", &["colour", "lens", "photo", "profile"]),
    ("calibrate", &["chart", "colour", "photo", "profile"]),
    ("darkroot", &["calibrate", "chart", "colour", "develop", "encode", "lens", "photo", "profile", "raw"]),
    ("batch", &["colour", "darkroot", "develop", "encode", "photo", "profile", "raw", "sandbox"]),
    // It shows pictures, charts and profiles, and encodes views for the browser.
    ("window", &["batch", "chart", "colour", "darkroot", "develop", "encode", "photo", "raw", "sandbox"]),
    // Options of the program are types of `develop` and `raw`; it shows profiles.
    ("cli", &["batch", "colour", "darkroot", "develop", "profile", "raw", "sandbox", "window"]),
    // Bindings: they take and show the nouns of all of these.
    ("python", &["batch", "calibrate", "chart", "colour", "darkroot", "develop", "photo", "profile", "raw"]),
    ("tests", &["chart", "colour", "darkroot", "develop", "lens", "photo", "profile", "simulate"]),
];

/// Crates that must stay pure: no files, no clock, no environment (architecture, invariant 7).
const PURE: [&str; 7] = ["colour", "photo", "lens", "profile", "chart", "calibrate", "develop"];

fn metadata() -> serde_json::Value {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let out = Command::new(cargo)
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    serde_json::from_slice(&out.stdout).unwrap()
}

/// Each of our crates by the name of its folder, with the names of the folders of ours that it uses.
fn arrows() -> BTreeMap<String, BTreeSet<String>> {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    let folder = |path: &str| Path::new(path).file_name().unwrap().to_string_lossy().into_owned();
    packages
        .iter()
        .map(|package| {
            let manifest = Path::new(package["manifest_path"].as_str().unwrap());
            let used = package["dependencies"]
                .as_array()
                .unwrap()
                .iter()
                .filter(|d| d["kind"].as_str() != Some("dev"))
                .filter_map(|d| d["path"].as_str())
                .map(folder)
                .collect();
            (folder(manifest.parent().unwrap().to_str().unwrap()), used)
        })
        .collect()
}

#[test]
fn crates_use_each_other_only_along_the_arrows_of_the_architecture() {
    let mut found = arrows();
    for (name, allowed) in ARROWS {
        let used = found.remove(name).unwrap_or_else(|| panic!("there is no crate `{name}`"));
        let allowed: BTreeSet<String> = allowed.iter().map(|a| (*a).to_owned()).collect();
        let wrong: Vec<_> = used.difference(&allowed).collect();
        assert!(wrong.is_empty(), "`{name}` uses {wrong:?}; see docs/architecture.md");
    }
    // Crates that came later: they may stand anywhere, but must be named here.
    assert!(found.is_empty(), "no arrows are known for {found:?}");
}

#[test]
fn every_crate_has_the_lints_and_the_licence_of_the_workspace() {
    let mut seen = 0;
    for (name, _) in ARROWS {
        let folder = if name == "tests" { root().join(name) } else { root().join("crates").join(name) };
        let text = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        let inherits = |table: &toml::Table, key: &str| {
            table.get(key).and_then(|v| v.get("workspace")).and_then(toml::Value::as_bool) == Some(true)
        };
        assert_eq!(manifest["lints"].get("workspace").and_then(toml::Value::as_bool), Some(true), "{name}");
        let package = manifest["package"].as_table().unwrap();
        for key in ["version", "edition", "rust-version", "license"] {
            assert!(inherits(package, key), "{name}: {key}");
        }
        assert!(package.contains_key("description"), "{name}");
        seen += 1;
    }
    let folders = std::fs::read_dir(root().join("crates")).unwrap();
    let crates = folders.filter(|f| f.as_ref().unwrap().path().join("Cargo.toml").exists()).count();
    assert_eq!(seen, crates + 1, "a crate of `crates/` is not named in this test");
}

#[test]
fn pure_crates_touch_no_files_clock_or_environment() {
    for name in PURE {
        for file in files(&root().join("crates").join(name).join("src")) {
            let text = std::fs::read_to_string(&file).unwrap();
            for word in [
                "std::fs",
                "std::env",
                "std::net",
                "std::process",
                "std::time",
                "SystemTime",
                "thread::spawn",
            ] {
                assert!(!text.contains(word), "{}: uses {word}", file.display());
            }
        }
    }
}

#[test]
fn every_crate_says_what_it_does_not_do() {
    for (name, _) in ARROWS {
        let library = root().join("crates").join(name).join("src/lib.rs");
        if name != "tests" && library.exists() {
            let text = std::fs::read_to_string(&library).unwrap();
            assert!(text.starts_with("//! ") && text.contains("**What it does not do:**"), "{name}");
        }
    }
}
