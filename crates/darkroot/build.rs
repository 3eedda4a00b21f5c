//! Builds the profiles of `profiles/` into the library: a table of the names of their cameras and of their texts.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join("../../profiles");
    println!("cargo::rerun-if-changed={}", root.display());
    let mut files = Vec::new();
    collect(&root, &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        let name = file.strip_prefix(&root).unwrap_or(file).display().to_string();
        let path = fs::canonicalize(file)?.display().to_string();
        let camera = Camera::of(&fs::read_to_string(file)?);
        let Camera { make, model, aliases } =
            camera.ok_or_else(|| io::Error::other(format!("{name}: no camera")))?;
        table.push_str(&format!("    BuiltIn {{ make: {make}, model: {model}, aliases: &{aliases}, "));
        table.push_str(&format!("text: include_str!({path:?}) }},\n"));
    }
    table.push_str("]\n");
    fs::write(PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("profiles.rs"), table)
}

/// The names of a profile's camera as they stand in its file: TOML's texts and lists of texts are those of Rust, as long as
/// they hold nothing strange. The test of the store reads every profile whole and compares.
struct Camera {
    make: String,
    model: String,
    aliases: String,
}

impl Camera {
    fn of(text: &str) -> Option<Self> {
        let section = text.split_once("[camera]")?.1.split("\n[").next()?;
        let value = |key: &str| {
            let line =
                section.lines().find_map(|line| line.strip_prefix(key)?.trim_start().strip_prefix('='));
            line.map(|value| value.trim().to_owned())
        };
        Some(Self { make: value("make")?, model: value("model")?, aliases: value("aliases")? })
    }
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|e| e == "toml") {
            files.push(path);
        }
    }
    Ok(())
}
