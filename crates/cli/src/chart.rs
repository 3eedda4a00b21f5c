//! `darkroot chart`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use darkroot::find_chart::{Found, FoundCharts, preview};
use darkroot::{Settings, charts, find_charts, path_text, shown};
use serde_json::json;

use crate::deadline::Deadline;
use crate::sandbox::{self, Sandbox};
use crate::{Common, Outcome};

/// Find colour charts in raw files and pictures: corners, which chart, which way round
///
/// Exit code 1 when a file shows none.
#[derive(Debug, Args)]
pub(crate) struct Chart {
    /// Raw files, or JPEG, PNG and TIFF pictures
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Look for this chart only: classic24, passport24, mini24, nano24, sg140, dc240, spyder24, spyder48, or a file that
    /// describes one; several may be given
    #[arg(long = "chart", value_name = "CHART")]
    charts: Vec<String>,

    #[command(flatten)]
    deadline: Deadline,

    #[command(flatten)]
    sandbox: Sandbox,

    /// One line of JSON for each file
    #[arg(long)]
    json: bool,

    /// Write a PNG of the one FILE with grid, patches and numbers over it
    #[arg(long, value_name = "OUT.png")]
    preview: Option<PathBuf>,

    /// Replace an existing preview
    #[arg(long, requires = "preview")]
    overwrite: bool,
}

impl Chart {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        if self.preview.is_some() && self.files.len() > 1 {
            bail!("`--preview` shows one file; name one");
        }
        let layouts = if self.charts.is_empty() {
            charts::layouts()
        } else {
            self.charts.iter().map(|c| charts::layout(c)).collect::<Result<_, _>>()?
        };
        self.sandbox.say(common);
        let reach = sandbox::reading(&self.files);
        let reach = self.preview.iter().fold(reach, |reach, preview| sandbox::writing(reach, preview));
        self.sandbox.confine(&reach)?;
        common.start_threads();
        let settings = Settings::default();
        let mut outcome = Outcome::Done;
        for (number, file) in self.files.iter().enumerate() {
            let after = self.files.len() - number - 1;
            let look = || find_charts(file, &layouts, &settings);
            let found = match self.deadline.over(file, after, |_| (), look) {
                Ok(found) => found,
                Err(fault) => {
                    crate::say(format_args!("error: {}", crate::hint::words(&fault)));
                    outcome = Outcome::SomeFailed;
                    continue;
                }
            };
            if let Some(output) = &self.preview {
                preview(file, &found, output, self.overwrite, &settings)?;
            }
            if found.search.found.is_empty() {
                outcome = Outcome::SomeFailed;
            }
            match self.json {
                true => writeln!(crate::out::json(), "{}", json(file, &found))?,
                false => writeln!(crate::out::lines(), "{}", words(file, &found))?,
            }
        }
        Ok(outcome)
    }
}

fn json(file: &Path, found: &FoundCharts) -> serde_json::Value {
    let chart = |c: &Found| {
        json!({
            "chart": c.layout,
            "corners": c.corners,
            "confidence": c.confidence,
            "rotation": c.rotation_degrees,
            "patch_pixels": c.patch_pixels,
            "gap": c.gap,
            "grid": [c.columns, c.rows],
            "centres": (0..c.columns * c.rows).map(|i| c.centre(i)).collect::<Vec<_>>(),
        })
    };
    json!({
        "file": path_text::text(file),
        "size": [found.size.width, found.size.height],
        "charts": found.search.found.iter().map(chart).collect::<Vec<_>>(),
        "refused": found.search.rejected.as_ref().map(|r| r.reason.to_string()),
    })
}

/// A line for each chart, or one that says why there is none.
fn words(file: &Path, found: &FoundCharts) -> String {
    let file = shown(file);
    let chart = |c: &Found| {
        let corners: Vec<String> = c.corners.iter().flatten().map(|v| format!("{v:.1}")).collect();
        format!(
            "{file}: {} turned by {:.0} degrees, confidence {:.2}, patches of {:.0} pixels, corners {}",
            shown(&c.layout),
            c.rotation_degrees,
            c.confidence,
            c.patch_pixels,
            corners.join(",")
        )
    };
    if found.search.found.is_empty() {
        let reason = found.search.rejected.as_ref().map_or_else(String::new, |r| format!(": {}", r.reason));
        return format!("{file}: no chart{reason}");
    }
    found.search.found.iter().map(chart).collect::<Vec<_>>().join("\n")
}
