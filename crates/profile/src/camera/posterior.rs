//! The sensitivities that a published matrix and the other cameras make most probable.
//!
//! Each channel's sensitivity, scaled to the sum 1, has a Gaussian prior: mean and covariance over known cameras, and a
//! smooth departure from all of them. A camera counts the more, the better its own computed matrix, with the family's
//! offset, explains the published one. A published row q, less the offset, observes (B - q w'B) s = 0: the computed row B s
//! is q times its value at white w'B s. The covariance of the family's offsets is its noise. Which family a matrix
//! belongs to is not known: each counts by how probable it makes the matrix.

use darkroot_colour::spectrum::SAMPLES;
use darkroot_colour::{Matrix3, Spectrum, Vector3};
use nalgebra::{DMatrix, DVector, SVector};

use super::offsets::{Family, Observation};
use super::peers::Peers;
use super::regression::Regression;
use crate::spectra::Sensitivities;

/// Correlation length of a camera's departure from the others, nm, and its variance relative to the sensitivity's square.
const SMOOTH_NM: f64 = 30.0;
const DEPARTURE: f64 = 0.01;
/// How fast a weight falls with the distance d of a computed matrix from the published one: exp(-d / 2T).
const TEMPERATURE: f64 = 3.0;
/// Share of the weight that all cameras have alike.
const ALIKE: f64 = 0.1;
/// Variance of the sum, which is 1.
const EXACT: f64 = 1e-10;
/// A family of less weight than this is left out.
const NEGLIGIBLE: f64 = 1e-3;

/// A camera as far as it is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// How sensitive each channel is beside the others: its sum over wavelength.
    pub(super) scale: [f64; 3],
    pub(super) channels: [Channel; 3],
    /// The family that explains the matrix best; `None` without a matrix.
    pub(super) family: Option<String>,
}

/// One channel's sensitivity, scaled to the sum 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channel {
    pub(super) mean: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
}

/// A published matrix as the estimate uses it.
struct Seen {
    regression: Regression,
    /// Rows, scaled to 1 at white.
    rows: [Vector3; 3],
    listed: bool,
    /// Covariance of each row by the camera's own departure from the others; nothing for listed matrices, whose families
    /// were learnt from cameras as they are.
    own: [Matrix3; 3],
}

/// How a family explains a matrix through each of the cameras.
struct Explained<'a> {
    family: &'a Family,
    /// Weight of each camera; they sum to 1.
    cameras: Vec<f64>,
    /// Logarithm of the family's probability, up to a constant.
    likelihood: f64,
}

impl Posterior {
    /// The camera of a published matrix. `None` where the matrix is not usable (a channel that is dark at white, a number
    /// that is not finite).
    pub fn of(peers: &Peers, published: &Observation) -> Option<Self> {
        let regression = Regression::under(&published.light, &peers.surfaces)?;
        let rows = regression.scaled(&published.matrix)?;
        let own = [0, 1, 2].map(|k| match published.listed {
            true => Matrix3::zeros(),
            false => own_spread(peers, &regression, &rows[k], k),
        });
        let seen = Seen { regression, rows, listed: published.listed, own };
        let explained: Vec<Explained<'_>> =
            peers.families.iter().map(|f| seen.explained(peers, f)).collect::<Option<_>>()?;
        let most = explained.iter().map(|e| e.likelihood).fold(f64::NEG_INFINITY, f64::max);
        let shares: Vec<f64> = explained.iter().map(|e| (e.likelihood - most).exp()).collect();
        let total: f64 = shares.iter().sum();
        let best = explained.iter().max_by(|a, b| a.likelihood.total_cmp(&b.likelihood))?;
        let mut parts = Vec::new();
        for (explained, share) in explained.iter().zip(&shares) {
            let share = share / total;
            if share > NEGLIGIBLE {
                parts.push((share, seen.channels(peers, explained)?));
            }
        }
        let channel = |k: usize| mixture(parts.iter().map(|(share, channels)| (*share, &channels[k])));
        let channels = [channel(0), channel(1), channel(2)];
        // What the matrix says of a channel at white is what the channel sees of the light there.
        let at_white = published.matrix * Vector3::from(published.light.white());
        let light = DVector::from_column_slice(&published.light.0) / published.light.stimulus_xyz().y;
        let scale = [0, 1, 2].map(|k| at_white[k] / channels[k].mean.dot(&light));
        let usable = scale.iter().all(|s| s.is_finite() && *s > 0.0);
        usable.then(|| Self { scale, channels, family: Some(best.family.name.clone()) })
    }

