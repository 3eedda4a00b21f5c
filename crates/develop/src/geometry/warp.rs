//! The map from places of the picture to places of the frame.

use darkroot_colour::{Matrix3, Vector3};
use darkroot_photo::{Rect, Size};

use super::lens::LensWarp;
use super::taps::Taps;

/// Pixels of the picture from one place that is computed to the next; between them places are interpolated, which is wrong by
/// a few thousandths of a pixel even under a fisheye.
const STEP: usize = 8;

/// Where the pixels of a picture come from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Warp {
    /// From columns and rows of the picture to those of the active area after the lens was corrected; homogeneous.
    to_frame: Matrix3,
    lens: Vec<LensWarp>,
    /// Size of the active area.
    area: Size,
    /// Pixels of the active area that one of the picture stands for, along each axis.
    reduction: f64,
    pub(super) taps: Taps,
}

/// Where the pixels of a part of a picture come from, at a scale.
#[derive(Debug)]
pub(crate) struct Places {
    /// Column and row of the first node, in steps.
    first: (usize, usize),
    columns: usize,
    /// By channel; one serves all where colours are not split.
    nodes: Vec<Vec<[f64; 2]>>,
}

/// Lines of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Axis {
    Rows,
    Columns,
}

impl Warp {
    /// `reduction` is how many pixels of the frame one of the picture stands for, along each axis; `sharpening` how much a smaller
    /// picture is sharpened.
    pub(super) fn new(
        to_frame: Matrix3,
        lens: Vec<LensWarp>,
        area: Size,
        reduction: f64,
        sharpening: f32,
    ) -> Self {
        Self { to_frame, lens, area, reduction, taps: Taps::of(reduction, f64::from(sharpening)) }
    }

    /// As many columns of the picture as are made of so many of the frame.
    pub(crate) fn columns(&self, of_frame: usize) -> usize {
        ((of_frame as f64 / self.reduction.max(1.0)) as usize).max(1)
    }

    /// Whether red, green and blue of a place come from different ones.
    pub(super) fn splits_colours(&self) -> bool {
        self.lens.iter().any(LensWarp::splits_colours)
    }

    /// Where a colour of a place of the picture lies in the active area, in pixels from its corner.
    pub(crate) fn place(&self, channel: usize, x: f64, y: f64) -> [f64; 2] {
        self.lens.iter().rev().fold(self.corrected(x, y), |at, lens| lens.place(channel, at))
    }

    /// Where a place of the picture lies in the active area once the lens is corrected, in pixels from its corner.
    pub(crate) fn corrected(&self, x: f64, y: f64) -> [f64; 2] {
        let v = self.to_frame * Vector3::new(x, y, 1.0);
        [v.x / v.z, v.y / v.z]
    }

    /// Where the pixels of a part of the picture come from, both at 1/`bin` of their size. Places that are none, as hostile
    /// coefficients make them, become the corner.
    pub(crate) fn places(&self, rect: Rect, bin: usize) -> Places {
        let first = (rect.x / STEP, rect.y / STEP);
        let (columns, rows) =
            (rect.right().div_ceil(STEP) + 1 - first.0, rect.bottom().div_ceil(STEP) + 1 - first.1);
        let channels = if self.splits_colours() { 3 } else { 1 };
        let scale = bin as f64;
        let most = [self.area.width as f64 / scale, self.area.height as f64 / scale];
        let node = |channel: usize, i: usize| {
            let at = |first: usize, i: usize| ((first + i) * STEP) as f64 * scale;
            let [x, y] = self.place(channel, at(first.0, i % columns), at(first.1, i / columns));
            let inside = |v: f64, most: f64| if v.is_finite() { v.clamp(-most, 2.0 * most) } else { 0.0 };
            [inside(x / scale, most[0]), inside(y / scale, most[1])]
        };
        let nodes = (0..channels).map(|c| (0..columns * rows).map(|i| node(c, i)).collect()).collect();
        Places { first, columns, nodes }
    }

