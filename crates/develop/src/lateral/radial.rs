//! A radial function through the displacements of many blocks, where it is certain.

use darkroot_colour::{Matrix3, Vector3};

use super::shift::Shift;

/// Displacement away from the centre over the distance from it: k0 + k1 r^2 + k2 r^4 pixels, r = 1 in the corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Radial(pub(super) [f64; 3]);

impl Radial {
    /// That, for a square of r.
    pub(super) fn factor(&self, square: f64) -> f64 {
        let [k0, k1, k2] = self.0;
        k0 + square * (k1 + square * k2)
    }

    /// The largest displacement within the picture, pixels.
    pub(super) fn most(&self) -> f64 {
        (0..=20).map(|i| f64::from(i) / 20.0).map(|r| r * self.factor(r * r).abs()).fold(0.0, f64::max)
    }

    /// The displacement at a place in units of the reach.
    fn at(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let factor = self.factor(u * u + v * v);
        [factor * u, factor * v]
    }
}

/// What one block shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// From the optical centre, in units of the reach.
    from_centre: [f64; 2],
    from_green: [f64; 2],
    /// Certainty of that: the inverse of its covariance (xx, xy, yy).
    certainty: [f64; 3],
}

impl Place {
    /// What a block shows. Blocks differ by more than noise: for the covariance C and its inverse M, the certainty is
    /// (C + OWN^2)^-1 = M (1 + OWN^2 M)^-1, which is symmetric, because both commute.
    pub(super) fn new(from_centre: [f64; 2], shift: Shift) -> Self {
        let [xx, xy, yy] = shift.certainty;
        let own = OWN * OWN;
        let (a, b, c) = (1.0 + own * xx, own * xy, 1.0 + own * yy);
        let determinant = a * c - b * b;
        let certainty = [xx * c - xy * b, xy * a - xx * b, yy * a - xy * b].map(|v| v / determinant);
        Self { from_centre, from_green: shift.by, certainty }
    }
}

/// Sectors round the centre, each of which is left out once.
const SECTORS: usize = 8;
/// Blocks below which a sector tells nothing.
const FEWEST: usize = 4;
/// Sectors that must tell, and the share of them that the others must predict better than no displacement would.
const TELLING: usize = 6;
const BETTER: f64 = 0.8;
/// Blocks in all that must tell, and how many of them outside of half the reach.
const BLOCKS: usize = 40;
const OUTER_BLOCKS: usize = 20;
/// A displacement counts that is larger than this, pixels, and than so many times its standard error.
const SMALLEST: f64 = 0.1;
const CERTAIN: f64 = 6.0;
/// Distances from the centre at one of which that must hold; at none the standard error is larger than both the displacement
/// and the smallest one.
const RADII: [f64; 3] = [0.5, 0.75, 1.0];
/// Standard deviation of what makes blocks differ besides noise, pixels.
const OWN: f64 = 0.06;
/// Rounds of reweighting, in each of which what counts as an outlier gets nearer.
const ROUNDS: usize = 8;
/// Square of the standard deviations from which on a block counts less and less.
const TELLS: f64 = 9.0;
/// Weight of the assumption that k2 is 0, where it is not to be fitted, and where it is.
const STRAIGHT: [f64; 2] = [1e12, 5.0];

/// The function, where it is certain.
pub(super) fn certain(places: &[Place]) -> Option<Radial> {
    let outer = places.iter().filter(|place| square(place) > 0.25).count();
    if places.len() < BLOCKS || outer < OUTER_BLOCKS {
        return None;
    }
    let [plain, bent] = [false, true].map(|bends| Tried::of(places, bends));
    let (plain, bent) = (plain?, bent?);
    // k2 is there where sectors that had no say are predicted better with it.
    let tried = if bent.bad < plain.bad { bent } else { plain };
    tried.is_certain().then_some(tried.all)
}

/// A function that was fitted to all places, and without each sector.
struct Tried {
    all: Radial,
    without: Vec<Radial>,
    /// How badly sectors are predicted by the others, in sum.
    bad: f64,
    /// How many of them are predicted better than by no displacement.
    better: usize,
}

