//! Interpolates a picture at the places that a map names.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Rect, Rgb};

use super::runs::{self, Lines, within};
use super::taps::{GROUP, Taps};
use super::warp::{Places, Warp};

/// What the stage works in.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Of the part of the frame: red, green, blue and nothing of each pixel.
    pixels: Vec<f32>,
    /// The same of what one place at an edge is made of.
    patch: Vec<f32>,
    /// Of a row of the picture: places, and what lies there.
    places: Vec<[f64; 2]>,
    found: Vec<f32>,
    /// For lines that run along the frame.
    lines: runs::Scratch,
}

/// Makes `out` the part `rect` of the picture. `camera` holds `source`, the part of the frame that [`Warp::needs`] said.
///
/// Light is averaged as it is, linear. No pixel leaves the range of those it is made of, so edges get no rims.
pub(crate) fn resample(
    warp: &Warp,
    (camera, source): (&Rgb<CameraSpace>, Rect),
    places: &Places,
    rect: Rect,
    scratch: &mut Scratch,
    out: &mut Rgb<CameraSpace>,
) {
    out.resize(rect.size());
    match Lines::of(&warp.taps, places) {
        Some(lines) => {
            lines.resample(warp, (camera, source), places, rect, &mut scratch.lines, out);
        }
        None => one_by_one(warp, (camera, source), places, rect, scratch, out),
    }
}

/// As [`resample`], whatever the map does.
pub(super) fn one_by_one(
    warp: &Warp,
    (camera, source): (&Rgb<CameraSpace>, Rect),
    places: &Places,
    rect: Rect,
    scratch: &mut Scratch,
    out: &mut Rgb<CameraSpace>,
) {
    let Scratch { pixels, patch, places: row, found, .. } = scratch;
    interleave(camera, pixels);
    row.resize(rect.width, [0.0; 2]);
    found.resize(LANES * rect.width, 0.0);
    let mut work = Work { taps: &warp.taps, source, pixels, patch };
    for y in 0..rect.height {
        let planes = out.planes_mut().map(|plane| &mut plane[y * rect.width..][..rect.width]);
        for channel in 0..places.channels() {
            places.row(channel, rect.x, rect.y + y, row);
            work.row(row, found);
            let channels = if places.channels() == 1 { 0..3 } else { channel..channel + 1 };
            for c in channels {
                for (v, pixel) in planes[c].iter_mut().zip(found.chunks_exact(LANES)) {
                    *v = pixel[c];
                }
            }
        }
    }
}

/// Numbers of a pixel: red, green, blue, and one that means nothing.
const LANES: usize = 4;
/// Numbers of the pixels that a place takes of each row where nothing is made smaller.
const NUMBERS: usize = LANES * GROUP;

/// Puts the numbers of each pixel beside each other.
fn interleave(picture: &Rgb<CameraSpace>, pixels: &mut Vec<f32>) {
    let [red, green, blue] = picture.planes();
    pixels.resize(LANES * red.len(), 0.0);
    for (((pixel, r), g), b) in pixels.chunks_exact_mut(LANES).zip(red).zip(green).zip(blue) {
        pixel.copy_from_slice(&[*r, *g, *b, 0.0]);
    }
}

struct Work<'a> {
    taps: &'a Taps,
    source: Rect,
    pixels: &'a [f32],
    patch: &'a mut Vec<f32>,
}

impl Work<'_> {
    /// What lies at the places of a row.
    fn row(&mut self, places: &[[f64; 2]], out: &mut [f32]) {
        vectorised(
            #[inline(always)]
            || {
                for (&place, out) in places.iter().zip(out.chunks_exact_mut(LANES)) {
                    self.pixel(place, out);
                }
            },
        );
    }

    #[inline(always)]
    fn pixel(&mut self, [x, y]: [f64; 2], out: &mut [f32]) {
        if let Some(((left, columns), (top, rows))) = self.taps.few(x).zip(self.taps.few(y)) {
            let (left, top) =
                ((left - self.source.x as isize) as usize, (top - self.source.y as isize) as usize);
            let source = self.source;
            // What lies before the first pixel counts as far beyond the last.
            if left < source.width
                && left + GROUP <= source.width
                && top < source.height
                && top + GROUP <= source.height
            {
                let begin = LANES * (top * source.width + left);
                let (used, width) = ((GROUP - 1) * LANES * source.width + NUMBERS, LANES * source.width);
                if let Some(pixels) = self.pixels.get(begin..begin + used) {
                    return mean_of_few(pixels, width, (columns, rows), out);
                }
            }
        }
        let ((left, columns), (top, rows)) = (self.taps.at(x), self.taps.at(y));
        let rows = &rows[..self.taps.count];
        let (left, top) = (left - self.source.x as isize, top - self.source.y as isize);
        let fits = |first: isize, count: usize, length: usize| first >= 0 && first as usize + count <= length;
        if fits(left, columns.len(), self.source.width) && fits(top, rows.len(), self.source.height) {
            let begin = top as usize * self.source.width + left as usize;
            return mean(&self.pixels[LANES * begin..], LANES * self.source.width, (columns, rows), out);
        }
        self.copy_edge((left, columns.len()), (top, rows.len()));
        mean(self.patch, LANES * columns.len(), (columns, rows), out);
    }

    /// Copies pixels at an edge of the frame, beyond which its last ones go on.
    #[inline(never)]
    fn copy_edge(&mut self, (left, columns): (isize, usize), (top, rows): (isize, usize)) {
        self.patch.clear();
        for j in 0..rows as isize {
            let row = (top + j).clamp(0, self.source.height as isize - 1) as usize * self.source.width;
            let column = |i: isize| (left + i).clamp(0, self.source.width as isize - 1) as usize;
            for i in 0..columns as isize {
                self.patch.extend_from_slice(&self.pixels[LANES * (row + column(i))..][..LANES]);
            }
        }
    }
}

