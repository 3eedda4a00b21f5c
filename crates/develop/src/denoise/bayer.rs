//! The two finest scales of a rectangle of a Bayer mosaic, and with the coarse ones all of its noise.
//!
//! A plane is gone through from top to bottom, each step as many rows behind the one before as it looks ahead, so that only
//! the last rows of each are kept.

use darkroot_colour::simd::vectorised;
use darkroot_photo::Rect;

use super::Denoiser;
use super::coarse::Coarse;
use super::rows::{Places, Source, hat, hat_along, power_of_pairs, twice};
use super::shrink::{FINE, UnitNoise, removed, threshold};

/// Rows and columns of a plane around the result that is looked at: 1 and 2 for the low-passes, 1 and 2 more (a whole pair)
/// for the power of what lies around.
const PLANE_BORDER: usize = 6;
/// The same in pixels.
pub(crate) const BORDER: usize = 2 * PLANE_BORDER;
/// Rectangles begin and end where pairs of rows and columns of a plane do.
const ALIGNED: usize = 4;

/// Rows that are kept of a ring: more than any step looks back.
const RING: usize = 8;

/// What one thread works in, and what it made last.
#[derive(Default)]
pub(crate) struct Scratch {
    /// The mosaic of a rectangle with its border.
    mosaic: Vec<f32>,
    /// Column and row of the frame at which it begins, which may lie outside of it, and its width.
    begin: (isize, isize),
    width: usize,
    /// Rotated planes.
    planes: [Vec<f32>; 4],
    /// Share of the variance left in them, for pairs of rows and columns.
    left: [Vec<f32>; 4],
    rings: Rings,
}

impl Scratch {
    /// Room for the mosaic of a rectangle that begins in this column and row of the frame.
    pub(super) fn begin_at(&mut self, begin: (isize, isize), width: usize, height: usize) -> &mut [f32] {
        (self.begin, self.width) = (begin, width);
        self.mosaic.resize(width * height, 0.0);
        &mut self.mosaic
    }

    /// The light of row `y` of the frame from column `x` on, inside the rectangle that was denoised last.
    pub(crate) fn row(&self, x: usize, y: usize, out: &mut [f32]) {
        let column = (x as isize - self.begin.0) as usize;
        let row = (y as isize - self.begin.1) as usize;
        out.copy_from_slice(&self.mosaic[row * self.width + column..][..out.len()]);
    }
}

/// See [`Denoiser::denoise`].
pub(super) fn denoise(
    filter: &Denoiser,
    source: Source<'_>,
    coarse: &Coarse,
    rect: Rect,
    scratch: &mut Scratch,
) {
    let area = source.capture.active_area;
    // From the active area's corner, in pixels.
    let first = |at: usize, start: usize| (at - start) / ALIGNED * ALIGNED;
    let (x, y) = (first(rect.x, area.x), first(rect.y, area.y));
    let span = |begin: usize, end: usize| (end - begin).next_multiple_of(ALIGNED) + 2 * BORDER;
    let (width, height) = (span(x, rect.right() - area.x), span(y, rect.bottom() - area.y));
    let (x, y) = (x as isize - BORDER as isize, y as isize - BORDER as isize);
    let begin = (x + area.x as isize, y + area.y as isize);
    for (i, row) in scratch.begin_at(begin, width, height).chunks_exact_mut(width).enumerate() {
        source.row(x, y + i as isize, row);
    }
    let size = (width / 2, height / 2);
    let corner = (x / 2, y / 2);
    let Scratch { mosaic, planes, left, rings, .. } = scratch;
    for (plane, left) in planes.iter_mut().zip(left.iter_mut()) {
        plane.resize(size.0 * size.1, 0.0);
        left.resize(size.0 * size.1 / 4, 0.0);
    }
    if rings.row.len() != size.0 {
        *rings = Rings::new(size.0);
    }
    vectorised(
        #[inline(always)]
        || {
            forth(filter, mosaic, planes, size);
            for (k, (plane, left)) in planes.iter_mut().zip(left.iter_mut()).enumerate() {
                let strength = filter.strengths[k];
                let thresholds = [0, 1].map(|j| threshold(filter.unit.variances[j], strength));
                rings.clean((plane, left), size, &filter.unit, thresholds, (coarse, k, corner));
            }
            back(filter, (planes, left), mosaic, size);
        },
    );
}

