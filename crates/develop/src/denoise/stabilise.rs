//! The root that gives every sample noise of variance 1, and the way back that keeps means.

use super::Line;

/// A floor without slope is taken for one with so small a slope, against the root of the floor: below it floats have too
/// few digits.
const LEAST_SLOPE: f32 = 1e-3;
/// No light is brighter than so many electrons, so that no root is infinite.
const MOST: f32 = 1e12;
/// Root at which the exact inverse is 0 electrons, 2 sqrt(3/8); below it stays there.
const ZERO: f32 = 1.224_744_9;

/// The generalised Anscombe transformation for one channel, z = 2 sqrt(x / a + 3/8 + b / a^2), for noise of variance
/// a x + b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stabiliser {
    /// Electrons (of noise) per light.
    electrons: f32,
    /// What is added to the electrons under the root.
    offset: f32,
    /// Light of an electron.
    slope: f32,
}

impl Stabiliser {
    pub(super) fn of(line: Line) -> Self {
        let slope = line.slope.max(LEAST_SLOPE * line.floor.sqrt()).max(f32::MIN_POSITIVE.sqrt());
        let floor = line.floor / slope / slope;
        Self { electrons: 1.0 / slope, offset: 0.375 + floor, slope }
    }

    /// How the root of bright grey light grows, against other channels with other slopes and multipliers.
    pub(super) fn slope_of_grey(&self, multiplier: f32) -> f32 {
        (self.electrons / multiplier.max(f32::MIN_POSITIVE)).sqrt()
    }

    /// The root of some light.
    #[inline(always)]
    pub(super) fn root(&self, light: f32) -> f32 {
        let electrons = light * self.electrons + self.offset;
        // Also where light is no number.
        let electrons = if electrons > 0.0 { electrons } else { 0.0 };
        2.0 * if electrons < MOST { electrons } else { MOST }.sqrt()
    }

    /// The light whose roots have the mean `root` where the share `removed` of their variance was taken away: Makitalo and
    /// Foi's closed form of the exact unbiased inverse for all of it, plain squares for none.
    #[inline(always)]
    pub(super) fn light(&self, root: f32, removed: f32) -> f32 {
        let root = if root > 0.0 { root } else { 0.0 };
        let inverse = 1.0 / if root > ZERO { root } else { ZERO };
        let tail = inverse * (0.306_186_22 + inverse * (-1.375 + inverse * 0.765_465_5));
        self.slope * (0.25 * root * root - self.offset + removed * (0.25 + tail))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: Line = Line { slope: 1e-4, floor: 9e-8 };

    #[test]
    fn without_removal_a_root_is_undone() {
        let stabiliser = Stabiliser::of(LINE);
        for light in [-5e-4, 0.0, 1e-3, 0.3, 1.0, 4.0] {
            let again = stabiliser.light(stabiliser.root(light), 0.0);
            assert!((again - light).abs() < 1e-6 * (1.0 + light), "{light}: {again}");
        }
    }

    #[test]
    fn the_mean_of_roots_becomes_the_mean_of_light() {
        // Poisson counts of many means, with the reading noise of three electrons, summed exactly.
        let stabiliser = Stabiliser::of(LINE);
        for electrons in [2.0f64, 10.0, 50.0, 400.0] {
            let (mut mean, mut weight) = (0.0, 0.0);
            for n in 0..2000 {
                let log = |k: u32| f64::from(k).ln();
                let p = (f64::from(n) * electrons.ln() - electrons - (1..=n).map(log).sum::<f64>()).exp();
                for step in -40..=40 {
                    let read = f64::from(step) / 10.0;
                    let p = p * (-read * read / 2.0).exp();
                    let light = ((f64::from(n) + 3.0 * read) * 1e-4) as f32;
                    mean += p * f64::from(stabiliser.root(light));
                    weight += p;
                }
            }
            let light = f64::from(stabiliser.light((mean / weight) as f32, 1.0)) / 1e-4;
            // Three electrons of read noise below none are cut at the root's end.
            assert!((light - electrons).abs() < 0.02 + 1e-3 * electrons, "{electrons}: {light}");
        }
    }

    #[test]
    fn nothing_strange_comes_of_strange_light() {
        let stabiliser = Stabiliser::of(LINE);
        for light in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0] {
            assert!(stabiliser.root(light).is_finite());
        }
        let flat = Stabiliser::of(Line { slope: 0.0, floor: 1e-6 });
        assert!((flat.light(flat.root(0.25), 0.0) - 0.25).abs() < 1e-5);
    }
}
