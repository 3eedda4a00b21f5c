//! Models of the spectral prior, from the shot of a chart whose patches have known reflectances.

use darkroot_colour::{Spectrum, Xyz};
use rayon::prelude::*;

use super::prior::{Hyperparameters, Observed, Prior};
use super::virtual_set::{Rendered, VirtualSet};
use super::{Fit, FitError, Samples, chromatic, root_set};
use crate::spectra::Effective;
use crate::{Kind, Model};

/// Most fits that a cross-validation makes; where there are more colours, they are left out in groups.
const MOST_FITS: usize = 24;

/// What the models of the spectral prior know beside the colours.
#[derive(Debug, Clone, Copy)]
pub struct Knowledge<'a> {
    /// Reflectance of each patch.
    pub reflectances: &'a [Spectrum],
    /// The light.
    pub light: &'a Spectrum,
    /// What is known of cameras under that light.
    pub prior: &'a Prior,
    /// Colours that the model should be good for.
    pub set: &'a VirtualSet,
}

/// Fits a model of the spectral prior. Its estimates for colours left out come from fits without them: one by one,
/// or in 24 groups where there are more than 24 colours.
///
/// # Errors
/// Another number of reflectances than colours, or colours that do not determine the model.
pub fn fit(samples: &Samples, knowledge: Knowledge<'_>, kind: Kind) -> Result<Fit, FitError> {
    let count = samples.len();
    if knowledge.reflectances.len() != count {
        return Err(FitError::NoSpectra { kind });
    }
    let observed = Observed { reflectances: knowledge.reflectances, rgb: samples.rgb() };
    let undetermined = FitError::Undetermined { kind };
    let h = knowledge.prior.most_likely(observed).ok_or(undetermined)?;
    let model = model(observed, knowledge, h, kind)?;
    let groups = count.min(MOST_FITS);
    let left_out = |group: usize| {
        let kept: Vec<usize> = (0..count).filter(|i| i % groups != group).collect();
        let reflectances: Vec<Spectrum> = kept.iter().map(|i| knowledge.reflectances[*i].clone()).collect();
        let rgb: Vec<[f64; 3]> = kept.iter().map(|i| samples.rgb()[*i]).collect();
        let rest = Observed { reflectances: &reflectances, rgb: &rgb };
        self::model(rest, knowledge, h, kind)
    };
    let models = (0..groups).into_par_iter().map(left_out).collect::<Result<Vec<_>, _>>()?;
    let estimate = |(i, rgb): (usize, &[f64; 3])| -> Xyz { models[i % groups].xyz(*rgb) };
    Ok(Fit {
        model,
        left_out: samples.rgb().iter().enumerate().map(estimate).collect(),
        settings: format!("departure {}, noise {}", h.departure, h.noise),
    })
}

/// Fits a model of the spectral prior to a virtual set, with a camera whose sensitivities are known.
///
/// For cross-validation the surfaces of the set are left out in 24 groups. A surface that the set was made from is
/// estimated by the fit that lacks its representative in the set.
///
/// # Errors
/// Colours that do not determine the model.
pub fn fit_known_camera(
    set: &VirtualSet,
    camera: &Effective,
    light: &Spectrum,
    surfaces: &Samples,
    kind: Kind,
) -> Result<Fit, FitError> {
    let rendered = set.render(camera, light)?;
    let model = model_of(&rendered, kind)?;
    let groups = rendered.real().min(MOST_FITS);
    let without = |group: usize| model_of(&rendered.without(|surface| surface % groups == group)?, kind);
    let models = (0..groups).into_par_iter().map(without).collect::<Result<Vec<_>, _>>()?;
    let pairs = surfaces.rgb().iter().zip(set.stands_for());
    let left_out = pairs.map(|(rgb, owner)| models[owner % groups].xyz(*rgb)).collect();
    Ok(Fit { model, left_out, settings: String::new() })
}

/// The model alone, without cross-validation.
///
/// # Errors
/// Colours that do not determine it.
pub fn model_only(samples: &Samples, knowledge: Knowledge<'_>, kind: Kind) -> Result<Model, FitError> {
    let observed = Observed { reflectances: knowledge.reflectances, rgb: samples.rgb() };
    let h = knowledge.prior.most_likely(observed).ok_or(FitError::Undetermined { kind })?;
    model(observed, knowledge, h, kind)
}

fn model(
    observed: Observed<'_>,
    knowledge: Knowledge<'_>,
    h: Hyperparameters,
    kind: Kind,
) -> Result<Model, FitError> {
    let camera = knowledge.prior.posterior(observed, h).ok_or(FitError::Undetermined { kind })?;
    let set = knowledge.set.render(&camera, knowledge.light)?;
    model_of(&set, kind)
}

fn model_of(set: &Rendered, kind: Kind) -> Result<Model, FitError> {
    match kind {
        Kind::Chromatic => chromatic::fit(set),
        Kind::Spectral => root_set::fit(set),
        _ => Err(FitError::NoSpectra { kind }),
    }
}
