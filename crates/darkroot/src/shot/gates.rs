//! Whether a shot of a chart is good enough to make a profile of it.

use darkroot_chart::{EdgeWidth, Layout, Measurement, Quad, Slope};
use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Xy, Xyz};

use super::corrections::ColourChange;
use super::{ShotOptions, View};

/// How a check came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// As it should be.
    Good,
    /// Usable; it could be better.
    Warning,
    /// Not usable.
    Refused,
}

/// One check.
#[derive(Debug, Clone, PartialEq)]
pub struct Gate {
    /// What was checked ("exposure").
    pub name: &'static str,
    /// How it came out.
    pub verdict: Verdict,
    /// The measured value, in the unit that `words` say; NaN where it cannot be measured.
    pub value: f64,
    /// What was found.
    pub words: String,
    /// What to do about it.
    pub advice: String,
}

/// Share of saturation that the brightest channel of the white patch should have.
const EXPOSURE: (f64, f64) = (0.40, 0.90);
/// Below this share there is too little light to profile by.
const TOO_DARK: f64 = 0.02;
/// Slope of light over the chart: good up to, usable up to.
const EVENNESS: (f64, f64) = (0.05, 0.30);
/// Glare as a share of white.
const GLARE: (f64, f64) = (0.005, 0.03);
/// Standard error of the darkest neutral patch, relative.
const NOISE: (f64, f64) = (0.005, 0.05);
/// Smallest patch side, pixels.
const PATCH_PIXELS: (f64, f64) = (20.0, 8.0);
/// Longest edge of the chart over the opposite one.
const ANGLE: (f64, f64) = (1.15, 1.6);
/// Width of the patches' edges, 10 to 90 %, as a share of a patch. A patch is measured from 0.22 of its side on: up to the
/// first its neighbours change nothing, at the second they are 1.5 % of it in the mean and 7 % at worst (docs/charts.md).
const EDGES: (f64, f64) = (0.20, 0.40);
/// Departure of shots under one light from each other, relative, after their noise: dE2000 0.2 on a middle grey, and 0.7,
/// as much as good profiles are off.
const AGREEMENT: (f64, f64) = (0.01, 0.03);

/// Mireds from the named light from which the shot was taken in another: makers' matrices are within 20 of ordinary
/// lights, D50 and A are 150 apart.
const OTHER_LIGHT: f64 = 50.0;

/// Checks a measured shot.
#[expect(clippy::too_many_arguments, reason = "everything that was found about the shot is judged here")]
pub fn gates(
    view: &View,
    measurements: &[Measurement],
    expected: &[Xyz],
    slope: Slope,
    glare: [f64; 3],
    corners: &Quad,
    layout: &Layout,
    options: &ShotOptions,
) -> Vec<Gate> {
    let mut gates = vec![exposure(view, measurements, expected), clipping(measurements)];
    let evened = options.even_out || options.flat.is_some();
    let uneven = slope.range();
    let good = if evened { f64::INFINITY } else { EVENNESS.0 };
    gates.push(graded(
        "evenness",
        uneven,
        (good, if evened { f64::INFINITY } else { EVENNESS.1 }),
        format!("the light changes by {:.1} % over the chart", 100.0 * uneven),
        "light it from both sides or from farther away, give a `--flat`, or add `--even-out`",
    ));
    gates.push(stray_light(glare, options.correct_glare));
    gates.push(noise(measurements, expected));
    gates.push(size(corners, layout));
    gates.push(angle(corners));
    gates
}

fn stray_light(glare: [f64; 3], corrected: bool) -> Gate {
    let most = glare.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let lowest = glare.iter().copied().fold(0.0, f64::min);
    let advice = if lowest < -GLARE.0 / 2.0 {
        "the file's black level is too high: add `--correct-glare`, which takes that out too, or give a `--dark`"
    } else {
        "shade the lens, remove bright surfaces around, or add `--correct-glare`"
    };
    graded(
        "glare",
        most,
        if corrected { (f64::INFINITY, f64::INFINITY) } else { GLARE },
        format!("stray light is {} % of white", by_channel(glare)),
        advice,
    )
}

