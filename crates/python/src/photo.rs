//! A photograph in memory.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use darkroot::{Decoder, Photo as Core, Settings};
use darkroot_photo::{Layout, Rect};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::cancel::{Cancel, given};
use crate::fault::{Class, IntoException, OrException};
use crate::files::file;
use crate::opened::{Open, Source};
use crate::order::{Order, for_array, scale_of};
use crate::run::run;
use crate::samples::Samples;
use crate::settings::{Asked, limits};
use crate::{json, picture, store};

/// A decoded raw file. :class:`darkroot.Photo` says more.
#[pyclass(module = "darkroot._core", frozen, subclass)]
pub(crate) struct Photo(Mutex<Option<Arc<Open>>>);

impl Photo {
    fn open(&self) -> PyResult<Arc<Open>> {
        let open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        open.clone().ok_or_else(|| Class::Settings.says("the photo is closed; open the file again"))
    }
}

#[pymethods]
impl Photo {
    /// Opens a file by its path, or the bytes of one, which are called `name` in messages.
    #[new]
    #[pyo3(signature = (source, *, name = None, decoder = "flashraw", threads = None, cancel = None))]
    fn new(
        py: Python<'_>,
        source: &Bound<'_, PyAny>,
        name: Option<PathBuf>,
        decoder: &str,
        threads: Option<usize>,
        cancel: Option<&Bound<'_, Cancel>>,
    ) -> PyResult<Self> {
        let decoder = decoder_of(decoder)?;
        let source = match source.cast::<PyBytes>() {
            Ok(bytes) => Source::Memory(Arc::new(bytes.clone().into())),
            Err(_) => Source::File(file(source.extract()?)),
        };
        let name = name.unwrap_or_else(|| match &source {
            Source::File(path) => path.clone(),
            Source::Memory(_) => "the bytes".into(),
        });
        let opened = run(py, threads, &given(cancel), move |_| {
            let decoded = source.with(|bytes| Core::open_with(bytes, decoder, &limits()))?;
            let photo =
                decoded.map_err(|fault| darkroot::Error::Raw { path: name.clone(), source: fault })?;
            Ok::<_, darkroot::Error>(Open::new(photo, name, source))
        })?;
        Ok(Self(Mutex::new(Some(Arc::new(opened.or_exception()?)))))
    }

    /// What the photograph is called in messages.
    #[getter]
    fn name(&self) -> PyResult<PathBuf> {
        Ok(self.open()?.name.clone())
    }

    /// Lets the samples go; views of them stay as they are.
    fn close(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
    }

    /// Common name of the camera.
    #[getter]
    fn camera(&self) -> PyResult<String> {
        Ok(self.open()?.photo.capture().camera.name())
    }

    /// Holds the samples for NumPy.
    #[getter]
    fn _samples(&self) -> PyResult<Samples> {
        Ok(Samples(Arc::clone(self.open()?.analysis().capture())))
    }

    /// x, y, width and height of the part of the frame where light falls.
    #[getter]
    fn active_area(&self) -> PyResult<(usize, usize, usize, usize)> {
        Ok(sides(self.open()?.photo.capture().active_area))
    }

    /// x, y, width and height of the part of the frame that the maker shows.
    #[getter]
    fn crop(&self) -> PyResult<(usize, usize, usize, usize)> {
        Ok(sides(self.open()?.photo.capture().default_crop))
    }

    /// How to turn the picture upright, 1 to 8 as Exif counts.
    #[getter]
    fn orientation(&self) -> PyResult<u16> {
        Ok(self.open()?.photo.capture().orientation.exif())
    }

    /// Letters of the colour filter array.
    #[getter]
    fn cfa(&self) -> PyResult<Option<String>> {
        Ok(match self.open()?.photo.capture().counts.layout() {
            Layout::Cfa(cfa) => Some(cfa.to_string()),
            Layout::Monochrome | Layout::Rgb => None,
        })
    }

