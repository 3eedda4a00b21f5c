//! The reflectance of a surface of which only the colour under D50 is known: the most probable one.
//!
//! Many reflectances have one colour, and they part under another light. The prior is Gaussian: mean and covariance of the
//! built-in surfaces, each weighted by how many it stands for and by exp(-d^2/2), d its distance in CIELAB over (21, 14,
//! 14), so that a red is recovered from reds. The colour is an exact linear observation of it; the estimate is the posterior
//! mean, held between 0 and 1 (a Wiener estimate with a local prior; compare Shimano, "Recovery of spectral reflectances of
//! objects being imaged without prior knowledge", IEEE TIP 15(7), 2006). The covariance that is left says how far its colour
//! under a light can be off.

use darkroot_colour::spectrum::SAMPLES;
use darkroot_colour::{Illuminant, Lab, Matrix3, Spectrum, Vector3, Xyz, white};
use nalgebra::{DMatrix, DVector};

use super::metric::de2000_weights;
use super::virtual_set::builtin_surfaces;

/// Distances in L*, a* and b* over which a surface's weight falls.
const REACH: [f64; 3] = [21.0, 14.0, 14.0];
/// Weight of the farthest surfaces.
const FAR: f64 = 1e-3;
/// Share of the covariance of all surfaces in every local one, and a variance that keeps it regular.
const GLOBAL: f64 = 1e-5;
const REGULAR: f64 = 1e-7;

/// A recovered reflectance.
#[derive(Debug, Clone, PartialEq)]
pub struct Recovered {
    /// The most probable one, 0..=1.
    pub reflectance: Spectrum,
    covariance: DMatrix<f64>,
}

/// The built-in surfaces and their colours under D50.
#[derive(Debug, Clone, PartialEq)]
pub struct Recovery {
    surfaces: Vec<DVector<f64>>,
    labs: Vec<Lab>,
    /// How many surfaces each stands for, relative.
    counts: Vec<f64>,
    everywhere: DMatrix<f64>,
    /// Reflectance to XYZ under D50.
    observer: DMatrix<f64>,
}

impl Recovery {
    /// That of the surfaces built into the program. `None` only if their text is broken.
    pub fn builtin() -> Option<Self> {
        let light = Illuminant::by_name("D50")?.spectrum();
        let known = builtin_surfaces()?;
        let surfaces: Vec<DVector<f64>> =
            known.iter().map(|(s, _)| DVector::from_column_slice(&s.0)).collect();
        let even = 1.0 / surfaces.len() as f64;
        let mean = surfaces.iter().sum::<DVector<f64>>() * even;
        Some(Self {
            labs: known.iter().map(|(s, _)| s.reflected_xyz(&light).lab(light.white())).collect(),
            // Weights are square roots of numbers.
            counts: known.iter().map(|(_, weight)| weight * weight).collect(),
            everywhere: covariance(&surfaces, &vec![even; surfaces.len()], &mean),
            observer: observer(&light),
            surfaces,
        })
    }

    /// The reflectance of a colour relative to [`white::D50`]. `None` for a colour that is no finite number.
    pub fn of(&self, colour: Xyz) -> Option<Recovered> {
        let lab = colour.lab(white::D50);
        let weight = |(other, count): (&Lab, &f64)| {
            let apart =
                [(other.l - lab.l) / REACH[0], (other.a - lab.a) / REACH[1], (other.b - lab.b) / REACH[2]];
            let square: f64 = apart.iter().map(|d| d * d).sum();
            ((-0.5 * square).exp() + FAR) * count
        };
        let weights: Vec<f64> = self.labs.iter().zip(&self.counts).map(weight).collect();
        let total: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|w| w / total).collect();
        let mut mean = DVector::zeros(SAMPLES);
        for (surface, w) in self.surfaces.iter().zip(&weights) {
            mean.axpy(*w, surface, 1.0);
        }
        let mut prior = covariance(&self.surfaces, &weights, &mean) + &self.everywhere * GLOBAL;
        for i in 0..SAMPLES {
            prior[(i, i)] += REGULAR;
        }
        // The white of the table differs from the rounded one in the fourth digit.
        let light_white = &self.observer * DVector::from_element(SAMPLES, 1.0);
        let rounded = Vector3::from(white::D50);
        let seen = DVector::from_fn(3, |k, _| Vector3::from(colour)[k] / rounded[k] * light_white[k]);
        let gained = &prior * self.observer.transpose();
        let factor = (&self.observer * &gained).cholesky()?;
        let found = &mean + &gained * factor.solve(&(seen - &self.observer * &mean));
        let covariance = prior - &gained * factor.solve(&gained.transpose());
        let reflectance = Spectrum(std::array::from_fn(|i| found[i].clamp(0.0, 1.0)));
        reflectance.0.iter().all(|v| v.is_finite()).then_some(Recovered { reflectance, covariance })
    }
}

impl Recovered {
    /// How far its colour under a light is probably off: root mean square, dE2000.
    pub fn uncertainty(&self, light: &Spectrum) -> f64 {
        let observer = observer(light);
        let spread = &observer * &self.covariance * observer.transpose();
        let spread = Matrix3::from_fn(|i, k| spread[(i, k)]);
        let colour = self.reflectance.reflected_xyz(light);
        let metric = de2000_weights(&[colour], light.white())[0];
        (metric * spread * metric.transpose()).trace().max(0.0).sqrt()
    }
}

/// Reflectance to XYZ under a light, Y = 1 for the perfect diffuser.
fn observer(light: &Spectrum) -> DMatrix<f64> {
    let unit = |i: usize| {
        let mut one = [0.0; SAMPLES];
        one[i] = 1.0;
        Vector3::from(Spectrum(one).reflected_xyz(light))
    };
    DMatrix::from_fn(3, SAMPLES, |k, i| unit(i)[k])
}

fn covariance(surfaces: &[DVector<f64>], weights: &[f64], mean: &DVector<f64>) -> DMatrix<f64> {
    let mut off = DMatrix::zeros(SAMPLES, surfaces.len());
    for (i, (surface, w)) in surfaces.iter().zip(weights).enumerate() {
        off.set_column(i, &((surface - mean) * w.sqrt()));
    }
    &off * off.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::difference::de2000;

    #[test]
    fn a_recovered_reflectance_has_its_colour() {
        let recovery = Recovery::builtin().unwrap();
        let light = Illuminant::by_name("D50").unwrap().spectrum();
        for lab in
            [(50.0, 0.0, 0.0), (40.0, 50.0, 25.0), (70.0, -30.0, 40.0), (30.0, 10.0, -40.0), (92.0, 0.0, 2.0)]
        {
            let lab = Lab { l: lab.0, a: lab.1, b: lab.2 };
            let found = recovery.of(lab.xyz(white::D50)).unwrap();
            let back = found.reflectance.reflected_xyz(&light).lab(light.white());
            assert!(de2000(lab, back) < 0.3, "{lab:?} {back:?}");
            // Under the light that its colour is known for, nothing is left to be unsure of.
            assert!(found.uncertainty(&light) < 0.05, "{}", found.uncertainty(&light));
            assert!(found.uncertainty(&Spectrum::illuminant_a()) < 3.0);
        }
    }

    #[test]
    fn a_colour_that_is_no_number_has_no_reflectance() {
        assert_eq!(Recovery::builtin().unwrap().of(Xyz::new(f64::NAN, 0.2, 0.2)), None);
    }
}
