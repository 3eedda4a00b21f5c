//! Interpolates eight pixels at once where the map runs along the frame: neighbours of the picture are then made of neighbours of
//! the frame, which lie side by side in memory. Lenses, small angles and turns by right angles are such maps; pictures of another
//! size are not. The result is what [`super::resample`] finds one by one, to the bit.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Rect, Rgb};

use super::taps::{GROUP, PHASES, Taps};
use super::warp::{Axis, Places, Warp};
use crate::cones::{greater, lesser};

/// Pixels that are made at once.
const RUN: usize = 8;
/// Pixels of a row that are read for them, at least `RUN + GROUP - 1`.
const WIDE: usize = 16;
/// Times in eight pixels that neighbours may be made of others than neighbours, above which eight at once are no gain.
const MOST_BREAKS: f64 = 1.5;

/// What the lines of a part of the picture are worked out in.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Where the pixels of a line come from, and that in parts of a pixel of the frame.
    places: Vec<[f64; 2]>,
    parts: Vec<[i32; 2]>,
    /// What lies there, by channel.
    found: [Vec<f32>; 3],
    work: Work,
}

/// What a line's pixels are made with.
#[derive(Debug, Default)]
struct Work {
    /// Across and down, for each eight.
    weights: Vec<[Weights; 2]>,
    /// The first of the pixels of each eight, where those lie side by side.
    firsts: Vec<Option<usize>>,
    /// Least and greatest of the columns that each eight are made of.
    ranges: Vec<[f32; 2 * WIDE]>,
}

/// How lines of the picture run along rows of the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lines {
    /// Which lines: rows or columns.
    axis: Axis,
    /// Whether from their last pixel to their first one.
    backwards: bool,
}

impl Lines {
    /// The lines of a part of the picture that run so; `None` where none do.
    pub(super) fn of(taps: &Taps, places: &Places) -> Option<Self> {
        if !taps.is_plain() {
            return None;
        }
        let all = [(Axis::Rows, false), (Axis::Rows, true), (Axis::Columns, false), (Axis::Columns, true)];
        let breaks = |(axis, backwards): (Axis, bool)| {
            let along = if backwards { -(RUN as f64) } else { RUN as f64 };
            places.mean_over_steps(axis, |[x, y]| (x - along).abs() + y.abs())
        };
        let found = all.into_iter().find(|&lines| breaks(lines) < MOST_BREAKS);
        found.map(|(axis, backwards)| Self { axis, backwards })
    }

    /// Makes `out` the part `rect` of the picture, of `camera`, which holds `source`.
    pub(super) fn resample(
        self,
        warp: &Warp,
        (camera, source): (&Rgb<CameraSpace>, Rect),
        places: &Places,
        rect: Rect,
        scratch: &mut Scratch,
        out: &mut Rgb<CameraSpace>,
    ) {
        let (count, lines) = match self.axis {
            Axis::Rows => (rect.width, rect.height),
            Axis::Columns => (rect.height, rect.width),
        };
        let Scratch { places: line, parts, found, work } = scratch;
        line.resize(count, [0.0; 2]);
        for plane in &mut *found {
            plane.resize(count.next_multiple_of(RUN), 0.0);
        }
        let frame = Frame { source, planes: camera.planes() };
        for i in 0..lines {
            for channel in 0..places.channels() {
                match self.axis {
                    Axis::Rows => places.row(channel, rect.x, rect.y + i, line),
                    Axis::Columns => places.column(channel, rect.x + i, rect.y, line),
                }
                if self.backwards {
                    line.reverse();
                }
                parts_of(line, parts);
                let channels = if places.channels() == 1 { 0..3 } else { channel..channel + 1 };
                frame.line(warp.taps.plain(), parts, channels, (&mut *work, &mut *found));
            }
            for (plane, found) in out.planes_mut().into_iter().zip(&mut *found) {
                let found = &mut found[..count];
                if self.backwards {
                    found.reverse();
                }
                match self.axis {
                    Axis::Rows => plane[i * count..][..count].copy_from_slice(found),
                    Axis::Columns => {
                        plane[i..].iter_mut().step_by(lines).zip(found).for_each(|(v, found)| *v = *found);
                    }
                }
            }
        }
    }
}

