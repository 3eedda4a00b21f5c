//! Colours of a camera without a profile: those of the camera that its published matrix makes most probable.

use std::path::Path;
use std::sync::OnceLock;

use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Illuminant, Matrix3, Spectrum, Vector3};
use darkroot_photo::{Camera, Capture, Layout};
use darkroot_profile::camera::{Estimate, Observation, Peers};
use darkroot_profile::{Origin, Profile, ProfileCamera, Sensitivities};
use darkroot_raw::{Limits, Listed};

use crate::{Error, ProfileStore};

/// Light of a matrix that names none, as lists of camera matrices have it, K.
const UNNAMED: f64 = 6504.0;
/// Matrices for warmer lights than this are for lamps.
const WARMEST_DAYLIGHT: f64 = 4000.0;

/// An estimate as a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// The camera that was estimated.
    pub profile: Profile,
    /// How sure it is, and what it was made from.
    pub estimate: Estimate,
}

impl Estimated {
    /// What the colours rest on, in words: "estimated from the camera's matrix (expected dE2000 1.0)".
    pub fn words(&self) -> String {
        let from = match self.estimate.expected_of_matrix {
            Some(_) => "estimated from the camera's matrix",
            None => "those of the mean camera, for no matrix is known",
        };
        format!("{from} (expected dE2000 {:.1})", self.estimate.expected)
    }
}

/// The camera of a capture, from the matrix that the file or the decoder has for daylight, or the nearest to it; a second
/// one for another light adds nothing (measured). `None` for sensors without colour, for pictures that are no mosaic and
/// have no matrix, and where the matrix itself is to be expected to be better.
pub fn estimate(capture: &Capture) -> Option<Estimated> {
    let layout = capture.counts.layout();
    if *layout == Layout::Monochrome || (*layout == Layout::Rgb && capture.calibrations.is_empty()) {
        return None;
    }
    let estimated = of_matrix(&capture.camera, published(capture).as_ref())?;
    (!estimated.estimate.matrix_is_better()).then_some(estimated)
}

/// The camera of a photograph, or the one that a person names as decoders list it ("Nikon D90").
///
/// # Errors
/// A file that cannot be read, a name that is not in the list, a matrix that is not usable.
pub fn estimate_named(text: &str, limits: &Limits) -> Result<Estimated, Error> {
    let path = Path::new(text);
    if path.exists() || crate::settings::is_file_name(text) {
        let bytes = crate::files::read(path)?;
        let raw = |source| Error::Raw { path: path.to_owned(), source };
        let capture = darkroot_raw::header(&bytes, limits).map_err(raw)?;
        let published = published(&capture).ok_or(Error::Prior)?;
        return of_matrix(&capture.camera, Some(&published)).ok_or(Error::Prior);
    }
    let found = entry(text).ok_or_else(|| Error::NotListed { text: text.to_owned() })?;
    let published = of_entry(&found);
    let camera = Camera { common_make: found.make, common_model: found.model, ..Camera::default() };
    of_matrix(&camera, Some(&published)).ok_or(Error::Prior)
}

/// The matrix that decoders list for a camera ("Nikon D90").
pub(crate) fn listed(name: &str) -> Option<Observation> {
    entry(name).as_ref().map(of_entry)
}

fn entry(name: &str) -> Option<Listed> {
    let plain = |s: &str| s.to_lowercase().replace(char::is_whitespace, "");
    darkroot_raw::cameras().into_iter().find(|c| plain(&c.name()) == plain(name))
}

fn of_entry(entry: &Listed) -> Observation {
    Observation { light: light(UNNAMED), matrix: entry.color_matrix, listed: true }
}

fn of_matrix(camera: &Camera, published: Option<&Observation>) -> Option<Estimated> {
    let estimate = Estimate::of(peers()?, published)?;
    let profile = profile(camera, &estimate);
    Some(Estimated { profile, estimate })
}

/// The estimate as a profile of a camera.
fn profile(camera: &Camera, estimate: &Estimate) -> Profile {
    let written = format!("{} {}", camera.make, camera.model).trim().to_owned();
    let aliases = Some(written).filter(|name| !name.is_empty() && *name != camera.name());
    let names = ProfileCamera {
        make: camera.common_make.clone(),
        model: camera.common_model.clone(),
        aliases: aliases.into_iter().collect(),
    };
    let summary = match &estimate.family {
        Some(family) => format!("estimated from the camera's published matrix, by what is known of {family}"),
        None => "the mean of measured cameras; no matrix of this one is known".to_owned(),
    };
    let program = format!("darkroot {}", crate::VERSION);
    let origin = Origin { summary, program, ..Origin::default() };
    Profile::of_camera(names, estimate.camera.clone(), origin)
}

/// The matrix nearest to daylight, for this specimen of the camera.
pub(crate) fn published(capture: &Capture) -> Option<Observation> {
    let kelvin = |c: &darkroot_photo::Calibration| c.kelvin.unwrap_or(UNNAMED);
    let far = |c: &darkroot_photo::Calibration| (1e6 / kelvin(c) - 1e6 / UNNAMED).abs();
    let nearest = capture.calibrations.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
    let own = nearest.camera_calibration.unwrap_or_else(Matrix3::identity);
    let balance = Matrix3::from_diagonal(&Vector3::from(capture.analog_balance));
    // Only a DNG has matrices of its own.
    let listed = capture.source.format != "DNG" || darkroot_raw::is_listed(&nearest.color_matrix);
    Some(Observation { light: light(kelvin(nearest)), matrix: balance * own * nearest.color_matrix, listed })
}

/// The light that a matrix for this temperature is for.
fn light(kelvin: f64) -> Spectrum {
    let d65 = Illuminant::by_name("D65").map(|d65| d65.spectrum());
    let same = |light: &Spectrum| {
        light.white().xy().is_some_and(|xy| (1e6 / Temperature::of(xy).kelvin - 1e6 / kelvin).abs() < 2.0)
    };
    match d65.filter(same) {
        Some(d65) => d65,
        None if kelvin < WARMEST_DAYLIGHT => Spectrum::black_body(kelvin),
        None => Spectrum::daylight(kelvin),
    }
}

/// The cameras whose measured sensitivities are built into the program.
pub(crate) fn peers() -> Option<&'static Peers> {
    static PEERS: OnceLock<Option<Peers>> = OnceLock::new();
    let make = || {
        let store = ProfileStore::builtin();
        let known = store.all().into_iter().filter_map(|found| found.profile.known_camera());
        let known: Vec<Sensitivities> = known.map(|camera| camera.sensitivities().clone()).collect();
        Peers::with_builtin(&known)
    };
    PEERS.get_or_init(make).as_ref()
}
