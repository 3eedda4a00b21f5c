//! How strong the noise of samples is, by their light.

/// The variance of samples under one filter: `slope` x light + `floor`, in the unit of light (1 = saturated).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Line {
    /// Shot noise: light of one electron.
    pub slope: f32,
    /// Read noise.
    pub floor: f32,
}

impl Line {
    /// The variance at some light.
    pub fn at(self, light: f32) -> f32 {
        self.slope * light.max(0.0) + self.floor
    }

    /// Whether both numbers are finite, none is negative, and there is noise.
    pub fn is_sane(self) -> bool {
        let sane = |v: f32| v.is_finite() && v >= 0.0;
        sane(self.slope) && sane(self.floor) && self.slope + self.floor > 0.0
    }
}

/// The noise of a capture's red, green and blue samples, before balancing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    /// By channel.
    pub channels: [Line; 3],
}

/// Signal to noise at the mean light of a picture from which on it counts as clean: the noise of 160 000 electrons.
const CLEAN: f32 = 400.0;
/// Variance of rounding to whole counts.
const ROUNDING: f32 = 1.0 / 12.0;
/// Up to so many times the variance of rounding there is nothing else.
const ONLY_ROUNDING: f32 = 2.0;

impl NoiseModel {
    /// From DNG NoiseProfile: pairs of slope and floor, one for all channels or one for each. `None` where it says nothing
    /// that could be true.
    pub fn from_profile(pairs: &[[f64; 2]]) -> Option<Self> {
        let line = |pair: &[f64; 2]| Line { slope: pair[0] as f32, floor: pair[1] as f32 };
        let channels = match pairs {
            [one] => [line(one); 3],
            [red, green, blue] => [red, green, blue].map(line),
            _ => return None,
        };
        channels.iter().all(|line| line.is_sane()).then_some(Self { channels })
    }

    /// Whether there is nothing to take away in a picture of this mean light whose counts are so far apart.
    pub fn is_clean(&self, mean: [f32; 3], step: f32) -> bool {
        let rounding = ONLY_ROUNDING * ROUNDING * step * step;
        self.channels.iter().zip(mean).all(|(line, mean)| {
            let variance = line.at(mean);
            variance <= rounding || mean > CLEAN * variance.sqrt()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_has_one_pair_or_three() {
        let pair = [1e-4, 1e-7];
        let one = NoiseModel::from_profile(&[pair]).unwrap();
        assert_eq!(Some(one), NoiseModel::from_profile(&[pair; 3]));
        assert!((one.channels[2].at(0.5) - 5.01e-5).abs() < 1e-9);
        for wrong in [vec![], vec![pair; 2], vec![[f64::NAN, 0.0]], vec![[0.0, 0.0]], vec![[-1e-4, 1e-3]]] {
            assert_eq!(NoiseModel::from_profile(&wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn what_is_only_rounded_is_clean() {
        let step = 1.0 / 4095.0;
        let only = |floor: f32| NoiseModel { channels: [Line { slope: 0.0, floor }; 3] };
        assert!(only(step * step / 12.0).is_clean([0.01; 3], step));
        assert!(!only(step * step).is_clean([0.01; 3], step));
        // Bright and nearly without noise.
        assert!(only(step * step).is_clean([0.5; 3], step));
    }
}
