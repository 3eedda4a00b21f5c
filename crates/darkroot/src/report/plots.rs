//! Plots of a calibration as SVG.

use std::fmt::Write as _;

use darkroot_colour::{Lab, Xyz, white};
use darkroot_profile::{Calibration, lint};

use super::css;
use crate::calibrate::Judged;

const SIDE: f64 = 320.0;

fn used(patches: &[Judged]) -> impl Iterator<Item = &Judged> {
    patches.iter().filter(|p| p.excluded.is_none())
}

fn lab(xyz: Xyz) -> Lab {
    xyz.lab(white::D50)
}

fn open(svg: &mut String, label: &str) {
    let _ = write!(
        svg,
        "<figure><svg class=\"plot\" viewBox=\"0 0 {SIDE} {}\" role=\"img\" aria-label=\"{label}\">",
        SIDE + 20.0
    );
}

fn close(svg: &mut String, caption: &str) {
    let _ = write!(svg, "</svg><figcaption>{caption}</figcaption></figure>");
}

/// Arrows in a*b* from each reference colour to what the profile makes of it.
pub(super) fn vectors(patches: &[Judged]) -> String {
    const STRETCH: f64 = 5.0;
    let reach =
        used(patches).map(|p| lab(p.reference)).map(|c| c.a.abs().max(c.b.abs())).fold(40.0, f64::max) * 1.15;
    let place = |a: f64, b: f64| (SIDE / 2.0 * (1.0 + a / reach), SIDE / 2.0 * (1.0 - b / reach));
    let mut svg = String::new();
    open(&mut svg, "residuals in a*b*");
    let half = SIDE / 2.0;
    let _ = write!(
        svg,
        "<path d=\"M0 {half}H{SIDE}M{half} 0V{SIDE}\" stroke=\"#ccc\" fill=\"none\"/><text x=\"{}\" y=\"{}\">a*</text>\
         <text x=\"{}\" y=\"12\">b*</text>",
        SIDE - 16.0,
        half - 4.0,
        half + 4.0
    );
    for patch in used(patches) {
        let (from, to) = (lab(patch.reference), lab(patch.corrected));
        let (x, y) = place(from.a, from.b);
        let (u, v) = place(from.a + STRETCH * (to.a - from.a), from.b + STRETCH * (to.b - from.b));
        let _ = write!(
            svg,
            "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{u:.1}\" y2=\"{v:.1}\" stroke=\"#333\"/><circle cx=\"{x:.1}\" \
             cy=\"{y:.1}\" r=\"4\" fill=\"{}\" stroke=\"#666\" stroke-width=\".5\"><title>{} dE2000 {:.2}</title></circle>",
            css(patch.reference),
            super::escape(&patch.name),
            patch.de2000
        );
    }
    close(&mut svg, "Residuals in a*b*, five times as long as they are.");
    svg
}

/// Lightness residuals over lightness.
pub(super) fn lightness(patches: &[Judged]) -> String {
    let off = |p: &Judged| lab(p.corrected).l - lab(p.reference).l;
    let reach = used(patches).map(|p| off(p).abs()).fold(1.0, f64::max) * 1.15;
    let half = SIDE / 2.0;
    let mut svg = String::new();
    open(&mut svg, "lightness residuals");
    let _ = write!(
        svg,
        "<path d=\"M0 {half}H{SIDE}\" stroke=\"#ccc\"/><text x=\"0\" y=\"12\">+{reach:.1} L*</text><text x=\"0\" \
         y=\"{}\">-{reach:.1} L*</text><text x=\"{}\" y=\"{}\">L* 100</text>",
        SIDE - 4.0,
        SIDE - 40.0,
        half + 14.0
    );
    for patch in used(patches) {
        let (x, y) = (SIDE * lab(patch.reference).l / 100.0, half * (1.0 - off(patch) / reach));
        let _ = write!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{}\" stroke=\"#666\" stroke-width=\".5\"><title>{} {:+.2}\
             </title></circle>",
            css(patch.reference),
            super::escape(&patch.name),
            off(patch)
        );
    }
    close(&mut svg, "Lightness residuals.");
    svg
}

/// Where the profile can be trusted: the disc of camera hues and saturations, grey where no patch is near and red where
/// the model folds over.
pub(super) fn trust(calibration: &Calibration, patches: &[Judged]) -> String {
    const HUES: usize = 48;
    const RINGS: usize = 10;
    let position = |rgb: [f64; 3]| {
        let largest = rgb.iter().copied().fold(1e-9, f64::max);
        let least = rgb.iter().copied().fold(f64::INFINITY, f64::min).max(0.0);
        let (angle, radius) =
            (darkroot_profile::hue_plane::position(rgb) / 6.0 * std::f64::consts::TAU, 1.0 - least / largest);
        [radius * angle.cos(), radius * angle.sin()]
    };
    let known: Vec<[f64; 2]> = used(patches).map(|p| position(p.rgb)).collect();
    let sign = calibration.model.jacobian([0.5; 3]).determinant().signum();
    let half = SIDE / 2.0;
    let mut svg = String::new();
    open(&mut svg, "where the profile can be trusted");
    for ring in 0..RINGS {
        for hue in 0..HUES {
            let (inner, outer) = (ring as f64 / RINGS as f64, (ring + 1) as f64 / RINGS as f64);
            let saturation = ((inner + outer) / 2.0).min(0.97);
            let pure = darkroot_profile::hue_plane::at_position(6.0 * (hue as f64 + 0.5) / HUES as f64);
            let rgb = pure.map(|p| (1.0 - saturation + saturation * p).max(0.02));
            let here = position(rgb);
            let near =
                known.iter().map(|[x, y]| (x - here[0]).hypot(y - here[1])).fold(f64::INFINITY, f64::min);
            let folds = calibration.model.jacobian(rgb).determinant() * sign <= 0.0;
            let fill =
                if folds { "#b00020".to_owned() } else { css(calibration.model.xyz(rgb.map(|v| v * 0.6))) };
            // Full colour beside a patch, nearly none farther than a quarter of the disc away.
            let opacity = if folds { 1.0 } else { (1.0 - near / 0.35).clamp(0.08, 1.0) };
            let angle = |i: usize| i as f64 / HUES as f64 * std::f64::consts::TAU;
            let point = |radius: f64, angle: f64| {
                format!(
                    "{:.1} {:.1}",
                    half * (1.0 + radius * angle.cos()),
                    half * (1.0 - radius * angle.sin())
                )
            };
            let _ = write!(
                svg,
                "<path d=\"M{}L{}L{}L{}Z\" fill=\"{fill}\" fill-opacity=\"{opacity:.2}\"/>",
                point(inner, angle(hue)),
                point(outer, angle(hue)),
                point(outer, angle(hue + 1)),
                point(inner, angle(hue + 1))
            );
        }
    }
    for [x, y] in &known {
        let _ = write!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.5\" fill=\"#fff\" stroke=\"#222\"/>",
            half * (1.0 + x),
            half * (1.0 - y)
        );
    }
    let folded = 100.0 * lint::folds(&calibration.model);
    close(
        &mut svg,
        &format!(
            "Camera hues (round) and saturations (outwards) with the chart's patches: pale is extrapolated, dark red folds \
             over ({folded:.1} % of the cube)."
        ),
    );
    svg
}
