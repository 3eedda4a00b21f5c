//! `darkroot verify PICTURE...`: finished pictures, one or a folder of them.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use darkroot::deliver::{
    DeliveryRequest, Details, GUIDELINES, Grey, Guideline, JudgedPicture, Metric, Verdict, is_picture, judge,
    preset,
};
use darkroot::fault::ChartError;
use darkroot::report::delivered;
use darkroot::verify::{LogLine, Outcome as Judged, append};
use darkroot::{Error, shown, write_text};

use super::Verify;
use crate::sandbox;
use crate::{Common, Outcome};

/// L* up to which greys count as one.
const SAME: f64 = 1.0;
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
    Ok(Outcome::Done)
}

impl Verify {
    /// Judges finished pictures.
    pub(super) fn judge_pictures(&self, pictures: &Pictures, common: Common) -> Result<Outcome> {
        let light = self.light.as_deref().map(darkroot::light::find).transpose()?;
        let request = self.shot.delivery(light, self.chart_pitch)?;
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
                self.say(found, verdicts);
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

    /// What a person is told of a picture.
    fn say(&self, found: &JudgedPicture, verdicts: &[Verdict]) {
        let delivery = &found.delivery;
        let file = shown(&found.path);
        crate::say(format_args!("{file}: {}", delivered::about(found)));
        let (s, sl1) = (delivery.de2000, delivery.sl1);
        crate::say(format_args!(
            "  dE2000 mean {:.2}, median {:.2}, 95 % {:.2}, max {:.2} (SL = 1: mean {:.2}, max {:.2})",
            s.mean, s.median, s.p95, s.max, sl1.mean, sl1.max
        ));
        let mut greys: Vec<&Grey> = Vec::new();
        for grey in &delivery.greys {
            // Large charts have many greys of one lightness: the one that is most off stands for them.
            match greys.last_mut().filter(|last| (last.truth.l - grey.truth.l).abs() < SAME) {
                Some(last) if last.lightness_error().abs() < grey.lightness_error().abs() => *last = grey,
                Some(_) => {}
                None => greys.push(grey),
            }
        }
        let greys: Vec<String> =
            greys.iter().map(|g| format!("{:.1} ({:+.2})", g.found.l, g.lightness_error())).collect();
        crate::say(format_args!("  greys, L* (error): {}", greys.join(", ")));
        say_details(&delivery.details);
        for guideline in &GUIDELINES {
            let levels: Vec<String> = guideline
                .rows
                .iter()
                .map(|row| (row.metric.short(), delivered::level(guideline, row, found)))
                .filter(|(_, level)| *level != "–")
                .map(|(name, level)| format!("{name} {level}"))
                .collect();
            crate::say(format_args!("  {}: {}", guideline.name, levels.join(", ")));
        }
        for note in &delivery.notes {
            crate::say(format_args!("  note: {}", shown(note)));
        }
        for verdict in verdicts {
            let mark = match verdict.kept() {
                Some(true) => "PASS",
                Some(false) => "FAIL",
                None => "    ",
            };
            crate::say(format_args!("  {mark} {verdict} [{}]", verdict.source));
        }
        if let Some(asked) = self.asked_in_words() {
            let passed = verdicts.iter().all(|verdict| verdict.kept() != Some(false));
            crate::say(format_args!("{file}: {} ({asked})", if passed { "PASS" } else { "FAIL" }));
        }
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

/// What edges, the grid and an even surface tell.
fn say_details(details: &Details) {
    if let Some(edges) = details.edges {
        crate::say(format_args!(
            "  edges ({}): SFR50 {:.3}, SFR10 {:.3} cycles a pixel, largest response {:.2}, red and blue off by {:.2} pixels",
            edges.count, edges.sfr50, edges.sfr10, edges.peak, edges.misregistration
        ));
    }
    if let Some(scale) = details.scale {
        let stated = scale.stated.map_or("states none".to_owned(), |stated| {
            format!("stated {stated:.0}, {:+.1} %", 100.0 * (scale.found / stated - 1.0))
        });
        crate::say(format_args!("  scale: {:.1} pixels an inch ({stated})", scale.found));
    }
    if let Some(grid) = details.distortion {
        crate::say(format_args!(
            "  grid ({} patches): distortion {:.2} % of the diagonal, {:.2} pixels",
            grid.patches, grid.percent, grid.pixels
        ));
    }
    if let Some(even) = details.uniformity {
        crate::say(format_args!(
            "  even surface: luminance differs by {:.1} %, L* by {:.2}, a*b* by {:.2}",
            even.luminance, even.lightness, even.colour
        ));
    }
}
