//! Colour beside highlights that are too bright for the sensor.
//!
//! Beside a step of several stops, demosaicing lets some of the bright side leak into the dark one, and not the same
//! of each channel: a tiny reflex gets a coloured rim, which rebuilt samples, being guessed, make worse. But the
//! colours that may be there are known: that of the dark samples around, that of the reflex itself, which is neutral,
//! and mixtures of the two. Red and blue beyond these are cut; green, which has most samples, only where it leaves
//! the range of those beside it.

use std::array::from_fn;

use darkroot_photo::{CameraSpace, Cfa, Layout, Mosaic, Rgb};

use crate::demosaic::{signed_sqrt, signed_square};
use crate::highlights::{CLIPPED, Treatment, reaches};
use crate::stage::{Stage, WhenSmaller};
use darkroot_colour::simd::vectorised;

/// Pixels around the result that are looked at.
pub const BORDER: usize = 5;

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "fringe", border: BORDER, when_smaller: WhenSmaller::Skipped };

/// How near a highlight is, by columns or rows away: beyond three, leaks fade.
const NEAR: [f32; BORDER + 1] = [1.0, 1.0, 1.0, 1.0, 0.7, 0.35];
/// Weights of dark samples, by columns and by rows away: a triangle.
const WEIGHTS: [f32; BORDER + 1] = [6.0, 5.0, 4.0, 3.0, 2.0, 1.0];
/// Samples below this share of the brightness at which the first channel clips are not of the highlight or its edge.
const DARK: f32 = 0.35;
/// A highlight leaves the same share of each channel's samples dark. Where the smallest share is less than `ALIKE`
/// times the largest, something coloured is bright, and from `UNLIKE` on nothing is cut.
const ALIKE: f32 = 0.75;
const UNLIKE: f32 = 0.5;
/// Added to the largest share: few samples tell little.
const FEW: f32 = 0.05;

/// Cuts the colours of a picture that was demosaiced from this mosaic, which has `border` more pixels, at least
/// [`BORDER`], on each side.
pub fn cut(mosaic: &Mosaic<f32>, border: usize, treatment: &Treatment, picture: &mut Rgb<CameraSpace>) {
    let (Treatment::Rebuild(rebuild), Layout::Cfa(cfa)) = (treatment, &mosaic.layout) else { return };
    let bright = rebuild.limits.iter().fold(f32::MAX, |a, &b| a.min(b)) * CLIPPED;
    if !reaches(&mosaic.samples, bright) {
        return;
    }
    let (size, width) = (picture.size(), mosaic.size.width);
    let kinds = kinds(mosaic, cfa, bright);
    let seen = spread(&kinds, width);
    let [red, green, blue] = picture.planes_mut();
    for y in 0..size.height {
        let places = (y + border) * width + border..(y + border) * width + border + size.width;
        for run in seen[places.clone()].chunks(RUN).enumerate().filter(|(_, run)| shows_everything(run)) {
            let first = run.0 * RUN;
            for (x, _) in (first..).zip(run.1).filter(|(_, seen)| *seen & EVERYTHING == EVERYTHING) {
                let centre = places.start + x;
                let Some((around, weight)) = around(mosaic, &kinds, centre) else { continue };
                let i = y * size.width + x;
                let (least, most) = greens(mosaic, &kinds, centre);
                green[i] += (green[i].clamp(least, most) - green[i]) * weight;
                let neutral = green[i].max(0.0);
                for (c, v) in [(0, &mut red[i]), (2, &mut blue[i])] {
                    let tinted = neutral * around[c] / around[1];
                    *v += (v.clamp(neutral.min(tinted), neutral.max(tinted)) - *v) * weight;
                }
            }
        }
    }
}

/// Pixels that are looked at together: only a few have everything around them.
const RUN: usize = 64;

/// Whether some pixel of a run has bright and dark samples of every channel around it.
fn shows_everything(seen: &[u8]) -> bool {
    seen.iter().fold(false, |found, seen| found | (seen & EVERYTHING == EVERYTHING))
}

