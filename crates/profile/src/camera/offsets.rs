//! How published colour matrices differ from those that sensitivities give.
//!
//! The difference is systematic, and makers of matrices differ: older and newer matrices of Adobe are two families. What
//! is kept of a family are the mean and the covariance of the difference, for each channel. A third family are matrices that
//! someone computed from sensitivities or a chart, as phones and laboratories write them into their files: they differ only
//! by the surfaces and the way of the fit. A fourth stands for matrices of which nothing is known: it is as wide as all
//! published ones together, and wider.

use darkroot_colour::{Matrix3, Spectrum, Vector3};
use nalgebra::DVector;

use super::regression::{Regression, inverse_fit};
use crate::spectra::Sensitivities;

/// Variance that is added to every covariance: the families are small, and no matrix is exact to a hundredth.
const FLOOR: f64 = 1e-4;
/// How much wider than all known matrices together those are of which nothing is known: a factor on the variance.
const WIDE: f64 = 9.0;
/// How probable such a matrix is before it is looked at.
const RARE: Shares = Shares { listed: 0.001, found: 0.001 };
/// How probable a published matrix is, and one that was computed.
const USUAL: Shares = Shares { listed: 1.0, found: 1.0 };
const COMPUTED: Shares = Shares { listed: 0.1, found: 10.0 };
/// Names of the channels.
const CHANNELS: [&str; 3] = ["red", "green", "blue"];
/// Fewest cameras that make a family.
const FEWEST: usize = 4;

/// The systematic difference of one kind of published matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Family {
    /// Its name, for people.
    pub name: String,
    /// For each channel, the mean of published row less computed row, both scaled to 1 at white.
    pub mean: [Vector3; 3],
    /// Covariance of that difference.
    pub covariance: [Matrix3; 3],
    /// How probable the family is before a matrix is looked at, relative to the others.
    pub shares: Shares,
}

/// How probable something is for a matrix that lists of published ones have, and for one that only a file has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// For a listed one.
    pub listed: f64,
    /// For one that was found in a file.
    pub found: f64,
}

/// A published matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The light that it is for.
    pub light: Spectrum,
    /// XYZ to camera RGB, of any scale.
    pub matrix: Matrix3,
    /// Whether lists of published matrices have it; others are known from their file only.
    pub listed: bool,
}

/// A camera of which both are known: for each channel the published row less the computed one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The three rows.
    pub rows: [Vector3; 3],
    /// Whether the matrix is one of the older kind.
    pub older: bool,
}

impl Difference {
    /// That of a camera whose sensitivities are known, too. `None` where the matrix is not usable.
    pub fn of(regression: &Regression, camera: &Sensitivities, published: &Matrix3) -> Option<Self> {
        let rows = regression.scaled(published)?;
        let own = |k: usize| regression.row(&DVector::from_column_slice(&camera.0[k].0));
        Some(Self { rows: [0, 1, 2].map(|k| rows[k] - own(k)), older: Self::is_older(published) })
    }

    /// Adobe's older matrices have a middle row that begins below -0.6.
    fn is_older(matrix: &Matrix3) -> bool {
        matrix[(1, 0)] < -0.6
    }
}

/// Differences of the matrices that each set of surfaces gives for a camera, fitted in either direction: camera RGB from
/// XYZ, and XYZ from camera RGB. Sets that determine no matrix give none.
pub fn computed(
    regression: &Regression,
    light: &Spectrum,
    camera: &Sensitivities,
    sets: &[Vec<Spectrum>],
) -> Vec<Difference> {
    let forward = |set: &[Spectrum]| {
        let even: Vec<(Spectrum, f64)> = set.iter().map(|s| (s.clone(), 1.0)).collect();
        Regression::under(light, &even).map(|r| r.matrix(camera))
    };
    let both = |set: &Vec<Spectrum>| [forward(set), inverse_fit(light, camera, set)];
    let matrices = sets.iter().flat_map(both).flatten();
    matrices.filter_map(|matrix| Difference::of(regression, camera, &matrix)).collect()
}

