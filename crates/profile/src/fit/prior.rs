//! The camera's sensitivities, estimated from a shot of a chart and from what is known of other cameras.
//!
//! Unknown is each channel's effective sensitivity e: the light times the sensitivity, scaled to the sum 1. Its prior
//! is Gaussian, with the mean and the covariance over known cameras. A second covariance is added for what is peculiar
//! to this camera, a smooth departure from all others: alpha diag(a) K diag(a), with K a Gaussian in the distance of
//! wavelengths and a the root mean square of e over the cameras. The patches, whose reflectances R are known, are
//! measurements rgb = R e with noise; errors of gain and flare, which all patches share, may be part of the noise.
//! White counts as exact. The estimate is the posterior mean. alpha, the noise and the shared errors are chosen so that
//! the patches are most likely (maximum marginal likelihood).

use darkroot_colour::Spectrum;
use darkroot_colour::spectrum::SAMPLES;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::population::{ChannelPopulation, Population};
use crate::spectra::Effective;

/// Correlation length of a camera's departure from the others, nm.
const SMOOTH_NM: f64 = 30.0;
/// Sizes of that departure that are tried, relative to the sensitivities.
const DEPARTURES: [f64; 6] = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3];
/// Noise of a patch that is tried, relative to its value.
const NOISES: [f64; 6] = [0.0005, 0.001, 0.003, 0.01, 0.02, 0.03];
/// Noise is proportional to the value of a patch, but never below that of a patch of this value.
const DARKEST: f64 = 0.01;
/// Shared errors of all patches that are tried: none, and those of an ordinary shot.
pub(crate) const SHARED: [Shared; 2] =
    [Shared { gain: 0.0, flare: 0.0 }, Shared { gain: 0.02, flare: 0.003 }];
/// Variance of the white, which is exact.
const EXACT: f64 = 1e-10;

/// What is known of cameras in general under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    channels: [ChannelPrior; 3],
}

#[derive(Debug, Clone, PartialEq)]
struct ChannelPrior {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Covariance of the smooth departure for alpha = 1.
    departure: DMatrix<f64>,
}

/// How far a camera may depart from the others, and how noisy its patches are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hyperparameters {
    /// alpha: variance of the smooth departure, relative.
    pub departure: f64,
    /// Noise of a patch, relative to its value.
    pub noise: f64,
    /// Errors that all patches share.
    pub shared: Shared,
}

/// Standard deviations of errors that all patches of a shot share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shared {
    /// Of the gain (exposure, shading).
    pub gain: f64,
    /// Of the flare, relative to white.
    pub flare: f64,
}

impl Shared {
    /// Covariance of the errors of patches of these values: the shared ones, and noise of its own for each, relative.
    pub(crate) fn covariance(self, noise: f64, values: &DVector<f64>) -> DMatrix<f64> {
        let mut covariance = values * values.transpose() * (self.gain * self.gain);
        covariance.add_scalar_mut(self.flare * self.flare);
        for (i, value) in values.iter().enumerate() {
            covariance[(i, i)] += (noise * value.max(DARKEST)).powi(2);
        }
        covariance
    }
}

/// Patches of known reflectances and what the camera made of them.
#[derive(Debug, Clone, Copy)]
pub struct Observed<'a> {
    /// Reflectances of the patches.
    pub reflectances: &'a [Spectrum],
    /// Balanced camera RGB of each.
    pub rgb: &'a [[f64; 3]],
}

impl Prior {
    /// The prior of a population of cameras under a light. `None` where a channel sees nothing of it.
    ///
    /// With the mean m and the covariance S of sensitivities of sum 1, light l gives e the mean l m / (l.m) and the
    /// covariance diag(l) S diag(l) / (l.m)^2, to first order.
    pub fn under(cameras: &Population, light: &Spectrum) -> Option<Self> {
        let light = DVector::from_column_slice(&light.0);
        let channel = |channel: &ChannelPopulation| {
            let seen = light.dot(&channel.mean);
            if !(seen > 0.0 && seen.is_finite()) {
                return None;
            }
            let scaled = |v: &DVector<f64>| v.component_mul(&light) / seen;
            let mean = scaled(&channel.mean);
            let mut covariance = DMatrix::zeros(SAMPLES, SAMPLES);
            for component in &channel.components {
                let component = scaled(component);
                covariance += &component * component.transpose();
            }
            let size = DVector::from_fn(SAMPLES, |i, _| (mean[i] * mean[i] + covariance[(i, i)]).sqrt());
            Some(ChannelPrior::new(mean, covariance, &size))
        };
        let [r, g, b] = cameras.channels.each_ref().map(channel);
        Some(Self { channels: [r?, g?, b?] })
    }

