//! The look that a profile brings along.

use super::*;

/// A profile of the simulated camera; what is appended says how its maker would show its colours.
fn profile(version: u8, rendering: &str) -> String {
    format!(
        r#"format = "darkroot profile"
version = {version}

[camera]
make = "Darkroot"
model = "Simulated One"

[[calibration]]
light = "D65"
xy = [0.3127, 0.3290]
model = "linear"

[calibration.terms]
r = [0.62, 0.24, 0.02]
g = [0.22, 0.80, 0.05]
b = [0.13, -0.04, 0.75]
{rendering}"#
    )
}

/// Greys twice as bright, nothing else.
const BRIGHT: &str = "\n[rendering]\ncurve = [[0.0, 0.0], [0.25, 0.5], [0.5, 1.0], [1.0, 1.0]]\n";
/// No colour is left.
const GREY: &str = "\n[rendering]\nexposure = 1.0\n\n[rendering.look]\ndivisions = [1, 2, 1]\ncoded = false\nnodes = [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]\n";

fn pixels(desk: &Desk, name: &str) -> Vec<[u16; 3]> {
    image::open(desk.path(name)).unwrap().into_rgb16().pixels().map(|p| p.0).collect()
}

fn mean(pixels: &[[u16; 3]]) -> f64 {
    pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64
}

#[test]
fn a_profile_shows_its_colours_as_it_says_in_files_and_in_batches() {
    let desk = Desk::with_dng();
    desk.put("bright.toml", profile(3, BRIGHT));
    desk.put("grey.toml", profile(3, GREY));
    let develop = |name: &str, options: &[&str]| {
        desk.develop(&[&["a.dng", "-o", name, "--bits", "16", "--profile"], options].concat());
        pixels(&desk, name)
    };
    let measured = develop("measured.png", &["bright.toml", "--look", "reproduction"]);
    let bright = develop("bright.png", &["bright.toml", "--look", "dcp"]);
    let darker = develop("darker.png", &["bright.toml", "--look", "dcp", "--shadows", "-1"]);
    assert!(mean(&bright) > 1.2 * mean(&measured) && mean(&darker) < 0.98 * mean(&bright));
    let grey = develop("grey.png", &["grey.toml", "--look", "dcp"]);
    assert!(grey.iter().all(|p| p[0].abs_diff(p[1]).max(p[1].abs_diff(p[2])) < 40));
    // A recipe asks for it as well, and a batch makes pictures anew when the look of the profile has changed.
    desk.put("roll/a.dng", small_dng());
    desk.put("roll/darkroot.toml", "look = \"dcp\"\nbits = 16\nprofile = \"../look.toml\"\n");
    desk.put("look.toml", profile(3, BRIGHT));
    let batch = || {
        let run = desk.run(&["batch", "roll", "-o", "out", "--format", "png"]);
        assert_eq!(run.code, 0, "{}", run.err);
        pixels(&desk, "out/a.png")
    };
    assert_eq!(batch(), bright);
    desk.put("look.toml", profile(3, GREY));
    assert_eq!(batch(), grey);
}

#[test]
fn a_profile_that_says_nothing_of_looks_is_a_sentence() {
    let desk = Desk::with_dng();
    desk.put("plain.toml", profile(1, ""));
    desk.put("broken.toml", profile(3, &BRIGHT.replace("0.25", "0.75")));
    for (options, words) in [
        (&["--profile", "plain.toml"][..], &["a.dng", "tone curve", ".dcp"][..]),
        (&["--profile", "matrix"], &["a.dng", "tone curve"]),
        (&[], &["a.dng", "tone curve"]),
        (&["--profile", "broken.toml"], &["broken.toml", "[rendering]"]),
        (&["--profile", "plain.toml", "--from-preview"], &["look"]),
    ] {
        let run = desk.run(&[&["develop", "a.dng", "-o", "o.png", "--look", "dcp"], options].concat());
        assert_ne!(run.code, 0, "{options:?}");
        for word in words {
            assert!(run.err.contains(word), "{options:?} says nothing of `{word}`: {}", run.err);
        }
    }
}
