//! The colour that a picture has where it is not clipped, continued into where it is.
//!
//! Blocks (`survey.rs`) without a clipped sample give their colour, bright ones more than dark ones, because light that
//! runs into clipping is bright before it does. It spreads into the clipped ones from all sides, smoothly and however far
//! that is: means over ever larger squares, of which each place takes the smallest that knows something. Blocks of which
//! one channel is clipped know from the other two how strong their colour is; they hand that on to those inside.

use rayon::prelude::*;

use crate::highlights::rebuilt;
use crate::survey::{Block, Survey};

/// Light as a share of clipping below which a block tells nothing.
const DARK: f32 = 0.6;
/// Mean light of a channel, as a share of its limit, that is clipped all over a block.
const ALL_OVER: f32 = 0.95;
/// Weight of grey where nothing else is known.
const NOTHING: f32 = 3e-4;
/// Rows that one task goes on with.
const ROWS: usize = 16;

/// Balanced colours, mean 1, on a grid over the active area.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClippedColours {
    /// Top left of the active area, in pixels of the frame.
    corner: (usize, usize),
    /// Pixels along the side of a block.
    side: usize,
    grid: Grid,
}

impl ClippedColours {
    /// From the blocks of a frame whose active area begins at `corner`, balanced by multipliers.
    pub(crate) fn of(survey: &Survey, corner: (usize, usize), multipliers: [f32; 3]) -> Self {
        if !survey.blocks.iter().any(|b| b.clipped.contains(&true)) {
            return Self::default();
        }
        let limits = [0, 1, 2].map(|c| multipliers[c] * survey.saturation[c]);
        let balanced = |b: &Block| [0, 1, 2].map(|c| (b.mean[c] * multipliers[c]).max(0.0));
        let seen: Vec<[f32; 3]> = survey.blocks.iter().map(balanced).collect();
        let whole = |b: &Block, seen: &[f32; 3]| match b.clipped {
            [false, false, false] => weighted(*seen, limits),
            _ => UNKNOWN,
        };
        let known = survey.blocks.iter().zip(&seen).map(|(b, seen)| whole(b, seen));
        let first = Grid { columns: survey.columns, cells: known.collect() }.continued();
        // Once more, with what the blocks know of which one channel is clipped.
        let known = survey.blocks.iter().zip(&seen).enumerate().map(|(i, (b, seen))| {
            let mut channels = (0..3).filter(|&c| b.clipped[c]);
            match (channels.next(), channels.next()) {
                // All over: at the edge of a reflex the mean is that of two things.
                (Some(c), None) if seen[c] > ALL_OVER * limits[c] => weighted(
                    rebuilt(clipped(*seen, b.clipped, limits), limits, first.cells[i].colour()),
                    limits,
                ),
                _ => whole(b, seen),
            }
        });
        let grid = Grid { columns: survey.columns, cells: known.collect() }.continued();
        Self { corner, side: survey.side, grid }
    }

    /// The colour for a pixel of the frame; grey where nothing is clipped anywhere.
    pub(crate) fn at(&self, x: isize, y: isize) -> [f32; 3] {
        if self.grid.cells.is_empty() {
            return [1.0; 3];
        }
        let place = |at: isize, corner: usize| ((at - corner as isize) as f32 + 0.5) / self.side as f32 - 0.5;
        self.grid.between(place(x, self.corner.0), place(y, self.corner.1)).colour()
    }
}

/// The mean of a block in which a channel is clipped, as if all its samples were.
fn clipped(seen: [f32; 3], clipped: [bool; 3], limits: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|c| if clipped[c] { limits[c] } else { seen[c] })
}

/// A colour of mean 1 times its weight, and the weight.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell([f32; 4]);

const UNKNOWN: Cell = Cell([0.0; 4]);

/// The colour of a block, and how much it counts.
fn weighted(seen: [f32; 3], limits: [f32; 3]) -> Cell {
    let mean = (seen[0] + seen[1] + seen[2]) / 3.0;
    let share = (0..3).map(|c| seen[c] / limits[c]).fold(0.0, f32::max);
    let bright = ((share - DARK) / (1.0 - DARK)).clamp(0.0, 1.0);
    if bright <= 0.0 {
        return UNKNOWN;
    }
    let weight = bright * bright;
    let [r, g, b] = seen.map(|v| v / mean * weight);
    Cell([r, g, b, weight])
}

impl Cell {
    fn colour(self) -> [f32; 3] {
        let Self([r, g, b, weight]) = self;
        // Grey has the mean 1, too.
        [r, g, b].map(|v| (v + NOTHING) / (weight + NOTHING))
    }

    fn plus(self, other: Self, share: f32) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self([a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2], a[3] + share * b[3]])
    }
}

