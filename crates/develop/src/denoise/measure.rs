//! How strong the noise of a capture is, as the picture itself shows it: photon transfer in its flattest places.
//!
//! In small windows the variance of each of the four planes of the mosaic is measured by a mask that sees neither shading nor
//! straight edges (J. Immerkaer, "Fast noise variance estimation", Computer Vision and Image Understanding 64(2), 1996).
//! Windows are sorted by their light and parted into groups. In a group a plane is judged where the three others are
//! flattest: noise of different planes does not depend on each other, so the choice does not make it look smaller. Texture
//! only adds to noise; the line through the groups is fitted from below.
//!
//! Where few windows are flat, or grain and texture are everywhere, that is still too much, and to take too much costs detail,
//! while to take half costs nearly nothing. So there are two estimates: the likely one, and a careful one from the very
//! flattest windows and lowest groups of all channels. The more of the picture shows no more than the likely noise, the more
//! that one is trusted.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Layout, Rect};
use rayon::prelude::*;

use super::any::Array;
use super::block;
use super::model::{Line, NoiseModel};
use crate::light::{LinearLight, layout_from};

/// Side of a window, pixels.
const WINDOW: usize = 16;
/// Side of its part of a plane.
const SIDE: usize = WINDOW / 2;
/// Most windows that are looked at.
const MOST_WINDOWS: usize = 16_000;
/// Most groups of windows, and fewest windows of one.
const MOST_GROUPS: usize = 24;
const FEWEST_WINDOWS: usize = 20;
/// Samples from this share of the clipping level on have less noise than others.
const NEARLY_CLIPPED: f32 = 0.9;
/// A window whose variance is no more than so many times the expected one shows only noise.
const ONLY_NOISE: f32 = 1.25;
/// Shares of such windows up to which the careful estimate holds, and from which on the likely one does.
const TRUST: (f64, f64) = (0.4, 0.7);

/// Below the first of them the careful estimate is lowered with the share, to this part at most.
const LEAST: f64 = 0.35;

/// A way to estimate.
#[derive(Clone, Copy)]
struct Way {
    /// One window in so many of a group is taken for flat.
    flattest: usize,
    /// Loss of a group above the line against that of one below it: texture adds to noise, nothing takes from it.
    above: f64,
}

const LIKELY: Way = Way { flattest: 6, above: 0.35 };
const CAREFUL: Way = Way { flattest: 20, above: 0.1 };

/// What a window shows of one plane.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    light: f32,
    variance: f32,
}

/// The noise of red, green and blue samples; `None` where too little of the picture tells it. `limits` is the light at which
/// channels clip.
pub(crate) fn measured(capture: &Capture, light: &LinearLight, limits: [f32; 3]) -> Option<Measured> {
    let area = capture.active_area;
    let Layout::Cfa(cfa) = layout_from(capture.counts.layout(), area.x as isize, area.y as isize) else {
        return None;
    };
    if area.width < WINDOW || area.height < WINDOW {
        return None;
    }
    let array = Array::of(&cfa);
    // Planes of an array other than Bayer's: red, the greens of even and of odd rows, blue.
    let channels = match &array {
        Some(_) => [0, 1, 1, 2],
        None if cfa.is_bayer() => block(&cfa),
        None => return None,
    };
    let rows = area.height / WINDOW;
    let step = (rows * (area.width / WINDOW)).div_ceil(MOST_WINDOWS).max(1);
    let rows: Vec<usize> = (0..rows).step_by(step).collect();
    let limits = channels.map(|c| NEARLY_CLIPPED * limits[c]);
    let strip = |row: &usize| match &array {
        Some(array) => strip_of_any(capture, light, array, row * WINDOW, limits),
        None => strip(capture, light, area, row * WINDOW, limits),
    };
    let windows: Vec<[Seen; 4]> = rows.par_iter().flat_map_iter(strip).collect();
    if windows.len() < FEWEST_WINDOWS {
        return None;
    }
    let of_plane: Vec<[Vec<Group>; 2]> =
        (0..4usize).into_par_iter().map(|p| groups(&windows, p, [LIKELY, CAREFUL])).collect();
    let line = |channel: usize| {
        let planes = (0..4).filter(|p| channels[*p] == channel);
        line_through(&planes.flat_map(|p| of_plane[p][0].iter().copied()).collect::<Vec<_>>(), LIKELY)
    };
    let likely = [line(0)?, line(1)?, line(2)?];
    let all: Vec<Group> = of_plane.iter().flat_map(|groups| groups[1].iter().copied()).collect();
    let careful = line_through(&all, CAREFUL)?;
    let only_noise = |window: &&[Seen; 4]| {
        let ratio =
            |p: usize| window[p].variance / likely[channels[p]].at(window[p].light).max(f32::MIN_POSITIVE);
        (0..4).map(ratio).sum::<f32>() <= 4.0 * ONLY_NOISE
    };
    let share = windows.iter().filter(only_noise).count() as f64 / windows.len() as f64;
    let trust = ((share - TRUST.0) / (TRUST.1 - TRUST.0)).clamp(0.0, 1.0) as f32;
    let caution = (share / TRUST.0).clamp(LEAST, 1.0) as f32;
    let mixed = likely.map(|line| {
        let mix = |likely: f32, careful: f32| careful * caution + trust * (likely - careful * caution);
        Line { slope: mix(line.slope, careful.slope), floor: mix(line.floor, careful.floor) }
    });
    let mean = |channel: usize| {
        let planes = (0..4).filter(|p| channels[*p] == channel);
        let light: f64 =
            planes.clone().map(|p| windows.iter().map(|w| f64::from(w[p].light)).sum::<f64>()).sum();
        (light / (planes.count() * windows.len()).max(1) as f64) as f32
    };
    Some(Measured {
        model: NoiseModel { channels: mixed },
        mean: [mean(0), mean(1), mean(2)],
        light: windows.iter().map(|window| window.map(|seen| seen.light)).collect(),
    })
}

