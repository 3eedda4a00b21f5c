//! `darkroot profile from-matrix`.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use darkroot::shown;

use crate::{Common, Outcome};

/// Make a profile from a camera's published color matrix and what is known of other cameras, without a shot
///
/// This is what `develop` does for a camera without a profile. The profile can be exported, judged and kept.
#[derive(Debug, Args)]
pub(super) struct FromMatrix {
    /// A raw file of the camera, or its name as `profile list --all` shows it ("Nikon D90")
    camera: String,

    /// Profile to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Replace an existing file
    #[arg(long)]
    overwrite: bool,
}

impl FromMatrix {
    pub(super) fn run(self, common: Common) -> Result<Outcome> {
        let found = darkroot::estimate_named(&self.camera, &darkroot::Limits::default())?;
        darkroot::store::write(&found.profile, &self.output, self.overwrite)?;
        if common.quiet {
            return Ok(Outcome::Done);
        }
        crate::say(format_args!("{}: {}", shown(&found.profile.camera().name()), found.words()));
        let estimate = &found.estimate;
        if let (Some(family), Some(matrix)) = (&estimate.family, estimate.expected_of_matrix) {
            crate::say(format_args!(
                "the matrix is most like {family}; by itself it is off by {matrix:.1}, as far as is known"
            ));
        }
        Ok(Outcome::Done)
    }
}
