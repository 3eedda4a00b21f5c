//! `darkroot profile SHOT --chart CHART --light LIGHT`.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::Args;
use darkroot::shot::Correct;
use darkroot::{
    ChartRequest, Error, MadeProfile, Settings, chart_camera, light, make_profile, report, shown,
};
use darkroot_profile::Kind;

use super::shot_args::ShotArgs;
use super::{table, told};
use crate::{Common, Outcome, hint};

/// Make a profile from shots of a colour chart
#[derive(Debug, Args)]
pub(super) struct Make {
    /// Raw shots of the chart; or tables of patches with the camera's linear RGB and what they are (.ti3, .cgats, .txt,
    /// .csv)
    #[arg(value_name = "SHOT")]
    pub(super) shots: Vec<PathBuf>,

    #[command(flatten)]
    pub(super) table: table::TableArgs,

    #[command(flatten)]
    pub(super) shot: ShotArgs,

    /// Light of the shots: D50, A, LED-B3, 5200K, x,y, lamp.csv; one for all, or one for each shot. Shots of several
    /// exposures under one light are a bracket: one measurement, and a check that the sensor is linear
    #[arg(long = "light", value_name = "LIGHT")]
    pub(super) lights: Vec<String>,

    /// Take the mean of several shots under one light at one exposure, and check that they agree
    #[arg(long)]
    pub(super) average: bool,

    /// The model; without it the best by cross-validation
    #[arg(long, value_name = "MODEL", value_parser = crate::values::kind)]
    pub(super) model: Option<Kind>,

    /// Keep the camera in the profile, not models for the lights of the shots: colours for any light follow from it, so that
    /// a shot in daylight serves the evening, too
    #[arg(long, conflicts_with = "model")]
    pub(super) as_camera: bool,

    /// Allow a model that is no good for pictures (plain polynomials)
    #[arg(long)]
    force: bool,

    /// Profile to write; the name of the first shot with .toml if not given
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Report to write: one HTML page with pictures, plots and figures
    #[arg(long, value_name = "FILE")]
    pub(super) report: Option<PathBuf>,

    /// Date to write into the profile, YYYY-MM-DD; none if not given
    #[arg(long, default_value = "")]
    pub(super) date: String,

    /// Figures as JSON on stdout
    #[arg(long)]
    pub(super) json: bool,

    /// Replace existing files
    #[arg(long)]
    pub(super) overwrite: bool,
}

impl Make {
    /// `--light D65 A` names two lights, as `from-spectra` takes them: what stands among the shots, is no file and names
    /// a light is one.
    fn take_lights(&mut self) {
        if self.lights.is_empty() {
            return;
        }
        let is_light = |shot: &mut PathBuf| {
            !shot.exists() && shot.to_str().is_some_and(|text| light::LightSource::by_name(text).is_some())
        };
        let lights: Vec<PathBuf> = self.shots.extract_if(.., is_light).collect();
        self.lights.extend(lights.iter().map(|light| light.to_string_lossy().into_owned()));
    }

    pub(super) fn run(mut self, common: Common) -> Result<Outcome> {
        self.take_lights();
        let Some(first) = self.shots.first() else {
            bail!("give a shot of a chart, or a command; `darkroot help profile` shows both");
        };
        if self.lights.is_empty() {
            bail!("give the light of the shot: `--light D50`, `--light 5200K` or a file of its spectrum");
        }
        if self.model.is_some_and(|kind| !kind.keeps_exposure()) && !self.force {
            bail!("colours by a plain polynomial change with exposure; take another model or add `--force`");
        }
        let output = self.output.clone().unwrap_or_else(|| first.with_extension("toml"));
        if self.shots.iter().any(|path| table::is_one(path)) {
            return table::run(&self, &output, common);
        }
        self.table.refuse()?;
        let request =
            self.shot.request(&self.shots, &self.lights, self.model, &self.date, Correct::WhereItHelps)?;
        let request = ChartRequest { average: self.average, ..request };
        let lone = |i: usize| request.shots.iter().filter(|s| s.1 == request.shots[i].1).count() == 1;
        if self.average && (0..request.shots.len()).all(lone) {
            bail!("`--average` is for several shots under one light; leave it out, or give more shots");
        }
        let deadline = self.shot.deadline.times(self.shots.len());
        let make = || {
            let made = make_profile(&request, &Settings::default())?;
            let camera = self.as_camera.then(|| chart_camera(&made)).transpose()?;
            Ok(MadeProfile { profile: camera.unwrap_or_else(|| made.profile.clone()), ..made })
        };
        let made = match deadline.over(first, 0, |_| (), make) {
            Ok(made) => made,
            Err(fault @ Error::SeveralShots { .. }) => bail!(fault),
            Err(fault) => {
                crate::say(format_args!("error: {}", hint::words(&fault)));
                return Ok(Outcome::SomeFailed);
            }
        };
        darkroot::store::write(&made.profile, &output, self.overwrite)?;
        if let Some(path) = &self.report {
            darkroot::write_text(path, &report::html(&made, &request.layout), self.overwrite)
                .with_context(|| "the profile is written, the report is not")?;
        }
        if self.json {
            for light in &made.lights {
                use std::io::Write as _;
                writeln!(crate::out::json(), "{}", told::figures(light))?;
            }
        }
        if !common.quiet {
            crate::say(format_args!(
                "{}: profile for {}",
                shown(&output),
                shown(&made.profile.camera().name())
            ));
            made.lights.iter().for_each(told::say_light);
            told::say_camera(&made.profile);
        }
        Ok(Outcome::Done)
    }
}
