//! What a person is told of a finished picture.

use darkroot::deliver::{Details, GUIDELINES, Grey, JudgedPicture, Metric, Verdict};
use darkroot::report::delivered;
use darkroot::shown;

/// L* up to which greys count as one.
const SAME: f64 = 1.0;

/// What a person is told of a picture.
pub(super) fn say(found: &JudgedPicture, verdicts: &[Verdict], asked: Option<&str>) {
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
    say_noise(found);
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
    if let Some(asked) = asked {
        let passed = verdicts.iter().all(|verdict| verdict.kept() != Some(false));
        crate::say(format_args!("{file}: {} ({asked})", if passed { "PASS" } else { "FAIL" }));
    }
}

/// What the noise of the greys tells.
fn say_noise(found: &JudgedPicture) {
    let delivery = &found.delivery;
    if let Some(seen) = delivery.value(Metric::VisualNoise, false) {
        crate::say(format_args!(
            "  visual noise (ISO 15739:2013, {:.0} pixels a degree): {seen} at most",
            found.pixels_per_degree
        ));
    }
    if let Some(range) = delivery.dynamic_range {
        crate::say(format_args!(
            "  dynamic range: {:.1} stops estimated by the noise of the greys, {:.1} that can be relied on, {:.1} shown by the chart",
            range.stops, range.least, range.shown
        ));
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
    if let Some(bands) = details.banding {
        let one = |bands: &darkroot::deliver::Bands| match bands.worst {
            Some((off, line)) => format!("{:.3} (line {line} by {off:+.2})", bands.deviation),
            None => format!("none above {:.3}", bands.noise),
        };
        crate::say(format_args!(
            "  banding, L* over lines: rows {}, columns {}",
            one(&bands.rows),
            one(&bands.columns)
        ));
    }
}
