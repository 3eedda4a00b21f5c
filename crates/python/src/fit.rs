//! Profiles from colours, sensitivities or a published matrix. Each gives the text of the profile's file.

use std::path::PathBuf;
use std::sync::Arc;

use darkroot::{Error, FromSpectra, light};
use darkroot_calibrate::fit::Choice;
use darkroot_calibrate::{MeasuredPatch, calibrate};
use darkroot_chart::ReferenceColour;
use darkroot_colour::Xyz;
use darkroot_colour::measured::Measured;
use darkroot_profile::camera::KnownCamera;
use darkroot_profile::{Kind, Origin, ProfileCamera, Sensitivities};
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2};
use pyo3::prelude::*;

use crate::fault::{Class, OrException};
use crate::profile::text;
use crate::run::run;

type Table<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;
type Row<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;

/// Fits a profile to colours; :func:`darkroot.fit_profile` says more.
#[pyfunction]
#[pyo3(signature = (rgb, *, xyz = None, reflectance = None, wavelengths = None, light = "D50", camera = "", model = None, names = None, date = ""))]
#[allow(clippy::too_many_arguments)] // Those of a call in Python.
pub(crate) fn fit_profile(
    py: Python<'_>,
    rgb: Table<'_>,
    xyz: Option<Table<'_>>,
    reflectance: Option<Table<'_>>,
    wavelengths: Option<Row<'_>>,
    light: &str,
    camera: &str,
    model: Option<&str>,
    names: Option<Vec<String>>,
    date: &str,
) -> PyResult<String> {
    let rgb = triples("rgb", &rgb)?;
    let references = match (xyz, reflectance, wavelengths) {
        (Some(xyz), None, None) => {
            let of = |[x, y, z]: [f64; 3]| ReferenceColour::Xyz(Xyz::new(x, y, z));
            triples("xyz", &xyz)?.into_iter().map(of).collect()
        }
        (None, Some(table), Some(nm)) => reflectances(&table, &nm)?,
        _ => {
            let words = "give `xyz`, or `reflectance` with its `wavelengths`";
            return Err(Class::Settings.says(words));
        }
    };
    if rgb.len() != references.len() || names.as_ref().is_some_and(|n| n.len() != rgb.len()) {
        let words =
            format!("there are {} colours of the camera and {} references", rgb.len(), references.len());
        return Err(Class::Settings.says(words));
    }
    let names = names.unwrap_or_else(|| (1..=rgb.len()).map(|n| n.to_string()).collect());
    let patch = |((name, rgb), reference): ((String, [f64; 3]), ReferenceColour)| MeasuredPatch {
        name,
        rgb,
        uncertainty: [0.0; 3],
        clipped: 0.0,
        reference,
        excluded: rgb.iter().any(|v| *v <= 0.0).then(|| "darker than black".to_owned()),
    };
    let patches: Vec<MeasuredPatch> = names.into_iter().zip(rgb).zip(references).map(patch).collect();
    let light = light::find(light).or_exception()?;
    let choice = Choice { kind: model.map(kind).transpose()?, ..Choice::default() };
    let (camera, count) = (camera_of(camera), patches.len());
    let fitted = run(py, None, &Arc::default(), move |_| {
        let fit = calibrate(&light, &patches, &choice);
        fit.map_err(|source| Error::Fit { light: light.light.name.clone(), source })
    })?;
    let origin = Origin {
        summary: format!("{count} colours"),
        date: date.to_owned(),
        program: program(),
        ..Origin::default()
    };
    let calibrations = vec![fitted.or_exception()?.calibration];
    let profile = darkroot_profile::Profile::new(camera, calibrations, origin).ok_or(Error::NoLight);
    Ok(text(&profile.or_exception()?))
}

/// The camera that a published matrix makes most probable.
#[pyfunction]
pub(crate) fn from_matrix(py: Python<'_>, camera: String) -> PyResult<(String, String)> {
    let found = run(py, None, &Arc::default(), move |_| {
        darkroot::estimate_named(&camera, &darkroot::Limits::default())
    })?;
    let found = found.or_exception()?;
    Ok((text(&found.profile), found.words()))
}

