//! Shots of colour charts.

use std::path::PathBuf;
use std::sync::Arc;

use darkroot::deliver::{self, DeliveryRequest};
use darkroot::find_chart::Found;
use darkroot::shot::{self, Correct, Gate, ShotOptions, Verdict};
use darkroot::{ChartRequest, Error, FoundCharts, LightSource, Settings, charts, light, report};
use darkroot_calibrate::MeasuredPatch;
use darkroot_chart::ChartLayout;
use darkroot_photo::{Layout, Mosaic, Size};
use numpy::PyReadonlyArray3;
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::fault::{Class, IntoException, OrException};
use crate::fit::kind;
use crate::json;
use crate::profile::{Profile, figures, summary, text};
use crate::run::run;

/// What a person says about a shot, as Python gives it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Said {
    chart: String,
    reference: Option<String>,
    corners: Option<[[f64; 2]; 4]>,
    flat: Option<PathBuf>,
    dark: Option<PathBuf>,
    even_out: String,
    correct_glare: String,
    exclude: Vec<String>,
    accept: bool,
    allow_rendered: bool,
}

impl Said {
    fn request(self, shots: Vec<(PathBuf, LightSource)>) -> PyResult<ChartRequest> {
        let layout = charts::layout(&self.chart).or_exception()?;
        let reference = charts::reference(self.reference.as_deref(), &layout).or_exception()?;
        let options = ShotOptions {
            corners: self.corners,
            flat: self.flat,
            dark: self.dark,
            even_out: correct("even_out", &self.even_out)?,
            correct_glare: correct("correct_glare", &self.correct_glare)?,
            exclude: self.exclude,
            accept: self.accept,
            allow_rendered: self.allow_rendered,
        };
        Ok(ChartRequest::of(shots, layout, reference, options))
    }
}

fn correct(name: &str, when: &str) -> PyResult<Correct> {
    match when {
        "auto" => Ok(Correct::WhereItHelps),
        "always" => Ok(Correct::Always),
        "never" => Ok(Correct::Never),
        other => {
            Err(Class::Settings.says(format!("`{name}` cannot be `{other}`; it is auto, always or never")))
        }
    }
}

/// Charts of a file or of linear light, as a list of dictionaries.
#[pyfunction]
#[pyo3(signature = (path, light, layouts))]
pub(crate) fn detect_charts<'py>(
    py: Python<'py>,
    path: Option<PathBuf>,
    light: Option<PyReadonlyArray3<'py, f32>>,
    layouts: Option<Vec<String>>,
) -> PyResult<Bound<'py, PyAny>> {
    let layouts: Vec<ChartLayout> = match layouts {
        Some(names) => {
            names.iter().map(|name| charts::layout(name)).collect::<Result<_, _>>().or_exception()?
        }
        None => charts::layouts(),
    };
    let light = light.map(|light| {
        let light = light.as_array();
        let (height, width, _) = light.dim();
        Mosaic { size: Size { width, height }, layout: Layout::Rgb, samples: light.iter().copied().collect() }
    });
    let found = run(py, None, &Arc::default(), move |_| match (path, light) {
        (Some(path), _) => darkroot::find_charts(&path, &layouts, &Settings::default()),
        (None, Some(light)) => Ok(darkroot::find_charts_in(light, &layouts)),
        (None, None) => Ok(FoundCharts { size: Size { width: 0, height: 0 }, search: Default::default() }),
    })?;
    json::python(py, found.or_exception()?.search.found.iter().map(chart).collect())
}

fn chart(found: &Found) -> Value {
    /// Share of a patch's side that is left out at each edge, as measuring does.
    const INSET: f64 = 0.22;
    let patches: Vec<_> = (0..found.columns * found.rows).map(|i| found.patch(i, INSET)).collect();
    json!({
        "chart": found.layout, "confidence": found.confidence, "corners": found.corners,
        "rotation_degrees": found.rotation_degrees, "patch_pixels": found.patch_pixels,
        "columns": found.columns, "rows": found.rows, "patches": patches,
    })
}

/// Measures the patches of a shot.
#[pyfunction]
pub(crate) fn measure_chart<'py>(py: Python<'py>, path: PathBuf, said: Said) -> PyResult<Bound<'py, PyAny>> {
    let request = said.request(Vec::new())?;
    let found = run(py, None, &Arc::default(), move |_| {
        shot::open(&path, &request.layout, &request.reference, &request.options, &Settings::default())
    })?;
    json::python(py, of_shot(&found.or_exception()?.0))
}

fn of_shot(shot: &darkroot::Shot) -> Value {
    let one = |p: &MeasuredPatch| {
        let xyz = p.reference.xyz_d50();
        json!({
            "name": p.name, "rgb": p.rgb, "uncertainty": p.uncertainty, "clipped": p.clipped,
            "xyz": [xyz.x, xyz.y, xyz.z], "excluded": p.excluded,
        })
    };
    json!({
        "path": darkroot::path_text::text(&shot.path),
        "camera": shot.camera.name(), "corners": shot.corners, "windows": shot.windows,
        "confidence": shot.confidence, "patches": shot.patches.iter().map(one).collect::<Value>(),
        "gates": shot.gates.iter().map(gate).collect::<Value>(), "notes": shot.notes,
        "exposure_seconds": shot.exposure_seconds, "date": shot.date,
    })
}

fn gate(gate: &Gate) -> Value {
    let verdict = match gate.verdict {
        Verdict::Good => "good",
        Verdict::Warning => "warning",
        Verdict::Refused => "refused",
    };
    json!({
        "name": gate.name(), "verdict": verdict, "value": Some(gate.value()).filter(|v| v.is_finite()),
        "words": gate.words(), "advice": gate.advice(),
    })
}