/// As [`mean`] of as many pixels as a place takes where nothing is made smaller: two columns after two.
#[inline(always)]
fn mean_of_few(
    pixels: &[f32],
    width: usize,
    (columns, rows): (&[f32; GROUP], &[f32; GROUP]),
    out: &mut [f32],
) {
    const PAIR: usize = 2 * LANES;
    let mut totals = Totals::NOTHING;
    for (pair, weights) in columns.as_chunks::<2>().0.iter().enumerate() {
        totals.add::<PAIR>(&pixels[pair * PAIR..], width, (weights, rows));
    }
    totals.within(out);
}

/// The weighted mean of the pixels from the first one on, within their range: down the columns of a group, then across.
#[inline(always)]
fn mean(pixels: &[f32], width: usize, (columns, rows): (&[f32], &[f32]), out: &mut [f32]) {
    let mut totals = Totals::NOTHING;
    for (group, weights) in columns.chunks_exact(GROUP).enumerate() {
        totals.add::<NUMBERS>(&pixels[group * NUMBERS..], width, (weights, rows));
    }
    totals.within(out);
}

/// Weighted sums of pixels, and the range of those.
struct Totals {
    sum: [f32; LANES],
    low: [f32; LANES],
    high: [f32; LANES],
}

impl Totals {
    const NOTHING: Self = Self { sum: [0.0; LANES], low: [f32::MAX; LANES], high: [f32::MIN; LANES] };

    /// Adds columns of `N` numbers in all, from the first pixel on: down each, then across.
    #[inline(always)]
    fn add<const N: usize>(&mut self, pixels: &[f32], width: usize, (columns, rows): (&[f32], &[f32])) {
        let (mut mean, mut least, mut most) = ([0f32; N], [f32::MAX; N], [f32::MIN; N]);
        for (j, of_row) in rows.iter().enumerate() {
            let row = &pixels[j * width..][..N];
            for (((mean, least), most), v) in mean.iter_mut().zip(&mut least).zip(&mut most).zip(row) {
                *mean += of_row * v;
                *least = if v < least { *v } else { *least };
                *most = if v > most { *v } else { *most };
            }
        }
        let Self { sum, low, high } = self;
        for (k, weight) in columns.iter().enumerate() {
            for i in 0..LANES {
                let at = LANES * k + i;
                sum[i] += weight * mean[at];
                low[i] = if least[at] < low[i] { least[at] } else { low[i] };
                high[i] = if most[at] > high[i] { most[at] } else { high[i] };
            }
        }
    }

    /// The sums, held within their ranges.
    #[inline(always)]
    fn within(&self, out: &mut [f32]) {
        for (i, out) in out.iter_mut().enumerate().take(LANES) {
            *out = within(self.sum[i], self.low[i], self.high[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_few_is_the_mean_to_the_bit() {
        let mut random = 7u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as f32 / (1 << 24) as f32
        };
        let taps = Taps::of(1.0, 1.0);
        let width = 19;
        let pixels: Vec<f32> = (0..LANES * width * 12).map(|_| next()).collect();
        for _ in 0..500 {
            let place = [next(), next()].map(|v| 3.0 + 4.0 * f64::from(v));
            let [(left, columns), (top, rows)] = place.map(|v| taps.at(v));
            let [few_columns, few_rows] = place.map(|v| taps.few(v).unwrap());
            assert_eq!((few_columns.0, &few_columns.1[..]), (left, columns));
            let from = &pixels[LANES * (top as usize * width + left as usize)..];
            let (mut slow, mut fast) = ([0f32; LANES], [0f32; LANES]);
            mean(from, LANES * width, (columns, rows), &mut slow);
            mean_of_few(from, LANES * width, (few_columns.1, few_rows.1), &mut fast);
            assert_eq!(slow.map(f32::to_bits), fast.map(f32::to_bits));
        }
        assert!(Taps::of(1.5, 1.0).few(3.0).is_none());
    }
}
