//! `docs/formats.md`: every maker's formats and what is known of each, made from the tests and checked here.
//!
//! `UPDATE_FORMATS=1 cargo test -p darkroot-tests --test formats` reads the real files in DARKROOT_DATA, notes them in
//! `tests/formats.toml`, and writes the page. Without that the page must be what it would write; and where the real files are,
//! each must decode to what is noted of it.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.

mod known;
mod page;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use darkroot_photo::{Capture, Layout};
use darkroot_raw::{Decoder, Limits, decode, samples_hash};
use darkroot_tests::root;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use known::Synthetic;

/// Samples of the largest file that is read here: 400 million.
const LARGEST: u64 = 400_000_000;

/// A file from a camera, or from a program that wrote it from one, and what it decodes to.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Real {
    file: String,
    sha256: String,
    maker: String,
    camera: String,
    kind: String,
    /// Hash of the samples; none where they are coded with loss, which decoders round in their own ways.
    samples: Option<String>,
}

#[derive(Debug, Default, Deserialize, Serialize)]
struct Notes {
    #[serde(default)]
    real: Vec<Real>,
}

fn noted() -> Notes {
    toml::from_str(&std::fs::read_to_string(root().join("tests/formats.toml")).unwrap_or_default()).unwrap()
}

/// What a capture says of its file: container, compression, bits, layout.
fn kind(capture: &Capture) -> String {
    let source = &capture.source;
    let layout = match capture.counts.layout() {
        Layout::Cfa(cfa) => cfa.to_string(),
        Layout::Rgb => "linear RGB".to_owned(),
        Layout::Monochrome => "monochrome".to_owned(),
    };
    let float = if matches!(capture.counts, darkroot_photo::Counts::F32(_)) { " floating point" } else { "" };
    format!("{}, {}, {} bits{float}, {layout}", source.format, source.compression, source.bits)
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut hex, byte| {
        write!(hex, "{byte:02x}").unwrap();
        hex
    })
}

/// Decodes a real file.
fn read(path: &Path) -> Real {
    let bytes = std::fs::read(path).unwrap();
    let limits = Limits { max_samples: LARGEST, ..Limits::default() };
    let capture = decode(&bytes, Decoder::Flashraw, &limits).unwrap_or_else(|e| panic!("{path:?}: {e}"));
    let lossy = ["lossy JPEG", "JPEG XL", "Vc5"].iter().any(|c| capture.source.compression.contains(c));
    let maker = match capture.camera.common_make.as_str() {
        "" => "(no maker)".to_owned(),
        maker => maker.to_owned(),
    };
    Real {
        file: path.file_name().unwrap().to_string_lossy().into_owned(),
        sha256: hex(&bytes),
        maker,
        camera: capture.camera.name(),
        kind: kind(&capture),
        samples: (!lossy).then(|| format!("{:016x}", samples_hash(&capture.counts))),
    }
}

/// All real files at hand; those that are no raw files are left out by their names.
fn real_files() -> Vec<Real> {
    let folder = darkroot_tests::real_files("raw");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e != "tsv"));
    paths.sort();
    paths.iter().map(|path| read(path)).collect()
}

#[test]
fn the_page_is_what_the_tests_say() {
    if std::env::var_os("UPDATE_FORMATS").is_some() {
        let text = toml::to_string(&Notes { real: real_files() }).unwrap();
        let head = "# Real files at hand and what they decode to: made by `cargo test -p darkroot-tests --test formats`.\n";
        std::fs::write(root().join("tests/formats.toml"), format!("{head}\n{text}")).unwrap();
        std::fs::write(root().join("docs/formats.md"), page::page(&noted().real)).unwrap();
    }
    let stored = std::fs::read_to_string(root().join("docs/formats.md")).unwrap();
    let wanted = page::page(&noted().real);
    assert!(
        stored == wanted,
        "docs/formats.md is old: UPDATE_FORMATS=1 cargo test -p darkroot-tests --test formats"
    );
    // A page that says little would pass as well.
    assert!(stored.matches("real file").count() > 15 && stored.matches("untested").count() > 15);
}

#[test]
#[cfg_attr(not(has_raw_files), ignore = "needs `raw` in DARKROOT_DATA")]
fn every_real_file_decodes_to_what_is_noted_of_it() {
    if std::env::var_os("UPDATE_FORMATS").is_some() {
        return; // They are being noted.
    }
    let noted = noted().real;
    let by_name: BTreeMap<&str, &Real> = noted.iter().map(|real| (real.file.as_str(), real)).collect();
    for real in real_files() {
        assert_eq!(
            by_name.get(real.file.as_str()),
            Some(&&real),
            "{}: note it by UPDATE_FORMATS=1",
            real.file
        );
    }
}

#[test]
fn every_test_that_the_page_names_is_there_and_runs() {
    for Synthetic { kind, file, test, .. } in known::SYNTHETIC {
        let text = std::fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        if file.ends_with(".py") {
            assert!(text.contains(test), "{kind}: {file} has no {test}");
            continue;
        }
        let at = text.find(&format!("fn {test}()")).unwrap_or_else(|| panic!("{kind}: no {test} in {file}"));
        let before = text[..at].rsplit("\n\n").next().unwrap();
        assert!(before.contains("#[test]"), "{test} is no test");
        assert!(!before.contains("#[ignore"), "{test} does not run");
    }
}
