//! Profiles from a camera's spectral sensitivities, without a shot.

use std::path::PathBuf;

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Spectrum, Xyz, white};
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{self, Samples, spectral};
use darkroot_profile::{
    Calibration, Errors, Figures, Kind, Model, Origin, Patch, Profile, ProfileCamera, Sensitivities,
};

use crate::light::NamedLight;
use crate::{Error, spectra};

/// Most colours whose single residuals a profile keeps.
const MOST_PATCHES: usize = 250;

/// What a profile is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct FromSpectra {
    /// The camera, as raw files name it.
    pub camera: ProfileCamera,
    /// File with three spectra: red, green, blue.
    pub sensitivities: PathBuf,
    /// Lights, a calibration for each.
    pub lights: Vec<NamedLight>,
    /// Files of reflectances to fit to.
    pub reflectances: Vec<PathBuf>,
    /// Files of reflectances to judge by.
    pub held_out: Vec<PathBuf>,
    /// Kind of model.
    pub kind: Kind,
    /// Day that the profile carries, YYYY-MM-DD; may be empty.
    pub date: String,
}

/// Fits the profile.
///
/// # Errors
/// Files that cannot be used, lights without a spectrum, too few colours.
pub fn from_spectra(request: &FromSpectra) -> Result<Profile, Error> {
    let (camera, file) = spectra::read_sensitivities(&request.sensitivities)?;
    let (training, sources) = read_all(&request.reflectances)?;
    let (held_out, judges) = read_all(&request.held_out)?;
    let calibrations = request
        .lights
        .iter()
        .map(|light| calibrate(&camera, light, &training, &held_out, request.kind))
        .collect::<Result<Vec<_>, _>>()?;
    let mut summary =
        format!("fitted to {} reflectances through the camera's spectral sensitivities", training.len());
    if !judges.names.is_empty() {
        summary += &format!("; held-out figures are those of {} ({})", held_out.len(), judges.names);
    }
    let origin = Origin {
        summary,
        chart: String::new(),
        reference: sources.names,
        reference_sha256: sources.sha256,
        sensitivities: name(&request.sensitivities),
        sensitivities_sha256: file.sha256,
        date: request.date.clone(),
        program: format!("darkroot {}", crate::VERSION),
    };
    Profile::new(request.camera.clone(), calibrations, origin).ok_or(Error::NoLight)
}

struct Sources {
    /// File names, joined.
    names: String,
    /// Hashes, joined.
    sha256: String,
}

fn name(path: &std::path::Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn read_all(paths: &[PathBuf]) -> Result<(Vec<(String, Spectrum)>, Sources), Error> {
    let (mut all, mut names, mut hashes) = (Vec::new(), Vec::new(), Vec::new());
    for path in paths {
        let file = spectra::read(path)?;
        let labels = file.spectra.iter().map(|(n, _)| n.clone());
        all.extend(labels.zip(file.reflectances()));
        names.push(name(path));
        hashes.push(file.sha256);
    }
    Ok((all, Sources { names: names.join(", "), sha256: hashes.join(", ") }))
}

fn calibrate(
    camera: &Sensitivities,
    light: &NamedLight,
    training: &[(String, Spectrum)],
    held_out: &[(String, Spectrum)],
    kind: Kind,
) -> Result<Calibration, Error> {
    let name = &light.light.name;
    let fault = |what: &dyn std::fmt::Display| Error::Fit { light: name.clone(), what: what.to_string() };
    let spectrum =
        light.spectrum.as_ref().ok_or_else(|| fault(&"its spectrum is not known; name a lamp or a file"))?;
    let effective =
        camera.under(spectrum).ok_or_else(|| fault(&"a channel of the camera sees nothing of it"))?;
    let spectra_of = |set: &[(String, Spectrum)]| set.iter().map(|(_, s)| s.clone()).collect::<Vec<_>>();
    let render = |set| effective.render(&spectra_of(set), spectrum).map_err(|e| fault(&e));
    let samples = render(training)?;
    let fit = match kind {
        Kind::Spectral | Kind::Chromatic => {
            let set = VirtualSet::of(&spectra_of(training));
            spectral::fit_known_camera(&set, &effective, spectrum, &samples, kind).map_err(|e| fault(&e))?
        }
        _ => fit::fit(&samples, kind).map_err(|e| fault(&e))?.fit,
    };
    let mut figures = fit.figures(&samples);
    if !held_out.is_empty() {
        figures.held_out = Some(errors(&fit.model, &render(held_out)?));
    }
    let names: Vec<&str> = training.iter().map(|(n, _)| n.as_str()).collect();
    Ok(calibration(light, kind, &fit.model, figures, &samples, &names))
}

/// Errors of a model over colours.
fn errors(model: &Model, samples: &Samples) -> Errors {
    let estimates: Vec<Xyz> = samples.rgb().iter().map(|rgb| model.xyz(*rgb)).collect();
    Errors::between(&estimates, samples.xyz(), samples.white())
}

/// A fit as a calibration: its XYZ relative to D50, with the residual of each colour where they are few.
pub(crate) fn calibration(
    light: &NamedLight,
    kind: Kind,
    model: &Model,
    figures: Figures,
    samples: &Samples,
    names: &[&str],
) -> Calibration {
    let to_d50 = bradford(samples.white(), white::D50);
    let adapted = |c: Xyz| Xyz::from(to_d50 * darkroot_colour::Vector3::from(c));
    let model = model.then(&to_d50).rounded();
    let patch = |(name, (rgb, xyz)): (&&str, (&[f64; 3], &Xyz))| {
        let (xyz, found) = (adapted(*xyz), model.xyz(*rgb));
        let de2000 = darkroot_colour::difference::de2000(found.lab(white::D50), xyz.lab(white::D50));
        Patch { name: (*name).to_owned(), rgb: *rgb, xyz, de2000 }
    };
    let pairs = names.iter().zip(samples.rgb().iter().zip(samples.xyz()));
    let patches = if samples.len() <= MOST_PATCHES { pairs.map(patch).collect() } else { Vec::new() };
    Calibration { light: light.light.clone(), kind, model, figures: figures.rounded(), patches }
}
