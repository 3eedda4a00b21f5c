//! A picture in small cells, beside another one.

use darkroot_colour::{Oklab, TransferCurve, Vector3, Xyz};
use darkroot_photo::{Picture, PictureSpace, Samples, Size};

/// Light below which a row or column belongs to a border, linear: 8 of 255 coded.
const BORDER: f32 = 0.0025;
/// Share of a side that borders may have.
const WIDEST: f64 = 0.3;
/// Pixels along a cell, at least.
const CELL: usize = 4;
/// Cells along the longer side.
const CELLS: std::ops::RangeInclusive<usize> = 20..=96;
/// Largest difference of shapes: width over height of one, over that of the other.
const SHAPE: f64 = 1.25;
/// Share of the cells that count as calm.
const CALM: f64 = 0.6;

/// Linear light of sRGB.
#[derive(Debug, Clone)]
struct Light {
    size: Size,
    pixels: Vec<[f32; 3]>,
}

/// Colours of the cells of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    columns: usize,
    /// L*, and a and b of Oklab, of each, row by row.
    cells: Vec<[f64; 3]>,
}

/// The whole of a picture, less its borders, from which cells are made.
#[derive(Debug, Clone)]
pub struct Whole(Light);

impl Cells {
    /// Prepares a preview: what the camera rendered, without black borders.
    pub fn of_whole(picture: &Picture) -> Whole {
        Whole(Light::of(picture).without_borders())
    }

    /// Lightness of cells without contrast of their own, in both.
    pub(super) fn calm_pairs(&self, other: &Self) -> Vec<[f64; 2]> {
        self.calm(other).map(|i| [self.cells[i][0], other.cells[i][0]]).collect()
    }

    /// Colours (a and b of Oklab) of the same cells, where they are neither nearly black nor nearly white.
    pub(super) fn calm_colours(&self, other: &Self) -> Vec<[[f64; 2]; 2]> {
        let lit = |v: f64| (15.0..95.0).contains(&v);
        let both = move |i: &usize| lit(self.cells[*i][0]) && lit(other.cells[*i][0]);
        let colour = |cell: [f64; 3]| [cell[1], cell[2]];
        self.calm(other).filter(both).map(|i| [colour(self.cells[i]), colour(other.cells[i])]).collect()
    }

    fn calm(&self, other: &Self) -> impl Iterator<Item = usize> {
        let contrast: Vec<f64> =
            (0..self.cells.len()).map(|i| self.contrast(i).max(other.contrast(i))).collect();
        let mut sorted = contrast.clone();
        sorted.sort_by(f64::total_cmp);
        let limit = sorted.get((CALM * sorted.len() as f64) as usize).copied().unwrap_or(f64::MAX);
        (0..contrast.len()).filter(move |i| contrast[*i] <= limit)
    }

    /// Largest difference in lightness from a cell to those beside it.
    fn contrast(&self, i: usize) -> f64 {
        let x = i % self.columns;
        let beside = [
            (x > 0).then(|| i - 1),
            (x + 1 < self.columns).then(|| i + 1),
            i.checked_sub(self.columns),
            Some(i + self.columns),
        ];
        let of = |j: usize| self.cells.get(j).map_or(0.0, |cell| (cell[0] - self.cells[i][0]).abs());
        beside.into_iter().flatten().map(of).fold(0.0, f64::max)
    }
}

impl Whole {
    /// Cells of another picture of the same scene, and of this one: as large a part of both as has one shape, from the middle.
    /// `None` where shapes differ too much or one is too small.
    pub fn beside(&self, picture: &Picture) -> Option<(Cells, Cells)> {
        let ours = Light::of(picture);
        let shape = |light: &Light| light.size.width as f64 / light.size.height.max(1) as f64;
        let (a, b) = (shape(&ours), shape(&self.0));
        if a / b > SHAPE || b / a > SHAPE {
            return None;
        }
        let common = a.min(b);
        let across = ours.size.width.min(self.0.size.width) / CELL;
        let columns = across.min(*CELLS.end());
        let rows = (columns as f64 / common).round() as usize;
        if columns.max(rows) < *CELLS.start() || rows == 0 {
            return None;
        }
        Some((ours.cells(common, columns, rows), self.0.cells(common, columns, rows)))
    }
}

impl Light {
    /// Of a picture of linear sRGB in floating point; black of any other.
    fn of(picture: &Picture) -> Self {
        let is_linear = matches!(picture.space, PictureSpace::Rgb(space) if space == space.linear());
        let pixels = match &picture.samples {
            Samples::F32(samples) if is_linear => samples.as_chunks::<3>().0.to_vec(),
            _ => vec![[0.0; 3]; picture.size.area()],
        };
        Self { size: picture.size, pixels }
    }

    /// Less rows and columns at the edges in which nothing is lit.
    fn without_borders(self) -> Self {
        let Size { width, height } = self.size;
        let lit = |x: usize, y: usize| self.pixels[y * width + x].iter().any(|v| *v > BORDER);
        let row = |y: &usize| (0..width).any(|x| lit(x, *y));
        let column = |x: &usize| (0..height).any(|y| lit(*x, y));
        let most = |side: usize| (WIDEST * side as f64) as usize;
        let top = (0..most(height)).find(row).unwrap_or(0);
        let bottom = (height - most(height)..height).rev().find(row).map_or(height, |y| y + 1);
        let left = (0..most(width)).find(column).unwrap_or(0);
        let right = (width - most(width)..width).rev().find(column).map_or(width, |x| x + 1);
        let rows =
            (top..bottom).flat_map(|y| self.pixels[y * width + left..y * width + right].iter().copied());
        Self { size: Size { width: right - left, height: bottom - top }, pixels: rows.collect() }
    }

    /// Means of cells over the middle part that has this shape.
    fn cells(&self, shape: f64, columns: usize, rows: usize) -> Cells {
        let (width, height) = (self.size.width as f64, self.size.height as f64);
        let (used_width, used_height) =
            if width / height > shape { (height * shape, height) } else { (width, width / shape) };
        let (left, top) = (0.5 * (width - used_width), 0.5 * (height - used_height));
        let span = |i: usize, n: usize, start: f64, used: f64, end: usize| {
            let at = |i: usize| ((start + used * i as f64 / n as f64).round() as usize).min(end);
            at(i)..at(i + 1).max(at(i) + 1).min(end)
        };
        let cell = |i: usize| {
            let xs = span(i % columns, columns, left, used_width, self.size.width);
            let ys = span(i / columns, rows, top, used_height, self.size.height);
            let mut sum = [0f64; 3];
            let mut n = 0;
            for y in ys {
                for pixel in &self.pixels[y * self.size.width..][xs.clone()] {
                    for (sum, v) in sum.iter_mut().zip(pixel) {
                        *sum += f64::from(*v);
                    }
                    n += 1;
                }
            }
            seen(sum.map(|v| v / f64::from(n.max(1))))
        };
        Cells { columns, cells: (0..columns * rows).map(cell).collect() }
    }
}

/// L*, a and b of linear sRGB.
fn seen(rgb: [f64; 3]) -> [f64; 3] {
    let space = darkroot_colour::RgbSpace::SRGB;
    let xyz = space.to_xyz() * Vector3::from(rgb);
    let lightness = 100.0 * TransferCurve::LStar.encode(xyz[1].clamp(0.0, 1.0));
    let colour = Oklab::of(Xyz::from(space.to_xyz_under(darkroot_colour::white::D65) * Vector3::from(rgb)));
    [lightness, colour.a, colour.b]
}
