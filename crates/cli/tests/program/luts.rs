//! Tables that are laid over a look.

use super::*;

/// A `.cube` file that swaps red and blue.
const SWAP: &str = "LUT_3D_SIZE 2\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n";
/// A curve for all channels: half as bright, coded.
const DARKER: &str = "LUT_1D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n";

fn pixels(desk: &Desk, name: &str) -> Vec<[u16; 3]> {
    image::open(desk.path(name)).unwrap().into_rgb16().pixels().map(|p| p.0).collect()
}

#[test]
fn a_table_is_laid_over_every_look_of_a_picture() {
    let desk = Desk::with_dng();
    desk.put("swap.cube", SWAP);
    for look in ["neutral", "vivid", "flat"] {
        let picture = |name: &str, options: &[&str]| {
            let fixed = ["a.dng", "-o", name, "--look", look, "--bits", "16", "--overwrite"];
            desk.develop(&[&fixed[..], options].concat());
            pixels(&desk, name)
        };
        let plain = picture("plain.png", &[]);
        let swapped = picture("swapped.png", &["--lut", "swap.cube"]);
        let away =
            plain.iter().zip(&swapped).map(|(a, b)| (0..3).map(|c| a[c].abs_diff(b[2 - c])).max().unwrap());
        assert!(away.max().unwrap() < 40, "{look}");
    }
}

#[test]
fn one_curve_for_all_channels_is_a_tone_curve_and_keeps_hues() {
    let desk = Desk::with_dng();
    desk.put("roll/film.cube", DARKER);
    desk.put("roll/a.dng", small_dng());
    desk.put("roll/darkroot.toml", "lut = \"film.cube\"\nbits = 16\n");
    desk.develop(&["a.dng", "-o", "plain.png", "--bits", "16"]);
    let run = desk.run(&["batch", "roll", "-o", "out", "--format", "png"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let (plain, darker) = (pixels(&desk, "plain.png"), pixels(&desk, "out/a.png"));
    let is_grey = |a: &[u16; 3]| a[1] > 500 && a[0].abs_diff(a[1]).max(a[2].abs_diff(a[1])) < 600;
    let greys = plain.iter().zip(&darker).filter(|(a, _)| is_grey(a));
    let halves: Vec<f64> = greys.map(|(a, b)| f64::from(b[1]) / f64::from(a[1].max(1))).collect();
    assert!(halves.len() > 100 && halves.iter().all(|h| (h - 0.5).abs() < 0.02), "{halves:?}");
}

#[test]
fn tables_that_are_none_are_sentences_and_so_are_looks_without_room() {
    let desk = Desk::with_dng();
    desk.put("cut.cube", SWAP.replace("\n1 1 1", ""));
    desk.put("picture.cube", b"\x89PNG\r\n\x1a\n\0\0");
    desk.put("step.clf", "<ProcessList id=\"1\" compCLFversion=\"3\"><ACES/></ProcessList>");
    desk.put("swap.cube", SWAP);
    for (options, code, words) in [
        (&["--lut", "none.cube"][..], 1, &["none.cube", "no such file"][..]),
        (&["--lut", "cut.cube"], 1, &["cut.cube", "7 rows", "8"]),
        (&["--lut", "picture.cube"], 1, &["picture.cube", "line 1"]),
        (&["--lut", "step.clf"], 1, &["step.clf", "`ACES`"]),
        (&["--lut", "swap.cube", "--look", "linear", "--format", "tiff"], 2, &["no room for lut"]),
        (&["--lut", "swap.cube", "--look", "reproduction", "--format", "tiff"], 2, &["no room for lut"]),
        (&["--lut-space", "camera"], 2, &["camera", "srgb"]),
    ] {
        let run = desk.run(&[&["develop", "a.dng", "-o", "o.tif"], options].concat());
        assert_eq!(run.code, code, "{options:?}: {}", run.err);
        for word in words {
            assert!(run.err.contains(word), "{options:?} says nothing of `{word}`: {}", run.err);
        }
    }
}
