//! `darkroot profile list`.

use std::io::Write as _;

use anyhow::Result;
use clap::Args;
use darkroot::shown;
use darkroot_profile::Calibration;
use serde_json::json;

use crate::Outcome;

/// List the profiles of your folder and those built in
#[derive(Debug, Args)]
pub(super) struct List {
    /// One line of JSON for each profile
    #[arg(long)]
    json: bool,
}

impl List {
    pub(super) fn run(self) -> Result<Outcome> {
        let store = super::store();
        let mut out = crate::out::lines();
        let all = store.all();
        let width = all.iter().map(|f| f.profile.camera().name().len()).max().unwrap_or(0);
        for found in &all {
            let profile = &found.profile;
            let lights: Vec<&str> = profile.calibrations().iter().map(|c| c.light.name.as_str()).collect();
            let mut models: Vec<String> = profile.calibrations().iter().map(|c| c.kind.to_string()).collect();
            models.dedup();
            if self.json {
                let line = json!({
                    "camera": profile.camera().name(),
                    "aliases": profile.camera().aliases,
                    "lights": lights,
                    "models": models,
                    "held_out_de2000_mean": profile.calibrations().iter().map(unseen).collect::<Vec<_>>(),
                    "place": found.place,
                });
                writeln!(crate::out::json(), "{line}")?;
            } else {
                let (name, lights) = (shown(&profile.camera().name()), shown(&lights.join(", ")));
                writeln!(out, "{name:width$}  {:10}  {lights:12}  {}", models.join(", "), found.place)?;
            }
        }
        if all.is_empty() && !self.json {
            crate::say(format_args!("there are no profiles"));
        }
        Ok(Outcome::Done)
    }
}

/// Mean error on colours that the fit did not see: held out, else left out.
fn unseen(calibration: &Calibration) -> Option<f64> {
    let figures = &calibration.figures;
    figures.held_out.or(figures.leave_one_out).map(|e| e.de2000.mean)
}
