//! The places of all patches from the edges of all patches.

use darkroot_colour::statistics::median;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::pixels::SearchImage;
use super::placement::{Candidate, Family};
use crate::Homography;

/// Chart and picture brought together by edges.
#[derive(Debug, Clone)]
pub(super) struct Refined {
    /// From column and row, in steps, to pixels of the picture.
    pub(super) map: Homography,
    /// Half a patch's width and height, in steps.
    pub(super) half: [f64; 2],
    /// Root of the median square of the edges' distances from their places, in patches.
    pub(super) error: f64,
    /// Share of the edges seen in their places.
    pub(super) seen: f64,
}

/// Patches are looked at with about this many pixels along a side.
const PATCH_SIDE: f64 = 40.0;
/// Patches smaller than this, in pixels, have no edges to speak of.
const SMALLEST_SIDE: f64 = 2.0;
/// Rounds of finding edges and fitting the chart to them, and how far an edge may be from its place in each, in patches.
const ROUNDS: [f64; 4] = [0.16, 0.1, 0.06, 0.06];
/// Weakest edge, as a difference of logarithms over all channels.
const WEAKEST: f64 = 0.08;
/// Distances beyond this, in steps, count less (Huber).
const HUBER: f64 = 0.02;
/// Edges within this share of a patch of their place are seen there.
const IN_PLACE: f64 = 0.1;

/// `None` when the edges do not determine the chart.
pub(super) fn refine(picture: &SearchImage, candidate: &Candidate, family: &Family) -> Option<Refined> {
    let columns = family.columns();
    let rows = family.layout().rows;
    let mut now = Refined { map: candidate.map, half: [candidate.fill / 2.0; 2], error: 1.0, seen: 0.0 };
    let [[a, b], [c, d]] = now.map.derivative([columns[columns.len() - 1] / 2.0, rows as f64 / 2.0]);
    let side = (a * d - b * c).abs().sqrt() * candidate.fill;
    if side < SMALLEST_SIDE || side.is_nan() {
        return None;
    }
    let view = View::of(picture, candidate, (side / PATCH_SIDE).max(1.0) as usize)?;
    for reach in ROUNDS {
        let edges = edges(&view, &now, &columns, rows, reach);
        now = fitted(&now, &edges)?;
    }
    let total = (columns.len() * rows * 4 * SEGMENTS) as f64;
    let edges = edges(&view, &now, &columns, rows, IN_PLACE);
    let back = now.map.inverse()?;
    let mut errors: Vec<f64> =
        edges.iter().map(|e| (e.residual(&back, now.half) / (2.0 * now.half[e.axis])).powi(2)).collect();
    let seen = errors.iter().filter(|e| **e < IN_PLACE * IN_PLACE / 4.0).count() as f64;
    now.error = median(&mut errors)?.sqrt();
    now.seen = seen / total;
    Some(now)
}

/// Pieces of a patch's side that are located on their own.
const SEGMENTS: usize = 3;

/// An edge seen.
struct Edge {
    /// In pixels of the picture.
    at: [f64; 2],
    /// 0 for a patch's left and right edges, 1 for top and bottom.
    axis: usize,
    /// The patch's column or row.
    place: f64,
    /// -1 for left and top, 1 for right and bottom.
    side: f64,
    weight: f64,
}

impl Edge {
    /// Distance from where it should be, in steps.
    fn residual(&self, back: &Homography, half: [f64; 2]) -> f64 {
        back.apply(self.at)[self.axis] - self.place - self.side * half[self.axis]
    }
}

fn edges(view: &View, now: &Refined, columns: &[f64], rows: usize, reach: f64) -> Vec<Edge> {
    let mut edges = Vec::new();
    for row in 0..rows {
        for column in columns {
            let centre = [*column, row as f64];
            for (axis, side) in [(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0)] {
                for segment in 0..SEGMENTS {
                    let along = (segment as f64 - (SEGMENTS - 1) as f64 / 2.0) * 0.45;
                    edges.extend(edge(view, now, centre, axis, side, along, reach));
                }
            }
        }
    }
    edges
}

