//! Profiles from a camera's spectral sensitivities, without a shot.

use std::path::PathBuf;

use darkroot_calibrate::known_camera::{calibrate, judge};
use darkroot_colour::Spectrum;
use darkroot_profile::camera::KnownCamera;
use darkroot_profile::{Kind, Origin, Profile, ProfileCamera};

use crate::fault::SpectraError;
use crate::light::LightSource;
use crate::{Error, spectra};

/// What a profile is made from. Without reflectances to fit to, the profile is the camera itself, and its models follow from
/// the sensitivities and the surfaces that are built into the program.
#[derive(Debug, Clone, PartialEq)]
pub struct FromSpectra {
    /// The camera, as raw files name it.
    pub camera: ProfileCamera,
    /// File with three spectra: red, green, blue.
    pub sensitivities: PathBuf,
    /// Lights, a calibration for each; those that a camera is judged under.
    pub lights: Vec<LightSource>,
    /// Files of reflectances to fit to; may be empty.
    pub reflectances: Vec<PathBuf>,
    /// Files of reflectances to judge by.
    pub held_out: Vec<PathBuf>,
    /// Kind of model for reflectances.
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
    let judged_by = match judges.names.is_empty() {
        true => String::new(),
        false => format!("; held-out figures are those of {} ({})", held_out.len(), judges.names),
    };
    let origin = |summary: String| Origin {
        summary: summary + &judged_by,
        chart: String::new(),
        reference: sources.names.clone(),
        reference_sha256: sources.sha256.clone(),
        sensitivities: name(&request.sensitivities),
        sensitivities_sha256: file.sha256.clone(),
        date: request.date.clone(),
        program: format!("darkroot {}", crate::VERSION),
    };
    if training.is_empty() {
        let known = KnownCamera::new(&camera)
            .ok_or_else(|| Error::spectra(&request.sensitivities, SpectraError::Blind))?;
        let mut judged = Vec::new();
        for light in request.lights.iter().filter(|_| !held_out.is_empty()) {
            judged.push(judge(&camera, &known, light, &held_out).map_err(|e| Error::fit(light, e))?);
        }
        let origin = origin("the camera's measured spectral sensitivities".to_owned());
        return Ok(Profile::of_camera(request.camera.clone(), known.judged(judged), origin));
    }
    let calibrations = request
        .lights
        .iter()
        .map(|light| {
            calibrate(&camera, light, &training, &held_out, request.kind).map_err(|e| Error::fit(light, e))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let summary =
        format!("fitted to {} reflectances through the camera's spectral sensitivities", training.len());
    let origin = origin(summary);
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
