//! Which of several references a chart is: makers change their colours, and charts differ from what is published.

use darkroot_profile::Kind;
use darkroot_profile::fit::fit;

use crate::balanced::Balanced;
use crate::patch::with_spectra;
use crate::{CalibrateError, LightSource, MeasuredPatch};

/// How far patches are off, mean dE2000, by the `anchored` model of all other patches, whose errors for patches left out
/// have a closed form. A reference that is not the chart's is off for every model; the one that is off least is the chart's.
///
/// # Errors
/// Too few usable patches, or ones that determine no model.
pub fn left_out(light: &LightSource, patches: &[MeasuredPatch]) -> Result<f64, CalibrateError> {
    let patches = &*with_spectra(patches, light, &mut Vec::new());
    let balanced = Balanced::new(patches, light, &mut Vec::new())?;
    let figures = fit(&balanced.samples, Kind::Anchored)?.fit.figures(&balanced.samples);
    Ok(figures.leave_one_out.map_or(f64::INFINITY, |errors| errors.de2000.mean))
}
