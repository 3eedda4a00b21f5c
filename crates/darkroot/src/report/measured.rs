//! What was measured of a finished picture beside its colours: greys, details, and what no guideline limits.

use maud::{Markup, html};

use crate::deliver::{Bands, JudgedPicture, UNLIMITED};

/// The grey patches: tones, white balance, noise.
pub(super) fn greys(judged: &JudgedPicture) -> Markup {
    html! {
        table.models {
            caption { "Greys" }
            tr {
                th { "patch" } th { "L*" } th { "reference" } th { "error" } th { "dE(a*b*)" } th { "noise L*" } th { "visual" }
            }
            @for grey in &judged.delivery.greys {
                tr {
                    td { (grey.name) }
                    td { (format!("{:.2}", grey.found.l)) }
                    td { (format!("{:.2}", grey.truth.l)) }
                    td { (format!("{:+.2}", grey.lightness_error())) }
                    td { (format!("{:.2}", grey.colour_error())) }
                    td { (format!("{:.2}", grey.noise.lightness)) }
                    td { (grey.noise.visual.map_or("–".to_owned(), |seen| format!("{:.2}", seen.weighted()))) }
                }
            }
        }
    }
}

/// What edges, the grid and an even surface tell.
pub(super) fn details(judged: &JudgedPicture) -> Markup {
    let details = &judged.delivery.details;
    let mut rows: Vec<(&str, String)> = Vec::new();
    if let Some(edges) = details.edges {
        rows.push(("slanted edges", edges.count.to_string()));
        rows.push(("SFR50, cycles a pixel", format!("{:.3}", edges.sfr50)));
        rows.push(("SFR10, cycles a pixel, at most 0.5", format!("{:.3}", edges.sfr10)));
        rows.push(("largest response", format!("{:.2}", edges.peak)));
        rows.push(("red and blue beside green, pixels", format!("{:.2}", edges.misregistration)));
    }
    if let Some(scale) = details.scale {
        rows.push(("pixels an inch, by the chart", format!("{:.1}", scale.found)));
        rows.extend(scale.stated.map(|stated| ("pixels an inch, as stated", format!("{stated:.1}"))));
    }
    if let Some(grid) = details.distortion {
        rows.push(("distortion of the grid, % of the diagonal", format!("{:.2}", grid.percent)));
    }
    if let Some(even) = details.uniformity {
        rows.push(("even surface: luminance, %", format!("{:.1}", even.luminance)));
        rows.push(("even surface: L*", format!("{:.2}", even.lightness)));
        rows.push(("even surface: a*b*", format!("{:.2}", even.colour)));
    }
    if let Some(bands) = details.banding {
        rows.push(("even surface: banding of rows, L*", banded(&bands.rows)));
        rows.push(("even surface: banding of columns, L*", banded(&bands.columns)));
    }
    if let Some(range) = judged.delivery.dynamic_range {
        rows.push((
            "dynamic range, stops, estimated by the noise of the greys",
            format!("{:.1}", range.stops),
        ));
        rows.push(("dynamic range, stops that can be relied on", format!("{:.1}", range.least)));
        rows.push(("dynamic range, stops that the chart shows", format!("{:.1}", range.shown)));
    }
    html! {
        @if !rows.is_empty() {
            table.models {
                caption { "Details and geometry" }
                @for (what, value) in &rows { tr { td { (what) } td { (value) } } }
            }
        }
    }
}

/// Bands in a word: how strong, and which line is most off.
fn banded(bands: &Bands) -> String {
    match bands.worst {
        Some((off, line)) => format!("{:.3}; line {line} by {off:+.2}", bands.deviation),
        None => format!("none above {:.3}", bands.noise),
    }
}

/// What is measured without a limit, each with its source.
pub(super) fn unlimited(judged: &JudgedPicture) -> Markup {
    html! {
        h3 { "Measured without a limit" }
        table.gates {
            tr { th { "what" } th { "found" } th { "after" } }
            @for (metric, source) in &UNLIMITED {
                tr {
                    td { (metric.name()) }
                    td {
                        @match judged.delivery.value(*metric, false) {
                            Some(found) => { (found) }
                            None => { "not measured; it takes " (metric.needs()) }
                        }
                    }
                    td { small { (source) } }
                }
            }
        }
        p.legend {
            "Visual noise is that of the picture seen with " (format!("{:.0}", judged.pixels_per_degree)) " pixels a degree."
        }
    }
}
