//! What is wrong in a recipe is named with its place.

use super::*;

#[test]
fn what_is_wrong_in_a_file_is_named_with_its_line_before_anything_is_written() {
    let desk = roll();
    desk.put("b.dng", small_dng());
    let wrong = [
        ("\n\nspcae = \"srgb\"", [":3:", "`spcae`", "did you mean `space`"]),
        ("clarity = 1", [":1:", "`clarity`", "white-balance"]),
        ("look = \"film\"", [":1:", "`film`", "neutral, vivid, flat, camera, dcp, reproduction or linear"]),
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