    /// The part of the active area, at 1/`bin` of its size, that a part of the picture is made of.
    pub(crate) fn needs(&self, places: &Places, bin: usize) -> Rect {
        let size = Size { width: self.area.width.div_ceil(bin), height: self.area.height.div_ceil(bin) };
        let around = self.taps.reach() as f64;
        let span = |axis: usize, length: usize| {
            let all = || places.nodes.iter().flatten().map(|node| node[axis]);
            let (least, most) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
            let first = (least - around).clamp(0.0, length as f64 - 1.0) as usize;
            (first, (most + around).clamp(first as f64 + 1.0, length as f64).ceil() as usize - first)
        };
        let ((x, width), (y, height)) = (span(0, size.width), span(1, size.height));
        Rect { x, y, width, height }
    }
}

/// How far the middle of a pixel lies between two nodes.
#[inline(always)]
fn share(v: usize) -> f64 {
    ((v % STEP) as f64 + 0.5) / STEP as f64
}

#[inline(always)]
fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + share * (b - a)
}

impl Places {
    /// 1, or 3 where each colour comes from another place.
    pub(super) fn channels(&self) -> usize {
        self.nodes.len()
    }

    /// Where a colour of the pixels of a row, from column `x` on, comes from.
    pub(super) fn row(&self, channel: usize, x: usize, y: usize, places: &mut [[f64; 2]]) {
        let below = share(y);
        let row = (y / STEP - self.first.1) * self.columns;
        let nodes = |row: usize| &self.nodes[channel][row..][..self.columns];
        let (above, under) = (nodes(row), nodes(row + self.columns));
        let at = |i: usize| [mix(above[i][0], under[i][0], below), mix(above[i][1], under[i][1], below)];
        let (mut x, mut places) = (x, places);
        while !places.is_empty() {
            let i = x / STEP - self.first.0;
            let (left, right) = (at(i), at(i + 1));
            let (run, rest) = places.split_at_mut((STEP - x % STEP).min(places.len()));
            for (x, place) in (x..).zip(run.iter_mut()) {
                let along = share(x);
                *place = [mix(left[0], right[0], along), mix(left[1], right[1], along)];
            }
            x += run.len();
            places = rest;
        }
    }
    /// Where a colour of the pixels of a column, from row `y` on, comes from: what [`Self::row`] says of them.
    pub(super) fn column(&self, channel: usize, x: usize, y: usize, places: &mut [[f64; 2]]) {
        let along = share(x);
        let column = x / STEP - self.first.0;
        let (mut y, mut places) = (y, places);
        while !places.is_empty() {
            let at = (y / STEP - self.first.1) * self.columns + column;
            let [[a, b], [c, d]] =
                [at, at + self.columns].map(|at| [self.nodes[channel][at], self.nodes[channel][at + 1]]);
            let (run, rest) = places.split_at_mut((STEP - y % STEP).min(places.len()));
            for (y, place) in (y..).zip(run.iter_mut()) {
                let below = share(y);
                *place = [0, 1].map(|i| mix(mix(a[i], c[i], below), mix(b[i], d[i], below), along));
            }
            y += run.len();
            places = rest;
        }
    }

    /// The mean, over all nodes, of what is said of the way from one node to the next along lines of the picture.
    pub(super) fn mean_over_steps(&self, axis: Axis, of: impl Fn([f64; 2]) -> f64) -> f64 {
        let ahead = match axis {
            Axis::Rows => 1,
            Axis::Columns => self.columns,
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for nodes in &self.nodes {
            for (i, node) in nodes.iter().enumerate() {
                let is_last = axis == Axis::Rows && (i + 1) % self.columns == 0;
                if let Some(next) = nodes.get(i + ahead).filter(|_| !is_last) {
                    sum += of([next[0] - node[0], next[1] - node[1]]);
                    count += 1.0;
                }
            }
        }
        sum / count
    }
}