/// Makes a profile of shots: its text, its report as a page, and what the shots and the fits came to.
#[pyfunction]
#[pyo3(signature = (shots, said, *, average, as_camera, model, date))]
pub(crate) fn make_profile<'py>(
    py: Python<'py>,
    shots: Vec<(PathBuf, String)>,
    said: Said,
    average: bool,
    as_camera: bool,
    model: Option<&str>,
    date: String,
) -> PyResult<(String, String, Bound<'py, PyAny>)> {
    let with_light = |(path, name): (PathBuf, String)| Ok((path, light::find(&name)?));
    let shots = shots.into_iter().map(with_light).collect::<Result<Vec<_>, Error>>().or_exception()?;
    let kind = model.map(kind).transpose()?;
    let request = ChartRequest { average, kind, date, ..said.request(shots)? };
    let made = run(py, None, &Arc::default(), move |_| {
        let made = darkroot::make_profile(&request, &Settings::default())?;
        let camera = as_camera.then(|| darkroot::chart_camera(&made)).transpose()?;
        let profile = text(camera.as_ref().unwrap_or(&made.profile));
        let lights = made.lights.iter().map(|light| {
            let models = light.calibrated.compared.iter().map(|c| match &c.result {
                Ok(found) => json!({ "model": c.kind.to_string(), "figures": figures(found), "fault": null }),
                Err(fault) => json!({ "model": c.kind.to_string(), "figures": null, "fault": fault.to_string() }),
            });
            json!({
                "light": light.light.light.name, "model": light.calibrated.calibration.kind.to_string(),
                "figures": figures(&light.calibrated.calibration.figures), "models": models.collect::<Value>(),
                "shots": light.shots.iter().map(of_shot).collect::<Value>(),
                "gates": light.gates.iter().map(gate).collect::<Value>(),
                "notes": light.calibrated.notes, "white_balance": light.white_balance,
            })
        });
        Ok::<_, Error>((profile, report::html(&made, &request.layout), lights.collect::<Value>()))
    })?;
    let (profile, page, lights) = made.or_exception()?;
    Ok((profile, page, json::python(py, lights)?))
}

/// Judges a raw shot of a chart by a profile.
#[pyfunction]
#[pyo3(signature = (path, profile, said, light))]
pub(crate) fn verify_shot<'py>(
    py: Python<'py>,
    path: PathBuf,
    profile: &Bound<'py, Profile>,
    said: Said,
    light: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let request = said.request(Vec::new())?;
    let profile = profile.get().shared();
    let light = light.map(light::find).transpose().or_exception()?;
    let found = run(py, None, &Arc::default(), move |_| {
        darkroot::verify::verify(&profile, &path, light.as_ref(), &request, &Settings::default())
    })?;
    let found = found.or_exception()?;
    let judgement = &found.judgement;
    let told = json!({
        "light": found.light.light.name, "light_assumed": found.light_assumed,
        "de2000": summary(judgement.errors.de2000), "sl1": summary(judgement.sl1),
        "promised": judgement.promised.map(summary), "patches": judged(&judgement.patches),
        "shot": of_shot(&found.shot),
    });
    json::python(py, told)
}

fn judged(patches: &[darkroot_calibrate::JudgedPatch]) -> Value {
    let one = |p: &darkroot_calibrate::JudgedPatch| {
        json!({
            "name": p.name, "de2000": p.de2000, "excluded": p.excluded,
            "xyz": [p.corrected.x, p.corrected.y, p.corrected.z],
            "reference": [p.reference.x, p.reference.y, p.reference.z],
        })
    };
    patches.iter().map(one).collect()
}

/// Judges a finished picture of a chart by its reference, and by a guideline's limits where one is named.
#[pyfunction]
#[pyo3(signature = (path, said, light, preset))]
pub(crate) fn verify_picture<'py>(
    py: Python<'py>,
    path: PathBuf,
    said: Said,
    light: Option<&str>,
    preset: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let guideline = preset.map(|name| {
        deliver::preset(name)
            .ok_or_else(|| Class::Settings.says(format!("`{name}` is no preset of a guideline")))
    });
    let guideline = guideline.transpose()?;
    let light = light.map(light::find).transpose().or_exception()?;
    let asked = said.request(Vec::new())?;
    let request = DeliveryRequest {
        layout: asked.layout,
        reference: asked.reference,
        corners: asked.options.corners,
        exclude: asked.options.exclude,
        flat: asked.options.flat,
        pitch: None,
        pixels_per_degree: deliver::PIXELS_PER_DEGREE,
        light,
        accept: asked.options.accept,
    };
    let found = run(py, None, &Arc::default(), move |_| deliver::judge(&path, &request))?;
    let found = found.map_err(IntoException::exception)?;
    let delivery = &found.delivery;
    let verdicts =
        guideline.map(|(guideline, level)| guideline.verdicts(level, delivery)).unwrap_or_default();
    let verdict = |v: &deliver::Verdict| json!({ "metric": v.metric.name(), "words": v.to_string(), "kept": v.kept(), "source": v.source });
    let told = json!({
        "light": found.light.light.name, "space": found.space, "bits": found.bits,
        "confidence": found.confidence, "corners": found.corners,
        "de2000": summary(delivery.de2000), "sl1": summary(delivery.sl1), "patches": judged(&delivery.patches),
        "verdicts": verdicts.iter().map(verdict).collect::<Value>(),
        "kept": verdicts.iter().all(|v| v.kept() != Some(false)), "notes": delivery.notes,
    });
    json::python(py, told)
}
