//! The files of a batch, and what is to be done with each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot::{Settings, path_text, shown};
use darkroot_encode::Format;

use super::facts::{CameraNames, SessionColour};
use super::failure::Conflict;
use super::find::Source;
use super::names::LeftOut;
use super::record::Done;
use super::shard::Shard;
use super::source_fault::SourceFault;
use super::task::Develop;
use super::{hash, names};

/// What outputs with one name become.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum OnCollision {
    /// Nothing is done at all.
    #[default]
    Refuse,
    /// They get different names.
    Suffix,
    /// One is made: of the input that it was made of before, else of the first by name. The others are left out.
    Skip,
    /// One is made, of an input with one of these endings (lower case, without the dot), the first of them that there is; else
    /// as for `Skip`.
    Prefer(Vec<String>),
}

impl std::str::FromStr for OnCollision {
    type Err = String;

    /// `refuse`, `suffix`, `skip`, or `prefer:` and endings between commas.
    fn from_str(text: &str) -> Result<Self, String> {
        let ending = |text: &str| text.trim().trim_start_matches('.').to_lowercase();
        let preferred = text.strip_prefix("prefer").map(|rest| rest.trim_start_matches([':', '=', ' ']));
        match (text, preferred) {
            ("refuse", _) => Ok(Self::Refuse),
            ("suffix", _) => Ok(Self::Suffix),
            ("skip", _) => Ok(Self::Skip),
            (_, Some(endings)) if !endings.is_empty() => {
                Ok(Self::Prefer(endings.split(',').map(ending).collect()))
            }
            _ => Err("use refuse, suffix, skip or prefer:nef,dng".to_owned()),
        }
    }
}

/// How a plan is made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanOptions {
    /// The output folder.
    pub out: PathBuf,
    /// Names of outputs below it; [`names::MIRRORED`] mirrors the inputs' tree.
    pub template: String,
    /// Outputs with one name.
    pub on_collision: OnCollision,
    /// Whether files that no journal knows may be replaced.
    pub overwrite: bool,
    /// Whether everything is done again.
    pub redo: bool,
    /// Whether outputs are read again and compared with the journal.
    pub verify: bool,
    /// Which part.
    pub shard: Shard,
}

impl PlanOptions {
    /// Everything that is to be done, into this folder.
    pub fn into(out: &Path) -> Self {
        Self {
            out: out.to_owned(),
            template: names::MIRRORED.to_owned(),
            on_collision: OnCollision::Refuse,
            overwrite: false,
            redo: false,
            verify: false,
            shard: Shard::WHOLE,
        }
    }
}

/// Why a file is to be developed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// It never was.
    New,
    /// A run ended in the middle of it.
    Interrupted,
    /// It failed before.
    FailedBefore,
    /// The input has another content than then.
    InputChanged,
    /// Other settings than then.
    SettingsChanged,
    /// The profile is another than then.
    ProfileChanged,
    /// A table, a frame or a shot of a chart that the settings name is another than then.
    FileChanged,
    /// The output is gone.
    OutputMissing,
    /// The output was damaged on the disk: another content at the same time of change.
    OutputDamaged,
    /// It was asked for.
    Asked,
}

/// What is to be done with a file.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// Develop it.
    Todo(Why),
    /// Nothing: done and unchanged.
    Done(Box<Done>),
    /// It cannot be done: another picture is in the way.
    Conflict(Conflict),
}

/// Settings that hold for one or more files.
#[derive(Debug, Clone)]
pub struct FileSettings {
    /// Every setting as text.
    pub texts: BTreeMap<String, String>,
    /// The same, typed.
    pub settings: Settings,
    /// Format of the outputs.
    pub format: Format,
    /// What hashes go by: texts without the profile's path.
    pub(crate) canonical: String,
}

/// One file of a plan.
#[derive(Debug, Clone)]
pub struct Item {
    /// The input.
    pub source: Source,
    /// The output's path below the output folder, with forward slashes, as [`path_text`] writes it.
    pub output: String,
    /// Its number.
    pub number: usize,
    /// Its settings.
    pub prepared: Arc<FileSettings>,
    /// SHA-256 of the files that the settings name beside the profile, as they were when the plan was made; empty where there
    /// are none, or one cannot be read.
    pub(crate) files: String,
    /// Colours of its session.
    pub session: Arc<Vec<SessionColour>>,
    /// What is to be done.
    pub state: State,
}

