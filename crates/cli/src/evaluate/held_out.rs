//! `darkroot evaluate --held-out`.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Result, bail};
use darkroot::LightSource;
use darkroot::evaluate::ReflectanceSet;
use darkroot::evaluate::held_out::{Judgement, MODELS, Request, evaluate};
use darkroot::shown;
use darkroot_profile::Kind;

use super::Knowledge;
use crate::Outcome;

pub(super) fn run(
    knowledge: Knowledge,
    cameras: Vec<PathBuf>,
    judged: Vec<ReflectanceSet>,
    lights: Vec<LightSource>,
) -> Result<Outcome> {
    let Some(chart) = knowledge.chart()? else {
        bail!("give the chart that the models are fitted to: `--chart NAME=FILE`")
    };
    let fitted_to = format!("{} ({} patches)", shown(&chart.name), chart.reflectances.len());
    let names: Vec<String> = judged.iter().map(|set| set.name.clone()).collect();
    let outcome = evaluate(&Request {
        surfaces: knowledge.surfaces()?,
        cameras,
        prior: knowledge.prior,
        chart,
        judged,
        lights: lights.clone(),
        between: knowledge.between,
    })?;
    super::say_left_out(outcome.surfaces_left_out);
    let mut out = crate::out::lines();
    for light in &lights {
        let light = light.light.name.as_str();
        let results: Vec<&Judgement> = outcome.results.iter().filter(|r| r.light == light).collect();
        let count = results.len() / MODELS.len();
        writeln!(out, "{}, {count} cameras, fitted to {fitted_to}, dE2000", shown(light))?;
        writeln!(out, "  {:13} mean   95 %   max   by set: {}", "", shown(&names.join(", ")))?;
        for kind in MODELS {
            let of_kind: Vec<&Judgement> = results.iter().filter(|r| r.kind == kind).copied().collect();
            write_model(&mut out, kind, &of_kind)?;
            if knowledge.each {
                for result in of_kind {
                    writeln!(out, "      {:30} {:.2}", shown(&result.camera), result.errors.mean)?;
                }
            }
        }
        writeln!(out)?;
    }
    Ok(Outcome::Done)
}

fn write_model(out: &mut impl std::io::Write, kind: Kind, results: &[&Judgement]) -> Result<()> {
    let count = results.len().max(1) as f64;
    let mean = |of: &dyn Fn(&Judgement) -> f64| results.iter().map(|r| of(r)).sum::<f64>() / count;
    let sets = results.first().map_or(0, |r| r.sets.len());
    let sets: Vec<String> = (0..sets).map(|i| format!("{:.2}", mean(&|r| r.sets[i]))).collect();
    let kind = kind.to_string();
    let [all, p95, max] = [mean(&|r| r.errors.mean), mean(&|r| r.errors.p95), mean(&|r| r.errors.max)];
    writeln!(out, "  {kind:13} {all:.3}  {p95:5.2}  {max:5.1}   {}", sets.join(" "))?;
    Ok(())
}