    /// The hyperparameters under which the patches are most likely, all channels together. `None` when the patches
    /// cannot be explained at all (a value that is not finite).
    pub fn most_likely(&self, observed: Observed<'_>) -> Option<Hyperparameters> {
        let design = design(observed.reflectances);
        let mut best: Option<(f64, Hyperparameters)> = None;
        for departure in DEPARTURES {
            let spreads = self.channels.each_ref().map(|c| &design * c.total(departure) * design.transpose());
            for (noise, shared) in NOISES.into_iter().flat_map(|n| SHARED.map(|s| (n, s))) {
                let h = Hyperparameters { departure, noise, shared };
                let likelihood = (0..3).map(|c| {
                    let known = Known::new(&self.channels[c], &design, &spreads[c], observed, c, h)?;
                    Some(known.log_likelihood())
                });
                let Some(sum) = likelihood.sum::<Option<f64>>().filter(|l| l.is_finite()) else { continue };
                if best.as_ref().is_none_or(|(most, _)| sum > *most) {
                    best = Some((sum, h));
                }
            }
        }
        best.map(|(_, h)| h)
    }

    /// The camera as far as the patches and the other cameras tell. `None` as in [`Prior::most_likely`].
    pub fn posterior(&self, observed: Observed<'_>, h: Hyperparameters) -> Option<Effective> {
        let design = design(observed.reflectances);
        let channel = |c: usize| {
            let prior = &self.channels[c];
            let total = prior.total(h.departure);
            let spread = &design * &total * design.transpose();
            let known = Known::new(prior, &design, &spread, observed, c, h)?;
            let mean = &prior.mean + total * design.transpose() * known.factor.solve(&known.surprise);
            let mut samples = [0.0; SAMPLES];
            samples.copy_from_slice(mean.as_slice());
            Some(Spectrum(samples))
        };
        Some(Effective([channel(0)?, channel(1)?, channel(2)?]))
    }
}

impl ChannelPrior {
    fn new(mean: DVector<f64>, covariance: DMatrix<f64>, size: &DVector<f64>) -> Self {
        let departure = DMatrix::from_fn(SAMPLES, SAMPLES, |i, j| {
            let apart = Spectrum::wavelength(i) - Spectrum::wavelength(j);
            size[i] * size[j] * (-(apart * apart) / (2.0 * SMOOTH_NM * SMOOTH_NM)).exp()
        });
        Self { mean, covariance, departure }
    }

    fn total(&self, departure: f64) -> DMatrix<f64> {
        &self.covariance + &self.departure * departure
    }
}

/// Reflectances as rows, and the perfect diffuser as the last one.
fn design(reflectances: &[Spectrum]) -> DMatrix<f64> {
    DMatrix::from_fn(reflectances.len() + 1, SAMPLES, |i, k| reflectances.get(i).map_or(1.0, |r| r.0[k]))
}

/// One channel's patches against what the prior expects of them.
struct Known {
    /// Cholesky factor of the covariance of the patches.
    factor: Cholesky<f64, Dyn>,
    /// What was measured less what the prior expects.
    surprise: DVector<f64>,
}

impl Known {
    fn new(
        prior: &ChannelPrior,
        design: &DMatrix<f64>,
        spread: &DMatrix<f64>,
        observed: Observed<'_>,
        channel: usize,
        h: Hyperparameters,
    ) -> Option<Self> {
        let Hyperparameters { noise, shared, .. } = h;
        let count = observed.rgb.len();
        let value = |i: usize| observed.rgb.get(i).map_or(1.0, |rgb| rgb[channel]);
        let mut covariance = spread.clone();
        let mut patches = covariance.view_mut((0, 0), (count, count));
        patches += shared.covariance(noise, &DVector::from_fn(count, |i, _| value(i)));
        covariance[(count, count)] += EXACT;
        let measured = DVector::from_fn(count + 1, |i, _| value(i));
        // A hundredth of a millionth of the smallest noise, squared, against rounding.
        let rounding = DMatrix::identity(count + 1, count + 1) * 1e-14;
        Some(Self {
            factor: Cholesky::new(covariance + rounding)?,
            surprise: measured - design * &prior.mean,
        })
    }

    /// Up to a constant.
    fn log_likelihood(&self) -> f64 {
        let explained = self.surprise.dot(&self.factor.solve(&self.surprise));
        let size: f64 = self.factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        -0.5 * explained - size
    }
}
