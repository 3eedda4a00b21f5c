//! What a camera made of a chart's patches, from the samples of the sensor as they are: nothing is interpolated, so no
//! patch mixes with its neighbours.

use darkroot_colour::statistics::median;
use darkroot_photo::{Layout, Mosaic};
use rayon::prelude::*;

use crate::Quad;

/// Light above this share of a channel's saturation counts as clipped.
pub(crate) const CLIPPED: f32 = 0.98;
/// Samples farther from the median than this many standard deviations are dust, glints or dirt.
const OUTLIER: f64 = 4.0;
/// Standard deviation of normal noise over its median absolute deviation.
const MAD_TO_SIGMA: f64 = 1.4826;
/// Fewest samples of a channel that make a measurement.
const FEWEST: usize = 9;

/// One patch.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// Mean of red, green and blue, 1 = the white level.
    pub mean: [f64; 3],
    /// Standard deviation of the samples.
    pub deviation: [f64; 3],
    /// Samples of each channel that took part.
    pub count: [usize; 3],
    /// Share of the samples that are clipped.
    pub clipped: f64,
    /// Share of the samples that were left out as outliers.
    pub outliers: f64,
    /// Relative change of green from one edge of the window to the other, the larger of both directions.
    pub slope: f64,
}

impl Measurement {
    /// Standard error of the mean.
    pub fn uncertainty(&self) -> [f64; 3] {
        [0, 1, 2].map(|c| self.deviation[c] / (self.count[c].max(1) as f64).sqrt())
    }

    /// Whether there are enough samples of every channel.
    pub fn is_complete(&self) -> bool {
        self.count.iter().all(|n| *n >= FEWEST)
    }
}

/// Measures windows (in pixels of the frame, integers are pixel centres) of a frame of linear light. Monochrome
/// frames give the same value three times.
pub fn measure(light: &Mosaic<f32>, saturation: [f32; 3], windows: &[Quad]) -> Vec<Measurement> {
    windows.par_iter().map(|window| patch(light, saturation, window)).collect()
}

fn patch(light: &Mosaic<f32>, saturation: [f32; 3], window: &Quad) -> Measurement {
    let mut samples: [Vec<Sample>; 3] = Default::default();
    let (mut all, mut clipped) = (0usize, 0usize);
    for_each_inside(light, window, |x, y, channel, value| {
        all += 1;
        if value >= CLIPPED * saturation[channel] {
            clipped += 1;
        }
        samples[channel].push(Sample { x: x as f64, y: y as f64, value: f64::from(value) });
    });
    let robust = samples.each_ref().map(|s| Robust::of(s));
    let left_out: usize = (0..3).map(|c| samples[c].len() - robust[c].count).sum();
    let share = |n: usize| if all == 0 { 0.0 } else { n as f64 / all as f64 };
    Measurement {
        mean: robust.each_ref().map(|r| r.mean),
        deviation: robust.each_ref().map(|r| r.deviation),
        count: robust.each_ref().map(|r| r.count),
        clipped: share(clipped),
        outliers: share(left_out),
        slope: slope(&samples[1], &robust[1]),
    }
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    x: f64,
    y: f64,
    value: f64,
}

/// Mean and deviation without outliers.
struct Robust {
    mean: f64,
    deviation: f64,
    count: usize,
    low: f64,
    high: f64,
}

impl Robust {
    fn of(samples: &[Sample]) -> Self {
        let values: Vec<f64> = samples.iter().map(|s| s.value).filter(|v| v.is_finite()).collect();
        let middle = median(&mut values.clone()).unwrap_or(0.0);
        let mut distances: Vec<f64> = values.iter().map(|v| (v - middle).abs()).collect();
        let spread = MAD_TO_SIGMA * median(&mut distances).unwrap_or(0.0);
        // A patch without noise (simulated, or quantised) has no spread; then only its own value belongs to it.
        let reach = OUTLIER * spread.max(1e-6);
        let (low, high) = (middle - reach, middle + reach);
        let kept: Vec<f64> = values.into_iter().filter(|v| (low..=high).contains(v)).collect();
        let count = kept.len();
        let mean = kept.iter().sum::<f64>() / count.max(1) as f64;
        let variance =
            kept.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count.saturating_sub(1).max(1) as f64;
        Self { mean, deviation: variance.sqrt(), count, low, high }
    }
}

/// Relative change of the values across the window, from a plane fitted to them.
fn slope(samples: &[Sample], robust: &Robust) -> f64 {
    let kept: Vec<Sample> =
        samples.iter().filter(|s| (robust.low..=robust.high).contains(&s.value)).copied().collect();
    if kept.len() < FEWEST || robust.mean <= 0.0 {
        return 0.0;
    }
    let count = kept.len() as f64;
    let centre = |of: fn(&Sample) -> f64| kept.iter().map(of).sum::<f64>() / count;
    let (x, y) = (centre(|s| s.x), centre(|s| s.y));
    let along = |place: &dyn Fn(&Sample) -> f64| {
        let squares: f64 = kept.iter().map(|s| place(s).powi(2)).sum();
        let product: f64 = kept.iter().map(|s| place(s) * (s.value - robust.mean)).sum();
        let reach = kept.iter().map(|s| place(s).abs()).fold(0.0, f64::max);
        if squares > 0.0 { 2.0 * reach * product / squares / robust.mean } else { 0.0 }
    };
    along(&|s: &Sample| s.x - x).abs().max(along(&|s: &Sample| s.y - y).abs())
}