/// Shares of red, green and blue in percent, in words.
pub(super) fn by_channel([r, g, b]: [f64; 3]) -> String {
    format!("{:.2} (red), {:.2} (green), {:.2} (blue)", 100.0 * r, 100.0 * g, 100.0 * b)
}

/// Whether the light has one colour all over the chart.
pub(super) fn colour_change(change: ColourChange, evened: bool) -> Gate {
    let ColourChange { range, gain } = change;
    let (verdict, words) = if change.is_justified() {
        let verdict = if evened { Verdict::Good } else { Verdict::Warning };
        (verdict, format!("the light's colour changes by {:.1} % over the chart", 100.0 * range))
    } else {
        let words = format!(
            "no change of the light's colour over the chart is certain (taking {:.1} % out makes patches left out {:.2} \
             times as wrong)",
            100.0 * range,
            gain
        );
        (Verdict::Good, words)
    };
    let advice = "light the chart by one kind of lamp, give a `--flat`, or add `--even-out`".to_owned();
    Gate { name: "colour of light", verdict, value: range, words, advice }
}

/// Whether the light is the one that was named, by what the camera's own matrices make of its white.
pub(crate) fn light_of(found: Xy, named: Xy, name: &str) -> Gate {
    let kelvin = |xy: Xy| Temperature::of(xy).kelvin;
    let (shot, said) = (kelvin(found), kelvin(named));
    let apart = (1e6 / shot - 1e6 / said).abs();
    let near = (shot / 100.0).round() * 100.0;
    graded(
        "light",
        apart,
        (OTHER_LIGHT, f64::INFINITY),
        format!(
            "the white of the shot is that of {near:.0} K by the camera's own matrix, {apart:.0} mired from {name} \
             ({said:.0} K)"
        ),
        &format!(
            "name the light that the chart stood in (`--light {near:.0}K`, or the lamp), best with a `--reference` of spectra"
        ),
    )
}

fn graded(name: &'static str, value: f64, (good, usable): (f64, f64), words: String, advice: &str) -> Gate {
    let verdict = if value <= good {
        Verdict::Good
    } else if value <= usable {
        Verdict::Warning
    } else {
        Verdict::Refused
    };
    Gate { name, verdict, value, words, advice: advice.to_owned() }
}

fn exposure(view: &View, measurements: &[Measurement], expected: &[Xyz]) -> Gate {
    let brightest = (0..expected.len()).max_by(|a, b| expected[*a].y.total_cmp(&expected[*b].y)).unwrap_or(0);
    let white = &measurements[brightest];
    let share =
        (0..3).map(|c| white.mean[c] / f64::from(view.frame.saturation[c]).max(1e-6)).fold(0.0, f64::max);
    let words = format!("the white patch is at {:.0} % of saturation", 100.0 * share);
    let stops = (0.7 / share.max(1e-6)).log2();
    let amount = |stops: f64| match stops.abs() {
        s if s < 0.75 => "half a stop".to_owned(),
        s => format!("{s:.0} stop{}", if s >= 1.5 { "s" } else { "" }),
    };
    let (verdict, advice) = if white.clipped > 0.01 {
        (Verdict::Refused, "take it with about one stop less light".to_owned())
    } else if share < TOO_DARK {
        (Verdict::Refused, format!("take it with {} more light", amount(stops)))
    } else if share < EXPOSURE.0 {
        (Verdict::Warning, format!("{} more light would be better", amount(stops)))
    } else if share > EXPOSURE.1 {
        (Verdict::Warning, "half a stop less light would be better".to_owned())
    } else {
        (Verdict::Good, String::new())
    };
    Gate { name: "exposure", verdict, value: share, words, advice }
}

fn clipping(measurements: &[Measurement]) -> Gate {
    let clipped = measurements.iter().filter(|m| m.clipped > 0.001).count();
    let share = clipped as f64 / measurements.len().max(1) as f64;
    graded(
        "clipping",
        share,
        (0.0, 0.15),
        format!("{clipped} of {} patches are clipped", measurements.len()),
        "take it with less light",
    )
}

