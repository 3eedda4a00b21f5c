//! What can be wrong with a model without anything being wrong with its file.

use std::fmt;

use darkroot_colour::{Xyz, white};

use crate::fit::metric::lab_derivatives;
use crate::{Calibration, Model};

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Pictures may suffer in places.
    Warning,
    /// The model should not be used.
    Failure,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Failure => "failure",
        })
    }
}

/// What was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// The white of the light becomes the white of D50.
    White,
    /// Twice the light gives twice the colour.
    Exposure,
    /// Luminance is positive.
    Luminance,
    /// Different camera colours stay different and in sequence: the Jacobian keeps its sign.
    Folds,
    /// More of a colour is more of that colour: its hue holds as it grows saturated.
    HueTwist,
    /// Coefficients are of a sane size.
    Coefficients,
    /// Noise in dark saturated colours grows no more than by a matrix.
    Noise,
}

impl Check {
    /// Its name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::Exposure => "exposure",
            Self::Luminance => "luminance",
            Self::Folds => "folds",
            Self::HueTwist => "hue-twist",
            Self::Coefficients => "coefficients",
            Self::Noise => "noise",
        }
    }
}

/// One thing that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The light of the calibration.
    pub light: String,
    /// What was looked at.
    pub check: Check,
    /// How bad it is.
    pub severity: Severity,
    /// The measured value, in the unit that `words` say.
    pub value: f64,
    /// What was found, in words.
    pub words: String,
}

/// Limits of a check: up to the first a note, up to the second a warning, beyond a failure.
struct Limits(f64, f64);

/// CIEDE2000 between the model's white and D50.
const WHITE: Limits = Limits(0.01, 0.5);
/// Share of the cube with negative luminance. Good models have it near the primaries of the camera, which no light
/// reaches: up to a quarter of the cube (Fujifilm X-T4, measured).
const LUMINANCE: Limits = Limits(0.05, 0.33);
/// Share of the cube that folds over.
const FOLDS: Limits = Limits(0.0, 0.05);
/// Degrees that a hue turns between a fifth and nine tenths of full saturation.
const HUE_TWIST: Limits = Limits(25.0, 60.0);
/// Largest coefficient.
const COEFFICIENTS: Limits = Limits(30.0, 300.0);
/// Noise relative to that of the model's own matrix for colours near grey.
const NOISE: Limits = Limits(1.5, 3.0);

/// Levels of each channel of the cube that is searched, in equal steps of 1.43. Below the first, roots are so steep
/// that a sensor's noise hides what happens.
fn levels() -> impl Iterator<Item = f64> + Clone {
    const COUNT: i32 = 12;
    const FIRST: f64 = 0.02;
    (0..COUNT).map(|i| FIRST.powf(1.0 - f64::from(i) / f64::from(COUNT - 1)))
}

/// Colours of the cube whose largest channel is 1: by homogeneity they stand for all.
fn saturations() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for a in levels() {
        for b in levels() {
            all.extend([[1.0, a, b], [a, 1.0, b], [a, b, 1.0]]);
        }
    }
    all
}

