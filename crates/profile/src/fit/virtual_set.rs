//! A large set of colours rendered through a camera that is known only by its posterior: what the models of the
//! spectral prior are fitted to.

use colour::{Matrix3, Spectrum};

use super::metric::de2000_weights;
use super::{FitError, Samples};
use crate::spectra::Effective;

/// Weight of squares and cubes of reflectances (deeper, more saturated colours of the same materials).
const POWER_WEIGHT: f64 = 0.03;
/// Weight of ideal bands and edges.
const IDEAL_WEIGHT: f64 = 0.03;
/// Reflectances are kept at or above this, and camera RGB at or above a tenth of it.
const LEAST: f64 = 1e-4;

/// Reflectances of real surfaces, their powers, and ideal ones, with the weight of each.
#[derive(Debug, Clone, PartialEq)]
pub struct VirtualSet {
    reflectances: Vec<Spectrum>,
    weights: Vec<f64>,
    /// How many of the first reflectances are those of real surfaces.
    real: usize,
}

/// A virtual set as a camera sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The colours.
    pub samples: Samples,
    /// Weight of each in a fit.
    pub weights: Vec<f64>,
    /// What XYZ means in CIEDE2000 at each.
    pub metric: Vec<Matrix3>,
    /// How many of the first are real surfaces.
    pub real: usize,
}

impl VirtualSet {
    /// The set that grows from reflectances of real surfaces, each with its weight.
    pub fn new(surfaces: &[(Spectrum, f64)]) -> Self {
        let clamped = |s: &Spectrum| Spectrum(s.0.map(|v| v.clamp(LEAST, 1.0)));
        let real: Vec<(Spectrum, f64)> = surfaces.iter().map(|(s, w)| (clamped(s), *w)).collect();
        let power =
            |n: i32| real.iter().map(move |(s, w)| (Spectrum(s.0.map(|v| v.powi(n))), POWER_WEIGHT * w));
        let ideal = ideal().into_iter().map(|s| (s, IDEAL_WEIGHT));
        let all: Vec<(Spectrum, f64)> =
            real.iter().cloned().chain(power(2)).chain(power(3)).chain(ideal).collect();
        let count = real.len();
        let (reflectances, weights) = all.into_iter().unzip();
        Self { reflectances, weights, real: count }
    }

    /// The set through a camera, under the light that the camera stands under.
    ///
    /// # Errors
    /// Values that are not finite.
    pub fn render(&self, camera: &Effective, light: &Spectrum) -> Result<Rendered, FitError> {
        let whole = camera.render(&self.reflectances, light)?;
        let positive = whole.rgb().iter().map(|rgb| rgb.map(|v| v.max(LEAST / 10.0))).collect();
        let samples = Samples::new(positive, whole.xyz().to_vec(), whole.white())?;
        let metric = de2000_weights(samples.xyz(), samples.white());
        Ok(Rendered { samples, weights: self.weights.clone(), metric, real: self.real })
    }
}

impl Rendered {
    /// The set without some of the real surfaces and their powers.
    ///
    /// # Errors
    /// None in practice; the values were checked before.
    pub fn without(&self, left_out: impl Fn(usize) -> bool) -> Result<Self, FitError> {
        let powers = 3 * self.real;
        let kept: Vec<usize> =
            (0..self.weights.len()).filter(|i| *i >= powers || !left_out(i % self.real)).collect();
        let s = &self.samples;
        Ok(Self {
            samples: Samples::new(
                kept.iter().map(|i| s.rgb()[*i]).collect(),
                kept.iter().map(|i| s.xyz()[*i]).collect(),
                s.white(),
            )?,
            weights: kept.iter().map(|i| self.weights[*i]).collect(),
            metric: kept.iter().map(|i| self.metric[*i]).collect(),
            real: kept.iter().filter(|i| **i < self.real).count(),
        })
    }

    /// The real surfaces alone.
    ///
    /// # Errors
    /// None in practice; the values were checked before.
    pub fn real_samples(&self) -> Result<Samples, FitError> {
        let s = &self.samples;
        Samples::new(s.rgb()[..self.real].to_vec(), s.xyz()[..self.real].to_vec(), s.white())
    }
}

/// Gaussian bands and gaps of three widths, rising and falling edges of two, between 0.02 and 0.92.
fn ideal() -> Vec<Spectrum> {
    let between = |share: f64| 0.02 + 0.9 * share;
    let both = |share: &dyn Fn(f64) -> f64| {
        [Spectrum::from_fn(|nm| between(share(nm))), Spectrum::from_fn(|nm| between(1.0 - share(nm)))]
    };
    let mut all = Vec::new();
    for width in [40.0, 80.0, 140.0] {
        for centre in (400..=700).step_by(20).map(f64::from) {
            all.extend(both(&|nm| (-0.5 * ((nm - centre) / width * 2.0).powi(2)).exp()));
        }
    }
    for centre in (430..=680).step_by(15).map(f64::from) {
        for width in [8.0, 25.0] {
            all.extend(both(&|nm| 1.0 / (1.0 + (-(nm - centre) / width).exp())));
        }
    }
    all
}