fn noise(measurements: &[Measurement], expected: &[Xyz]) -> Gate {
    let darkest = (0..expected.len()).min_by(|a, b| expected[*a].y.total_cmp(&expected[*b].y)).unwrap_or(0);
    let m = &measurements[darkest];
    let relative = (0..3).map(|c| m.uncertainty()[c] / m.mean[c].abs().max(1e-6)).fold(0.0, f64::max);
    graded(
        "noise",
        relative,
        NOISE,
        format!("the darkest patch is known to {:.2} %", 100.0 * relative),
        "use a lower ISO, more light, or several shots",
    )
}

/// How sharp the patches' edges are.
pub(super) fn sharpness(edges: Option<EdgeWidth>) -> Gate {
    let advice = "focus on the chart, close the aperture by two stops, hold the camera still, or come nearer";
    match edges {
        Some(EdgeWidth { pixels, patch }) => graded(
            "sharpness",
            patch,
            EDGES,
            format!("the patches' edges are {pixels:.1} pixels wide, {:.0} % of a patch", 100.0 * patch),
            advice,
        ),
        None => Gate {
            name: "sharpness",
            verdict: Verdict::Warning,
            value: f64::NAN,
            words: "the patches' edges are too faint or too noisy to tell how sharp the shot is".to_owned(),
            advice: format!("see with `darkroot chart --preview` whether the grid is right; {advice}"),
        },
    }
}

/// Whether shots of several exposures are the same picture scaled.
pub(crate) fn linearity(departure: f64, worst: &str) -> Gate {
    graded(
        "linearity",
        departure,
        AGREEMENT,
        format!("between the exposures the sensor is linear to {:.2} %", 100.0 * departure),
        &format!(
            "bracket by exposure time only, in steady light, with a `--dark` for long exposures; or leave out {worst}, \
             which departs most"
        ),
    )
}

/// Whether shots that are averaged show the same.
pub(crate) fn agreement(departure: f64, worst: &str) -> Gate {
    graded(
        "agreement",
        departure,
        AGREEMENT,
        format!("the shots that are averaged agree to {:.2} %", 100.0 * departure),
        &format!("take them from one place in steady light; or leave out {worst}, which departs most"),
    )
}

fn edges(corners: &Quad) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 4]);
        (bx - ax).hypot(by - ay)
    })
}

fn size(corners: &Quad, layout: &Layout) -> Gate {
    let [top, right, bottom, left] = edges(corners);
    let patches = |n: usize| n as f64 + (n as f64 - 1.0) * layout.gap;
    let side = (top.min(bottom) / patches(layout.columns)).min(right.min(left) / patches(layout.rows));
    let verdict = if side >= PATCH_PIXELS.0 {
        Verdict::Good
    } else if side >= PATCH_PIXELS.1 {
        Verdict::Warning
    } else {
        Verdict::Refused
    };
    let words = format!("patches are {side:.0} pixels wide");
    Gate { name: "size", verdict, value: side, words, advice: "come nearer, or use a longer lens".to_owned() }
}

fn angle(corners: &Quad) -> Gate {
    let [top, right, bottom, left] = edges(corners);
    let ratio = |a: f64, b: f64| a.max(b) / a.min(b).max(1e-9);
    let worst = ratio(top, bottom).max(ratio(left, right));
    graded(
        "angle",
        worst,
        ANGLE,
        format!("opposite edges of the chart differ by {:.0} %", 100.0 * (worst - 1.0)),
        "hold the camera straight before the chart",
    )
}

/// Luminance of camera colours, by the combination of channels that fits the expected luminances best; green alone
/// where that cannot be told.
pub(super) fn luminances(rgb: &[[f64; 3]], expected: &[Xyz]) -> Vec<f64> {
    use darkroot_profile::fit::{Samples, plain};
    let fitted = Samples::new(rgb.to_vec(), expected.to_vec(), darkroot_colour::white::D50)
        .and_then(|samples| plain::root(&samples, darkroot_profile::Order::One));
    match fitted {
        Ok(fit) => rgb.iter().map(|rgb| fit.model.xyz(*rgb).y).collect(),
        Err(_) => rgb.iter().map(|rgb| rgb[1]).collect(),
    }
}