/// A profile from sensitivities in a file.
#[pyfunction]
#[pyo3(signature = (sensitivities, *, camera, lights, reflectances, held_out, model, date))]
#[allow(clippy::too_many_arguments)] // Those of a call in Python.
pub(crate) fn from_spectra_file(
    py: Python<'_>,
    sensitivities: PathBuf,
    camera: &str,
    lights: Vec<String>,
    reflectances: Vec<PathBuf>,
    held_out: Vec<PathBuf>,
    model: Option<&str>,
    date: String,
) -> PyResult<String> {
    let request = FromSpectra {
        camera: camera_of(camera),
        sensitivities,
        lights: lights.iter().map(|name| light::find(name)).collect::<Result<_, _>>().or_exception()?,
        reflectances,
        held_out,
        kind: model.map_or(Ok(Kind::Spectral), kind)?,
        date,
    };
    let made = run(py, None, &Arc::default(), move |_| darkroot::from_spectra(&request))?;
    Ok(text(&made.or_exception()?))
}

/// A profile that is the camera with these sensitivities: wavelengths x 3.
#[pyfunction]
pub(crate) fn from_sensitivities(
    wavelengths: Row<'_>,
    sensitivities: Table<'_>,
    camera: &str,
    date: &str,
) -> PyResult<String> {
    let nm: Vec<f64> = wavelengths.as_array().to_vec();
    let table = sensitivities.as_array();
    if table.ncols() != 3 {
        return Err(Class::Settings.says("`sensitivities` needs three columns: red, green and blue"));
    }
    let channel = |c: usize| measured(&nm, &table.column(c).to_vec()).map(|m| m.spectrum());
    let sensitivities = Sensitivities([channel(0)?, channel(1)?, channel(2)?]);
    let known = KnownCamera::new(&sensitivities)
        .ok_or_else(|| Class::Profile.says("a channel sees nothing of light between 380 and 780 nm"))?;
    let summary = "the camera's measured spectral sensitivities".to_owned();
    let origin = Origin { summary, date: date.to_owned(), program: program(), ..Origin::default() };
    Ok(text(&darkroot_profile::Profile::of_camera(camera_of(camera), known, origin)))
}

/// Name and version of the program, as profiles carry it.
fn program() -> String {
    format!("darkroot {}", darkroot::VERSION)
}

/// A camera by make and model in one; the first word is the make.
pub(crate) fn camera_of(name: &str) -> ProfileCamera {
    let (make, model) = name.trim().split_once(' ').unwrap_or((name.trim(), ""));
    ProfileCamera { make: make.to_owned(), model: model.trim().to_owned(), aliases: Vec::new() }
}

/// The model of a name.
pub(crate) fn kind(name: &str) -> PyResult<Kind> {
    name.parse().map_err(|_| {
        let names: Vec<String> = Kind::ALL.iter().map(Kind::to_string).collect();
        Class::Settings.says(format!("`model` cannot be `{name}`; it is {}", names.join(", ")))
    })
}

fn triples(name: &str, table: &Table<'_>) -> PyResult<Vec<[f64; 3]>> {
    let table = table.as_array();
    if table.ncols() != 3 || table.iter().any(|v| !v.is_finite()) {
        return Err(
            Class::Settings.says(format!("`{name}` must be a table of three columns of finite numbers"))
        );
    }
    Ok(table.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
}

fn measured(nm: &[f64], values: &[f64]) -> PyResult<Measured> {
    Measured::new(nm, values).map_err(|fault| Class::Settings.says(format!("the spectra: {fault}")))
}

fn reflectances(table: &Table<'_>, nm: &Row<'_>) -> PyResult<Vec<ReferenceColour>> {
    let nm: Vec<f64> = nm.as_array().to_vec();
    let one = |row: numpy::ndarray::ArrayView1<'_, f64>| {
        Ok(ReferenceColour::Reflectance(measured(&nm, &row.to_vec())?))
    };
    table.as_array().rows().into_iter().map(one).collect()
}
