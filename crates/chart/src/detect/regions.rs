//! Flat regions of about the shape of a parallelogram: what a patch looks like.
//!
//! Pixels are taken in the sequence of their contrast with their neighbours, the smoothest first, and each is joined to
//! the regions that it touches. So a region grows over its patch until it leaks over the weakest edge and merges with
//! another region; its shape is judged just before each merge. No threshold has to be chosen: shade, noise and blur
//! change the contrast at which a patch is complete, but complete it becomes (the idea of MSER: Matas et al., BMVC
//! 2002).

use super::pixels::Reduced;

/// A flat region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Region {
    pub(super) centre: [f64; 2],
    /// Covariance of its pixels: xx, xy, yy. A parallelogram with sides a and b has (aa' + bb') / 12.
    pub(super) covariance: [f64; 3],
    /// Pixels.
    pub(super) area: f64,
}

/// Fewest pixels of a patch.
const SMALLEST: u32 = 16;
/// Largest patch as a share of the picture.
const LARGEST: f64 = 1.0 / 14.0;
/// Area over 12 sqrt(det covariance): 1 for a parallelogram, 1.05 for an ellipse, less for everything with arms or holes.
const COMPACTNESS: [f64; 2] = [0.78, 1.08];
/// Most a region may be stretched: the larger standard deviation over the smaller.
const STRETCH: f64 = 5.0;
/// Light added before taking logarithms, as a share of the picture's white: keeps noise in the dark small.
const FLOOR: f32 = 0.01;
const LEVELS: usize = 400;

/// The regions of a picture.
pub(super) fn regions(picture: &Reduced) -> Vec<Region> {
    let levels = contrast_levels(picture);
    let order = counting_sort(&levels);
    let mut forest = Forest::new(picture.width, picture.height);
    let mut found = Vec::new();
    for pixel in order {
        forest.add(pixel as usize, &mut found);
    }
    without_doubles(found)
}

/// Contrast of each pixel with its four neighbours, in steps of a logarithmic scale.
fn contrast_levels(picture: &Reduced) -> Vec<u16> {
    let (w, h) = (picture.width, picture.height);
    let mut squares = vec![0.0f32; w * h];
    for plane in &picture.planes {
        let log: Vec<f32> = plane.iter().map(|v| (v.max(0.0) + FLOOR).ln()).collect();
        for y in 0..h {
            let (up, down) = (y.saturating_sub(1) * w, (y + 1).min(h - 1) * w);
            for x in 0..w {
                let (left, right) = (x.saturating_sub(1), (x + 1).min(w - 1));
                let (a, b, c, d, e) =
                    (log[y * w + x], log[y * w + left], log[y * w + right], log[up + x], log[down + x]);
                let range = a.max(b).max(c).max(d.max(e)) - a.min(b).min(c).min(d.min(e));
                squares[y * w + x] += range * range;
            }
        }
    }
    // ln of the contrast from 0.002 to 8 over all levels.
    let (from, to) = (0.002f32.ln(), 8.0f32.ln());
    let scale = (LEVELS - 1) as f32 / (to - from);
    let level = |s: f32| ((s.max(1e-12).ln() * 0.5 - from) * scale).clamp(0.0, (LEVELS - 1) as f32) as u16;
    squares.into_iter().map(level).collect()
}

fn counting_sort(levels: &[u16]) -> Vec<u32> {
    let mut starts = vec![0usize; LEVELS + 1];
    for level in levels {
        starts[usize::from(*level) + 1] += 1;
    }
    for i in 0..LEVELS {
        starts[i + 1] += starts[i];
    }
    let mut order = vec![0u32; levels.len()];
    for (pixel, level) in levels.iter().enumerate() {
        let place = &mut starts[usize::from(*level)];
        order[*place] = pixel as u32;
        *place += 1;
    }
    order
}

/// Sums over the pixels of a growing region.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: u32,
    border: bool,
    x: i64,
    y: i64,
    xx: i64,
    xy: i64,
    yy: i64,
}

/// Disjoint sets of joined pixels.
struct Forest {
    width: usize,
    height: usize,
    parent: Vec<u32>,
    sums: Vec<Sums>,
}

/// Parent of pixels that have not joined yet.
const ALONE: u32 = u32::MAX;

impl Forest {
    fn new(width: usize, height: usize) -> Self {
        let count = width * height;
        Self { width, height, parent: vec![ALONE; count], sums: vec![Sums::default(); count] }
    }

