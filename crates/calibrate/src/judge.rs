//! A finished profile against a new shot of a chart: is the camera still what it was?

use std::fmt;

use darkroot_colour::difference::{de2000, de2000_sl1};
use darkroot_colour::{Xyz, white};
use darkroot_profile::{Calibration, Errors, Model, Profile, Summary};

use crate::balanced::Balanced;
use crate::patch::with_spectra;
use crate::{CalibrateError, JudgedPatch, LightSource, MeasuredPatch};

/// What the patches of a shot say about a profile.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Judgement {
    /// Every patch by the profile.
    pub patches: Vec<JudgedPatch>,
    /// Errors over the usable patches.
    pub errors: Errors,
    /// CIEDE2000 with SL = 1 over them, which weighs dark and bright as much as middle greys.
    pub sl1: Summary,
    /// Share of patches below dE2000 4.
    pub within_four: f64,
    /// What the profile says of itself: patches left out of its fit.
    pub promised: Option<Summary>,
}

/// Judges measured patches by a profile.
///
/// # Errors
/// Too few usable patches.
pub fn judge(
    profile: &Profile,
    light: &LightSource,
    patches: &[MeasuredPatch],
) -> Result<Judgement, CalibrateError> {
    let known = profile.known_camera().zip(light.spectrum.as_ref());
    let model = known.and_then(|(camera, spectrum)| camera.model_under(spectrum));
    let model = model.unwrap_or_else(|| profile.model_for(light.light.xy));
    let (patches, errors) = by_model(light, patches, &model)?;
    let pairs: Vec<_> = patches
        .iter()
        .filter(|p| p.excluded.is_none())
        .map(|p| (p.corrected.lab(white::D50), p.reference.lab(white::D50)))
        .collect();
    let sl1 = Summary::of(&pairs.iter().map(|(a, b)| de2000_sl1(*a, *b)).collect::<Vec<_>>());
    let below = pairs.iter().filter(|(a, b)| de2000(*a, *b) < 4.0).count();
    let nearest = profile.calibrations().iter().min_by(|a, b| {
        let off = |c: &Calibration| (1e6 / c.light.kelvin() - 1e6 / light.light.kelvin()).abs();
        off(a).total_cmp(&off(b))
    });
    let promised = nearest.and_then(|c| c.figures.leave_one_out.or(c.figures.held_out)).map(|e| e.de2000);
    let within_four = below as f64 / pairs.len().max(1) as f64;
    Ok(Judgement { patches, errors, sl1, within_four, promised })
}

/// Limits that a shot must keep.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    /// Largest mean of dE2000.
    pub mean: Option<f64>,
    /// Largest single dE2000.
    pub max: Option<f64>,
    /// Share of patches that must be below dE2000 4.
    pub within_four: Option<f64>,
    /// Whether dE2000 counts with SL = 1.
    pub sl1: bool,
}

/// Conformance presets by name. The limits are those that secondary sources give for colour accuracy; the standards
/// ask for more than colour.
pub const PRESETS: [(&str, Limits); 3] = [
    // FADGI, "Technical Guidelines for Digitizing Cultural Heritage Materials", 4 stars: mean < 2, 90 % of the patches
    // below 4.
    ("fadgi-4star", Limits { mean: Some(2.0), max: None, within_four: Some(0.9), sl1: false }),
    // Metamorfoze Preservation Imaging Guidelines, full: mean at most 3, largest 7, SL = 1.
    ("metamorfoze-full", Limits { mean: Some(3.0), max: Some(7.0), within_four: None, sl1: true }),
    // ISO 19264-1, level A: mean at most 4, largest 10.
    ("iso19264-a", Limits { mean: Some(4.0), max: Some(10.0), within_four: None, sl1: false }),
];

impl fmt::Display for Limits {
    /// What they ask for, in words; nothing where they ask for nothing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut words = Vec::new();
        words.extend(self.mean.map(|v| format!("mean {v}")));
        words.extend(self.max.map(|v| format!("max {v}")));
        words.extend(self.within_four.map(|v| format!("{:.0} % below 4", 100.0 * v)));
        if self.sl1 && !words.is_empty() {
            words.push("SL = 1".to_owned());
        }
        f.write_str(&words.join(", "))
    }
}

impl Limits {
    /// Which limits a shot does not keep.
    pub fn broken(&self, found: &Judgement) -> Vec<Broken> {
        let s = if self.sl1 { found.sl1 } else { found.errors.de2000 };
        let mut broken = Vec::new();
        if let Some(limit) = self.mean.filter(|limit| s.mean > *limit) {
            broken.push(Broken::Mean { found: s.mean, limit, sl1: self.sl1 });
        }
        if let Some(limit) = self.max.filter(|limit| s.max > *limit) {
            broken.push(Broken::Max { found: s.max, limit, sl1: self.sl1 });
        }
        if let Some(limit) = self.within_four.filter(|share| found.within_four < *share) {
            broken.push(Broken::WithinFour { found: found.within_four, limit });
        }
        broken
    }
}

/// A limit that a shot does not keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Broken {
    /// The mean of dE2000.
    Mean {
        /// What it is.
        found: f64,
        /// What it may be.
        limit: f64,
        /// Whether with SL = 1.
        sl1: bool,
    },
    /// The largest dE2000.
    Max {
        /// What it is.
        found: f64,
        /// What it may be.
        limit: f64,
        /// Whether with SL = 1.
        sl1: bool,
    },
    /// The share of patches below dE2000 4.
    WithinFour {
        /// What it is.
        found: f64,
        /// What it must be.
        limit: f64,
    },
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = |sl1: bool| if sl1 { "dE2000 (SL = 1)" } else { "dE2000" };
        match *self {
            Self::Mean { found, limit, sl1 } => {
                write!(f, "mean {} is {found:.2}, more than {limit}", what(sl1))
            }
            Self::Max { found, limit, sl1 } => {
                write!(f, "the largest {} is {found:.2}, more than {limit}", what(sl1))
            }
            Self::WithinFour { found, limit } => write!(
                f,
                "{:.0} % of the patches are below dE2000 4, less than {:.0} %",
                100.0 * found,
                100.0 * limit
            ),
        }
    }
}

/// What a given model makes of measured patches, balanced by the white of their own light.
///
/// # Errors
/// Too few usable patches.
pub fn by_model(
    light: &LightSource,
    patches: &[MeasuredPatch],
    model: &Model,
) -> Result<(Vec<JudgedPatch>, Errors), CalibrateError> {
    let patches = &*with_spectra(patches, light, &mut Vec::new());
    let balanced = Balanced::new(patches, light, &mut Vec::new())?;
    let judged: Vec<JudgedPatch> = patches.iter().map(|p| balanced.judged(p, model, None)).collect();
    let used = || judged.iter().filter(|j| j.excluded.is_none());
    let estimates: Vec<Xyz> = used().map(|j| j.corrected).collect();
    let truths: Vec<Xyz> = used().map(|j| j.reference).collect();
    let errors = Errors::between(&estimates, &truths, white::D50);
    Ok((judged, errors))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_say_what_they_miss() {
        let limits = PRESETS[1].1;
        let shot = |mean: f64| Judgement {
            sl1: Summary { mean, median: mean, p95: mean, max: 2.0 * mean },
            within_four: 1.0,
            ..Judgement::default()
        };
        assert!(limits.broken(&shot(2.0)).is_empty());
        assert_eq!(limits.broken(&shot(5.0)).len(), 2);
    }
}
