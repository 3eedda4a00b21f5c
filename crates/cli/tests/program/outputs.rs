//! Where pictures go, and what is never written over.

use super::*;

/// Fails unless the file is a picture of the expected size.
fn is_a_picture(desk: &Desk, name: &str) {
    let picture = image::open(desk.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!((picture.width(), picture.height()), (WIDTH, HEIGHT), "{name}");
}

#[test]
fn without_options_the_picture_lies_beside_its_raw_file_as_a_jpeg() {
    let desk = Desk::new();
    desk.put("roll/DSC_1.v2.DNG", small_dng());
    desk.develop(&["roll/DSC_1.v2.DNG"]);
    assert_eq!(names(&desk.path("roll")), ["DSC_1.v2.DNG", "DSC_1.v2.jpg"]);
    assert!(desk.read("roll/DSC_1.v2.jpg").starts_with(&[0xff, 0xd8, 0xff]));
    is_a_picture(&desk, "roll/DSC_1.v2.jpg");
    assert_eq!(desk.read("roll/DSC_1.v2.DNG"), small_dng());
}

#[test]
fn the_ending_of_the_output_chooses_the_format() {
    let desk = Desk::with_dng();
    let starts: [(&str, &[u8]); 10] = [
        ("o.jpg", &[0xff, 0xd8]),
        ("o.JPEG", &[0xff, 0xd8]),
        ("o.png", b"\x89PNG"),
        ("o.tif", b"II"),
        ("o.TIFF", b"II"),
        ("o.webp", b"RIFF"),
        ("o.avif", b"\0\0\0"),
        ("o.exr", &[0x76, 0x2f, 0x31, 0x01]),
        ("o.jxl", &[]),
        ("o.dng", b"II*\0"),
    ];
    for (name, start) in starts {
        desk.develop(&["a.dng", "-o", name]);
        assert!(desk.read(name).starts_with(start), "{name}");
    }
}

#[test]
fn the_format_that_is_named_counts_more_than_the_ending() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "picture.bin", "--format", "png"]);
    assert!(desk.read("picture.bin").starts_with(b"\x89PNG"));
    desk.develop(&["a.dng", "--format", "tiff"]);
    is_a_picture(&desk, "a.tif");
}

#[test]
fn a_folder_takes_all_pictures() {
    let desk = Desk::with_dng();
    desk.put("b.nef", small_nef());
    std::fs::create_dir(desk.path("there")).unwrap();
    desk.develop(&["a.dng", "b.nef", "-o", "there"]);
    assert_eq!(names(&desk.path("there")), ["a.jpg", "b.jpg"]);
    // A name that ends like a folder is made.
    desk.develop(&["a.dng", "b.nef", "-o", "new/deep/", "--format", "png"]);
    assert_eq!(names(&desk.path("new/deep")), ["a.png", "b.png"]);
}

#[test]
fn a_template_names_each_picture() {
    let desk = Desk::new();
    desk.put("roll 7/a.dng", small_dng());
    desk.put("roll 7/b.nef", small_nef());
    std::fs::create_dir(desk.path("out")).unwrap();
    let template = "out/{parent}-{stem}-{camera}-{date}-{seq}.{ext}";
    desk.develop(&["roll 7/a.dng", "roll 7/b.nef", "-o", template, "--format", "png"]);
    assert_eq!(
        names(&desk.path("out")),
        ["roll 7-a-Darkroot_Simulated_One-2026-01-01-0001.png", "roll 7-b-Nikon_D750-2026-01-01-0002.png"]
    );
}

