//! From measured patches to a calibration: the white, every model fitted and cross-validated, the best one.
//!
//! 1. Patches that were excluded are left out; fewer than six are too few.
//! 2. The reference colours become XYZ under the light of the shot.
//! 3. The camera's white is found through the grey patches, and every patch is divided by it.
//! 4. Each kind of model is fitted to all patches, and to all but one in turn.
//! 5. The kind with the least error on patches left out is taken, or the one that was asked for.

use darkroot_colour::{Spectrum, Vector3, Xyz};
use darkroot_profile::fit::{Fit, FitError};
use darkroot_profile::lint::{self, Severity};
use darkroot_profile::{Calibration, Kind};

use crate::balanced::Balanced;
use crate::compare::{self, Compared};
use crate::patch::with_spectra;
use crate::{CrossValidation, JudgedPatch, LightSource, MeasuredPatch};

/// What a person decides about the fit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Choice {
    /// The model; the best one if not given.
    pub kind: Option<Kind>,
    /// Rounds of cross-validation, where the patches were corrected by what they themselves show.
    pub cross_validation: Vec<CrossValidation>,
}

/// Why a chart gives no calibration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// Nothing is left to fit to.
    #[error(
        "only {left} of {all} patches can be used ({clipped} are clipped); take a shot with less light, or another chart"
    )]
    TooFewPatches {
        /// Usable patches.
        left: usize,
        /// All patches.
        all: usize,
        /// Clipped patches.
        clipped: usize,
    },
    /// The work needs the spectrum of the light.
    #[error("its spectrum is not known; take a light whose spectrum is")]
    NoSpectrum,
    /// A channel of the camera sees nothing of the light.
    #[error("a channel of the camera sees nothing of it")]
    BlindChannel,
    /// A fit that cannot be made.
    #[error("{0}")]
    Fit(#[from] FitError),
}

/// A calibration and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    /// The calibration.
    pub calibration: Calibration,
    /// Every model that was tried.
    pub compared: Vec<Compared>,
    /// Camera RGB of the white of the light, in units of the measurements.
    pub white_rgb: [f64; 3],
    /// Every patch, with what the model makes of it.
    pub patches: Vec<JudgedPatch>,
    /// Reflectance and balanced camera RGB of the usable patches, where reflectances are known or could be recovered.
    pub seen: Vec<(Spectrum, [f64; 3])>,
    /// What had to be assumed.
    pub notes: Vec<String>,
}

/// Fits every model to the usable patches and takes the best.
///
/// # Errors
/// Too few usable patches, or a wanted model that cannot be fitted.
pub fn calibrate(
    light: &LightSource,
    patches: &[MeasuredPatch],
    choice: &Choice,
) -> Result<Calibrated, CalibrateError> {
    let mut notes = Vec::new();
    let patches = &*with_spectra(patches, light, &mut notes);
    let balanced = Balanced::new(patches, light, &mut notes)?;
    let Balanced { usable, samples, white_rgb, to_d50, .. } = &balanced;

    let spectra: Option<Vec<Spectrum>> = usable.iter().map(|p| p.reference.spectrum()).collect();
    let prior = compare::prior(light);
    let knowledge = compare::knowledge(spectra.as_deref(), light, prior.as_ref());
    let mut compared = compare::compare(samples, knowledge);
    let places: Vec<usize> = (0..patches.len()).filter(|i| patches[*i].excluded.is_none()).collect();
    for round in &choice.cross_validation {
        compare::cross_validate(&mut compared, round, &places, samples, knowledge)?;
    }
    for (compared, fit) in &mut compared {
        if let (Ok(figures), Some(fit)) = (&mut compared.result, fit) {
            *figures = fit.figures(samples);
        }
    }
    let sound = |kind: Kind, fit: &Fit| {
        let calibration = Calibration::new(light.light.clone(), kind, fit.model.then(to_d50));
        lint::check(&calibration).iter().all(|finding| finding.severity < Severity::Failure)
    };
    let (kind, fit) = chosen(&compared, choice.kind, sound)?;

    let figures = fit.figures(samples);
    let model = fit.model.then(to_d50).rounded();
    let mut left_out = fit.left_out.iter().map(|c| Xyz::from(to_d50 * Vector3::from(*c)));
    let judged: Vec<JudgedPatch> = patches
        .iter()
        .map(|p| {
            let unseen = if p.excluded.is_none() { left_out.next() } else { None };
            balanced.judged(p, &model, unseen)
        })
        .collect();
    let calibration = Calibration {
        light: light.light.clone(),
        kind,
        model,
        figures: figures.rounded(),
        patches: judged.iter().filter(|j| j.excluded.is_none()).map(JudgedPatch::for_profile).collect(),
    };
    let compared = compared.into_iter().map(|(c, _)| c).collect();
    let seen = spectra.into_iter().flatten().zip(samples.rgb().iter().copied()).collect();
    Ok(Calibrated { calibration, compared, white_rgb: *white_rgb, patches: judged, seen, notes })
}

