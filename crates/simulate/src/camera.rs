//! A simulated camera: what its sensor sees, how it counts, and its colour matrices.

use darkroot_colour::{Matrix3, Spectrum, Vector3, Xyz, white};
use darkroot_photo::{BlackLevel, Calibration, Cfa, Layout};

use crate::chart;
use crate::exact::{exp, gaussian};

/// Facts of a sensor and its electronics.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Maker, as files name it.
    pub make: String,
    /// Model, as files name it.
    pub model: String,
    /// Sensitivity to energy of red, green and blue samples, relative.
    pub sensitivities: [Spectrum; 3],
    /// Filters over the samples, from the first stored one on.
    pub layout: Layout,
    /// Bits a stored sample, up to 16.
    pub bits: u8,
    /// Count of no light.
    pub black: BlackLevel,
    /// Count of saturation.
    pub white: u16,
    /// Columns on the left and rows at the top that no light reaches.
    pub masked: (usize, usize),
    /// Pixels that the maker leaves out of the default crop on each side.
    pub crop: usize,
    /// Electrons at saturation.
    pub full_well: f64,
    /// Standard deviation of a sample without light, electrons.
    pub read_noise: f64,
}

impl Camera {
    /// "Darkroot Simulated One": 14 bits, RGGB, 24-patch colours about as good as those of a DSLR.
    pub fn simulated_one() -> Self {
        Self {
            make: "Darkroot".to_owned(),
            model: "Simulated One".to_owned(),
            sensitivities: sensitivities(),
            layout: filters("RGGB"),
            bits: 14,
            black: BlackLevel::uniform(512.0),
            white: 15_892,
            masked: (0, 0),
            crop: 4,
            full_well: 60_000.0,
            read_noise: 5.0,
        }
    }

    /// The same sensor under a name that decoders know, with the black level and saturation that they expect of
    /// it: "NIKON D750" of 14 bits. Its colours are those of the simulation, not of a real D750.
    pub fn nikon_d750() -> Self {
        Self {
            make: "NIKON CORPORATION".to_owned(),
            model: "NIKON D750".to_owned(),
            black: BlackLevel::uniform(600.0),
            white: 16_383,
            crop: 0,
            ..Self::simulated_one()
        }
    }

    /// [`Camera::nikon_d750`] set to 12 bits.
    pub fn nikon_d750_12_bit() -> Self {
        Self { bits: 12, black: BlackLevel::uniform(150.0), white: 4_095, ..Self::nikon_d750() }
    }

    /// Its names as a decoder reports them.
    pub fn names(&self) -> darkroot_photo::Camera {
        let nikon = self.make.starts_with("NIKON");
        darkroot_photo::Camera {
            make: self.make.clone(),
            model: self.model.clone(),
            common_make: if nikon { "Nikon".to_owned() } else { self.make.clone() },
            common_model: self.model.trim_start_matches("NIKON ").to_owned(),
        }
    }

    /// Unbalanced camera RGB of a reflectance under a light; 1 is the green of the perfect diffuser.
    pub fn response(&self, reflectance: &Spectrum, light: &Spectrum) -> [f64; 3] {
        let stimulus = reflectance.times(light);
        let unit = light.dot(&self.sensitivities[1]);
        self.sensitivities.each_ref().map(|s| stimulus.dot(s) / unit)
    }

    /// Camera RGB of a neutral surface under a light, the largest value 1 (DNG AsShotNeutral).
    pub fn neutral(&self, light: &Spectrum) -> [f64; 3] {
        let rgb = self.response(&Spectrum::constant(1.0), light);
        let largest = rgb.into_iter().fold(0.0, f64::max);
        rgb.map(|v| v / largest)
    }

    /// Colour matrices for a light of `kelvin`, by least squares over the 24 patches of [`chart`]; the white of
    /// the light is exact. DNG 1.4, chapter 6: ColorMatrix takes XYZ under the light to camera RGB, ForwardMatrix
    /// balanced camera RGB to XYZ under D50.
    pub fn calibration(&self, light: &Spectrum, kelvin: f64) -> Calibration {
        let neutral = Vector3::from(self.neutral(light));
        let green = self.response(&Spectrum::constant(1.0), light)[1] / neutral[1];
        let d50 = Spectrum::daylight(5003.0);
        let (mut seen, mut balanced, mut camera, mut reference) = (vec![], vec![], vec![], vec![]);
        for patch in chart::reflectances() {
            let rgb = Vector3::from(self.response(&patch, light)) / green;
            seen.push(vector(patch.reflected_xyz(light)));
            camera.push(rgb);
            balanced.push(rgb.component_div(&neutral));
            reference.push(vector(patch.reflected_xyz(&d50)));
        }
        let light_white = vector(Spectrum::constant(1.0).reflected_xyz(light));
        Calibration {
            kelvin: Some(kelvin),
            color_matrix: fit(&seen, &camera, light_white, neutral),
            forward_matrix: Some(fit(&balanced, &reference, Vector3::repeat(1.0), Vector3::from(white::D50))),
            camera_calibration: None,
        }
    }
}

