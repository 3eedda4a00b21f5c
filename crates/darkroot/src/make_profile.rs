//! Shots of a chart to a profile.

use darkroot_calibrate::calibrate;
use darkroot_calibrate::fit::Choice;
use darkroot_calibrate::gates::{self, Departure};
use darkroot_calibrate::series::{self, Member};
use darkroot_photo::Camera;
use darkroot_profile::{Origin, Profile, ProfileCamera};

use crate::fault::ChartError;
use crate::light::LightSource;
use crate::shot::{ChartRequest, Found, Gate, Shot, View, WhichReference, common_name, open_view, refuse};
use crate::shown;
use crate::{Error, Settings};

pub use darkroot_calibrate::{Calibrated, Compared, JudgedPatch};

/// Red or blue against green, as a natural logarithm, from which the camera's white is another than the light's.
const OTHER_WHITE: f64 = 0.15;

/// One light of a made profile.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeLight {
    /// The light.
    pub light: LightSource,
    /// The shots under it.
    pub shots: Vec<Shot>,
    /// What was checked between the shots: `linearity` of an exposure bracket, `agreement` of what is averaged; and
    /// whether the `light` is the one that was named.
    pub gates: Vec<Gate>,
    /// The calibration.
    pub calibrated: Calibrated,
    /// Gains of red, green and blue that show the chart as it is, where the white balance in the file is another.
    pub white_balance: Option<[f64; 3]>,
    /// The first shot, to look at.
    pub view: View,
}

impl MadeLight {
    /// The light that the shots themselves show, by the camera's own matrices; none where there are none.
    pub fn light_found(&self) -> Option<LightSource> {
        let matrix = self.view.matrix.as_ref()?;
        LightSource::of_white(matrix.white_of(self.calibrated.white_rgb))
    }
}

/// A profile and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeProfile {
    /// The profile.
    pub profile: Profile,
    /// Its lights, as they were given.
    pub lights: Vec<MadeLight>,
}

/// Measures the shots and fits the profile.
///
/// # Errors
/// Shots that cannot be used, shots of several cameras, too few patches.
pub fn make_profile(request: &ChartRequest, settings: &Settings) -> Result<MadeProfile, Error> {
    let mut names: Vec<&str> = Vec::new();
    for (_, light) in &request.shots {
        if !names.contains(&light.light.name.as_str()) {
            names.push(&light.light.name);
        }
    }
    let mut series = Series::default();
    let mut lights: Vec<MadeLight> = Vec::new();
    for name in names {
        let opened = series.open(request, name, settings)?;
        let Some((_, light)) = request.shots.iter().find(|(_, l)| l.light.name == name) else { continue };
        lights.push(made_light(request, light, opened)?);
    }
    let camera = series.camera.ok_or(Error::NoLight)?;
    let calibrations = lights.iter().map(|l| l.calibrated.calibration.clone()).collect();
    let origin = origin(request, series.reference.as_ref());
    let profile = Profile::new(named(&camera), calibrations, origin).ok_or(Error::NoLight)?;
    Ok(MadeProfile { profile, lights })
}

/// What all shots of a profile share.
#[derive(Default)]
struct Series<'a> {
    camera: Option<Camera>,
    reference: Option<WhichReference<'a>>,
}

impl<'a> Series<'a> {
    /// Measures the shots under one light; all must be of one camera.
    fn open(
        &mut self,
        request: &'a ChartRequest,
        light: &str,
        settings: &Settings,
    ) -> Result<Vec<(Shot, View)>, Error> {
        let mut opened = Vec::new();
        for (path, light) in request.shots.iter().filter(|(_, l)| l.light.name == light) {
            let (layout, options) = (&request.layout, &request.options);
            let view = open_view(path, options, settings)?;
            let found = Found::new(path, &view, layout, options, settings)?;
            let which = self.reference.get_or_insert_with(|| WhichReference::of(request, &found, light));
            let mut shot = found.shot(layout, which.reference, options)?;
            shot.notes.extend(which.note.clone());
            let first = self.camera.get_or_insert_with(|| shot.camera.clone());
            if *first != shot.camera {
                let (camera, other) = (common_name(&shot.camera), common_name(first));
                return Err(Error::chart(path, ChartError::SeveralCameras { camera, other }));
            }
            opened.push((shot, view));
        }
        Ok(opened)
    }
}

