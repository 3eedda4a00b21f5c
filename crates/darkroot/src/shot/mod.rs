//! A shot of a chart from its file: where the chart is, what its patches are, whether the shot is good enough.
//!
//! Files are read here; the science is that of [`darkroot_calibrate::shot`].

mod light;
pub(crate) mod rendered;
mod request;
mod view;
mod which;

use std::path::{Path, PathBuf};

use darkroot_calibrate::gates::Corrected;
use darkroot_calibrate::shot::{self, Chart, Companions, Treatment};
use darkroot_calibrate::{CrossValidation, MeasuredPatch};
use darkroot_chart::{ChartLayout, Measurement, Quad, Reference, Slope};

pub use darkroot_calibrate::gates::near;
pub use darkroot_calibrate::{Correct, Finding, Gate, Verdict};
pub(crate) use light::light_of;
pub use request::ChartRequest;
pub use view::View;
pub(crate) use view::common_name;
pub(crate) use which::WhichReference;

use crate::fault::ChartError;
use crate::find_chart::{self, Place};
use crate::{Error, Settings};

/// What a person says about a shot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShotOptions {
    /// Corners of the chart by hand: outer corners of the corner patches, in pixels of the developed picture, from
    /// patch 1 on clockwise as the chart is printed.
    pub corners: Option<Quad>,
    /// A shot of an even surface in the same light.
    pub flat: Option<PathBuf>,
    /// A shot with the lens closed.
    pub dark: Option<PathBuf>,
    /// Whether the slope of light over the chart is taken out, as far as the patches show it: for each channel on its own
    /// where the light's colour changes and patches that had no say in it bear that out, else one for all.
    pub even_out: Correct,
    /// Whether the glare is taken out that the patches show, channel by channel: it has the colour of what dazzles.
    pub correct_glare: Correct,
    /// Names of patches to leave out.
    pub exclude: Vec<String>,
    /// Use shots that fail a gate.
    pub accept: bool,
    /// Take rendered pictures (JPEG, PNG, TIFF) too.
    pub allow_rendered: bool,
}

/// A measured shot.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// The file.
    pub path: PathBuf,
    /// The camera.
    pub camera: darkroot_photo::Camera,
    /// Chart corners in pixels of the developed picture.
    pub corners: Quad,
    /// The part of each patch that was measured.
    pub windows: Vec<Quad>,
    /// How sure the detection is, 0..=1; 1 for corners by hand.
    pub confidence: f64,
    /// Every patch of the layout.
    pub patches: Vec<MeasuredPatch>,
    /// The measurements as they were, before corrections.
    pub measurements: Vec<Measurement>,
    /// Slope of light over the chart.
    pub slope: Slope,
    /// Stray light in green as a share of white.
    pub glare: f64,
    /// All patches as corrected without the help of some: what to cross-validate with. Empty where nothing was corrected
    /// by the patches themselves.
    pub cross_validation: Vec<CrossValidation>,
    /// What was checked.
    pub gates: Vec<Gate>,
    /// What had to be assumed.
    pub notes: Vec<String>,
    /// Exposure time in seconds, where the camera tells.
    pub exposure_seconds: Option<f64>,
    /// Day of the shot, YYYY-MM-DD, where the camera tells.
    pub date: Option<String>,
}

/// Opens a shot, finds and measures the chart, and checks whether it is good enough.
///
/// # Errors
/// Files that cannot be read, no chart, a reference that does not fit, a check that fails.
pub fn open(
    path: &Path,
    layout: &ChartLayout,
    reference: &Reference,
    options: &ShotOptions,
    settings: &Settings,
) -> Result<(Shot, View), Error> {
    let view = open_view(path, options, settings)?;
    let shot = judged(path, &view, layout, reference, options, settings)?;
    Ok((shot, view))
}

/// Decodes a shot.
pub(crate) fn open_view(path: &Path, options: &ShotOptions, settings: &Settings) -> Result<View, Error> {
    if options.allow_rendered { View::open_any(path, settings) } else { View::open(path, settings) }
}

/// As [`open`], for a shot that is open already: finds and measures the chart, and checks whether it is good enough.
///
/// # Errors
/// As [`open`].
pub fn judged(
    path: &Path,
    view: &View,
    layout: &ChartLayout,
    reference: &Reference,
    options: &ShotOptions,
    settings: &Settings,
) -> Result<Shot, Error> {
    Found::new(path, view, layout, options, settings)?.shot(layout, reference, options)
}

/// A shot in which the chart is found, and what helps to measure it.
pub(crate) struct Found<'a> {
    path: &'a Path,
    view: &'a View,
    place: Place,
    dark: Option<View>,
    flat: Option<View>,
}

