//! How much of a detail is noise: local Wiener shrinkage (Mihcak et al. 1999).
//!
//! The wavelet's low-pass is (1 2 1)/4 along rows and along columns, its taps twice as far apart at each scale. A detail of
//! power v, as its surroundings have it, in noise of variance n, keeps the share 1 - n / v. The power is that of squares of
//! 2 x 2 details, weighted 1 2 1 with those around it: shared by four details, it costs little, and figures are as good.

/// Scales that are looked at.
pub(super) const SCALES: usize = 6;
/// Those of them that are looked at in tiles, at every sample.
pub(super) const FINE: usize = 2;

/// How much above its expected power noise is still taken for noise: the power of a few details scatters. Tuned on Kodak 1,
/// 5, 23 and McMaster 1, 9, 13, with noise added.
const MARGIN: f32 = 1.2;

/// The smallest power that divides.
const TINY: f32 = 1e-12;

/// The power up to which details of a scale whose noise has this variance vanish.
pub(super) fn threshold(variance: f32, strength: f32) -> f32 {
    MARGIN * variance * strength * strength
}

/// The share of a detail of some power that is taken away.
#[inline(always)]
pub(super) fn removed(threshold: f32, power: f32) -> f32 {
    let share = threshold / if power > TINY { power } else { TINY };
    if share < 1.0 { share } else { 1.0 }
}

/// What white noise of variance 1 becomes.
#[derive(Debug)]
pub(super) struct UnitNoise {
    /// Variance of the details of each scale.
    pub(super) variances: [f32; SCALES],
    /// Of the two finest: how their details depend on each other, against the variance of both together.
    pub(super) shares: [f32; 3],
}

impl UnitNoise {
    pub(super) fn new() -> Self {
        // The low-pass of scale j in one dimension, centred. In two dimensions it is the product of that with itself, so
        // that sums of products are squares of those in one.
        let mut smooth = vec![vec![1.0f64]];
        for j in 0..SCALES {
            let (last, step) = (&smooth[j], 1usize << j);
            let mut next = vec![0.0; last.len() + 2 * step];
            for (i, v) in last.iter().enumerate() {
                for (tap, weight) in [0.25, 0.5, 0.25].into_iter().enumerate() {
                    next[i + tap * step] += v * weight;
                }
            }
            smooth.push(next);
        }
        let product = |i: usize, j: usize| {
            let (short, long) = (&smooth[i.min(j)], &smooth[i.max(j)]);
            let first = (long.len() - short.len()) / 2;
            short.iter().zip(&long[first..]).map(|(a, b)| a * b).sum::<f64>().powi(2)
        };
        // Details are the differences of successive low-passes.
        let dependence = |i: usize, j: usize| {
            product(i, j) - product(i, j + 1) - product(i + 1, j) + product(i + 1, j + 1)
        };
        let fine = [dependence(0, 0), 2.0 * dependence(0, 1), dependence(1, 1)];
        let both: f64 = fine.iter().sum();
        Self {
            variances: std::array::from_fn(|j| dependence(j, j) as f32),
            shares: fine.map(|v| (v / both) as f32),
        }
    }

    /// The share of the variance that is left when these shares of the details of the two finest scales are taken away, and
    /// all of the others.
    #[inline(always)]
    pub(super) fn left(&self, removed: [f32; 2]) -> f32 {
        let [a, b] = removed.map(|r| 1.0 - r);
        self.shares[0] * a * a + self.shares[1] * a * b + self.shares[2] * b * b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_noise_alone_nothing_is_left_and_of_strong_details_nearly_all() {
        let threshold = threshold(0.5, 1.0);
        assert!(removed(threshold, 0.5) == 1.0 && removed(threshold, 0.0) == 1.0);
        assert!((removed(threshold, 60.0) - 0.01).abs() < 1e-6);
        assert_eq!(removed(super::threshold(0.5, 0.0), 0.5), 0.0);
    }

    #[test]
    fn shares_of_the_variance() {
        let unit = UnitNoise::new();
        // 1 - 2/4 + (6/16)^2.
        assert!((unit.variances[0] - 0.640_625).abs() < 1e-6);
        assert!(unit.variances.windows(2).all(|v| v[1] < v[0] / 3.0));
        assert!((unit.left([0.0; 2]) - 1.0).abs() < 1e-6 && unit.left([1.0; 2]).abs() < 1e-6);
    }
}
