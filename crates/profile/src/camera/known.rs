//! A camera whose sensitivities are known, and its models for every light.
//!
//! What a profile keeps of the sensitivities are samples every 10 nm; between them they are smooth (Sprague). That is finer
//! than most are measured, and needs no table that another version of the program might lack.

use std::collections::VecDeque;
use std::sync::{Mutex, OnceLock, PoisonError};

use darkroot_colour::adaptation::bradford;
use darkroot_colour::measured::Measured;
use darkroot_colour::{Illuminant, Spectrum, Xy, white};

use super::light;
use crate::fit::root_set;
use crate::fit::virtual_set::VirtualSet;
use crate::spectra::Sensitivities;
use crate::{Calibration, Errors, Figures, Kind, Light, Model};

/// How many models are remembered: a series of photographs has few whites.
const REMEMBERED: usize = 8;
/// Most steps, and the step in chromaticity that slopes are taken over, where a white is looked for.
const STEPS: usize = 20;
const SLOPE: f64 = 1e-4;
/// Lights that stand for all others where a list of calibrations is wanted.
const STANDARD: [&str; 3] = ["D65", "D50", "A"];

/// Wavelengths of a profile's samples: 380 to 780 nm.
pub const KEPT: usize = 41;
/// Decimals of a sample; the largest of all channels is 1.
const DECIMALS: f64 = 1e5;

/// How far a camera's colours were off, on surfaces that took no part.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Name of the light.
    pub light: String,
    /// The errors.
    pub errors: Errors,
}

/// What is known of how a camera sees, and the models that were computed from it.
#[derive(Debug)]
pub struct KnownCamera {
    /// Red, green and blue every 10 nm.
    samples: [[f64; KEPT]; 3],
    /// The same every 5 nm.
    sensitivities: Sensitivities,
    /// What its colours were measured to be off by; may be empty.
    judged: Vec<Judged>,
    /// For an estimate: how far its colours are off by all that is known of it, mean dE2000 under daylight.
    expected: Option<f64>,
    standard: OnceLock<Vec<Calibration>>,
    last: Mutex<VecDeque<(Xy, Model)>>,
    /// The neutral whose white was last asked for, and that white: most settings leave both as they are.
    last_white: Mutex<Option<([f64; 3], Xy)>>,
}

impl KnownCamera {
    /// A camera of these sensitivities, rounded to what a profile keeps. `None` where one is no finite number, or a channel
    /// sees nothing under one of the standard lights.
    pub fn new(sensitivities: &Sensitivities) -> Option<Self> {
        let all = || sensitivities.0.iter().flat_map(|channel| channel.0);
        let largest = all().fold(0.0, f64::max);
        let kept = |v: f64| (v / largest * DECIMALS).round() / DECIMALS + 0.0;
        Self::of_samples(sensitivities.0.each_ref().map(|s| std::array::from_fn(|i| kept(s.0[2 * i]))))
    }

    /// A camera of samples every 10 nm from 380 to 780 nm. `None` as for [`KnownCamera::new`].
    pub fn of_samples(samples: [[f64; KEPT]; 3]) -> Option<Self> {
        let wavelengths: [f64; KEPT] = std::array::from_fn(|i| Spectrum::wavelength(2 * i));
        let smooth = |values: &[f64; KEPT]| Measured::new(&wavelengths, values).ok()?.smooth();
        let [r, g, b] = samples.each_ref().map(smooth);
        let sensitivities = Sensitivities([r?, g?, b?]);
        let sees = |name: &&str| {
            let light = Illuminant::by_name(name).map(|light| light.spectrum());
            light.is_some_and(|light| sensitivities.under(&light).is_some())
        };
        STANDARD.iter().all(sees).then(|| Self {
            samples,
            sensitivities,
            judged: Vec::new(),
            expected: None,
            standard: OnceLock::new(),
            last: Mutex::default(),
            last_white: Mutex::default(),
        })
    }

    /// The same with what its colours were measured to be off by.
    #[must_use]
    pub fn judged(self, judged: Vec<Judged>) -> Self {
        Self { judged, standard: OnceLock::new(), ..self }
    }

    /// The same as an estimate whose colours are probably off by that mean dE2000.
    #[must_use]
    pub fn expecting(self, expected: Option<f64>) -> Self {
        Self { expected, ..self }
    }

    /// Samples every 10 nm, as a profile keeps them.
    pub fn samples(&self) -> &[[f64; KEPT]; 3] {
        &self.samples
    }

    /// What its colours were measured to be off by.
    pub fn figures(&self) -> &[Judged] {
        &self.judged
    }

    /// How far an estimate's colours are probably off; `None` for measured sensitivities.
    pub fn expected(&self) -> Option<f64> {
        self.expected
    }

    /// The sensitivities, relative to each other.
    pub fn sensitivities(&self) -> &Sensitivities {
        &self.sensitivities
    }

