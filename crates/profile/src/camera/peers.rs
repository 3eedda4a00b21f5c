//! What is known of cameras in general: sensitivities of measured ones, surfaces, and how published matrices differ.

use darkroot_colour::Spectrum;
use nalgebra::DVector;

use super::offsets::{self, Family};
use crate::fit::virtual_set::builtin_surfaces;
use crate::spectra::Sensitivities;

/// Cameras, surfaces and families of matrices that an estimate rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct Peers {
    /// For each camera its channels, each scaled to the sum 1.
    pub(super) cameras: Vec<[DVector<f64>; 3]>,
    /// Surfaces with weights, through which matrices are computed.
    pub(super) surfaces: Vec<(Spectrum, f64)>,
    /// Families of published matrices.
    pub(super) families: Vec<Family>,
}

impl Peers {
    /// From measured cameras, with the surfaces and the families of matrices that are built into the program. `None` as for
    /// [`Peers::new`], or where their text is broken.
    pub fn with_builtin(cameras: &[Sensitivities]) -> Option<Self> {
        let families = offsets::parse(include_str!("../../data/offsets.csv"))?;
        Self::new(cameras, builtin_surfaces()?.to_vec(), families)
    }

    /// From measured cameras. `None` for fewer than two, or where a channel sees nothing.
    pub fn new(
        cameras: &[Sensitivities],
        surfaces: Vec<(Spectrum, f64)>,
        families: Vec<Family>,
    ) -> Option<Self> {
        let scaled = |camera: &Sensitivities| {
            let channel = |c: usize| {
                let values = DVector::from_column_slice(&camera.0[c].0);
                let sum = values.sum();
                (sum > 0.0 && sum.is_finite()).then(|| values / sum)
            };
            Some([channel(0)?, channel(1)?, channel(2)?])
        };
        let cameras = cameras.iter().map(scaled).collect::<Option<Vec<_>>>()?;
        (cameras.len() > 1).then_some(Self { cameras, surfaces, families })
    }
}