/// Cells in rows.
#[derive(Debug, Clone, PartialEq, Default)]
struct Grid {
    columns: usize,
    cells: Vec<Cell>,
}

impl Grid {
    fn rows(&self) -> usize {
        self.cells.len() / self.columns.max(1)
    }

    /// Every cell with what it lacks of a weight of 1 from the squares around it.
    fn continued(self) -> Self {
        if self.cells.len() <= 1 {
            return self;
        }
        let coarse = self.halved().continued();
        let Self { columns, mut cells } = self;
        let half = |i: usize| (i as f32 - 0.5) / 2.0;
        cells.par_chunks_mut(columns).with_min_len(ROWS).enumerate().for_each(|(y, row)| {
            for (x, cell) in row.iter_mut().enumerate() {
                let Cell([.., weight]) = *cell;
                let lacks = (1.0 - weight).max(0.0);
                *cell = cell.plus(coarse.between(half(x), half(y)), lacks);
            }
        });
        Self { columns, cells }
    }

    /// Four cells as one, whose weight is their sum, at most 1: what is known is known however large the square.
    fn halved(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows().div_ceil(2));
        let mut cells = vec![UNKNOWN; columns * rows];
        for (y, row) in self.cells.chunks(self.columns).enumerate() {
            let sums = &mut cells[y / 2 * columns..][..columns];
            for (sum, pair) in sums.iter_mut().zip(row.chunks(2)) {
                *sum = pair.iter().fold(*sum, |sum, cell| sum.plus(*cell, 1.0));
            }
        }
        for cell in &mut cells {
            let [.., weight] = cell.0;
            *cell = UNKNOWN.plus(*cell, 1.0 / weight.max(1.0));
        }
        Self { columns, cells }
    }

    /// The mean of the four cells around a place, by nearness; beyond the edge it goes on as it ends.
    #[inline]
    fn between(&self, x: f32, y: f32) -> Cell {
        let place = |at: f32, count: usize| {
            let at = at.clamp(0.0, (count - 1) as f32);
            let first = at as usize;
            (first, (first + 1).min(count - 1), at - first as f32)
        };
        let (left, right, u) = place(x, self.columns);
        let (top, bottom, v) = place(y, self.rows());
        let row = |y: usize| {
            let at = |x: usize| self.cells[y * self.columns + x];
            UNKNOWN.plus(at(left), 1.0 - u).plus(at(right), u)
        };
        UNKNOWN.plus(row(top), 1.0 - v).plus(row(bottom), v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of one row: the light of each, clipped where it reaches 1.
    fn row(light: &[[f32; 3]]) -> Survey {
        let block = |v: &[f32; 3]| Block { mean: v.map(|v| v.min(1.0)), clipped: v.map(|v| v >= 1.0) };
        Survey {
            columns: light.len(),
            side: 8,
            blocks: light.iter().map(block).collect(),
            saturation: [1.0; 3],
        }
    }

    fn close(a: [f32; 3], b: [f32; 3], bound: f32) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < bound)
    }

    #[test]
    fn a_colour_goes_on_into_what_is_clipped_however_far() {
        let orange = |light: f32| [1.0, 0.6, 0.2].map(|v| v * light);
        let light: Vec<[f32; 3]> = (0..64).map(|i| orange(if i < 8 { 0.9 } else { 20.0 })).collect();
        let colours = ClippedColours::of(&row(&light), (0, 0), [1.0; 3]);
        let wanted = orange(1.0 / 0.6);
        for x in (0..64 * 8).step_by(5) {
            assert!(close(colours.at(x, 3), wanted, 0.05), "{x}: {:?}", colours.at(x, 3));
        }
    }

    #[test]
    fn two_channels_that_are_left_make_a_white_cloud_in_a_blue_sky_white() {
        // Green is clipped in the cloud's edge, everything inside.
        let light: Vec<[f32; 3]> = (0..48)
            .map(|i| match i {
                0..16 => [0.4, 0.7, 0.9],
                16..20 | 44.. => [0.6, 1.1, 0.6],
                _ => [3.0, 3.0, 3.0],
            })
            .collect();
        let colours = ClippedColours::of(&row(&light), (0, 0), [1.0; 3]);
        let inside = colours.at(30 * 8, 3);
        assert!(inside[2] - inside[0] < 0.25, "{inside:?}");
    }

    #[test]
    fn where_nothing_is_clipped_and_where_nothing_is_known_it_is_grey() {
        let plain = ClippedColours::of(&row(&[[0.5, 0.2, 0.2]; 4]), (0, 0), [1.0; 3]);
        assert_eq!(plain.at(9, 3), [1.0; 3]);
        let burnt = ClippedColours::of(&row(&[[5.0; 3]; 4]), (0, 0), [1.0; 3]);
        assert!(close(burnt.at(9, 3), [1.0; 3], 1e-4));
    }
}
