//! Regions that lie in rows and columns.

use darkroot_colour::statistics::median;
use std::collections::BTreeMap;

use super::regions::Region;
use crate::Homography;

/// Regions in rows and columns.
#[derive(Debug, Clone)]
pub(super) struct Lattice {
    /// The regions' centres by column and row; some may be missing.
    pub(super) members: BTreeMap<(i32, i32), [f64; 2]>,
    /// From column and row to pixels. Rows follow columns clockwise, so nothing is mirrored.
    pub(super) map: Homography,
    /// Side of a patch as a share of the step from one patch to the next.
    pub(super) fill: f64,
}

/// Fewest regions that make a lattice.
const FEWEST: usize = 7;
/// Steps from a region to its neighbour, in sides of the region.
const STEP: [f64; 2] = [0.95, 2.0];
/// How far from its predicted place a region may lie, as a share of a step.
const TOLERANCE: f64 = 0.22;
/// Neighbours tried as the second region of a lattice.
const NEIGHBOURS: usize = 5;

/// All lattices, the largest first. A region may belong to several small ones, but not to two large ones.
pub(super) fn lattices(regions: &[Region]) -> Vec<Lattice> {
    let index = Index::of(regions);
    let mut used = vec![0usize; regions.len()];
    let mut found = Vec::new();
    for seed in 0..regions.len() {
        if used[seed] >= FEWEST {
            continue;
        }
        let best = neighbours(regions, &index, seed)
            .into_iter()
            .map(|second| grown(regions, &index, seed, second))
            .max_by_key(|members| members.len());
        let Some(members) = best.filter(|m| m.len() >= FEWEST) else { continue };
        let Some((lattice, kept)) = fitted(regions, members) else { continue };
        for region in kept {
            used[region] = used[region].max(lattice.members.len());
        }
        found.push(lattice);
    }
    found.sort_by_key(|l| std::cmp::Reverse(l.members.len()));
    found
}

/// Squared length of a vector in sides of a parallelogram of this covariance.
fn squared_sides(covariance: [f64; 3], [x, y]: [f64; 2]) -> f64 {
    let [a, b, c] = covariance;
    (c * x * x - 2.0 * b * x * y + a * y * y) / (a * c - b * b) / 12.0
}

fn alike(one: &Region, two: &Region) -> bool {
    let ratio = one.area / two.area;
    let ([a, b, c], [d, e, f]) = (one.covariance, two.covariance);
    // Half the trace of one covariance in units of the other: 1 for the same shape.
    let half_trace = (c * d - 2.0 * b * e + a * f) / (a * c - b * b) / 2.0 * ratio;
    (0.5..2.0).contains(&ratio) && half_trace < 1.6
}

/// The nearest regions that may be the next in a row.
fn neighbours(regions: &[Region], index: &Index, seed: usize) -> Vec<usize> {
    let one = &regions[seed];
    let reach = STEP[1] * (one.covariance[0].max(one.covariance[2]) * 12.0).sqrt();
    let mut near: Vec<(f64, usize)> = index
        .near(one.centre, reach)
        .filter(|i| *i != seed && alike(one, &regions[*i]))
        .map(|i| (squared_sides(one.covariance, difference(regions[i].centre, one.centre)), i))
        .filter(|(d, _)| (STEP[0] * STEP[0]..STEP[1] * STEP[1]).contains(d))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.truncate(NEIGHBOURS);
    near.into_iter().map(|(_, i)| i).collect()
}

/// Grows a lattice from two neighbours: each further place is predicted from the nearest regions that are in it
/// already.
fn grown(regions: &[Region], index: &Index, seed: usize, second: usize) -> BTreeMap<(i32, i32), usize> {
    let u = difference(regions[second].centre, regions[seed].centre);
    let v = quarter_turn(regions[seed].covariance, u);
    let mut members = BTreeMap::from([((0, 0), seed), ((1, 0), second)]);
    let mut queue: Vec<(i32, i32)> = vec![(0, 0), (1, 0)];
    let mut next = 0;
    while next < queue.len() {
        let (i, j) = queue[next];
        next += 1;
        for (di, dj) in [(1i32, 0i32), (-1, 0), (0, 1), (0, -1)] {
            let place = (i + di, j + dj);
            if members.contains_key(&place) || place.0.abs() > 60 || place.1.abs() > 60 {
                continue;
            }
            let at = |p: &(i32, i32)| members.get(p).map(|r: &usize| regions[*r].centre);
            let from = &regions[members[&(i, j)]];
            let step = step(&at, (i, j), (di, dj)).unwrap_or([
                u[0] * f64::from(di) + v[0] * f64::from(dj),
                u[1] * f64::from(di) + v[1] * f64::from(dj),
            ]);
            let target = [from.centre[0] + step[0], from.centre[1] + step[1]];
            let reach = TOLERANCE * step[0].hypot(step[1]);
            let nearest = index
                .near(target, reach)
                .filter(|r| alike(from, &regions[*r]))
                .map(|r| (distance(regions[r].centre, target), r))
                .filter(|(d, _)| *d < reach)
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            if let Some((_, region)) = nearest {
                members.insert(place, region);
                queue.push(place);
            }
        }
    }
    members
}

