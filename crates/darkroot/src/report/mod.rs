//! The report on a profile: one HTML page with everything in it, nothing from the network.

mod plots;
mod shown;
pub use shown::base64;

use std::fmt::Write as _;

use darkroot_chart::Layout;
use darkroot_colour::{RgbSpace, Vector3, Xyz, white};
use darkroot_profile::{Errors, Kind};

use crate::calibrate::{Calibrated, EXPOSURES, Judged};
use crate::make_profile::{MadeLight, MadeProfile};
use crate::shot::{Gate, Verdict};

/// The page.
pub fn html(made: &MadeProfile, layout: &Layout) -> String {
    let camera = made.profile.camera().name();
    let mut page = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        page,
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>Profile of {0}</title><style>{1}</style></head><body><header><h1>{0}</h1>\
         <p>{2}</p></header>",
        escape(&camera),
        include_str!("page.css"),
        escape(&made.profile.origin().summary),
    );
    for light in &made.lights {
        section(&mut page, light, layout);
    }
    provenance(&mut page, made);
    page.push_str("</body></html>\n");
    page
}

fn section(page: &mut String, light: &MadeLight, layout: &Layout) {
    let Calibrated { calibration, patches, .. } = &light.calibrated;
    let _ = write!(
        page,
        "<section><h2>{} <small>{:.0} K, model <b>{}</b></small></h2>",
        escape(&calibration.light.name),
        calibration.light.kelvin(),
        calibration.kind
    );
    headline(page, light);
    page.push_str("<div class=\"columns\">");
    for shot in light.shots.iter().take(1) {
        page.push_str(&shown::picture(&light.view, &light.calibrated, shot));
    }
    gates(page, light);
    page.push_str("</div>");
    page.push_str("<h3>Patches: as measured | as reference | as corrected</h3>");
    page.push_str(&swatches(patches, layout));
    models(page, &light.calibrated);
    exposures(page, &light.calibrated);
    page.push_str("<div class=\"columns\">");
    page.push_str(&plots::vectors(patches));
    page.push_str(&plots::lightness(patches));
    page.push_str(&plots::trust(calibration, patches));
    page.push_str("</div>");
    notes(page, light);
    page.push_str("</section>");
}

/// The figures that matter, in one line.
fn headline(page: &mut String, light: &MadeLight) {
    let figures = &light.calibrated.calibration.figures;
    let mean = |e: Option<Errors>| e.map_or("–".to_owned(), |e| format!("{:.2}", e.de2000.mean));
    let linear = light.calibrated.compared.iter().find(|c| c.kind == Kind::Linear);
    let linear = linear.and_then(|c| c.result.as_ref().ok()).and_then(|f| f.leave_one_out);
    let _ = write!(
        page,
        "<p class=\"headline\">Patches that the fit has not seen are off by dE2000 <b>{}</b> in the mean (a matrix: {}); \
         patches that it has seen by {}.</p>",
        mean(figures.leave_one_out),
        mean(linear),
        mean(figures.training),
    );
}

fn gates(page: &mut String, light: &MadeLight) {
    page.push_str("<table class=\"gates\"><caption>The shot</caption>");
    for shot in &light.shots {
        let name = shot.path.file_name().unwrap_or_default().to_string_lossy();
        let _ = write!(
            page,
            "<tr><th colspan=\"2\">{} <small>chart found with confidence {:.2}</small></th></tr>",
            escape(&name),
            shot.confidence
        );
        shot.gates.iter().for_each(|g| gate(page, g));
    }
    if !light.gates.is_empty() {
        page.push_str("<tr><th colspan=\"2\">between the shots</th></tr>");
        light.gates.iter().for_each(|g| gate(page, g));
    }
    page.push_str("</table>");
}

fn gate(page: &mut String, Gate { verdict, words, advice, .. }: &Gate) {
    let (class, mark) = match verdict {
        Verdict::Good => ("good", "good"),
        Verdict::Warning => ("warning", "warning"),
        Verdict::Refused => ("refused", "failed"),
    };
    let advice = if *verdict == Verdict::Good { String::new() } else { format!(": {advice}") };
    let _ = write!(
        page,
        "<tr class=\"{class}\"><td>{mark}</td><td>{}{}</td></tr>",
        escape(words),
        escape(&advice)
    );
}

