//! The house in order: arrows between crates, profiles, samples, lints, and no traces of the machine it was built on.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use darkroot_colour::white;
use darkroot_tests::root;
use serde::Deserialize;
use sha2::{Digest, Sha256};

/// Which of our crates each crate uses, as `docs/architecture.md` has it. Tests and benches may use any.
const ARROWS: [(&str, &[&str]); 13] = [
    ("colour", &[]),
    ("photo", &["colour"]),
    ("profile", &["colour"]),
    ("raw", &["colour", "photo"]),
    ("encode", &["colour", "photo"]),
    ("chart", &["colour", "photo"]),
    ("simulate", &["colour", "photo"]),
    ("develop", &["colour", "photo", "profile"]),
    ("calibrate", &["chart", "colour", "photo", "profile"]),
    ("darkroot", &["calibrate", "chart", "colour", "develop", "encode", "photo", "profile", "raw"]),
    ("batch", &["colour", "darkroot", "develop", "encode", "photo", "profile", "raw"]),
    // Options of the program are types of `develop` and `raw`; it shows profiles.
    ("cli", &["batch", "colour", "darkroot", "develop", "profile", "raw"]),
    ("tests", &["chart", "colour", "darkroot", "develop", "photo", "profile", "simulate"]),
];

/// Crates that must stay pure: no files, no clock, no environment (architecture, invariant 7).
const PURE: [&str; 6] = ["colour", "photo", "profile", "chart", "calibrate", "develop"];

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

/// Which other files of its crate a file uses, from its `use` lines and paths. Files are named without `.rs`.
fn used_files(folder: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let sources = files(folder).into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs"));
    let texts: BTreeMap<String, String> = sources
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]\nmod tests").next().unwrap().to_owned();
            (path.file_stem().unwrap().to_string_lossy().into_owned(), text)
        })
        .filter(|(name, _)| name != "lib")
        .collect();
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let used = |text: &str| {
        let mut found = BTreeSet::new();
        for path in text.split("super::").skip(1).chain(text.split("crate::").skip(1)) {
            match path.strip_prefix('{') {
                // In `use super::{a, b};` each word is a file.
                Some(list) => {
                    let list = list.split(';').next().unwrap();
                    found.extend(list.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::to_owned));
                }
                None => {
                    found.insert(word(path));
                }
            }
        }
        found.retain(|name| texts.contains_key(name));
        found
    };
    texts
        .iter()
        .map(|(name, text)| {
            let mut found = used(text);
            found.remove(name);
            (name.clone(), found)
        })
        .collect()
}

/// Files that use each other, directly or by way of others, and files that use those: what is left when files that
/// use none are taken away again and again.
fn circle(mut graph: BTreeMap<String, BTreeSet<String>>) -> BTreeSet<String> {
    loop {
        let free: BTreeSet<String> =
            graph.iter().filter(|(_, used)| used.is_empty()).map(|(name, _)| name.clone()).collect();
        if free.is_empty() {
            return graph.into_keys().collect();
        }
        graph.retain(|name, _| !free.contains(name));
        for used in graph.values_mut() {
            used.retain(|name| !free.contains(name));
        }
    }
}

#[test]
fn files_of_the_batch_use_each_other_without_circles() {
    let graph = used_files(&root().join("crates/batch/src"));
    assert!(graph.len() > 20 && graph["batch"].contains("plan"), "the files were not read: {graph:?}");
    assert_eq!(circle(graph.clone()), BTreeSet::new(), "these use each other, or what does");
    // The test sees a circle where there is one.
    let mut wrong = graph;
    wrong.get_mut("plan").unwrap().insert("batch".to_owned());
    assert!(circle(wrong).contains("plan"));
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

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Every profile of the repository with its text.
fn profiles() -> Vec<(PathBuf, String)> {
    let all = files(&root().join("profiles")).into_iter();
    all.filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| (path.clone(), std::fs::read_to_string(&path).unwrap()))
        .collect()
}

