//! A model applied to planes of `f32`: the fast path.
//!
//! Loops are plain and vectorised by the compiler for AVX2 or AVX-512 where the machine has it; additions and multiplications
//! are never fused, so every machine gives the same bits.

mod hue_plane;
mod polynomial;
mod residual;
mod root;

use crate::Model;
use darkroot_colour::simd::vectorised_widely;
use hue_plane::HuePlanes;
use polynomial::PolynomialPlanes;
use residual::ResidualPlanes;
use root::RootPlanes;

/// Pixels handled at a time: their roots stay in the first-level cache.
const BLOCK: usize = 256;

/// Sums of X, Y and Z of a block.
type Out = [[f32; BLOCK]; 3];

/// A part of a model with its numbers as the loops want them.
trait PlanePart {
    /// Adds the part's share for the pixels of three slices of one length, at most [`BLOCK`].
    fn add(&self, rgb: [&[f32]; 3], out: &mut Out);
}

/// A model with its numbers as the loops want them.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneModel {
    root: Option<RootPlanes>,
    hue_plane: Option<HuePlanes>,
    residual: Option<ResidualPlanes>,
    polynomial: Option<PolynomialPlanes>,
}

impl PlaneModel {
    /// Prepares a model.
    pub fn new(model: &Model) -> Self {
        Self {
            root: model.root.as_ref().map(RootPlanes::new),
            hue_plane: model.hue_plane.as_ref().map(HuePlanes::new),
            residual: model.residual.as_ref().map(ResidualPlanes::new),
            polynomial: model.polynomial.as_ref().map(PolynomialPlanes::new),
        }
    }

    /// Replaces the three planes, of equal length, by the model's values for them.
    pub fn apply(&self, planes: [&mut [f32]; 3]) {
        let [r, g, b] = planes;
        let length = r.len().min(g.len()).min(b.len());
        let (r, g, b) = (&mut r[..length], &mut g[..length], &mut b[..length]);
        vectorised_widely(
            #[inline(always)]
            || {
                let blocks = r.chunks_mut(BLOCK).zip(g.chunks_mut(BLOCK)).zip(b.chunks_mut(BLOCK));
                for ((r, g), b) in blocks {
                    let mut out = [[0f32; BLOCK]; 3];
                    self.add([r, g, b], &mut out);
                    r.copy_from_slice(&out[0][..r.len()]);
                    g.copy_from_slice(&out[1][..g.len()]);
                    b.copy_from_slice(&out[2][..b.len()]);
                }
            },
        );
    }
}

impl PlanePart for PlaneModel {
    #[inline(always)]
    fn add(&self, rgb: [&[f32]; 3], out: &mut Out) {
        if let Some(part) = &self.root {
            part.add(rgb, out);
        }
        if let Some(part) = &self.hue_plane {
            part.add(rgb, out);
        }
        if let Some(part) = &self.residual {
            part.add(rgb, out);
        }
        if let Some(part) = &self.polynomial {
            part.add(rgb, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples_for_tests::all_parts;
    use crate::{Order, RootPolynomial};
    use proptest::prelude::*;

    fn apply(model: &Model, pixels: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let mut planes = [0, 1, 2].map(|c| pixels.iter().map(|p| p[c]).collect::<Vec<f32>>());
        let [r, g, b] = &mut planes;
        PlaneModel::new(model).apply([r, g, b]);
        (0..pixels.len()).map(|i| [0, 1, 2].map(|c| planes[c][i])).collect()
    }

    /// Largest difference from the slow path, relative to the sizes of the channels.
    fn worst(model: &Model, pixels: &[[f32; 3]]) -> f64 {
        let fast = apply(model, pixels);
        let off = |(p, f): (&[f32; 3], &[f32; 3])| {
            let slow = model.xyz(p.map(f64::from));
            let size = f64::from(p.iter().fold(1e-30, |m: f32, v| m.max(v.abs())));
            let [x, y, z] = f.map(f64::from);
            (x - slow.x).abs().max((y - slow.y).abs()).max((z - slow.z).abs()) / size
        };
        pixels.iter().zip(&fast).map(off).fold(0.0, f64::max)
    }

    fn pixels() -> impl Strategy<Value = Vec<[f32; 3]>> {
        prop::collection::vec(prop::array::uniform3(-0.1f32..4.0), 1..600)
    }

    proptest! {
        #[test]
        fn root_polynomials_agree_with_single_colours(
            order in 1u8..=4,
            coefficients in prop::collection::vec(prop::array::uniform3(-2.0f64..2.0), 22),
            pixels in pixels(),
        ) {
            let order = Order::new(order).unwrap();
            let count = order.terms().len();
            let model = RootPolynomial::new(order, coefficients[..count].to_vec()).unwrap().into();
            // Relative to the sum of the terms' sizes: they may cancel.
            prop_assert!(worst(&model, &pixels) <= 1e-6 * 2.0 * count as f64);
        }

        #[test]
        fn all_parts_agree_with_single_colours(pixels in pixels()) {
            for model in all_parts() {
                // The table of the residual is the coarsest: a hundred-thousandth.
                prop_assert!(worst(&model, &pixels) <= 2e-5, "{model:?} {}", worst(&model, &pixels));
            }
        }

        #[test]
        fn planes_commute_with_exposure(k in 1e-3f32..1e3, rgb in prop::array::uniform3(0f32..1.0)) {
            for model in all_parts().into_iter().filter(Model::is_exposure_invariant) {
                let (one, two) = (apply(&model, &[rgb])[0], apply(&model, &[rgb.map(|v| v * k)])[0]);
                for c in 0..3 {
                    prop_assert!((one[c] * k - two[c]).abs() <= 4e-5 * k, "{one:?} * {k} is not {two:?}");
                }
            }
        }
    }
}
