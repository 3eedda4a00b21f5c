//! Brings red and blue of a mosaic to where green is, before colours are interpolated: interpolation lets fine detail of red
//! and blue follow green, so afterwards half of a displacement could no longer be told from the rest.
//!
//! Red that belongs to green at x lies at x + d(x). Where there is a red sample, its difference to the green that belongs to
//! it, at x - d(x), is what is smooth in most pictures (Cok, US patent 4642678, 1987, has the hue that way). These differences
//! are interpolated at the right places and added to green. Green samples stay as they are, and where red is green there is
//! nothing to interpolate. What comes of it stays within the red samples around the place: green that is clipped, or a line too
//! thin for its samples, differs from red by anything.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Filter, Layout, Mosaic, Size};

use super::shift::cubic;
use super::{CELL, Lateral};
use crate::cones::{greater, lesser};
use crate::stage::{Stage, WhenSmaller};

/// Pixels that are looked at besides those that a displacement leads to: four for differences, two for green between pixels,
/// three for green at red and blue.
const AROUND: usize = 9;
/// Most places of a colour side by side in a cell, and columns that are looked at for them.
const RUN: usize = CELL / 2;
const WIDE: usize = 2 * RUN + 4;
/// Steps of green below which both directions count alike, squared.
const EVEN: f32 = 1e-12;

/// What a thread works in.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    green: Vec<f32>,
    /// By colour, in every second column and row from its first one on.
    differences: Vec<f32>,
    /// The samples themselves, likewise.
    own: Vec<f32>,
}

/// What it asks of a tile.
pub(crate) fn stage(lateral: &Lateral) -> Stage {
    Stage { name: "lateral", border: 2 * lateral.most + AROUND, when_smaller: WhenSmaller::Same }
}

/// Brings red and blue of a Bayer mosaic, whose first sample lies in column and row `begin` of the frame, to where green is.
/// The outermost pixels, as [`stage`] says, are left as they are.
pub(crate) fn align(
    mosaic: &mut Mosaic<f32>,
    begin: (isize, isize),
    lateral: &Lateral,
    scratch: &mut Scratch,
) {
    let Layout::Cfa(cfa) = &mosaic.layout else { return };
    let size = mosaic.size;
    let margins = [5 + lateral.most, stage(lateral).border];
    if size.width <= 2 * margins[1] || size.height <= 2 * margins[1] {
        return;
    }
    let colours = [Filter::Red, Filter::Blue].map(|filter| cfa.first(filter).unwrap_or_default());
    greens(&mosaic.samples, size, colours, &mut scratch.green);
    for (colour, first) in [0, 2].into_iter().zip(colours) {
        if !lateral.moves(colour) {
            continue;
        }
        let sites = Sites { size, first, begin, lateral, colour };
        let columns = size.width.div_ceil(2);
        let (green, differences, own) = (&scratch.green, &mut scratch.differences, &mut scratch.own);
        for plane in [&mut *differences, own] {
            plane.clear();
            plane.resize(columns * size.height.div_ceil(2), 0.0);
        }
        let samples = &mut mosaic.samples;
        vectorised(
            #[inline(always)]
            || {
                sites.for_each_run(
                    margins[0],
                    #[inline(always)]
                    |(x, y): (usize, usize), count: usize, [dx, dy]: [f64; 2]| {
                        let taps = Taps::of([-dx, -dy]);
                        let (at, site) = (y * size.width + x, y / 2 * columns + x / 2);
                        let shifted = taps.run::<2>(green, size.width, (at, count));
                        for (k, green) in shifted.iter().enumerate().take(count) {
                            own[site + k] = samples[at + 2 * k];
                            differences[site + k] = samples[at + 2 * k] - green;
                        }
                    },
                );
                sites.for_each_run(
                    margins[1],
                    #[inline(always)]
                    |(x, y): (usize, usize), count: usize, [dx, dy]: [f64; 2]| {
                        let taps = Taps::of([0.5 * dx, 0.5 * dy]);
                        let (at, site) = (y * size.width + x, y / 2 * columns + x / 2);
                        let shifted = taps.run::<1>(differences, columns, (site, count));
                        let (least, most) = taps.ranges(own, columns, (site, count));
                        for k in 0..count {
                            let sample = green[at + 2 * k] + shifted[k];
                            samples[at + 2 * k] = sample.max(least[k]).min(most[k]);
                        }
                    },
                );
            },
        );
    }
}

/// The places of one colour in a mosaic.
struct Sites<'a> {
    size: Size,
    /// Column and row of the first one: 0 or 1.
    first: (usize, usize),
    begin: (isize, isize),
    lateral: &'a Lateral,
    colour: usize,
}

