//! `darkroot profile list`.

use std::io::Write as _;

use anyhow::Result;
use clap::Args;
use darkroot::shown;
use darkroot::store::Found;
use darkroot_profile::Calibration;
use darkroot_profile::ProfileCamera;
use serde_json::json;

use crate::Outcome;

/// List the profiles of your folder and those built in
#[derive(Debug, Args)]
pub(super) struct List {
    /// Every camera of which anything is known: those, too, whose colours are estimated from their published matrix
    #[arg(long)]
    all: bool,

    /// One line of JSON for each profile
    #[arg(long)]
    json: bool,
}

/// A line of the list.
struct Line {
    camera: ProfileCamera,
    lights: Vec<String>,
    models: Vec<String>,
    unseen: Vec<Option<f64>>,
    place: String,
}

impl List {
    pub(super) fn run(self) -> Result<Outcome> {
        let store = super::store();
        let found = store.all();
        let mut lines: Vec<Line> = found.iter().map(|f| of_profile(f)).collect();
        if self.all {
            let known = |camera: &darkroot::Listed| {
                found.iter().any(|f| f.profile.camera().is(&camera.make, &camera.model))
            };
            lines.extend(darkroot::cameras().into_iter().filter(|c| !known(c)).map(of_list));
        }
        let width = lines.iter().map(|l| l.camera.name().chars().count()).max().unwrap_or(0);
        let mut out = crate::out::lines();
        for Line { camera, lights, models, unseen, place } in &lines {
            if self.json {
                let line = json!({
                    "camera": camera.name(),
                    "aliases": camera.aliases,
                    "lights": lights,
                    "models": models,
                    "held_out_de2000_mean": unseen,
                    "place": place,
                });
                writeln!(crate::out::json(), "{line}")?;
            } else {
                let (name, lights) = (shown(&camera.name()), shown(&lights.join(", ")));
                writeln!(out, "{name:width$}  {:10}  {lights:12}  {place}", models.join(", "))?;
            }
        }
        if lines.is_empty() && !self.json {
            crate::say(format_args!("there are no profiles"));
        }
        Ok(Outcome::Done)
    }
}

fn of_profile(found: &Found) -> Line {
    let profile = &found.profile;
    let camera = profile.camera().clone();
    let place = found.place.clone();
    if let Some(known) = profile.known_camera() {
        let models = vec!["camera".to_owned()];
        let unseen = known.figures().iter().map(|judged| Some(judged.errors.de2000.mean)).collect();
        return Line { camera, lights: vec!["any light".to_owned()], models, unseen, place };
    }
    let mut models: Vec<String> = profile.calibrations().iter().map(|c| c.kind.to_string()).collect();
    models.dedup();
    Line {
        camera,
        lights: profile.calibrations().iter().map(|c| c.light.name.clone()).collect(),
        models,
        unseen: profile.calibrations().iter().map(unseen).collect(),
        place,
    }
}

/// A camera that decoders list with its matrix.
fn of_list(camera: darkroot::Listed) -> Line {
    Line {
        camera: ProfileCamera { make: camera.make, model: camera.model, aliases: Vec::new() },
        lights: vec!["any light".to_owned()],
        models: vec!["estimate".to_owned()],
        unseen: Vec::new(),
        place: "estimated from its published matrix".to_owned(),
    }
}

/// Mean error on colours that the fit did not see: held out, else left out.
fn unseen(calibration: &Calibration) -> Option<f64> {
    let figures = &calibration.figures;
    figures.held_out.or(figures.leave_one_out).map(|e| e.de2000.mean)
}
