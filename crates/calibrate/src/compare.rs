//! Every model on the patches of one chart, and the best of them.

use darkroot_colour::{Spectrum, Xyz};
use darkroot_profile::fit::population::Population;
use darkroot_profile::fit::prior::Prior;
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{self, Background, Fit, FitError, Knowledge, Samples, white_through};
use darkroot_profile::{Errors, Figures, Kind, Model};

use crate::{CrossValidation, LightSource};

/// A model that is meant to be taken is taken when it is within this factor of the best.
const AS_GOOD: f64 = 1.05;
/// Models that are meant to be taken, the first that is as good: they hold where there are no patches.
const PREFERRED: [Kind; 3] = [Kind::Spectral, Kind::Half, Kind::Anchored];

/// Exposures, in stops, at which every model is checked by scaling the patches.
pub const EXPOSURES: [i32; 7] = [-3, -2, -1, 0, 1, 2, 3];

/// Models that are fitted and compared, the simplest first. The polynomial of degree 4 has more terms than small charts
/// have patches.
fn kinds() -> impl Iterator<Item = Kind> {
    Kind::ALL.into_iter().filter(|kind| *kind != Kind::Polynomial(4))
}

/// One model of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The kind.
    pub kind: Kind,
    /// Its errors, or why it could not be fitted.
    pub result: Result<Figures, FitError>,
    /// Mean dE2000 on the patches of the fit with the light scaled to each of [`EXPOSURES`]; of a model that keeps
    /// colours at every exposure all are the same.
    pub exposures: Option<[f64; 7]>,
    /// What was chosen inside its fit.
    pub settings: String,
}

/// What is known of cameras in general under a light; `None` where its spectrum is not known.
pub(crate) fn prior(light: &LightSource) -> Option<Prior> {
    Prior::under(&Population::builtin()?, light.spectrum.as_ref()?)
}

/// What the models of the prior know beside the colours of a chart.
pub(crate) fn knowledge<'a>(
    reflectances: Option<&'a [Spectrum]>,
    light: &'a LightSource,
    prior: Option<&'a Prior>,
) -> Option<Knowledge<'a>> {
    let light = light.spectrum.as_ref()?;
    Some(Knowledge { reflectances: reflectances?, light, prior: prior?, set: VirtualSet::builtin()? })
}

/// Fits every kind that can be fitted.
pub(crate) fn compare(samples: &Samples, knowledge: Option<Knowledge<'_>>) -> Vec<(Compared, Option<Fit>)> {
    let background = knowledge.map_or(Background::ColoursOnly, Background::Reflectances);
    let one = |kind: Kind| match fit::fit_knowing(samples, kind, background) {
        Ok(fit) => {
            let (figures, settings) = (fit.figures(samples), fit.settings.clone());
            let exposures = Some(EXPOSURES.map(|stops| scaled_error(&fit.model, samples, stops)));
            (Compared { kind, result: Ok(figures), exposures, settings }, Some(fit))
        }
        Err(fault) => (Compared { kind, result: Err(fault), exposures: None, settings: String::new() }, None),
    };
    kinds().map(one).collect()
}

/// Takes one round of cross-validation into the estimates for patches left out: what a model makes of the group when it
/// took part neither in the fit nor in the corrections. `places` are those of the samples among all patches.
pub(crate) fn cross_validate(
    compared: &mut [(Compared, Option<Fit>)],
    round: &CrossValidation,
    places: &[usize],
    samples: &Samples,
    knowledge: Option<Knowledge<'_>>,
) -> Result<(), FitError> {
    let rgb: Vec<[f64; 3]> = places.iter().map(|i| round.rgb[*i]).collect();
    let raw = Samples::new(rgb, samples.xyz().to_vec(), samples.white())?;
    let white = white_through(&raw)?;
    let balanced: Vec<[f64; 3]> = raw.rgb().iter().map(|rgb| [0, 1, 2].map(|c| rgb[c] / white[c])).collect();
    let unseen = Samples::new(balanced, samples.xyz().to_vec(), samples.white())?;
    let left_out: Vec<usize> = (0..places.len()).filter(|i| round.left_out.contains(&places[*i])).collect();
    for (compared, fit) in compared {
        let Some(fit) = fit else { continue };
        let kind = compared.kind;
        let again: Vec<Xyz> = match knowledge.filter(|_| kind.needs_spectra()) {
            Some(knowledge) => {
                let model = without(&left_out, &unseen, knowledge, kind)?;
                left_out.iter().map(|i| model.xyz(unseen.rgb()[*i])).collect()
            }
            None => {
                let estimates = fit::fit(&unseen, kind)?.fit.left_out;
                left_out.iter().map(|i| estimates[*i]).collect()
            }
        };
        for (i, estimate) in left_out.iter().zip(again) {
            fit.left_out[*i] = estimate;
        }
    }
    Ok(())
}

/// A model of the prior, fitted without some of the patches.
fn without(
    left_out: &[usize],
    samples: &Samples,
    knowledge: Knowledge<'_>,
    kind: Kind,
) -> Result<Model, FitError> {
    let kept: Vec<usize> = (0..samples.len()).filter(|i| !left_out.contains(i)).collect();
    let reflectances: Vec<Spectrum> = kept.iter().map(|i| knowledge.reflectances[*i].clone()).collect();
    let rest = Samples::new(
        kept.iter().map(|i| samples.rgb()[*i]).collect(),
        kept.iter().map(|i| samples.xyz()[*i]).collect(),
        samples.white(),
    )?;
    fit::spectral::model_only(&rest, Knowledge { reflectances: &reflectances, ..knowledge }, kind)
}

/// Mean dE2000 of a model on the samples at another exposure, scaled back.
fn scaled_error(model: &Model, samples: &Samples, stops: i32) -> f64 {
    let k = 2f64.powi(stops);
    let estimate = |rgb: &[f64; 3]| model.xyz(rgb.map(|v| v * k)).scaled(1.0 / k);
    let estimates: Vec<Xyz> = samples.rgb().iter().map(estimate).collect();
    Errors::between(&estimates, samples.xyz(), samples.white()).de2000.mean
}

/// The kind with the least mean error on patches left out; `spectral`, else `half`, else `anchored` where they are as
/// good. Models whose colours change with exposure are not among them, and none of `refused`.
pub(crate) fn best(compared: &[(Compared, Option<Fit>)], refused: &[Kind]) -> Option<Kind> {
    let score = |c: &Compared| {
        if refused.contains(&c.kind) {
            return None;
        }
        let figures = c.result.as_ref().ok()?;
        let mean = figures.leave_one_out?.de2000.mean;
        (mean.is_finite() && c.kind.keeps_exposure()).then_some((c.kind, mean))
    };
    let scores: Vec<(Kind, f64)> = compared.iter().filter_map(|(c, _)| score(c)).collect();
    let least = scores.iter().map(|(_, s)| *s).fold(f64::INFINITY, f64::min);
    let preferred =
        PREFERRED.into_iter().find(|k| scores.iter().any(|(kind, s)| kind == k && *s <= AS_GOOD * least));
    preferred.or_else(|| scores.iter().find(|(_, s)| *s <= least).map(|(kind, _)| *kind))
}