#[test]
fn a_template_with_a_wrong_placeholder_is_refused() {
    let desk = Desk::with_dng();
    for template in ["{name}.jpg", "{stem.jpg", "{}.jpg"] {
        desk.fails(2, &["develop", "a.dng", "-o", template], &["placeholder", "{stem}"]);
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn an_ending_that_names_no_format_is_refused() {
    let desk = Desk::with_dng();
    for name in ["o.bmp", "o", "o.nef", "{stem}"] {
        desk.fails(2, &["develop", "a.dng", "-o", name], &["ending", ".jpg", "--format"]);
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn an_output_that_exists_stays_as_it_is() {
    let desk = Desk::with_dng();
    desk.put("a.jpg", "precious");
    desk.fails(1, &["develop", "a.dng"], &["a.jpg", "exists already", "--overwrite", "-o"]);
    assert_eq!(desk.read("a.jpg"), b"precious");
    assert_eq!(desk.names(), ["a.dng", "a.jpg"]);
    desk.develop(&["a.dng", "--overwrite"]);
    is_a_picture(&desk, "a.jpg");
    assert_eq!(desk.names(), ["a.dng", "a.jpg"]);
}

#[test]
fn an_output_that_exists_stays_when_its_raw_file_cannot_be_read() {
    let desk = Desk::new();
    desk.put("a.dng", &small_dng()[..2000]);
    desk.put("a.jpg", "precious");
    desk.fails(1, &["develop", "a.dng", "--overwrite"], &["a.dng"]);
    assert_eq!(desk.read("a.jpg"), b"precious");
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_nowhere_counts_as_an_output_that_exists() {
    let desk = Desk::with_dng();
    std::os::unix::fs::symlink("nowhere", desk.path("a.jpg")).unwrap();
    desk.fails(1, &["develop", "a.dng"], &["exists already"]);
    assert_eq!(desk.names(), ["a.dng", "a.jpg"]);
}

#[cfg(unix)]
#[test]
fn an_output_that_is_a_link_to_the_raw_file_leaves_the_raw_file_whole() {
    let desk = Desk::with_dng();
    std::os::unix::fs::symlink("a.dng", desk.path("a.jpg")).unwrap();
    desk.run(&["develop", "a.dng", "--overwrite"]);
    assert_eq!(desk.read("a.dng"), small_dng());
}

#[test]
fn two_inputs_for_one_output_are_refused_before_anything_is_written() {
    let desk = Desk::with_dng();
    desk.put("a.nef", small_nef());
    desk.put("sub/A.dng", small_dng());
    let same: [&[&str]; 5] = [
        &["a.dng", "a.nef"],
        &["a.dng", "a.dng"],
        &["a.dng", "./a.dng"],
        &["a.dng", "sub/A.dng", "-o", "out/"], // Only their case differs.
        &["a.dng", "sub/A.dng", "-o", "one.jpg"],
    ];
    for arguments in same {
        let words = ["would both be written to", "{seq}"];
        desk.fails(2, &[&["develop"], arguments].concat(), &words);
    }
    assert_eq!(desk.names(), ["a.dng", "a.nef", "sub"]);
}

#[test]
fn an_output_over_its_own_input_is_refused() {
    let desk = Desk::with_dng();
    desk.put("sub/x.dng", small_dng());
    for output in ["a.dng", "./a.dng", "sub/../a.dng", "{stem}.dng"] {
        let arguments = ["develop", "a.dng", "--overwrite", "--format", "dng", "-o", output];
        desk.fails(2, &arguments, &["would be overwritten"]);
    }
    assert_eq!(desk.read("a.dng"), small_dng());
}

#[test]
fn an_output_over_another_input_is_refused() {
    let desk = Desk::new();
    desk.put("0001.dng", small_dng());
    desk.put("0002.dng", small_dng());
    let arguments = ["develop", "0002.dng", "0001.dng", "--overwrite", "--format", "jpeg", "-o", "{seq}.dng"];
    let run = desk.run(&arguments);
    assert!(desk.read("0001.dng") == small_dng(), "the raw file 0001.dng is gone: {}", run.err);
    assert!(desk.read("0002.dng") == small_dng(), "the raw file 0002.dng is gone: {}", run.err);
    assert_eq!(run.code, 2, "{}", run.err);
}

#[test]
fn a_folder_that_does_not_exist_is_named() {
    let desk = Desk::with_dng();
    desk.fails(1, &["develop", "a.dng", "-o", "no/o.jpg"], &["no", "folder does not exist", "create it"]);
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn a_folder_under_a_file_cannot_be_made() {
    let desk = Desk::with_dng();
    desk.put("file", "");
    let run = desk.fails(2, &["develop", "a.dng", "-o", "file/sub/"], &["file/sub", "-o"]);
    assert!(run.err.contains("cannot be made"), "{}", run.err);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(rights_count), ignore = "this user may do everything")]
fn a_folder_that_must_not_be_written_to_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::with_dng();
    let locked = desk.path("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o555)).unwrap();
    desk.fails(1, &["develop", "a.dng", "-o", "locked/a.jpg"], &["locked/a.jpg", "permission denied", "-o"]);
    assert!(names(&locked).is_empty());
}

#[cfg(unix)]
#[test]
fn a_picture_has_the_rights_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::with_dng();
    desk.put("any", "");
    desk.develop(&["a.dng"]);
    let mode = |name| std::fs::metadata(desk.path(name)).unwrap().permissions().mode();
    assert_eq!(mode("a.jpg"), mode("any"));
}

#[test]
fn the_other_files_go_on_after_a_bad_one() {
    let desk = Desk::with_dng();
    desk.put("bad.dng", "no raw file");
    desk.put("c.nef", small_nef());
    let run =
        desk.fails(1, &["develop", "bad.dng", "a.dng", "missing.nef", "c.nef"], &["bad.dng", "missing.nef"]);
    assert!(run.err.contains("2 of 4 files failed"), "{}", run.err);
    is_a_picture(&desk, "a.jpg");
    assert_eq!(desk.names(), ["a.dng", "a.jpg", "bad.dng", "c.jpg", "c.nef"]);
}

#[test]
fn names_with_spaces_umlauts_and_dashes_are_names_like_any_other() {
    let desk = Desk::new();
    for name in ["a b.dng", "Zoë 日本.dng", "-x.dng"] {
        desk.put(name, small_dng());
        desk.develop(&["-o", "out/", "--overwrite", "--", name]);
    }
    assert_eq!(names(&desk.path("out")), ["-x.jpg", "Zoë 日本.jpg", "a b.jpg"].map(String::from));
}

#[cfg(target_os = "linux")]
fn not_utf_8(desk: &Desk, arguments: &[&str]) -> Run {
    use std::os::unix::ffi::OsStrExt;
    let name = |bytes| desk.folder.path().join(std::ffi::OsStr::from_bytes(bytes));
    std::fs::write(name(b"caf\xe9.dng"), small_dng()).unwrap();
    let output = desk.command(arguments).arg(name(b"caf\xe9.dng")).output().unwrap();
    assert!(name(b"caf\xe9.jpg").exists());
    Run::of(&output, arguments)
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_utf_8_is_a_name_like_any_other() {
    let run = not_utf_8(&Desk::new(), &["develop"]);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_utf_8_is_reported_as_well_as_json_can() {
    let run = not_utf_8(&Desk::new(), &["develop", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("\"done\""), "{}", run.out);
}

#[test]
fn the_same_file_developed_twice_is_the_same_to_the_byte() {
    let desk = Desk::with_dng();
    for ending in ["jpg", "png", "tif", "webp", "avif", "exr", "jxl", "dng"] {
        let (one, two) = (format!("1.{ending}"), format!("2.{ending}"));
        desk.develop(&["a.dng", "-o", &one, "--threads", "1"]);
        desk.develop(&["a.dng", "-o", &two, "--threads", "3"]);
        assert!(desk.read(&one) == desk.read(&two), "{ending}");
    }
}

#[test]
fn tones_of_a_look_are_changed_as_asked() {
    let desk = Desk::with_dng();
    let mean = |options: &[&str]| {
        desk.develop(&[&["a.dng", "-o", "o.png", "--overwrite"], options].concat());
        let picture = image::open(desk.path("o.png")).unwrap().to_rgb8();
        let channel = |c: usize| picture.pixels().map(|p| f64::from(p[c])).sum::<f64>();
        let spread =
            picture.pixels().map(|p| f64::from(p.0.iter().max().unwrap() - p.0.iter().min().unwrap()));
        (channel(0) + channel(1) + channel(2), spread.sum::<f64>())
    };
    let (light, spread) = mean(&[]);
    assert!(mean(&["--shadows", "1"]).0 > 1.05 * light);
    assert!(mean(&["--highlights-tone", "-1.5"]).0 < 0.98 * light);
    assert!(mean(&["--saturation", "1.5"]).1 > 1.2 * spread);
    assert!(mean(&["--saturation", "0"]).1 < 0.02 * spread);
    assert!(mean(&["--vibrance", "1"]).1 > 1.05 * spread);
}

#[test]
fn a_curve_by_points_darkens_what_it_shall_and_needs_a_look() {
    let desk = Desk::with_dng();
    let mean = |name: &str| {
        let picture = image::open(desk.path(name)).unwrap().to_rgb8();
        picture.iter().map(|&v| f64::from(v)).sum::<f64>() / picture.len() as f64
    };
    desk.develop(&["a.dng", "-o", "plain.png"]);
    desk.develop(&["a.dng", "-o", "same.png", "--curve", "50:50"]);
    desk.develop(&["a.dng", "-o", "dark.png", "--curve", "20:10, 50:30"]);
    assert!((mean("same.png") - mean("plain.png")).abs() < 0.1);
    assert!(mean("dark.png") < mean("plain.png") - 10.0);
    desk.put("r.toml", "curve = \"20:10,50:30\"\n");
    desk.develop(&["a.dng", "-o", "recipe.png", "--recipe", "r.toml"]);
    assert!(desk.read("recipe.png") == desk.read("dark.png"));
    for wrong in ["50", "50:x", "50:60,60:50", "20:10,20:30", "0:101"] {
        desk.fails(2, &["develop", "a.dng", "--curve", wrong], &["curve", "BEFORE:AFTER"]);
    }
    desk.fails(2, &["develop", "a.dng", "-o", "o.tif", "--look", "linear", "--curve", "50:40"], &["curve"]);
}