impl Sites<'_> {
    /// Calls `run` for places side by side in a cell of the frame, every second column: column and row of the first one, how
    /// many, and their displacement. Cells are those of the frame, so that tiles agree.
    #[inline(always)]
    fn for_each_run(&self, margin: usize, mut run: impl FnMut((usize, usize), usize, [f64; 2])) {
        let cell = CELL as isize;
        // The cell of a column or row, and the first column or row behind it.
        let of = |at: usize, begin: isize| (at as isize + begin).div_euclid(cell);
        let end =
            |cell_at: isize, begin: isize, most: usize| (((cell_at + 1) * cell - begin) as usize).min(most);
        let start = |first: usize| margin + (margin + first) % 2;
        let (right, bottom) = (self.size.width - margin, self.size.height - margin);
        let mut top = start(self.first.1);
        while top < bottom {
            let row = of(top, self.begin.1);
            let below = end(row, self.begin.1, bottom);
            let mut x = start(self.first.0);
            while x < right {
                let column = of(x, self.begin.0);
                let count = (end(column, self.begin.0, right) - x).div_ceil(2);
                let by = self.lateral.of_cell(self.colour, column, row);
                for y in (top..below).step_by(2) {
                    run((x, y), count, by);
                }
                x += 2 * count;
            }
            top += 2 * (below - top).div_ceil(2);
        }
    }
}

/// Weights of the 4 x 4 values that a value at a distance is made of.
struct Taps {
    left: isize,
    top: isize,
    across: [f32; 4],
    down: [f32; 4],
}

impl Taps {
    fn of(by: [f64; 2]) -> Self {
        let [(left, across, _), (top, down, _)] = by.map(cubic);
        Self { left, top, across, down }
    }

    /// The value at the distance from one, in rows of this width.
    #[inline(always)]
    fn at(&self, values: &[f32], width: usize, at: usize) -> f32 {
        let first = at as isize + self.left + self.top * width as isize;
        let mut sums = [0f32; 4];
        for (j, weight) in self.down.iter().enumerate() {
            let row = &values[first as usize + j * width..][..4];
            for (sum, v) in sums.iter_mut().zip(row) {
                *sum += weight * v;
            }
        }
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.across[i] * sums[i]);
        (a + d) + (b + c)
    }

    /// As [`Self::at`] for so many values from one on, `STEP` apart. What columns have is shared by neighbours.
    #[inline(always)]
    fn run<const STEP: usize>(
        &self,
        values: &[f32],
        width: usize,
        (at, count): (usize, usize),
    ) -> [f32; RUN] {
        let mut out = [0f32; RUN];
        let first = (at as isize + self.left + self.top * width as isize) as usize;
        let Some(rows) = values.get(first..first + 3 * width + WIDE) else {
            for (k, out) in out.iter_mut().enumerate().take(count) {
                *out = self.at(values, width, at + STEP * k);
            }
            return out;
        };
        let mut sums = [0f32; WIDE];
        for (j, weight) in self.down.iter().enumerate() {
            for (sum, v) in sums.iter_mut().zip(&rows[j * width..][..WIDE]) {
                *sum += weight * v;
            }
        }
        // Written out: as a closure over four it is done one by one.
        let [a, b, c, d] = self.across;
        for (k, out) in out.iter_mut().enumerate() {
            let at = STEP * k;
            *out = (a * sums[at] + d * sums[at + 3]) + (b * sums[at + 1] + c * sums[at + 2]);
        }
        out
    }

    /// As [`Self::range`] for so many values side by side, from one on.
    #[inline(always)]
    fn ranges(&self, values: &[f32], width: usize, (at, count): (usize, usize)) -> ([f32; RUN], [f32; RUN]) {
        let (mut least, mut most) = ([0f32; RUN], [0f32; RUN]);
        let first = (at as isize + self.left + self.top * width as isize) as usize;
        let Some(rows) = values.get(first..first + 3 * width + RUN + 4) else {
            for k in 0..count {
                (least[k], most[k]) = self.range(values, width, at + k);
            }
            return (least, most);
        };
        let (mut low, mut high) = ([f32::INFINITY; RUN + 4], [f32::NEG_INFINITY; RUN + 4]);
        for j in 0..4 {
            for ((low, high), &v) in low.iter_mut().zip(&mut high).zip(&rows[j * width..][..RUN + 4]) {
                *low = if v < *low { v } else { *low };
                *high = if v > *high { v } else { *high };
            }
        }
        for k in 0..RUN {
            least[k] = lesser(lesser(low[k], low[k + 1]), lesser(low[k + 2], low[k + 3]));
            most[k] = greater(greater(high[k], high[k + 1]), greater(high[k + 2], high[k + 3]));
        }
        (least, most)
    }

    /// The smallest and the largest of the values that [`Self::at`] looks at.
    #[inline(always)]
    fn range(&self, values: &[f32], width: usize, at: usize) -> (f32, f32) {
        let first = at as isize + self.left + self.top * width as isize;
        let (mut least, mut most) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
        for j in 0..4 {
            let row = &values[first as usize + j * width..][..4];
            for ((least, most), &v) in least.iter_mut().zip(&mut most).zip(row) {
                *least = if v < *least { v } else { *least };
                *most = if v > *most { v } else { *most };
            }
        }
        let fold = |[a, b, c, d]: [f32; 4], of: fn(f32, f32) -> f32| of(of(a, b), of(c, d));
        (fold(least, f32::min), fold(most, f32::max))
    }
}