/// Lines across an edge that are averaged for one piece of it.
const LINES: usize = 5;

/// Looks for an edge across a piece of a patch's side: `along` is the piece's middle in half patches.
fn edge(
    view: &View,
    now: &Refined,
    centre: [f64; 2],
    axis: usize,
    side: f64,
    along: f64,
    reach: f64,
) -> Option<Edge> {
    let other = 1 - axis;
    let point = |t: f64, line: usize| {
        let mut p = centre;
        let offset = (line as f64 - (LINES - 1) as f64 / 2.0) * 0.08;
        p[other] += now.half[other] * (along + offset);
        p[axis] += side * now.half[axis] + t;
        now.map.apply(p)
    };
    let middle = LINES / 2;
    let (from, to) = (point(0.0, middle), point(0.01, middle));
    // Pixels of the view in a step across the edge.
    let scale = (to[0] - from[0]).hypot(to[1] - from[1]) / 0.01 / view.factor as f64;
    if !(scale > 1.0 && scale.is_finite()) {
        return None;
    }
    let reach = (reach * 2.0 * now.half[axis]).max(1.2 / scale);
    let spacing = 0.5 / scale;
    let count = ((reach + 2.0 / scale) / spacing).ceil().min(200.0) as i32;
    let profile: Vec<[f32; 3]> = (-count..=count)
        .map(|n| {
            let mut sum = [0.0; 3];
            for line in 0..LINES {
                let p = point(f64::from(n) * spacing, line);
                for (c, sum) in sum.iter_mut().enumerate() {
                    *sum += view.at(c, p);
                }
            }
            sum.map(|s| s / LINES as f32)
        })
        .collect();
    // Change over two pixels.
    let slope: Vec<f64> = profile
        .windows(5)
        .map(|w| (0..3).map(|c| f64::from(w[4][c] - w[0][c]).powi(2)).sum::<f64>().sqrt())
        .collect();
    let (t, height) = peak(&slope, spacing, reach)?;
    let mut p = centre;
    p[other] += now.half[other] * along;
    p[axis] += side * now.half[axis] + t;
    let at = now.map.apply(p);
    let weight = (height / 0.3).min(1.0);
    at.iter().all(|v| v.is_finite()).then_some(Edge { at, axis, place: centre[axis], side, weight })
}

/// Place and height of the peak of a slope that lies within `reach` of the middle, those near the middle favoured.
fn peak(slope: &[f64], spacing: f64, reach: f64) -> Option<(f64, f64)> {
    let half_count = (slope.len() - 1) as f64 / 2.0;
    let place = |i: usize| (i as f64 - half_count) * spacing;
    let favoured = |i: usize| slope[i] * (-0.5 * (place(i) / (0.6 * reach)).powi(2)).exp();
    let best = (0..slope.len())
        .filter(|i| place(*i).abs() <= reach)
        .max_by(|a, b| favoured(*a).total_cmp(&favoured(*b)))?;
    if slope[best] < WEAKEST || best == 0 || best + 1 == slope.len() {
        return None;
    }
    let (mut sum, mut moment) = (0.0, 0.0);
    for (i, slope) in slope.iter().enumerate().skip(best.saturating_sub(2)).take(5) {
        let weight = slope * slope;
        sum += weight;
        moment += weight * place(i);
    }
    Some((moment / sum, slope[best]))
}

