//! Settings from folders, recipes, flags and sidecars, on pictures that are really developed.

use serde_json::Value;

use super::*;
use crate::profiles::profile;

/// A raw file in a folder, and a `darkroot.toml` above both that ends the search.
fn roll() -> Desk {
    let desk = Desk::new();
    desk.put("darkroot.toml", "root = true\n");
    desk.put("roll/a.dng", small_dng());
    desk
}

/// Develops `roll/a.dng` to a PNG: its bytes, the report, the words.
fn developed(desk: &Desk, arguments: &[&str]) -> (Vec<u8>, Value, String) {
    let fixed = ["develop", "roll/a.dng", "-o", "o.png", "--overwrite", "--json"];
    let run = desk.run(&[&fixed, arguments].concat());
    assert_eq!(run.code, 0, "{arguments:?}: {}", run.err);
    (desk.read("o.png"), serde_json::from_str(&run.out).unwrap(), run.err)
}

/// The same picture from flags alone.
fn by_flags(desk: &Desk, arguments: &[&str]) -> Vec<u8> {
    developed(desk, &[&["--no-recipes"], arguments].concat()).0
}

/// Names of the files that settings were from.
fn from(report: &Value) -> Vec<String> {
    let paths = report["settings_from"].as_array().unwrap().iter();
    let name = |path: &Value| Path::new(path.as_str().unwrap()).file_name().unwrap().to_owned();
    paths.map(|path| name(path).into_string().unwrap()).collect()
}

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
fn what_is_wrong_in_a_file_is_named_with_its_line_before_anything_is_written() {
    let desk = roll();
    desk.put("b.dng", small_dng());
    let wrong = [
        ("\n\nspcae = \"srgb\"", [":3:", "`spcae`", "did you mean `space`"]),
        ("sharpen = 1", [":1:", "`sharpen`", "white-balance"]),
        ("look = \"film\"", [":1:", "`film`", "neutral, vivid, flat or linear"]),
        ("exposure = \"bright\"", [":1:", "`bright`", "-20 to 20"]),
        ("quality = 101", [":1:", "`101`", "1..=100"]),
        ("bits = 12", [":1:", "`12`", "8, 16 or 32"]),
        ("space = \"cmyk\"", [":1:", "`cmyk`", "adobe-rgb"]),
        ("auto-exposure = 1", [":1:", "a number", "true or false"]),
        ("white-balance = 5200", [":1:", "a number", "\"5200K\""]),
        ("white-balance = \"5200\"", [":1:", "`5200`", "5200K"]),
        ("look = vivid", [":1:", "not TOML", "in quotes"]),
        ("look = \"flat\"\nlook = \"flat\"", [":2:", "not TOML", "duplicate"]),
        ("format = \"darkroot profile\"", ["camera profile", "not a recipe", "--profile"]),
    ];
    for (text, words) in wrong {
        for file in ["roll/darkroot.toml", "roll/a.dng.darkroot.toml", "mine.toml"] {
            desk.put(file, text);
            let recipe = if file == "mine.toml" { &["--recipe", file][..] } else { &[] };
            let words: Vec<&str> = [file].into_iter().chain(words).collect();
            let run = desk.fails(2, &[&["develop", "b.dng", "roll/a.dng"], recipe].concat(), &words);
            assert_eq!(run.err.lines().count(), 1, "{}", run.err);
            desk.fails(2, &[&["recipe", "roll/a.dng"], recipe].concat(), &words);
            std::fs::remove_file(desk.path(file)).unwrap();
        }
    }
    desk.fails(2, &["develop", "roll/a.dng", "--recipe", "none.toml"], &["none.toml", "no such file"]);
    desk.put("roll/darkroot.toml", b"look = \"caf\xe9\"");
    desk.fails(2, &["develop", "roll/a.dng"], &["roll/darkroot.toml", "UTF-8"]);
    assert_eq!(names(&desk.path("roll")), ["a.dng", "darkroot.toml"]);
    assert_eq!(desk.names(), ["b.dng", "darkroot.toml", "roll"]);
}

