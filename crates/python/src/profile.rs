//! What a camera's colours mean.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot::export::{self, ExportError, ExportRequest, Target, calibration};
use darkroot_profile::export::cube::Shaper;
use darkroot_profile::export::icc::Version;
use darkroot_profile::{Calibration, Figures, Summary, lint};
use numpy::{AllowTypeChange, PyArray1, PyArrayLikeDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::fault::{Class, IntoException, OrException};
use crate::run::run;
use crate::{json, store};

/// What one camera's colours mean: from its linear RGB to XYZ. :class:`darkroot.Profile` says more.
#[pyclass(module = "darkroot._core", frozen, subclass, eq)]
#[derive(PartialEq)]
pub(crate) struct Profile(Arc<darkroot_profile::Profile>);

impl Profile {
    pub(crate) fn shared(&self) -> Arc<darkroot_profile::Profile> {
        Arc::clone(&self.0)
    }

    fn calibration(&self, light: Option<&str>) -> PyResult<Calibration> {
        calibration(&self.0, light).or_exception()
    }
}

/// The text of a profile file, which Python makes its profile from.
pub(crate) fn text(profile: &darkroot_profile::Profile) -> String {
    darkroot_profile::file::format(profile)
}

impl IntoException for ExportError {
    fn exception(self) -> PyErr {
        match self {
            Self::File(fault) => fault.exception(),
            Self::Format(fault) => Class::Profile.says(fault.to_string()),
            other => Class::Settings.says(other.to_string()),
        }
    }
}

#[pymethods]
impl Profile {
    /// What the text of a profile file says.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let profile = darkroot_profile::file::parse(text);
        Ok(Self(Arc::new(profile.map_err(|fault| Class::Profile.says(format!("the text {fault}")))?)))
    }

    /// The text of the profile that a file or a camera's name stands for.
    #[staticmethod]
    fn _text_of(py: Python<'_>, name: String) -> PyResult<String> {
        let found = run(py, Some(1), &Arc::default(), move |_| store::store().choose(&name))?;
        Ok(text(&found.or_exception()?.profile))
    }

    fn to_text(&self) -> String {
        text(&self.0)
    }

    #[pyo3(signature = (path, *, overwrite = false))]
    fn save(&self, path: PathBuf, overwrite: bool) -> PyResult<()> {
        darkroot::store::write(&self.0, &path, overwrite).or_exception()
    }

    #[getter]
    fn camera(&self) -> String {
        self.0.camera().name()
    }

    #[getter]
    fn lights(&self) -> Vec<String> {
        self.0.calibrations().iter().map(|c| c.light.name.clone()).collect()
    }

    /// Whether it is a camera, which knows every light, and not models for some lights.
    #[getter]
    fn is_camera(&self) -> bool {
        self.0.known_camera().is_some()
    }

    #[pyo3(signature = (rgb, light = None))]
    fn apply<'py>(
        &self,
        py: Python<'py>,
        rgb: PyArrayLikeDyn<'py, f64, AllowTypeChange>,
        light: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let shape = rgb.shape().to_vec();
        if shape.last() != Some(&3) {
            let words = format!("`rgb` has the shape {shape:?}; its last axis must be 3, for R, G and B");
            return Err(Class::Settings.says(words));
        }
        let model = self.calibration(light)?.model;
        let colours: Vec<f64> = rgb.as_array().iter().copied().collect();
        let found = run(py, None, &Arc::default(), move |_| {
            use rayon::prelude::*;
            let each = colours.par_chunks_exact(3).map(|rgb| model.xyz([rgb[0], rgb[1], rgb[2]]));
            each.flat_map_iter(|xyz| [xyz.x, xyz.y, xyz.z]).collect::<Vec<f64>>()
        })?;
        Ok(PyArray1::from_vec(py, found).reshape(shape)?.into_any())
    }

    #[pyo3(signature = (light = None))]
    fn figures<'py>(&self, py: Python<'py>, light: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
        let found = self.calibration(light)?;
        let mut told = figures(&found.figures);
        told["light"] = found.light.name.clone().into();
        told["kelvin"] = found.light.kelvin().into();
        told["model"] = found.kind.to_string().into();
        json::python(py, told)
    }

    #[pyo3(signature = (light = None))]
    fn patches<'py>(&self, py: Python<'py>, light: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
        let found = self.calibration(light)?;
        let one = |p: &darkroot_profile::Patch| json!({ "name": p.name, "rgb": p.rgb, "xyz": [p.xyz.x, p.xyz.y, p.xyz.z], "de2000": p.de2000 });
        json::python(py, found.patches.iter().map(one).collect())
    }

    #[getter]
    fn origin<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let o = self.0.origin();
        let told = json!({
            "summary": o.summary, "chart": o.chart, "reference": o.reference, "reference_sha256": o.reference_sha256,
            "sensitivities": o.sensitivities, "sensitivities_sha256": o.sensitivities_sha256,
            "date": o.date, "program": o.program,
        });
        json::python(py, told)
    }

    fn lint<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let profile = self.shared();
        let found = run(py, None, &Arc::default(), move |_| {
            let all = profile.calibrations().iter().flat_map(lint::check);
            let one = |f: lint::Finding| {
                json!({
                    "light": f.light, "check": f.check.name(), "severity": f.severity.to_string(),
                    "value": f.value, "words": f.words,
                })
            };
            all.map(one).collect::<Value>()
        })?;
        json::python(py, found)
    }

    #[pyo3(signature = (path, *, light = None, raw = None, neutral = None, space = None, shaper = "sqrt", grid = 33, icc_version = 4, overwrite = false))]
    #[allow(clippy::too_many_arguments)] // Those of a call in Python.
    fn export<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        light: Option<Lights>,
        raw: Option<PathBuf>,
        neutral: Option<Neutrals>,
        space: Option<&str>,
        shaper: &str,
        grid: usize,
        icc_version: u8,
        overwrite: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let target = target(&path, icc_version)?;
        if !(2..=129).contains(&grid) {
            return Err(Class::Settings.says(format!("`grid` cannot be {grid}; it is 2 to 129")));
        }
        let unknown = |name: &str| Class::Settings.says(format!("`{name}` is no colour space"));
        let request = ExportRequest {
            lights: light.map_or_else(Vec::new, Lights::list),
            raw_file: raw,
            neutrals: neutral.map_or_else(Vec::new, Neutrals::list),
            space: space
                .map(|name| darkroot::settings::space(name).ok_or_else(|| unknown(name)))
                .transpose()?,
            shaper: match shaper {
                "none" => Shaper::None,
                "sqrt" => Shaper::SquareRoot,
                other => {
                    return Err(
                        Class::Settings.says(format!("`shaper` cannot be `{other}`; it is none or sqrt"))
                    );
                }
            },
            grid,
            ..ExportRequest::to(target)
        };
        let profile = self.shared();
        let made = run(py, None, &Arc::default(), move |_| -> PyResult<Value> {
            let exported = export::export(&profile, &request).or_exception()?;
            export::write(&path, &exported.bytes, overwrite).or_exception()?;
            let one = |(light, found): (String, darkroot_profile::export::Deviation)| json!({ "light": light, "de2000": summary(found.de2000), "colours": found.colours });
            Ok(exported.deviations.into_iter().map(one).collect())
        })?;
        json::python(py, made?)
    }
}

