//! `darkroot profile SHOT --chart CHART --light LIGHT`.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::Args;
use darkroot::make_profile::MadeLight;
use darkroot::shot::{Gate, ShotOptions, Verdict};
use darkroot::{
    ChartRequest, Error, MadeProfile, Settings, chart_camera, charts, light, make_profile, report,
};
use darkroot_profile::Kind;
use serde_json::json;

use crate::deadline::Deadline;
use crate::{Common, Outcome, hint};
use darkroot::shown;

/// How a shot of a chart is read.
#[derive(Debug, Args)]
pub(crate) struct ShotArgs {
    /// The chart: classic24, passport24, mini24, nano24, sg140, dc240, spyder24, spyder48, or a file that describes one
    #[arg(long, value_name = "CHART", default_value = "classic24")]
    chart: String,

    /// What the patches are: a built-in reference or a file (CGATS, .cie, .ti3, CxF 3, CSV; Lab, XYZ or spectra)
    #[arg(long, value_name = "REFERENCE")]
    reference: Option<String>,

    /// Corners of the chart by hand: outer corners of the corner patches in pixels of the developed picture, from patch
    /// 1 on clockwise as the chart is printed
    #[arg(long, value_name = "X,Y,X,Y,X,Y,X,Y", value_parser = crate::values::corners)]
    corners: Option<[[f64; 2]; 4]>,

    /// A shot of an even surface in the same light, to take light fall-off out
    #[arg(long, value_name = "FILE")]
    flat: Option<PathBuf>,

    /// A shot with the lens closed, to subtract
    #[arg(long, value_name = "FILE")]
    dark: Option<PathBuf>,

    /// Take the slope of light over the chart out, as far as the patches show it
    #[arg(long)]
    even_out: bool,

    /// Take out the stray light that the grey patches show
    #[arg(long)]
    correct_glare: bool,

    /// Leave a patch out, by its name; several may be given
    #[arg(long, value_name = "PATCH")]
    exclude: Vec<String>,

    /// Use the shot even if it is not good enough
    #[arg(long)]
    accept: bool,

    /// Take rendered pictures (JPEG, PNG, TIFF) too
    #[arg(long)]
    allow_rendered: bool,

    #[command(flatten)]
    pub(crate) deadline: Deadline,
}

impl ShotArgs {
    fn options(&self) -> ShotOptions {
        ShotOptions {
            corners: self.corners,
            flat: self.flat.clone(),
            dark: self.dark.clone(),
            even_out: self.even_out,
            correct_glare: self.correct_glare,
            exclude: self.exclude.clone(),
            accept: self.accept,
            allow_rendered: self.allow_rendered,
        }
    }

    /// A request for shots, each with its light.
    pub(crate) fn request(
        &self,
        files: &[PathBuf],
        lights: &[String],
        kind: Option<Kind>,
        date: &str,
    ) -> Result<ChartRequest> {
        let found = lights.iter().map(|l| light::find(l)).collect::<Result<Vec<_>, _>>()?;
        let of = |i: usize| match found.as_slice() {
            [only] => Ok(only.clone()),
            all if all.len() == files.len() => Ok(all[i].clone()),
            all => bail!(
                "there are {} shots and {} lights; give one light for all, or one for each shot in the same order",
                files.len(),
                all.len()
            ),
        };
        let shots = files.iter().enumerate().map(|(i, f)| Ok((f.clone(), of(i)?))).collect::<Result<_>>()?;
        let layout = charts::layout(&self.chart)?;
        let reference = charts::reference(self.reference.as_deref(), &layout)?;
        Ok(ChartRequest {
            shots,
            layout,
            reference: reference.colours,
            reference_name: reference.name,
            reference_sha256: reference.sha256,
            options: self.options(),
            average: false,
            kind,
            date: date.to_owned(),
        })
    }
}

/// Make a profile from shots of a colour chart
#[derive(Debug, Args)]
pub(super) struct Make {
    /// Raw shots of the chart
    #[arg(value_name = "SHOT")]
    shots: Vec<PathBuf>,

    #[command(flatten)]
    shot: ShotArgs,

    /// Light of the shots: D50, A, LED-B3, 5200K, x,y, lamp.csv; one for all, or one for each shot. Shots of several
    /// exposures under one light are a bracket: one measurement, and a check that the sensor is linear
    #[arg(long = "light", value_name = "LIGHT")]
    lights: Vec<String>,

    /// Take the mean of several shots under one light at one exposure, and check that they agree
    #[arg(long)]
    average: bool,

    /// The model; without it the best by cross-validation
    #[arg(long, value_name = "MODEL", value_parser = crate::values::kind)]
    model: Option<Kind>,

    /// Keep the camera in the profile, not models for the lights of the shots: colours for any light follow from it, so that
    /// a shot in daylight serves the evening, too
    #[arg(long, conflicts_with = "model")]
    as_camera: bool,

    /// Allow a model that is no good for pictures (plain polynomials)
    #[arg(long)]
    force: bool,

    /// Profile to write; the name of the first shot with .toml if not given
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Report to write: one HTML page with pictures, plots and figures
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// Date to write into the profile, YYYY-MM-DD; none if not given
    #[arg(long, default_value = "")]
    date: String,

