//! The figures of a judged picture as JSON, for programs.

use darkroot_calibrate::delivery::{Bound, Found, GUIDELINES, Grey, Metric, UNLIMITED, Verdict};
use serde_json::{Value, json};

use super::JudgedPicture;
use crate::path_text;

/// Everything that was found in a picture, and the limits that were asked for.
pub fn figures(judged: &JudgedPicture, verdicts: &[Verdict]) -> Value {
    let delivery = &judged.delivery;
    let details = &delivery.details;
    let colour = |s: darkroot_profile::Summary| json!({"mean": s.mean, "median": s.median, "p95": s.p95, "max": s.max});
    json!({
        "file": path_text::text(&judged.path),
        "space": judged.space,
        "light": judged.light.light.name,
        "corners": judged.corners,
        "windows": judged.windows,
        "pixels_per_degree": judged.pixels_per_degree,
        "de2000": colour(delivery.de2000),
        "de2000_sl1": colour(delivery.sl1),
        "greys": delivery.greys.iter().map(grey).collect::<Vec<_>>(),
        "metrics": metrics(judged),
        "dynamic_range": delivery.dynamic_range.map(|range| json!({
            "stops": range.stops, "least": range.least, "shown": range.shown,
        })),
        "edges": details.edges.map(|e| json!({
            "count": e.count, "sfr50": e.sfr50, "sfr10": e.sfr10, "peak": e.peak, "misregistration": e.misregistration,
        })),
        "scale": details.scale.map(|scale| json!({"pixels_an_inch": scale.found, "stated": scale.stated})),
        "distortion": details.distortion.map(|grid| json!({"percent": grid.percent, "pixels": grid.pixels})),
        "even_surface": details.uniformity.map(|even| json!({
            "luminance_percent": even.luminance, "lightness": even.lightness, "colour": even.colour,
        })),
        "banding": details.banding.map(|banding| {
            let bands = |b: super::Bands| json!({"deviation": b.deviation, "worst": b.worst, "noise": b.noise});
            json!({"rows": bands(banding.rows), "columns": bands(banding.columns)})
        }),
        "limits": verdicts.iter().map(verdict).collect::<Vec<_>>(),
        "notes": delivery.notes,
    })
}

fn grey(grey: &Grey) -> Value {
    json!({
        "name": grey.name,
        "lab": [grey.found.l, grey.found.a, grey.found.b],
        "reference": [grey.truth.l, grey.truth.a, grey.truth.b],
        "noise": grey.noise.lightness,
        "luminance_noise": grey.noise.luminance,
        "visual_noise": grey.noise.visual.map(|seen| json!({
            "l": seen.l, "u": seen.u, "v": seen.v, "weighted": seen.weighted(),
        })),
    })
}

/// Each metric once, with the level that each guideline gives it and where its limits are from.
fn metrics(judged: &JudgedPicture) -> Vec<Value> {
    let found = |found: Option<Found>| found.map(|found| [found.low, found.high]);
    let limited = GUIDELINES.iter().flat_map(|guideline| {
        guideline.rows.iter().map(move |row| {
            json!({
                "metric": row.metric.name(),
                "found": found(judged.delivery.value(row.metric, guideline.sl1)),
                "guideline": guideline.name,
                "level": guideline.reached(row, &judged.delivery).map(|level| level.name),
                "source": row.source,
            })
        })
    });
    let unlimited = UNLIMITED.iter().map(|(metric, source): &(Metric, &str)| {
        json!({
            "metric": metric.name(),
            "found": found(judged.delivery.value(*metric, false)),
            "source": source,
        })
    });
    limited.chain(unlimited).collect()
}

fn verdict(verdict: &Verdict) -> Value {
    let Bound { least, most } = verdict.bound;
    json!({
        "metric": verdict.metric.name(),
        "found": verdict.found.map(|found| [found.low, found.high]),
        "least": least,
        "most": most,
        "kept": verdict.kept(),
        "source": verdict.source,
    })
}
