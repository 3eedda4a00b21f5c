//! From measured patches of a chart to a calibration: white, exclusions, every model cross-validated, the best one.

mod patches;

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Spectrum, Vector3, Xyz, white};
use darkroot_profile::fit::population::Population;
use darkroot_profile::fit::prior::Prior;
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{self, FitError, Knowledge, Samples, spectral, white_through};
use darkroot_profile::{Calibration, Errors, Figures, Kind, Model, Order};

pub(crate) use patches::is_clipped;
pub use patches::{Judged, MeasuredPatch};

use crate::light::NamedLight;
use crate::shot::Fold;

/// Models that are fitted and compared, the simplest first.
const KINDS: [Kind; 11] = [
    Kind::Linear,
    Kind::Polynomial(2),
    Kind::Polynomial(3),
    Kind::Root(Order::Two),
    Kind::Root(Order::Three),
    Kind::Root(Order::Four),
    Kind::Anchored,
    Kind::HuePlane,
    Kind::Half,
    Kind::Spectral,
    Kind::Chromatic,
];
/// A model that is meant to be taken is taken when it is within this factor of the best.
const AS_GOOD: f64 = 1.05;

/// Exposures, in stops, at which every model is checked by scaling the patches.
pub const EXPOSURES: [i32; 7] = [-3, -2, -1, 0, 1, 2, 3];

/// What a person decides about the fit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Choice {
    /// The model; the best one if not given.
    pub kind: Option<Kind>,
    /// The patches as corrected without the help of some, where the patches themselves told how to correct them.
    pub folds: Vec<Fold>,
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
    /// A fit that cannot be made.
    #[error("{0}")]
    Fit(#[from] FitError),
}

/// One model of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The kind.
    pub kind: Kind,
    /// Its errors, or why it could not be fitted.
    pub result: Result<Figures, String>,
    /// Mean dE2000 on the patches of the fit with the light scaled to each of [`EXPOSURES`]; of a model that keeps
    /// colours at every exposure all are the same.
    pub exposures: Option<[f64; 7]>,
    /// What was chosen inside its fit.
    pub settings: String,
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
    pub patches: Vec<Judged>,
    /// What had to be assumed.
    pub notes: Vec<String>,
}

/// Fits every model to the usable patches and takes the best.
///
/// # Errors
/// Too few usable patches, or a wanted model that cannot be fitted.
pub fn calibrate(
    light: &NamedLight,
    patches: &[MeasuredPatch],
    choice: &Choice,
) -> Result<Calibrated, CalibrateError> {
    let mut notes = Vec::new();
    let usable: Vec<&MeasuredPatch> = patches.iter().filter(|p| p.excluded.is_none()).collect();
    if usable.len() < 6 {
        let clipped = patches.iter().filter(|p| p.is_clipped()).count();
        return Err(CalibrateError::TooFewPatches { left: usable.len(), all: patches.len(), clipped });
    }
    let light_white = light.light.xy.xyz();
    let reference = patches::Reference::new(patches, light, light_white, &mut notes);
    let xyz = |patch: &MeasuredPatch| reference.xyz(patch);

    let raw = Samples::new(
        usable.iter().map(|p| p.rgb).collect(),
        usable.iter().map(|p| xyz(p)).collect(),
        light_white,
    )?;
    let white_rgb = white_through(&raw)?;
    let balance = |rgb: [f64; 3]| [0, 1, 2].map(|c| rgb[c] / white_rgb[c]);
    let samples =
        Samples::new(usable.iter().map(|p| balance(p.rgb)).collect(), raw.xyz().to_vec(), light_white)?;

    let spectra: Option<Vec<Spectrum>> = usable.iter().map(|p| p.reference.spectrum()).collect();
    let mut compared = compare(&samples, spectra.as_deref(), light);
    let places: Vec<usize> = (0..patches.len()).filter(|i| patches[*i].excluded.is_none()).collect();
    for fold in &choice.folds {
        see_unseen(&mut compared, fold, &places, &samples)?;
    }
    for (compared, fit) in &mut compared {
        if let (Ok(figures), Some(fit)) = (&mut compared.result, fit) {
            *figures = fit.figures(&samples);
        }
    }
    let kind = choice.kind.or_else(|| best(&compared)).unwrap_or(Kind::Linear);
    let Some((_, fit)) = compared.iter().find(|(c, _)| c.kind == kind) else {
        return Err(FitError::Undetermined { kind }.into());
    };
    let Some(fit) = fit else {
        // Fitted again for its reason.
        return Err(fit::fit(&samples, kind).err().unwrap_or(FitError::Undetermined { kind }).into());
    };
    let figures = fit.figures(&samples);
    let to_d50 = bradford(light_white, white::D50);
    let adapted = |c: Xyz| Xyz::from(to_d50 * Vector3::from(c));
    let model = fit.model.then(&to_d50).rounded();
    let mut left_out = fit.left_out.iter();
    let judged: Vec<Judged> = patches
        .iter()
        .map(|p| {
            let unseen = if p.excluded.is_none() { left_out.next().map(|c| adapted(*c)) } else { None };
            Judged::new(p, balance(p.rgb), adapted(xyz(p)), model.xyz(balance(p.rgb)), unseen)
        })
        .collect();
    let calibration = Calibration {
        light: light.light.clone(),
        kind,
        model,
        figures: figures.rounded(),
        patches: judged.iter().filter(|j| j.excluded.is_none()).map(Judged::for_profile).collect(),
    };
    let compared = compared.into_iter().map(|(c, _)| c).collect();
    Ok(Calibrated { calibration, compared, white_rgb, patches: judged, notes })
}

