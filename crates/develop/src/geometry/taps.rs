//! Weights of the pixels from which a place between them is interpolated.

/// Places between two pixels that are told apart.
const PHASES: usize = 256;
/// Zeros of the kernel on each side.
const LOBES: f64 = 3.0;
/// Weights come in groups of so many: as many as one place takes where nothing is made smaller.
pub(super) const GROUP: usize = 6;

/// Lanczos's kernel (Duchon, Journal of Applied Meteorology 18, 1979) along one axis, widened where a picture is made
/// smaller, so that no detail is left that the smaller picture cannot show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Taps {
    /// Pixels that one place is made of: as many on each side.
    pub(super) count: usize,
    /// That, filled up with zeros to whole groups.
    padded: usize,
    /// By phase: weights whose sum is 1.
    weights: Vec<f32>,
}

impl Taps {
    /// For a picture in which a pixel stands for so many of those that it is made of, along each axis.
    pub(super) fn of(reduction: f64) -> Self {
        let reduction = reduction.max(1.0);
        let half = (LOBES * reduction).ceil() as usize;
        let (count, padded) = (2 * half, (2 * half).next_multiple_of(GROUP));
        let mut weights = vec![0f32; PHASES * padded];
        for (phase, weights) in weights.chunks_exact_mut(padded).enumerate() {
            let between = phase as f64 / PHASES as f64;
            let at = |i: usize| kernel((i as f64 - (half as f64 - 1.0) - between) / reduction);
            let sum: f64 = (0..count).map(at).sum();
            for (i, weight) in weights[..count].iter_mut().enumerate() {
                *weight = (at(i) / sum) as f32;
            }
        }
        Self { count, padded, weights }
    }

    /// Pixels on each side of a place that it is made of, or that are read with them.
    pub(super) fn reach(&self) -> usize {
        self.count / 2 + GROUP
    }

    /// The first pixel that makes a place (the middle of pixel i is i + 0.5), and the weights from there on.
    #[inline(always)]
    pub(super) fn at(&self, place: f64) -> (isize, &[f32]) {
        // In parts of a pixel; places are within a few pictures of the frame.
        let parts = ((place - 0.5) * PHASES as f64).round() as i32 as isize;
        let first = parts.div_euclid(PHASES as isize) + 1 - (self.count / 2) as isize;
        let phase = parts.rem_euclid(PHASES as isize) as usize;
        (first, &self.weights[phase * self.padded..][..self.padded])
    }
}

/// sinc(x) sinc(x / 3) within three pixels.
fn kernel(x: f64) -> f64 {
    let sinc = |x: f64| {
        let x = std::f64::consts::PI * x;
        if x.abs() < 1e-9 { 1.0 } else { x.sin() / x }
    };
    if x.abs() < LOBES { sinc(x) * sinc(x / LOBES) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_itself_and_even_light_stays() {
        let taps = Taps::of(1.0);
        let (first, weights) = taps.at(10.5);
        assert_eq!(first, 8);
        let expected = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-7), "{weights:?}");
        for reduction in [0.5, 1.0, 1.3, 7.9] {
            let taps = Taps::of(reduction);
            for place in [0.0, 3.16, 100.999, -2.2] {
                let (first, weights) = taps.at(place);
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
                let half = (taps.count / 2) as f64;
                assert!((first as f64 + half - place).abs() <= 1.0);
            }
        }
    }
}
