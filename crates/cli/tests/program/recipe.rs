//! Settings from folders, recipes, flags and sidecars, on pictures that are really developed.

use serde_json::Value;

use super::*;
use crate::profiles::profile;

mod faults;
mod formats;
mod layers;
mod printed;

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