/// The families of known differences: of published matrices, and of [`computed`] ones. Families of too few are left out.
pub fn families(known: &[Difference], computed: &[Difference]) -> Vec<Family> {
    let of = |older: bool| known.iter().filter(move |d| d.older == older).map(|d| d.rows).collect::<Vec<_>>();
    let rows = |of: &[Difference]| of.iter().map(|d| d.rows).collect::<Vec<_>>();
    let found = [
        Family::of("older published matrices", &of(true), 1.0, USUAL),
        Family::of("newer published matrices", &of(false), 1.0, USUAL),
        Family::of("computed matrices", &rows(computed), 1.0, COMPUTED),
        Family::of("matrices of unknown origin", &rows(known), WIDE, RARE),
    ];
    found.into_iter().flatten().collect()
}

/// As text: a line for each channel of each family, with its shares, mean and the lower triangle of its covariance.
pub fn format(families: &[Family]) -> String {
    let mut text = String::new();
    for family in families {
        for ((name, mean), covariance) in CHANNELS.iter().zip(&family.mean).zip(&family.covariance) {
            let lower = (0..3).flat_map(|i| (0..=i).map(move |j| covariance[(i, j)]));
            let shares = [family.shares.listed, family.shares.found];
            let numbers = shares.into_iter().chain(mean.iter().copied()).chain(lower);
            let numbers: Vec<String> = numbers.map(|v| format!("{v:.6e}")).collect();
            text += &format!("{},{name},{}\n", family.name, numbers.join(","));
        }
    }
    text
}

/// From the text of [`format()`]. `None` where it is no such text.
pub fn parse(text: &str) -> Option<Vec<Family>> {
    let lines: Vec<&str> = text.lines().collect();
    let row = |line: &&str, channel: &str| {
        let mut cells = line.split(',');
        let name = cells.next()?.to_owned();
        (cells.next()? == channel).then_some(())?;
        let v: [f64; 11] = cells.map(|c| c.parse().ok()).collect::<Option<Vec<_>>>()?.try_into().ok()?;
        let covariance = Matrix3::new(v[5], v[6], v[8], v[6], v[7], v[9], v[8], v[9], v[10]);
        Some((name, Shares { listed: v[0], found: v[1] }, Vector3::new(v[2], v[3], v[4]), covariance))
    };
    let family = |lines: &[&str]| {
        let [red, green, blue] = lines else { return None };
        let rows = [row(red, CHANNELS[0])?, row(green, CHANNELS[1])?, row(blue, CHANNELS[2])?];
        Some(Family {
            name: rows[0].0.clone(),
            shares: rows[0].1,
            mean: rows.each_ref().map(|r| r.2),
            covariance: rows.each_ref().map(|r| r.3),
        })
    };
    lines.chunks(3).map(family).collect()
}

impl Family {
    fn of(name: &str, differences: &[[Vector3; 3]], wider: f64, shares: Shares) -> Option<Self> {
        if differences.len() < FEWEST {
            return None;
        }
        let count = differences.len() as f64;
        let mean = [0, 1, 2].map(|k| differences.iter().map(|d| d[k]).sum::<Vector3>() / count);
        let covariance = [0, 1, 2].map(|k| {
            let off = differences.iter().map(|d| d[k] - mean[k]);
            let own = off.map(|o| o * o.transpose()).sum::<Matrix3>() / (count - 1.0);
            own * wider + Matrix3::identity() * FLOOR
        });
        Some(Self { name: name.to_owned(), mean, covariance, shares })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_survive_their_text() {
        let row =
            |i: i32, k: i32| Vector3::new(f64::from(i * i % 7), f64::from(i * k), f64::from(i + k)) * 0.01;
        let difference = |i: i32| Difference { rows: [row(i, 1), row(i, 2), row(i, 3)], older: i % 2 == 0 };
        let known: Vec<Difference> = (0..12).map(difference).collect();
        let made = families(&known, &known[..5]);
        assert_eq!(made.len(), 4);
        for (a, b) in parse(&format(&made)).unwrap().iter().zip(&made) {
            assert_eq!((&a.name, a.shares), (&b.name, b.shares));
            for k in 0..3 {
                assert!((a.mean[k] - b.mean[k]).amax() < 1e-7);
                assert!((a.covariance[k] - b.covariance[k]).amax() < 1e-7);
            }
        }
        assert_eq!(parse("older,red,1,2,3"), None);
        assert!(families(&[], &[]).is_empty());
    }
}