/// One light: its shots as one measurement, and the fit to it.
fn made_light(
    request: &ChartRequest,
    light: &LightSource,
    opened: Vec<(Shot, View)>,
) -> Result<MadeLight, Error> {
    let (shots, views): (Vec<Shot>, Vec<View>) = opened.into_iter().unzip();
    let view = views.into_iter().next().ok_or(Error::NoLight)?;
    let members: Vec<Member<'_>> =
        shots.iter().map(|s| Member { patches: &s.patches, cross_validation: &s.cross_validation }).collect();
    let mut gates = between(&shots, &members, light, request)?;
    let patches = series::combined(&members.iter().map(|m| m.patches).collect::<Vec<_>>());
    let cross_validation = series::combined_cross_validation(&members);
    let choice = Choice { kind: request.kind, cross_validation };
    let calibrated = calibrate(light, &patches, &choice).map_err(|e| Error::fit(light, e))?;
    if let Some(matrix) = &view.matrix {
        let found = matrix.white_of(calibrated.white_rgb);
        gates.push(gates::light(found, light.light.xy, &light.light.name));
    }
    let white_balance = view.as_shot.and_then(|as_shot| other_white(as_shot, calibrated.white_rgb));
    Ok(MadeLight { light: light.clone(), shots, gates, calibrated, white_balance, view })
}

/// Checks of the shots under one light against the first of them.
fn between(
    shots: &[Shot],
    members: &[Member<'_>],
    light: &LightSource,
    request: &ChartRequest,
) -> Result<Vec<Gate>, Error> {
    if !request.average
        && let Some((one, other)) = series::same_exposure(members)
    {
        let (one, other) = (shots[one].path.clone(), shots[other].path.clone());
        return Err(Error::SeveralShots { one, other, light: light.light.name.clone() });
    }
    let checks: [fn(Departure) -> Gate; 2] = [gates::linearity, gates::agreement];
    let mut gates = Vec::new();
    for (worst, check) in series::departures(members).into_iter().zip(checks) {
        let Some((worst, departure)) = worst else { continue };
        let path = &shots[worst].path;
        let gate = check(Departure::of(&shown(path), departure));
        refuse(path, std::slice::from_ref(&gate), request.options.accept)?;
        gates.push(gate);
    }
    Ok(gates)
}

/// The gains for the light of the chart, where the camera's white balance is not that of this light.
fn other_white(as_shot: [f64; 3], white: [f64; 3]) -> Option<[f64; 3]> {
    let ratio = |c: usize| (as_shot[c] / as_shot[1] * white[1] / white[c]).ln().abs();
    (ratio(0).max(ratio(2)) > OTHER_WHITE).then(|| white.map(|v| white[1] / v))
}

/// The camera as a profile names it, with the name in its files where that is another.
fn named(camera: &Camera) -> ProfileCamera {
    let alias = format!("{} {}", camera.make, camera.model);
    let is_known = alias.trim() == common_name(camera).trim();
    ProfileCamera {
        make: camera.common_make.clone(),
        model: camera.common_model.clone(),
        aliases: if is_known { Vec::new() } else { vec![alias] },
    }
}

fn origin(request: &ChartRequest, which: Option<&WhichReference<'_>>) -> Origin {
    let count = request.shots.len();
    Origin {
        summary: format!("{count} shot{} of a chart", if count == 1 { "" } else { "s" }),
        chart: request.layout.title.clone(),
        reference: which.map_or_else(|| request.reference_name.clone(), |w| w.name.to_owned()),
        reference_sha256: which.map_or_else(|| request.reference_sha256.clone(), |w| w.sha256.to_owned()),
        date: request.date.clone(),
        program: format!("darkroot {}", crate::VERSION),
        ..Origin::default()
    }
}