/// Bright and dark samples of each channel.
const BRIGHT_KINDS: u8 = 0b00_0111;
const DARK_KINDS: u8 = 0b11_1000;
const EVERYTHING: u8 = BRIGHT_KINDS | DARK_KINDS;

/// The kind of each sample: bit c for a bright one of channel c, bit 3 + c for a dark one, c itself in the last two.
fn kinds(mosaic: &Mosaic<f32>, cfa: &Cfa, bright: f32) -> Vec<u8> {
    let width = mosaic.size.width;
    let mut kinds = vec![0u8; mosaic.samples.len()];
    // The channel of each sample of a row, for each row of the array.
    let channels = |y: usize| (0..width).map(|x| cfa.at(x, y).plane().unwrap_or(1) as u8).collect();
    let channels: Vec<Vec<u8>> = (0..cfa.height()).map(channels).collect();
    vectorised(
        #[inline(always)]
        || {
            let rows = mosaic.samples.chunks_exact(width).zip(kinds.chunks_exact_mut(width));
            for ((row, out), channels) in rows.zip(channels.iter().cycle()) {
                for ((out, &v), &c) in out.iter_mut().zip(row).zip(channels) {
                    let bit = 1 << c;
                    let is_bright = if v >= bright { bit } else { 0 };
                    let is_dark = if v < DARK * bright { bit << 3 } else { 0 };
                    *out = c << 6 | is_bright | is_dark;
                }
            }
        },
    );
    kinds
}

/// The kinds of samples within [`BORDER`] columns and rows of each.
fn spread(kinds: &[u8], width: usize) -> Vec<u8> {
    let mut along = vec![0u8; kinds.len()];
    let mut seen = vec![0u8; kinds.len()];
    vectorised(
        #[inline(always)]
        || {
            gather(kinds, &mut along, 1);
            gather(&along, &mut seen, width);
        },
    );
    seen
}

/// Each byte with those up to [`BORDER`] steps before and after it; rows run into each other only in the border.
#[inline(always)]
fn gather(bytes: &[u8], out: &mut [u8], step: usize) {
    let inner = bytes.len().saturating_sub(2 * BORDER * step);
    for k in 0..=2 * BORDER {
        let shifted = &bytes[(k * step).min(bytes.len())..];
        for (out, byte) in out.iter_mut().skip(BORDER * step).take(inner).zip(shifted) {
            *out |= byte;
        }
    }
}

/// Least and largest of the green samples of the 3 x 3 around one.
fn greens(mosaic: &Mosaic<f32>, kinds: &[u8], centre: usize) -> (f32, f32) {
    let (mut least, mut most) = (f32::MAX, f32::MIN);
    for y in 0..3 {
        let run = centre + y * mosaic.size.width - mosaic.size.width - 1..;
        for (&v, kind) in mosaic.samples[run.clone()][..3].iter().zip(&kinds[run]) {
            if kind >> 6 == 1 {
                (least, most) = (least.min(v), most.max(v));
            }
        }
    }
    if least <= most { (least, most) } else { (f32::MIN, f32::MAX) }
}

