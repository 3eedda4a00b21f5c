//! How good the colours of a camera are that was estimated from its published matrix, where its sensitivities are known.
//!
//! Each camera is judged with all that rests on it taken out: it and every camera with the same name or the same published
//! matrix leave the prior and the offsets, and surfaces that are judged on leave the surfaces of the prior.

use std::path::{Path, PathBuf};

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Matrix3, Spectrum, Vector3};
use darkroot_profile::camera::{
    Difference, Estimate, Observation, Peers, Regression, computed, families, light,
};
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{fit, root_set};
use darkroot_profile::{Kind, Model, Sensitivities, Summary, lint};
use rayon::prelude::*;

use super::ReflectanceSet;
use super::cameras::{cut, names, without_judged};
use super::published::{Published, named};
use super::seen::Seen;
use crate::fault::SpectraError;
use crate::light::LightSource;
use crate::{Error, ProfileStore, spectra};

/// Into how many parts the surfaces of the prior are cut, of each of which matrices are computed.
const TRAINING_SETS: usize = 4;

/// What is judged, and by what.
#[derive(Debug, Clone)]
pub struct Request {
    /// Published matrices.
    pub published: Vec<Published>,
    /// Sensitivities of the cameras of the prior.
    pub prior: Vec<PathBuf>,
    /// Sensitivities of the cameras that are judged.
    pub cameras: Vec<PathBuf>,
    /// Surfaces of the prior.
    pub surfaces: Vec<Spectrum>,
    /// Surfaces that are judged on.
    pub judged: Vec<ReflectanceSet>,
    /// Patches of a chart, for comparison: a matrix is fitted to them under each light.
    pub chart: Option<ReflectanceSet>,
    /// Lights.
    pub lights: Vec<LightSource>,
    /// Wavelengths that count, nm; many cameras were measured over less than the whole range.
    pub between: (f64, f64),
}

/// How the colours were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// By the published matrix.
    Matrix,
    /// By the estimated camera, the light's spectrum known.
    Spectrum,
    /// By the estimated camera, only the light's white known.
    White,
    /// By a matrix fitted to the chart under that light.
    Chart,
}

impl Method {
    /// All of them, in the sequence of tables.
    pub const ALL: [Self; 4] = [Self::Matrix, Self::Spectrum, Self::White, Self::Chart];
}

impl std::fmt::Display for Method {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.pad(match self {
            Self::Matrix => "published matrix",
            Self::Spectrum => "estimated camera, spectrum known",
            Self::White => "estimated camera, white known",
            Self::Chart => "matrix fitted to a chart in this light",
        })
    }
}

/// How one camera did under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The camera, by the published matrix's name.
    pub camera: String,
    /// Name of the light.
    pub light: String,
    /// dE2000 of each method over all surfaces that are judged on.
    pub errors: Vec<(Method, Summary)>,
    /// The same for each set, mean only.
    pub sets: Vec<(Method, Vec<f64>)>,
    /// Noise in dark saturated colours, white known, against that of each matrix: the largest of three colours.
    pub noise: Vec<(Method, f64)>,
    /// Mean dE2000 under D65 that was to be expected of the estimated camera, and of the matrix: the program takes the one
    /// of which less is to be expected.
    pub expected: [f64; 2],
}

impl Judgement {
    /// Whether the program would take the matrix.
    pub fn matrix_is_taken(&self) -> bool {
        self.expected[1] < self.expected[0]
    }
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Each camera under each light.
    pub results: Vec<Judgement>,
    /// Files of cameras for which no published matrix was found.
    pub without_matrix: Vec<PathBuf>,
    /// Surfaces of the prior that were left out because they are judged on.
    pub surfaces_left_out: usize,
}

/// A camera with both.
struct Known {
    name: String,
    sensitivities: Sensitivities,
    matrix: Matrix3,
}

/// Judges every camera.
///
/// # Errors
/// Files that cannot be used, lights without a spectrum, fewer cameras than a prior needs.
pub fn evaluate(request: &Request) -> Result<Outcome, Error> {
    let mut without_matrix = Vec::new();
    let prior = read(&request.prior, &request.published, &mut without_matrix)?;
    let cameras = read(&request.cameras, &request.published, &mut without_matrix)?;
    without_matrix.sort();
    without_matrix.dedup();
    let surfaces = without_judged(&request.surfaces, &request.judged);
    let surfaces_left_out = request.surfaces.len() - surfaces.len();
    let cut = |light: &Spectrum| cut(light, request.between);
    let d65 = LightSource::by_name("D65")
        .and_then(|d65| d65.spectrum)
        .map(|d65| cut(&d65))
        .ok_or(Error::NoLight)?;
    let weighted: Vec<(Spectrum, f64)> = surfaces.iter().map(|s| (s.clone(), 1.0)).collect();
    let undetermined = || Error::Prior;
    let regression = Regression::under(&d65, &weighted).ok_or_else(undetermined)?;
    let set = VirtualSet::of(&surfaces);
    let parts: Vec<Vec<Spectrum>> =
        surfaces.chunks(surfaces.len().div_ceil(TRAINING_SETS).max(1)).map(<[Spectrum]>::to_vec).collect();
    let one = |camera: &Known| {
        let others: Vec<&Known> = prior.iter().filter(|p| !twins(p, camera)).collect();
        let known: Vec<Sensitivities> = others.iter().map(|p| p.sensitivities.clone()).collect();
        let differences: Vec<Difference> =
            others.iter().filter_map(|p| Difference::of(&regression, &p.sensitivities, &p.matrix)).collect();
        let of_parts = known.iter().flat_map(|camera| computed(&regression, &d65, camera, &parts));
        let families = families(&differences, &of_parts.collect::<Vec<_>>());
        let peers = Peers::new(&known, weighted.clone(), families).ok_or_else(undetermined)?;
        let published = Observation { light: d65.clone(), matrix: camera.matrix, listed: true };
        let estimate = Estimate::judged(&peers, Some(&published), &set, &d65).ok_or_else(undetermined)?;
        let judge = |light: &LightSource| judge(camera, &estimate, &set, light, request);
        request.lights.iter().map(judge).collect::<Result<Vec<_>, _>>()
    };
    let results = cameras.par_iter().map(one).collect::<Result<Vec<_>, _>>()?;
    Ok(Outcome { results: results.into_iter().flatten().collect(), without_matrix, surfaces_left_out })
}