/// The name of a light, or several.
#[derive(FromPyObject)]
enum Lights {
    One(String),
    Several(Vec<String>),
}

impl Lights {
    fn list(self) -> Vec<String> {
        match self {
            Self::One(light) => vec![light],
            Self::Several(lights) => lights,
        }
    }
}

/// Camera RGB of a white, or of several.
#[derive(FromPyObject)]
enum Neutrals {
    One([f64; 3]),
    Several(Vec<[f64; 3]>),
}

impl Neutrals {
    fn list(self) -> Vec<[f64; 3]> {
        match self {
            Self::One(neutral) => vec![neutral],
            Self::Several(neutrals) => neutrals,
        }
    }
}

/// What a file's ending asks for.
fn target(path: &Path, icc_version: u8) -> PyResult<Target> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match (ending.as_str(), icc_version) {
        ("dcp", _) => Ok(Target::Dcp),
        ("icc" | "icm", 2) => Ok(Target::Icc(Version::Two)),
        ("icc" | "icm", 4) => Ok(Target::Icc(Version::Four)),
        ("icc" | "icm", other) => {
            Err(Class::Settings.says(format!("`icc_version` cannot be {other}; it is 2 or 4")))
        }
        ("cube", _) => Ok(Target::Cube),
        ("clf", _) => Ok(Target::Clf),
        _ => Err(Class::Settings.says(format!(
            "{}: its ending names no format of profiles; use .dcp, .icc, .cube or .clf",
            darkroot::shown(path)
        ))),
    }
}

/// Mean, median, 95th percentile and largest.
pub(crate) fn summary(s: Summary) -> Value {
    json!({ "mean": s.mean, "median": s.median, "p95": s.p95, "max": s.max })
}

/// CIEDE2000 over what a model was fitted to, over patches left out, and over other colours.
pub(crate) fn figures(f: &Figures) -> Value {
    json!({
        "training": f.training.map(|e| summary(e.de2000)),
        "left_out": f.leave_one_out.map(|e| summary(e.de2000)),
        "held_out": f.held_out.map(|e| summary(e.de2000)),
    })
}
