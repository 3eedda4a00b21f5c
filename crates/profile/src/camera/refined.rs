//! A camera that is known from its matrix, or not at all, and has shot a chart of known reflectances.
//!
//! With l the light, R a patch's reflectance and b what a channel makes of it when white is 1, (l (R - b)).s = 0: each patch
//! is a linear observation of the channel's sensitivity s, as a published matrix is. Its noise is relative to b; how large it
//! is, and whether the patches share errors of gain and flare, is chosen so that they are most likely (maximum marginal
//! likelihood), as in [`crate::fit::prior`].

use darkroot_colour::spectrum::SAMPLES;
use darkroot_colour::{Spectrum, Vector3};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::posterior::{Channel, Posterior};
use crate::fit::prior::SHARED;

/// Noise of a patch that is tried, relative to its value.
const NOISES: [f64; 5] = [0.002, 0.005, 0.01, 0.02, 0.03];

/// The patches of a chart under one light, as the camera saw them.
#[derive(Debug, Clone, Copy)]
pub struct ChartSeen<'a> {
    /// The light.
    pub light: &'a Spectrum,
    /// Camera RGB of its white, of any scale.
    pub white: [f64; 3],
    /// Reflectance of each patch, and its camera RGB where that of white is (1,1,1).
    pub patches: &'a [(Spectrum, [f64; 3])],
}

impl Posterior {
    /// What the camera is after it has shot a chart, too. `None` where that cannot be: a channel that sees nothing of the
    /// light, a number that is not finite.
    #[must_use]
    pub fn refined(&self, chart: ChartSeen<'_>) -> Option<Self> {
        let light = DVector::from_column_slice(&chart.light.0) / chart.light.stimulus_xyz().y;
        let observed = [0, 1, 2].map(|k| Observed::new(&self.channels[k], &light, chart.patches, k));
        let [Some(red), Some(green), Some(blue)] = observed else { return None };
        let observed = [red, green, blue];
        let mut best: Option<(f64, [DMatrix<f64>; 3])> = None;
        for (noise, shared) in NOISES.iter().flat_map(|noise| SHARED.map(|shared| (*noise, shared))) {
            let noises = observed.each_ref().map(|o| shared.covariance(noise, &o.values));
            let likelihood = observed.iter().zip(&noises).map(|(o, noise)| o.log_likelihood(noise));
            let Some(sum) = likelihood.sum::<Option<f64>>().filter(|l| l.is_finite()) else { continue };
            if best.as_ref().is_none_or(|(most, _)| sum > *most) {
                best = Some((sum, noises));
            }
        }
        let (_, noises) = best?;
        let channel = |k: usize| observed[k].given(&self.channels[k], &noises[k]);
        let channels = [channel(0)?, channel(1)?, channel(2)?];
        let white = Vector3::from(chart.white);
        let scale = [0, 1, 2].map(|k| white[k] / channels[k].mean.dot(&light));
        let usable = scale.iter().all(|s| s.is_finite() && *s > 0.0);
        usable.then(|| Self { scale, channels, family: self.family.clone() })
    }
}

/// One channel's patches as observations that are zero.
struct Observed {
    /// The prior's covariance times the observations' rows, transposed; and the covariance of the observations without noise.
    gained: DMatrix<f64>,
    spread: DMatrix<f64>,
    /// What is missing to zero.
    surprise: DVector<f64>,
    values: DVector<f64>,
}

impl Observed {
    fn new(
        channel: &Channel,
        light: &DVector<f64>,
        patches: &[(Spectrum, [f64; 3])],
        k: usize,
    ) -> Option<Self> {
        let at_white = channel.mean.dot(light);
        if !(at_white.is_finite() && at_white > 0.0) {
            return None;
        }
        // A row for each patch: the light times its reflectance less its value, over what the channel sees of the light.
        let design = DMatrix::from_fn(patches.len(), SAMPLES, |i, j| {
            let (reflectance, rgb) = &patches[i];
            light[j] * (reflectance.0[j] - rgb[k]) / at_white
        });
        let gained = &channel.covariance * design.transpose();
        let spread = &design * &gained;
        let surprise = -(&design * &channel.mean);
        let values = DVector::from_fn(patches.len(), |i, _| patches[i].1[k]);
        Some(Self { gained, spread, surprise, values })
    }

    fn factor(&self, noise: &DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
        (&self.spread + noise).cholesky()
    }

    fn log_likelihood(&self, noise: &DMatrix<f64>) -> Option<f64> {
        let factor = self.factor(noise)?;
        let size: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        Some(-0.5 * self.surprise.dot(&factor.solve(&self.surprise)) - size)
    }

    fn given(&self, prior: &Channel, noise: &DMatrix<f64>) -> Option<Channel> {
        let factor = self.factor(noise)?;
        Some(Channel {
            mean: &prior.mean + &self.gained * factor.solve(&self.surprise),
            covariance: &prior.covariance - &self.gained * factor.solve(&self.gained.transpose()),
        })
    }
}
