//! What the crew and its workers say to each other; between processes, a JSON object a line.
//!
//! The crew sends a [`Order::Task`]. The worker reads the file and answers [`Answer::Needs`] with the memory that
//! the rest takes; the crew sends [`Order::Go`] when there is room for it, or [`Order::Drop`]. Then comes the
//! result, or [`Answer::Failed`].

use std::collections::BTreeMap;
use std::path::PathBuf;

use darkroot::{Error, path_text};
use serde::{Deserialize, Serialize};

use super::facts::{CameraNames, ChartLook, Header, Identity, SessionColour};
use super::failure::FailureKind;

/// To a worker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Order {
    Task(Box<Task>),
    /// There is room: go on with this many threads.
    Go {
        threads: usize,
    },
    /// There is no room: forget the task.
    Drop,
}

/// What can be asked of a worker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Task {
    /// Read what stands at the head of the file.
    Header {
        #[serde(with = "path_text")]
        input: PathBuf,
    },
    /// Develop a file.
    Develop(Develop),
    /// Look for a chart in a file.
    Look {
        #[serde(with = "path_text")]
        input: PathBuf,
        layout: Option<String>,
    },
    /// Make a profile of a chart shot.
    Calibrate(Calibrate),
    /// A small picture of a finished output.
    Thumbnail {
        #[serde(with = "path_text")]
        picture: PathBuf,
    },
}

impl Task {
    /// The same once more, after a worker died over it. That may have been after it had put its output in place and
    /// before it could say so: what stands there now is ours, because nothing stood there when the task was begun.
    pub(crate) fn once_more(self) -> Self {
        match self {
            Self::Develop(develop) => Self::Develop(Develop { overwrite: true, ..develop }),
            other => other,
        }
    }

    /// The file that it reads.
    pub(crate) fn input(&self) -> &PathBuf {
        match self {
            Self::Header { input } | Self::Look { input, .. } => input,
            Self::Develop(develop) => &develop.input,
            Self::Calibrate(calibrate) => &calibrate.input,
            Self::Thumbnail { picture } => picture,
        }
    }
}

/// A file to develop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Develop {
    #[serde(with = "path_text")]
    pub(crate) input: PathBuf,
    #[serde(with = "path_text")]
    pub(crate) output: PathBuf,
    /// Every setting as text.
    pub(crate) texts: BTreeMap<String, String>,
    /// Name of the output's format.
    pub(crate) format: String,
    /// Colours from charts of the session, by camera.
    pub(crate) session: Vec<SessionColour>,
    /// Whether a file at `output` may be replaced.
    pub(crate) overwrite: bool,
    /// The output folder.
    #[serde(with = "path_text")]
    pub(crate) out: PathBuf,
    /// Folder below it for the unfinished output.
    #[serde(with = "path_text")]
    pub(crate) scratch: PathBuf,
    /// Whether to make a small picture of it too.
    pub(crate) thumbnail: bool,
}

/// A chart shot to make a profile of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Calibrate {
    #[serde(with = "path_text")]
    pub(crate) input: PathBuf,
    /// SHA-256 of the shot as it was when its chart was found.
    pub(crate) sha256: String,
    /// The chart.
    pub(crate) layout: String,
    /// Its reference; the built-in one, if none.
    pub(crate) reference: Option<String>,
    pub(crate) light: Option<String>,
    /// The output folder.
    #[serde(with = "path_text")]
    pub(crate) out: PathBuf,
    /// Where the profile goes, below it.
    #[serde(with = "path_text")]
    pub(crate) profile: PathBuf,
}

/// From a worker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Answer {
    /// The file is read; the rest takes this many bytes of memory in all.
    Needs {
        bytes: u64,
    },
    Dropped,
    Header(Header),
    Developed(Box<Developed>),
    Looked(ChartLook),
    Calibrated(Box<SessionColour>),
    /// JPEG bytes as base 64; none where the format cannot be shown.
    Thumbnail(Option<String>),
    Failed(TaskError),
}

/// A developed file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Developed {
    pub(crate) source: Identity,
    pub(crate) written: Identity,
    pub(crate) camera: CameraNames,
    /// SHA-256 of the profile; empty for the file's own matrices.
    pub(crate) profile: String,
    /// What gave the colours, in words.
    pub(crate) colours: String,
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) seconds: f64,
    pub(crate) notes: Vec<String>,
    /// JPEG bytes as base 64.
    pub(crate) thumbnail: Option<String>,
    /// Most memory that the process ever held, bytes; 0 where the system does not tell.
    pub(crate) peak: u64,
    /// What it said that it needs, bytes.
    pub(crate) needed: u64,
}

/// Why a task came to nothing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct TaskError {
    pub(crate) kind: FailureKind,
    /// One sentence that names the file.
    #[serde(rename = "error")]
    pub(crate) words: String,
}

/// What went wrong in a task.
pub(crate) enum Fault {
    /// In words already.
    Task(TaskError),
    Library(Error),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}