/// Places in parts of a pixel. The last one is followed by such that fill a run.
fn parts_of(places: &[[f64; 2]], parts: &mut Vec<[i32; 2]>) {
    parts.resize(places.len(), [0; 2]);
    vectorised(
        #[inline(always)]
        || {
            for (parts, &place) in parts.as_flattened_mut().iter_mut().zip(places.as_flattened()) {
                *parts = Taps::parts(place);
            }
        },
    );
    let last = parts.last().copied().unwrap_or_default();
    let missing = parts.len().next_multiple_of(RUN) - parts.len();
    parts.extend((1..=missing).map(|i| [last[0].wrapping_add((i * PHASES) as i32), last[1]]));
}

/// Weights of eight places, by pixel that they are made of.
type Weights = [[f32; RUN]; GROUP];

/// A part of the frame.
struct Frame<'a> {
    source: Rect,
    planes: [&'a [f32]; 3],
}

impl Frame<'_> {
    /// What lies at the places of a line, of some channels.
    fn line(
        &self,
        weights: &[[f32; GROUP]],
        parts: &[[i32; 2]],
        channels: std::ops::Range<usize>,
        (work, found): (&mut Work, &mut [Vec<f32>; 3]),
    ) {
        let Work { weights: all, firsts, ranges } = work;
        all.resize(parts.len() / RUN, [[[0.0; RUN]; GROUP]; 2]);
        ranges.resize(parts.len() / RUN, [0.0; 2 * WIDE]);
        firsts.clear();
        let runs = parts.as_chunks::<RUN>().0;
        vectorised(
            #[inline(always)]
            || {
                for (of, parts) in all.iter_mut().zip(runs) {
                    weights_of(weights, parts, of);
                    firsts
                        .push(Some(self.together(parts, 0)).filter(|(end, _)| *end == RUN).and_then(|v| v.1));
                }
                for c in channels.clone() {
                    let plane = self.planes[c];
                    // Ranges lie in memory, because compilers make poor shuffles of them otherwise; so all of a line first, or
                    // each would wait for its own.
                    for (range, first) in ranges.iter_mut().zip(&*firsts) {
                        if let Some(rows) = first.and_then(|first| rows(plane, first, self.source.width)) {
                            range_of(&rows, range);
                        }
                    }
                    let out = found[c].as_chunks_mut::<RUN>().0;
                    for (i, (out, parts)) in out.iter_mut().zip(runs).enumerate() {
                        match firsts[i].and_then(|first| rows(plane, first, self.source.width)) {
                            Some(rows) => *out = eight(&rows, &all[i], &ranges[i]),
                            None => self.in_pieces(plane, parts, weights, &all[i], out),
                        }
                    }
                }
            },
        );
    }

    /// What lies at eight places that are not all made of pixels side by side.
    #[inline(always)]
    fn in_pieces(
        &self,
        plane: &[f32],
        parts: &[[i32; 2]; RUN],
        weights: &[[f32; GROUP]],
        of: &[Weights; 2],
        out: &mut [f32; RUN],
    ) {
        let (mut begin, mut range) = (0, [0.0; 2 * WIDE]);
        while begin < RUN {
            let (end, first) = self.together(parts, begin);
            if let Some(rows) = first.and_then(|first| rows(plane, first, self.source.width)) {
                range_of(&rows, &mut range);
                out[begin..end].copy_from_slice(&eight(&rows, of, &range)[begin..end]);
            } else {
                for i in begin..end {
                    out[i] = self.at_edge(plane, parts[i], weights);
                }
            }
            begin = end;
        }
    }

    /// The first pixel that a place in parts of a pixel is made of, along one axis, from the corner.
    #[inline(always)]
    fn first(part: i32, corner: usize) -> i32 {
        (part >> PHASES.trailing_zeros()).wrapping_add(1 - (GROUP / 2) as i32).wrapping_sub(corner as i32)
    }

    /// The end of the places from `begin` on that are made of pixels side by side, and where those of the whole run would begin,
    /// if those of these places are all there.
    #[inline(always)]
    fn together(&self, parts: &[[i32; 2]; RUN], begin: usize) -> (usize, Option<usize>) {
        let Rect { x, y, width, height } = self.source;
        let at = |i: usize| [Self::first(parts[i][0], x).wrapping_sub(i as i32), Self::first(parts[i][1], y)];
        let [left, top] = at(begin);
        let mut end = begin + 1;
        while end < RUN && at(end) == [left, top] {
            end += 1;
        }
        let within = |first: i32, count: usize, most: usize| first >= 0 && first as usize + count <= most;
        let is_within = within(left.wrapping_add(begin as i32), end - begin + GROUP - 1, width)
            && within(top, GROUP, height);
        // Pixels of the run that are not of these places may lie before the row.
        let all = top as isize * width as isize + left as isize;
        (end, usize::try_from(all).ok().filter(|_| is_within))
    }

    /// A place that is made of pixels beyond the edge, where the last ones go on.
    #[inline(never)]
    fn at_edge(&self, plane: &[f32], [x, y]: [i32; 2], weights: &[[f32; GROUP]]) -> f32 {
        let phase = |v: i32| &weights[v as usize % PHASES];
        let Rect { x: left, y: top, width, height } = self.source;
        let pixel = |v: i32, corner: usize, k: usize, length: usize| {
            (Self::first(v, corner) as isize + k as isize).clamp(0, length as isize - 1) as usize
        };
        let (mut sum, mut low, mut high) = (0f32, f32::MAX, f32::MIN);
        for (k, across) in phase(x).iter().enumerate() {
            let mut mean = 0f32;
            for (j, down) in phase(y).iter().enumerate() {
                let v = plane[pixel(y, top, j, height) * width + pixel(x, left, k, width)];
                mean += down * v;
                low = lesser(v, low);
                high = greater(v, high);
            }
            sum += across * mean;
        }
        within(sum, low, high)
    }
}

