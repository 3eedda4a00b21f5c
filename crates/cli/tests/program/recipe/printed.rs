//! What `darkroot recipe` prints, and the help.

use super::*;

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
    assert_eq!(settings.len(), 60);
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
            let option = |end: char| help.split_once(&format!("\n      --{name}{end}"));
            let (_, after) = [' ', '[', '\n'].into_iter().find_map(option).unwrap();
            let own = after.split("\n      --").next().unwrap();
            let own = own.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(own.contains(&format!("[default: {value}]")), "{command} --{name}: {own}");
        }
        assert!(help.contains("--recipe <FILE>") && help.contains("--no-recipes"));
    }
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
