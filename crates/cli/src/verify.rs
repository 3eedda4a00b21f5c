//! `darkroot verify`.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use darkroot::verify::{
    Judgement, Limits, LogLine, PRESETS, Verification, append, history, read_log, verify,
};
use darkroot::{Settings, write_text};

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

    /// Light of the shot: D50, A, LED-B3, 5200K, x,y, lamp.csv
    #[arg(long, value_name = "LIGHT", default_value = "D50")]
    light: String,

    /// Largest mean dE2000
    #[arg(long, value_name = "DE")]
    max_mean: Option<f64>,

    /// Largest single dE2000
    #[arg(long, value_name = "DE")]
    max: Option<f64>,

    /// Limits of a guideline: fadgi-4star, metamorfoze-full, iso19264-a
    #[arg(long, value_name = "NAME", value_parser = preset)]
    preset: Option<Limits>,

    /// Append a line to this CSV file
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,

    /// Date for the log; empty if not given
    #[arg(long, default_value = "")]
    date: String,

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

fn preset(name: &str) -> Result<Limits, String> {
    let found = PRESETS.iter().find(|(n, _)| *n == name).map(|(_, limits)| *limits);
    let names: Vec<&str> = PRESETS.iter().map(|(n, _)| *n).collect();
    found.ok_or_else(|| format!("`{name}` is no preset; there are {}", names.join(", ")))
}

impl Verify {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        if let (Some(log), Some(output)) = (&self.history, &self.output) {
            let (lines, torn) = read_log(log)?;
            if torn > 0 {
                crate::say(format_args!("warning: {}: {torn} lines cannot be read", log.display()));
            }
            write_text(output, &history(&lines), self.overwrite)?;
            return Ok(Outcome::Done);
        }
        let (Some(profile), Some(file)) = (&self.profile, &self.chart_shot) else {
            bail!("give a profile and a shot of a chart");
        };
        let profile = store().choose(profile)?.profile;
        let request =
            self.shot.request(std::slice::from_ref(file), std::slice::from_ref(&self.light), None, "")?;
        let judge = || verify(&profile, &request, &Settings::default());
        let found = match self.shot.deadline.over(file, 0, |_| (), judge) {
            Ok(found) => found,
            Err(fault) => {
                crate::say(format_args!("error: {}", crate::hint::words(&fault)));
                return Ok(Outcome::SomeFailed);
            }
        };
        let judgement = &found.judgement;
        let own = Limits { mean: self.max_mean, max: self.max, ..Limits::default() };
        let mut broken = own.broken(judgement);
        broken.extend(self.preset.iter().flat_map(|preset| preset.broken(judgement)));
        if !common.quiet {
            say(file, judgement);
        }
        if let Some(log) = &self.log {
            append(log, &self.log_line(file, profile.camera().name(), &found, broken.is_empty()))?;
        }
        for fault in &broken {
            crate::say(format_args!("error: {}: {fault}", file.display()));
        }
        Ok(if broken.is_empty() { Outcome::Done } else { Outcome::Rejected })
    }

    fn log_line(&self, file: &Path, camera: String, found: &Verification, passed: bool) -> LogLine {
        let patches = found.judgement.patches.iter().zip(&found.shot.patches);
        let brightest = patches.max_by(|(a, _), (b, _)| a.reference.y.total_cmp(&b.reference.y));
        LogLine {
            date: self.date.clone(),
            file: file.to_owned(),
            camera,
            light: self.light.clone(),
            de2000: found.judgement.errors.de2000,
            white: brightest.map_or([0.0; 3], |(_, p)| p.rgb),
            passed,
        }
    }
}

fn say(file: &Path, judgement: &Judgement) {
    let s = judgement.errors.de2000;
    crate::say(format_args!(
        "{}: dE2000 mean {:.2}, median {:.2}, 95 % {:.2}, max {:.2}",
        file.display(),
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
