//! Plots of a calibration as SVG; their numbers are those of [`darkroot_calibrate::plot`].

use darkroot_calibrate::JudgedPatch;
use darkroot_calibrate::plot::{self, Residual, TrustCell};
use darkroot_profile::{Calibration, lint};
use maud::{Markup, html};

use super::css;

const SIDE: f64 = 320.0;
const HALF: f64 = SIDE / 2.0;

/// A plot with its caption.
fn figure(label: &str, caption: &str, drawing: &Markup) -> Markup {
    html! {
        figure {
            svg.plot viewBox=(format!("0 0 {SIDE} {}", SIDE + 20.0)) role="img" aria-label=(label) { (drawing) }
            figcaption { (caption) }
        }
    }
}

/// A coordinate to a tenth of a pixel.
fn at(v: f64) -> String {
    format!("{v:.1}")
}

fn dot(x: f64, y: f64, residual: &Residual<'_>, words: &str) -> Markup {
    let fill = css(residual.patch.reference);
    html! {
        circle cx=(at(x)) cy=(at(y)) r="4" fill=(fill) stroke="#666" stroke-width=".5" {
            title { (residual.patch.name) " " (words) }
        }
    }
}

/// Arrows in a*b* from each reference colour to what the profile makes of it.
pub(super) fn vectors(patches: &[JudgedPatch]) -> Markup {
    const STRETCH: f64 = 5.0;
    let residuals = plot::residuals(patches);
    let reach =
        residuals.iter().map(|r| r.expected.a.abs().max(r.expected.b.abs())).fold(40.0, f64::max) * 1.15;
    let place = |a: f64, b: f64| (HALF * (1.0 + a / reach), HALF * (1.0 - b / reach));
    let arrow = |r: &Residual<'_>| {
        let (from, to) = (r.expected, r.found);
        let (x, y) = place(from.a, from.b);
        let (u, v) = place(from.a + STRETCH * (to.a - from.a), from.b + STRETCH * (to.b - from.b));
        html! {
            line x1=(at(x)) y1=(at(y)) x2=(at(u)) y2=(at(v)) stroke="#333" {}
            (dot(x, y, r, &format!("dE2000 {:.2}", r.patch.de2000)))
        }
    };
    let drawing = html! {
        path d=(format!("M0 {HALF}H{SIDE}M{HALF} 0V{SIDE}")) stroke="#ccc" fill="none" {}
        text x=(SIDE - 16.0) y=(HALF - 4.0) { "a*" }
        text x=(HALF + 4.0) y="12" { "b*" }
        @for residual in &residuals { (arrow(residual)) }
    };
    figure("residuals in a*b*", "Residuals in a*b*, five times as long as they are.", &drawing)
}

/// Lightness residuals over lightness.
pub(super) fn lightness(patches: &[JudgedPatch]) -> Markup {
    let residuals = plot::residuals(patches);
    let off = |r: &Residual<'_>| r.found.l - r.expected.l;
    let reach = residuals.iter().map(|r| off(r).abs()).fold(1.0, f64::max) * 1.15;
    let point = |r: &Residual<'_>| {
        let (x, y) = (SIDE * r.expected.l / 100.0, HALF * (1.0 - off(r) / reach));
        dot(x, y, r, &format!("{:+.2}", off(r)))
    };
    let drawing = html! {
        path d=(format!("M0 {HALF}H{SIDE}")) stroke="#ccc" {}
        text x="0" y="12" { (format!("+{reach:.1} L*")) }
        text x="0" y=(SIDE - 4.0) { (format!("-{reach:.1} L*")) }
        text x=(SIDE - 40.0) y=(HALF + 14.0) { "L* 100" }
        @for residual in &residuals { (point(residual)) }
    };
    figure("lightness residuals", "Lightness residuals.", &drawing)
}

/// Where the profile can be trusted: the disc of camera hues and saturations, grey where no patch is near and red where
/// the model folds over.
pub(super) fn trust(calibration: &Calibration, patches: &[JudgedPatch]) -> Markup {
    let trust = plot::trust(calibration, patches);
    let cell = |cell: &TrustCell| {
        let colour = || css(calibration.model.xyz(cell.rgb.map(|v| v * 0.6)));
        let fill = if cell.folds { "#b00020".to_owned() } else { colour() };
        // Full colour beside a patch, nearly none farther than a quarter of the disc away.
        let opacity = if cell.folds { 1.0 } else { (1.0 - cell.nearest / 0.35).clamp(0.08, 1.0) };
        let ([inner, outer], [begin, end]) = (cell.radii, cell.angles);
        let point = |radius: f64, angle: f64| {
            let (x, y) = (HALF * (1.0 + radius * angle.cos()), HALF * (1.0 - radius * angle.sin()));
            format!("{x:.1} {y:.1}")
        };
        let corners = [point(inner, begin), point(outer, begin), point(outer, end), point(inner, end)];
        html! {
            path d=(format!("M{}Z", corners.join("L"))) fill=(fill) fill-opacity=(format!("{opacity:.2}")) {}
        }
    };
    let drawing = html! {
        @for one in &trust.cells { (cell(one)) }
        @for [x, y] in &trust.patches {
            circle cx=(at(HALF * (1.0 + x))) cy=(at(HALF * (1.0 - y))) r="2.5" fill="#fff" stroke="#222" {}
        }
    };
    let caption = format!(
        "Camera hues (round) and saturations (outwards) with the chart's patches: pale is extrapolated, dark red folds over \
         ({:.1} % of the cube).",
        100.0 * lint::folds(&calibration.model)
    );
    figure("where the profile can be trusted", &caption, &drawing)
}