/// Every patch in the chart's own grid.
fn swatches(patches: &[Judged], layout: &Layout) -> String {
    const SIDE: usize = 84;
    let mut svg = format!(
        "<svg class=\"swatches\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"patches\">",
        layout.columns * SIDE,
        layout.rows * (SIDE + 6)
    );
    for (i, patch) in patches.iter().enumerate() {
        let (x, y) = ((i % layout.columns) * SIDE, (i / layout.columns) * (SIDE + 6));
        // As measured: balanced camera RGB taken for linear sRGB.
        let measured = coded(patch.rgb);
        let third = (SIDE - 4) / 3;
        for (k, colour) in [measured, css(patch.reference), css(patch.corrected)].iter().enumerate() {
            let _ = write!(
                svg,
                "<rect x=\"{}\" y=\"{y}\" width=\"{third}\" height=\"{}\" fill=\"{colour}\"/>",
                x + k * third,
                SIDE - 20
            );
        }
        let text = match &patch.excluded {
            Some(reason) => escape(reason),
            None => format!(
                "{:.2} <tspan class=\"unseen\">{:.2}</tspan>",
                patch.de2000,
                patch.left_out.unwrap_or(patch.de2000)
            ),
        };
        let class = if patch.excluded.is_some() { "excluded" } else { "" };
        let _ = write!(
            svg,
            "<text class=\"{class}\" x=\"{x}\" y=\"{}\">{text}</text><text class=\"name\" x=\"{x}\" y=\"{}\">{}</text>",
            y + SIDE - 12,
            y + SIDE - 3,
            escape(&patch.name)
        );
    }
    svg.push_str("</svg><p class=\"legend\">dE2000 by the profile, and by a fit without the patch.</p>");
    svg
}

fn models(page: &mut String, calibrated: &Calibrated) {
    page.push_str(
        "<h3>Models</h3><table class=\"models\"><tr><th>model</th><th colspan=\"4\">training</th><th colspan=\"4\">each \
         patch left out</th><th></th></tr><tr><th></th><th>mean</th><th>median</th><th>95&nbsp;%</th><th>max</th><th>mean</th>\
         <th>median</th><th>95&nbsp;%</th><th>max</th><th></th></tr>",
    );
    for compared in &calibrated.compared {
        let class = if compared.kind == calibrated.calibration.kind { " class=\"chosen\"" } else { "" };
        let _ = write!(page, "<tr{class}><td>{}</td>", compared.kind);
        match &compared.result {
            Ok(figures) => {
                for errors in [figures.training, figures.leave_one_out] {
                    match errors.map(|e| e.de2000).filter(|s| s.max.is_finite()) {
                        Some(s) => {
                            for v in [s.mean, s.median, s.p95, s.max] {
                                let _ = write!(page, "<td>{v:.2}</td>");
                            }
                        }
                        None => page.push_str("<td colspan=\"4\">not determined</td>"),
                    }
                }
                let _ = write!(page, "<td>{}</td></tr>", escape(&compared.settings));
            }
            Err(reason) => {
                let _ = write!(page, "<td colspan=\"9\">{}</td></tr>", escape(reason));
            }
        }
    }
    page.push_str("</table><p class=\"legend\">dE2000 under the light. Training error says little: any model fits what it has seen.</p>");
}

/// Every model on the same patches at other exposures.
fn exposures(page: &mut String, calibrated: &Calibrated) {
    page.push_str("<h3>Exposure</h3><table class=\"models\"><tr><th>model</th>");
    for stops in EXPOSURES {
        let _ = write!(page, "<th>{stops:+}</th>");
    }
    page.push_str("</tr>");
    for compared in &calibrated.compared {
        let Some(means) = compared.exposures else { continue };
        let class = if compared.kind == calibrated.calibration.kind { " class=\"chosen\"" } else { "" };
        let _ = write!(page, "<tr{class}><td>{}</td>", compared.kind);
        for mean in means {
            let _ = write!(page, "<td>{mean:.2}</td>");
        }
        page.push_str("</tr>");
    }
    page.push_str(
        "</table><p class=\"legend\">Mean dE2000 on the patches with so many stops more light. Of a model that keeps \
         colours at every exposure all figures of a row are the same.</p>",
    );
}

fn notes(page: &mut String, light: &MadeLight) {
    let notes: Vec<&String> =
        light.shots.iter().flat_map(|s| &s.notes).chain(&light.calibrated.notes).collect();
    if notes.is_empty() {
        return;
    }
    page.push_str("<ul class=\"notes\">");
    for note in notes {
        let _ = write!(page, "<li>{}</li>", escape(note));
    }
    page.push_str("</ul>");
}

fn provenance(page: &mut String, made: &MadeProfile) {
    let origin = made.profile.origin();
    page.push_str("<section><h2>Where it comes from</h2><table class=\"models\">");
    for (label, value) in [
        ("chart", &origin.chart),
        ("reference", &origin.reference),
        ("SHA-256 of the reference", &origin.reference_sha256),
        ("date", &origin.date),
        ("program", &origin.program),
    ] {
        if !value.is_empty() {
            let _ = write!(page, "<tr><td>{label}</td><td>{}</td></tr>", escape(value));
        }
    }
    page.push_str("</table></section>");
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

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
