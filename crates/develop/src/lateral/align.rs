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

use super::taps::Taps;
use super::{CELL, Lateral};
use crate::stage::{Stage, WhenSmaller};

/// Pixels that are looked at besides those that a displacement leads to: four for differences, two for green between pixels,
/// three for green at red and blue.
const AROUND: usize = 9;
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
                    (margins[0], -1.0),
                    #[inline(always)]
                    |(x, y): (usize, usize), count: usize, taps: &Taps| {
                        let (at, site) = (y * size.width + x, y / 2 * columns + x / 2);
                        let shifted = taps.run::<2>(green, size.width, (at, count));
                        for (k, green) in shifted.iter().enumerate().take(count) {
                            own[site + k] = samples[at + 2 * k];
                            differences[site + k] = samples[at + 2 * k] - green;
                        }
                    },
                );
                sites.for_each_run(
                    (margins[1], 0.5),
                    #[inline(always)]
                    |(x, y): (usize, usize), count: usize, taps: &Taps| {
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
    /// many, and the taps of so many times their displacement. Cells are those of the frame, so that tiles agree.
    #[inline(always)]
    fn for_each_run(&self, (margin, times): (usize, f64), mut run: impl FnMut((usize, usize), usize, &Taps)) {
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
                let taps = Taps::of(by.map(|v| times * v));
                for y in (top..below).step_by(2) {
                    run((x, y), count, &taps);
                }
                x += 2 * count;
            }
            top += 2 * (below - top).div_ceil(2);
        }
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
