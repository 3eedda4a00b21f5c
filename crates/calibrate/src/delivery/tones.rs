//! The grey patches: tone response, white balance, gain modulation, noise.

use darkroot_chart::PatchNoise;
use darkroot_colour::difference::de2000;
use darkroot_colour::{Lab, white};

use crate::JudgedPatch;

/// Chroma up to which a reference colour is a grey.
const GREY: f64 = 5.0;
/// L\* between two greys from which a step tells of the gain; with less the noise of a reference does.
const LEAST_STEP: f64 = 1.0;
/// Mean L\* of a step from which it lies in the highlights.
const HIGHLIGHTS: f64 = 75.0;

/// A grey patch.
#[derive(Debug, Clone, PartialEq)]
pub struct Grey {
    /// Its name.
    pub name: String,
    /// What it is in the picture.
    pub found: Lab,
    /// What it should be.
    pub truth: Lab,
    /// Noise in it.
    pub noise: PatchNoise,
}

impl Grey {
    /// Error of L\*: the tone response (OECF) at this grey.
    pub fn lightness_error(&self) -> f64 {
        self.found.l - self.truth.l
    }

    /// Error of the colour without lightness: CIEDE2000 with L\* as it should be, as Metamorfoze 2.0 measures white
    /// balance.
    pub fn colour_error(&self) -> f64 {
        de2000(Lab { l: self.truth.l, ..self.found }, self.truth)
    }
}

/// What lies between two greys that are neighbours in lightness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// L\* in the middle of it, by the reference.
    pub lightness: f64,
    /// Difference of L\* in the picture over that of the reference.
    pub gain: f64,
}

impl Step {
    /// Whether it lies in the highlights: above L\* 75 in the mean. The guidelines mean the lightest steps of their own
    /// targets, which other charts do not have; the number is Darkroot's.
    pub fn is_highlight(&self) -> bool {
        self.lightness >= HIGHLIGHTS
    }
}

/// The greys among patches, each with its noise, from light to dark.
pub(super) fn greys<'a>(patches: impl Iterator<Item = (&'a JudgedPatch, &'a PatchNoise)>) -> Vec<Grey> {
    let grey = |(patch, noise): (&JudgedPatch, &PatchNoise)| {
        let truth = patch.reference.lab(white::D50);
        let found = patch.corrected.lab(white::D50);
        (truth.a.hypot(truth.b) <= GREY).then(|| Grey {
            name: patch.name.clone(),
            found,
            truth,
            noise: *noise,
        })
    };
    let mut greys: Vec<Grey> = patches.filter_map(grey).collect();
    greys.sort_by(|a, b| b.truth.l.total_cmp(&a.truth.l));
    greys
}

/// Steps between neighbours; greys of one lightness, as large charts have them, count as one.
pub(super) fn steps(greys: &[Grey]) -> Vec<Step> {
    let mut levels: Vec<(f64, f64, f64)> = Vec::new();
    for grey in greys {
        match levels.last_mut() {
            Some((truth, found, count)) if (*truth / *count - grey.truth.l).abs() < LEAST_STEP => {
                *truth += grey.truth.l;
                *found += grey.found.l;
                *count += 1.0;
            }
            _ => levels.push((grey.truth.l, grey.found.l, 1.0)),
        }
    }
    let levels: Vec<[f64; 2]> =
        levels.iter().map(|(truth, found, count)| [truth / count, found / count]).collect();
    let step = |pair: &[[f64; 2]]| {
        let ([light, light_found], [dark, dark_found]) = (pair[0], pair[1]);
        Step { lightness: (light + dark) / 2.0, gain: (light_found - dark_found) / (light - dark) }
    };
    levels.windows(2).map(step).collect()
}
