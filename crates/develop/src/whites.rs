//! Which white of the light gives which neutral, by the best that is known of the camera.

use darkroot_colour::{Spectrum, Xy, white};
use darkroot_photo::{AsShot, Capture};
use darkroot_profile::Profile;
use darkroot_profile::camera::KnownCamera;

use crate::white::CameraMatrix;

/// What tells the white from the neutral, and back: the sensitivities of a profile that has them, else the maker's
/// matrices. Colours and white balance agree, because both come from the same camera.
#[derive(Debug, Clone, Copy)]
pub struct Whites<'a> {
    matrix: Option<&'a CameraMatrix>,
    camera: Option<Anchored<'a>>,
    /// The neutral that the samples were divided by.
    applied: [f64; 3],
}

/// A camera whose neutral of daylight is that of the maker's matrices: specimens differ in the size of their channels, and
/// sensitivities are often measured channel by channel.
#[derive(Debug, Clone, Copy)]
struct Anchored<'a> {
    camera: &'a KnownCamera,
    /// What the camera's own RGB is multiplied by.
    scale: [f64; 3],
}

impl<'a> Whites<'a> {
    /// By what is known: the matrices, and a profile that may be a camera. A camera that is an estimate without a matrix
    /// says nothing of the size of its channels, so nothing of whites.
    pub fn of(matrix: Option<&'a CameraMatrix>, profile: Option<&'a Profile>) -> Self {
        let known = profile.and_then(Profile::known_camera);
        let anchored = |camera: &'a KnownCamera| {
            let Some(matrix) = matrix else {
                return camera.expected().is_none().then_some(Anchored { camera, scale: [1.0; 3] });
            };
            let (wanted, own) = (matrix.neutral_of(white::D65_XY)?, camera.neutral_of(white::D65_XY)?);
            Some(Anchored { camera, scale: [0, 1, 2].map(|c| wanted[c] / own[c]) })
        };
        Self { matrix, camera: known.and_then(anchored), applied: [1.0; 3] }
    }

    /// The same for samples that the camera divided by this neutral before it stored them.
    #[must_use]
    pub fn applied(self, neutral: [f64; 3]) -> Self {
        Self { applied: neutral, ..self }
    }

    /// Camera RGB of a white; the largest value is 1. `None` when nothing tells it.
    pub fn neutral_of(&self, white: Xy) -> Option<[f64; 3]> {
        let by_camera = self.camera.and_then(|Anchored { camera, scale }| {
            let own = camera.neutral_of(white)?;
            Some([0, 1, 2].map(|c| own[c] * scale[c]))
        });
        let neutral = by_camera.or_else(|| self.matrix?.neutral_of(white))?;
        let stored = [0, 1, 2].map(|c| neutral[c] / self.applied[c]);
        let largest = stored.iter().copied().fold(0.0, f64::max);
        Some(stored.map(|v| v / largest))
    }

    /// Chromaticity of the white that gives this neutral. `None` when nothing tells it.
    pub fn white_of(&self, neutral: [f64; 3]) -> Option<Xy> {
        let neutral = [0, 1, 2].map(|c| neutral[c] * self.applied[c]);
        let by_matrix = self.matrix.map(|matrix| matrix.white_of(neutral));
        let by_camera = self.camera.and_then(|Anchored { camera, scale }| {
            let own = [0, 1, 2].map(|c| neutral[c] / scale[c]);
            camera.white_of(own, by_matrix.unwrap_or(white::D50_XY))
        });
        by_camera.or(by_matrix)
    }

    /// Chromaticity of the white that a capture names as shot. `None` when it names none, or nothing tells it.
    pub fn as_shot(&self, capture: &Capture) -> Option<Xy> {
        match capture.as_shot? {
            AsShot::Neutral(neutral) => self.white_of(neutral),
            AsShot::White(xy) => self.neutral_of(xy).and_then(|neutral| self.white_of(neutral)),
        }
    }

    /// Balanced camera RGB of surfaces under a light. `None` when nothing tells it.
    pub(crate) fn colours(&self, light: &Spectrum, surfaces: &[(Spectrum, f64)]) -> Option<Vec<[f64; 3]>> {
        match self.camera {
            Some(Anchored { camera, .. }) => {
                let there = camera.sensitivities().under(light)?;
                Some(surfaces.iter().map(|(surface, _)| there.rgb(surface)).collect())
            }
            None => self.matrix?.colours(light, surfaces),
        }
    }
}
