//! Which settings count where several are given.

use super::*;

#[test]
fn each_layer_counts_more_than_the_one_before() {
    let desk = roll();
    let (plain, report, words) = developed(&desk, &[]);
    assert!(
        plain == by_flags(&desk, &[]) && from(&report).is_empty() && !words.contains("settings:"),
        "{words}"
    );

    let steps: [(&str, &str, &[&str], &[&str]); 5] = [
        ("darkroot.toml", "1", &[], &["darkroot.toml"]),
        ("roll/darkroot.toml", "2", &[], &["darkroot.toml"]),
        ("mine.toml", "3", &["--recipe", "mine.toml"], &["mine.toml"]),
        ("", "4", &["--recipe", "mine.toml", "--exposure", "4"], &[]),
        (
            "roll/a.dng.darkroot.toml",
            "0.5",
            &["--recipe", "mine.toml", "--exposure", "4"],
            &["a.dng.darkroot.toml"],
        ),
    ];
    for (file, stops, arguments, sources) in steps {
        if !file.is_empty() {
            let root = if file == "darkroot.toml" { "root = true\n" } else { "" };
            desk.put(file, format!("{root}exposure = {stops}\n"));
        }
        let (picture, report, _) = developed(&desk, arguments);
        assert!(picture == by_flags(&desk, &["--exposure", stops]), "{file}");
        let gain = f64::exp2(stops.parse().unwrap());
        assert!((report["gain"].as_f64().unwrap() / gain - 1.0).abs() < 1e-5, "{file}: {report}");
        assert_eq!(from(&report), sources, "{file}");
    }
}

#[test]
fn layers_are_put_together_key_by_key() {
    let desk = roll();
    desk.put("darkroot.toml", "root = true\nlook = \"vivid\"\nexposure = 1\nbits = 16");
    desk.put("roll/darkroot.toml", "exposure = -0.5");
    desk.put("mine.toml", "highlights = \"clip\"\ndemosaic = \"best\"");
    desk.put("roll/a.dng.darkroot.toml", "white-balance = \"3200K,+8\"");
    let (picture, report, words) = developed(&desk, &["--recipe", "mine.toml", "--demosaic", "bilinear"]);
    let flags = ["--look", "vivid", "--exposure", "-0.5", "--bits", "16", "--highlights", "clip"];
    let more = ["--demosaic", "bilinear", "--wb", "3200K,+8"];
    assert!(picture == by_flags(&desk, &[&flags[..], &more].concat()));
    assert_eq!(from(&report), ["darkroot.toml", "darkroot.toml", "mine.toml", "a.dng.darkroot.toml"]);
    let line = words.lines().find(|l| l.contains("settings: ")).unwrap();
    assert_eq!(
        line.trim(),
        "settings: darkroot.toml (bits, look); roll/darkroot.toml (exposure); mine.toml (highlights); \
         roll/a.dng.darkroot.toml (white-balance)"
    );
}

#[test]
fn a_sidecar_is_for_its_file_only() {
    let desk = roll();
    desk.put("roll/b.dng", small_dng());
    desk.put("roll/b.dng.darkroot.toml", "look = \"flat\"");
    let run = desk.develop(&["roll/a.dng", "roll/b.dng", "-o", "out/"]);
    assert_eq!(run.err.matches("settings: ").count(), 1, "{}", run.err);
    assert!(run.err.contains("settings: roll/b.dng.darkroot.toml (look)"), "{}", run.err);
    assert!(desk.read("out/a.jpg") != desk.read("out/b.jpg"));
    desk.develop(&["roll/b.dng", "--look", "neutral", "--no-recipes", "-o", "c.jpg"]);
    assert!(desk.read("out/a.jpg") == desk.read("c.jpg"));
}

#[test]
fn a_flag_that_a_sidecar_overrules_is_said() {
    let desk = roll();
    desk.put("roll/a.dng.darkroot.toml", "exposure = 1\nlook = \"vivid\"");
    let (_, report, words) = developed(&desk, &["--exposure", "2", "--look", "vivid"]);
    let note = "`--exposure 2` is overruled by roll/a.dng.darkroot.toml: exposure 1";
    assert!(words.contains(&format!("note: {note}")), "{words}");
    assert_eq!(report["notes"].as_array().unwrap(), &[Value::from(note)]);
}