/// Fits two things to the edges that were seen: the map from pixels to steps, and half the width and height of a patch.
fn fitted(now: &Refined, edges: &[Edge]) -> Option<Refined> {
    if edges.len() < 24 {
        return None;
    }
    let n = edges.len() as f64;
    let centre = [0, 1].map(|k| edges.iter().map(|e| e.at[k]).sum::<f64>() / n);
    let spread = edges.iter().map(|e| (e.at[0] - centre[0]).hypot(e.at[1] - centre[1])).sum::<f64>() / n;
    let back_to_pixels = Matrix3::new(spread, 0.0, centre[0], 0.0, spread, centre[1], 0.0, 0.0, 1.0);
    let mut map = now.map.inverse()?.0 * back_to_pixels;
    map /= map[(2, 2)];
    let mut half = now.half;
    for _ in 0..4 {
        let mut normal = SMatrix::<f64, 10, 10>::zeros();
        let mut right = SVector::<f64, 10>::zeros();
        for edge in edges {
            let (x, y) = ((edge.at[0] - centre[0]) / spread, (edge.at[1] - centre[1]) / spread);
            let p = map * Vector3::new(x, y, 1.0);
            let w = 1.0 / p.z;
            let value = p[edge.axis] * w;
            let residual = edge.place + edge.side * half[edge.axis] - value;
            let weight = edge.weight * (HUBER / residual.abs().max(HUBER));
            let mut row = SVector::<f64, 10>::zeros();
            let first = 3 * edge.axis;
            row[first] = x * w;
            row[first + 1] = y * w;
            row[first + 2] = w;
            row[6] = -value * x * w;
            row[7] = -value * y * w;
            row[8 + edge.axis] = -edge.side;
            normal += row * row.transpose() * weight;
            right += row * (residual * weight);
        }
        let step = normal.cholesky()?.solve(&right);
        let s = |i: usize| step[i];
        map += Matrix3::new(s(0), s(1), s(2), s(3), s(4), s(5), s(6), s(7), 0.0);
        half = [half[0] + s(8), half[1] + s(9)];
    }
    let back = map * back_to_pixels.try_inverse()?;
    let sane = half.iter().all(|h| (0.2..0.53).contains(h));
    let forth = Homography(back).inverse()?;
    let map = Homography(forth.0 / forth.0[(2, 2)]);
    (sane && map.0.iter().all(|m| m.is_finite())).then_some(Refined { map, half, ..*now })
}

/// The part of the picture around a chart in logarithms, made smaller when patches are large.
struct View {
    origin: [f64; 2],
    factor: usize,
    picture: SearchImage,
}

/// Largest side of a view in pixels.
const LARGEST_VIEW: usize = 3000;

impl View {
    fn of(picture: &SearchImage, candidate: &Candidate, factor: usize) -> Option<Self> {
        let corners = candidate.corners();
        let range = |k: usize, limit: usize| {
            let [low, high] =
                corners.iter().fold([f64::MAX, f64::MIN], |m, p| [m[0].min(p[k]), m[1].max(p[k])]);
            let margin = 0.1 * (high - low);
            let (low, high) =
                ((low - margin).max(0.0) as usize, ((high + margin).max(0.0) as usize).min(limit));
            (low, high.saturating_sub(low) / factor)
        };
        let ((x0, width), (y0, height)) = (range(0, picture.width), range(1, picture.height));
        if width < 8 || height < 8 || width > LARGEST_VIEW || height > LARGEST_VIEW {
            return None;
        }
        let share = 1.0 / (factor * factor) as f32;
        let planes = picture.planes.each_ref().map(|plane| {
            let mut small = vec![0.0f32; width * height];
            for (y, row) in small.chunks_exact_mut(width).enumerate() {
                for line in 0..factor {
                    let start = (y0 + y * factor + line) * picture.width + x0;
                    let line = &plane[start..start + width * factor];
                    for (sum, pixels) in row.iter_mut().zip(line.chunks_exact(factor)) {
                        *sum += pixels.iter().sum::<f32>() * share;
                    }
                }
            }
            let mut sorted: Vec<f32> = small.iter().step_by(7).copied().collect();
            let rank = sorted.len() * 95 / 100;
            let white = sorted.select_nth_unstable_by(rank, f32::total_cmp).1.max(f32::MIN_POSITIVE);
            for v in &mut small {
                *v = (*v / white + 0.02).ln();
            }
            small
        });
        Some(Self { origin: [x0 as f64, y0 as f64], factor, picture: SearchImage { width, height, planes } })
    }

    /// Logarithm of the light at a point of the whole picture.
    fn at(&self, channel: usize, [x, y]: [f64; 2]) -> f32 {
        let k = self.factor as f64;
        self.picture.at(channel, (x - self.origin[0] + 0.5) / k - 0.5, (y - self.origin[1] + 0.5) / k - 0.5)
    }
}