/// What the picture tells of its noise.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Measured {
    pub(crate) model: NoiseModel,
    /// Mean light of each channel, where it is not clipped.
    pub(crate) mean: [f32; 3],
    /// Mean light of the four places of a Bayer block in each window, row by row from the active area's corner on.
    pub(crate) light: Vec<[f32; 4]>,
}

/// The windows of one row of them, without those in which something clips.
fn strip(capture: &Capture, light: &LinearLight, area: Rect, top: usize, limits: [f32; 4]) -> Vec<[Seen; 4]> {
    let columns = area.width / WINDOW;
    let width = columns * SIDE;
    let mut row = vec![0f32; 2 * width];
    let mut planes = [0; 4].map(|_| vec![0f32; width * SIDE]);
    for y in 0..WINDOW {
        light.levelled(&capture.counts, area.x, area.y + top + y, &mut row);
        let [even, odd] = match &mut planes {
            [a, b, _, _] if y % 2 == 0 => [a, b],
            [_, _, c, d] => [c, d],
        };
        let place = y / 2 * width..(y / 2 + 1) * width;
        let pairs = row.chunks_exact(2);
        for ((even, odd), pair) in even[place.clone()].iter_mut().zip(&mut odd[place]).zip(pairs) {
            *even = pair[0];
            *odd = pair[1];
        }
    }
    // Sums over columns of windows.
    let mut sums = [0; 4].map(|_| [0; 3].map(|_| vec![0f32; width]));
    let mut down = vec![0f32; width];
    vectorised(
        #[inline(always)]
        || {
            for ((plane, [sum, square, most]), limit) in planes.iter().zip(&mut sums).zip(limits) {
                for (y, row) in plane.chunks_exact(width).enumerate() {
                    for ((&v, sum), most) in row.iter().zip(sum.iter_mut()).zip(most.iter_mut()) {
                        *sum += v;
                        *most = if v >= limit { 1.0 } else { *most };
                    }
                    if y == 0 || y + 1 == SIDE {
                        continue;
                    }
                    let (above, below) =
                        (&plane[(y - 1) * width..][..width], &plane[(y + 1) * width..][..width]);
                    for i in 0..width {
                        down[i] = above[i] - 2.0 * row[i] + below[i];
                    }
                    for (i, square) in square[1..width - 1].iter_mut().enumerate() {
                        let mask = down[i] - 2.0 * down[i + 1] + down[i + 2];
                        *square += mask * mask;
                    }
                }
            }
        },
    );
    let window = |i: usize| {
        let all = i * SIDE..(i + 1) * SIDE;
        let inner = i * SIDE + 1..(i + 1) * SIDE - 1;
        let clips = sums.iter().any(|[_, _, most]| most[all.clone()].iter().any(|v| *v > 0.0));
        let seen = sums.each_ref().map(|[sum, square, _]| Seen {
            light: sum[all.clone()].iter().sum::<f32>() / (SIDE * SIDE) as f32,
            // The mask has (1 + 4 + 1)^2 times the variance of a sample.
            variance: square[inner.clone()].iter().sum::<f32>() / (36 * (SIDE - 2) * (SIDE - 2)) as f32,
        });
        (!clips).then_some(seen)
    };
    (0..columns).filter_map(window).collect()
}