/// Colour of the dark samples around one, and how much it is to count: by how near a highlight is that is bright in
/// every channel, and by whether it is a highlight.
fn around(mosaic: &Mosaic<f32>, kinds: &[u8], centre: usize) -> Option<([f32; 3], f32)> {
    let (mut near, mut sums, mut dark, mut all) = ([0f32; 3], [0f32; 3], [0f32; 3], [0f32; 3]);
    for y in 0..=2 * BORDER {
        let run = centre + y * mosaic.size.width - BORDER * mosaic.size.width - BORDER..;
        let samples = &mosaic.samples[run.clone()][..2 * BORDER + 1];
        for (x, (&v, &kind)) in samples.iter().zip(&kinds[run]).enumerate() {
            let (c, down, across) = (usize::from(kind >> 6), y.abs_diff(BORDER), x.abs_diff(BORDER));
            let weight = WEIGHTS[down] * WEIGHTS[across];
            all[c] += weight;
            if kind & DARK_KINDS != 0 {
                sums[c] += weight * signed_sqrt(v);
                dark[c] += weight;
            } else if kind & BRIGHT_KINDS != 0 {
                near[c] = near[c].max(NEAR[down.max(across)]);
            }
        }
    }
    if sums.iter().any(|&sum| sum <= 0.0) {
        return None;
    }
    let shares: [f32; 3] = from_fn(|c| dark[c] / all[c]);
    let least = |values: [f32; 3]| values[0].min(values[1]).min(values[2]);
    let alike = least(shares) / (shares[0].max(shares[1]).max(shares[2]) + FEW);
    let trust = ((alike - UNLIKE) * (1.0 / (ALIKE - UNLIKE))).clamp(0.0, 1.0);
    let colour = from_fn(|c| signed_square(sums[c] / dark[c]));
    Some((colour, least(near) * trust))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::highlights::Rebuild;
    use darkroot_photo::Size;

    const SIZE: Size = Size { width: 30, height: 30 };
    fn treatment() -> Treatment {
        Treatment::Rebuild(Rebuild { limits: [2.0, 1.0, 1.5], colours: Arc::default(), uneven: false })
    }

    /// A surface of one colour under an RGGB array, with a bright spot of 3 x 3 pixels in the middle.
    fn spot(surface: [f32; 3]) -> Mosaic<f32> {
        let cfa = Cfa::parse("RGGB").unwrap();
        let inside = |i: usize| (14..17).contains(&(i % 30)) && (14..17).contains(&(i / 30));
        let sample =
            |i: usize| if inside(i) { 2.0 } else { surface[cfa.at(i % 30, i / 30).plane().unwrap()] };
        Mosaic { size: SIZE, samples: (0..SIZE.area()).map(sample).collect(), layout: Layout::Cfa(cfa) }
    }

    /// What becomes of a pixel of the picture whose place in the mosaic is given; all pixels have its colour.
    fn cut_at(mosaic: &Mosaic<f32>, (x, y): (usize, usize), pixel: [f32; 3]) -> [f32; 3] {
        let inner = Size { width: 20, height: 20 };
        let mut picture = Rgb::from_planes(inner, pixel.map(|v| vec![v; inner.area()])).unwrap();
        cut(mosaic, BORDER, &treatment(), &mut picture);
        picture.at(x - BORDER, y - BORDER)
    }

    #[test]
    fn a_colour_that_is_neither_the_surface_nor_the_highlight_nor_between_is_cut() {
        // Red leaked.
        let [r, g, b] = cut_at(&spot([0.1, 0.1, 0.1]), (13, 14), [0.5, 0.1, 0.08]);
        assert!((r - 0.1).abs() < 1e-6 && g == 0.1 && (b - 0.1).abs() < 1e-6, "{r} {g} {b}");
    }

    #[test]
    fn colours_between_the_surface_and_the_highlight_are_left_alone() {
        let surface = [0.2, 0.1, 0.05];
        for pixel in [[0.15, 0.1, 0.08], [0.11, 0.1, 0.09]] {
            assert_eq!(cut_at(&spot(surface), (13, 14), pixel), pixel);
        }
    }

    #[test]
    fn beyond_the_border_nothing_is_cut() {
        assert_eq!(cut_at(&spot([0.1; 3]), (8, 14), [0.5, 0.1, 0.08]), [0.5, 0.1, 0.08]);
    }

    #[test]
    fn a_light_that_is_bright_in_one_channel_keeps_its_hue() {
        let mut mosaic = spot([0.1; 3]);
        let Layout::Cfa(cfa) = mosaic.layout.clone() else { return };
        for (i, v) in mosaic.samples.iter_mut().enumerate() {
            *v = if cfa.at(i % 30, i / 30).plane() == Some(0) { *v } else { 0.1 };
        }
        assert_eq!(cut_at(&mosaic, (13, 14), [0.5, 0.1, 0.08]), [0.5, 0.1, 0.08]);
    }
}
