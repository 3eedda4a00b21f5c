//! `darkroot profile apply`.

use std::io::Write as _;

use anyhow::{Context as _, Result};
use clap::Args;

use crate::Outcome;

/// Camera RGB on stdin to XYZ on stdout, as CSV, for science and tests
///
/// Rows of balanced camera RGB, 1 for the white of the light, under the header `r,g,b`, become rows of XYZ relative
/// to D50, Y = 1 for the white, under the header `X,Y,Z`.
#[derive(Debug, Args)]
pub(super) struct Apply {
    /// Profile file, or the name of a camera with a profile
    profile: String,

    /// Light of the calibration, or a temperature (4000K) to interpolate at, where the profile has several
    #[arg(long, value_name = "LIGHT")]
    light: Option<String>,
}

impl Apply {
    pub(super) fn run(self) -> Result<Outcome> {
        let profile = super::store().choose(&self.profile)?.profile;
        let model = darkroot::export::calibration(&profile, self.light.as_deref())?.model;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(std::io::stdin().lock());
        let head = reader.headers().context("stdin")?.clone();
        let column = |name: &str| {
            let place = head.iter().position(|h| h.eq_ignore_ascii_case(name));
            place.with_context(|| format!("stdin: has no column `{name}`; its first row must be r,g,b"))
        };
        let columns = [column("r")?, column("g")?, column("b")?];
        let mut out = std::io::BufWriter::new(crate::out::ours());
        writeln!(out, "X,Y,Z")?;
        for record in reader.records() {
            let record = record.context("stdin")?;
            let line = record.position().map_or(0, csv::Position::line);
            let mut rgb = [0.0; 3];
            for (value, column) in rgb.iter_mut().zip(columns) {
                let cell = record.get(column).unwrap_or_default();
                let number: Option<f64> = cell.parse().ok().filter(|v: &f64| v.is_finite());
                *value = number.with_context(|| format!("stdin, line {line}: `{cell}` is not a number"))?;
            }
            let xyz = model.xyz(rgb);
            writeln!(out, "{},{},{}", xyz.x, xyz.y, xyz.z)?;
        }
        out.flush()?;
        Ok(Outcome::Done)
    }
}
