//! Decoding as callers use it. Real files are read from the folder that `DARKROOT_DATA` names.

use super::*;

/// A folder of real test files. Tests that need one are ignored where it is not (`tests/build.rs`).
fn data(folder: &str) -> std::path::PathBuf {
    let top = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    top.join(std::env::var_os("DARKROOT_DATA").unwrap()).join(folder)
}

fn read(path: &std::path::Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

#[test]
fn what_is_no_raw_file_is_named() {
    for (bytes, word) in [
        (&b""[..], "empty"),
        (b"\xff\xd8\xff\xe0 and so on", "JPEG"),
        (b"\x89PNG\r\n", "PNG"),
        (b"<html>", "text"),
        (b"0123456789", "not known"),
    ] {
        let message = decode(bytes, Decoder::Flashraw, &Limits::default()).unwrap_err().to_string();
        assert!(message.contains(word) && message.contains("give a raw file"), "{message}");
    }
}

#[test]
fn directories_that_point_at_themselves_are_refused() {
    // A little-endian TIFF whose only directory has itself as sub-directory.
    let mut bytes = b"II\x2a\0\x08\0\0\0\x01\0\x4a\x01\x04\0\x01\0\0\0\x08\0\0\0".to_vec();
    bytes.extend([0; 8]);
    for decoder in [Decoder::Flashraw, Decoder::Rawloader] {
        let error = decode(&bytes, decoder, &Limits::default()).unwrap_err();
        assert!(error.to_string().contains("point back"), "{error}");
    }
}

#[test]
#[cfg_attr(not(has_fixtures), ignore = "needs `fixtures` in DARKROOT_DATA")]
fn fixtures_decode_to_their_true_samples() {
    let folder = data("fixtures");
    let truth = std::fs::read_to_string(folder.join("truth.txt")).unwrap();
    let mut exact = 0;
    for line in truth.lines() {
        let mut words = line.split_whitespace();
        let (name, hash) = (words.next().unwrap(), words.next().unwrap());
        let path =
            ["dng", "nef"].map(|e| folder.join(format!("{name}.{e}"))).into_iter().find(|p| p.exists());
        let decoded = decode(&read(&path.unwrap()), Decoder::Flashraw, &Limits::default());
        if name == "d750_12_unc_le" {
            continue; // Decoders disagree on the bit order of little-endian packed NEF; no truth to hold to.
        }
        let capture = decoded.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(format!("{:016x}", samples_hash(&capture.counts)), hash, "{name}");
        exact += 1;
    }
    assert!(exact > 40, "{exact}");
}

#[test]
#[cfg_attr(not(has_fixtures), ignore = "needs `fixtures` in DARKROOT_DATA")]
fn rawloader_gives_the_same_samples_or_declines() {
    let folder = data("fixtures");
    let truth = std::fs::read_to_string(folder.join("truth.txt")).unwrap();
    let (mut same, mut declined) = (0, 0);
    for line in truth.lines() {
        let mut words = line.split_whitespace();
        let (name, hash) = (words.next().unwrap(), words.next().unwrap());
        let path = folder.join(format!("{name}.dng"));
        if !path.exists() {
            continue; // rawloader dithers NEF on purpose.
        }
        match decode(&read(&path), Decoder::Rawloader, &Limits::default()) {
            Ok(c) => {
                assert_eq!(format!("{:016x}", samples_hash(&c.counts)), hash, "{name}");
                same += 1;
            }
            Err(e) => {
                eprintln!("{name} {e}");
                declined += 1;
            }
        }
    }
    assert!(same >= 10 && declined > 0, "{same} same, {declined} declined");
}

#[test]
#[cfg_attr(not(has_broken_files), ignore = "needs `broken` in DARKROOT_DATA")]
fn broken_files_are_errors_with_a_sentence() {
    let folder = data("broken");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        for decoder in [Decoder::Flashraw, Decoder::Rawloader] {
            match decode(&read(&path), decoder, &Limits::default()) {
                Ok(c) => eprintln!("{} decodes: {:?}", path.display(), c.counts.size()),
                Err(e) => assert!(e.to_string().len() > 20, "{}: {e}", path.display()),
            }
        }
    }
}

#[test]
#[cfg_attr(not(has_fixtures), ignore = "needs `fixtures` in DARKROOT_DATA")]
fn a_file_beyond_the_limit_is_refused() {
    let folder = data("fixtures");
    let limits = Limits { max_samples: 100, ..Limits::default() };
    let error = decode(&read(&folder.join("u16le.dng")), Decoder::Flashraw, &limits).unwrap_err();
    assert!(matches!(error, Error::TooLarge(_)), "{error}");
}
