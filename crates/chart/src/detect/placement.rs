//! Which chart a lattice of regions is: every layout is tried in every place and turn, mirrored too, and judged by its
//! colours. One such try is a reading of the lattice.

use std::collections::HashMap;

use super::colours::{Expected, Fit};
use super::lattice::Lattice;
use super::pixels::Reduced;
use crate::{ChartLayout, Homography, Quad};

/// Layouts that differ in their gaps only.
#[derive(Debug, Clone)]
pub(super) struct Family {
    pub(super) layouts: Vec<ChartLayout>,
    pub(super) expected: Expected,
}

impl Family {
    pub(super) fn of(layouts: &[ChartLayout]) -> Vec<Self> {
        let mut families: Vec<Self> = Vec::new();
        for layout in layouts {
            let same = |f: &&mut Self| {
                let other = &f.layouts[0];
                (other.columns, other.rows, &other.patches) == (layout.columns, layout.rows, &layout.patches)
                    && other.hinge == layout.hinge
            };
            if let Some(family) = families.iter_mut().find(same) {
                family.layouts.push(layout.clone());
                continue;
            }
            let colours: Vec<_> = layout.patches.iter().map(|p| p.lab).collect();
            let places: Vec<[f64; 2]> = (0..colours.len())
                .map(|i| [i % layout.columns, i / layout.columns].map(|k| k as f64))
                .collect();
            families.push(Self { layouts: vec![layout.clone()], expected: Expected::new(&colours, &places) });
        }
        families
    }

    /// The first layout of the family; the others differ in their gaps only.
    pub(super) fn layout(&self) -> &ChartLayout {
        &self.layouts[0]
    }

    /// Places of the columns, in steps (from one patch to the next): whole numbers, except behind a hinge.
    pub(super) fn columns(&self) -> Vec<f64> {
        let layout = self.layout();
        (0..layout.columns).map(|c| layout.column_edges(c)[0] / (1.0 + layout.gap)).collect()
    }
}

/// A chart that may be there.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) family: usize,
    /// From the chart's column and row (in steps between patches) to pixels of the picture.
    pub(super) map: Homography,
    pub(super) fill: f64,
    /// Columns and rows less one, in steps.
    extent: [f64; 2],
    pub(super) fit: Fit,
    /// How much the best of all other readings leaves unexplained. Near to `fit`, the reading is ambiguous.
    pub(super) next: f64,
    pub(super) mirrored: bool,
    patches: usize,
    /// Patches that were seen as regions.
    pub(super) seen: usize,
}

impl Candidate {
    /// Larger charts first, if they are explained.
    pub(super) fn rank(&self) -> f64 {
        let quality = (1.0 - 2.0 * self.fit.unexplained()).max(0.0);
        let certainty = if self.mirrored { 0.5 } else { 1.0 };
        certainty
            * quality
            * (self.patches as f64).sqrt()
            * (0.5 + 0.5 * self.seen as f64 / self.patches as f64)
    }

    /// Outer corners of the corner patches.
    pub(super) fn corners(&self) -> Quad {
        let half = self.fill / 2.0;
        let [x, y] = self.extent;
        [[-half, -half], [x + half, -half], [x + half, y + half], [-half, y + half]]
            .map(|p| self.map.apply(p))
    }
}

/// Share of a chart's patches that must have been seen as regions.
const FEWEST_SEEN: f64 = 0.3;
fn fewest_seen(patches: usize) -> usize {
    ((FEWEST_SEEN * patches as f64) as usize).max(7)
}

/// Share of a lattice's regions that must belong to the chart.
const FEWEST_EXPLAINED: f64 = 0.55;
/// Readings worse than this are not looked at again.
const HOPELESS: f64 = 0.68;
/// The four turns of the chart against the lattice, then the same of its mirror image: each is a matrix of two rows
/// that takes a column and row of the chart to those of the lattice.
const TURNS: [[i32; 4]; 8] = [
    [1, 0, 0, 1],
    [0, -1, 1, 0],
    [-1, 0, 0, -1],
    [0, 1, -1, 0],
    [-1, 0, 0, 1],
    [0, -1, -1, 0],
    [1, 0, 0, -1],
    [0, 1, 1, 0],
];

