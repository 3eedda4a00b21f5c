//! The calibration of a profile that a person means.

use darkroot_colour::temperature::{daylight_xy, planckian_xy};
use darkroot_profile::camera::KnownCamera;
use darkroot_profile::{Calibration, Kind, Light, Profile};

use super::ExportError;

/// The calibration for a light by its name or, between lights, by a temperature; the only one where none is named.
///
/// # Errors
/// Several lights and no name, a light that the profile does not have, a file of a light that cannot be used.
pub fn calibration(profile: &Profile, light: Option<&str>) -> Result<Calibration, ExportError> {
    let names: Vec<&str> = profile.calibrations().iter().map(|c| c.light.name.as_str()).collect();
    let names = names.join(", ");
    match (light, profile.calibrations()) {
        (None, [only]) => Ok(only.clone()),
        (None, _) => Err(ExportError::SeveralLights { names }),
        (Some(light), all) => {
            if let Some(found) = all.iter().find(|c| c.light.name.eq_ignore_ascii_case(light)) {
                return Ok(found.clone());
            }
            if let Some(known) = profile.known_camera() {
                return of_camera(known, light);
            }
            let kelvin = light.strip_suffix(['K', 'k']).and_then(|n| n.trim().parse::<f64>().ok());
            match kelvin.filter(|k| *k > 0.0 && k.is_finite()) {
                Some(kelvin) => Ok(between(profile, kelvin)),
                None => Err(ExportError::NoLight { name: light.to_owned(), names }),
            }
        }
    }
}

/// The calibration for any light, by the camera's sensitivities.
fn of_camera(known: &KnownCamera, name: &str) -> Result<Calibration, ExportError> {
    let source = crate::light::find(name).map_err(Box::new)?;
    let model = match &source.spectrum {
        Some(spectrum) => known.model_under(spectrum),
        None => Some(known.model_for(source.light.xy)),
    };
    match model {
        Some(model) => Ok(Calibration::new(source.light, Kind::Spectral, model)),
        None => Err(ExportError::BlindChannel { name: name.to_owned() }),
    }
}

/// The calibration for daylight of `kelvin`, or a lamp below 4000 K.
fn between(profile: &Profile, kelvin: f64) -> Calibration {
    const WARMEST_DAYLIGHT: f64 = 4000.0;
    let xy = if kelvin < WARMEST_DAYLIGHT { planckian_xy(kelvin) } else { daylight_xy(kelvin) };
    let light = Light { name: format!("{kelvin}K"), xy };
    Calibration::new(light, profile.calibrations()[0].kind, profile.model_for(xy))
}
