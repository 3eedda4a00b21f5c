//! The calibration of a profile that a person means.

use anyhow::{Result, bail};
use darkroot_colour::temperature::{daylight_xy, planckian_xy};
use darkroot_profile::camera::KnownCamera;
use darkroot_profile::{Calibration, Kind, Light, Profile};

/// The calibration for a light by its name or, between lights, by a temperature; the only one where none is named.
pub(super) fn choose(profile: &Profile, light: Option<&str>) -> Result<Calibration> {
    let names: Vec<&str> = profile.calibrations().iter().map(|c| c.light.name.as_str()).collect();
    let choices = names.join(", ");
    match (light, profile.calibrations()) {
        (None, [only]) => Ok(only.clone()),
        (None, _) => bail!("the profile has calibrations for {choices}; choose one with `--light`"),
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
                None => bail!(
                    "the profile has no light `{light}`; it has {choices}, or take a temperature (4000K)"
                ),
            }
        }
    }
}

/// The calibration for any light, by the camera's sensitivities.
fn of_camera(known: &KnownCamera, name: &str) -> Result<Calibration> {
    let source = darkroot::light::find(name)?;
    let model = match &source.spectrum {
        Some(spectrum) => known.model_under(spectrum),
        None => Some(known.model_for(source.light.xy)),
    };
    match model {
        Some(model) => Ok(Calibration::new(source.light, Kind::Spectral, model)),
        None => bail!("a channel of the camera sees nothing under `{name}`; choose another light"),
    }
}

/// The calibration for daylight of `kelvin`, or a lamp below 4000 K.
fn between(profile: &Profile, kelvin: f64) -> Calibration {
    const WARMEST_DAYLIGHT: f64 = 4000.0;
    let xy = if kelvin < WARMEST_DAYLIGHT { planckian_xy(kelvin) } else { daylight_xy(kelvin) };
    let light = Light { name: format!("{kelvin}K"), xy };
    Calibration::new(light, profile.calibrations()[0].kind, profile.model_for(xy))
}