#[test]
fn a_root_ends_the_search_upwards() {
    let desk = roll();
    desk.put("darkroot.toml", "root = true\nlook = \"flat\"");
    desk.put("roll/darkroot.toml", "root = true\nexposure = 1");
    assert!(developed(&desk, &[]).0 == by_flags(&desk, &["--exposure", "1"]));
    desk.put("roll/darkroot.toml", "root = false\nexposure = 1");
    assert!(developed(&desk, &[]).0 == by_flags(&desk, &["--exposure", "1", "--look", "flat"]));
    for file in ["mine.toml", "roll/a.dng.darkroot.toml"] {
        desk.put(file, "\nroot = true");
        let arguments = ["develop", "roll/a.dng", "--recipe", "mine.toml"];
        desk.fails(2, &arguments, &[&format!("{file}:2:"), "`root`", "darkroot.toml"]);
        desk.put(file, "");
    }
}

#[test]
fn a_relative_profile_lies_beside_the_file_that_names_it() {
    let desk = roll();
    desk.put("cameras/my.toml", profile("Darkroot", "Simulated One"));
    let flag = by_flags(&desk, &["--profile", "cameras/my.toml"]);
    let matrix = by_flags(&desk, &["--profile", "matrix"]);
    assert!(flag != matrix);
    for (file, path, arguments) in [
        ("darkroot.toml", "cameras/my.toml", &[][..]),
        ("roll/darkroot.toml", "../cameras/my.toml", &[]),
        ("cameras/recipe.toml", "my.toml", &["--recipe", "cameras/recipe.toml"]),
        ("roll/a.dng.darkroot.toml", "../cameras/my.toml", &[]),
    ] {
        desk.put(file, format!("profile = \"{path}\""));
        let (picture, report, _) = developed(&desk, arguments);
        assert!(picture == flag, "{file}");
        assert!(report["profile"].as_str().unwrap().ends_with("my.toml"), "{file}");
        // A word stays a word, even where a file has that name.
        desk.put(Path::new(file).parent().unwrap().join("matrix").to_str().unwrap(), "");
        desk.put(file, "profile = \"matrix\"");
        assert!(developed(&desk, arguments).0 == matrix, "{file}");
        std::fs::remove_file(desk.path(file)).unwrap();
    }
    desk.put("roll/darkroot.toml", "profile = \"none.toml\"");
    desk.fails(1, &["develop", "roll/a.dng"], &["roll/none.toml"]);
}

#[test]
fn without_recipes_nothing_in_folders_counts() {
    let desk = roll();
    let plain = by_flags(&desk, &[]);
    desk.put("roll/darkroot.toml", "look = \"film\"");
    desk.put("roll/a.dng.darkroot.toml", "nonsense");
    let (picture, report, words) = developed(&desk, &["--no-recipes"]);
    assert!(picture == plain && from(&report).is_empty() && !words.contains("settings:"), "{words}");
    // What is named counts.
    desk.put("mine.toml", "exposure = 1");
    let (named, report, _) = developed(&desk, &["--no-recipes", "--recipe", "mine.toml"]);
    assert!(named == by_flags(&desk, &["--exposure", "1"]) && from(&report) == ["mine.toml"]);
}

#[test]
fn a_flag_can_take_back_what_a_recipe_says() {
    let desk = roll();
    desk.put(
        "roll/darkroot.toml",
        "auto-exposure = true\nformat = \"png\"\nspace = \"rec2020\"\nbits = 16\nprofile = \"none.toml\"",
    );
    let flags = ["--auto-exposure=false", "--space", "auto", "--bits", "auto", "--profile", "auto"];
    assert!(developed(&desk, &flags).0 == by_flags(&desk, &[]));
    let desk = roll();
    assert!(by_flags(&desk, &["--auto-exposure"]) == by_flags(&desk, &["--auto-exposure=true"]));
    assert!(by_flags(&desk, &["--auto-exposure"]) != by_flags(&desk, &[]));
}

#[test]
fn a_name_that_leaves_no_room_for_a_sidecar_is_a_name_like_any_other() {
    let desk = Desk::new();
    let name = format!("{}.dng", "x".repeat(245));
    desk.put(&name, small_dng());
    desk.develop(&[&name, "-o", "o.jpg"]);
}