/// What a given model makes of measured patches, balanced by the white of their own light.
///
/// # Errors
/// Too few usable patches.
pub fn judge(
    light: &NamedLight,
    patches: &[MeasuredPatch],
    model: &Model,
) -> Result<(Vec<Judged>, Errors), CalibrateError> {
    let usable: Vec<&MeasuredPatch> = patches.iter().filter(|p| p.excluded.is_none()).collect();
    if usable.len() < 6 {
        let clipped = patches.iter().filter(|p| p.is_clipped()).count();
        return Err(CalibrateError::TooFewPatches { left: usable.len(), all: patches.len(), clipped });
    }
    let light_white = light.light.xy.xyz();
    let reference = patches::Reference::new(patches, light, light_white, &mut Vec::new());
    let raw = Samples::new(
        usable.iter().map(|p| p.rgb).collect(),
        usable.iter().map(|p| reference.xyz(p)).collect(),
        light_white,
    )?;
    let white_rgb = white_through(&raw)?;
    let to_d50 = bradford(light_white, white::D50);
    let judged: Vec<Judged> = patches
        .iter()
        .map(|p| {
            let rgb = [0, 1, 2].map(|c| p.rgb[c] / white_rgb[c]);
            let truth = Xyz::from(to_d50 * Vector3::from(reference.xyz(p)));
            Judged::new(p, rgb, truth, model.xyz(rgb), None)
        })
        .collect();
    let used = || judged.iter().filter(|j| j.excluded.is_none());
    let estimates: Vec<Xyz> = used().map(|j| j.corrected).collect();
    let truths: Vec<Xyz> = used().map(|j| j.reference).collect();
    let errors = Errors::between(&estimates, &truths, white::D50);
    Ok((judged, errors))
}

/// Fits every kind that can be fitted.
fn compare(
    samples: &Samples,
    spectra: Option<&[Spectrum]>,
    light: &NamedLight,
) -> Vec<(Compared, Option<fit::Fit>)> {
    let statistics = Population::builtin().zip(VirtualSet::builtin());
    let prior = statistics
        .as_ref()
        .zip(light.spectrum.as_ref())
        .and_then(|((population, set), spectrum)| Some((Prior::under(population, spectrum)?, set, spectrum)));
    let one = |kind: Kind| {
        let result = match (kind, spectra, &prior) {
            (Kind::Spectral | Kind::Chromatic, Some(reflectances), Some((prior, set, light))) => {
                spectral::fit(samples, Knowledge { reflectances, light, prior, set }, kind)
            }
            _ => fit::fit(samples, kind).map(|candidate| candidate.fit),
        };
        match result {
            Ok(fit) => {
                let (figures, settings) = (fit.figures(samples), fit.settings.clone());
                let exposures = Some(EXPOSURES.map(|stops| scaled_error(&fit.model, samples, stops)));
                (Compared { kind, result: Ok(figures), exposures, settings }, Some(fit))
            }
            Err(fault) => {
                let result = Err(fault.to_string());
                (Compared { kind, result, exposures: None, settings: String::new() }, None)
            }
        }
    };
    KINDS.into_iter().map(one).collect()
}