#[test]
fn settings_that_contradict_each_other_name_the_file_and_where_they_are_from() {
    let desk = roll();
    desk.put("roll/darkroot.toml", "bits = 16");
    let run =
        desk.fails(2, &["develop", "roll/a.dng"], &["roll/a.dng", "roll/darkroot.toml (bits)", "only 8"]);
    assert!(!desk.path("roll/a.jpg").exists(), "{}", run.err);
    desk.develop(&["roll/a.dng", "--bits", "auto"]);
    desk.develop(&["roll/a.dng", "-o", "o.png"]);
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
fn each_file_has_the_format_of_its_own_recipe() {
    let desk = roll();
    desk.put("roll/b.nef", small_nef());
    desk.put("roll/c.dng", small_dng());
    desk.put("roll/darkroot.toml", "format = \"png\"");
    desk.put("roll/b.nef.darkroot.toml", "format = \"tiff\"");
    let files = ["roll/a.dng", "roll/b.nef", "roll/c.dng"];
    desk.develop(&[&files[..], &["-o", "out/"]].concat());
    assert_eq!(names(&desk.path("out")), ["a.png", "b.tif", "c.png"]);
    desk.develop(&[&files[..], &["-o", "out/{seq}.{ext}"]].concat());
    assert!(
        desk.read("out/0001.png").starts_with(b"\x89PNG") && desk.read("out/0002.tif").starts_with(b"II")
    );
    // With formats of their own, files of one stem do not collide.
    desk.put("roll/a.nef", small_nef());
    desk.put("roll/a.nef.darkroot.toml", "format = \"webp\"");
    desk.develop(&["roll/a.dng", "roll/a.nef", "-o", "both/"]);
    assert_eq!(names(&desk.path("both")), ["a.png", "a.webp"]);
    // Flags count more than the folder.
    desk.develop(&["roll/c.dng", "--format", "jpeg", "-o", "out/"]);
    desk.develop(&["roll/c.dng", "--format", "auto", "-o", "auto/"]);
    assert!(desk.path("out/c.jpg").exists() && desk.path("auto/c.jpg").exists());
}

#[test]
fn the_ending_of_the_output_counts_more_than_the_format_of_a_recipe_and_that_is_said() {
    let desk = roll();
    desk.put("roll/darkroot.toml", "format = \"png\"");
    for output in ["o.tif", "{stem}.tif"] {
        let run = desk.develop(&["roll/a.dng", "-o", output, "--overwrite"]);
        let note =
            "note: the output's ending counts more than the format png of roll/darkroot.toml: it is TIFF";
        assert!(run.err.contains(note), "{}", run.err);
    }
    assert!(desk.read("o.tif").starts_with(b"II") && desk.read("a.tif").starts_with(b"II"));
    let run = desk.develop(&["roll/a.dng", "-o", "o.png"]);
    assert!(!run.err.contains("note:"), "{}", run.err);
    // An ending that says nothing leaves it to the recipe.
    desk.develop(&["roll/a.dng", "-o", "o.bin"]);
    assert!(desk.read("o.bin").starts_with(b"\x89PNG"));
}

#[test]
fn a_printed_recipe_gives_the_same_picture_to_the_bit() {
    let desk = roll();
    desk.put("cameras/my.toml", profile("Darkroot", "Simulated One"));
    desk.put(
        "roll/darkroot.toml",
        "look = \"vivid\"\nexposure = +0.50\nbits = 16\nformat = \"png\"\nspace = \"display-p3\"",
    );
    desk.put("roll/a.dng.darkroot.toml", "white-balance = \"2.1,1,1.5\"\nauto-exposure = true");
    desk.put("elsewhere/a.dng", small_dng());
    for flags in [
        &[][..],
        &["--profile", "cameras/my.toml", "--highlights", "clip", "--format", "tiff"],
        &["--crop", "active", "--demosaic", "bilinear", "--exposure", "-.25", "--decoder", "rawloader"],
        &["--look", "linear", "--space", "auto", "--format", "exr", "--bits", "32", "--auto-exposure=false"],
    ] {
        desk.develop(&[&["roll/a.dng", "-o", "one/"], flags].concat());
        let printed = desk.run(&[&["recipe", "roll/a.dng"], flags].concat());
        assert_eq!((printed.code, printed.err.as_str()), (0, ""), "{flags:?}");
        desk.put("deep/er/printed.toml", &printed.out);
        desk.develop(&["elsewhere/a.dng", "-o", "two/", "--recipe", "deep/er/printed.toml"]);
        let made = names(&desk.path("one"));
        assert_eq!(names(&desk.path("two")), made, "{flags:?}");
        for name in made {
            let same = desk.read(&format!("one/{name}")) == desk.read(&format!("two/{name}"));
            assert!(same, "{flags:?}: {name}\n{}", printed.out);
        }
        // Printed again, it is the same but for the comments.
        let again = desk.run(&["recipe", "elsewhere/a.dng", "--recipe", "deep/er/printed.toml"]).out;
        let values = |text: &str| -> Vec<String> {
            text.lines().map(|l| l.split('#').next().unwrap().trim().to_owned()).collect()
        };
        assert_eq!(values(&again), values(&printed.out));
        for folder in ["one", "two"] {
            std::fs::remove_dir_all(desk.path(folder)).unwrap();
        }
    }
}

#[test]
fn a_recipe_says_where_each_value_is_from() {
    let desk = roll();
    desk.put("roll/darkroot.toml", "look = \"vivid\"");
    desk.put("roll/a.dng.darkroot.toml", "exposure = 1");
    let run = desk.run(&["recipe", "roll/a.dng", "roll/not-yet.nef", "--bits", "8"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let lines: Vec<String> =
        run.out.lines().map(|l| l.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    let (first, second) = lines.split_at(lines.iter().position(String::is_empty).unwrap());
    for line in [
        "# roll/a.dng",
        "look = \"vivid\" # roll/darkroot.toml",
        "exposure = 1 # roll/a.dng.darkroot.toml",
        "bits = 8 # command line",
        "white-balance = \"as-shot\" # default",
    ] {
        assert!(first.iter().any(|l| l == line), "no `{line}` in {}", run.out);
    }
    for line in ["# roll/not-yet.nef", "exposure = 0 # default"] {
        assert!(second.iter().any(|l| l == line), "no `{line}` in {}", run.out);
    }
    // Without a file it is about the folder.
    let here = desk.run(&["recipe", "--json"]);
    let report: Value = serde_json::from_str(&here.out).unwrap();
    assert!(report["file"].is_null() && report["settings"]["look"]["from"] == "default", "{report}");
    let report: Value = serde_json::from_str(&desk.run(&["recipe", "--json", "roll/a.dng"]).out).unwrap();
    assert_eq!(report["file"], "roll/a.dng");
    let settings = report["settings"].as_object().unwrap();
    assert_eq!(settings.len(), 15);
    assert_eq!((&settings["look"]["value"], &settings["look"]["from"]), (&"vivid".into(), &"folder".into()));
    assert!(settings["look"]["path"].as_str().unwrap().ends_with("roll/darkroot.toml"));
    assert_eq!(
        (&settings["exposure"]["value"], &settings["exposure"]["from"]),
        (&1.into(), &"sidecar".into())
    );
    assert_eq!(settings["auto-exposure"], serde_json::json!({ "value": false, "from": "default" }));
    assert_eq!(desk.names(), ["darkroot.toml", "roll"]);
}

#[test]
fn the_help_states_the_defaults_that_hold() {
    let desk = roll();
    let report: Value = serde_json::from_str(&desk.run(&["recipe", "--json"]).out).unwrap();
    for command in ["develop", "recipe"] {
        let help = desk.run(&[command, "--help"]).out;
        for (name, setting) in report["settings"].as_object().unwrap() {
            let value = setting["value"].as_str().map_or_else(|| setting["value"].to_string(), str::to_owned);
            let (_, after) = help.split_once(&format!("\n      --{name}")).unwrap();
            let own = after.split("\n      --").next().unwrap();
            let own = own.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(own.contains(&format!("[default: {value}]")), "{command} --{name}: {own}");
        }
        assert!(help.contains("--recipe <FILE>") && help.contains("--no-recipes"));
    }
}

#[test]
fn a_name_that_leaves_no_room_for_a_sidecar_is_a_name_like_any_other() {
    let desk = Desk::new();
    let name = format!("{}.dng", "x".repeat(245));
    desk.put(&name, small_dng());
    desk.develop(&[&name, "-o", "o.jpg"]);
}

#[test]
fn every_setting_is_described_and_is_an_option_with_that_default() {
    let desk = Desk::new();
    let run = desk.run(&["recipe", "--describe"]);
    let settings: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    let settings = settings.as_array().unwrap();
    let help = desk.run(&["develop", "--help"]).out;
    let recipe = desk.run(&["recipe"]).out;
    for setting in settings {
        let name = setting["name"].as_str().unwrap();
        assert!(help.contains(&format!("--{name}")), "{name} is no option");
        assert!(recipe.contains(&format!("{name} = ")), "{name} is not in a recipe");
        assert!(!setting["help"].as_str().unwrap().is_empty() && setting["allowed"].is_string(), "{name}");
    }
    let exposure = settings.iter().find(|s| s["name"] == "exposure").unwrap();
    assert_eq!((&exposure["range"], &exposure["unit"]), (&serde_json::json!([-20.0, 20.0]), &"stops".into()));
    assert_eq!(settings.len(), recipe.lines().filter(|l| l.contains(" = ")).count());
}