/// What is wrong with a profile, in words.
fn fault(text: &str) -> Option<String> {
    let profile = match darkroot_profile::file::parse(text) {
        Ok(profile) => profile,
        Err(error) => return Some(error.to_string()),
    };
    if profile.origin().summary.is_empty() {
        return Some("has no origin: how was it made?".to_owned());
    }
    profile.calibrations().iter().find_map(|calibration| {
        let white = calibration.model.xyz([1.0; 3]);
        let off = [white.x - white::D50.x, white.y - white::D50.y, white.z - white::D50.z];
        let wrong = off.iter().any(|d| d.abs() > 1e-6);
        wrong.then(|| format!("maps white to {white:?} under {}", calibration.light.name))
    })
}

#[test]
fn every_profile_parses_and_maps_white_to_white() {
    for (path, text) in profiles() {
        assert_eq!(fault(&text), None, "{}", path.display());
        let profile = darkroot_profile::file::parse(&text).unwrap();
        assert_eq!(
            darkroot_profile::file::parse(&darkroot_profile::file::format(&profile)).as_ref(),
            Ok(&profile)
        );
    }
}

#[test]
fn a_profile_lies_in_the_folder_of_its_maker_under_the_name_of_its_camera() {
    let plain = |s: &str| s.to_lowercase().replace(|c: char| !c.is_alphanumeric(), "");
    let mut taken = BTreeMap::new();
    for (path, text) in profiles() {
        let camera = darkroot_profile::file::parse(&text).unwrap().camera().clone();
        let folder = path.parent().unwrap().file_name().unwrap().to_string_lossy().into_owned();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        assert_eq!(plain(&folder), plain(&camera.make), "{}", path.display());
        assert!(plain(&name).contains(&plain(&camera.model)), "{}", path.display());
        assert_eq!(taken.insert(plain(&camera.name()), path.clone()), None, "{}", path.display());
    }
}

#[test]
fn a_profile_that_tints_white_is_found() {
    let good =
        std::fs::read_to_string(root().join("tests/golden/0015-root-polynomial/profile.toml")).unwrap();
    assert_eq!(fault(&good), None);
    assert!(fault(&good.replace("0.68", "0.69")).unwrap().contains("maps white to"));
    assert!(fault(&good.replace("summary = \"written", "summary = \"\" #")).unwrap().contains("origin"));
}

#[derive(Deserialize)]
struct Manifest {
    sample: Vec<Sample>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sample {
    name: String,
    sha256: String,
    licence: String,
    made: String,
}

fn manifest() -> Vec<Sample> {
    let text = std::fs::read_to_string(root().join("samples/MANIFEST.toml")).unwrap();
    toml::from_str::<Manifest>(&text).unwrap().sample
}

#[test]
fn every_sample_stands_in_the_manifest_with_its_hash_and_licence() {
    let samples = manifest();
    assert!(!samples.is_empty());
    for sample in &samples {
        let bytes = std::fs::read(root().join("samples").join(&sample.name)).unwrap();
        let hash = Sha256::digest(&bytes).iter().fold(String::new(), |mut hex, byte| {
            write!(hex, "{byte:02x}").unwrap();
            hex
        });
        assert_eq!(hash, sample.sha256, "{}", sample.name);
        assert!(!sample.licence.is_empty() && !sample.made.is_empty(), "{}", sample.name);
    }
    for path in files(&root().join("samples")) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let known = name == "README.md" || name == "MANIFEST.toml" || samples.iter().any(|s| s.name == name);
        assert!(known, "samples/{name} is not in the manifest");
    }
}

#[test]
fn every_sample_is_made_again_byte_for_byte() {
    let made = darkroot_simulate::samples::all();
    let listed = manifest();
    assert_eq!(made.len(), listed.len());
    for (made, listed) in made.iter().zip(&listed) {
        assert_eq!((made.name, made.made), (listed.name.as_str(), listed.made.as_str()));
        let stored = std::fs::read(root().join("samples").join(made.name)).unwrap();
        assert!(stored == made.bytes, "samples/{} is not what simulate makes", made.name);
    }
}

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
    assert!(all.iter().any(|path| path.ends_with("tests/tests/tidy.rs")), "the list of files is wrong");
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
