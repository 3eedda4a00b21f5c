//! How strong the noise of a capture is, by brightness: measured in the flattest places of the picture itself.
//!
//! The variance is that of the square roots of balanced samples, the domain of demosaicing. Shot noise is even
//! there (Anscombe, Biometrika 35, 1948); read noise lets it rise in the shadows.

use darkroot_photo::{Capture, Cfa, Filter, Layout};
use rayon::prelude::*;

use crate::demosaic::{signed_sqrt, signed_square};
use crate::light::LinearLight;

/// Half octaves of brightness from 2^-16 to 2^8 of the picture's mean. Relative to the mean, so that the same picture
/// with more light has the same noise for its brightness.
const BINS: usize = 48;
const FIRST_EXPONENT: u32 = 127 - 16;

/// Side of the windows in which the variance is measured, pixels.
const WINDOW: usize = 10;
/// Most windows that are looked at.
const MOST_WINDOWS: usize = 40_000;
/// Fewest windows that tell something of their brightness.
const FEWEST_WINDOWS: usize = 24;
/// Which windows of one brightness count as flat, by rank.
const FLAT_RANKS: (f64, f64) = (0.05, 0.20);
/// The flattest windows of pure noise show this share of its variance: the mean between those ranks of a chi-square
/// distribution of about 30 degrees of freedom: second differences of one window depend on each other.
const SELECTION: f32 = 0.62;

/// Variance of the square roots of balanced red, green and blue samples, by brightness.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    variances: [[f32; 3]; BINS],
    /// 1 / mean brightness of the picture.
    scale: f32,
}

impl Noise {
    /// No noise at all.
    pub const NONE: Self = Self { variances: [[0.0; 3]; BINS], scale: 1.0 };

    /// Variances at a brightness (mean of balanced samples, 1 = saturated).
    #[inline(always)]
    pub fn at(&self, brightness: f32) -> [f32; 3] {
        self.variances[bin(brightness * self.scale)]
    }

    /// The noise of a capture after balancing with these multipliers, from what its windows show; none where there are
    /// no windows.
    pub(crate) fn of(windows: &[Window], multipliers: [f32; 3]) -> Self {
        let balanced: Vec<Balanced> =
            windows.par_iter().with_min_len(4096).map(|w| w.balanced(multipliers)).collect();
        let mean =
            balanced.iter().map(|w| f64::from(w.brightness)).sum::<f64>() / balanced.len().max(1) as f64;
        if mean.is_nan() || mean <= 0.0 {
            return Self::NONE;
        }
        let scale = (1.0 / mean) as f32;
        let mut bins: Vec<Vec<(f32, &Window)>> = (0..BINS).map(|_| Vec::new()).collect();
        for (balanced, window) in balanced.iter().zip(windows) {
            bins[bin(balanced.brightness * scale)].push((balanced.roughness, window));
        }
        let known: Vec<Option<[f32; 3]>> =
            bins.par_iter_mut().map(|windows| flat(windows, multipliers)).collect();
        let nearest = |i: usize| {
            let by_distance = (0..BINS).filter(|&j| known[j].is_some()).min_by_key(|&j| j.abs_diff(i));
            by_distance.and_then(|j| known[j]).unwrap_or_default()
        };
        Self { variances: std::array::from_fn(nearest), scale }
    }
}

/// Half octave of a brightness: its exponent and the first bit of its mantissa.
#[inline(always)]
fn bin(brightness: f32) -> usize {
    let half_octave = brightness.max(0.0).to_bits() >> 22;
    (half_octave.saturating_sub(FIRST_EXPONENT << 1) as usize).min(BINS - 1)
}

/// Variances, balanced, in the flat ones among windows of one brightness, which come with their roughness. Near black
/// the spread of the roots overstates the bias, elsewhere shading and texture do: the least of the estimates counts.
fn flat(windows: &mut [(f32, &Window)], multipliers: [f32; 3]) -> Option<[f32; 3]> {
    if windows.len() < FEWEST_WINDOWS {
        return None;
    }
    let rank = |share: f64| (share * windows.len() as f64) as usize;
    let (first, end) = (rank(FLAT_RANKS.0), rank(FLAT_RANKS.1).max(rank(FLAT_RANKS.0) + 1));
    // The flattest of all up to the last rank, then those among them from the first rank on.
    let rougher = |a: &(f32, &Window), b: &(f32, &Window)| a.0.total_cmp(&b.0);
    windows.select_nth_unstable_by(end - 1, rougher);
    windows[..end].select_nth_unstable_by(first, rougher);
    let chosen = &windows[first..end];
    let mean = |estimate: fn(&Window) -> [f32; 3], c: usize| {
        multipliers[c] * chosen.iter().map(|(_, w)| estimate(w)[c]).sum::<f32>() / chosen.len() as f32
    };
    Some([0, 1, 2].map(|c| {
        let least = mean(|w| w.spread, c).min(mean(|w| w.bend_x, c)).min(mean(|w| w.bend_y, c));
        (least / SELECTION).max(0.0)
    }))
}