/// The same for arrays other than Bayer's, from departures of samples from the mean of their colour around them.
fn strip_of_any(
    capture: &Capture,
    light: &LinearLight,
    array: &Array,
    top: usize,
    limits: [f32; 4],
) -> Vec<[Seen; 4]> {
    let area = capture.active_area;
    let width = area.width;
    let mut samples = vec![0f32; width * WINDOW];
    for (y, row) in samples.chunks_exact_mut(width).enumerate() {
        light.levelled(&capture.counts, area.x, area.y + top + y, row);
    }
    let mut departures = vec![0f32; samples.len()];
    array.departures(&samples, width, (0, top as isize), &mut departures);
    let window = |i: usize| {
        let mut seen = [Seen::default(); 4];
        let (mut counts, mut inner, mut clips) = ([0f32; 4], [0f32; 4], false);
        for y in 0..WINDOW {
            for x in i * WINDOW..(i + 1) * WINDOW {
                let phase = (top + y) % array.period.1 * array.period.0 + x % array.period.0;
                let plane = match array.places[phase].channel {
                    0 => 0,
                    1 => 1 + y % 2,
                    _ => 3,
                };
                let at = y * width + x;
                seen[plane].light += samples[at];
                counts[plane] += 1.0;
                clips |= samples[at] >= limits[plane];
                // Three rows and columns away from the edges of the strip departures are known.
                if (3..WINDOW - 3).contains(&y) && (3..width - 3).contains(&x) {
                    seen[plane].variance += departures[at] * departures[at];
                    inner[plane] += 1.0;
                }
            }
        }
        for (seen, (count, inner)) in seen.iter_mut().zip(counts.into_iter().zip(inner)) {
            seen.light /= count.max(1.0);
            seen.variance /= inner.max(1.0);
        }
        (!clips).then_some(seen)
    };
    (0..width / WINDOW).filter_map(window).collect()
}

/// Flat windows of similar light.
#[derive(Debug, Clone, Copy)]
struct Group {
    light: f64,
    variance: f64,
}

/// Groups of windows by the light of a plane, each in two ways.
fn groups(windows: &[[Seen; 4]], plane: usize, ways: [Way; 2]) -> [Vec<Group>; 2] {
    let mut sorted: Vec<&[Seen; 4]> = windows.iter().collect();
    sorted.sort_unstable_by(|a, b| a[plane].light.total_cmp(&b[plane].light));
    let size = sorted.len().div_ceil(MOST_GROUPS).max(FEWEST_WINDOWS);
    let others = |w: &[Seen; 4]| (0..4).filter(|p| *p != plane).map(|p| w[p].variance).sum::<f32>();
    let group = |windows: &mut [&[Seen; 4]], way: Way| {
        let flattest = (windows.len() / way.flattest).max(1);
        windows.select_nth_unstable_by(flattest - 1, |a, b| others(a).total_cmp(&others(b)));
        // Sums must not depend on the order in which the flattest were found.
        let chosen = &mut windows[..flattest];
        chosen.sort_unstable_by(|a, b| a[plane].variance.total_cmp(&b[plane].variance));
        let mean = |value: fn(&Seen) -> f32| {
            chosen.iter().map(|w| f64::from(value(&w[plane]))).sum::<f64>() / flattest as f64
        };
        Group { light: mean(|s| s.light), variance: mean(|s| s.variance) }
    };
    ways.map(|way| sorted.chunks_mut(size).filter(|w| 2 * w.len() >= size).map(|w| group(w, way)).collect())
}

/// The line under the groups: of all through two of them, or through one and without floor or slope, the one that loses
/// least, in logarithms of the variance.
fn line_through(groups: &[Group], Way { above, .. }: Way) -> Option<Line> {
    let loss = |slope: f64, floor: f64| {
        let of = |g: &Group| {
            let expected = (slope * g.light.max(0.0) + floor).max(f64::MIN_POSITIVE);
            let miss = (g.variance.max(f64::MIN_POSITIVE) / expected).ln();
            if miss > 0.0 { above * miss } else { (above - 1.0) * miss }
        };
        groups.iter().map(of).sum::<f64>()
    };
    let alone = groups.iter().flat_map(|g| [(g.variance / g.light, 0.0), (0.0, g.variance)]);
    let pairs = groups.iter().enumerate().flat_map(|(i, g)| groups[..i].iter().map(move |h| (g, h)));
    let through = pairs.map(|(g, h)| {
        let slope = (g.variance - h.variance) / (g.light - h.light);
        (slope, g.variance - slope * g.light.max(0.0))
    });
    let possible = alone
        .chain(through)
        .filter(|(slope, floor)| slope.is_finite() && floor.is_finite() && *slope >= 0.0 && *floor >= 0.0);
    let best = possible.map(|line| (loss(line.0, line.1), line)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, (slope, floor))| Line { slope: slope as f32, floor: floor as f32 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_above_the_line_does_not_lift_it() {
        let group = |i: usize| {
            let light = (i as f64 + 0.5) / 40.0;
            let texture = if i.is_multiple_of(3) { 3.0 } else { 1.0 };
            Group { light, variance: texture * (1e-4 * light + 1e-6) }
        };
        let line = line_through(&(0..40).map(group).collect::<Vec<_>>(), LIKELY).unwrap();
        assert!((line.slope / 1e-4 - 1.0).abs() < 0.02 && (line.floor / 1e-6 - 1.0).abs() < 0.1, "{line:?}");
        assert_eq!(line_through(&[], LIKELY), None);
    }
}