/// A filter array by the letters of its square block, row by row ("RGGB"); anything else means no filters.
pub fn filters(letters: &str) -> Layout {
    Cfa::parse(letters).map_or(Layout::Monochrome, Layout::Cfa)
}

/// The 6x6 array of Fujifilm's X-Trans sensors.
pub fn x_trans() -> Layout {
    filters("GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG")
}

/// Sums of Gaussians behind an infrared and an ultraviolet filter, with the peaks, widths and side lobes that
/// silicon behind dyes commonly has (compare Jiang et al., "What is the space of spectral sensitivity functions
/// for digital color cameras?", WACV 2013). The heights are chosen so that the matrix for D65 resembles that of
/// common full-frame cameras: what decoders know of a D750 serves for its simulation too.
fn sensitivities() -> [Spectrum; 3] {
    let step = |nm: f64, at: f64, width: f64| 1.0 / (1.0 + exp((at - nm) / width));
    let filter = |nm: f64| step(nm, 412.0, 5.0) * step(-nm, -672.0, 9.0);
    let dye = |lobes: &[(f64, f64, f64)]| {
        Spectrum::from_fn(|nm| {
            filter(nm)
                * lobes.iter().map(|&(height, at, width)| height * gaussian(nm, at, width)).sum::<f64>()
        })
    };
    [
        dye(&[(0.68, 609.0, 21.5), (0.29, 632.0, 24.0), (0.03, 582.0, 25.0), (0.024, 430.0, 30.0)]),
        dye(&[(0.92, 530.0, 33.0), (0.41, 575.0, 28.0), (0.13, 455.0, 40.0)]),
        dye(&[(1.30, 455.0, 25.0), (0.08, 490.0, 22.0), (0.027, 550.0, 40.0)]),
    ]
}

/// The matrix that takes `inputs` to `outputs` with the least sum of squares among those that take `white_in` to
/// `white_out` exactly (Lagrange's method on the normal equations, which for three smooth channels are far from
/// singular).
fn fit(inputs: &[Vector3], outputs: &[Vector3], white_in: Vector3, white_out: Vector3) -> Matrix3 {
    let gram = inputs.iter().fold(Matrix3::zeros(), |sum, v| sum + v * v.transpose());
    let cross = inputs.iter().zip(outputs).fold(Matrix3::zeros(), |sum, (i, o)| sum + o * i.transpose());
    let inverse = gram.try_inverse().unwrap_or_else(Matrix3::identity);
    let free = cross * inverse;
    let pull = inverse * white_in;
    free + (white_out - free * white_in) * pull.transpose() / white_in.dot(&pull)
}

fn vector(xyz: Xyz) -> Vector3 {
    Vector3::from(xyz)
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::difference::de2000;

    fn lights() -> [(Spectrum, f64); 2] {
        [(Spectrum::daylight(6504.0), 6504.0), (Spectrum::illuminant_a(), 2856.0)]
    }

    #[test]
    fn the_white_of_the_light_is_exact() {
        let camera = Camera::simulated_one();
        for (light, kelvin) in lights() {
            let calibration = camera.calibration(&light, kelvin);
            let xyz = vector(Spectrum::constant(1.0).reflected_xyz(&light));
            let neutral = Vector3::from(camera.neutral(&light));
            assert!((calibration.color_matrix * xyz - neutral).norm() < 1e-12);
            let d50 = calibration.forward_matrix.unwrap() * Vector3::repeat(1.0);
            assert!((d50 - Vector3::from(white::D50)).norm() < 1e-12);
        }
    }

    #[test]
    fn colours_through_the_matrix_are_about_as_good_as_a_dslr() {
        let camera = Camera::simulated_one();
        for (light, kelvin) in lights() {
            let forward = camera.calibration(&light, kelvin).forward_matrix.unwrap();
            let neutral = Vector3::from(camera.response(&Spectrum::constant(1.0), &light));
            let mut sum = 0.0;
            for (name, lab) in chart::PATCHES {
                let rgb = Vector3::from(camera.response(&crate::reflectance::of_lab(lab), &light));
                let seen = Xyz::from(forward * rgb.component_div(&neutral)).lab(white::D50);
                sum += de2000(seen, lab);
                assert!(de2000(seen, lab) < 8.0, "{name}: {}", de2000(seen, lab));
            }
            let mean = sum / 24.0;
            assert!((0.3..3.0).contains(&mean), "{mean}");
        }
    }
}
