//! Checks of a shot ("gates"): is it good enough to make a profile of?
//!
//! Each check measures one thing, compares it with two limits and gives a [`Gate`]: good up to the first limit, usable with
//! a warning up to the second, refused beyond. The limits stand together below. What was measured is a [`Finding`], which
//! also has the words for it.

mod finding;
pub use finding::{Departure, Finding, by_channel, near};

use darkroot_chart::{ChartLayout, EdgeWidth, Measurement, Quad};
use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Xy, Xyz};

use crate::corrections::ColourChange;

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
    /// How it came out.
    pub verdict: Verdict,
    /// What was found.
    pub finding: Finding,
}

impl Gate {
    /// What was checked ("exposure").
    pub fn name(&self) -> &'static str {
        self.finding.name()
    }

    /// The measured value; NaN where it cannot be measured.
    pub fn value(&self) -> f64 {
        self.finding.value()
    }

    /// What was found, in words.
    pub fn words(&self) -> String {
        self.finding.words()
    }

    /// What to do about it, where it is not good.
    pub fn advice(&self) -> String {
        self.finding.advice()
    }

    /// By two limits: good up to the first, usable up to the second.
    fn graded(finding: Finding, (good, usable): (f64, f64)) -> Self {
        let value = finding.value();
        let verdict = if value <= good {
            Verdict::Good
        } else if value <= usable {
            Verdict::Warning
        } else {
            Verdict::Refused
        };
        Self { verdict, finding }
    }
}

/// Share of saturation that the brightest channel of the white patch should have.
const EXPOSURE: (f64, f64) = (0.40, 0.90);
/// Below this share there is too little light to profile by.
const TOO_DARK: f64 = 0.02;
/// Slope of light over the chart: good up to, usable up to.
const EVENNESS: (f64, f64) = (0.05, 0.30);
/// Glare as a share of white.
const GLARE: (f64, f64) = (0.005, 0.03);
/// Share of clipped patches.
const CLIPPED: (f64, f64) = (0.0, 0.15);
/// Standard error of the darkest neutral patch, relative.
const NOISE: (f64, f64) = (0.005, 0.05);
/// Smallest patch side, pixels: good from the first on, usable from the second on.
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
/// For what was corrected, or can be told from a shot but not held against it.
const ANY: f64 = f64::INFINITY;

/// What is already taken out of a shot, and so is not held against it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Corrected {
    /// Uneven light, by a flat or by the patches.
    pub unevenness: bool,
    /// Glare.
    pub glare: bool,
}

/// How bright the white patch is.
pub fn exposure(saturation: [f32; 3], measurements: &[Measurement], expected: &[Xyz]) -> Gate {
    let brightest = (0..expected.len()).max_by(|a, b| expected[*a].y.total_cmp(&expected[*b].y)).unwrap_or(0);
    let white = &measurements[brightest];
    let share = (0..3).map(|c| white.mean[c] / f64::from(saturation[c]).max(1e-6)).fold(0.0, f64::max);
    let clipped = white.clipped > 0.01;
    let verdict = if clipped || share < TOO_DARK {
        Verdict::Refused
    } else if share < EXPOSURE.0 || share > EXPOSURE.1 {
        Verdict::Warning
    } else {
        Verdict::Good
    };
    Gate { verdict, finding: Finding::Exposure { share, clipped } }
}

/// How many patches are clipped.
pub fn clipping(measurements: &[Measurement]) -> Gate {
    let clipped = measurements.iter().filter(|m| crate::patch::is_clipped(m.clipped)).count();
    Gate::graded(Finding::Clipping { clipped, all: measurements.len() }, CLIPPED)
}

/// Whether the light is equally strong all over the chart. `range` is its largest relative difference.
pub fn evenness(range: f64, corrected: Corrected) -> Gate {
    let limits = if corrected.unevenness { (ANY, ANY) } else { EVENNESS };
    Gate::graded(Finding::Evenness { range }, limits)
}

/// How much stray light there is, as shares of white.
pub fn glare(shares: [f64; 3], corrected: Corrected) -> Gate {
    Gate::graded(Finding::Glare(shares), if corrected.glare { (ANY, ANY) } else { GLARE })
}

/// How well the darkest patch is known.
pub fn noise(measurements: &[Measurement], expected: &[Xyz]) -> Gate {
    let darkest = (0..expected.len()).min_by(|a, b| expected[*a].y.total_cmp(&expected[*b].y)).unwrap_or(0);
    let m = &measurements[darkest];
    let relative = (0..3).map(|c| m.uncertainty()[c] / m.mean[c].abs().max(1e-6)).fold(0.0, f64::max);
    Gate::graded(Finding::Noise(relative), NOISE)
}

/// How large the patches are.
pub fn size(corners: &Quad, layout: &ChartLayout) -> Gate {
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
    Gate { verdict, finding: Finding::Size(side) }
}

/// How obliquely the chart was taken.
pub fn angle(corners: &Quad) -> Gate {
    let [top, right, bottom, left] = edges(corners);
    let ratio = |a: f64, b: f64| a.max(b) / a.min(b).max(1e-9);
    Gate::graded(Finding::Angle(ratio(top, bottom).max(ratio(left, right))), ANGLE)
}

fn edges(corners: &Quad) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 4]);
        (bx - ax).hypot(by - ay)
    })
}

/// Whether the light has one colour all over the chart.
pub fn colour_of_light(change: ColourChange, corrected: Corrected) -> Gate {
    let ColourChange { range, gain } = change;
    let certain = change.is_certain();
    let verdict = if certain && !corrected.unevenness { Verdict::Warning } else { Verdict::Good };
    Gate { verdict, finding: Finding::ColourOfLight { range, gain, certain } }
}

/// How sharp the patches' edges are.
pub fn sharpness(edges: Option<EdgeWidth>) -> Gate {
    let finding = Finding::Sharpness(edges);
    match edges {
        Some(_) => Gate::graded(finding, EDGES),
        None => Gate { verdict: Verdict::Warning, finding },
    }
}

/// Whether the light is the one that was named, by what the camera's own matrices make of its white.
pub fn light(found: Xy, named: Xy, name: &str) -> Gate {
    let kelvin = |xy: Xy| Temperature::of(xy).kelvin;
    let finding = Finding::Light { found: kelvin(found), named: kelvin(named), name: name.to_owned() };
    Gate::graded(finding, (OTHER_LIGHT, ANY))
}

/// Whether shots of several exposures are the same picture scaled.
pub fn linearity(departure: Departure) -> Gate {
    Gate::graded(Finding::Linearity(departure), AGREEMENT)
}

/// Whether shots that are averaged show the same.
pub fn agreement(departure: Departure) -> Gate {
    Gate::graded(Finding::Agreement(departure), AGREEMENT)
}
