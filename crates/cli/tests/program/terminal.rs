//! No text from outside orders a terminal about or begins a line that looks like one of ours.

use darkroot_photo::metadata::{Directory, Value, tag};

use super::*;

const EVIL: &str = "x\u{1b}]0;owned\u{7}\nerror: b.dng: everything is lost\r\u{9b}2J\u{202e}";

/// Fails if what a run said holds an order, or a line that a text made.
fn is_plain(run: &Run, what: &str) {
    for text in [&run.out, &run.err] {
        let order = text.chars().find(|c| c.is_control() && *c != '\n' || *c == '\u{202e}');
        assert_eq!(order, None, "{what}: {text:?}");
        assert!(!text.lines().any(|line| line.starts_with("error: b.dng")), "{what}: {text:?}");
    }
}

/// A file whose camera, photographer and copyright are hostile.
fn evil_dng() -> Vec<u8> {
    let mut metadata = darkroot_simulate::expose::metadata();
    for tag in [tag::ARTIST, tag::COPYRIGHT] {
        metadata.set(Directory::Image, tag, Value::Text(EVIL.to_owned()));
    }
    metadata.set(Directory::Exif, tag::LENS_MODEL, Value::Text(EVIL.to_owned()));
    let exposure = Exposure { metadata, ..Exposure::default() };
    let mut capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &exposure);
    capture.camera.make = EVIL.to_owned();
    capture.camera.model = EVIL.to_owned();
    dng::write(&capture, dng::Storage::Uncompressed)
}

#[test]
fn what_stands_in_a_file_is_shown_in_its_line() {
    let desk = Desk::new();
    desk.put("in/a.dng", evil_dng());
    let runs: [&[&str]; 6] = [
        &["inspect", "in/a.dng"],
        &["inspect", "in/a.dng", "--json"],
        &["develop", "in/a.dng", "-v"],
        &["develop", "in/a.dng", "--profile", "Nikon D700", "--overwrite"],
        &["batch", "in", "-o", "out", "-v"],
        &["batch", "in", "-o", "out2", "--json"],
    ];
    for arguments in runs {
        let run = desk.run(arguments);
        is_plain(&run, &format!("{arguments:?}"));
        for line in run.out.lines().filter(|_| arguments.contains(&"--json")) {
            serde_json::from_str::<serde_json::Value>(line).unwrap();
        }
    }
    let shown = desk.run(&["inspect", "in/a.dng"]).out;
    assert!(shown.lines().any(|l| l.starts_with("artist") && l.contains(r"\u{1b}]0;owned")), "{shown}");
    // The metadata itself goes along as it is.
    assert!(desk.read("in/a.jpg").windows(EVIL.len()).any(|w| w == EVIL.as_bytes()));
}

#[cfg(unix)]
#[test]
fn names_of_files_are_shown_in_their_line() {
    let desk = Desk::new();
    let name = EVIL.replace('/', "") + ".dng";
    desk.put("in/good.dng", small_dng());
    std::fs::write(desk.path("in").join(&name), "text").unwrap();
    let path = format!("in/{name}");
    let option = format!("--{EVIL}");
    let runs: [&[&str]; 12] = [
        &["develop", &path],
        &["develop", &path, "--json"],
        &["inspect", &path],
        &["chart", &path],
        &["recipe", &path],
        &["profile", "show", &path],
        &["profile", &path, "--light", &path],
        &["develop", "in/good.dng", "--recipe", &path],
        &["develop", "in/good.dng", &option],
        &["batch", "in", "-o", "out"],
        &["batch", "in", "-o", "out", "--dry-run"],
        &["batch", "status", "out"],
    ];
    for arguments in runs {
        let run = desk.run(arguments);
        is_plain(&run, &format!("{arguments:?}"));
        assert!(
            run.err.contains("owned") || run.out.contains("owned"),
            "{arguments:?}: {}{}",
            run.out,
            run.err
        );
    }
}

#[test]
fn a_fault_of_a_text_quotes_a_line_at_most() {
    let desk = Desk::with_dng();
    let long = "x".repeat(100_000);
    for (name, text) in [
        ("syntax.toml", format!("format = \"darkroot profile\"\nversion = 1\n{long} = = \"{long}\"\n")),
        ("field.toml", format!("format = \"darkroot profile\"\nversion = 1\n{long} = 1\n")),
        ("format.toml", format!("format = \"{long}\"\nversion = 1\n")),
    ] {
        desk.put(name, text);
        let run = desk.fails(1, &["develop", "a.dng", "--profile", name], &[name]);
        assert!(run.err.len() < 1000 && run.err.lines().count() < 4, "{name}: {}", run.err.len());
    }
    for text in [format!("{long} = 1"), format!("look = \"{long}\""), format!("a = \"{long}"), long.clone()] {
        desk.put("r.toml", text);
        let run = desk.fails(2, &["develop", "a.dng", "--recipe", "r.toml"], &["r.toml"]);
        assert!(run.err.len() < 1000, "{}", run.err.len());
    }
    desk.put("lamp.csv", format!("name,{long}\na,1\n"));
    let run = desk.fails(2, &["profile", "a.dng", "--light", "lamp.csv"], &["lamp.csv"]);
    assert!(run.err.len() < 1000, "{}", run.err.len());
}
