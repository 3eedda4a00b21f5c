//! What a worker does with a chart shot: finding the chart, and making a profile of it.

use std::path::Path;

use darkroot::fault::ChartError;
use darkroot::make_profile::ChartRequest;
use darkroot::{Error, Settings, ShotOptions, charts, find_chart, light, make_profile, store};

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

/// Makes a profile of a chart shot and writes it.
pub(crate) fn calibrate(task: &Calibrate, settings: &Settings) -> Result<SessionColour, Error> {
    let input = &task.input;
    let layout = charts::layout(&task.layout)?;
    let reference = charts::reference(task.reference.as_deref(), &layout)?;
    let request = ChartRequest {
        shots: vec![(input.clone(), light::find(&task.light)?)],
        layout,
        reference: reference.colours,
        reference_name: reference.name,
        reference_sha256: reference.sha256,
        options: ShotOptions::default(),
        kind: None,
        average: false,
        date: String::new(),
    };
    let made = make_profile(&request, settings)?;
    let first = made.lights.first().ok_or(Error::NoLight)?;
    let camera = first.shots.first().map(|s| CameraNames::from(&s.camera)).unwrap_or_default();
    let white = first.calibrated.white_rgb;
    if white.iter().any(|v| *v <= 0.0) {
        return Err(Error::chart(input, ChartError::DarkGreys));
    }
    store::write(&made.profile, &task.profile, true)?;
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
