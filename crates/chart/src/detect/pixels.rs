//! Pictures to search in.

use rayon::prelude::*;

/// A picture of linear light in any scale and any camera's red, green and blue. Rows follow one another without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchImage {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue: `width * height` values each.
    pub planes: [Vec<f32>; 3],
}

impl SearchImage {
    /// The picture without values that are no light; `None` when the planes do not have its size.
    pub(super) fn checked(&self) -> Option<Self> {
        let count = self.width.checked_mul(self.height)?;
        if count == 0 || self.planes.iter().any(|p| p.len() != count) {
            return None;
        }
        let light = |v: &f32| if v.is_finite() { v.clamp(0.0, 1e12) } else { 0.0 };
        let planes = self.planes.each_ref().map(|plane| plane.par_iter().map(light).collect());
        Some(Self { width: self.width, height: self.height, planes })
    }

    /// Value at a point between pixels, bilinear; the border continues outwards.
    pub(super) fn at(&self, channel: usize, x: f64, y: f64) -> f32 {
        bilinear(&self.planes[channel], self.width, self.height, x, y)
    }
}

/// A picture made smaller by averaging squares of pixels, each channel scaled so that its brightest light is about 1.
#[derive(Debug, Clone)]
pub(super) struct Reduced {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) planes: [Vec<f32>; 3],
    /// Pixels of the picture along a side of one pixel here.
    pub(super) factor: usize,
}

/// This share of the pixels, the brightest, counts as lamps and reflections that are brighter than the picture's white.
const BRIGHTEST: f64 = 0.005;

impl Reduced {
    /// `None` when nothing is left or a channel is black.
    pub(super) fn of(picture: &SearchImage, factor: usize) -> Option<Self> {
        let (width, height) = (picture.width / factor, picture.height / factor);
        if width == 0 || height == 0 {
            return None;
        }
        let share = 1.0 / (factor * factor) as f32;
        let mut planes = picture.planes.each_ref().map(|plane| {
            let mut small = vec![0.0f32; width * height];
            small.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
                for line in plane.chunks_exact(picture.width).skip(y * factor).take(factor) {
                    for (sum, pixels) in row.iter_mut().zip(line.chunks_exact(factor)) {
                        *sum += pixels.iter().sum::<f32>() * share;
                    }
                }
            });
            small
        });
        for plane in &mut planes {
            let white = white(plane);
            if white <= 0.0 {
                return None;
            }
            plane.par_iter_mut().for_each(|v| *v /= white);
        }
        Some(Self { width, height, planes, factor })
    }

    /// Whether a point lies on the picture.
    pub(super) fn holds(&self, [x, y]: [f64; 2]) -> bool {
        x >= 0.0 && y >= 0.0 && x <= (self.width - 1) as f64 && y <= (self.height - 1) as f64
    }

    /// Value at a point between pixels, bilinear.
    pub(super) fn at(&self, channel: usize, x: f64, y: f64) -> f32 {
        bilinear(&self.planes[channel], self.width, self.height, x, y)
    }
}

fn white(plane: &[f32]) -> f32 {
    let step = (plane.len() / 100_000).max(1);
    let mut some: Vec<f32> = plane.iter().copied().step_by(step).collect();
    let rank = (some.len() as f64 * (1.0 - BRIGHTEST)) as usize;
    let rank = rank.min(some.len() - 1);
    *some.select_nth_unstable_by(rank, f32::total_cmp).1
}

fn bilinear(plane: &[f32], width: usize, height: usize, x: f64, y: f64) -> f32 {
    let (x, y) = (x.clamp(0.0, (width - 1) as f64), y.clamp(0.0, (height - 1) as f64));
    let (x0, y0) = (x as usize, y as usize);
    let (x1, y1) = ((x0 + 1).min(width - 1), (y0 + 1).min(height - 1));
    let (fx, fy) = ((x - x0 as f64) as f32, (y - y0 as f64) as f32);
    let row = |y: usize| plane[y * width + x0] * (1.0 - fx) + plane[y * width + x1] * fx;
    row(y0) * (1.0 - fy) + row(y1) * fy
}
