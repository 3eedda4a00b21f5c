//! What cameras have in common: statistics of their sensitivities, from which no single camera can be recovered.

use darkroot_colour::Spectrum;
use darkroot_colour::decomposition::symmetric_eigen;
use darkroot_colour::spectrum::SAMPLES;
use nalgebra::{DMatrix, DVector};

use crate::spectra::Sensitivities;

/// Sensitivities of a population of cameras, each channel scaled to the sum 1 over 380 to 780 nm every 5 nm.
#[derive(Debug, Clone, PartialEq)]
pub struct Population {
    pub(super) channels: [ChannelPopulation; 3],
}

/// One channel: its mean, and its principal components, each as long as the standard deviation along it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ChannelPopulation {
    pub(super) mean: DVector<f64>,
    pub(super) components: Vec<DVector<f64>>,
}

impl Population {
    /// Mean and the `most` first principal components over cameras. `None` for fewer than two cameras, or where a
    /// channel sees nothing.
    pub fn of(cameras: &[Sensitivities], most: usize) -> Option<Self> {
        if cameras.len() < 2 {
            return None;
        }
        let channel = |c: usize| {
            let scaled = |camera: &Sensitivities| {
                let values = DVector::from_column_slice(&camera.0[c].0);
                let sum = values.sum();
                (sum > 0.0 && sum.is_finite()).then(|| values / sum)
            };
            let all = cameras.iter().map(scaled).collect::<Option<Vec<_>>>()?;
            let mean = all.iter().sum::<DVector<f64>>() / all.len() as f64;
            let mut covariance = DMatrix::zeros(SAMPLES, SAMPLES);
            for one in &all {
                let off = one - &mean;
                covariance += &off * off.transpose() / (all.len() - 1) as f64;
            }
            Some(ChannelPopulation { mean, components: components(covariance, most.min(all.len() - 1)) })
        };
        Some(Self { channels: [channel(0)?, channel(1)?, channel(2)?] })
    }

    /// The statistics of eleven cameras that are built into the program (`data/README.md`). `None` only if their text
    /// is broken.
    pub fn builtin() -> Option<Self> {
        Self::parse(include_str!("../../data/sensitivities.csv"))
    }

    /// As text: for each channel a line for the mean and one for each component, 81 values with six decimals.
    pub fn format(&self) -> String {
        let line = |name: &str, values: &DVector<f64>| {
            let values: Vec<String> = values.iter().map(|v| format!("{:.6}", v + 0.0)).collect();
            format!("{name},{}\n", values.join(","))
        };
        let mut text = String::new();
        for (name, channel) in ["red", "green", "blue"].iter().zip(&self.channels) {
            text += &line(&format!("{name} mean"), &channel.mean);
            for (i, component) in channel.components.iter().enumerate() {
                text += &line(&format!("{name} {}", i + 1), component);
            }
        }
        text
    }

    /// From the text of [`Population::format`]. `None` where it is no such text.
    pub fn parse(text: &str) -> Option<Self> {
        let channel = |name: &str| {
            let row = |line: &str| {
                let (label, values) = line.split_once(',')?;
                let values: Vec<f64> = values.split(',').map(|v| v.parse().ok()).collect::<Option<_>>()?;
                let kind = label.strip_prefix(name)?.trim();
                (values.len() == SAMPLES).then(|| (kind == "mean", DVector::from_vec(values)))
            };
            let rows: Vec<(bool, DVector<f64>)> =
                text.lines().filter(|l| l.starts_with(name)).map(row).collect::<Option<_>>()?;
            let (means, components): (Vec<_>, Vec<_>) = rows.into_iter().partition(|(mean, _)| *mean);
            let mean = means.into_iter().next()?.1;
            Some(ChannelPopulation { mean, components: components.into_iter().map(|(_, c)| c).collect() })
        };
        Some(Self { channels: [channel("red")?, channel("green")?, channel("blue")?] })
    }
}

/// The directions of largest variance, each as long as its standard deviation, its largest value positive.
fn components(covariance: DMatrix<f64>, most: usize) -> Vec<DVector<f64>> {
    let Some(eigen) = symmetric_eigen(covariance) else { return Vec::new() };
    let mut order: Vec<usize> = (0..SAMPLES).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let component = |i: usize| {
        let direction = eigen.eigenvectors.column(i) * eigen.eigenvalues[i].max(0.0).sqrt();
        let largest = direction[direction.icamax()];
        if largest < 0.0 { -direction } else { direction }
    };
    order.into_iter().take(most).map(component).collect()
}

/// Reflectances as text: a line each, its weight first, then 81 values with four decimals.
pub fn format_reflectances(reflectances: &[(Spectrum, f64)]) -> String {
    let line = |(s, weight): &(Spectrum, f64)| {
        let values: Vec<String> = s.0.iter().map(|v| format!("{v:.4}")).collect();
        format!("{weight:.4},{}\n", values.join(","))
    };
    reflectances.iter().map(line).collect()
}

/// From the text of [`format_reflectances`]. `None` where it is no such text.
pub fn parse_reflectances(text: &str) -> Option<Vec<(Spectrum, f64)>> {
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().ok()).collect::<Option<_>>()?;
        let (weight, values) = values.split_first()?;
        Some((Spectrum(values.try_into().ok()?), *weight))
    };
    text.lines().filter(|l| !l.starts_with('#')).map(row).collect()
}

/// Reflectances projected on their first principal components: what they have in common stays, single ones are not
/// told.
pub fn smoothed(reflectances: &[Spectrum], all: &[Spectrum], most: usize) -> Vec<Spectrum> {
    let vector = |s: &Spectrum| DVector::from_column_slice(&s.0);
    let mean = all.iter().map(vector).sum::<DVector<f64>>() / all.len().max(1) as f64;
    let mut covariance = DMatrix::zeros(SAMPLES, SAMPLES);
    for one in all {
        let off = vector(one) - &mean;
        covariance += &off * off.transpose();
    }
    let directions: Vec<DVector<f64>> = components(covariance, most).iter().map(|c| c.normalize()).collect();
    let project = |s: &Spectrum| {
        let off = vector(s) - &mean;
        let kept = directions.iter().fold(mean.clone(), |sum, d| sum + d * d.dot(&off));
        Spectrum(std::array::from_fn(|i| kept[i].clamp(0.0, 1.0)))
    };
    reflectances.iter().map(project).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cameras() -> Vec<Sensitivities> {
        let band = |centre: f64, width: f64| Spectrum::from_fn(|nm| (-((nm - centre) / width).powi(2)).exp());
        let camera = |shift: f64| {
            Sensitivities([band(600.0 + shift, 40.0), band(540.0, 40.0 + shift), band(450.0, 30.0)])
        };
        [-8.0, -3.0, 0.0, 5.0, 9.0].map(camera).to_vec()
    }

    #[test]
    fn statistics_survive_their_text() {
        let population = Population::of(&cameras(), 3).unwrap();
        let read = Population::parse(&population.format()).unwrap();
        for (a, b) in population.channels.iter().zip(&read.channels) {
            assert!((&a.mean - &b.mean).amax() < 1e-6 && a.components.len() == b.components.len());
        }
        assert_eq!(Population::parse("red mean,1,2,3"), None);
    }

    #[test]
    fn components_carry_the_variance() {
        let population = Population::of(&cameras(), 4).unwrap();
        let variance =
            |c: usize| -> f64 { population.channels[c].components.iter().map(DVector::norm_squared).sum() };
        // Red and green move among these cameras, blue does not.
        assert!(variance(0) > 1e-5 && variance(1) > 1e-5 && variance(2) < 1e-20);
    }
}
