//! The light that a shot was taken in, measured.

use darkroot_calibrate::{Gate, LightSource, Verdict, gates, white_of};

use super::{Shot, View, refuse};
use crate::Error;

/// The light of a shot: the one that was named, if the white of the shot does not speak against it, else the one that the
/// white shows by the camera's own matrices. `None` where none was named and the file has no matrices.
///
/// # Errors
/// A light that was named and is not that of the shot, or patches that show no white.
pub(crate) fn light_of(
    shot: &Shot,
    view: &View,
    named: Option<&LightSource>,
    accept: bool,
) -> Result<Option<LightSource>, Error> {
    let Some(matrix) = &view.matrix else { return Ok(named.cloned()) };
    let white =
        white_of(&shot.patches).map_err(|e| Error::fit(named.unwrap_or(&LightSource::assumed()), e))?;
    let found = matrix.white_of(white);
    let Some(named) = named else { return Ok(LightSource::of_white(found)) };
    let gate = gates::light(found, named.light.xy, &named.light.name);
    if gate.verdict != Verdict::Good {
        refuse(&shot.path, &[Gate { verdict: Verdict::Refused, ..gate }], accept)?;
    }
    Ok(Some(named.clone()))
}
