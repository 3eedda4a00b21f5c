//! Files are opened, and texts shown, in one place each: what is checked there is checked for all.

use darkroot_tests::root;

use crate::files;

/// What opens a file or shows a text, and the only files that may do so.
const DOORS: [(&[&str], &[&str]); 3] = [
    (
        &[
            "fs::read(",
            "read_to_string(path",
            "File::open(",
            "File::create(",
            "OpenOptions",
            "fs::write(",
            "ImageReader::open(",
        ],
        &["darkroot/src/files/"],
    ),
    (&[".display()", "to_string_lossy()"], &["darkroot/src/shown.rs"]),
    (&["io::stdout()", "io::stderr()", "println!", "eprintln!"], &["cli/src/out.rs", "darkroot/src/files/"]),
];

/// Where a line does something else than it looks like.
const HARMLESS: [&str; 9] = [
    // Facts about this process.
    "\"/proc/self/",
    // Whether somebody looks.
    "is_terminal()",
    // Names inside of files, which are escaped where they are shown.
    "file_name().unwrap_or_default().to_string_lossy()",
    "file_stem().unwrap_or_default().to_string_lossy()",
    "let name = entry.file_name().to_string_lossy();",
    // Arguments that name lights and nothing else.
    "light.to_string_lossy()",
    // Where a name goes on as a path.
    "Path::to_string_lossy",
    "//!",
    "///",
];

/// What of a source is no test.
fn program(text: &str) -> &str {
    text.split("#[cfg(test)]").next().unwrap_or_default()
}

#[test]
fn files_are_opened_and_texts_shown_in_one_place_each() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for folder in ["darkroot/src", "batch/src", "window/src", "cli/src", "python/src"] {
        for path in files(&root().join("crates").join(folder)) {
            let name = path.strip_prefix(root().join("crates")).unwrap().to_str().unwrap().to_owned();
            if !name.ends_with(".rs") || name.ends_with("tests.rs") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            for (number, line) in program(&text).lines().enumerate() {
                for (ways, places) in DOORS {
                    let is_door = places.iter().any(|place| name.starts_with(place));
                    let Some(way) = ways.iter().find(|way| line.contains(**way)) else { continue };
                    seen += usize::from(is_door);
                    if !is_door && !HARMLESS.iter().any(|harmless| line.contains(harmless)) {
                        wrong.push(format!("{name}:{}: {way}", number + 1));
                    }
                }
            }
        }
    }
    assert!(seen > 5, "the doors themselves were not found");
    assert!(wrong.is_empty(), "these go past the doors:\n{}", wrong.join("\n"));
}