/// The best reading of a lattice for each family of layouts.
pub(super) fn candidates(picture: &Reduced, lattice: &Lattice, families: &[Family]) -> Vec<Candidate> {
    let occupied = Occupied::of(lattice);
    let mut cells = Cells { picture, lattice, occupied, seen: HashMap::new() };
    (0..families.len()).filter_map(|family| best(&mut cells, family, &families[family])).collect()
}

#[derive(Clone, Copy)]
struct Reading {
    turn: [i32; 4],
    mirrored: bool,
    /// Place of the chart's first patch on the lattice.
    origin: [f64; 2],
    fit: Fit,
    seen: usize,
}

fn best(cells: &mut Cells, family: usize, known: &Family) -> Option<Candidate> {
    let layout = known.layout();
    let (members, patches) = (cells.lattice.members.len(), layout.columns * layout.rows);
    if members < fewest_seen(patches) || (patches as f64) < FEWEST_EXPLAINED * members as f64 {
        return None;
    }
    let columns = known.columns();
    let mut best: Option<Reading> = None;
    let mut next = 1.0f64;
    for (number, turn) in TURNS.into_iter().enumerate() {
        // The columns of a folding chart's two leaves are not whole steps apart, so only those of one leaf can lie on
        // the lattice's. Either may be that one.
        for leaf in 0..if layout.hinge.is_some() { 2 } else { 1 } {
            let shift = columns[if leaf == 0 { 0 } else { layout.columns - 1 }].fract();
            for origin in origins(cells.lattice, turn, shift, &columns, layout.rows) {
                let Some(reading) = read(cells, known, &columns, turn, number >= 4, origin) else { continue };
                let unexplained = reading.fit.unexplained();
                match &best {
                    Some(b) if b.fit.unexplained() <= unexplained => next = next.min(unexplained),
                    _ => {
                        next = best.map_or(next, |b| next.min(b.fit.unexplained()));
                        best = Some(reading);
                    }
                }
            }
        }
    }
    let reading = best.filter(|r| r.fit.unexplained() < HOPELESS)?;
    let [a, b, c, d] = reading.turn.map(f64::from);
    let place = nalgebra::Matrix3::new(a, b, reading.origin[0], c, d, reading.origin[1], 0.0, 0.0, 1.0);
    let k = cells.picture.factor as f64;
    let enlarge = Homography::scale_shift([k, k], [0.5 * k - 0.5, 0.5 * k - 0.5]);
    Some(Candidate {
        family,
        map: enlarge.after(&cells.lattice.map).after(&Homography(place)),
        fill: cells.lattice.fill,
        extent: [columns[columns.len() - 1], (layout.rows - 1) as f64],
        fit: reading.fit,
        next,
        mirrored: reading.mirrored,
        patches: layout.columns * layout.rows,
        seen: reading.seen,
    })
}

/// Where on the lattice the chart's first patch may lie.
fn origins(lattice: &Lattice, turn: [i32; 4], shift: f64, columns: &[f64], rows: usize) -> Vec<[f64; 2]> {
    let [a, b, c, d] = turn.map(f64::from);
    let far = [columns[columns.len() - 1], (rows - 1) as f64];
    let range = |k: usize| {
        let values = lattice.members.keys().map(|place| if k == 0 { place.0 } else { place.1 });
        values.fold([i32::MAX, i32::MIN], |m, v| [m[0].min(v), m[1].max(v)])
    };
    let (row_a, row_b) = ([a, b], [c, d]);
    let along = |k: usize, row: [f64; 2]| {
        let end = row[0] * far[0] + row[1] * far[1];
        let [first, last] = range(k).map(f64::from);
        let from = (first - end.max(0.0)).floor() as i32;
        let to = (last - end.min(0.0)).ceil() as i32;
        // A hinge leaves a fraction of a step, along the chart's columns only.
        let part = -row[0] * shift;
        (from..=to).map(move |n| f64::from(n) + part)
    };
    along(0, row_a).flat_map(|x| along(1, row_b).map(move |y| [x, y])).collect()
}

