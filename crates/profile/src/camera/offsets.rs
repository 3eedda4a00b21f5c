//! How published colour matrices differ from those that sensitivities give.
//!
//! The difference is systematic, and makers of matrices differ: older and newer matrices of Adobe are two families. What
//! is kept of a family are the mean and the covariance of the difference, for each channel. A third family stands for
//! matrices of which nothing is known, as phones write them into their files: it is as wide as all together, and wider.

use darkroot_colour::{Matrix3, Spectrum, Vector3};
use nalgebra::DVector;

use super::regression::Regression;
use crate::spectra::Sensitivities;

/// Variance that is added to every covariance: the families are small, and no matrix is exact to a hundredth.
const FLOOR: f64 = 1e-4;
/// How much wider than all known matrices together those are of which nothing is known: a factor on the variance.
const WIDE: f64 = 9.0;
/// How probable such a matrix is before it is looked at.
const RARE: f64 = 0.001;
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
    pub share: f64,
}

/// A published matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The light that it is for.
    pub light: Spectrum,
    /// XYZ to camera RGB, of any scale.
    pub matrix: Matrix3,
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

/// The families of known differences. Empty where there are too few of them.
pub fn families(known: &[Difference]) -> Vec<Family> {
    let of = |older: bool| known.iter().filter(move |d| d.older == older).map(|d| d.rows).collect::<Vec<_>>();
    let all: Vec<[Vector3; 3]> = known.iter().map(|d| d.rows).collect();
    let found = [
        Family::of("older published matrices", &of(true), 1.0, 1.0),
        Family::of("newer published matrices", &of(false), 1.0, 1.0),
        Family::of("matrices of unknown origin", &all, WIDE, RARE),
    ];
    found.into_iter().flatten().collect()
}

/// As text: a line for each channel of each family, with its share, mean and the lower triangle of its covariance.
pub fn format(families: &[Family]) -> String {
    let mut text = String::new();
    for family in families {
        for ((name, mean), covariance) in CHANNELS.iter().zip(&family.mean).zip(&family.covariance) {
            let lower = (0..3).flat_map(|i| (0..=i).map(move |j| covariance[(i, j)]));
            let numbers = std::iter::once(family.share).chain(mean.iter().copied()).chain(lower);
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
        let v: [f64; 10] = cells.map(|c| c.parse().ok()).collect::<Option<Vec<_>>>()?.try_into().ok()?;
        let covariance = Matrix3::new(v[4], v[5], v[7], v[5], v[6], v[8], v[7], v[8], v[9]);
        Some((name, v[0], Vector3::new(v[1], v[2], v[3]), covariance))
    };
    let family = |lines: &[&str]| {
        let [red, green, blue] = lines else { return None };
        let rows = [row(red, CHANNELS[0])?, row(green, CHANNELS[1])?, row(blue, CHANNELS[2])?];
        Some(Family {
            name: rows[0].0.clone(),
            share: rows[0].1,
            mean: rows.each_ref().map(|r| r.2),
            covariance: rows.each_ref().map(|r| r.3),
        })
    };
    lines.chunks(3).map(family).collect()
}

impl Family {
    fn of(name: &str, differences: &[[Vector3; 3]], wider: f64, share: f64) -> Option<Self> {
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
        Some(Self { name: name.to_owned(), mean, covariance, share })
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
        let made = families(&(0..12).map(difference).collect::<Vec<_>>());
        assert_eq!(made.len(), 3);
        for (a, b) in parse(&format(&made)).unwrap().iter().zip(&made) {
            assert_eq!(a.name, b.name);
            for k in 0..3 {
                assert!((a.mean[k] - b.mean[k]).amax() < 1e-7);
                assert!((a.covariance[k] - b.covariance[k]).amax() < 1e-7);
            }
        }
        assert_eq!(parse("older,red,1,2,3"), None);
        assert!(families(&[]).is_empty());
    }
}
