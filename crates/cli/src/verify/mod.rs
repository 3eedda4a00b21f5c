//! `darkroot verify`.

mod delivered;
mod words;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use darkroot::deliver::{GUIDELINES, PIXELS_PER_DEGREE};
use darkroot::shot::Correct;
use darkroot::store::Found;
use darkroot::verify::{
    Limits, LogLine, Outcome as Judged, PRESETS, Verification, append, history, read_log, verify,
};
use darkroot::{Settings, shown, write_text};

use crate::profile::{ShotArgs, store};
use crate::sandbox::Sandbox;
use crate::{Common, Outcome};

/// Judge a shot of a chart by a profile, or finished pictures of a chart by its reference; exit code 3 when limits are not
/// kept
///
/// `verify PROFILE SHOT` judges a raw shot. `verify PICTURE...` judges TIFF, JPEG and PNG files, Darkroot's or anyone's,
/// through their own colour profiles, and `verify FOLDER` those of a folder that show a chart.
#[derive(Debug, Args)]
pub(crate) struct Verify {
    /// A profile (a file, or the name of a camera with one) and a raw shot; or finished pictures; or a folder of them
    #[arg(required_unless_present_any = ["history", "explain"], value_name = "PROFILE SHOT | PICTURE | FOLDER", num_args = 1..)]
    inputs: Vec<PathBuf>,

    /// List what each preset asks for, and where its numbers are from
    #[arg(long)]
    explain: bool,

    #[command(flatten)]
    shot: ShotArgs,

    #[command(flatten)]
    sandbox: Sandbox,

    /// Light of the shot: D50, A, LED-B3, 5200K, x,y, lamp.csv; the one that its white shows if not given
    #[arg(long, value_name = "LIGHT")]
    light: Option<String>,

    /// Largest mean dE2000
    #[arg(long, value_name = "DE")]
    max_mean: Option<f64>,

    /// Largest single dE2000
    #[arg(long, value_name = "DE")]
    max: Option<f64>,

    /// Limits of a guideline: fadgi-4star to -1star, iso19264-a to -c, metamorfoze-full, -light, -extra-light (`--explain`
    /// lists them). Of a raw shot colours are judged, of a finished picture all that it shows
    #[arg(long, value_name = "NAME", value_parser = preset)]
    preset: Option<&'static str>,

    /// Millimetres between the middles of two patches side by side, to tell pixels an inch of a finished picture
    #[arg(long, value_name = "MM", value_parser = crate::values::millimetres)]
    chart_pitch: Option<f64>,

    /// Pixels of a finished picture in a degree of sight, for visual noise: 41 are a screen of 100 pixels an inch at 60 cm
    #[arg(long, value_name = "NUMBER", default_value_t = PIXELS_PER_DEGREE, value_parser = crate::values::pixels_per_degree)]
    pixels_per_degree: f64,

    /// Print what was found in finished pictures as JSON, a line a picture
    #[arg(long)]
    json: bool,

    /// Write an HTML page on finished pictures: the chart as it was found, patches, limits, levels
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// Append a line to this CSV file
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,

    /// Date for the log; that of the shot if not given
    #[arg(long)]
    date: Option<String>,

    /// Plot a log over time instead, to the page given with `-o`
    #[arg(long, value_name = "LOG", requires = "output", conflicts_with = "inputs")]
    history: Option<PathBuf>,

    /// Page to write
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Replace an existing page
    #[arg(long)]
    overwrite: bool,
}

/// The name of a preset.
fn preset(name: &str) -> Result<&'static str, String> {
    let mut names = GUIDELINES.iter().flat_map(|guideline| guideline.levels).map(|level| level.preset);
    let known = names.clone().collect::<Vec<_>>().join(", ");
    names.find(|preset| *preset == name).ok_or_else(|| format!("`{name}` is no preset; there are {known}"))
}

