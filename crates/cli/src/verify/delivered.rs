//! `darkroot verify PICTURE...`: finished pictures, one or a folder of them.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use darkroot::deliver::{
    DeliveryRequest, GUIDELINES, Guideline, JudgedPicture, Metric, UNLIMITED, Verdict, figures, is_picture,
    judge, preset,
};
use darkroot::fault::ChartError;
use darkroot::report::delivered;
use darkroot::verify::{LogLine, Outcome as Judged, append};
use darkroot::{Error, shown, write_text};

use super::{Verify, words};
use crate::sandbox;
use crate::{Common, Outcome};

/// Most pictures of a folder.
const MOST: usize = 10_000;

/// Finished pictures that are named.
pub(super) struct Pictures {
    files: Vec<PathBuf>,
    /// Whether they were found in a folder, where not every picture shows a chart.
    found: bool,
}

/// The finished pictures among inputs; `None` where they name none.
pub(super) fn pictures(inputs: &[PathBuf]) -> Result<Option<Pictures>> {
    match inputs {
        [folder] if folder.is_dir() => {
            let mut files = Vec::new();
            for entry in std::fs::read_dir(folder).with_context(|| shown(folder))? {
                let path = entry.with_context(|| shown(folder))?.path();
                if is_picture(&path) && path.is_file() {
                    files.push(path);
                }
            }
            files.sort();
            if files.is_empty() {
                bail!("{}: has no TIFF, JPEG or PNG files to judge", shown(folder));
            }
            if files.len() > MOST {
                bail!("{}: has more than {MOST} pictures; judge it in parts", shown(folder));
            }
            Ok(Some(Pictures { files, found: true }))
        }
        // A profile may be called like a picture by nobody.
        [first, ..] if is_picture(first) => {
            let other = inputs.iter().find(|path| !is_picture(path));
            match other {
                Some(other) => bail!(
                    "{}: is no finished picture; judge raw shots by a profile, one at a time",
                    shown(other)
                ),
                None => Ok(Some(Pictures { files: inputs.to_vec(), found: false })),
            }
        }
        _ => Ok(None),
    }
}

/// Prints what each preset asks for.
pub(super) fn explain() -> Result<Outcome> {
    let mut out = crate::out::lines();
    for guideline in &GUIDELINES {
        let sl1 = if guideline.sl1 { ", dE2000 with SL = 1" } else { "" };
        writeln!(out, "{}{sl1}", guideline.name)?;
        for (place, level) in guideline.levels.iter().enumerate() {
            writeln!(out, "  --preset {} ({})", level.preset, level.name)?;
            for row in guideline.rows {
                if let Some(bound) = row.bounds.get(place).copied().flatten() {
                    writeln!(out, "    {:44} {:14} [{}]", row.metric.name(), bound.to_string(), row.source)?;
                }
            }
        }
    }
    writeln!(out, "measured without a limit")?;
    for (metric, source) in UNLIMITED {
        writeln!(out, "    {:44} {:14} [{source}]", metric.name(), "")?;
    }
    Ok(Outcome::Done)
}

impl Verify {
    /// Judges finished pictures.
    pub(super) fn judge_pictures(&self, pictures: &Pictures, common: Common) -> Result<Outcome> {
        let light = self.light.as_deref().map(darkroot::light::find).transpose()?;
        let request = self.shot.delivery(light, self.chart_pitch, self.pixels_per_degree)?;
        self.confine(pictures, &request, common)?;
        common.start_threads();
        let (mut judged, mut without, mut unreadable) = (Vec::new(), Vec::new(), 0usize);
        for (number, file) in pictures.files.iter().enumerate() {
            let after = pictures.files.len() - number - 1;
            match self.shot.deadline.over(file, after, |_| (), || judge(file, &request)) {
                Ok(found) => judged.push(found),
                Err(Error::Chart { source: ChartError::NotFound { .. }, .. }) if pictures.found => {
                    without.push(file);
                }
                Err(fault) => {
                    crate::say(format_args!("error: {}", crate::hint::words(&fault)));
                    unreadable += 1;
                }
            }
        }
        judged.sort_by(|a, b| (&a.date, &a.path).cmp(&(&b.date, &b.path)));
        let verdicts: Vec<Vec<Verdict>> = judged.iter().map(|found| self.verdicts(found)).collect();
        if !common.quiet {
            for (found, verdicts) in judged.iter().zip(&verdicts) {
                words::say(found, verdicts, self.asked_in_words().as_deref());
            }
            if !without.is_empty() {
                let (count, verb) = if without.len() == 1 {
                    ("1 picture".to_owned(), "shows")
                } else {
                    (format!("{} pictures", without.len()), "show")
                };
                crate::say(format_args!(
                    "{count} {verb} no {} and {} not judged",
                    request.layout.title,
                    if without.len() == 1 { "was" } else { "were" }
                ));
            }
        }
        if self.json {
            print(&judged, &verdicts)?;
        }
        let lines: Vec<LogLine> = judged.iter().zip(&verdicts).map(|(j, v)| self.line(j, v)).collect();
        if let Some(log) = &self.log {
            lines.iter().try_for_each(|line| append(log, line))?;
        }
        if let Some(report) = &self.report {
            write_text(report, &self.page(&judged, &verdicts, &lines, &request), self.overwrite)?;
        }
        if pictures.found && judged.is_empty() {
            bail!("no picture of the folder shows a {}; name the chart with `--chart`", request.layout.title);
        }
        let broken = verdicts.iter().flatten().any(|verdict| verdict.kept() == Some(false));
        Ok(match (unreadable, broken) {
            (1.., _) => Outcome::SomeFailed,
            (0, true) => Outcome::Rejected,
            (0, false) => Outcome::Done,
        })
    }

