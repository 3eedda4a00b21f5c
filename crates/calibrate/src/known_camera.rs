//! Calibrations of a camera whose spectral sensitivities are known: what it makes of a surface is computed, not shot.

use darkroot_colour::adaptation::bradford;
use darkroot_colour::difference::de2000;
use darkroot_colour::{Spectrum, Vector3, Xyz, white};
use darkroot_profile::camera::{Judged, KnownCamera};
use darkroot_profile::fit::{Background, Fit, Samples, fit_knowing};
use darkroot_profile::{Calibration, Errors, Figures, Kind, Model, Patch, Sensitivities};

use crate::{CalibrateError, LightSource};

/// Most colours whose single residuals a profile keeps.
const MOST_PATCHES: usize = 250;

/// Surfaces with their names.
pub type Surfaces = [(String, Spectrum)];

/// Fits a kind of model to surfaces, and judges it by others that took no part.
///
/// # Errors
/// A light without a spectrum, a channel that sees nothing of it, too few colours.
pub fn calibrate(
    camera: &Sensitivities,
    light: &LightSource,
    training: &Surfaces,
    held_out: &Surfaces,
    kind: Kind,
) -> Result<Calibration, CalibrateError> {
    let spectrum = light.spectrum.as_ref().ok_or(CalibrateError::NoSpectrum)?;
    let effective = camera.under(spectrum).ok_or(CalibrateError::BlindChannel)?;
    let reflectances: Vec<Spectrum> = training.iter().map(|(_, s)| s.clone()).collect();
    let samples = effective.render(&reflectances, spectrum)?;
    let background = Background::Camera { reflectances: &reflectances, light: spectrum, camera: &effective };
    let fit = fit_knowing(&samples, kind, background)?;
    let mut figures = fit.figures(&samples);
    if !held_out.is_empty() {
        let unseen: Vec<Spectrum> = held_out.iter().map(|(_, s)| s.clone()).collect();
        figures.held_out = Some(errors(&fit.model, &effective.render(&unseen, spectrum)?));
    }
    let names: Vec<&str> = training.iter().map(|(n, _)| n.as_str()).collect();
    Ok(calibration(light, kind, &fit, figures, &samples, &names))
}

/// How far the colours of a camera that is known by its sensitivities are off under a light, on surfaces that took no part.
///
/// # Errors
/// A light without a spectrum, a channel that sees nothing of it.
pub fn judge(
    sensitivities: &Sensitivities,
    known: &KnownCamera,
    light: &LightSource,
    held_out: &Surfaces,
) -> Result<Judged, CalibrateError> {
    let spectrum = light.spectrum.as_ref().ok_or(CalibrateError::NoSpectrum)?;
    let effective = sensitivities.under(spectrum).ok_or(CalibrateError::BlindChannel)?;
    let model = known.model_under(spectrum).ok_or(CalibrateError::BlindChannel)?;
    let unseen: Vec<Spectrum> = held_out.iter().map(|(_, s)| s.clone()).collect();
    let samples = effective.render(&unseen, spectrum)?;
    let under_light = model.then(&bradford(white::D50, samples.white()));
    Ok(Judged { light: light.light.name.clone(), errors: errors(&under_light, &samples).rounded() })
}

/// Errors of a model over colours.
fn errors(model: &Model, samples: &Samples) -> Errors {
    let estimates: Vec<Xyz> = samples.rgb().iter().map(|rgb| model.xyz(*rgb)).collect();
    Errors::between(&estimates, samples.xyz(), samples.white())
}

/// A fit as a calibration: its XYZ relative to D50, with the residual of each colour where they are few.
fn calibration(
    light: &LightSource,
    kind: Kind,
    fit: &Fit,
    figures: Figures,
    samples: &Samples,
    names: &[&str],
) -> Calibration {
    let to_d50 = bradford(samples.white(), white::D50);
    let adapted = |c: Xyz| Xyz::from(to_d50 * Vector3::from(c));
    let model = fit.model.then(&to_d50).rounded();
    let patch = |(name, (rgb, xyz)): (&&str, (&[f64; 3], &Xyz))| {
        let (xyz, found) = (adapted(*xyz), model.xyz(*rgb));
        let de2000 = de2000(found.lab(white::D50), xyz.lab(white::D50));
        Patch { name: (*name).to_owned(), rgb: *rgb, xyz, de2000 }
    };
    let pairs = names.iter().zip(samples.rgb().iter().zip(samples.xyz()));
    let patches = if samples.len() <= MOST_PATCHES { pairs.map(patch).collect() } else { Vec::new() };
    Calibration { light: light.light.clone(), kind, model, figures: figures.rounded(), patches }
}