/// Green everywhere: at red and blue from the four along the row and along the column, by cubic interpolation; the more even
/// direction counts more. Red and blue have no say, because they lie elsewhere.
fn greens(samples: &[f32], size: Size, colours: [(usize, usize); 2], green: &mut Vec<f32>) {
    let width = size.width;
    green.clear();
    green.extend_from_slice(samples);
    vectorised(
        #[inline(always)]
        || {
            for y in 3..size.height - 3 {
                let first = colours.iter().find(|(_, row)| row % 2 == y % 2).map_or(0, |(column, _)| *column);
                for x in (3 + (3 + first) % 2..width - 3).step_by(2) {
                    let at = y * width + x;
                    let along = |step: usize| {
                        let [a, b, c, d] = [
                            samples[at - 3 * step],
                            samples[at - step],
                            samples[at + step],
                            samples[at + 3 * step],
                        ];
                        let uneven = (c - b).abs() + 0.5 * ((b - a).abs() + (d - c).abs());
                        (0.5625 * (b + c) - 0.0625 * (a + d), uneven * uneven + EVEN)
                    };
                    let ((h, uneven_h), (v, uneven_v)) = (along(1), along(width));
                    green[at] = (h * uneven_v + v * uneven_h) / (uneven_h + uneven_v);
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use darkroot_photo::Cfa;

    use super::super::Radial;
    use super::*;

    #[test]
    fn a_run_is_what_its_values_are_to_the_bit() {
        let mut random = 1u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as f32 / (1 << 24) as f32
        };
        let (width, height) = (61, 23);
        let values: Vec<f32> = (0..width * height).map(|_| next()).collect();
        for by in [[0.0, 0.0], [0.3, -0.8], [-2.6, 1.4], [1.999, 2.5]] {
            let taps = Taps::of(by);
            for (row, column, count) in [(6, 6, 8), (11, 20, 3), (15, 40, 8), (17, 47, 1), (17, 44, 5)] {
                let at = row * width + column;
                let (one, two) =
                    (taps.run::<1>(&values, width, (at, count)), taps.run::<2>(&values, width, (at, count)));
                let (least, most) = taps.ranges(&values, width, (at, count));
                for k in 0..count {
                    assert_eq!(one[k].to_bits(), taps.at(&values, width, at + k).to_bits());
                    assert_eq!(two[k].to_bits(), taps.at(&values, width, at + 2 * k).to_bits());
                    let range = taps.range(&values, width, at + k);
                    assert_eq!(
                        (least[k].to_bits(), most[k].to_bits()),
                        (range.0.to_bits(), range.1.to_bits())
                    );
                }
            }
        }
    }

    #[test]
    fn no_red_is_invented_beside_green_that_is_clipped() {
        let size = Size { width: 96, height: 80 };
        let cfa = Cfa::parse("GRBG").unwrap();
        // A dark twig, between whose reds green sees a sky that it clips.
        let light = |x: usize, y: usize| {
            let twig = (x + y / 5).is_multiple_of(11) || (3 * y + x).is_multiple_of(23);
            match cfa.at(x, y) {
                Filter::Red => [0.9, 0.4][usize::from(twig)],
                Filter::Green => [1.0, 0.1][usize::from(twig)],
                _ => [1.0, 0.3][usize::from(twig)],
            }
        };
        let samples = (0..size.area()).map(|at| light(at % size.width, at / size.width)).collect();
        let before = Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples };
        let lateral = Lateral {
            centre: [48.0, -400.0],
            reach: 400.0,
            channels: [Some(Radial([1.3, 0.0, 0.0])), Some(Radial([-0.7, 0.0, 0.0]))],
            most: 2,
        };
        let mut after = before.clone();
        align(&mut after, (0, 0), &lateral, &mut Scratch::default());
        let changed =
            before.samples.iter().zip(&after.samples).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert!(changed > 200, "{changed}");
        for (at, &sample) in after.samples.iter().enumerate() {
            let range = match cfa.at(at % size.width, at / size.width) {
                Filter::Red => 0.4..=0.9,
                Filter::Green => 0.1..=1.0,
                _ => 0.3..=1.0,
            };
            assert!(range.contains(&sample), "{at}: {sample}");
        }
    }
}
