//! Profiles for other programs: DCP, ICC, 3-D tables; each with a reader that says what the file gives. A DCP can be
//! imported, too.
//!
//! The model stays what it is, balanced camera RGB to XYZ relative to D50; a file of another format can only hold
//! an approximation of it. So every writer here has a reader, and [`deviation`] compares what was read back with
//! the model over colours of sRGB's gamut.
//!
//! | file | holds | in | out |
//! |---|---|---|---|
//! | [`dcp`] | matrix and 2.5-D table in HSV | camera RGB, unbalanced | XYZ D50 |
//! | [`icc`] | 3-D table behind L\* curves | balanced camera RGB, 0..1 | CIELAB D50 |
//! | [`clf`] | 3-D table between cube root and cube | balanced camera RGB, 0..1 | linear RGB of a space |
//! | [`cube`] | 3-D table | balanced camera RGB, 0..1, or its square root | RGB of a space |

pub mod clf;
pub mod cube;
pub mod dcp;
pub mod grid;
pub mod icc;

mod fault;
mod gamut;
pub use fault::{ClfFault, CubeFault, CubeLine, DcpFault, DcpLimit, Error, IccFault};
pub use gamut::{Deviation, deviation, invert, srgb_colours};

#[cfg(test)]
mod tests {
    use darkroot_colour::{Matrix3, white};

    use crate::residual::Centre;
    use crate::{
        Calibration, HuePlane, Kind, Light, Model, Order, Origin, Profile, ProfileCamera, Residual,
        RootPolynomial,
    };

    /// Forward matrix of an ordinary camera.
    pub(crate) fn forward() -> Matrix3 {
        let mut m = Matrix3::new(0.65, 0.2, 0.1, 0.25, 0.75, 0.0, 0.02, 0.05, 0.75);
        for (r, w) in [white::D50.x, white::D50.y, white::D50.z].into_iter().enumerate() {
            m[(r, 2)] = w - m[(r, 0)] - m[(r, 1)];
        }
        m
    }

    /// White-exact models: a matrix, a root polynomial, a hue-plane model with a residual.
    pub(crate) fn models() -> Vec<Model> {
        let mut terms: Vec<[f64; 3]> = (0..3).map(|c| [0, 1, 2].map(|r| forward()[(r, c)])).collect();
        // Each root term less the mean of its channels: nothing is added to grey.
        for [a, b, size] in [[0, 1, 12], [1, 2, -20], [0, 2, 9]] {
            let size = f64::from(size) / 100.0;
            let weight = [size, 0.6 * size, -0.3 * size];
            terms.push(weight);
            for k in 0..3 {
                terms[a as usize][k] -= weight[k] / 2.0;
                terms[b as usize][k] -= weight[k] / 2.0;
            }
        }
        let root = RootPolynomial::new(Order::Two, terms).unwrap();
        let knot = |i: usize| {
            let turn = 0.05 * (i as f64).sin();
            let zero_sum = Matrix3::new(turn, -turn, 0.0, 0.0, turn, -turn, -turn, 0.0, turn);
            forward() + zero_sum
        };
        let hues = HuePlane::new((0..12).map(knot).collect()).unwrap();
        let centre = Centre { rgb: [0.6, 0.3, 0.1], weight: [0.03, 0.02, -0.01] };
        let chromatic = Model { residual: Residual::new(vec![centre]), ..hues.into() };
        vec![Model::linear(&forward()), root.into(), chromatic]
    }

    pub(crate) fn calibration(model: Model) -> Calibration {
        Calibration::new(Light { name: "D65".into(), xy: white::D65_XY }, Kind::Spectral, model)
    }

    pub(crate) fn profile(calibrations: Vec<Calibration>) -> Profile {
        let camera = ProfileCamera { make: "Nikon".into(), model: "D\"7<00>".into(), aliases: Vec::new() };
        Profile::new(camera, calibrations, Origin::default()).unwrap()
    }
}
