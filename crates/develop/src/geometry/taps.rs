//! Weights of the pixels from which a place between them is interpolated.

/// Places between two pixels that are told apart.
pub(super) const PHASES: usize = 256;
/// Zeros of the kernel on each side.
const LOBES: f64 = 3.0;
/// Weights come in groups of so many: as many as one place takes where nothing is made smaller.
pub(super) const GROUP: usize = 6;

/// Most that a picture is sharpened by which is made smaller: a tenth more contrast of details four pixels wide, a sixth of those
/// that are smaller.
const CRISP: f64 = 0.2;
/// Reduction from which on it gets all of that; the more it is made smaller, the less is left of the sharpness of its pixels.
const CRISP_FROM: f64 = 2.0;
/// Below this reduction the kernel stays as narrow as it is: what a picture then has beyond its own half of the sampling rate is
/// the last twenty-fifth of the frame's, and cameras leave little there. Corrected lenses zoom by as much, and a wider kernel costs
/// twice as much.
const NO_REDUCTION: f64 = 1.04;
/// Blur that sharpening takes off, pixels of the smaller picture.
const SOFT: f64 = 0.7;

/// Lanczos's kernel (Duchon, Journal of Applied Meteorology 18, 1979) along one axis, widened where a picture is made
/// smaller, so that no detail is left that the smaller picture cannot show, and sharpened a little there.
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
    /// For a picture in which a pixel stands for so many of those that it is made of, along each axis; `sharpening` is 1 for what
    /// suits pictures, 0 for none.
    pub(super) fn of(reduction: f64, sharpening: f64) -> Self {
        let reduction = if reduction < NO_REDUCTION { 1.0 } else { reduction };
        let crisp = CRISP * sharpening * ((reduction - 1.0) / (CRISP_FROM - 1.0)).min(1.0);
        let half = (LOBES * reduction).ceil() as usize;
        let (count, padded) = (2 * half, (2 * half).next_multiple_of(GROUP));
        let mut weights = vec![0f32; PHASES * padded];
        for (phase, weights) in weights.chunks_exact_mut(padded).enumerate() {
            let between = phase as f64 / PHASES as f64;
            let at = |i: usize| {
                let x = (i as f64 - (half as f64 - 1.0) - between) / reduction;
                (1.0 + crisp) * kernel(x) - crisp * soft(x)
            };
            let sum: f64 = (0..count).map(at).sum();
            for (i, weight) in weights[..count].iter_mut().enumerate() {
                *weight = (at(i) / sum) as f32;
            }
        }
        Self { count, padded, weights }
    }

    /// Pixels on each side of a place that it is made of, or that are read with them.
    pub(super) fn reach(&self) -> usize {
        self.count / 2 + self.padded - self.count + 1
    }

    /// The first pixel that makes a place (the middle of pixel i is i + 0.5), and the weights from there on.
    #[inline(always)]
    pub(super) fn at(&self, place: f64) -> (isize, &[f32]) {
        let (first, phase) = self.first(place);
        (first, &self.weights[phase * self.padded..][..self.padded])
    }

    /// As [`Self::at`], where nothing is made smaller.
    #[inline(always)]
    pub(super) fn few(&self, place: f64) -> Option<(isize, &[f32; GROUP])> {
        let (first, phase) = self.first(place);
        self.plain().get(phase).map(|weights| (first, weights))
    }

    /// Whether nothing is made smaller: a place is then made of one group.
    pub(super) fn is_plain(&self) -> bool {
        self.padded == GROUP
    }

    /// The weights of each phase, where nothing is made smaller.
    pub(super) fn plain(&self) -> &[[f32; GROUP]] {
        if self.is_plain() { self.weights.as_chunks::<GROUP>().0 } else { &[] }
    }

    /// A place in parts of a pixel from the middle of the first one, to the nearest; places are within a few pictures of the frame.
    #[inline(always)]
    pub(super) fn parts(place: f64) -> i32 {
        // Floor by adding a number beyond which there are no fractions: libraries' floor is a call on old processors, and
        // conversions that saturate are slow.
        const WHOLE: f64 = 6_755_399_441_055_744.0;
        let v = (place - 0.5) * PHASES as f64 + 0.5;
        let nearest = v + WHOLE;
        (nearest.to_bits() as i32).wrapping_sub(i32::from(nearest - WHOLE > v))
    }

    #[inline(always)]
    fn first(&self, place: f64) -> (isize, usize) {
        let parts = Self::parts(place);
        let first = (parts >> PHASES.trailing_zeros()) as isize + 1 - (self.count / 2) as isize;
        (first, (parts & (PHASES as i32 - 1)) as usize)
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

/// A bell of [`SOFT`] pixels, within three pixels.
fn soft(x: f64) -> f64 {
    let bell = (-0.5 * (x / SOFT).powi(2)).exp() / (SOFT * std::f64::consts::TAU.sqrt());
    if x.abs() < LOBES { bell } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_counted_from_below() {
        for (place, parts) in [(0.5, 0), (0.0, -128), (7.25, 1728), (-3.0, -896), (30_000.123, 7_679_903)] {
            assert_eq!(Taps::parts(place), parts, "{place}");
        }
        for i in -40_000..40_000 {
            let place = f64::from(i) * 0.013;
            let v = (place - 0.5) * PHASES as f64 + 0.5;
            assert_eq!(f64::from(Taps::parts(place)), v.floor(), "{place}");
        }
    }

    #[test]
    fn a_pixel_is_itself_and_even_light_stays() {
        let taps = Taps::of(1.0, 1.0);
        let (first, weights) = taps.at(10.5);
        assert_eq!(first, 8);
        let expected = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-7), "{weights:?}");
        for reduction in [0.5, 1.0, 1.3, 7.9] {
            let taps = Taps::of(reduction, 1.0);
            for place in [0.0, 3.16, 100.999, -2.2] {
                let (first, weights) = taps.at(place);
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
                let half = (taps.count / 2) as f64;
                assert!((first as f64 + half - place).abs() <= 1.0);
            }
        }
    }

    #[test]
    fn sharpening_gives_contrast_to_what_the_smaller_picture_shows_and_none_to_what_it_cannot() {
        // What is left of waves of so many periods a pixel of the smaller picture.
        let left = |taps: &Taps, periods: f64, reduction: f64| {
            let (first, weights) = taps.at(500.5);
            let wave = |i: usize| {
                let place = (first + i as isize) as f64 + 0.5 - 500.5;
                (std::f64::consts::TAU * periods * place / reduction).cos()
            };
            weights.iter().enumerate().map(|(i, w)| f64::from(*w) * wave(i)).sum::<f64>()
        };
        for reduction in [2.0, 3.7] {
            let (plain, crisp) = (Taps::of(reduction, 0.0), Taps::of(reduction, 1.0));
            for (periods, least, most) in [(0.05, 1.0, 1.02), (0.25, 1.06, 1.12), (0.4, 1.08, 1.2)] {
                let gain = left(&crisp, periods, reduction) / left(&plain, periods, reduction);
                assert!((least..most).contains(&gain), "{reduction} {periods}: {gain}");
            }
            for periods in [0.75, 0.9] {
                assert!(left(&crisp, periods, reduction).abs() < 0.03, "{reduction} {periods}");
            }
        }
    }
}