impl Verify {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        if let (Some(log), Some(output)) = (&self.history, &self.output) {
            let (lines, torn) = read_log(log)?;
            if torn > 0 {
                crate::say(format_args!("warning: {}: {torn} lines cannot be read", shown(log)));
            }
            write_text(output, &history(&lines), self.overwrite)?;
            return Ok(Outcome::Done);
        }
        if self.explain {
            return delivered::explain();
        }
        if let Some(pictures) = delivered::pictures(&self.inputs)? {
            return self.judge_pictures(&pictures, common);
        }
        common.start_threads();
        let [profile, file] = &self.inputs[..] else {
            bail!(
                "give a profile and a raw shot of a chart, or finished pictures (TIFF, JPEG, PNG), or a folder of them"
            );
        };
        if self.report.is_some() || self.json {
            bail!(
                "`--report` and `--json` are for finished pictures; `darkroot profile --report` writes a page on a raw shot"
            );
        }
        let Some(profile) = profile.to_str() else { bail!("the profile's name is not UTF-8") };
        let Found { profile, place } = store().choose(profile)?;
        let request = self.shot.request(&[], &[], None, "", Correct::Never)?;
        let of_preset = self.limits_of_preset()?;
        let light = self.light.as_deref().map(darkroot::light::find).transpose()?;
        let judge = || verify(&profile, file, light.as_ref(), &request, &Settings::default());
        let found = match self.shot.deadline.over(file, 0, |_| (), judge) {
            Ok(found) => found,
            Err(fault) => {
                crate::say(format_args!("error: {}", crate::hint::words(&fault)));
                return Ok(Outcome::SomeFailed);
            }
        };
        let judgement = &found.judgement;
        let mut broken = self.own_limits().broken(judgement);
        broken.extend(of_preset.broken(judgement));
        if !common.quiet {
            say(file, &found, self.light.is_none());
        }
        if let Some(log) = &self.log {
            append(
                log,
                &self.log_line(profile.camera().name(), place, &found, of_preset, broken.is_empty()),
            )?;
        }
        for fault in &broken {
            crate::say(format_args!("error: {}: {fault}", shown(file)));
        }
        Ok(if broken.is_empty() { Outcome::Done } else { Outcome::Rejected })
    }

    fn own_limits(&self) -> Limits {
        Limits { mean: self.max_mean, max: self.max, ..Limits::default() }
    }

    /// What the preset asks of a raw shot.
    fn limits_of_preset(&self) -> Result<Limits> {
        let Some(name) = self.preset else { return Ok(Limits::default()) };
        let found = PRESETS.iter().find(|(preset, _)| *preset == name).map(|(_, limits)| *limits);
        found.with_context(|| {
            let names: Vec<&str> = PRESETS.iter().map(|(preset, _)| *preset).collect();
            format!(
                "the preset `{name}` judges finished pictures; for raw shots there are {}",
                names.join(", ")
            )
        })
    }

    fn log_line(
        &self,
        camera: String,
        profile: String,
        found: &Verification,
        of_preset: Limits,
        keeps: bool,
    ) -> LogLine {
        let patches = found.judgement.patches.iter().zip(&found.shot.patches);
        let brightest = patches.max_by(|(a, _), (b, _)| a.reference.y.total_cmp(&b.reference.y));
        let own = self.own_limits();
        let limits = [own, of_preset];
        let limits: Vec<String> = limits.iter().map(ToString::to_string).filter(|l| !l.is_empty()).collect();
        LogLine {
            date: self.date.clone().or_else(|| found.shot.date.clone()).unwrap_or_default(),
            file: found.shot.path.clone(),
            camera,
            light: found.light.light.name.clone(),
            de2000: found.judgement.errors.de2000,
            white: brightest.map_or([0.0; 3], |(_, p)| p.rgb),
            outcome: match keeps {
                _ if limits.is_empty() => Judged::Unjudged,
                true => Judged::Passed,
                false => Judged::Failed,
            },
            profile,
            preset: self.preset.unwrap_or_default().to_owned(),
            limits: limits.join("; "),
        }
    }
}

fn say(file: &Path, found: &Verification, is_light_free: bool) {
    let judgement = &found.judgement;
    if is_light_free {
        let light = &found.light.light.name;
        let why =
            if found.light_assumed { "assumed; `--light` names it" } else { "as the shot's white shows" };
        crate::say(format_args!("{}: light {light} ({why})", shown(file)));
    }
    let s = judgement.errors.de2000;
    crate::say(format_args!(
        "{}: dE2000 mean {:.2}, median {:.2}, 95 % {:.2}, max {:.2}",
        shown(file),
        s.mean,
        s.median,
        s.p95,
        s.max
    ));
    if let Some(promised) = judgement.promised {
        crate::say(format_args!(
            "  the profile promises mean {:.2}, max {:.2} for colours it has not seen",
            promised.mean, promised.max
        ));
    }
    let mut worst: Vec<_> = judgement.patches.iter().filter(|p| p.excluded.is_none()).collect();
    worst.sort_by(|a, b| b.de2000.total_cmp(&a.de2000));
    let worst: Vec<String> = worst.iter().take(5).map(|p| format!("{} {:.2}", p.name, p.de2000)).collect();
    crate::say(format_args!("  worst: {}", worst.join(", ")));
}