    /// The model under a light of known spectrum: balanced camera RGB to XYZ relative to D50. A root polynomial of order 4,
    /// fitted to the built-in surfaces as this camera sees them. `None` for a light of which a channel sees nothing.
    pub fn model_under(&self, light: &Spectrum) -> Option<Model> {
        self.model_by(VirtualSet::builtin()?, light)
    }

    /// The same, fitted to another virtual training set.
    pub fn model_by(&self, set: &VirtualSet, light: &Spectrum) -> Option<Model> {
        let rendered = set.render(&self.sensitivities.under(light)?, light).ok()?;
        let model = root_set::fit(&rendered).ok()?;
        Some(model.then(&bradford(light.white(), white::D50)))
    }

    /// The model for a light of which the white is known: that of the light which stands in for all with this white
    /// ([`light::likely`]). The last ones are remembered.
    pub fn model_for(&self, white: Xy) -> Model {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, model)) = last.iter().find(|(known, _)| *known == white) {
            return model.clone();
        }
        let model = self.model_under(&light::likely(white));
        let model = model.unwrap_or_else(|| self.calibrations()[0].model.clone());
        if last.len() == REMEMBERED {
            last.pop_front();
        }
        last.push_back((white, model.clone()));
        model
    }

    /// Camera RGB of a white, the largest 1: what the camera sees of the light that stands in for all with this white
    /// ([`light::with_white`]). `None` for a white that no smooth light has.
    pub fn neutral_of(&self, white: Xy) -> Option<[f64; 3]> {
        let light = light::with_white(white, |_| false)?;
        let seen = self.sensitivities.0.each_ref().map(|s| s.dot(&light));
        let largest = seen.iter().copied().fold(0.0, f64::max);
        seen.iter().all(|v| v.is_finite() && *v > 0.0).then(|| seen.map(|v| v / largest))
    }

    /// The white whose [`neutral_of`](Self::neutral_of) is this camera RGB, of any scale, by Newton's method from a white
    /// near to it. `None` where there is none. The last one is remembered.
    pub fn white_of(&self, neutral: [f64; 3], near: Xy) -> Option<Xy> {
        let mut last = self.last_white.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known, white)) = *last
            && known.map(f64::to_bits) == neutral.map(f64::to_bits)
        {
            return Some(white);
        }
        let found = self.search_white(neutral, near)?;
        *last = Some((neutral, found));
        Some(found)
    }

    fn search_white(&self, neutral: [f64; 3], near: Xy) -> Option<Xy> {
        let ratios = |[r, g, b]: [f64; 3]| nalgebra::Vector2::new((r / g).ln(), (b / g).ln());
        let wanted = ratios(neutral);
        let off = |xy: Xy| self.neutral_of(xy).map(|n| ratios(n) - wanted);
        let mut xy = near;
        let mut here = off(xy)?;
        for _ in 0..STEPS {
            if here.norm() < 1e-9 {
                break;
            }
            let along = (off(Xy::new(xy.x + SLOPE, xy.y))? - here) / SLOPE;
            let across = (off(Xy::new(xy.x, xy.y + SLOPE))? - here) / SLOPE;
            let step = nalgebra::Matrix2::from_columns(&[along, across]).try_inverse()? * here;
            // Whites lie close together: a step that leaves them, or does not help, is shortened.
            let next = (0..8).map(|n| 0.5f64.powi(n)).find_map(|share| {
                let there = Xy::new(xy.x - share * step.x, xy.y - share * step.y);
                let off = off(there).filter(|o| o.norm() < here.norm())?;
                Some((there, off))
            });
            let Some((there, off)) = next else { break };
            (xy, here) = (there, off);
        }
        (here.norm() < 1e-6).then_some(xy)
    }

    /// Calibrations for D65, D50 and A, which stand for those of all other lights.
    pub fn calibrations(&self) -> &[Calibration] {
        self.standard.get_or_init(|| {
            let calibration = |name: &&str| {
                let spectrum = Illuminant::by_name(name)?.spectrum();
                let light = Light { name: (*name).to_owned(), xy: spectrum.white().xy()? };
                let held_out = self.judged.iter().find(|j| j.light == *name).map(|j| j.errors);
                let figures = Figures { held_out, ..Figures::default() };
                let model = self.model_under(&spectrum)?;
                Some(Calibration { figures, ..Calibration::new(light, Kind::Spectral, model) })
            };
            STANDARD.iter().filter_map(calibration).collect()
        })
    }
}

impl Clone for KnownCamera {
    fn clone(&self) -> Self {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Self {
            samples: self.samples,
            sensitivities: self.sensitivities.clone(),
            judged: self.judged.clone(),
            expected: self.expected,
            standard: self.standard.clone(),
            last: Mutex::new(last),
            last_white: Mutex::default(),
        }
    }
}

impl PartialEq for KnownCamera {
    fn eq(&self, other: &Self) -> bool {
        self.samples == other.samples && self.judged == other.judged && self.expected == other.expected
    }
}
