//! `darkroot profile apply`.

use std::io::Write as _;

use anyhow::{Context as _, Result, bail};
use clap::Args;
use profile::Profile;

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
        let model = model(&profile, self.light.as_deref())?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(std::io::stdin().lock());
        let head = reader.headers().context("stdin")?.clone();
        let column = |name: &str| {
            let place = head.iter().position(|h| h.eq_ignore_ascii_case(name));
            place.with_context(|| format!("stdin: has no column `{name}`; its first row must be r,g,b"))
        };
        let columns = [column("r")?, column("g")?, column("b")?];
        let mut out = std::io::BufWriter::new(std::io::stdout().lock());
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

/// The model for a light by its name or temperature; the only one where none is named.
fn model(profile: &Profile, light: Option<&str>) -> Result<profile::Model> {
    let names: Vec<&str> = profile.calibrations().iter().map(|c| c.light.name.as_str()).collect();
    let choices = names.join(", ");
    match (light, profile.calibrations()) {
        (None, [only]) => Ok(only.model.clone()),
        (None, _) => bail!("the profile has calibrations for {choices}; choose one with `--light`"),
        (Some(light), all) => {
            if let Some(found) = all.iter().find(|c| c.light.name.eq_ignore_ascii_case(light)) {
                return Ok(found.model.clone());
            }
            let kelvin = light.strip_suffix(['K', 'k']).and_then(|n| n.trim().parse::<f64>().ok());
            match kelvin.filter(|k| *k > 0.0 && k.is_finite()) {
                Some(kelvin) => Ok(profile.model_for(kelvin)),
                None => bail!(
                    "the profile has no light `{light}`; it has {choices}, or take a temperature (4000K)"
                ),
            }
        }
    }
}
