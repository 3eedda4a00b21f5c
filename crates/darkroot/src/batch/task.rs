//! What the parent process and its workers say to each other: a JSON object a line.
//!
//! The parent sends a [`Order::Task`]. The worker reads the file and answers [`Answer::Needs`] with the memory that
//! the rest takes; the parent sends [`Order::Go`] when there is room for it, or [`Order::Drop`]. Then comes the
//! result, or [`Answer::Failed`].

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::record::{CameraNames, Identity};
use super::session::{SessionColour, Sight};

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
    Header { input: PathBuf },
    /// Develop a file.
    Develop(Develop),
    /// Look for a chart in a file.
    Look { input: PathBuf, layout: Option<String> },
    /// Make a profile of a chart shot.
    Calibrate { input: PathBuf, layout: String, reference: Option<String>, light: String, profile: PathBuf },
    /// A small picture of a finished output.
    Thumbnail { picture: PathBuf },
}

impl Task {
    /// The file that it reads.
    pub(crate) fn input(&self) -> &PathBuf {
        match self {
            Self::Header { input } | Self::Look { input, .. } | Self::Calibrate { input, .. } => input,
            Self::Develop(develop) => &develop.input,
            Self::Thumbnail { picture } => picture,
        }
    }
}

/// A file to develop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Develop {
    pub(crate) input: PathBuf,
    pub(crate) output: PathBuf,
    /// Every setting as text.
    pub(crate) texts: BTreeMap<String, String>,
    /// Name of the output's format.
    pub(crate) format: String,
    /// Colours from charts of the session, by camera.
    pub(crate) session: Vec<SessionColour>,
    /// Whether a file at `output` may be replaced.
    pub(crate) overwrite: bool,
    /// Folder for the unfinished output.
    pub(crate) scratch: PathBuf,
    /// Whether to make a small picture of it too.
    pub(crate) thumbnail: bool,
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
    Looked(Sight),
    Calibrated(Box<SessionColour>),
    /// JPEG bytes as base 64; none where the format cannot be shown.
    Thumbnail(Option<String>),
    Failed(Trouble),
}

/// What stands at the head of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Header {
    /// Camera and date as they can stand in a file name.
    pub(crate) camera: String,
    pub(crate) date: String,
    /// Pixels of the frame.
    pub(crate) pixels: u64,
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
pub(crate) struct Trouble {
    pub(crate) kind: TroubleKind,
    /// One sentence that names the file.
    pub(crate) error: String,
}

/// What the rest of the batch must know of a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TroubleKind {
    /// The file.
    File,
    /// The disk of the outputs is full: no other file fares better.
    DiskFull,
    /// The output cannot be written for another reason; perhaps its folder is gone.
    Output,
    /// The file changed while it was read.
    Changing,
    /// The worker died or was killed.
    Died,
}