    /// The mean camera, where no matrix is known: every camera counts alike, and white is white under daylight.
    pub fn mean_camera(peers: &Peers) -> Self {
        let alike = vec![1.0 / peers.cameras.len() as f64; peers.cameras.len()];
        let channel = |k: usize| {
            let (mean, covariance) = prior(peers, &alike, k);
            Channel { mean, covariance }
        };
        let channels = [channel(0), channel(1), channel(2)];
        let daylight = DVector::from_column_slice(&Spectrum::daylight(5003.0).0);
        let scale = [0, 1, 2].map(|k| 1.0 / channels[k].mean.dot(&daylight));
        Self { scale, channels, family: None }
    }

    /// The family of published matrices that explains the matrix best; `None` for the mean camera.
    pub fn family(&self) -> Option<&str> {
        self.family.as_deref()
    }

    /// The most probable sensitivities.
    pub fn sensitivities(&self) -> Sensitivities {
        self.with(|channel| channel.mean.clone())
    }

    /// Cameras that are as probable as they should be: `count` draws from the posterior, always the same ones.
    pub fn draws(&self, count: usize) -> Vec<Sensitivities> {
        let rounding = DMatrix::identity(SAMPLES, SAMPLES) * 1e-12;
        let roots = self.channels.each_ref().map(|c| (&c.covariance + &rounding).cholesky().map(|r| r.l()));
        let mut normal = Normal::default();
        let mut draw = || {
            let mut roots = roots.iter();
            self.with(|channel| {
                let random = DVector::from_fn(SAMPLES, |_, _| normal.next());
                match roots.next() {
                    Some(Some(root)) => &channel.mean + root * random,
                    _ => channel.mean.clone(),
                }
            })
        };
        (0..count).map(|_| draw()).collect()
    }

    fn with(&self, mut of: impl FnMut(&Channel) -> DVector<f64>) -> Sensitivities {
        Sensitivities([0, 1, 2].map(|k| {
            let mut samples = [0.0; SAMPLES];
            samples.copy_from_slice((of(&self.channels[k]) * self.scale[k]).as_slice());
            Spectrum(samples)
        }))
    }
}

impl Seen {
    fn explained<'a>(&self, peers: &Peers, family: &'a Family) -> Option<Explained<'a>> {
        let mut inverses = [Matrix3::zeros(); 3];
        let mut spread = 0.0;
        for (k, inverse) in inverses.iter_mut().enumerate() {
            let covariance = family.covariance[k] + self.own[k];
            *inverse = covariance.try_inverse()?;
            spread += covariance.determinant().ln();
        }
        let distance = |camera: &[DVector<f64>; 3]| -> f64 {
            let off = |k: usize| self.regression.row(&camera[k]) + family.mean[k] - self.rows[k];
            (0..3).map(|k| off(k).dot(&(inverses[k] * off(k)))).sum()
        };
        let logarithms: Vec<f64> = peers.cameras.iter().map(|c| -distance(c) / (2.0 * TEMPERATURE)).collect();
        let most = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let likely: Vec<f64> = logarithms.iter().map(|l| (l - most).exp()).collect();
        let total: f64 = likely.iter().sum();
        let even = 1.0 / likely.len() as f64;
        let share = if self.listed { family.shares.listed } else { family.shares.found };
        Some(Explained {
            family,
            cameras: likely.iter().map(|l| (1.0 - ALIKE) * l / total + ALIKE * even).collect(),
            likelihood: most + (total * even * share).ln() - spread / (2.0 * TEMPERATURE),
        })
    }

    fn channels(&self, peers: &Peers, explained: &Explained<'_>) -> Option<[Channel; 3]> {
        let channel = |k: usize| self.channel(peers, explained, k);
        Some([channel(0)?, channel(1)?, channel(2)?])
    }

    /// The prior of the weighted cameras, given the row.
    fn channel(&self, peers: &Peers, explained: &Explained<'_>, k: usize) -> Option<Channel> {
        let family = explained.family;
        let (mean, covariance) = prior(peers, &explained.cameras, k);
        let operator = &self.regression.operator;
        let at_white = self.regression.white.transpose() * operator;
        let gain = (at_white * &mean)[0];
        let row = self.rows[k] - family.mean[k];
        let mut design = DMatrix::zeros(4, SAMPLES);
        design.row_mut(0).fill(1.0);
        design.rows_mut(1, 3).copy_from(&(operator - row * at_white));
        let gained = &covariance * design.transpose();
        let mut spread = &design * &gained;
        spread[(0, 0)] += EXACT;
        let mut noise = spread.view_mut((1, 1), (3, 3));
        noise += family.covariance[k] * gain * gain;
        let mut surprise = -(&design * &mean);
        surprise[0] += 1.0;
        let factor = spread.cholesky()?;
        Some(Channel {
            mean: mean + &gained * factor.solve(&surprise),
            covariance: covariance - &gained * factor.solve(&gained.transpose()),
        })
    }
}

