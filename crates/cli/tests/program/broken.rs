//! Bad inputs: an error that names the file, exit code 1, nothing written.

use super::*;

/// Develops bad files in one run: each must be named in an error, and no file may come of it.
fn refuses(desk: &Desk, files: &[String], words: &[&str]) {
    let before = desk.names();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let run = desk.fails(1, &[&["develop"], &files[..], &["-o", "out/"]].concat(), words);
    for file in &files {
        let named = run.err.lines().any(|line| line.starts_with(&format!("error: {file}: ")));
        assert!(named, "{file} is not named: {}", run.err);
    }
    assert!(names(&desk.path("out")).is_empty(), "{:?}", names(&desk.path("out")));
    std::fs::remove_dir(desk.path("out")).unwrap();
    assert_eq!(desk.names(), before);
    let inspected = desk.run(&[&["inspect"], &files[..]].concat());
    assert_eq!((inspected.code, inspected.out.as_str()), (1, ""));
}

#[test]
fn what_is_no_raw_file_is_named_for_what_it_is() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "o.jpg"]);
    desk.develop(&["a.dng", "-o", "o.png"]);
    let (jpeg, png) = (desk.read("o.jpg"), desk.read("o.png"));
    let cases: [(&[u8], &str); 6] = [
        (b"", "empty"),
        (b"Dear diary,\nno pictures today.\n", "raw file such as NEF"),
        (b"<html></html>", "text"),
        (&jpeg, "JPEG"),
        (&png, "PNG"),
        (&[0; 5000], "raw file such as NEF"),
    ];
    for (bytes, word) in cases {
        desk.put("bad.nef", bytes);
        refuses(&desk, &["bad.nef".to_owned()], &[word]);
    }
}

#[test]
fn a_picture_that_was_developed_is_no_raw_file() {
    let desk = Desk::with_dng();
    for ending in ["tif", "webp", "avif", "exr", "jxl"] {
        let name = format!("p.{ending}");
        desk.develop(&["a.dng", "-o", &name]);
        refuses(&desk, &[name], &[]);
    }
}

#[test]
fn a_file_that_is_missing_or_a_folder_is_named() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path("folder.nef")).unwrap();
    refuses(&desk, &["folder.nef".to_owned()], &["it is a folder"]);
    refuses(&desk, &["missing.nef".to_owned()], &["no such file"]);
    refuses(&desk, &["no/folder.nef".to_owned()], &["no such file"]);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(rights_count), ignore = "this user may do everything")]
fn a_file_that_must_not_be_read_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::with_dng();
    std::fs::set_permissions(desk.path("a.dng"), std::fs::Permissions::from_mode(0o000)).unwrap();
    refuses(&desk, &["a.dng".to_owned()], &["permission denied"]);
}

/// Lengths of every kind: within the header, the directories, the preview and the samples, up to the last of them.
fn lengths(whole: usize) -> Vec<usize> {
    let mut lengths = vec![0, 1, 2, 3, 4, 7, 8, 9, 10, 15, 16, 32, 64, 100, 128, 255, 256, 500, 512];
    lengths.extend([1000, 1024, 1500, 2000, 3000, 4095, 4096, 5000, 8192, 16_384, 65_536]);
    lengths.extend((1..20).map(|i| whole * i / 20));
    lengths.extend([whole - 4096, whole - 1024, whole - 100, whole - 16, whole - 2, whole - 1]);
    lengths.retain(|&length| length < whole);
    lengths
}

#[test]
fn a_sample_that_was_cut_off_anywhere_is_refused() {
    for name in ["still-life.nef", "still-life.dng"] {
        let desk = Desk::new();
        let bytes = std::fs::read(sample(name)).unwrap();
        let mut files = Vec::new();
        for length in lengths(bytes.len()) {
            let file = format!("cut-{length:07}.raw");
            desk.put(&file, &bytes[..length]);
            files.push(file);
        }
        refuses(&desk, &files, &["files failed"]);
    }
}

#[test]
fn a_file_that_was_cut_off_anywhere_is_refused_by_the_other_decoder_too() {
    let desk = Desk::new();
    let mut accepted = Vec::new();
    for length in lengths(small_dng().len()) {
        desk.put("cut.dng", &small_dng()[..length]);
        let run = desk.run(&["develop", "cut.dng", "--decoder", "rawloader", "-o", "o.jpg", "--overwrite"]);
        match run.code {
            1 => assert!(run.err.contains("error: cut.dng: "), "{}", run.err),
            _ => accepted.push(length),
        }
    }
    assert!(accepted.is_empty(), "of {} bytes these were enough: {accepted:?}", small_dng().len());
    assert_eq!(desk.names(), ["cut.dng"]);
}

#[test]
#[cfg_attr(not(has_broken_files), ignore = "needs `broken` in DARKROOT_DATA")]
fn real_broken_files_are_developed_or_refused() {
    let folder = real_files("broken");
    let desk = Desk::new();
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.to_str().unwrap();
        for decoder in ["flashraw", "rawloader"] {
            let run = desk.run(&["develop", name, "--decoder", decoder, "-o", "o.jpg"]);
            assert!(run.code <= 1, "{name}: {}", run.err);
            assert_eq!(desk.path("o.jpg").exists(), run.code == 0, "{name}: {}", run.err);
            let _ = std::fs::remove_file(desk.path("o.jpg"));
            assert!(desk.names().is_empty(), "{name} left {:?}", desk.names());
        }
        seen += 1;
    }
    assert!(seen > 0);
}
