//! `darkroot evaluate --shots`.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use darkroot::evaluate::levels::{Level, Levels, levels};
use darkroot::{Settings, ShotOptions, charts};

use crate::Outcome;

#[derive(Debug, Args)]
pub(super) struct FromShots {
    /// Raw shots of a chart at one exposure under several levels of light, the full light first
    #[arg(long, value_name = "SHOT", num_args = 1.., requires = "measured")]
    shots: Vec<PathBuf>,

    /// Measured XYZ of every patch, a table for each shot, all in the unit that makes white about 1 (or 100) in the first
    #[arg(long, value_name = "FILE", num_args = 1.., requires = "shots")]
    measured: Vec<PathBuf>,

    /// A shot with the lens closed, to subtract from each
    #[arg(long, value_name = "FILE", requires = "shots")]
    dark: Option<PathBuf>,

    /// The chart in the shots
    #[arg(long, value_name = "CHART", default_value = "sg140", requires = "shots")]
    target: String,

    /// Corners of the chart by hand, as in `darkroot profile`
    #[arg(long, value_name = "X,Y,X,Y,X,Y,X,Y", value_parser = crate::values::corners, requires = "shots")]
    corners: Option<[[f64; 2]; 4]>,

    /// Leave out the patches of the chart's border, as the paper does with the SG
    #[arg(long, requires = "shots")]
    inner: bool,
}

impl FromShots {
    pub(super) fn is_asked(&self) -> bool {
        !self.shots.is_empty()
    }

    pub(super) fn run(self) -> Result<Outcome> {
        if self.shots.len() != self.measured.len() {
            bail!(
                "there are {} shots and {} tables of measurements; give one for each shot, in the same order",
                self.shots.len(),
                self.measured.len()
            );
        }
        let request = Levels {
            shots: self.shots.into_iter().zip(self.measured).collect(),
            layout: charts::layout(&self.target)?,
            inner: self.inner,
            options: ShotOptions {
                corners: self.corners,
                dark: self.dark,
                // A shot under little light is dark by intent.
                accept: true,
                ..ShotOptions::default()
            },
        };
        let (patches, levels) = levels(&request, &Settings::default())?;
        let mut out = crate::out::lines();
        writeln!(out, "{}, {patches} patches, dE*uv, each patch left out of its fit", request.layout.title)?;
        writeln!(out, "paper: Nikon D60, 96 patches of the Digital SG, tungsten light")?;
        for level in &levels {
            write_level(&mut out, level)?;
        }
        Ok(Outcome::Done)
    }
}

fn write_level(out: &mut impl std::io::Write, level: &Level) -> Result<()> {
    let paper = if level.paper.is_some() { "   paper: mean median   95 %    max" } else { "" };
    writeln!(out, "\n{}", level.name)?;
    writeln!(out, "  {:13}  mean median   95 %    max{paper}", "")?;
    for (place, (kind, errors)) in level.errors.iter().enumerate() {
        let own = errors.as_ref().map_or_else(
            || format!("{:27}", "too few patches"),
            |e| format!("{} {:6.1}", darkroot::evaluate::in_brief(&e.de_uv), e.de_uv.max),
        );
        let paper = level.paper.map_or_else(String::new, |rows| {
            let [mean, median, p95, max] = rows[place];
            format!("           {mean:4.1}    {median:3.1}   {p95:4.1}   {max:4.1}")
        });
        writeln!(out, "  {:13} {own}{paper}", kind.to_string())?;
    }
    Ok(())
}