/// Checks a calibration. Every check gives one finding.
pub fn check(calibration: &Calibration) -> Vec<Finding> {
    let model = &calibration.model;
    let finding = |check, severity, value, words: String| Finding {
        light: calibration.light.name.clone(),
        check,
        severity,
        value,
        words,
    };
    let judged = |check, value: f64, limits: Limits, words: String| {
        let severity = match value {
            v if v <= limits.0 => Severity::Note,
            v if v <= limits.1 => Severity::Warning,
            _ => Severity::Failure,
        };
        finding(check, severity, value, words)
    };
    let mut findings = vec![
        judged(Check::White, white_error(model), WHITE, {
            format!("white is off by dE2000 {:.2e}", white_error(model))
        }),
        if model.is_exposure_invariant() {
            finding(Check::Exposure, Severity::Note, 0.0, "twice the light gives twice the colour".to_owned())
        } else {
            let words = "a plain polynomial: colours change with exposure".to_owned();
            finding(Check::Exposure, Severity::Failure, 1.0, words)
        },
    ];
    let negative = negative_luminance(model);
    findings.push(judged(Check::Luminance, negative, LUMINANCE, {
        format!("negative luminance in {:.1} % of the RGB cube", 100.0 * negative)
    }));
    let folds = folds(model);
    findings.push(judged(Check::Folds, folds, FOLDS, {
        format!("the Jacobian changes its sign in {:.1} % of the RGB cube", 100.0 * folds)
    }));
    let (twist, hue) = hue_twist(model);
    findings.push(judged(Check::HueTwist, twist, HUE_TWIST, {
        format!("hues turn by at most {twist:.0} degrees with saturation (around camera hue {hue:.0})")
    }));
    let size = largest_coefficient(model);
    let words = format!("the largest coefficient is {size:.3}");
    findings.push(judged(Check::Coefficients, size, COEFFICIENTS, words));
    let noise = noise_growth(model);
    findings.push(judged(Check::Noise, noise, NOISE, {
        format!("noise in dark saturated colours is {noise:.2} times that of the matrix near grey")
    }));
    findings
}

/// CIEDE2000 between what the model makes of white and D50.
pub fn white_error(model: &Model) -> f64 {
    let found = model.xyz([1.0; 3]).lab(white::D50);
    darkroot_colour::difference::de2000(found, white::D50.lab(white::D50))
}

/// Share of saturated colours with negative luminance.
pub fn negative_luminance(model: &Model) -> f64 {
    share(|rgb| model.xyz(rgb).y < 0.0)
}

/// Share of colours where the determinant of the derivatives has not the sign that it has at grey.
pub fn folds(model: &Model) -> f64 {
    let sign = model.jacobian([0.5; 3]).determinant().signum();
    share(|rgb| model.jacobian(rgb).determinant() * sign <= 0.0)
}

fn share(is_bad: impl Fn([f64; 3]) -> bool) -> f64 {
    let all = saturations();
    all.iter().filter(|rgb| is_bad(**rgb)).count() as f64 / all.len() as f64
}

/// The largest turn of a hue as a colour of one camera hue grows more saturated, degrees, and that camera hue. Hue
/// is the direction from white in the CIE 1976 u'v' diagram.
pub fn hue_twist(model: &Model) -> (f64, f64) {
    const HUES: usize = 72;
    const SATURATIONS: [f64; 8] = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
    let white = uv(model.xyz([1.0; 3]));
    let direction = |hue: usize, saturation: f64| {
        let pure = crate::hue_plane::at_position(hue as f64 * 6.0 / HUES as f64);
        let [u, v] = uv(model.xyz(pure.map(|p| 1.0 - saturation + saturation * p)));
        (v - white[1]).atan2(u - white[0]).to_degrees()
    };
    let turn = |hue: usize| {
        let first = direction(hue, SATURATIONS[0]);
        let away = |s: f64| (direction(hue, s) - first + 180.0).rem_euclid(360.0) - 180.0;
        SATURATIONS.iter().map(|s| away(*s).abs()).fold(0.0, f64::max)
    };
    let widest = |a: (f64, f64), b: (f64, f64)| if b.0 > a.0 { b } else { a };
    (0..HUES).map(|h| (turn(h), h as f64 * 360.0 / HUES as f64)).fold((0.0, 0.0), widest)
}

fn uv(c: Xyz) -> [f64; 2] {
    let sum = c.x + 15.0 * c.y + 3.0 * c.z;
    [4.0 * c.x / sum, 9.0 * c.y / sum]
}

