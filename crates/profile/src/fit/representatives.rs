//! Few reflectances that stand for many.

use darkroot_colour::{Lab, Spectrum};

/// Rounds of Lloyd's algorithm.
const ROUNDS: usize = 40;

/// Reflectances that are alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Cluster {
    /// Their mean.
    pub mean: Spectrum,
    /// Which of the reflectances they are.
    pub members: Vec<usize>,
}

/// Sorts reflectances into at most `count` clusters by their colours under daylight and under a lamp and by their
/// shapes (k-means: Lloyd, "Least squares quantization in PCM", IEEE Trans. Inf. Theory 28(2), 1982; begun with the
/// reflectance nearest the mean, then always the one farthest from those taken). The same reflectances in the same
/// sequence give the same clusters.
pub fn clusters(reflectances: &[Spectrum], count: usize) -> Vec<Cluster> {
    let points = features(reflectances);
    if points.len() <= count {
        let single = |(i, s): (usize, &Spectrum)| Cluster { mean: s.clone(), members: vec![i] };
        return reflectances.iter().enumerate().map(single).collect();
    }
    let mut centres = begin(&points, count);
    let mut owner = assign(&points, &centres);
    for _ in 0..ROUNDS {
        for (c, centre) in centres.iter_mut().enumerate() {
            let own: Vec<&Vec<f64>> =
                points.iter().zip(&owner).filter(|(_, o)| **o == c).map(|(p, _)| p).collect();
            // A cluster that lost all of its members stays where it was.
            if !own.is_empty() {
                *centre = mean(&own);
            }
        }
        let next = assign(&points, &centres);
        if next == owner {
            break;
        }
        owner = next;
    }
    let cluster = |c: usize| {
        let members: Vec<usize> = (0..points.len()).filter(|i| owner[*i] == c).collect();
        let share = 1.0 / members.len() as f64;
        let sum = |k: usize| members.iter().map(|i| reflectances[*i].0[k]).sum::<f64>() * share;
        Cluster { mean: Spectrum(std::array::from_fn(sum)), members }
    };
    (0..centres.len()).map(cluster).filter(|c| !c.members.is_empty()).collect()
}

/// CIELAB under D50, twice what changes of it under A, and twenty times the square roots of the reflectance every
/// 10 nm from 400 to 700 nm: distances of about equal importance.
fn features(reflectances: &[Spectrum]) -> Vec<Vec<f64>> {
    let lights = [Spectrum::daylight(5003.0), Spectrum::illuminant_a()];
    let lab = |s: &Spectrum, light: &Spectrum| -> [f64; 3] {
        let Lab { l, a, b } = s.reflected_xyz(light).lab(light.white());
        [l, a, b]
    };
    let of = |s: &Spectrum| {
        let (day, lamp) = (lab(s, &lights[0]), lab(s, &lights[1]));
        let change = (0..3).map(|k| 2.0 * (lamp[k] - day[k]));
        let shape = (4..=64).step_by(2).map(|k| 20.0 * s.0[k].max(0.0).sqrt());
        day.into_iter().chain(change).chain(shape).collect()
    };
    reflectances.iter().map(of).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

fn mean(points: &[&Vec<f64>]) -> Vec<f64> {
    let width = points.first().map_or(0, |p| p.len());
    (0..width).map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64).collect()
}

fn begin(points: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let middle = mean(&points.iter().collect::<Vec<_>>());
    let to_middle: Vec<f64> = points.iter().map(|p| distance(p, &middle)).collect();
    let nearest = (0..points.len()).min_by(|a, b| to_middle[*a].total_cmp(&to_middle[*b]));
    let mut taken: Vec<usize> = nearest.into_iter().collect();
    let mut apart = vec![f64::INFINITY; points.len()];
    while let Some(&last) = taken.last() {
        if taken.len() == count {
            break;
        }
        for (d, p) in apart.iter_mut().zip(points) {
            *d = d.min(distance(p, &points[last]));
        }
        let farthest = (0..points.len()).max_by(|a, b| apart[*a].total_cmp(&apart[*b]).then(b.cmp(a)));
        taken.extend(farthest);
    }
    taken.into_iter().map(|i| points[i].clone()).collect()
}

fn assign(points: &[Vec<f64>], centres: &[Vec<f64>]) -> Vec<usize> {
    let nearest = |p: &Vec<f64>| {
        let at = |c: usize| distance(p, &centres[c]);
        (0..centres.len()).min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(0)
    };
    points.iter().map(nearest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_alike_comes_together() {
        let band = |centre: f64, height: f64| {
            Spectrum::from_fn(|nm| 0.1 + height * (-((nm - centre) / 40.0).powi(2)).exp())
        };
        let all: Vec<Spectrum> =
            (0..30).map(|i| band([450.0, 550.0, 620.0][i % 3], 0.5 + 0.002 * (i / 3) as f64)).collect();
        let found = clusters(&all, 3);
        assert_eq!(found.len(), 3);
        for cluster in &found {
            assert_eq!(cluster.members.len(), 10);
            assert!(cluster.members.iter().all(|i| i % 3 == cluster.members[0] % 3));
        }
        assert_eq!(clusters(&all, 30).len(), 30);
    }
}
