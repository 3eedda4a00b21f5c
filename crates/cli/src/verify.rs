//! `darkroot verify`.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use darkroot::shot::Correct;
use darkroot::store::Found;
use darkroot::verify::{
    Limits, LogLine, Outcome as Judged, PRESETS, Verification, append, history, read_log, verify,
};
use darkroot::{Settings, shown, write_text};

use crate::profile::{ShotArgs, store};
use crate::{Common, Outcome};

/// Judge a new shot of a chart by a profile; exit code 3 when it does not keep the limits
#[derive(Debug, Args)]
pub(crate) struct Verify {
    /// Profile file, or the name of a camera with a profile
    #[arg(required_unless_present = "history")]
    profile: Option<String>,

    /// Raw shot of the chart
    #[arg(required_unless_present = "history", value_name = "SHOT")]
    chart_shot: Option<PathBuf>,

    #[command(flatten)]
    shot: ShotArgs,

    /// Light of the shot: D50, A, LED-B3, 5200K, x,y, lamp.csv; the one that its white shows if not given
    #[arg(long, value_name = "LIGHT")]
    light: Option<String>,

    /// Largest mean dE2000
    #[arg(long, value_name = "DE")]
    max_mean: Option<f64>,

    /// Largest single dE2000
    #[arg(long, value_name = "DE")]
    max: Option<f64>,

    /// Limits of a guideline: fadgi-4star, metamorfoze-full, iso19264-a
    #[arg(long, value_name = "NAME", value_parser = preset)]
    preset: Option<Preset>,

    /// Append a line to this CSV file
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,

    /// Date for the log; that of the shot if not given
    #[arg(long)]
    date: Option<String>,

    /// Plot a log over time instead, to the page given with `-o`
    #[arg(long, value_name = "LOG", requires = "output", conflicts_with_all = ["profile", "chart_shot"])]
    history: Option<PathBuf>,

    /// Page to write
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Replace an existing page
    #[arg(long)]
    overwrite: bool,
}

/// Limits with the name of their guideline.
type Preset = (&'static str, Limits);

fn preset(name: &str) -> Result<Preset, String> {
    let found = PRESETS.iter().find(|(n, _)| *n == name).copied();
    let names: Vec<&str> = PRESETS.iter().map(|(n, _)| *n).collect();
    found.ok_or_else(|| format!("`{name}` is no preset; there are {}", names.join(", ")))
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
        let (Some(profile), Some(file)) = (&self.profile, &self.chart_shot) else {
            bail!("give a profile and a shot of a chart");
        };
        let Found { profile, place } = store().choose(profile)?;
        let request = self.shot.request(&[], &[], None, "", Correct::Never)?;
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
        broken.extend(self.preset.iter().flat_map(|(_, limits)| limits.broken(judgement)));
        if !common.quiet {
            say(file, &found, self.light.is_none());
        }
        if let Some(log) = &self.log {
            append(log, &self.log_line(profile.camera().name(), place, &found, broken.is_empty()))?;
        }
        for fault in &broken {
            crate::say(format_args!("error: {}: {fault}", shown(file)));
        }
        Ok(if broken.is_empty() { Outcome::Done } else { Outcome::Rejected })
    }

    fn own_limits(&self) -> Limits {
        Limits { mean: self.max_mean, max: self.max, ..Limits::default() }
    }

    fn log_line(&self, camera: String, profile: String, found: &Verification, keeps: bool) -> LogLine {
        let patches = found.judgement.patches.iter().zip(&found.shot.patches);
        let brightest = patches.max_by(|(a, _), (b, _)| a.reference.y.total_cmp(&b.reference.y));
        let own = self.own_limits();
        let limits = [own, self.preset.map_or_else(Limits::default, |(_, limits)| limits)];
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
            preset: self.preset.map_or_else(String::new, |(name, _)| name.to_owned()),
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