fn read(
    cells: &mut Cells,
    family: &Family,
    columns: &[f64],
    turn: [i32; 4],
    mirrored: bool,
    origin: [f64; 2],
) -> Option<Reading> {
    let rows = family.layout().rows;
    let patches = columns.len() * rows;
    let [a, b, c, d] = turn.map(f64::from);
    let place = |i: usize| {
        let (x, y) = (columns[i % columns.len()], (i / columns.len()) as f64);
        [a * x + b * y + origin[0], c * x + d * y + origin[1]]
    };
    let is_member = |i: &usize| {
        let p = place(*i);
        let near = p.map(f64::round);
        (0..2).all(|k| (p[k] - near[k]).abs() < 0.15) && cells.occupied.holds(near[0] as i32, near[1] as i32)
    };
    let seen = (0..patches).filter(is_member).count();
    let explained = FEWEST_EXPLAINED * cells.lattice.members.len() as f64;
    if seen < fewest_seen(patches) || (seen as f64) < explained {
        return None;
    }
    let colours: Option<Vec<[f64; 3]>> = (0..patches).map(|i| cells.colour(place(i))).collect();
    let colours = colours?;
    Some(Reading { turn, mirrored, origin, fit: family.expected.fit(|i| colours[i]), seen })
}

/// Which places of a lattice have regions.
struct Occupied {
    first: [i32; 2],
    width: i32,
    places: Vec<bool>,
}

impl Occupied {
    fn of(lattice: &Lattice) -> Self {
        let (mut first, mut last) = ([i32::MAX; 2], [i32::MIN; 2]);
        for (x, y) in lattice.members.keys() {
            first = [first[0].min(*x), first[1].min(*y)];
            last = [last[0].max(*x), last[1].max(*y)];
        }
        let (width, height) = (last[0] - first[0] + 1, last[1] - first[1] + 1);
        let mut places = vec![false; (width * height) as usize];
        for (x, y) in lattice.members.keys() {
            places[((y - first[1]) * width + x - first[0]) as usize] = true;
        }
        Self { first, width, places }
    }

    fn holds(&self, x: i32, y: i32) -> bool {
        let (x, y) = (x - self.first[0], y - self.first[1]);
        let inside = x >= 0 && x < self.width && y >= 0;
        inside && self.places.get((y * self.width + x) as usize).copied().unwrap_or(false)
    }
}

/// Colours at places of a lattice, each looked up once.
struct Cells<'a> {
    picture: &'a Reduced,
    lattice: &'a Lattice,
    occupied: Occupied,
    /// By place, rounded to eighths of a step.
    seen: HashMap<(i32, i32), Option<[f64; 3]>>,
}

impl Cells<'_> {
    /// Medians over the middle of the cell; `None` when it is not all in the picture.
    fn colour(&mut self, place: [f64; 2]) -> Option<[f64; 3]> {
        let key = ((place[0] * 8.0).round() as i32, (place[1] * 8.0).round() as i32);
        if let Some(known) = self.seen.get(&key) {
            return *known;
        }
        let colour = middle(self.picture, &self.lattice.map, place, 0.3 * self.lattice.fill);
        self.seen.insert(key, colour);
        colour
    }
}

fn middle(picture: &Reduced, map: &Homography, place: [f64; 2], reach: f64) -> Option<[f64; 3]> {
    let mut values: [[f32; 25]; 3] = [[0.0; 25]; 3];
    for n in 0..25 {
        let offset = [n % 5, n / 5].map(|k| (k as f64 - 2.0) / 2.0 * reach);
        let point = map.apply([place[0] + offset[0], place[1] + offset[1]]);
        if !picture.holds(point) {
            return None;
        }
        for (c, values) in values.iter_mut().enumerate() {
            values[n] = picture.at(c, point[0], point[1]);
        }
    }
    Some(values.map(|mut v| f64::from(*v.select_nth_unstable_by(12, f32::total_cmp).1)))
}
