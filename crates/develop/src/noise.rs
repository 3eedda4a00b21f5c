//! How strong the noise of a capture is, by brightness: measured in the flattest places of the picture itself.
//!
//! The variance is that of the square roots of balanced samples, the domain of demosaicing. Shot noise is even
//! there (Anscombe, Biometrika 35, 1948); read noise lets it rise in the shadows.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Cfa, Layout};
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

    /// So many times that variance.
    pub(crate) fn times(mut self, factor: f32) -> Self {
        for variance in self.variances.iter_mut().flatten() {
            *variance *= factor;
        }
        self
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

/// Light between which windows tell of photons, not of reading or of clipping; shares of the white level.
const OF_PHOTONS: (f32, f32) = (0.04, 0.45);

/// Variance of the square roots of samples, not balanced, that counting photons makes; `None` where too few windows tell.
pub(crate) fn of_photons(windows: &[Window]) -> Option<[f32; 3]> {
    // Of a Bayer window a quarter are red, a half green, a quarter blue.
    let samples = [0.25, 0.5, 0.25].map(|share| share * (WINDOW * WINDOW) as f32);
    let of_channel = |c: usize| {
        let is_told = |w: &&Window| (OF_PHOTONS.0..OF_PHOTONS.1).contains(&(w.light[c] / samples[c]));
        let mut found: Vec<f32> =
            windows.iter().filter(is_told).map(|w| w.bend_x[c].min(w.bend_y[c])).collect();
        if found.len() < FEWEST_WINDOWS {
            return None;
        }
        // The flattest fifth: the rest has texture.
        let rank = found.len() / 5;
        Some(*found.select_nth_unstable_by(rank, f32::total_cmp).1)
    };
    // Where one channel has no such light, it has the gain of the others.
    let found = [0, 1, 2].map(of_channel);
    let known = found.iter().flatten().copied().fold(f32::MAX, f32::min);
    found.iter().any(Option::is_some).then(|| found.map(|v| v.unwrap_or(known)))
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
    let of_row = |&row: &usize| strip(capture, linear, cfa, area.y + row * WINDOW);
    rows.par_iter().flat_map_iter(of_row).collect()
}

/// Rows and columns of a window that have neighbours of their colour on both sides inside it.
const MIDDLE: std::ops::Range<usize> = 2..WINDOW - 2;

/// The windows of one row of them, which begins at row `top` of the frame.
fn strip(capture: &Capture, linear: &LinearLight, cfa: &Cfa, top: usize) -> Vec<Window> {
    let area = capture.active_area;
    let width = area.width / WINDOW * WINDOW;
    let mut light = vec![0f32; width * WINDOW];
    let mut roots = vec![0f32; width * WINDOW];
    for (i, light) in light.chunks_exact_mut(width).enumerate() {
        linear.row(&capture.counts, area.x, top + i, light);
    }
    vectorised(
        #[inline(always)]
        || {
            for (root, &v) in roots.iter_mut().zip(&light) {
                *root = signed_sqrt(v);
            }
        },
    );
    let mut tallies = vec![Tally::default(); width / WINDOW];
    let mut bends = vec![(0f32, 0f32); width];
    for y in 0..WINDOW {
        let row = |y: usize| y * width..(y + 1) * width;
        let (light, here) = (&light[row(y)], &roots[row(y)]);
        let is_middle = MIDDLE.contains(&y);
        if is_middle {
            let (above, below) = (&roots[row(y - 2)], &roots[row(y + 2)]);
            second_differences(here, above, below, &mut bends);
        }
        let colours = [0, 1].map(|x| cfa.at(area.x + x, top + y).plane().unwrap_or(1));
        for (i, tally) in tallies.iter_mut().enumerate() {
            let window = i * WINDOW..(i + 1) * WINDOW;
            tally.add(colours, &light[window.clone()], &here[window.clone()]);
            if is_middle {
                tally.add_bends(colours, &bends[window]);
            }
        }
    }
    tallies.iter().map(Tally::window).collect()
}

/// Squares of the second differences between samples of one colour, along the row and along the columns: shading does
/// not show in them.
fn second_differences(here: &[f32], above: &[f32], below: &[f32], out: &mut [(f32, f32)]) {
    let inner = 2..here.len() - 2;
    let (above, below) = (&above[inner.clone()], &below[inner.clone()]);
    for (i, ((out, above), below)) in out[inner].iter_mut().zip(above).zip(below).enumerate() {
        let own = 2.0 * here[i + 2];
        let (along, down) = (here[i] - own + here[i + 4], above - own + below);
        *out = (along * along, down * down);
    }
}

/// Sums over a window, by channel.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    light: [f32; 3],
    roots: [f32; 3],
    counts: [f32; 3],
    bend_x: [f32; 3],
    bend_y: [f32; 3],
    bends: [f32; 3],
}

impl Tally {
    /// Adds a row, whose columns have these two colours in turn.
    fn add(&mut self, colours: [usize; 2], light: &[f32], roots: &[f32]) {
        for (parity, c) in colours.into_iter().enumerate() {
            let every_second = |values: &[f32]| values[parity..].iter().step_by(2).sum::<f32>();
            self.light[c] += every_second(light);
            self.roots[c] += every_second(roots);
            self.counts[c] += (WINDOW / 2) as f32;
        }
    }

    /// Adds the squares of second differences of a row.
    fn add_bends(&mut self, colours: [usize; 2], bends: &[(f32, f32)]) {
        for (x, bend) in bends.iter().enumerate().take(MIDDLE.end).skip(MIDDLE.start) {
            let c = colours[x % 2];
            self.bend_x[c] += bend.0;
            self.bend_y[c] += bend.1;
            // A second difference has 1 + 4 + 1 times the variance of a sample.
            self.bends[c] += 6.0;
        }
    }

    fn window(&self) -> Window {
        let spread = |c: usize| {
            let n = self.counts[c];
            (self.light[c] / n - signed_square(self.roots[c] / n)) * (n / (n - 1.0))
        };
        Window {
            light: self.light,
            spread: [spread(0), spread(1), spread(2)],
            bend_x: [0, 1, 2].map(|c| self.bend_x[c] / self.bends[c]),
            bend_y: [0, 1, 2].map(|c| self.bend_y[c] / self.bends[c]),
        }
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