fn judge(
    camera: &Known,
    estimate: &Estimate,
    set: &VirtualSet,
    light: &LightSource,
    request: &Request,
) -> Result<Judgement, Error> {
    let fault = |source: darkroot_calibrate::CalibrateError| Error::fit(light, source);
    let blind = || fault(darkroot_calibrate::CalibrateError::BlindChannel);
    let whole =
        light.spectrum.as_ref().ok_or_else(|| fault(darkroot_calibrate::CalibrateError::NoSpectrum))?;
    let spectrum = cut(whole, request.between);
    let camera_there = camera.sensitivities.under(&spectrum).ok_or_else(blind)?;
    let model_under = |light: &Spectrum| -> Option<Model> {
        let rendered = set.render(&estimate.camera.sensitivities().under(light)?, light).ok()?;
        root_set::fit(&rendered).ok()
    };
    let white = Vector3::from(spectrum.white());
    let matrix =
        camera.matrix.try_inverse().ok_or_else(blind)? * Matrix3::from_diagonal(&(camera.matrix * white));
    let by_spectrum = model_under(&spectrum).ok_or_else(blind)?;
    let name = light.light.name.as_str();
    let same_lamp =
        |lamp: &darkroot_colour::Illuminant| name.replace("FL", "F").eq_ignore_ascii_case(lamp.name);
    let guess = whole.white().xy().and_then(|xy| light::with_white(xy, same_lamp)).ok_or_else(blind)?;
    let guess = cut(&guess, request.between);
    let back = bradford(guess.white(), spectrum.white());
    let by_white = model_under(&guess).ok_or_else(blind)?.then(&back);
    let mut methods = vec![
        (Method::Matrix, Model::linear(&matrix)),
        (Method::Spectrum, by_spectrum),
        (Method::White, by_white.clone()),
    ];
    if let Some(chart) = &request.chart {
        let samples = camera_there.render(&chart.reflectances, &spectrum).map_err(|e| fault(e.into()))?;
        methods.push((Method::Chart, fit(&samples, Kind::Linear).map_err(|e| fault(e.into()))?.fit.model));
    }
    let matrices = methods.iter().filter(|(method, _)| matches!(method, Method::Matrix | Method::Chart));
    let noise = matrices.map(|(of, model)| (*of, lint::noise_beside(&by_white, model, spectrum.white())));
    let noise = noise.collect();
    let judged = Seen::by(&camera_there, &spectrum, &request.judged).map_err(|e| fault(e.into()))?;
    Ok(Judgement {
        camera: camera.name.clone(),
        light: name.to_owned(),
        errors: methods.iter().map(|(method, model)| (*method, judged.errors(model))).collect(),
        sets: methods.iter().map(|(method, model)| (*method, judged.means(model))).collect(),
        noise,
        expected: [estimate.expected, estimate.expected_of_matrix.unwrap_or(f64::INFINITY)],
    })
}

/// Cameras that would tell of each other: of one name, or with one published matrix.
fn twins(one: &Known, other: &Known) -> bool {
    one.name == other.name || one.matrix == other.matrix
}

/// The cameras of these files that have a published matrix.
fn read(paths: &[PathBuf], published: &[Published], without: &mut Vec<PathBuf>) -> Result<Vec<Known>, Error> {
    let store = ProfileStore::builtin();
    let mut known = Vec::new();
    for path in paths {
        match names(&store, path).iter().find_map(|name| named(published, name)) {
            Some(found) => known.push(Known {
                name: found.name(),
                sensitivities: spectra::read_sensitivities(path)?.0,
                matrix: found.matrix,
            }),
            None => without.push(path.clone()),
        }
    }
    if known.len() < 2 {
        let path = paths.first().map_or(Path::new("cameras"), PathBuf::as_path);
        return Err(Error::spectra(path, SpectraError::NoMatrix));
    }
    Ok(known)
}
