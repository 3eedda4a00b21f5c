//! Jobs on files.

use std::path::{Path, PathBuf};

use darkroot::{Control, Inspection, Job, Report, Settings};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::cancel::{Cancel, given};
use crate::fault::OrException;
use crate::run::run;
use crate::settings::Asked;
use crate::{json, store};

/// The path of a file. The library takes `-` for standard input and output; in Python it is a name like any other.
pub(crate) fn file(path: PathBuf) -> PathBuf {
    if darkroot::files::is_stream(&path) { Path::new(".").join(path) } else { path }
}

/// Develops one file into a picture; :func:`darkroot.develop_file` says more.
#[pyfunction]
#[pyo3(signature = (src, dst, *, overwrite = false, recipe = None, folders = false, threads = None, cancel = None, **settings))]
#[allow(clippy::too_many_arguments)] // Those of a call in Python.
pub(crate) fn develop_file<'py>(
    py: Python<'py>,
    src: PathBuf,
    dst: PathBuf,
    overwrite: bool,
    recipe: Option<&Bound<'py, PyAny>>,
    folders: bool,
    threads: Option<usize>,
    cancel: Option<&Bound<'py, Cancel>>,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked = Asked::of(recipe, settings)?;
    let job = Job { input: file(src), output: file(dst) };
    let settings = asked.for_file(&job.input, folders).or_exception()?;
    let (settings, store) = (Settings { overwrite, ..settings }, asked.store());
    let made = run(py, threads, &given(cancel), move |wish| {
        darkroot::develop(&job, &settings, &store, Control { cancel: Some(wish), ..Control::default() })
    })?;
    let report: Report = made.or_exception()?;
    json::python(py, serde_json::to_value(report).unwrap_or_default())
}

/// What a raw file is, as `darkroot inspect` says it.
#[pyfunction]
#[pyo3(signature = (path, *, threads = None))]
pub(crate) fn inspect(py: Python<'_>, path: PathBuf, threads: Option<usize>) -> PyResult<Bound<'_, PyAny>> {
    let found = run(py, threads, &given(None), move |_| {
        darkroot::inspect(&file(path), &Settings::default(), &store::store(), true)
    })?;
    let found: Inspection = found.or_exception()?;
    json::python(py, serde_json::to_value(found).unwrap_or_default())
}

/// Removes unfinished outputs, when Python ends.
#[pyfunction]
pub(crate) fn abandon() {
    darkroot::abandon();
}
