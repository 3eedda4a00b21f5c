//! The patches of a shot, balanced: divided by what the camera makes of the white of their light.

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Matrix3, Vector3, Xyz, white};
use darkroot_profile::Model;
use darkroot_profile::fit::{Samples, white_through};

use crate::patch::{Reference, with_spectra};
use crate::{CalibrateError, JudgedPatch, LightSource, MeasuredPatch};

/// Fewest patches that a calibration can be made of.
const FEWEST: usize = 6;

/// The patches of a shot with the camera's white, found through the greys.
pub(crate) struct Balanced<'a> {
    /// The patches that may be used.
    pub(crate) usable: Vec<&'a MeasuredPatch>,
    /// Those, balanced, with XYZ under the light.
    pub(crate) samples: Samples,
    /// Camera RGB of the white of the light, in units of the measurements.
    pub(crate) white_rgb: [f64; 3],
    /// From XYZ under the light to XYZ relative to D50.
    pub(crate) to_d50: Matrix3,
    reference: Reference<'a>,
}

impl<'a> Balanced<'a> {
    /// The patches of a shot under this light. What had to be assumed about their reference comes to `notes`.
    ///
    /// # Errors
    /// Too few usable patches, or greys that show no white.
    pub(crate) fn new(
        patches: &'a [MeasuredPatch],
        light: &'a LightSource,
        notes: &mut Vec<String>,
    ) -> Result<Self, CalibrateError> {
        let usable = enough(patches)?;
        let light_white = light.light.xy.xyz();
        let reference = Reference::new(patches, light, light_white, notes);
        let xyz: Vec<Xyz> = usable.iter().map(|p| reference.xyz(p)).collect();
        let unbalanced = Samples::new(usable.iter().map(|p| p.rgb).collect(), xyz.clone(), light_white)?;
        let white_rgb = white_through(&unbalanced)?;
        let rgb = usable.iter().map(|p| over(p.rgb, white_rgb)).collect();
        let samples = Samples::new(rgb, xyz, light_white)?;
        Ok(Self { usable, samples, white_rgb, to_d50: bradford(light_white, white::D50), reference })
    }

    /// A patch with what a model makes of it, and what one makes of it that was fitted without it.
    pub(crate) fn judged(&self, patch: &MeasuredPatch, model: &Model, unseen: Option<Xyz>) -> JudgedPatch {
        let rgb = over(patch.rgb, self.white_rgb);
        let truth = Xyz::from(self.to_d50 * Vector3::from(self.reference.xyz(patch)));
        JudgedPatch::new(patch, rgb, truth, model.xyz(rgb), unseen)
    }
}

/// Camera RGB of the white of a shot's light, through its grey patches; it needs not be known which light that is.
///
/// # Errors
/// Too few usable patches, or greys that show no white.
pub fn white_of(patches: &[MeasuredPatch]) -> Result<[f64; 3], CalibrateError> {
    Ok(Balanced::new(patches, &LightSource::assumed(), &mut Vec::new())?.white_rgb)
}

/// As [`white_of`], where the light is known: greys of a chart are not neutral to the last, and not alike in every light.
///
/// # Errors
/// As [`white_of`].
pub fn white_under(patches: &[MeasuredPatch], light: &LightSource) -> Result<[f64; 3], CalibrateError> {
    let patches = &*with_spectra(patches, light, &mut Vec::new());
    Ok(Balanced::new(patches, light, &mut Vec::new())?.white_rgb)
}

fn over(rgb: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| rgb[c] / white[c])
}

/// The patches that may be used.
///
/// # Errors
/// They are too few.
fn enough(patches: &[MeasuredPatch]) -> Result<Vec<&MeasuredPatch>, CalibrateError> {
    let usable: Vec<&MeasuredPatch> = patches.iter().filter(|p| p.excluded.is_none()).collect();
    if usable.len() < FEWEST {
        let clipped = patches.iter().filter(|p| p.is_clipped()).count();
        return Err(CalibrateError::TooFewPatches { left: usable.len(), all: patches.len(), clipped });
    }
    Ok(usable)
}
