//! The page: every file of it is in the program.

use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};

use crate::fault::Fault;

const HTML: &str = "text/html; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Name, kind and text of each file.
const FILES: &[(&str, &str, &str)] = &[
    ("", HTML, include_str!("../page/index.html")),
    ("style.css", STYLE, include_str!("../page/style.css")),
    ("icon.svg", "image/svg+xml", include_str!("../page/icon.svg")),
    ("main.js", SCRIPT, include_str!("../page/main.js")),
    ("server.js", SCRIPT, include_str!("../page/server.js")),
    ("elements.js", SCRIPT, include_str!("../page/elements.js")),
    ("sheet.js", SCRIPT, include_str!("../page/sheet.js")),
    ("files.js", SCRIPT, include_str!("../page/files.js")),
    ("develop.js", SCRIPT, include_str!("../page/develop.js")),
    ("picture.js", SCRIPT, include_str!("../page/picture.js")),
    ("layer.js", SCRIPT, include_str!("../page/layer.js")),
    ("readout.js", SCRIPT, include_str!("../page/readout.js")),
    ("controls.js", SCRIPT, include_str!("../page/controls.js")),
    ("edits.js", SCRIPT, include_str!("../page/edits.js")),
    ("tools.js", SCRIPT, include_str!("../page/tools.js")),
    ("tool.js", SCRIPT, include_str!("../page/tool.js")),
    ("crop.js", SCRIPT, include_str!("../page/crop.js")),
    ("lines.js", SCRIPT, include_str!("../page/lines.js")),
    ("histogram.js", SCRIPT, include_str!("../page/histogram.js")),
    ("export.js", SCRIPT, include_str!("../page/export.js")),
    ("batch.js", SCRIPT, include_str!("../page/batch.js")),
    ("chart.js", SCRIPT, include_str!("../page/chart.js")),
];

/// A file of the page.
pub(crate) fn file(name: &str) -> Response {
    match FILES.iter().find(|(known, ..)| *known == name) {
        Some((_, kind, text)) => ([(CONTENT_TYPE, *kind)], *text).into_response(),
        None => Fault::missing("there is no such page").into_response(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_page_is_in_the_program_and_names_only_such() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/page");
        let mut there: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .map(|name| if name == "index.html" { String::new() } else { name })
            .collect();
        let mut known: Vec<&str> = FILES.iter().map(|(name, ..)| *name).collect();
        there.sort();
        known.sort_unstable();
        assert_eq!(there, known);
        for (file, _, text) in FILES {
            for imported in text.split("from \"./").skip(1) {
                let name = imported.split('"').next().unwrap();
                assert!(known.contains(&name), "{file} imports {name}");
            }
        }
    }
}
