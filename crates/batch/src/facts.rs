//! Facts about files: what the journal keeps and what workers tell, in the same words.
//!
//! All of these stand in journals of earlier runs. Names and order of fields are part of the journal's format.

use std::path::PathBuf;
use std::time::UNIX_EPOCH;

use darkroot::{ProfileChoice, Settings};
use darkroot_develop::Balance;
use serde::{Deserialize, Serialize};

/// Folder inside the output folder that holds journals, profiles of sessions and unfinished outputs.
pub const FOLDER: &str = ".darkroot";

/// What a file was when it was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Size in bytes.
    pub size: u64,
    /// Time of its last change, nanoseconds since 1970.
    pub modified: i64,
    /// SHA-256 of its content, hexadecimal.
    pub sha256: String,
}

/// The camera of a file by all its names, as [`darkroot_photo::Camera`].
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub struct CameraNames {
    /// As written in the file.
    pub make: String,
    /// As written in the file.
    pub model: String,
    /// The maker's common name.
    pub common_make: String,
    /// The model's common name.
    pub common_model: String,
}

impl From<&darkroot_photo::Camera> for CameraNames {
    fn from(c: &darkroot_photo::Camera) -> Self {
        Self {
            make: c.make.clone(),
            model: c.model.clone(),
            common_make: c.common_make.clone(),
            common_model: c.common_model.clone(),
        }
    }
}

impl From<&CameraNames> for darkroot_photo::Camera {
    fn from(c: &CameraNames) -> Self {
        Self {
            make: c.make.clone(),
            model: c.model.clone(),
            common_make: c.common_make.clone(),
            common_model: c.common_model.clone(),
        }
    }
}

/// What stands at the head of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Header {
    /// Camera as it can stand in a file name; empty if unknown.
    pub camera: String,
    /// Date of the shot, 2026-05-01; empty if unknown.
    pub date: String,
    /// Pixels of the frame.
    pub pixels: u64,
}

/// What a look at a file showed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChartLook {
    /// The camera.
    pub camera: CameraNames,
    /// Name of the surest chart's layout, and how sure, 0..=1.
    pub chart: Option<(String, f64)>,
    /// The file as it was.
    pub source: Identity,
}

/// A look that stands in a journal, so that the next run need not look again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Looked {
    /// The file's path below its root.
    pub input: String,
    /// The chart that was looked for; any if none.
    pub layout: Option<String>,
    /// What was seen.
    #[serde(rename = "sight")]
    pub look: ChartLook,
}

/// A profile that was made of a chart shot, so that the next run need not make it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibrated {
    /// The chart shot's path below its root.
    pub input: String,
    /// SHA-256 of the shot and of everything that was asked for.
    pub request: String,
    /// What came of it.
    pub colour: SessionColour,
}

/// What one chart shot gives to the files of its camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionColour {
    /// The camera.
    pub camera: CameraNames,
    /// The chart shot's path below its root.
    pub chart: String,
    /// The profile's file.
    #[serde(with = "darkroot::path_text")]
    pub profile: PathBuf,
    /// SHA-256 of the profile.
    pub sha256: String,
    /// White-balance multipliers of red, green and blue.
    pub multipliers: [f64; 3],
    /// Mean CIEDE2000 over the patches, each by a fit without it.
    pub left_out: f64,
}

impl SessionColour {
    /// The settings with this white balance and profile.
    pub(crate) fn apply(&self, settings: &mut Settings) {
        settings.recipe.balance = Balance::Multipliers(self.multipliers);
        settings.profile = ProfileChoice::File(self.profile.clone());
    }
}

/// Time of a file's last change, nanoseconds since 1970; 0 where the system keeps none.
pub fn modified(data: &std::fs::Metadata) -> i64 {
    let Ok(time) = data.modified() else { return 0 };
    match time.duration_since(UNIX_EPOCH) {
        Ok(after) => i64::try_from(after.as_nanos()).unwrap_or(i64::MAX),
        Err(before) => -i64::try_from(before.duration().as_nanos()).unwrap_or(i64::MAX),
    }
}