    /// Gives up everything but the pictures and what is written, before the first of them is read.
    fn confine(&self, pictures: &Pictures, request: &DeliveryRequest, common: Common) -> Result<()> {
        self.sandbox.say(common);
        let reach = sandbox::reading(pictures.files.iter().chain(&request.flat));
        let outputs = self.report.iter().chain(&self.log);
        self.sandbox.confine(&outputs.fold(reach, |reach, output| sandbox::writing(reach, output)))
    }

    /// The guideline and level that are asked for.
    fn asked(&self) -> Option<(&'static Guideline, usize)> {
        self.preset.and_then(preset)
    }

    fn verdicts(&self, found: &JudgedPicture) -> Vec<Verdict> {
        const ASKED: &str = "as asked";
        let own = [(Metric::ColourMean, self.max_mean), (Metric::ColourMax, self.max)];
        let one = |(metric, most): (Metric, Option<f64>)| {
            let bound = darkroot::deliver::Bound { least: None, most: Some(most?) };
            Some(Verdict { metric, found: found.delivery.value(metric, false), bound, source: ASKED })
        };
        let mut verdicts: Vec<Verdict> = own.into_iter().filter_map(one).collect();
        if let Some((guideline, level)) = self.asked() {
            verdicts.extend(guideline.verdicts(level, &found.delivery));
        }
        verdicts
    }

    fn asked_in_words(&self) -> Option<String> {
        let name = self
            .asked()
            .map(|(guideline, level)| format!("{}, {}", guideline.name, guideline.levels[level].name));
        name.or_else(|| {
            (self.max_mean.is_some() || self.max.is_some()).then(|| "the limits that were given".to_owned())
        })
    }

    fn line(&self, found: &JudgedPicture, verdicts: &[Verdict]) -> LogLine {
        let kept = verdicts.iter().all(|verdict| verdict.kept() != Some(false));
        LogLine {
            date: self.date.clone().or_else(|| found.date.clone()).unwrap_or_default(),
            file: found.path.clone(),
            camera: String::new(),
            light: found.light.light.name.clone(),
            de2000: found.delivery.de2000,
            white: found.white,
            outcome: match kept {
                _ if verdicts.is_empty() => Judged::Unjudged,
                true => Judged::Passed,
                false => Judged::Failed,
            },
            profile: found.space.clone(),
            preset: self.preset.unwrap_or_default().to_owned(),
            limits: self.asked_in_words().unwrap_or_default(),
        }
    }

    fn page(
        &self,
        judged: &[JudgedPicture],
        verdicts: &[Vec<Verdict>],
        lines: &[LogLine],
        request: &DeliveryRequest,
    ) -> String {
        let asked = self.asked_in_words();
        match (judged, verdicts) {
            ([one], [verdicts]) => delivered::html(one, &request.layout, asked.as_deref(), verdicts),
            _ => delivered::table(judged, &request.layout, lines, asked.as_deref(), verdicts),
        }
    }
}

/// Prints every figure as JSON, a line a picture.
fn print(judged: &[JudgedPicture], verdicts: &[Vec<Verdict>]) -> Result<()> {
    let mut out = crate::out::json();
    for (found, verdicts) in judged.iter().zip(verdicts) {
        out.write_all((serde_json::to_string(&figures(found, verdicts))? + "\n").as_bytes())?;
    }
    Ok(())
}
