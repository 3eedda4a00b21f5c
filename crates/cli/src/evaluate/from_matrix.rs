//! `darkroot evaluate --from-matrix`.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use darkroot::evaluate::from_matrix::{Judgement, Method, Request, evaluate};
use darkroot::evaluate::{ReflectanceSet, published};
use darkroot::light::LightSource;
use darkroot::shown;

use super::Knowledge;
use crate::Outcome;

/// How much worse than its matrix an estimate may be before it is named, mean dE2000.
const WORSE: f64 = 0.1;

#[derive(Debug, Args)]
pub(super) struct FromMatrix {
    /// CSV of published matrices: make, model, D65_00 ... D65_22; judges cameras estimated from them
    #[arg(long, value_name = "FILE", requires_all = ["prior", "reflectances"])]
    from_matrix: Option<PathBuf>,
}

impl FromMatrix {
    pub(super) fn is_asked(&self) -> bool {
        self.from_matrix.is_some()
    }

    pub(super) fn run(
        self,
        knowledge: Knowledge,
        cameras: Vec<PathBuf>,
        judged: Vec<ReflectanceSet>,
        lights: Vec<LightSource>,
    ) -> Result<Outcome> {
        let names: Vec<String> = judged.iter().map(|set| set.name.clone()).collect();
        let outcome = evaluate(&Request {
            published: published::read(&self.from_matrix.unwrap_or_default())?,
            surfaces: knowledge.surfaces()?,
            chart: knowledge.chart()?,
            prior: knowledge.prior,
            cameras,
            judged,
            lights: lights.clone(),
            between: knowledge.between,
        })?;
        for path in &outcome.without_matrix {
            crate::say(format_args!("left out, no published matrix: {}", shown(path)));
        }
        super::say_left_out(outcome.surfaces_left_out);
        let mut out = crate::out::lines();
        for light in &lights {
            let light = light.light.name.as_str();
            let results: Vec<&Judgement> = outcome.results.iter().filter(|r| r.light == light).collect();
            write_light(&mut out, light, &results, &names)?;
            if knowledge.each {
                for result in results {
                    let figures: Vec<String> =
                        result.errors.iter().map(|(_, e)| format!("{:.2}", e.mean)).collect();
                    let [estimate, matrix] = result.expected;
                    let camera = shown(&result.camera);
                    let figures = figures.join("  ");
                    writeln!(
                        out,
                        "    {camera:34} {figures}   expected {estimate:.2}, of the matrix {matrix:.2}"
                    )?;
                }
            }
        }
        Ok(Outcome::Done)
    }
}

fn write_light(
    out: &mut impl std::io::Write,
    light: &str,
    results: &[&Judgement],
    names: &[String],
) -> Result<()> {
    let count = results.len().max(1) as f64;
    writeln!(out, "{}, {} cameras, dE2000", shown(light), results.len())?;
    writeln!(out, "  {:40} mean   95 %   max   by set: {}", "", shown(&names.join(", ")))?;
    let mut means: BTreeMap<&str, [f64; 3]> = BTreeMap::new();
    for method in Method::ALL {
        let (mut sums, mut sets, mut seen) = ([0.0; 3], vec![0.0; names.len()], false);
        for result in results {
            for (_, e) in result.errors.iter().filter(|(m, _)| *m == method) {
                seen = true;
                for (sum, value) in sums.iter_mut().zip([e.mean, e.p95, e.max]) {
                    *sum += value / count;
                }
                match method {
                    Method::Matrix => means.entry(&result.camera).or_default()[0] = e.mean,
                    Method::Spectrum => means.entry(&result.camera).or_default()[1] = e.mean,
                    Method::White => means.entry(&result.camera).or_default()[2] = e.mean,
                    Method::Chart => {}
                }
            }
            for (_, each) in result.sets.iter().filter(|(m, _)| *m == method) {
                sets.iter_mut().zip(each).for_each(|(sum, value)| *sum += value / count);
            }
        }
        if seen {
            let sets: Vec<String> = sets.iter().map(|mean| format!("{mean:.2}")).collect();
            let [mean, p95, max] = sums;
            writeln!(out, "  {method:40} {mean:.3}  {p95:5.2}  {max:5.1}   {}", sets.join(" "))?;
        }
    }
    for (known, k) in [("spectrum", 1), ("white", 2)] {
        let worst = means.iter().max_by(|a, b| a.1[k].total_cmp(&b.1[k]));
        if let Some((camera, errors)) = worst {
            let camera = shown(camera);
            writeln!(
                out,
                "  worst, {known} known: {camera} with {:.2} (its matrix {:.2})",
                errors[k], errors[0]
            )?;
        }
        for (camera, errors) in means.iter().filter(|(_, e)| e[k] > e[0] + WORSE) {
            let camera = shown(camera);
            writeln!(out, "  worse than its matrix: {camera} {:.2} against {:.2}", errors[k], errors[0])?;
        }
    }
    write_noise(out, results)?;
    writeln!(out)?;
    Ok(())
}

/// Noise in dark saturated colours against that of matrices, white known.
fn write_noise(out: &mut impl std::io::Write, results: &[&Judgement]) -> Result<()> {
    for of in [Method::Matrix, Method::Chart] {
        let growth = |r: &Judgement| r.noise.iter().find(|(m, _)| *m == of).map(|(_, growth)| *growth);
        let mut all: Vec<(f64, &str)> =
            results.iter().filter_map(|r| Some((growth(r)?, r.camera.as_str()))).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some((most, camera)), count) = (all.last(), all.len() as f64) else { continue };
        let mean = all.iter().map(|(growth, _)| growth).sum::<f64>() / count;
        let camera = shown(camera);
        writeln!(
            out,
            "  noise in dark saturated colours, white known: {mean:.2} times that of {of} (worst {most:.2}, {camera})"
        )?;
    }
    Ok(())
}
