//! `darkroot profile lint`.

use std::io::Write as _;

use anyhow::{Result, bail};
use clap::Args;
use darkroot::shown;
use darkroot_profile::lint::{Severity, check};
use serde_json::json;

use crate::Outcome;

/// Look for faults of profiles: folds, negative luminance, hue twists, noise
///
/// Exit code 3 when a profile fails.
#[derive(Debug, Args)]
pub(super) struct Lint {
    /// Profile files, or names of cameras with a profile
    #[arg(required_unless_present = "all")]
    profiles: Vec<String>,

    /// Check every profile of your folder and every one built in
    #[arg(long, conflicts_with = "profiles")]
    all: bool,

    /// One line of JSON for each finding
    #[arg(long)]
    json: bool,
}

impl Lint {
    pub(super) fn run(self) -> Result<Outcome> {
        let store = super::store();
        let profiles: Vec<_> = if self.all {
            store.all().into_iter().cloned().collect()
        } else {
            self.profiles.iter().map(|text| store.choose(text)).collect::<Result<_, _>>()?
        };
        if profiles.is_empty() {
            bail!("there are no profiles to check");
        }
        let mut out = crate::out::lines();
        let mut worst = Severity::Note;
        for found in &profiles {
            let camera = found.profile.camera().name();
            for finding in found.profile.calibrations().iter().flat_map(check) {
                worst = worst.max(finding.severity);
                if self.json {
                    let line = json!({
                        "profile": found.place,
                        "camera": camera,
                        "light": finding.light,
                        "check": finding.check.name(),
                        "severity": finding.severity.to_string(),
                        "value": finding.value,
                        "words": finding.words,
                    });
                    writeln!(crate::out::json(), "{line}")?;
                } else {
                    let severity = finding.severity.to_string();
                    let (light, words) = (shown(&finding.light), shown(&finding.words));
                    writeln!(out, "{}, {light}: {severity:7} {words}", shown(&camera))?;
                }
            }
        }
        Ok(if worst == Severity::Failure { Outcome::Rejected } else { Outcome::Done })
    }
}