    /// Figures as JSON on stdout
    #[arg(long)]
    json: bool,

    /// Replace existing files
    #[arg(long)]
    overwrite: bool,
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
        let request = self.shot.request(&self.shots, &self.lights, self.model, &self.date)?;
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
                writeln!(crate::out::json(), "{}", figures(light))?;
            }
        }
        if !common.quiet {
            crate::say(format_args!(
                "{}: profile for {}",
                shown(&output),
                shown(&made.profile.camera().name())
            ));
            made.lights.iter().for_each(say_light);
            for judged in made.profile.known_camera().into_iter().flat_map(|known| known.figures()) {
                let (light, errors) = (&judged.light, judged.errors.de2000);
                crate::say(format_args!(
                    "  the camera under {light}, left out, dE2000: mean {:.2}, max {:.2}",
                    errors.mean, errors.max
                ));
            }
        }
        Ok(Outcome::Done)
    }
}

fn say_light(light: &MadeLight) {
    for shot in &light.shots {
        for gate in shot.gates.iter().filter(|g| g.verdict != Verdict::Good) {
            let (path, advice) = (shown(&shot.path), hint::advice(gate));
            crate::say(format_args!("  warning: {path}: {}; {advice}", gate.words()));
        }
        for note in &shot.notes {
            crate::say(format_args!("  note: {}", shown(note)));
        }
    }
    for gate in light.gates.iter().filter(|g| g.verdict != Verdict::Good) {
        crate::say(format_args!("  warning: {}; {}", gate.words(), hint::advice(gate)));
    }
    for note in &light.calibrated.notes {
        crate::say(format_args!("  note: {}", shown(note)));
    }
    if let Some([red, _, blue]) = light.white_balance {
        crate::say(format_args!(
            "  note: the white balance in the file is not that of the chart's light: to see the chart as it is, develop with \
             `--white-balance {red:.3},1,{blue:.3}`"
        ));
    }
    let chosen = light.calibrated.calibration.kind;
    crate::say(format_args!("  {}, dE2000 (mean / max):  training   left out", light.light.light.name));
    for compared in &light.calibrated.compared {
        let mark = if compared.kind == chosen { "->" } else { "  " };
        let kind = compared.kind.to_string();
        match &compared.result {
            Ok(f) => {
                let pair = |e: Option<darkroot_profile::Errors>| match e
                    .map(|e| e.de2000)
                    .filter(|s| s.max.is_finite())
                {
                    Some(s) => format!("{:5.2} / {:5.2}", s.mean, s.max),
                    None => "not determined".to_owned(),
                };
                crate::say(format_args!(
                    "  {mark} {kind:13} {}   {}",
                    pair(f.training),
                    pair(f.leave_one_out)
                ));
            }
            Err(reason) => crate::say(format_args!("  {mark} {kind:13} {reason}")),
        }
    }
}

/// Everything about one light, for machines.
pub(super) fn figures(light: &MadeLight) -> serde_json::Value {
    let summary = |e: Option<darkroot_profile::Errors>| {
        e.map(|e| {
            let s = e.de2000;
            json!({ "mean": s.mean, "median": s.median, "p95": s.p95, "max": s.max })
        })
    };
    let compared: Vec<_> = light
        .calibrated
        .compared
        .iter()
        .map(|c| match &c.result {
            Ok(f) => json!({
                "model": c.kind.to_string(),
                "training": summary(f.training),
                "leave_one_out": summary(f.leave_one_out),
                "exposures": c.exposures,
            }),
            Err(reason) => json!({ "model": c.kind.to_string(), "error": reason.to_string() }),
        })
        .collect();
    let shots: Vec<_> = light
        .shots
        .iter()
        .map(|s| {
            json!({
                "file": darkroot::path_text::text(&s.path),
                "corners": s.corners,
                "confidence": s.confidence,
                "glare": s.glare,
                "unevenness": s.slope.range(),
                "gates": gates(&s.gates),
            })
        })
        .collect();
    let patches: Vec<_> = light
        .calibrated
        .patches
        .iter()
        .map(|p| {
            json!({
                "name": p.name,
                "rgb": p.rgb,
                "uncertainty": p.uncertainty,
                "de2000": p.de2000,
                "left_out_de2000": p.left_out,
                "excluded": p.excluded,
            })
        })
        .collect();
    json!({
        "light": light.light.light.name,
        "model": light.calibrated.calibration.kind.to_string(),
        "models": compared,
        "white_rgb": light.calibrated.white_rgb,
        "gates": gates(&light.gates),
        "shots": shots,
        "patches": patches,
    })
}

/// Checks, for machines; a value that could not be measured is null.
fn gates(gates: &[Gate]) -> Vec<serde_json::Value> {
    let one = |g: &Gate| {
        let verdict = match g.verdict {
            Verdict::Good => "good",
            Verdict::Warning => "warning",
            Verdict::Refused => "failed",
        };
        json!({ "name": g.name(), "verdict": verdict, "value": g.value(), "words": g.words() })
    };
    gates.iter().map(one).collect()
}