/// The rotated planes of a mosaic.
#[inline(always)]
fn forth(filter: &Denoiser, mosaic: &[f32], planes: &mut [Vec<f32>; 4], (columns, _): (usize, usize)) {
    let mut places = Places::new(columns);
    for (y, rows) in mosaic.chunks_exact(4 * columns).enumerate() {
        let planes = planes.each_mut().map(|p| &mut p[y * columns..][..columns]);
        places.rotated(filter, rows.split_at(2 * columns), planes);
    }
}

/// The mosaic of the planes, but for its border. Clipped samples stay as they are.
#[inline(always)]
fn back(
    filter: &Denoiser,
    (planes, left): (&[Vec<f32>; 4], &[Vec<f32>; 4]),
    mosaic: &mut [f32],
    (columns, rows): (usize, usize),
) {
    let inner = PLANE_BORDER..columns - PLANE_BORDER;
    let mut roots = [0; 2].map(|_| vec![0f32; inner.len()]);
    let mut pairs = vec![0f32; inner.len() / 2];
    let mut shares = [0; 2].map(|_| vec![0f32; inner.len()]);
    for y in PLANE_BORDER..rows - PLANE_BORDER {
        let row = planes.each_ref().map(|p| &p[y * columns..][inner.clone()]);
        let half = inner.start / 2..inner.end / 2;
        let left = left.each_ref().map(|l| &l[y / 2 * (columns / 2)..][half.clone()]);
        for down in 0..2 {
            for (across, (roots, shares)) in roots.iter_mut().zip(&mut shares).enumerate() {
                filter.rotation.back(2 * down + across, row, roots);
                filter.rotation.back_squared(2 * down + across, left, &mut pairs);
                twice(&pairs, shares);
            }
            let out = &mut mosaic[(2 * y + down) * 2 * columns..][2 * inner.start..2 * inner.end];
            let of = [2 * down, 2 * down + 1];
            let ([even, odd], limits) = (of.map(|i| filter.stabilisers[i]), of.map(|i| filter.limits[i]));
            let [even_roots, odd_roots] = &roots;
            let [even_shares, odd_shares] = &shares;
            let roots = even_roots.iter().zip(odd_roots);
            let shares = even_shares.iter().zip(odd_shares);
            for ((pair, roots), left) in out.chunks_exact_mut(2).zip(roots).zip(shares) {
                let light = [even.light(*roots.0, 1.0 - left.0), odd.light(*roots.1, 1.0 - left.1)];
                pair[0] = if pair[0] < limits[0] { light[0] } else { pair[0] };
                pair[1] = if pair[1] < limits[1] { light[1] } else { pair[1] };
            }
        }
    }
}

/// The last rows of each step over a plane. What lies at the ends of a row, where a step would look beyond it, stays 0.
#[derive(Default)]
struct Rings {
    smooth: Vec<Vec<f32>>,
    details: [Vec<Vec<f32>>; FINE],
    /// Mean squares of pairs of rows and columns.
    power: [Vec<Vec<f32>>; FINE],
    /// Share of the details of pairs that is taken away.
    removed: [Vec<f32>; FINE],
    /// The same for each column.
    factors: [Vec<f32>; FINE],
    coarse: Vec<f32>,
    /// Of the coarse scales, at every second column and the one after the last.
    line: Vec<f32>,
    row: Vec<f32>,
    half: Vec<f32>,
}

impl Rings {
    fn new(columns: usize) -> Self {
        let ring = |n: usize| (0..RING).map(|_| vec![0.0; n]).collect::<Vec<Vec<f32>>>();
        let two = |n: usize| [vec![0.0; n], vec![0.0; n]];
        Self {
            smooth: ring(columns),
            details: [ring(columns), ring(columns)],
            power: [ring(columns / 2), ring(columns / 2)],
            removed: two(columns / 2),
            factors: two(columns),
            coarse: vec![0.0; columns],
            line: vec![0.0; columns / 2 + 1],
            row: vec![0.0; columns],
            half: vec![0.0; columns / 2],
        }
    }