/// Puts what models make of patches that took part neither in the fit nor in the corrections in the place of what was
/// left out of the fit alone. `places` are those of the samples among all patches.
///
/// The models of the prior take too long to be fitted for each fold: there the fit stays as it is and only the patch's
/// own colour changes, which is most of it.
fn see_unseen(
    compared: &mut [(Compared, Option<fit::Fit>)],
    fold: &Fold,
    places: &[usize],
    samples: &Samples,
) -> Result<(), FitError> {
    let rgb: Vec<[f64; 3]> = places.iter().map(|i| fold.rgb[*i]).collect();
    let raw = Samples::new(rgb, samples.xyz().to_vec(), samples.white())?;
    let white = white_through(&raw)?;
    let balanced: Vec<[f64; 3]> = raw.rgb().iter().map(|rgb| [0, 1, 2].map(|c| rgb[c] / white[c])).collect();
    let unseen = Samples::new(balanced, samples.xyz().to_vec(), samples.white())?;
    let left_out: Vec<usize> = (0..places.len()).filter(|i| fold.left_out.contains(&places[*i])).collect();
    for (compared, fit) in compared {
        let Some(fit) = fit else { continue };
        let again = match compared.kind {
            Kind::Spectral | Kind::Chromatic => None,
            kind => Some(fit::fit(&unseen, kind)?.fit.left_out),
        };
        for i in &left_out {
            fit.left_out[*i] = again.as_ref().map_or_else(
                || {
                    let (now, then) = (fit.model.xyz(unseen.rgb()[*i]), fit.model.xyz(samples.rgb()[*i]));
                    let Xyz { x, y, z } = fit.left_out[*i];
                    Xyz::new(x + now.x - then.x, y + now.y - then.y, z + now.z - then.z)
                },
                |left_out| left_out[*i],
            );
        }
    }
    Ok(())
}

/// Mean dE2000 of a model on the samples at another exposure, scaled back.
fn scaled_error(model: &Model, samples: &Samples, stops: i32) -> f64 {
    let k = 2f64.powi(stops);
    let estimate = |rgb: &[f64; 3]| model.xyz(rgb.map(|v| v * k)).scaled(1.0 / k);
    let estimates: Vec<Xyz> = samples.rgb().iter().map(estimate).collect();
    Errors::between(&estimates, samples.xyz(), samples.white()).de2000.mean
}

/// The kind with the least mean error on patches left out; `spectral`, else `half`, else `anchored` where they are as
/// good, because they hold where there are no patches. Plain polynomials are not among them.
fn best(compared: &[(Compared, Option<fit::Fit>)]) -> Option<Kind> {
    let score = |c: &Compared| {
        let figures = c.result.as_ref().ok()?;
        let mean = figures.leave_one_out?.de2000.mean;
        (mean.is_finite() && !matches!(c.kind, Kind::Polynomial(_))).then_some((c.kind, mean))
    };
    let scores: Vec<(Kind, f64)> = compared.iter().filter_map(|(c, _)| score(c)).collect();
    let least = scores.iter().map(|(_, s)| *s).fold(f64::INFINITY, f64::min);
    let wanted = [Kind::Spectral, Kind::Half, Kind::Anchored];
    let preferred =
        wanted.into_iter().find(|k| scores.iter().any(|(kind, s)| kind == k && *s <= AS_GOOD * least));
    preferred.or_else(|| scores.iter().find(|(_, s)| *s <= least).map(|(kind, _)| *kind))
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

    fn d50() -> NamedLight {
        crate::light::find("D50").unwrap()
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
        assert!(matches!(found.calibration.kind, Kind::Half | Kind::Anchored | Kind::Root(_)));
        assert!(mean(found.calibration.kind) < 0.7 * mean(Kind::Linear), "{:?}", found.calibration.kind);
        // Without spectra the models of the prior say what they lack.
        let spectral = found.compared.iter().find(|c| c.kind == Kind::Spectral).unwrap();
        assert!(spectral.result.as_ref().unwrap_err().contains("reflectances"));
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