    fn root(&mut self, pixel: usize) -> usize {
        let mut at = pixel;
        while self.parent[at] as usize != at {
            self.parent[at] = self.parent[self.parent[at] as usize];
            at = self.parent[at] as usize;
        }
        at
    }

    fn add(&mut self, pixel: usize, found: &mut Vec<Region>) {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let border = x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height;
        self.parent[pixel] = pixel as u32;
        let (i, j) = (x as i64, y as i64);
        self.sums[pixel] = Sums { count: 1, border, x: i, y: j, xx: i * i, xy: i * j, yy: j * j };
        if x > 0 {
            self.join(pixel, pixel - 1, found);
        }
        if x + 1 < self.width {
            self.join(pixel, pixel + 1, found);
        }
        if y > 0 {
            self.join(pixel, pixel - self.width, found);
        }
        if y + 1 < self.height {
            self.join(pixel, pixel + self.width, found);
        }
    }

    fn join(&mut self, one: usize, two: usize, found: &mut Vec<Region>) {
        if self.parent[two] == ALONE {
            return;
        }
        let (one, two) = (self.root(one), self.root(two));
        if one == two {
            return;
        }
        let (a, b) = (self.sums[one], self.sums[two]);
        if a.count >= SMALLEST && b.count >= SMALLEST {
            let largest = LARGEST * (self.width * self.height) as f64;
            found.extend([a, b].into_iter().filter_map(|sums| region(&sums, largest)));
        }
        let (large, small) = if a.count >= b.count { (one, two) } else { (two, one) };
        self.parent[small] = large as u32;
        self.sums[large] = Sums {
            count: a.count + b.count,
            border: a.border || b.border,
            x: a.x + b.x,
            y: a.y + b.y,
            xx: a.xx + b.xx,
            xy: a.xy + b.xy,
            yy: a.yy + b.yy,
        };
    }
}

/// The region, when it has about the shape of a parallelogram.
fn region(sums: &Sums, largest: f64) -> Option<Region> {
    let n = f64::from(sums.count);
    if sums.border || n > largest {
        return None;
    }
    let centre = [sums.x as f64 / n, sums.y as f64 / n];
    // A pixel is a square with a variance of its own.
    let xx = sums.xx as f64 / n - centre[0] * centre[0] + 1.0 / 12.0;
    let yy = sums.yy as f64 / n - centre[1] * centre[1] + 1.0 / 12.0;
    let xy = sums.xy as f64 / n - centre[0] * centre[1];
    let (det, half_trace) = (xx * yy - xy * xy, (xx + yy) / 2.0);
    let compactness = n / (12.0 * det.max(1e-9).sqrt());
    let root = (half_trace * half_trace - det).max(0.0).sqrt();
    let stretched = half_trace + root > STRETCH * STRETCH * (half_trace - root);
    (compactness > COMPACTNESS[0] && compactness < COMPACTNESS[1] && !stretched).then_some(Region {
        centre,
        covariance: [xx, xy, yy],
        area: n,
    })
}

/// A patch is seen several times while it grows: the largest of them stays.
fn without_doubles(mut found: Vec<Region>) -> Vec<Region> {
    found.sort_by(|a, b| {
        let place = |r: &Region| r.centre[1] * 1e6 + r.centre[0];
        b.area.total_cmp(&a.area).then(place(a).total_cmp(&place(b)))
    });
    let cell = 8.0;
    let key = |p: [f64; 2]| ((p[0] / cell) as i32, (p[1] / cell) as i32);
    let mut places: std::collections::HashMap<(i32, i32), Vec<usize>> = std::collections::HashMap::new();
    let mut kept: Vec<Region> = Vec::new();
    for region in found {
        let reach = 0.25 * region.area.sqrt();
        let ((x0, y0), (x1, y1)) = (
            key([region.centre[0] - reach, region.centre[1] - reach]),
            key([region.centre[0] + reach, region.centre[1] + reach]),
        );
        let is_double = (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| (x, y))).any(|at| {
            places.get(&at).is_some_and(|near| {
                near.iter().any(|i| {
                    let other = &kept[*i];
                    let distance =
                        (other.centre[0] - region.centre[0]).hypot(other.centre[1] - region.centre[1]);
                    distance < reach && other.area < 2.0 * region.area
                })
            })
        });
        if !is_double {
            places.entry(key(region.centre)).or_default().push(kept.len());
            kept.push(region);
        }
    }
    kept
}