/// Calls `take` with column, row, channel and value of every sample whose pixel centre lies inside of a convex
/// window.
pub(crate) fn for_each_inside(
    light: &Mosaic<f32>,
    window: &Quad,
    mut take: impl FnMut(usize, usize, usize, f32),
) {
    let (width, height) = (light.size.width, light.size.height);
    let range = |axis: usize, length: usize| {
        let values = window.iter().map(|p| p[axis]);
        let low = values.clone().fold(f64::INFINITY, f64::min).ceil().max(0.0);
        let high = values.fold(f64::NEG_INFINITY, f64::max).floor().min(length as f64 - 1.0);
        if low <= high { low as usize..high as usize + 1 } else { 0..0 }
    };
    let planes = light.layout.planes();
    for y in range(1, height) {
        for x in range(0, width) {
            if !inside(window, x as f64, y as f64) {
                continue;
            }
            let first = (y * width + x) * planes;
            match &light.layout {
                Layout::Cfa(cfa) => {
                    if let Some(channel) = cfa.at(x, y).plane() {
                        take(x, y, channel, light.samples[first]);
                    }
                }
                Layout::Rgb => (0..3).for_each(|c| take(x, y, c, light.samples[first + c])),
                Layout::Monochrome => (0..3).for_each(|c| take(x, y, c, light.samples[first])),
            }
        }
    }
}

/// Whether a point lies inside of a convex quadrilateral, whichever way round its corners go.
pub(crate) fn inside(quad: &Quad, x: f64, y: f64) -> bool {
    let side = |i: usize| {
        let ([ax, ay], [bx, by]) = (quad[i], quad[(i + 1) % 4]);
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    };
    let sides = [side(0), side(1), side(2), side(3)];
    sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::{Cfa, Size};

    fn frame(value: impl Fn(usize, usize, usize) -> f32) -> Mosaic<f32> {
        let cfa = Cfa::parse("RGGB").unwrap();
        let size = Size { width: 40, height: 30 };
        let samples =
            (0..1200).map(|i| value(i % 40, i / 40, cfa.at(i % 40, i / 40).plane().unwrap())).collect();
        Mosaic { size, layout: Layout::Cfa(cfa), samples }
    }

    const WINDOW: Quad = [[5.0, 5.0], [24.0, 5.0], [24.0, 24.0], [5.0, 24.0]];

    fn measured(light: &Mosaic<f32>) -> Measurement {
        measure(light, [1.0; 3], &[WINDOW]).remove(0)
    }

    #[test]
    fn channels_do_not_mix() {
        let m = measured(&frame(|_, _, c| [0.1, 0.2, 0.3][c]));
        for (found, expected) in m.mean.into_iter().zip([0.1, 0.2, 0.3]) {
            assert!((found - expected).abs() < 1e-7);
        }
        assert_eq!(m.count, [100, 200, 100]);
        assert!(m.is_complete() && m.slope < 1e-9);
    }

    #[test]
    fn dust_and_glints_are_left_out() {
        let noise = |x: usize, y: usize| ((x * 7 + y * 13) % 11) as f32 * 1e-3;
        let m = measured(&frame(|x, y, _| if x < 7 && y < 8 { 0.9 } else { 0.5 + noise(x, y) }));
        assert!((m.mean[1] - 0.505).abs() < 1e-3, "{m:?}");
        assert!(m.outliers > 0.005 && m.clipped < 1e-9);
    }

    #[test]
    fn clipped_samples_are_counted() {
        let m = measured(&frame(|_, _, c| if c == 1 { 1.0 } else { 0.5 }));
        assert!((m.clipped - 0.5).abs() < 1e-9);
    }

    #[test]
    fn a_gradient_is_a_slope() {
        let m = measured(&frame(|x, _, _| 0.4 + 0.002 * x as f32));
        // From column 5 to column 24 by 0.038, of about 0.43.
        assert!((m.slope - 0.038 / 0.429).abs() < 0.01, "{}", m.slope);
    }

    #[test]
    fn windows_beyond_the_frame_are_empty() {
        let m =
            measure(&frame(|_, _, _| 0.5), [1.0; 3], &[[[50.0, 0.0], [60.0, 0.0], [60.0, 9.0], [50.0, 9.0]]]);
        assert!(!m[0].is_complete() && m[0].mean.iter().all(|v| v.is_finite()));
    }
}