/// What one window of the picture shows, before balancing: which light it is in does not matter yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// Sum of the light of each channel.
    light: [f32; 3],
    /// Mean of the light less the square of the mean root.
    spread: [f32; 3],
    /// Variance of the roots from second differences along rows.
    bend_x: [f32; 3],
    /// The same along columns.
    bend_y: [f32; 3],
}

/// A window in balanced light.
struct Balanced {
    /// Mean of all samples.
    brightness: f32,
    roughness: f32,
}

impl Window {
    /// Light is multiplied by the multipliers, and so are variances of its square roots.
    fn balanced(&self, multipliers: [f32; 3]) -> Balanced {
        let sum = |v: [f32; 3]| v[0] * multipliers[0] + v[1] * multipliers[1] + v[2] * multipliers[2];
        Balanced {
            brightness: sum(self.light) / (WINDOW * WINDOW) as f32,
            roughness: sum(self.bend_x) + sum(self.bend_y),
        }
    }
}

/// Windows of a Bayer capture, spread over the whole picture; none for other sensors.
pub(crate) fn windows(capture: &Capture, linear: &LinearLight) -> Vec<Window> {
    let Layout::Cfa(cfa) = capture.counts.layout() else { return Vec::new() };
    let area = capture.active_area;
    if !cfa.is_bayer() || area.width < WINDOW || area.height < WINDOW {
        return Vec::new();
    }
    // Every so many rows of windows.
    let (columns, rows) = (area.width / WINDOW, area.height / WINDOW);
    let step = (columns * rows).div_ceil(MOST_WINDOWS).max(1);
    let rows: Vec<usize> = (0..rows).step_by(step).collect();
    rows.par_iter()
        .flat_map_iter(|row| {
            let top = area.y + row * WINDOW;
            let width = columns * WINDOW;
            let mut strip = vec![0f32; width * WINDOW];
            for (i, light) in strip.chunks_exact_mut(width).enumerate() {
                linear.row(&capture.counts, area.x, top + i, light);
            }
            let window = |i: usize| window(&strip, width, i * WINDOW, cfa, (area.x, top));
            (0..columns).map(window).collect::<Vec<_>>()
        })
        .collect()
}

/// Light and variances of the window that begins in column `left` of a strip.
fn window(strip: &[f32], width: usize, left: usize, cfa: &Cfa, (x0, y0): (usize, usize)) -> Window {
    let (mut light, mut roots, mut counts) = ([0f32; 3], [0f32; 3], [0f32; 3]);
    let (mut bend_x, mut bend_y, mut bends) = ([0f32; 3], [0f32; 3], [0f32; 3]);
    let root = |x: usize, y: usize| signed_sqrt(strip[y * width + left + x]);
    for y in 0..WINDOW {
        for x in 0..WINDOW {
            let v = strip[y * width + left + x];
            let c = match cfa.at(x0 + left + x, y0 + y) {
                Filter::Red => 0,
                Filter::Blue => 2,
                _ => 1,
            };
            light[c] += v;
            roots[c] += signed_sqrt(v);
            counts[c] += 1.0;
            // Second differences between samples of one colour: shading does not show in them.
            if (2..WINDOW - 2).contains(&x) && (2..WINDOW - 2).contains(&y) {
                bend_x[c] += (root(x - 2, y) - 2.0 * root(x, y) + root(x + 2, y)).powi(2);
                bend_y[c] += (root(x, y - 2) - 2.0 * root(x, y) + root(x, y + 2)).powi(2);
                bends[c] += 6.0;
            }
        }
    }
    let spread = |c: usize| {
        let n = counts[c];
        (light[c] / n - signed_square(roots[c] / n)) * (n / (n - 1.0))
    };
    Window {
        light,
        spread: [spread(0), spread(1), spread(2)],
        bend_x: [0, 1, 2].map(|c| bend_x[c] / bends[c]),
        bend_y: [0, 1, 2].map(|c| bend_y[c] / bends[c]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brightness_falls_into_half_octaves() {
        assert_eq!(bin(1.0) - bin(0.5), 2);
        assert_eq!(bin(0.75), bin(0.5) + 1);
        assert_eq!([bin(0.0), bin(-1.0), bin(1e-9)], [0; 3]);
        assert_eq!(bin(1e9), BINS - 1);
    }

    #[test]
    fn the_flattest_windows_tell_the_noise_and_texture_does_not() {
        let windows: Vec<Window> = (0..1000)
            .map(|i| {
                let variance = if i % 2 == 0 { 0.01 + i as f32 * 1e-3 } else { 1e-4 };
                let estimate = [variance; 3];
                Window { light: [5.0, 10.0, 5.0], spread: estimate, bend_x: estimate, bend_y: estimate }
            })
            .collect();
        let noise = Noise::of(&windows, [2.0, 1.0, 1.0]);
        let [red, green, _] = noise.at(0.2);
        assert!((green * SELECTION - 1e-4).abs() < 1e-6 && (red / green - 2.0).abs() < 1e-3);
        // Brightnesses that no window has take the nearest.
        assert_eq!(noise.at(0.001), noise.at(0.2));
        assert_eq!(Noise::of(&[], [1.0; 3]), Noise::NONE);
    }
}
