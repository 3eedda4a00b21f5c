//! Decoding as callers use it. Real files are read from the folder that `DARKROOT_DATA` names.

use darkroot_photo::Counts;

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
        if name == "z9_HE" {
            // Its samples are of another codec than its note says: nobody shall show them as a picture.
            let message = decoded.unwrap_err().to_string();
            assert!(message.contains("High Efficiency (HE)") && message.contains("embedded"), "{message}");
            continue;
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

#[test]
#[cfg_attr(not(has_fixtures), ignore = "needs `fixtures` in DARKROOT_DATA")]
fn no_decoder_takes_high_efficiency_for_something_else() {
    let bytes = read(&data("fixtures").join("z9_HE.nef"));
    for decoder in [Decoder::Flashraw, Decoder::Rawloader] {
        let error = decode(&bytes, decoder, &Limits::default()).unwrap_err();
        assert!(matches!(error, Error::Compression { .. }), "{error}");
    }
    // Its headers are as readable as any.
    assert_eq!(header(&bytes, &Limits::default()).unwrap().camera.common_model, "Z 9");
}

#[test]
#[cfg_attr(not(has_raw_files), ignore = "needs `raw` in DARKROOT_DATA")]
fn a_real_floating_point_jpeg_xl_decodes_to_what_adobe_s_kit_gives() {
    let bytes = read(&data("raw").join("sony_a7r4_jxl_float16.dng"));
    let capture = decode(&bytes, Decoder::Flashraw, &Limits::default()).unwrap();
    let Counts::F32(mosaic) = &capture.counts else { panic!("integers") };
    let extremes = mosaic.samples.iter().fold((f32::MAX, f32::MIN), |(a, b), &v| (a.min(v), b.max(v)));
    let mean = mosaic.samples.iter().map(|&v| f64::from(v)).sum::<f64>() / mosaic.samples.len() as f64;
    // Adobe DNG SDK 1.7.1, stage 1: 0.57095, 5440.775, mean 152.5335.
    assert!((extremes.0 - 0.570_95).abs() < 1e-3 && (extremes.1 - 5440.775).abs() < 0.5, "{extremes:?}");
    assert!((mean - 152.5335).abs() < 1e-3, "{mean}");
    assert!(capture.notes.iter().any(|n| n.contains("transparency mask")), "{:?}", capture.notes);
}

#[test]
#[cfg_attr(not(has_raw_files), ignore = "needs `raw` in DARKROOT_DATA")]
fn noise_profiles_are_read() {
    let profile = |name: &str| {
        let bytes = read(&data("raw").join(name));
        header(&bytes, &Limits::default()).unwrap().noise_profile
    };
    let [[slope, floor]] = profile("gopro_hero7_vc5_gainmap.gpr")[..] else { panic!("one pair") };
    assert!((slope - 3.936e-4).abs() < 1e-7 && (floor - 1.2298e-7).abs() < 1e-11, "{slope:e} {floor:e}");
    assert_eq!(profile("nikon_d500_adobe_lossy_black.dng").len(), 3);
    assert!(profile("nikon_d1_uncompressed12.nef").is_empty());
}
