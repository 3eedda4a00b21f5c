//! What a worker does with a chart shot: finding the chart, and making a profile of it.

use std::path::Path;

use darkroot::ChartRequest;
use darkroot::fault::ChartError;
use darkroot::files::{Output, Tree};
use darkroot::shot::{Finding, Verdict};
use darkroot::{
    Error, LightSource, MadeProfile, Settings, ShotOptions, charts, find_chart, light, make_profile, store,
};

use super::facts::{CameraNames, SessionColour};
use super::hash;
use super::task::Calibrate;

/// Least confidence of a chart that colours a session.
const SURE: f64 = 0.8;

/// Looks for a chart: those with a built-in reference, or the one named.
pub(crate) fn look(
    input: &Path,
    layout: Option<&str>,
    settings: &Settings,
) -> Result<Option<(String, f64)>, Error> {
    let layouts = match layout {
        Some(name) => vec![charts::layout(name)?],
        None => charts::layouts().into_iter().filter(|l| charts::reference(None, l).is_ok()).collect(),
    };
    let found = find_chart::find_charts(input, &layouts, settings)?;
    let best = found.search.found.into_iter().next();
    Ok(best.filter(|f| f.confidence >= SURE).map(|f| (f.layout, f.confidence)))
}

/// Makes the profile under the light that was named, and refuses a shot that was taken in another; where none was named,
/// under the light that the shot itself shows.
fn made_in_its_light(
    mut request: ChartRequest,
    is_named: bool,
    settings: &Settings,
) -> Result<MadeProfile, Error> {
    let made = make_profile(&request, settings)?;
    let Some(first) = made.lights.first() else { return Ok(made) };
    if is_named {
        let other = first.gates.iter().find(|g| matches!(g.finding, Finding::Light { .. }));
        if let Some(gate) = other.filter(|g| g.verdict != Verdict::Good) {
            return Err(Error::chart(&request.shots[0].0, ChartError::Refused(Box::new(gate.clone()))));
        }
        return Ok(made);
    }
    match first.light_found() {
        Some(light) => {
            request.shots[0].1 = light;
            make_profile(&request, settings)
        }
        None => Ok(made),
    }
}

/// Opens the profile's file.
pub(crate) fn open(task: &Calibrate) -> Result<Output, Error> {
    let scratch = task.profile.parent().unwrap_or(&task.out).to_owned();
    let tree = Tree { root: task.out.clone(), scratch };
    Output::open(&task.profile, Some(&tree)).map_err(|e| Error::write(&task.profile, e))
}

/// Makes a profile of a chart shot and writes it.
pub(crate) fn calibrate(
    output: Output,
    task: &Calibrate,
    settings: &Settings,
) -> Result<SessionColour, Error> {
    let input = &task.input;
    let layout = charts::layout(&task.layout)?;
    let reference = charts::reference(task.reference.as_deref(), &layout)?;
    let named = task.light.as_deref().map(light::find).transpose()?;
    let light = named.clone().unwrap_or_else(LightSource::assumed);
    let shots = vec![(input.clone(), light)];
    let request = ChartRequest::of(shots, layout, reference, ShotOptions::default());
    let made = made_in_its_light(request, named.is_some(), settings)?;
    let first = made.lights.first().ok_or(Error::NoLight)?;
    let camera = first.shots.first().map(|s| CameraNames::from(&s.camera)).unwrap_or_default();
    let white = first.calibrated.white_rgb;
    if white.iter().any(|v| *v <= 0.0) {
        return Err(Error::chart(input, ChartError::DarkGreys));
    }
    store::write_into(output, &made.profile, &task.profile)?;
    Ok(SessionColour {
        camera,
        chart: String::new(),
        profile: task.profile.clone(),
        sha256: hash::text(&darkroot_profile::file::format(&made.profile)),
        multipliers: white.map(|v| white[1] / v),
        left_out: first
            .calibrated
            .calibration
            .figures
            .leave_one_out
            .as_ref()
            .map_or(f64::NAN, |e| e.de2000.mean),
    })
}