/// The pixels of six rows from one on.
#[inline(always)]
fn rows(plane: &[f32], first: usize, width: usize) -> Option<[&[f32; WIDE]; GROUP]> {
    let mut rows = [&[0f32; WIDE]; GROUP];
    let all = plane.get(first..first + (GROUP - 1) * width + WIDE)?;
    for (j, row) in rows.iter_mut().enumerate() {
        *row = all.get(j * width..)?.first_chunk::<WIDE>()?;
    }
    Some(rows)
}

/// Weights of eight places, across and down.
#[inline(always)]
fn weights_of(weights: &[[f32; GROUP]], parts: &[[i32; 2]; RUN], of: &mut [Weights; 2]) {
    let Some(weights) = weights.first_chunk::<PHASES>() else { return };
    for (axis, of) in of.iter_mut().enumerate() {
        for (i, parts) in parts.iter().enumerate() {
            let own = &weights[parts[axis] as usize % PHASES];
            for k in 0..GROUP {
                of[k][i] = own[k];
            }
        }
    }
}

/// The least and the greatest of the six pixels of each column.
#[inline(always)]
fn range_of(rows: &[&[f32; WIDE]; GROUP], range: &mut [f32; 2 * WIDE]) {
    for half in [0, RUN] {
        let (mut low, mut high) = ([f32::MAX; RUN], [f32::MIN; RUN]);
        for row in rows {
            // As an array of its own, or compilers take most of it one by one.
            let mut line = [0f32; RUN];
            line.copy_from_slice(&row[half..][..RUN]);
            for i in 0..RUN {
                low[i] = lesser(line[i], low[i]);
                high[i] = greater(line[i], high[i]);
            }
        }
        range[half..][..RUN].copy_from_slice(&low);
        range[WIDE + half..][..RUN].copy_from_slice(&high);
    }
}

/// Eight places side by side: the mean down the columns, then across, within the range of the pixels.
#[inline(always)]
fn eight(rows: &[&[f32; WIDE]; GROUP], [across, down]: &[Weights; 2], range: &[f32; 2 * WIDE]) -> [f32; RUN] {
    let mut sum = [0f32; RUN];
    for (k, across) in across.iter().enumerate() {
        let mut mean = [0f32; RUN];
        for (row, down) in rows.iter().zip(down) {
            for i in 0..RUN {
                mean[i] += down[i] * row[k + i];
            }
        }
        for i in 0..RUN {
            sum[i] += across[i] * mean[i];
        }
    }
    let (mut low, mut high) = ([0f32; RUN], [0f32; RUN]);
    low.copy_from_slice(&range[..RUN]);
    high.copy_from_slice(&range[WIDE..][..RUN]);
    for k in 1..GROUP {
        for i in 0..RUN {
            low[i] = lesser(range[k + i], low[i]);
            high[i] = greater(range[WIDE + k + i], high[i]);
        }
    }
    let mut out = [0f32; RUN];
    for i in 0..RUN {
        out[i] = within(sum[i], low[i], high[i]);
    }
    out
}

/// A sum, held within a range.
#[inline(always)]
pub(super) fn within(sum: f32, low: f32, high: f32) -> f32 {
    let v = if sum < high { sum } else { high };
    // Zero has no sign, whichever of two came first.
    (if v > low { v } else { low }) + 0.0
}
