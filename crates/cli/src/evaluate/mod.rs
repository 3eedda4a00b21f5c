//! `darkroot evaluate`.

mod from_matrix;
mod held_out;
mod levels;

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use darkroot::evaluate::{ReflectanceSet, Row, in_brief, read_set, table};
use darkroot::spectra;
use darkroot_colour::Spectrum;

use crate::Outcome;

/// Print figures that anybody can compute again: the papers' tables, and colours that nothing has seen
///
/// Each model (linear, polynomial-2 to -4, root-2 to -4) is fitted by plain least squares at exposure 1 to a set of
/// reflectances under a light, and judged by dE*uv (mean, median, 95th percentile, max) on each colour left out, at
/// each exposure. Beside it stand the figures of the paper (CIC 2011, tables 1 and 2) where the camera is the Sony
/// DXC-930, the light D65 and the set called SG, DC or SFU.
///
/// With `--from-matrix` each camera is estimated from its published matrix instead, with itself and its twins left out of all
/// that the estimate rests on, and judged by its real sensitivities (docs/colour.md has the table and the command).
///
/// With `--held-out` the models are fitted to the patches of a chart and judged on other surfaces, with the camera, its
/// twins and those surfaces left out of all that the models rest on: nothing that is judged can leak into what judges it.
///
/// With `--shots` the models are fitted to a real shot of a chart and judged under other levels of light, as in the paper's
/// table 3, whose figures stand beside.
#[derive(Debug, Args)]
pub(crate) struct Evaluate {
    /// CSV of a camera's sensitivities; several may be given
    #[arg(long = "sensitivities", value_name = "FILE", required_unless_present = "shots", num_args = 1..)]
    cameras: Vec<PathBuf>,

    /// Reflectances: NAME=FILE.csv, or NAME=FILE.csv:LIST.txt to take only the spectra that a text file lists, or sky: blue
    /// skies as surfaces, computed
    #[arg(long = "set", value_name = "NAME=FILE", required_unless_present = "shots", num_args = 1..)]
    sets: Vec<String>,

    /// Light: D65, A, LED-B3, 5500K, lamp.csv, lamps.csv:NAME; several may be given
    #[arg(long = "light", value_name = "LIGHT", default_value = "D65", num_args = 1..)]
    lights: Vec<String>,

    /// Exposures to judge at, relative to that of the fit
    #[arg(long, value_name = "FACTORS", value_delimiter = ',', default_value = "1,0.5,1.5", value_parser = factor)]
    exposures: Vec<f64>,

    #[command(flatten)]
    knowledge: Knowledge,

    #[command(flatten)]
    from_matrix: from_matrix::FromMatrix,

    /// Judge the models of a chart on surfaces, with cameras, that nothing they rest on has seen
    #[arg(long, requires_all = ["prior", "reflectances", "chart"], conflicts_with = "from_matrix")]
    held_out: bool,

    #[command(flatten)]
    shots: levels::FromShots,
}

/// What estimates and models rest on.
#[derive(Debug, Args)]
struct Knowledge {
    /// CSV of sensitivities to rest on; several, each left out where it or a twin is judged
    #[arg(long, value_name = "FILE", num_args = 1..)]
    prior: Vec<PathBuf>,

    /// CSV of reflectances to rest on; those that are judged on are left out
    #[arg(long, value_name = "FILE", num_args = 1..)]
    reflectances: Vec<PathBuf>,

    /// A chart, NAME=FILE.csv: the one that models are fitted to; with `--from-matrix` a matrix, for comparison
    #[arg(long, value_name = "NAME=FILE")]
    chart: Option<String>,

    /// Wavelengths that count, nm: many sensitivities were measured over less than the whole range
    #[arg(long, value_name = "NM-NM", default_value = "400-700", value_parser = range)]
    between: (f64, f64),

    /// A line for each camera
    #[arg(long)]
    each: bool,
}

impl Knowledge {
    /// The surfaces, read.
    fn surfaces(&self) -> Result<Vec<Spectrum>> {
        let mut surfaces = Vec::new();
        for path in &self.reflectances {
            surfaces.extend(spectra::read(path)?.reflectances());
        }
        Ok(surfaces)
    }

    /// The chart, read.
    fn chart(&self) -> Result<Option<ReflectanceSet>> {
        Ok(self.chart.as_deref().map(read_set).transpose()?)
    }
}

fn range(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once('-').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    ends.filter(|(a, b)| *a >= 380.0 && *a <= 450.0 && *b >= 650.0 && *b <= 780.0)
        .ok_or_else(|| format!("`{text}` is no range of wavelengths like 400-700 that holds 450 to 650 nm"))
}

/// Says how many surfaces the prior lost.
fn say_left_out(count: usize) {
    if count > 0 {
        crate::say(format_args!("left out of the prior because they are judged on: {count} surfaces"));
    }
}

fn factor(text: &str) -> Result<f64, String> {
    let factor: Option<f64> = text.trim().parse().ok().filter(|f| (1e-3..=1e3).contains(f));
    factor.ok_or_else(|| format!("`{text}` is no factor of light between 0.001 and 1000"))
}

impl Evaluate {
    pub(crate) fn run(self) -> Result<Outcome> {
        let sets = self.sets.iter().map(|s| read_set(s)).collect::<Result<Vec<_>, _>>()?;
        let lights = self.lights.iter().map(|l| darkroot::light::find(l)).collect::<Result<Vec<_>, _>>()?;
        if self.shots.is_asked() {
            return self.shots.run();
        }
        if self.from_matrix.is_asked() {
            return self.from_matrix.run(self.knowledge, self.cameras, sets, lights);
        }
        if self.held_out {
            return held_out::run(self.knowledge, self.cameras, sets, lights);
        }
        let mut out = crate::out::lines();
        for camera in &self.cameras {
            let name = camera.file_stem().unwrap_or_default().to_string_lossy();
            for light in &lights {
                for set in &sets {
                    for exposure in &self.exposures {
                        let rows = table(camera, light, set, *exposure)?;
                        let (light, count) = (&light.light.name, set.reflectances.len());
                        writeln!(
                            out,
                            "{name}, {light}, {} ({count} colours), exposure x{exposure}",
                            set.name
                        )?;
                        write_rows(&mut out, &rows)?;
                    }
                }
            }
        }
        Ok(Outcome::Done)
    }
}

fn write_rows(out: &mut impl std::io::Write, rows: &[Row]) -> Result<()> {
    let with_paper = rows.iter().any(|row| row.paper.is_some());
    let paper = if with_paper { "   paper: mean median   95 %" } else { "" };
    writeln!(out, "  {:13}  mean median   95 %    max{paper}", "dE*uv")?;
    for row in rows {
        let own = row.errors.map_or_else(
            || "too few colours".to_owned(),
            |e| format!("{} {:6.1}", in_brief(&e.de_uv), e.de_uv.max),
        );
        let paper = row.paper.map_or_else(String::new, |[mean, median, p95]| {
            format!("           {mean:4.1}    {median:3.1}   {p95:4.1}")
        });
        writeln!(out, "  {:13} {own}{paper}", row.kind.to_string())?;
    }
    writeln!(out)?;
    Ok(())
}