impl Tried {
    fn of(places: &[Place], bends: bool) -> Option<Self> {
        let all = fitted(places, bends)?;
        let mut tried = Self { all, without: Vec::new(), bad: 0.0, better: 0 };
        for i in 0..SECTORS {
            let (own, others): (Vec<Place>, Vec<Place>) = places.iter().partition(|place| sector(place) == i);
            if own.len() < FEWEST {
                continue;
            }
            let radial = fitted(&others, bends)?;
            let bad = |radial| own.iter().map(|place| badness(place, radial)).sum::<f64>();
            let (without, with) = (bad(None), bad(Some(&radial)));
            tried.bad += with;
            tried.better += usize::from(with < without);
            tried.without.push(radial);
        }
        Some(tried)
    }

    fn is_certain(&self) -> bool {
        let n = self.without.len() as f64;
        if self.without.len() < TELLING || (self.better as f64) < BETTER * n {
            return false;
        }
        // The jackknife over sectors (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter 11) knows of what
        // blocks of one object have in common.
        let found = RADII.map(|r| {
            let of = |radial: &Radial| r * radial.factor(r * r);
            let mean = self.without.iter().map(of).sum::<f64>() / n;
            let spread: f64 = self.without.iter().map(|radial| (of(radial) - mean).powi(2)).sum();
            (of(&self.all).abs(), ((n - 1.0) / n * spread).sqrt())
        });
        let moves = found.iter().any(|&(by, error)| by > SMALLEST && by > CERTAIN * error);
        let harms = found.iter().any(|&(by, error)| error > by.max(SMALLEST));
        moves && !harms
    }
}

/// The sector that a place lies in.
fn sector(place: &Place) -> usize {
    let [u, v] = place.from_centre;
    let turn = v.atan2(u) / std::f64::consts::TAU + 0.5;
    ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}

/// Square of the distance from the centre, in units of the reach.
fn square(place: &Place) -> f64 {
    let [u, v] = place.from_centre;
    u * u + v * v
}

/// Square of the distance of a block's displacement from what a function says, in standard deviations.
fn distance(place: &Place, radial: Option<&Radial>) -> f64 {
    let [x, y] = radial.map_or([0.0; 2], |radial| radial.at(place.from_centre));
    let (dx, dy) = (place.from_green[0] - x, place.from_green[1] - y);
    let [xx, xy, yy] = place.certainty;
    xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy
}

/// How badly a function predicts a block, 0 to 1: beyond a few standard deviations one is as bad as another (Geman and
/// McClure, Bulletin of the International Statistical Institute 52, 1987).
fn badness(place: &Place, radial: Option<&Radial>) -> f64 {
    let square = distance(place, radial);
    square / (square + TELLS)
}

/// The function that most blocks agree with: least squares that are reweighted, with ever narrower weights, so that the
/// first guess matters little.
fn fitted(places: &[Place], bends: bool) -> Option<Radial> {
    let mut radial = Radial([0.0; 3]);
    for round in 0..ROUNDS {
        let scale = TELLS * 4f64.powi((ROUNDS - 2).saturating_sub(round) as i32);
        let (mut products, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for place in places {
            let share = 1.0 + distance(place, Some(&radial)) / scale;
            let weight = 1.0 / (share * share);
            let [xx, xy, yy] = place.certainty.map(|v| v * weight);
            let [u, v] = place.from_centre;
            let [x, y] = place.from_green;
            let square = u * u + v * v;
            let powers = Vector3::new(1.0, square, square * square);
            let length = xx * u * u + 2.0 * xy * u * v + yy * v * v;
            products += length * powers * powers.transpose();
            right += (u * (xx * x + xy * y) + v * (xy * x + yy * y)) * powers;
        }
        products[(2, 2)] += STRAIGHT[usize::from(bends)];
        let found = products.try_inverse()? * right;
        radial = Radial([found[0], found[1], found[2]]);
        if !radial.0.iter().all(|k| k.is_finite()) {
            return None;
        }
    }
    Some(radial)
}