impl<'a> Found<'a> {
    /// Finds the chart, and opens what helps.
    pub(crate) fn new(
        path: &'a Path,
        view: &'a View,
        layout: &ChartLayout,
        options: &ShotOptions,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let place = locate(view, layout, options).map_err(|e| Error::chart(path, e))?;
        let open = |file: &PathBuf| companion(file, view, settings);
        let dark = options.dark.as_ref().map(open).transpose()?;
        let flat = options.flat.as_ref().map(open).transpose()?;
        Ok(Self { path, view, place, dark, flat })
    }

    /// The shot by one reference of the chart.
    pub(crate) fn shot(
        &self,
        layout: &ChartLayout,
        reference: &Reference,
        options: &ShotOptions,
    ) -> Result<Shot, Error> {
        let chart = Chart::new(layout, reference).map_err(|e| Error::chart(self.path, e))?;
        let companions = Companions {
            dark: self.dark.as_ref().map(View::sensor_light),
            flat: self.flat.as_ref().map(View::sensor_light),
        };
        measured(self.path, self.view, self.place.clone(), &chart, companions, options)
    }
}

fn locate(view: &View, layout: &ChartLayout, options: &ShotOptions) -> Result<Place, ChartError> {
    locate_in(view, layout, options.corners.as_ref())
}

/// Where the chart is, by hand or by detection.
pub(crate) fn locate_in(
    view: &View,
    layout: &ChartLayout,
    corners: Option<&Quad>,
) -> Result<Place, ChartError> {
    let place = match corners {
        Some(corners) => find_chart::by_hand(layout, corners)?,
        None => find_chart::best(view, layout)?,
    };
    let beside = layout.beside.as_ref().and_then(|beside| beside.windows(&place.corners, 0.0));
    let inside = |[x, y]: &[f64; 2]| {
        (-0.5..=view.size.width as f64 - 0.5).contains(x)
            && (-0.5..=view.size.height as f64 - 0.5).contains(y)
    };
    if place.corners.iter().chain(beside.iter().flatten().flatten()).all(inside) {
        Ok(place)
    } else {
        Err(ChartError::Outside { width: view.size.width, height: view.size.height })
    }
}

/// Measures, corrects and judges a chart whose place is known.
pub(crate) fn measured(
    path: &Path,
    view: &View,
    place: Place,
    chart: &Chart<'_>,
    companions: Companions<'_>,
    options: &ShotOptions,
) -> Result<Shot, Error> {
    let in_frame = |quads: &[Quad]| quads.iter().map(|q| q.map(|p| view.to_frame(p))).collect::<Vec<Quad>>();
    let light = view.sensor_light();
    let measured = shot::measure(chart, light, companions, &in_frame(&place.windows))
        .map_err(|e| Error::chart(path, e))?;

    let ShotOptions { even_out, correct_glare, .. } = *options;
    let treatment = Treatment { even_out, correct_glare, exclude: &options.exclude };
    let found = shot::correct(chart, &measured, treatment).map_err(|e| Error::chart(path, e))?;

    let unevenness = found.corrected.unevenness || options.flat.is_some();
    let corrected = Corrected { unevenness, ..found.corrected };
    let patches = in_frame(&place.patches);
    let whole = shot::Place { corners: &place.corners, patches: &patches };
    let gates = shot::judge(chart, light, whole, &measured, &found, corrected);
    refuse(path, &gates, options.accept)?;

    let mut notes = found.notes;
    notes.extend(chart.notes.iter().cloned());
    if rendered::is_rendered(path) {
        notes.insert(0, RENDERED.to_owned());
    }
    Ok(Shot {
        path: path.to_owned(),
        camera: view.camera.clone(),
        corners: place.corners,
        windows: place.windows,
        confidence: place.confidence,
        patches: found.patches,
        measurements: measured.measurements,
        slope: found.slope,
        glare: found.glare[1],
        cross_validation: found.cross_validation,
        gates,
        notes,
        exposure_seconds: view.exposure_seconds,
        date: view.date.clone(),
    })
}

const RENDERED: &str = "WARNING: made from a rendered picture: the profile serves pictures rendered in just this way, and \
                        no raw file";

/// A check that failed is an error, unless the person takes the shot as it is.
pub(crate) fn refuse(path: &Path, gates: &[Gate], accept: bool) -> Result<(), Error> {
    match gates.iter().find(|g| g.verdict == Verdict::Refused) {
        Some(failed) if !accept => Err(Error::chart(path, ChartError::Refused(Box::new(failed.clone())))),
        _ => Ok(()),
    }
}

/// A flat or dark frame: it must be of the same camera and size.
fn companion(path: &Path, of: &View, settings: &Settings) -> Result<View, Error> {
    let view = View::open(path, settings)?;
    if view.camera != of.camera {
        let fault = ChartError::CompanionCamera { camera: view.camera_name(), of: of.camera_name() };
        return Err(Error::chart(path, fault));
    }
    let (a, b) = (view.frame.light.size, of.frame.light.size);
    if a != b {
        let fault = ChartError::CompanionSize { size: [a.width, a.height], of: [b.width, b.height] };
        return Err(Error::chart(path, fault));
    }
    Ok(view)
}
