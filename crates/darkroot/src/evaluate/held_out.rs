//! How good profiles of a chart are on colours that nothing has seen: neither the fit nor the built-in knowledge.
//!
//! The knowledge of cameras and surfaces that some models rest on is made anew for each camera: from other cameras than it and
//! those of its name, and from surfaces of which none is judged on.

use std::path::PathBuf;

use darkroot_calibrate::CalibrateError;
use darkroot_colour::Spectrum;
use darkroot_profile::fit::population::Population;
use darkroot_profile::fit::prior::Prior;
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{Knowledge, fit, spectral};
use darkroot_profile::{Kind, Order, Sensitivities, Summary};
use rayon::prelude::*;

use super::ReflectanceSet;
use super::cameras::{cut, names, without_judged};
use super::seen::Seen;
use crate::light::LightSource;
use crate::{Error, ProfileStore, spectra};

/// The models that are judged.
pub const MODELS: [Kind; 7] = [
    Kind::Linear,
    Kind::Root(Order::Two),
    Kind::Anchored,
    Kind::HuePlane,
    Kind::Half,
    Kind::Spectral,
    Kind::Chromatic,
];

/// What is judged, and by what.
#[derive(Debug, Clone)]
pub struct Request {
    /// Sensitivities of the cameras that are judged.
    pub cameras: Vec<PathBuf>,
    /// Those that the knowledge may rest on.
    pub prior: Vec<PathBuf>,
    /// Surfaces that the knowledge may rest on.
    pub surfaces: Vec<Spectrum>,
    /// The chart that the models are fitted to.
    pub chart: ReflectanceSet,
    /// Surfaces that are judged on.
    pub judged: Vec<ReflectanceSet>,
    /// Lights.
    pub lights: Vec<LightSource>,
    /// Wavelengths that count, nm.
    pub between: (f64, f64),
}

/// How one model of one camera did under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The camera.
    pub camera: String,
    /// Name of the light.
    pub light: String,
    /// The model.
    pub kind: Kind,
    /// dE2000 over all surfaces that are judged on.
    pub errors: Summary,
    /// The same for each set, mean only.
    pub sets: Vec<f64>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Each model of each camera under each light.
    pub results: Vec<Judgement>,
    /// Surfaces that were left out of the knowledge because they are judged on.
    pub surfaces_left_out: usize,
}

struct Known {
    names: Vec<String>,
    sensitivities: Sensitivities,
}

/// Judges every model.
///
/// # Errors
/// Files that cannot be used, lights without a spectrum, fewer than two other cameras, a chart that determines no model.
pub fn evaluate(request: &Request) -> Result<Outcome, Error> {
    let store = ProfileStore::builtin();
    let read = |path: &PathBuf| {
        Ok(Known { names: names(&store, path), sensitivities: spectra::read_sensitivities(path)?.0 })
    };
    let prior = request.prior.iter().map(read).collect::<Result<Vec<_>, Error>>()?;
    let cameras = request.cameras.iter().map(read).collect::<Result<Vec<_>, Error>>()?;
    let surfaces = without_judged(&request.surfaces, &request.judged);
    let set = VirtualSet::of(&surfaces);
    let one = |camera: &Known| {
        let is_twin = |other: &&Known| other.names.iter().any(|name| camera.names.contains(name));
        let others: Vec<Sensitivities> =
            prior.iter().filter(|other| !is_twin(other)).map(|other| other.sensitivities.clone()).collect();
        let population = Population::of(&others, usize::MAX).ok_or(Error::Prior)?;
        let under = |light: &LightSource| judge(camera, &population, &set, light, request);
        request.lights.iter().map(under).collect::<Result<Vec<_>, _>>()
    };
    let results = cameras.par_iter().map(one).collect::<Result<Vec<_>, _>>()?;
    let results = results.into_iter().flatten().flatten().collect();
    Ok(Outcome { results, surfaces_left_out: request.surfaces.len() - surfaces.len() })
}

fn judge(
    camera: &Known,
    population: &Population,
    set: &VirtualSet,
    light: &LightSource,
    request: &Request,
) -> Result<Vec<Judgement>, Error> {
    let fault = |source: CalibrateError| Error::fit(light, source);
    let spectrum = light.spectrum.as_ref().ok_or_else(|| fault(CalibrateError::NoSpectrum))?;
    let spectrum = cut(spectrum, request.between);
    let there = camera.sensitivities.under(&spectrum).ok_or_else(|| fault(CalibrateError::BlindChannel))?;
    let chart = there.render(&request.chart.reflectances, &spectrum).map_err(|e| fault(e.into()))?;
    let judged = Seen::by(&there, &spectrum, &request.judged).map_err(|e| fault(e.into()))?;
    let prior = Prior::under(population, &spectrum).ok_or(Error::Prior)?;
    let reflectances = &request.chart.reflectances;
    let knowledge = Knowledge { reflectances, light: &spectrum, prior: &prior, set };
    let one = |kind: Kind| {
        let model = match kind {
            Kind::Spectral | Kind::Chromatic => spectral::model_only(&chart, knowledge, kind),
            _ => fit(&chart, kind).map(|found| found.fit.model),
        };
        let model = model.map_err(|e| fault(e.into()))?;
        Ok(Judgement {
            camera: camera.names[0].clone(),
            light: light.light.name.clone(),
            kind,
            errors: judged.errors(&model),
            sets: judged.means(&model),
        })
    };
    MODELS.into_iter().map(one).collect()
}