    /// Black level over the repeating block.
    #[getter]
    fn black<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let open = self.open()?;
        let black = &open.photo.capture().black;
        let values = PyArray1::from_slice(py, &black.values);
        match black.planes {
            1 => Ok(values.reshape([black.rows, black.columns])?.into_any()),
            planes => Ok(values.reshape([black.rows, black.columns, planes])?.into_any()),
        }
    }

    /// White level of red, green and blue.
    #[getter]
    fn white<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(PyArray1::from_slice(py, &self.open()?.photo.capture().white.0).into_any())
    }

    /// What had to be assumed or left out.
    #[getter]
    fn notes(&self) -> PyResult<Vec<String>> {
        Ok(self.open()?.photo.capture().notes.clone())
    }

    /// What the camera wrote about the shot.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let shot = darkroot::inspect::Shot::of(&self.open()?.photo.capture().metadata);
        json::python(py, serde_json::to_value(shot).unwrap_or_default())
    }

    /// The embedded JPEG as stored.
    fn preview<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let open = self.open()?;
        let found = run(py, Some(1), &Arc::default(), move |_| {
            let found = open.source.with(darkroot_raw::preview)?;
            found.map_err(|source| darkroot::Error::Raw { path: open.name.clone(), source })
        })?;
        Ok(found.or_exception()?.map(|preview| PyBytes::new(py, &preview.jpeg)))
    }

    /// Everything that `darkroot inspect` says.
    #[pyo3(signature = (*, threads = None))]
    fn inspect<'py>(&self, py: Python<'py>, threads: Option<usize>) -> PyResult<Bound<'py, PyAny>> {
        let open = self.open()?;
        let found = run(py, threads, &Arc::default(), move |_| {
            let settings = Settings::default();
            let store = store::store();
            darkroot::inspect_photo(&open.name, &open.photo, open.analysis(), &settings, &store, true)
        })?;
        json::python(py, serde_json::to_value(found.or_exception()?).unwrap_or_default())
    }

    /// Linear light under the filters.
    #[pyo3(signature = (*, threads = None))]
    fn light<'py>(&self, py: Python<'py>, threads: Option<usize>) -> PyResult<Bound<'py, PyAny>> {
        let open = self.open()?;
        let light = run(py, threads, &Arc::default(), move |_| open.analysis().frame().light)?;
        let (size, planes) = (light.size, light.layout.planes());
        let samples = PyArray1::from_vec(py, light.samples);
        match planes {
            1 => Ok(samples.reshape([size.height, size.width])?.into_any()),
            planes => Ok(samples.reshape([size.height, size.width, planes])?.into_any()),
        }
    }

    /// Develops the picture or a part of it.
    #[pyo3(signature = (*, dtype = None, scale = 1.0, region = None, recipe = None, threads = None, cancel = None, **settings))]
    #[allow(clippy::too_many_arguments)] // Those of a call in Python.
    fn develop<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        scale: f64,
        region: Option<(usize, usize, usize, usize)>,
        recipe: Option<&Bound<'py, PyAny>>,
        threads: Option<usize>,
        cancel: Option<&Bound<'py, Cancel>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = Asked::of(recipe, settings)?;
        let settings = for_array(asked.for_photo()?, dtype)?;
        let order = Order { settings, store: asked.store(), scale: scale_of(scale)?, region };
        let open = self.open()?;
        let made = run(py, threads, &given(cancel), move |wish| order.render(&open, wish))?;
        picture::array(py, made?)
    }

    /// What `develop` with the same settings does.
    #[pyo3(signature = (*, recipe = None, threads = None, **settings))]
    fn explain<'py>(
        &self,
        py: Python<'py>,
        recipe: Option<&Bound<'py, PyAny>>,
        threads: Option<usize>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = Asked::of(recipe, settings)?;
        let (settings, store) = (for_array(asked.for_photo()?, None)?, asked.store());
        let open = self.open()?;
        let told = run(py, threads, &Arc::default(), move |_| {
            let plan = open.plan(&settings, &store)?;
            let chosen = open.photo.profile(&store, &settings).map_err(|fault| fault.exception())?;
            let colours = darkroot::job::colours(&plan, open.photo.capture(), chosen.as_ref());
            Ok::<_, PyErr>(serde_json::json!({
                "width": plan.size().width, "height": plan.size().height,
                "space": plan.picture_space().name(), "colours": colours,
                "kelvin": plan.white.map(|w| w.kelvin), "tint": plan.white.map(|w| w.tint()),
                "multipliers": plan.multipliers(), "demosaic": plan.demosaic().name(), "gain": plan.gain,
                "notes": plan.notes,
            }))
        })?;
        json::python(py, told?)
    }
}

fn sides(rect: Rect) -> (usize, usize, usize, usize) {
    (rect.x, rect.y, rect.width, rect.height)
}

fn decoder_of(name: &str) -> PyResult<Decoder> {
    let mut settings = Settings::default();
    let key = darkroot::Key::named("decoder");
    key.apply(name, &mut settings)
        .map_err(|wrong| darkroot::RecipeError::Flag { key, wrong })
        .or_exception()?;
    Ok(settings.decoder)
}