/// Mean and covariance of one channel over weighted cameras, with the smooth departure.
fn prior(peers: &Peers, weights: &[f64], k: usize) -> (DVector<f64>, DMatrix<f64>) {
    let (mean, sizes) = moments(peers, weights, k);
    let effective = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
    let unbiased = effective / (effective - 1.0).max(0.5);
    let mut off = DMatrix::zeros(SAMPLES, peers.cameras.len());
    for (i, (camera, w)) in peers.cameras.iter().zip(weights).enumerate() {
        off.set_column(i, &((&camera[k] - &mean) * (w * unbiased).sqrt()));
    }
    let covariance = &off * off.transpose() + departure(&sizes);
    (mean, covariance)
}

/// Covariance of a row of the matrix that a camera's departure from the others gives.
fn own_spread(peers: &Peers, regression: &Regression, row: &Vector3, k: usize) -> Matrix3 {
    let even = vec![1.0 / peers.cameras.len() as f64; peers.cameras.len()];
    let (mean, sizes) = moments(peers, &even, k);
    let at_white = regression.white.transpose() * regression.operator;
    let design = (regression.operator - row * at_white) / (at_white * mean)[0];
    let spread = design * departure(&sizes) * design.transpose();
    Matrix3::from_fn(|i, j| spread[(i, j)])
}

/// Mean and root mean square of one channel over weighted cameras.
fn moments(peers: &Peers, weights: &[f64], k: usize) -> (DVector<f64>, DVector<f64>) {
    let mut mean = DVector::zeros(SAMPLES);
    let mut squares = DVector::zeros(SAMPLES);
    for (camera, w) in peers.cameras.iter().zip(weights) {
        mean.axpy(*w, &camera[k], 1.0);
        squares.axpy(*w, &camera[k].component_mul(&camera[k]), 1.0);
    }
    (mean, squares.map(f64::sqrt))
}

/// Covariance of a camera's smooth departure from the others, whose size is this.
fn departure(sizes: &DVector<f64>) -> DMatrix<f64> {
    let smooth: SVector<f64, SAMPLES> = SVector::from_fn(|apart, _| {
        let apart = darkroot_colour::spectrum::STEP_NM * apart as f64 / SMOOTH_NM;
        DEPARTURE * (-0.5 * apart * apart).exp()
    });
    DMatrix::from_fn(SAMPLES, SAMPLES, |i, j| sizes[i] * sizes[j] * smooth[i.abs_diff(j)])
}

/// One Gaussian with the mean and the covariance of several, weighted.
fn mixture<'a>(parts: impl Iterator<Item = (f64, &'a Channel)> + Clone) -> Channel {
    let mut mean = DVector::zeros(SAMPLES);
    let mut covariance = DMatrix::zeros(SAMPLES, SAMPLES);
    for (share, part) in parts.clone() {
        mean.axpy(share, &part.mean, 1.0);
    }
    for (share, part) in parts {
        let off = &part.mean - &mean;
        covariance += (&part.covariance + &off * off.transpose()) * share;
    }
    Channel { mean, covariance }
}

/// Normal deviates: a linear congruential generator (Knuth's MMIX) and the transform of Box and Muller.
struct Normal {
    state: u64,
    spare: Option<f64>,
}

impl Default for Normal {
    fn default() -> Self {
        Self { state: 0x9e37_79b9_7f4a_7c15, spare: None }
    }
}

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.state =
            self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let (radius, angle) = ((-2.0 * self.uniform().ln()).sqrt(), std::f64::consts::TAU * self.uniform());
        self.spare = Some(radius * angle.sin());
        radius * angle.cos()
    }
}