    /// Takes the noise of all scales from a plane but for its border, and notes what share of the variance is left. Of the
    /// coarse scales `coarse` tells what to take from plane `k`, which begins at this column and row.
    #[inline(always)]
    fn clean(
        &mut self,
        (plane, left): (&mut [f32], &mut [f32]),
        (columns, rows): (usize, usize),
        unit: &UnitNoise,
        thresholds: [f32; FINE],
        (coarse, k, (x, top)): (&Coarse, usize, (isize, isize)),
    ) {
        for y in 1..rows - 1 {
            let row = |y: usize| &plane[y * columns..][..columns];
            let smooth = &mut self.smooth[y % RING];
            hat(row(y - 1), row(y), row(y + 1), &mut self.row);
            hat_along(&self.row, 1, smooth);
            subtract(row(y), smooth, &mut self.details[0][y % RING]);
            // Of the second scale, two rows behind.
            let Some(y) = y.checked_sub(2).filter(|y| *y >= 3) else { continue };
            let smooth = |y: usize| &self.smooth[y % RING][..];
            hat(smooth(y - 2), smooth(y), smooth(y + 2), &mut self.row);
            hat_along(&self.row, 2, &mut self.factors[0]);
            subtract(smooth(y), &self.factors[0], &mut self.details[1][y % RING]);
            // At the end of a pair of rows, its power; then the pair above it is surrounded.
            if y % 2 == 0 || y < 5 {
                continue;
            }
            let pair = y / 2;
            for (details, power) in self.details.iter().zip(&mut self.power) {
                let rows = (&details[(y - 1) % RING][..], &details[y % RING][..]);
                power_of_pairs(rows.0, rows.1, &mut self.row, &mut power[pair % RING]);
            }
            if pair > PLANE_BORDER / 2 {
                let left = &mut left[(pair - 1) * (columns / 2)..][..columns / 2];
                self.shrink(pair - 1, left, unit, thresholds);
                for y in [2 * pair - 2, 2 * pair - 1] {
                    coarse.row(k, x, top + y as isize, &mut self.line, &mut self.coarse);
                    self.take(y, &mut plane[y * columns..][..columns]);
                }
            }
        }
    }

    /// How much of the details of a pair of rows goes.
    #[inline(always)]
    fn shrink(&mut self, pair: usize, left: &mut [f32], unit: &UnitNoise, thresholds: [f32; FINE]) {
        for (j, threshold) in thresholds.into_iter().enumerate() {
            let power = |pair: usize| &self.power[j][pair % RING][..];
            hat(power(pair - 1), power(pair), power(pair + 1), &mut self.half);
            hat_along(&self.half, 1, &mut self.removed[j]);
            for share in &mut self.removed[j] {
                *share = removed(threshold, *share);
            }
            twice(&self.removed[j], &mut self.factors[j]);
        }
        let [first, second] = self.removed.each_ref().map(|r| &r[..left.len()]);
        for (i, left) in left.iter_mut().enumerate() {
            *left = unit.left([first[i], second[i]]);
        }
    }

    /// Takes the noise from row `y`.
    #[inline(always)]
    fn take(&self, y: usize, row: &mut [f32]) {
        let n = row.len();
        let [first, second] = self.details.each_ref().map(|d| &d[y % RING][..n]);
        let [of_first, of_second] = self.factors.each_ref().map(|f| &f[..n]);
        let coarse = &self.coarse[..n];
        for i in 0..n {
            row[i] -= of_first[i] * first[i] + of_second[i] * second[i] + coarse[i];
        }
    }
}

#[inline(always)]
fn subtract(a: &[f32], b: &[f32], out: &mut [f32]) {
    let n = out.len();
    let (a, b) = (&a[..n], &b[..n]);
    for i in 0..n {
        out[i] = a[i] - b[i];
    }
}
