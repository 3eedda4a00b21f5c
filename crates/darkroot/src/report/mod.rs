//! The report on a profile: one HTML page with everything in it, nothing from the network.

pub mod delivered;
mod measured;
mod plots;
mod shown;
mod tables;

use darkroot_calibrate::{Calibrated, JudgedPatch};
use darkroot_chart::ChartLayout;
use darkroot_colour::{RgbSpace, Vector3, Xyz, white};
use darkroot_profile::{Errors, Kind};
use maud::{Markup, html};

use crate::make_profile::{MadeLight, MadeProfile};
use crate::page::{STYLE, page};
use crate::shot::{Gate, Verdict};

/// The page.
pub fn html(made: &MadeProfile, layout: &ChartLayout) -> String {
    let camera = made.profile.camera().name();
    let body = html! {
        header {
            h1 { (camera) }
            p { (made.profile.origin().summary) }
        }
        @for light in &made.lights { (section(light, layout)) }
        (provenance(made))
    };
    page(&format!("Profile of {camera}"), STYLE, body)
}

fn section(light: &MadeLight, layout: &ChartLayout) -> Markup {
    let Calibrated { calibration, patches, .. } = &light.calibrated;
    html! {
        section {
            h2 {
                (calibration.light.name) " "
                small { (format!("{:.0} K, model ", calibration.light.kelvin())) b { (calibration.kind) } }
            }
            (headline(light))
            div.columns {
                @if let Some(shot) = light.shots.first() {
                    (shown::picture(&light.view, &light.calibrated, shot))
                }
                (gates(light))
            }
            h3 { "Patches: as measured | as reference | as corrected" }
            (swatches(patches, layout))
            p.legend { "dE2000 by the profile, and by a fit without the patch." }
            (tables::models(&light.calibrated))
            (tables::exposures(&light.calibrated))
            div.columns {
                (plots::vectors(patches))
                (plots::lightness(patches))
                (plots::trust(calibration, patches))
            }
            (notes(light))
        }
    }
}

/// The figures that matter, in one line.
fn headline(light: &MadeLight) -> Markup {
    let figures = &light.calibrated.calibration.figures;
    let mean = |e: Option<Errors>| e.map_or("–".to_owned(), |e| format!("{:.2}", e.de2000.mean));
    let linear = light.calibrated.compared.iter().find(|c| c.kind == Kind::Linear);
    let linear = linear.and_then(|c| c.result.as_ref().ok()).and_then(|f| f.leave_one_out);
    html! {
        p.headline {
            "Patches that the fit has not seen are off by dE2000 " b { (mean(figures.leave_one_out)) }
            " in the mean (a matrix: " (mean(linear)) "); patches that it has seen by " (mean(figures.training)) "."
        }
    }
}

fn gates(light: &MadeLight) -> Markup {
    html! {
        table.gates {
            caption { "The shot" }
            @for shot in &light.shots {
                tr {
                    th colspan="2" {
                        (shot.path.file_name().unwrap_or_default().to_string_lossy()) " "
                        small { (format!("chart found with confidence {:.2}", shot.confidence)) }
                    }
                }
                @for gate in &shot.gates { (row(gate)) }
            }
            @if light.shots.len() > 1 && !light.gates.is_empty() {
                tr { th colspan="2" { "between the shots" } }
            }
            @for gate in &light.gates { (row(gate)) }
        }
    }
}

fn row(gate: &Gate) -> Markup {
    let (class, mark) = match gate.verdict {
        Verdict::Good => ("good", "good"),
        Verdict::Warning => ("warning", "warning"),
        Verdict::Refused => ("refused", "failed"),
    };
    let advice = gate.advice();
    html! {
        tr class=(class) {
            td { (mark) }
            td { (gate.words()) @if gate.verdict != Verdict::Good && !advice.is_empty() { ": " (advice) } }
        }
    }
}

/// Every patch in the chart's own grid.
fn swatches(patches: &[JudgedPatch], layout: &ChartLayout) -> Markup {
    const SIDE: usize = 84;
    const THIRD: usize = (SIDE - 4) / 3;
    // What stands beside the grid goes on below it.
    let rows = patches.len().div_ceil(layout.columns.max(1));
    let view_box = format!("0 0 {} {}", layout.columns * SIDE, rows * (SIDE + 6));
    let one = |(i, patch): (usize, &JudgedPatch)| {
        let (x, y) = ((i % layout.columns) * SIDE, (i / layout.columns) * (SIDE + 6));
        // As measured: balanced camera RGB taken for linear sRGB.
        let colours = [coded(patch.rgb), css(patch.reference), css(patch.corrected)];
        let class = patch.excluded.as_ref().map(|_| "excluded");
        html! {
            @for (k, colour) in colours.iter().enumerate() {
                rect x=(x + k * THIRD) y=(y) width=(THIRD) height=(SIDE - 20) fill=(colour) {}
            }
            rect.outline x=(x) y=(y) width=(3 * THIRD) height=(SIDE - 20) {}
            text class=[class] x=(x) y=(y + SIDE - 12) {
                @match &patch.excluded {
                    Some(reason) => { (reason) }
                    None => {
                        (format!("{:.2} ", patch.de2000))
                        tspan.unseen { (format!("{:.2}", patch.left_out.unwrap_or(patch.de2000))) }
                    }
                }
            }
            text.name x=(x) y=(y + SIDE - 3) { (patch.name) }
        }
    };
    html! {
        svg.swatches viewBox=(view_box) role="img" aria-label="patches" {
            @for patch in patches.iter().enumerate() { (one(patch)) }
        }
    }
}

fn notes(light: &MadeLight) -> Markup {
    let mut notes: Vec<String> =
        light.shots.iter().flat_map(|s| &s.notes).chain(&light.calibrated.notes).cloned().collect();
    notes.extend(light.white_balance.map(|[red, _, blue]| {
        format!(
            "the white balance in the file is not that of the chart's light: to see the chart as it is, develop with the \
             white balance {red:.3},1,{blue:.3}"
        )
    }));
    html! {
        @if !notes.is_empty() {
            ul.notes { @for note in &notes { li { (note) } } }
        }
    }
}

fn provenance(made: &MadeProfile) -> Markup {
    let origin = made.profile.origin();
    let rows = [
        ("chart", &origin.chart),
        ("reference", &origin.reference),
        ("SHA-256 of the reference", &origin.reference_sha256),
        ("date", &origin.date),
        ("program", &origin.program),
    ];
    html! {
        section {
            h2 { "Where it comes from" }
            table.models {
                @for (label, value) in rows.iter().filter(|(_, value)| !value.is_empty()) {
                    tr { td { (label) } td.words { (value) } }
                }
            }
        }
    }
}

/// A colour relative to D50 as CSS has it.
fn css(xyz: Xyz) -> String {
    let rgb = RgbSpace::SRGB.from_xyz_under(white::D50) * Vector3::from(xyz);
    coded(rgb.into())
}

/// Linear sRGB as CSS has it.
fn coded(rgb: [f64; 3]) -> String {
    let [r, g, b] = rgb.map(|v| (RgbSpace::SRGB.curve.encode(v.clamp(0.0, 1.0)) * 255.0).round());
    format!("rgb({r},{g},{b})")
}
