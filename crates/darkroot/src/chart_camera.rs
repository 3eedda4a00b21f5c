//! Shots of a chart, or tables of its patches, to a profile that is a camera, so that a shot in daylight serves the evening, too.

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Spectrum, white};
use darkroot_profile::camera::{ChartSeen, Judged, KnownCamera, Observation, Posterior};
use darkroot_profile::{Errors, Profile};
use rayon::prelude::*;

use crate::estimate::{listed, peers, published};
use crate::from_table::TableProfile;
use crate::make_profile::{Calibrated, MadeProfile};
use crate::{Error, LightSource, Limits, files};

/// In how many groups patches are left out to see how good it is.
const GROUPS: usize = 12;

/// The patches under one light.
struct SeenIn<'a> {
    light: &'a LightSource,
    calibrated: &'a Calibrated,
}

/// The profile of shots as a camera: the most probable one by the published matrix in the first shot, other cameras, and
/// the patches under every light. How far it is off under the light of each shot is found with a twelfth of the patches left
/// out at a time.
///
/// # Errors
/// A light without a spectrum, patches without reflectances, a channel that sees nothing.
pub fn chart_camera(made: &MadeProfile) -> Result<Profile, Error> {
    let first = made.lights.first().and_then(|light| light.shots.first()).ok_or(Error::NoLight)?;
    let header =
        files::read(&first.path).ok().and_then(|b| darkroot_raw::header(&b, &Limits::default()).ok());
    let seen = made.lights.iter().map(|made| SeenIn { light: &made.light, calibrated: &made.calibrated });
    camera(&made.profile, header.as_ref().and_then(published).as_ref(), &seen.collect::<Vec<_>>())
}

/// The same for a profile of tables of patches. The published matrix is the one that decoders list for the camera.
///
/// # Errors
/// As [`chart_camera`]; colours that were measured in the light itself tell of no other light.
pub fn table_camera(made: &TableProfile) -> Result<Profile, Error> {
    let seen = made.lights.iter().map(|(light, calibrated)| SeenIn { light, calibrated });
    camera(&made.profile, listed(&made.profile.camera().name()).as_ref(), &seen.collect::<Vec<_>>())
}

fn camera(made: &Profile, matrix: Option<&Observation>, lights: &[SeenIn<'_>]) -> Result<Profile, Error> {
    let peers = peers().ok_or(Error::Prior)?;
    let by_matrix = matrix.and_then(|matrix| Posterior::of(peers, matrix));
    let start = by_matrix.unwrap_or_else(|| Posterior::mean_camera(peers));
    let unusable = |seen: &SeenIn<'_>| Error::NoCamera { light: seen.light.light.name.clone() };
    let first = lights.first().ok_or(Error::NoLight)?;
    let camera = refined(&start, lights, None).ok_or_else(|| unusable(first))?;
    let judged = |(place, seen): (usize, &SeenIn<'_>)| {
        let errors = left_out(&start, lights, place).ok_or_else(|| unusable(seen))?;
        Ok(Judged { light: seen.light.light.name.clone(), errors: errors.rounded() })
    };
    let judged = lights.iter().enumerate().map(judged).collect::<Result<Vec<_>, Error>>()?;
    let summary = format!("the camera by {}", made.origin().summary);
    let origin = darkroot_profile::Origin { summary, ..made.origin().clone() };
    Ok(Profile::of_camera(made.camera().clone(), camera.judged(judged), origin))
}

/// Patches of a light that are left out: those whose number leaves this rest.
#[derive(Clone, Copy)]
struct Without {
    light: usize,
    rest: usize,
}

fn refined(start: &Posterior, lights: &[SeenIn<'_>], without: Option<Without>) -> Option<KnownCamera> {
    let mut camera = start.clone();
    for (place, made) in lights.iter().enumerate() {
        let kept = |i: usize| without.is_none_or(|w| w.light != place || i % GROUPS != w.rest);
        let all = made.calibrated.seen.iter().enumerate();
        let patches: Vec<_> = all.filter(|(i, _)| kept(*i)).map(|(_, seen)| seen.clone()).collect();
        let light = made.light.spectrum.as_ref().filter(|_| !patches.is_empty())?;
        camera = camera.refined(ChartSeen { light, white: made.calibrated.white_rgb, patches: &patches })?;
    }
    KnownCamera::new(&camera.sensitivities())
}

/// Errors under one light, of patches that took no part.
fn left_out(start: &Posterior, lights: &[SeenIn<'_>], place: usize) -> Option<Errors> {
    let made = &lights[place];
    let light: &Spectrum = made.light.spectrum.as_ref()?;
    let back = bradford(white::D50, light.white());
    let seen = &made.calibrated.seen;
    let group = |rest: usize| {
        let camera = refined(start, lights, Some(Without { light: place, rest }))?;
        let model = camera.model_under(light)?.then(&back);
        let mine = seen.iter().enumerate().filter(|(i, _)| i % GROUPS == rest);
        Some(mine.map(|(i, (_, rgb))| (i, model.xyz(*rgb))).collect::<Vec<_>>())
    };
    let groups: Vec<_> = (0..GROUPS.min(seen.len())).into_par_iter().map(group).collect::<Option<_>>()?;
    let mut estimates: Vec<_> = groups.into_iter().flatten().collect();
    estimates.sort_by_key(|(i, _)| *i);
    let estimates: Vec<_> = estimates.into_iter().map(|(_, xyz)| xyz).collect();
    let truth: Vec<_> = seen.iter().map(|(reflectance, _)| reflectance.reflected_xyz(light)).collect();
    Some(Errors::between(&estimates, &truth, light.white()))
}
