//! What a journal's lines say.

use serde::{Deserialize, Serialize};

use super::facts::{Calibrated, CameraNames, Identity, Looked};

/// A file that was developed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// The input's path below its root, with forward slashes.
    pub input: String,
    /// The output's path below the output folder, with forward slashes.
    pub output: String,
    /// What the input was.
    pub source: Identity,
    /// SHA-256 of the settings.
    pub settings: String,
    /// Its camera.
    pub camera: CameraNames,
    /// SHA-256 of the profile that gave the colours; empty for the file's own matrices.
    pub profile: String,
    /// SHA-256 of the other files that the settings name (tables, frames, shots of charts); empty where there are none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub files: String,
    /// What the output is.
    pub written: Identity,
    /// Width of the picture in pixels.
    pub width: usize,
    /// Height of the picture in pixels.
    pub height: usize,
    /// Seconds from reading to the finished output.
    pub seconds: f64,
    /// What had to be assumed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Number of the input, where names carry one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub number: Option<usize>,
    /// Version of Darkroot.
    pub program: String,
    /// When, RFC 3339, UTC.
    pub at: String,
}

/// A file that failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failed {
    /// The input's path below its root.
    pub input: String,
    /// The output that was meant.
    pub output: String,
    /// One sentence: what is wrong and what to do.
    pub error: String,
    /// Whether its worker died, now or in an earlier attempt that nothing was heard of: an output of ours may stand there
    /// all the same.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub died: bool,
    /// Version of Darkroot.
    pub program: String,
    /// When, RFC 3339, UTC.
    pub at: String,
}

/// One line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Record {
    /// The first line.
    Journal {
        /// Version of the format.
        version: u32,
        /// Version of Darkroot that began it.
        program: String,
    },
    /// A file is about to be developed: from here on what appears at `output` is this journal's.
    Begun {
        /// The input's path below its root.
        input: String,
        /// The output's path below the output folder.
        output: String,
        /// Number of the input, where names carry one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        number: Option<usize>,
        /// Files that its run is about, also those that were done before; not where more may come.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        of: Option<usize>,
    },
    /// It is done.
    Done(Box<Done>),
    /// It failed.
    Failed(Failed),
    /// It vanished after it was begun, and was not developed.
    Gone {
        /// The input's path below its root.
        input: String,
        /// The output that was meant.
        output: String,
    },
    /// A chart was looked for in a file, for the colours of its session.
    Looked(Looked),
    /// A profile was made of a chart shot.
    Calibrated(Calibrated),
}