impl Item {
    /// The output's path.
    pub fn place(&self, out: &Path) -> PathBuf {
        out.join(path_text::path(&self.output))
    }

    /// The output's path below the output folder, for people.
    pub fn output_shown(&self) -> String {
        shown(&path_text::path(&self.output))
    }

    /// What a worker is told to develop it: to this output, below a folder, with unfinished ones in another below that.
    pub(crate) fn task(&self, output: PathBuf, out: &Path, scratch: &Path) -> Develop {
        Develop {
            input: self.source.path.clone(),
            output,
            texts: self.prepared.texts.clone(),
            format: self.prepared.format.extension().to_owned(),
            session: Vec::clone(&self.session),
            overwrite: false,
            out: out.to_owned(),
            scratch: scratch.to_owned(),
            thumbnail: false,
        }
    }

    /// SHA-256 of all that a file of this camera is developed with, without where the profile's file lies.
    pub(crate) fn settings_hash(&self, camera: &CameraNames) -> String {
        let mut text = self.prepared.canonical.clone();
        if let Some(c) = self.session.iter().find(|c| c.camera == *camera) {
            let [red, green, blue] = c.multipliers.map(number_text);
            text += &format!("session={} {} [{red}, {green}, {blue}]\n", c.chart, c.sha256);
        }
        hash::text(&text)
    }
}

/// A batch, ready to run.
#[derive(Debug, Default)]
pub struct BatchPlan {
    /// The output folder.
    pub out: PathBuf,
    /// Names of outputs.
    pub template: String,
    /// Whether files that no journal knows may be replaced.
    pub overwrite: bool,
    /// All files of the shard.
    pub items: Vec<Item>,
    /// Inputs whose picture is made of another one.
    pub left_out: Vec<LeftOut>,
    /// What could not be read while looking for inputs.
    pub faults: Vec<SourceFault>,
}

/// A number as it stands in what the settings' hash is taken of. Journals of earlier runs hold such hashes, so this
/// must never change: the fewest digits that give the number again, `.0` behind whole ones, an exponent for very
/// large and very small ones.
fn number_text(value: f64) -> String {
    let plain = value.to_string();
    let size = value.abs();
    if size != 0.0 && size.is_finite() && !(1e-4..1e16).contains(&size) {
        format!("{value:e}")
    } else if plain.contains('.') || !value.is_finite() {
        plain
    } else {
        plain + ".0"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_hashes_are_written_as_in_the_first_journals() {
        for (value, text) in [
            (1.0, "1.0"),
            (2.184_920_1, "2.1849201"),
            (0.1, "0.1"),
            (0.000_01, "1e-5"),
            (0.000_1, "0.0001"),
            (0.000_099, "9.9e-5"),
            (0.000_012, "1.2e-5"),
            (9.9e-6, "9.9e-6"),
            (1e16, "1e16"),
            (123_456_789.0, "123456789.0"),
        ] {
            assert_eq!((number_text(value), format!("{value:?}")), (text.to_owned(), text.to_owned()));
        }
    }

    #[test]
    fn the_hash_of_settings_with_a_session_is_that_of_the_first_journals() {
        let settings = FileSettings {
            texts: BTreeMap::new(),
            settings: Settings::default(),
            format: Format::Jpeg,
            canonical: "format=jpg\n".into(),
        };
        let camera = CameraNames { make: "M".into(), ..CameraNames::default() };
        let colour = SessionColour {
            camera: camera.clone(),
            chart: "day 1/chart.dng".into(),
            profile: PathBuf::new(),
            sha256: "ab".into(),
            multipliers: [2.0, 1.0, 1.5],
            left_out: 0.0,
        };
        let item = Item {
            source: Source { path: PathBuf::new(), key: String::new(), size: 0, modified: 0 },
            output: String::new(),
            number: 1,
            prepared: Arc::new(settings),
            files: String::new(),
            session: Arc::new(vec![colour]),
            state: State::Todo(Why::New),
        };
        let text = "format=jpg\nsession=day 1/chart.dng ab [2.0, 1.0, 1.5]\n";
        assert_eq!(item.settings_hash(&camera), hash::text(text));
        assert_eq!(item.settings_hash(&CameraNames::default()), hash::text("format=jpg\n"));
    }
}
