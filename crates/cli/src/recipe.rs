//! `darkroot recipe`.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use darkroot::{CommonLook, Effective, Key, ProfileStore, path_text};
use serde_json::{Map, Value, json};

use crate::Outcome;
use crate::picture::{self, Picture};
use darkroot::shown;

/// Show which settings hold for files, and where each is from
///
/// Prints a recipe for each FILE, or for the current folder: what `darkroot develop` with the same options would
/// use. Save one and give it to --recipe.
#[derive(Debug, Args)]
pub(crate) struct Recipe {
    /// Raw files; they need not exist
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,

    #[command(flatten)]
    picture: Picture,

    /// A line of JSON for each file
    #[arg(long)]
    json: bool,

    /// Instead, a recipe with the one look that the camera gave all FILEs, by their embedded previews
    #[arg(long, requires = "files", conflicts_with = "json")]
    camera_look: bool,

    /// Describe every setting as JSON instead: its values, its default, what it changes
    #[arg(long, conflicts_with = "files")]
    describe: bool,
}

impl Recipe {
    pub(crate) fn run(self) -> Result<Outcome> {
        if self.describe {
            writeln!(crate::out::ours(), "{:#}", darkroot::settings::describe())?;
            return Ok(Outcome::Done);
        }
        if self.camera_look {
            return self.look();
        }
        let mut layers = self.picture.layers()?;
        let mut recipes = Vec::new();
        for file in &self.files {
            recipes.push((Some(file.as_path()), layers.for_file(file)?));
        }
        if self.files.is_empty() {
            recipes.push((None, layers.for_folder(Path::new("."))?));
        }
        let mut out = crate::out::lines();
        for (number, (file, effective)) in recipes.iter().enumerate() {
            if self.json {
                writeln!(crate::out::json(), "{}", as_json(*file, effective))?;
                continue;
            }
            if number > 0 {
                writeln!(out)?;
            }
            let title = file.map_or("this folder".to_owned(), shown);
            writeln!(out, "# {}", title)?;
            write!(out, "{}", effective.to_toml(picture::shown))?;
        }
        Ok(Outcome::Done)
    }
}

impl Recipe {
    /// One look for all files.
    fn look(&self) -> Result<Outcome> {
        let settings = self.picture.layers()?.for_folder(Path::new("."))?.settings()?;
        let store = ProfileStore::of_user();
        let found = darkroot::common_look(&self.files, &settings, &store)?;
        let Some(CommonLook { camera, look, told_by, without }) = found else {
            anyhow::bail!("no file has an embedded preview that tells of the camera's look");
        };
        for why in &without {
            crate::out::say(format_args!("left out: {why}"));
        }
        let photographs =
            if told_by == 1 { "1 photograph".to_owned() } else { format!("{told_by} photographs") };
        let mut out = crate::out::lines();
        writeln!(
            out,
            "# The look of {camera}, by the previews of {photographs}, which differ from it by {:.1} L*",
            look.left
        )?;
        writeln!(
            out,
            "look = \"neutral\"\ncurve = \"{}\"\nsaturation = {:.2}",
            look.curve(),
            look.saturation
        )?;
        Ok(Outcome::Done)
    }
}

fn as_json(file: Option<&Path>, effective: &Effective) -> Value {
    let one = |key: Key| {
        let (text, origin) = effective.get(key);
        let mut value = json!({ "value": key.as_json(text), "from": origin.name() });
        if let Some(path) = origin.path() {
            value["path"] = path_text::text(path).into();
        }
        (key.name().to_owned(), value)
    };
    let settings: Map<String, Value> = Key::all().map(one).collect();
    json!({ "file": file.map(path_text::text), "settings": settings })
}