/// The largest coefficient of the model's parts.
pub fn largest_coefficient(model: &Model) -> f64 {
    let root = model.root.iter().flat_map(|p| p.terms().flat_map(|(_, c)| c));
    let hues = model.hue_plane.iter().flat_map(|p| p.knots()).flat_map(|m| m.iter().copied());
    let bumps = model.residual.iter().flat_map(|p| p.centres()).flat_map(|c| c.weight);
    let polynomial = model.polynomial.iter().flat_map(|p| p.terms().flat_map(|(_, c)| c));
    root.chain(hues).chain(bumps).chain(polynomial).map(f64::abs).fold(0.0, f64::max)
}

/// Growth of small equal noise in the three channels of dark saturated colours, in CIELAB, against what the matrix
/// that the model is near grey makes of it: the largest of red, green and blue.
pub fn noise_growth(model: &Model) -> f64 {
    noise_beside(model, &Model::linear(&model.jacobian([0.5; 3])), white::D50)
}

/// The same against another model, both with XYZ relative to this white.
pub fn noise_beside(model: &Model, other: &Model, white: Xyz) -> f64 {
    const DARK: [[f64; 3]; 3] = [[0.02, 0.004, 0.003], [0.003, 0.006, 0.02], [0.004, 0.015, 0.005]];
    let noise =
        |model: &Model, rgb: [f64; 3]| (lab_derivatives(model.xyz(rgb), white) * model.jacobian(rgb)).norm();
    DARK.into_iter().map(|rgb| noise(model, rgb) / noise(other, rgb)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Kind, Light, Order, RootPolynomial};
    use darkroot_colour::Matrix3;

    fn calibration(model: Model) -> Calibration {
        Calibration::new(Light { name: "D50".into(), xy: white::D50_XY }, Kind::Linear, model)
    }

    fn plain() -> Matrix3 {
        // A forward matrix of an ordinary camera, its rows made to sum to D50.
        let mut m = Matrix3::new(0.65, 0.2, 0.1, 0.25, 0.75, 0.0, 0.02, 0.05, 0.75);
        for (r, w) in [white::D50.x, white::D50.y, white::D50.z].into_iter().enumerate() {
            m[(r, 2)] = w - m[(r, 0)] - m[(r, 1)];
        }
        m
    }

    fn severity(model: &Model, check: Check) -> Severity {
        super::check(&calibration(model.clone())).into_iter().find(|f| f.check == check).unwrap().severity
    }

    #[test]
    fn a_plain_matrix_has_no_faults() {
        let findings = check(&calibration(Model::linear(&plain())));
        assert!(findings.iter().all(|f| f.severity == Severity::Note), "{findings:#?}");
        assert_eq!(findings.len(), 7);
    }

    #[test]
    fn each_fault_is_found() {
        let scaled = Model::linear(&(plain() * 1.1));
        assert_eq!(severity(&scaled, Check::White), Severity::Failure);

        let mut negative = plain();
        negative[(1, 0)] -= 4.8;
        negative[(1, 1)] += 4.8;
        assert_eq!(severity(&Model::linear(&negative), Check::Luminance), Severity::Failure);

        let columns: Vec<[f64; 3]> = (0..3).map(|c| [0, 1, 2].map(|r| plain()[(r, c)])).collect();
        let bent = |size: f64| -> Model {
            let mut terms = columns.clone();
            terms.extend([[size, -size, 0.0], [-size, size, 0.0], [0.0; 3]]);
            RootPolynomial::new(Order::Two, terms).unwrap().into()
        };
        assert_eq!(severity(&bent(6.0), Check::Folds), Severity::Failure);
        assert_eq!(severity(&bent(6.0), Check::HueTwist), Severity::Failure);
        assert_ne!(severity(&bent(6.0), Check::Noise), Severity::Note);
        assert_eq!(severity(&bent(400.0), Check::Coefficients), Severity::Failure);
        assert_eq!(severity(&bent(0.02), Check::Folds), Severity::Note);

        let polynomial = crate::samples_for_tests::all_parts()[3].clone();
        assert_eq!(severity(&polynomial, Check::Exposure), Severity::Failure);
    }
}
