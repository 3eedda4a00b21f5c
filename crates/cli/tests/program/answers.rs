//! What a person writes in another way than we do gets the answer that helps.

use super::*;

#[test]
fn each_wrong_light_has_its_own_answer() {
    let desk = Desk::with_dng();
    for (light, words) in [
        ("6500", &["`6500` is no light", "did you mean `6500K`"][..]),
        ("daylight", &["did you mean `D55`"]),
        ("tungsten", &["did you mean `A`"]),
        ("TL84", &["did you mean `FL11`"]),
        ("moon", &["`moon` is no light", "LED-B3"]),
        ("lamp.csv", &["lamp.csv: cannot be read", "no such file"]),
    ] {
        let words: Vec<&str> = words.to_vec();
        desk.fails(2, &["profile", "a.dng", "--light", light], &words);
        desk.fails(2, &["verify", "Nikon D700", "a.dng", "--light", light], &words);
    }
}

#[test]
fn guesses_are_near_and_what_we_know_is_said() {
    let desk = Desk::with_dng();
    for (option, right, wrong) in [
        ("--width", "`--resize` takes", "--recipe"),
        ("--sharpening", "`--sharpen` takes", "--space"),
        ("--outdir", "`-o` says", "-- --outdir"),
        ("--force", "`--overwrite`", "-- --force"),
        ("--expsoure", "--exposure", "-- --expsoure"),
        ("--ev", "`--exposure`", "-- --ev"),
    ] {
        let run = desk.fails(2, &["develop", "a.dng", option], &[option, right]);
        assert!(!run.err.contains(wrong), "{}", run.err);
    }
    // An option that another command has is not praised here.
    let run = desk.fails(2, &["inspect", "a.dng", "--ev"], &["--ev"]);
    assert!(!run.err.contains("--exposure"), "{}", run.err);
    let run = desk.fails(2, &["developp", "a.dng"], &["develop"]);
    assert!(run.err.contains("'develop'"), "{}", run.err);
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn formats_have_the_names_of_their_endings_too() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "--format", "jpg"]);
    desk.develop(&["a.dng", "--format", "tif"]);
    desk.put("r.toml", "format = \"jpg\"");
    desk.develop(&["a.dng", "--recipe", "r.toml", "--overwrite"]);
    assert_eq!(desk.names(), ["a.dng", "a.jpg", "a.tif", "r.toml"]);
    // Both names are one setting.
    desk.put("in/a.dng", small_dng());
    let batch = |format: &str| desk.run(&["batch", "in", "-o", "out", "--format", format, "--json"]).out;
    assert!(batch("jpeg").contains(r#""done":1"#) && batch("jpg").contains(r#""unchanged":1"#));
}

#[test]
fn a_name_and_a_format_that_differ_are_an_error() {
    let desk = Desk::with_dng();
    for name in ["q.jpg", "out/{stem}.jpg"] {
        let words = [name, "JPEG", "PNG", "--format"];
        desk.fails(2, &["develop", "a.dng", "-o", name, "--format", "png"], &words);
    }
    desk.develop(&["a.dng", "-o", "q.png", "--format", "png"]);
    desk.put("in/a.dng", small_dng());
    desk.fails(2, &["batch", "in", "-o", "o", "--name", "{stem}.jpg", "--format", "png"], &["JPEG", "PNG"]);
    assert_eq!(desk.names(), ["a.dng", "in", "q.png"]);
}

#[test]
fn avif_is_said_to_have_the_bits_that_it_has() {
    let desk = Desk::with_dng();
    let run = desk.run(&["develop", "a.dng", "-o", "a.avif", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(report["bits"], 10, "{report}");
    // `pixi` says the same: three channels of so many bits.
    let file = desk.read("a.avif");
    let at = file.windows(4).position(|w| w == b"pixi").unwrap();
    assert_eq!(file[at + 8..at + 12], [3, 10, 10, 10]);
}

#[test]
fn a_file_without_a_chart_is_no_success() {
    let desk = Desk::with_dng();
    let run = desk.run(&["chart", "a.dng"]);
    assert!(run.code == 1 && run.out.contains("a.dng: no chart"), "{} {}", run.code, run.out);
}

#[test]
fn a_profile_is_named_like_its_camera() {
    let desk = Desk::new();
    let mut capture = expose(&Scene::still_life(FRAME), &Camera::nikon_d750(), &Exposure::default());
    capture.camera.model = "NIKON D700".into();
    desk.put("a.dng", dng::write(&capture, dng::Storage::Uncompressed));
    let run = desk.develop(&["a.dng", "--profile", "Nikon D700"]);
    assert!(run.err.contains("profile for Nikon D700") && run.err.contains("built in"), "{}", run.err);
    desk.put("r.toml", "profile = \"Nikon D700\"");
    desk.develop(&["a.dng", "--recipe", "r.toml", "-o", "b.jpg"]);
    assert_eq!(desk.read("a.jpg"), desk.read("b.jpg"));
    desk.fails(1, &["develop", "a.dng", "--profile", "Nikon D1", "-o", "c.jpg"], &["Nikon D1"]);
    desk.fails(1, &["develop", "a.dng", "--profile", "d700.toml", "-o", "c.jpg"], &["no such file"]);
    desk.put("in/a.dng", desk.read("a.dng"));
    assert_eq!(desk.run(&["batch", "in", "-o", "out", "--profile", "Nikon D700"]).code, 0);
    assert_eq!(desk.read("out/a.jpg"), desk.read("a.jpg"));
}

#[test]
fn develop_names_by_the_year_and_makes_the_folders_that_a_template_names() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "new/{year}/{month}-{day}/{stem}-{suffix}.{ext}"]);
    assert_eq!(names(&desk.path("new/2026/01-01")), ["a-dng.jpg"]);
    desk.develop(&["a.dng", "-o", "out/{stem}.{ext}"]);
    assert_eq!(names(&desk.path("out")), ["a.jpg"]);
}
