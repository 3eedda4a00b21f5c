//! The virtual training set: many reflectances, and the camera RGB and XYZ that they have by computation. The models of
//! the spectral prior are fitted to it, with the sensitivities that [`super::prior`] estimates.

use std::sync::OnceLock;

use darkroot_colour::{Matrix3, Spectrum};

use super::metric::de2000_weights;
use super::population::parse_reflectances;
use super::representatives::clusters;
use super::{FitError, Samples};
use crate::spectra::Effective;

/// Weight of squares and cubes of reflectances (deeper, more saturated colours of the same materials).
const POWER_WEIGHT: f64 = 0.03;
/// Reflectances are kept at or above this, and camera RGB at or above a tenth of it.
const LEAST: f64 = 1e-4;
/// Most clusters that surfaces are sorted into.
const CLUSTERS: usize = 240;

/// Reflectances of real surfaces, their powers, and ideal ones.
#[derive(Debug, Clone, PartialEq)]
pub struct VirtualSet {
    /// Real surfaces, then their squares, then their cubes, then ideal ones.
    reflectances: Vec<Spectrum>,
    /// Weight of each real surface; the mean is 1.
    weights: Vec<f64>,
    /// For each surface that the set was made from, the index of the real surface here that represents it.
    stands_for: Vec<usize>,
}

/// A virtual set as a camera sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The colours.
    pub samples: Samples,
    /// Weight of each real surface.
    pub weights: Vec<f64>,
    /// For each colour, the metric of CIEDE2000: how far off in XYZ is how far off in CIEDE2000.
    pub metric: Vec<Matrix3>,
}

impl VirtualSet {
    /// The set made from reflectances of real surfaces. Where there are many, similar ones are replaced by their mean,
    /// with the square root of their number as weight: a compromise, because collections have many samples of some
    /// colours and few of others that are as frequent in the world.
    pub fn of(surfaces: &[Spectrum]) -> Self {
        let clusters = clusters(surfaces, CLUSTERS);
        let mut stands_for = vec![0; surfaces.len()];
        for (c, cluster) in clusters.iter().enumerate() {
            for member in &cluster.members {
                stands_for[*member] = c;
            }
        }
        let weights: Vec<f64> = clusters.iter().map(|c| (c.members.len() as f64).sqrt()).collect();
        let means: Vec<Spectrum> = clusters.into_iter().map(|c| c.mean).collect();
        Self { stands_for, ..Self::weighted(&means, &weights) }
    }

    /// The set made from the representative reflectances that are built into the program (`data/README.md`).
    /// `None` only if their text is broken.
    pub fn builtin() -> Option<&'static Self> {
        static SET: OnceLock<Option<VirtualSet>> = OnceLock::new();
        let make = || {
            let (surfaces, weights): (Vec<Spectrum>, Vec<f64>) = builtin_surfaces()?.iter().cloned().unzip();
            Some(Self::weighted(&surfaces, &weights))
        };
        SET.get_or_init(make).as_ref()
    }

    /// The set made from these very reflectances, each with a weight.
    pub fn weighted(surfaces: &[Spectrum], weights: &[f64]) -> Self {
        let clamped = |s: &Spectrum| Spectrum(s.0.map(|v| v.clamp(LEAST, 1.0)));
        let real: Vec<Spectrum> = surfaces.iter().map(clamped).collect();
        let power = |n: i32| real.iter().map(move |s| Spectrum(s.0.map(|v| v.powi(n))));
        let mean = weights.iter().sum::<f64>() / weights.len().max(1) as f64;
        Self {
            reflectances: real.iter().cloned().chain(power(2)).chain(power(3)).chain(ideal()).collect(),
            weights: weights.iter().map(|w| w / mean).collect(),
            stands_for: (0..surfaces.len()).collect(),
        }
    }

    /// For each surface that the set was made from, the index of the real surface of the set that represents it.
    pub fn stands_for(&self) -> &[usize] {
        &self.stands_for
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
        Ok(Rendered { samples, weights: self.weights.clone(), metric })
    }
}

impl Rendered {
    /// Number of real surfaces.
    pub fn real(&self) -> usize {
        self.weights.len()
    }

    /// Weight of every colour, where ideal ones have the weight `ideal`.
    pub fn weights_with(&self, ideal: f64) -> Vec<f64> {
        let powers = self.weights.iter().map(|w| w * POWER_WEIGHT);
        let known = self.weights.iter().copied().chain(powers.clone()).chain(powers);
        known.chain(std::iter::repeat(ideal)).take(self.samples.len()).collect()
    }

    /// The real surfaces alone.
    ///
    /// # Errors
    /// None in practice; the values were checked before.
    pub fn real_samples(&self) -> Result<Samples, FitError> {
        let (s, count) = (&self.samples, self.real());
        Samples::new(s.rgb()[..count].to_vec(), s.xyz()[..count].to_vec(), s.white())
    }

    /// The set without some of the real surfaces and their powers.
    ///
    /// # Errors
    /// None in practice; the values were checked before.
    pub fn without(&self, left_out: impl Fn(usize) -> bool) -> Result<Self, FitError> {
        let real = self.real();
        let kept: Vec<usize> =
            (0..self.samples.len()).filter(|i| *i >= 3 * real || !left_out(i % real)).collect();
        let s = &self.samples;
        Ok(Self {
            samples: Samples::new(
                kept.iter().map(|i| s.rgb()[*i]).collect(),
                kept.iter().map(|i| s.xyz()[*i]).collect(),
                s.white(),
            )?,
            weights: kept.iter().filter(|i| **i < real).map(|i| self.weights[*i]).collect(),
            metric: kept.iter().map(|i| self.metric[*i]).collect(),
        })
    }
}

/// The representative reflectances that are built into the program, with their weights. `None` only if their text is broken.
pub fn builtin_surfaces() -> Option<&'static [(Spectrum, f64)]> {
    static SURFACES: OnceLock<Option<Vec<(Spectrum, f64)>>> = OnceLock::new();
    SURFACES.get_or_init(|| parse_reflectances(include_str!("../../data/reflectances.csv"))).as_deref()
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