/// The model that was asked for, or the best of those that are sound; the best of all where none is.
fn chosen(
    compared: &[(Compared, Option<Fit>)],
    wanted: Option<Kind>,
    sound: impl Fn(Kind, &Fit) -> bool,
) -> Result<(Kind, &Fit), CalibrateError> {
    let mut refused = Vec::new();
    let mut best = || loop {
        let kind = compare::best(compared, &refused)?;
        match compared.iter().find(|(c, _)| c.kind == kind) {
            Some((_, Some(fit))) if !sound(kind, fit) => refused.push(kind),
            _ => return Some(kind),
        }
    };
    let kind = wanted.or_else(&mut best).or_else(|| compare::best(compared, &[])).unwrap_or(Kind::Linear);
    match compared.iter().find(|(c, _)| c.kind == kind) {
        Some((_, Some(fit))) => Ok((kind, fit)),
        Some((Compared { result: Err(fault), .. }, None)) => Err(fault.clone().into()),
        _ => Err(FitError::Undetermined { kind }.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_chart::ReferenceColour;
    use darkroot_colour::illuminant::Illuminant;
    use darkroot_simulate::Camera;

    fn patches(camera: &Camera, light: &Spectrum, gain: f64) -> Vec<MeasuredPatch> {
        let reflectances = darkroot_simulate::chart::reflectances();
        let one = |(name, s): (&str, &Spectrum)| MeasuredPatch {
            name: name.to_owned(),
            rgb: camera.response(s, light).map(|v| v * gain),
            uncertainty: [1e-4; 3],
            clipped: 0.0,
            reference: ReferenceColour::Lab(darkroot_simulate::reflectance::lab_of(s)),
            excluded: None,
        };
        darkroot_simulate::chart::PATCHES.iter().map(|(n, _)| *n).zip(&reflectances).map(one).collect()
    }

    fn d50() -> LightSource {
        LightSource::by_name("D50").unwrap()
    }

    #[test]
    fn the_best_model_beats_the_matrix_and_says_so() {
        let light = Illuminant::by_name("D50").unwrap().spectrum();
        let found =
            calibrate(&d50(), &patches(&Camera::simulated_one(), &light, 0.3), &Choice::default()).unwrap();
        let mean = |kind: Kind| {
            let compared = found.compared.iter().find(|c| c.kind == kind).unwrap();
            compared.result.as_ref().unwrap().leave_one_out.unwrap().de2000.mean
        };
        assert!(!matches!(found.calibration.kind, Kind::Linear | Kind::Polynomial(_)));
        assert!(mean(found.calibration.kind) < 0.7 * mean(Kind::Linear), "{:?}", found.calibration.kind);
        assert!(found.notes[0].contains("most probable spectra"), "{:?}", found.notes);
        // Under a light without a spectrum the models of the prior say what they lack.
        let unknown = LightSource { spectrum: None, ..d50() };
        let found =
            calibrate(&unknown, &patches(&Camera::simulated_one(), &light, 0.3), &Choice::default()).unwrap();
        let spectral = found.compared.iter().find(|c| c.kind == Kind::Spectral).unwrap();
        assert!(spectral.result.as_ref().unwrap_err().to_string().contains("reflectances"));
    }

    #[test]
    fn the_exposure_of_the_shot_does_not_change_the_profile() {
        let light = Illuminant::by_name("D50").unwrap().spectrum();
        let camera = Camera::simulated_one();
        let model = |gain: f64| {
            calibrate(&d50(), &patches(&camera, &light, gain), &Choice::default()).unwrap().calibration.model
        };
        let (dark, bright) = (model(0.1), model(0.8));
        for rgb in [[0.5, 0.3, 0.2], [0.1, 0.4, 0.7]] {
            let (a, b) = (dark.xyz(rgb), bright.xyz(rgb));
            assert!((a.x - b.x).abs() + (a.y - b.y).abs() + (a.z - b.z).abs() < 1e-6);
        }
    }

    #[test]
    fn clipped_patches_take_no_part() {
        let light = Illuminant::by_name("D50").unwrap().spectrum();
        let mut all = patches(&Camera::simulated_one(), &light, 0.3);
        for patch in all.iter_mut().take(20) {
            patch.clipped = 0.5;
            patch.excluded = Some("clipped".to_owned());
        }
        let fault = calibrate(&d50(), &all, &Choice::default()).unwrap_err().to_string();
        assert!(fault.contains("only 4 of 24") && fault.contains("20 are clipped"), "{fault}");
    }
}
