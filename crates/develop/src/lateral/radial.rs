//! A radial function through the displacements of many blocks, where it is certain.

use darkroot_colour::{Matrix3, Vector3};

use super::shift::Shift;

/// Displacement away from the centre over the distance from it: k0 + k1 r^2 + k2 r^4 pixels, r = 1 in the corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Radial([f64; 3]);

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
    pub(super) from_centre: [f64; 2],
    pub(super) shift: Shift,
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
/// Displacements below are left, pixels, and such as are not so many times their standard error.
const SMALLEST: f64 = 0.1;
const CERTAIN: f64 = 6.0;
/// Distances from the centre at one of which that must hold.
const RADII: [f64; 3] = [0.5, 0.75, 1.0];
/// Standard deviation of what makes blocks differ besides noise, pixels.
const OWN: f64 = 0.06;
/// Rounds of reweighting, in each of which what counts as an outlier gets nearer.
const ROUNDS: usize = 12;
/// Weight of the assumption that k2 is small, in blocks of the standard deviation `OWN` a pixel off.
const STRAIGHT: f64 = 0.02;

/// The function, where it is certain.
pub(super) fn certain(places: &[Place]) -> Option<Radial> {
    let outer = places.iter().filter(|place| square(place) > 0.25).count();
    if places.len() < BLOCKS || outer < OUTER_BLOCKS {
        return None;
    }
    let all = fitted(places)?;
    let sector = |place: &Place| {
        let [u, v] = place.from_centre;
        let turn = v.atan2(u) / std::f64::consts::TAU + 0.5;
        ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
    };
    let mut without = Vec::new();
    let mut better = 0;
    for i in 0..SECTORS {
        let (own, others): (Vec<Place>, Vec<Place>) = places.iter().partition(|place| sector(place) == i);
        if own.len() < FEWEST {
            continue;
        }
        let radial = fitted(&others)?;
        let gain: f64 = own.iter().map(|place| badness(place, None) - badness(place, Some(&radial))).sum();
        better += usize::from(gain > 0.0);
        without.push(radial);
    }
    let n = without.len() as f64;
    if without.len() < TELLING || (better as f64) < BETTER * n {
        return None;
    }
    // The jackknife over sectors (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter 11) knows of what
    // blocks of one object have in common.
    let moves_at = |r: f64| {
        let of = |radial: &Radial| r * radial.factor(r * r);
        let mean = without.iter().map(of).sum::<f64>() / n;
        let spread: f64 = without.iter().map(|radial| (of(radial) - mean).powi(2)).sum();
        let error = ((n - 1.0) / n * spread).sqrt();
        of(&all).abs() > SMALLEST && of(&all).abs() > CERTAIN * error
    };
    if std::env::var_os("LCA_DEBUG").is_some() {
        let q: Vec<String> = [0.25, 0.5, 0.75, 1.0].iter().map(|r| { let of = |radial: &Radial| r * radial.factor(r * r);
        let mean = without.iter().map(of).sum::<f64>() / n;
        let spread: f64 = without.iter().map(|radial| (of(radial) - mean).powi(2)).sum();
        format!("{r}: {:.3}+-{:.3}", of(&all), ((n - 1.0) / n * spread).sqrt())}).collect();
        eprintln!("{} places {} outer, {better} of {n} better, {q:?} {all:?}", places.len(), outer);
        if std::env::var("LCA_DEBUG").unwrap() == "2" {
            for p in places { let [u,v]=p.from_centre; let [x,y]=p.shift.by; let r=u.hypot(v); let m=p.shift.certainty;
              println!("{u:.3} {v:.3} {x:.3} {y:.3} {:.3} {:.3} {:.4e} {:.4e} {:.4e} {:.3}", (u*x+v*y)/r, r*all.factor(r*r), m[0], m[1], m[2], badness(p, Some(&all)) ); }
        }
    }
    RADII.iter().any(|&r| moves_at(r)).then_some(all)
}

fn square(place: &Place) -> f64 {
    let [u, v] = place.from_centre;
    u * u + v * v
}

/// Certainty of a block's displacement with what makes blocks differ besides noise: (C + OWN^2)^-1 = M (1 + OWN^2 M)^-1 for
/// the covariance C and its inverse M. Symmetric, because both commute.
fn certainty(place: &Place) -> [f64; 3] {
    let [xx, xy, yy] = place.shift.certainty;
    let own = OWN * OWN;
    let (a, b, c) = (1.0 + own * xx, own * xy, 1.0 + own * yy);
    let determinant = a * c - b * b;
    [(xx * c - xy * b) / determinant, (xy * a - xx * b) / determinant, (yy * a - xy * b) / determinant]
}

/// Square of the distance of a block's displacement from what a function says, in standard deviations.
fn distance(place: &Place, radial: Option<&Radial>) -> f64 {
    let [x, y] = radial.map_or([0.0; 2], |radial| radial.at(place.from_centre));
    let (dx, dy) = (place.shift.by[0] - x, place.shift.by[1] - y);
    let [xx, xy, yy] = certainty(place);
    xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy
}

/// How badly a function predicts a block, 0 to 1: beyond a few standard deviations one is as bad as another (Geman and
/// McClure, Bulletin of the International Statistical Institute 52, 1987).
fn badness(place: &Place, radial: Option<&Radial>) -> f64 {
    let square = distance(place, radial);
    square / (square + 9.0)
}

/// The function that most blocks agree with: least squares that are reweighted, with ever narrower weights, so that the
/// first guess matters little.
fn fitted(places: &[Place]) -> Option<Radial> {
    let mut radial = Radial([0.0; 3]);
    for round in 0..ROUNDS {
        let scale = 9.0 * (1u32 << (2 * (ROUNDS - round)).saturating_sub(6).min(16)) as f64;
        let (mut products, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for place in places {
            let share = 1.0 + distance(place, Some(&radial)) / scale;
            let weight = 1.0 / (share * share);
            let [xx, xy, yy] = certainty(place).map(|v| v * weight);
            let [u, v] = place.from_centre;
            let [x, y] = place.shift.by;
            let square = u * u + v * v;
            let powers = Vector3::new(1.0, square, square * square);
            let length = xx * u * u + 2.0 * xy * u * v + yy * v * v;
            products += length * powers * powers.transpose();
            right += (u * (xx * x + xy * y) + v * (xy * x + yy * y)) * powers;
        }
        products[(2, 2)] += STRAIGHT / (OWN * OWN);
        let found = products.try_inverse()? * right;
        radial = Radial([found[0], found[1], found[2]]);
        if !radial.0.iter().all(|k| k.is_finite()) {
            return None;
        }
    }
    Some(radial)
}