/// The step that leads on from a place, taken from the steps around it.
fn step(
    at: &impl Fn(&(i32, i32)) -> Option<[f64; 2]>,
    (i, j): (i32, i32),
    (di, dj): (i32, i32),
) -> Option<[f64; 2]> {
    let here = at(&(i, j))?;
    if let Some(back) = at(&(i - di, j - dj)) {
        return Some(difference(here, back));
    }
    // The same step in the rows or columns beside.
    for side in [1, -1] {
        let beside = (i + side * dj, j + side * di);
        if let (Some(from), Some(to)) = (at(&beside), at(&(beside.0 + di, beside.1 + dj))) {
            return Some(difference(to, from));
        }
        if let (Some(from), Some(to)) = (at(&(beside.0 - di, beside.1 - dj)), at(&beside)) {
            return Some(difference(to, from));
        }
    }
    None
}

/// The other side of the square that has `u` as one side, seen in perspective. `[a, b, c]` is the covariance (xx, xy,
/// yy) of a region that is such a square on the chart: it tells how the square is distorted. The turn is clockwise (y
/// down).
fn quarter_turn([a, b, c]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    // With C the covariance and S its symmetric root, S^-1 undoes the distortion. So the turn is S R S^-1 with R a
    // quarter turn, and that equals C R / sqrt(det C).
    let root = (a * c - b * b).sqrt();
    [(-a * y + b * x) / root, (-b * y + c * x) / root]
}

fn fitted(regions: &[Region], mut members: BTreeMap<(i32, i32), usize>) -> Option<(Lattice, Vec<usize>)> {
    for _ in 0..3 {
        let pairs: Vec<_> =
            members.iter().map(|((i, j), r)| ([f64::from(*i), f64::from(*j)], regions[*r].centre)).collect();
        let spread = |k: usize| {
            let range = pairs.iter().fold([f64::MAX, f64::MIN], |m, p| [m[0].min(p.0[k]), m[1].max(p.0[k])]);
            range[1] - range[0]
        };
        if pairs.len() < FEWEST || spread(0) < 1.0 || spread(1) < 1.0 {
            return None;
        }
        let map = Homography::fitted(&pairs)?;
        let before = members.len();
        members.retain(|(i, j), r| {
            let place = [f64::from(*i), f64::from(*j)];
            let [[a, b], [c, d]] = map.derivative(place);
            let step = (a.hypot(c)).min(b.hypot(d));
            distance(map.apply(place), regions[*r].centre) < TOLERANCE * step
        });
        if members.len() == before {
            let fill = fill(regions, &members, &map);
            let kept: Vec<usize> = members.values().copied().collect();
            let members = members.into_iter().map(|(place, r)| (place, regions[r].centre)).collect();
            return Some((Lattice { members, map, fill }, kept));
        }
    }
    None
}

/// Median side of the regions over the step, both directions alike.
fn fill(regions: &[Region], members: &BTreeMap<(i32, i32), usize>, map: &Homography) -> f64 {
    let mut fills: Vec<f64> = members
        .iter()
        .map(|((i, j), r)| {
            let [[a, b], [c, d]] = map.derivative([f64::from(*i), f64::from(*j)]);
            (regions[*r].area / (a * d - b * c).abs()).sqrt()
        })
        .collect();
    median(&mut fills).map_or(0.8, |f| f.clamp(0.4, 1.0))
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

type Placed = (usize, [f64; 2]);

/// Regions by place, to find those near a point.
struct Index {
    cell: f64,
    /// Numbers and centres of the regions of a cell.
    places: BTreeMap<(i32, i32), Vec<Placed>>,
}

impl Index {
    fn of(regions: &[Region]) -> Self {
        let cell = 24.0;
        let mut places: BTreeMap<(i32, i32), Vec<Placed>> = BTreeMap::new();
        for (i, region) in regions.iter().enumerate() {
            let key = ((region.centre[0] / cell) as i32, (region.centre[1] / cell) as i32);
            places.entry(key).or_default().push((i, region.centre));
        }
        Self { cell, places }
    }

    fn near(&self, [x, y]: [f64; 2], reach: f64) -> impl Iterator<Item = usize> {
        let key = |v: f64| (v / self.cell).floor() as i32;
        let (columns, rows) = (key(x - reach)..=key(x + reach), key(y - reach)..=key(y + reach));
        columns
            .flat_map(move |i| rows.clone().filter_map(move |j| self.places.get(&(i, j))))
            .flatten()
            .filter(move |(_, c)| (c[0] - x).abs() <= reach && (c[1] - y).abs() <= reach)
            .map(|(i, _)| *i)
    }
}
