//! A photograph in memory.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use darkroot::settings::Engine;
use darkroot::{Analysis, Cancel as Wish, Decoder, Format, Photo as Core, Plan, Scale, Settings, View};
use darkroot_develop::{Bits, Look, OutputSpace};
use darkroot_photo::{Layout, Picture, Rect};
use numpy::{PyArray1, PyArrayDescr, PyArrayDescrMethods, PyArrayMethods, dtype};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyDict};

use crate::cancel::{Cancel, given};
use crate::fault::{Class, IntoException, OrException};
use crate::files::file;
use crate::run::run;
use crate::samples::Samples;
use crate::settings::{Asked, limits};
use crate::{json, picture, store};

/// Where the bytes are from, for what is read later.
#[derive(Clone)]
enum Source {
    File(PathBuf),
    Memory(Arc<PyBackedBytes>),
}

impl Source {
    /// Does something with the bytes of the file.
    fn with<T>(&self, work: impl FnOnce(&[u8]) -> T) -> Result<T, darkroot::Error> {
        match self {
            Self::File(path) => darkroot::files::read(path).map(|bytes| work(&bytes)),
            Self::Memory(bytes) => Ok(work(bytes)),
        }
    }
}

/// What is open.
struct Open {
    photo: Core,
    /// What the frame shows; looked for when it is first wanted, and kept.
    analysis: OnceLock<Analysis>,
    /// What the photograph is called in messages.
    name: PathBuf,
    source: Source,
}

impl Open {
    fn analysis(&self) -> &Analysis {
        self.analysis.get_or_init(|| self.photo.analyse_as_asked())
    }
}

/// A decoded raw file. :class:`darkroot.Photo` says more.
#[pyclass(module = "darkroot._core", frozen, subclass)]
pub(crate) struct Photo(Mutex<Option<Arc<Open>>>);

impl Photo {
    fn open(&self) -> PyResult<Arc<Open>> {
        let open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        open.clone().ok_or_else(|| Class::Settings.says("the photo is closed; open the file again"))
    }
}

/// What is asked of one picture.
struct Order {
    settings: Settings,
    store: Arc<darkroot::ProfileStore>,
    scale: Scale,
    region: Option<(usize, usize, usize, usize)>,
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
            Ok::<_, darkroot::Error>(Open { photo, analysis: OnceLock::new(), name, source })
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
        let made = run(py, threads, &given(cancel), move |wish| render(&open, &order, wish))?;
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
            let plan = plan(&open, &settings, &store)?;
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

fn scale_of(scale: f64) -> PyResult<Scale> {
    let fits = |halvings: &u8| (scale * f64::from(1u32 << halvings) - 1.0).abs() < 1e-9;
    (0..=6).find(fits).and_then(Scale::halved).ok_or_else(|| {
        Class::Settings.says(format!("`scale` cannot be {scale}; it is 1, 1/2, 1/4, 1/8, 1/16, 1/32 or 1/64"))
    })
}

/// Settings of a picture that goes into an array, which can have every space and every number of bits.
fn for_array(mut settings: Settings, wanted: Option<&Bound<'_, PyAny>>) -> PyResult<Settings> {
    if settings.engine != Engine::Darkroot {
        return Err(Class::Settings.says("`engine` goes with files: give it to `develop_file`"));
    }
    settings.format = Some(Format::Tiff);
    let measured = settings.recipe.look == Look::Linear || settings.space == Some(OutputSpace::Camera);
    let asked = wanted.map(bits_of).transpose()?;
    if let (Some(asked), Some(said)) = (asked, settings.bits)
        && asked != said
    {
        let words =
            format!("`dtype` and `bits` ask for {} and {} bits; leave one out", asked.count(), said.count());
        return Err(Class::Settings.says(words));
    }
    let usual = if measured { Bits::Float } else { Bits::Eight };
    settings.bits = Some(asked.or(settings.bits).unwrap_or(usual));
    Ok(settings)
}

fn bits_of(wanted: &Bound<'_, PyAny>) -> PyResult<Bits> {
    let py = wanted.py();
    let wanted = PyArrayDescr::new(py, wanted.clone())?;
    let is = |known: Bound<'_, PyArrayDescr>| wanted.is_equiv_to(&known);
    if is(dtype::<u8>(py)) {
        Ok(Bits::Eight)
    } else if is(dtype::<u16>(py)) {
        Ok(Bits::Sixteen)
    } else if is(dtype::<f32>(py)) {
        Ok(Bits::Float)
    } else {
        Err(Class::Settings.says(format!("`dtype` cannot be {wanted}; it is uint8, uint16 or float32")))
    }
}

fn plan(open: &Open, settings: &Settings, store: &darkroot::ProfileStore) -> PyResult<Plan> {
    let mut photo = open.photo.clone();
    if settings.recipe.look == Look::Camera {
        photo = open.source.with(|bytes| photo.with_preview(bytes, &limits())).or_exception()?;
    }
    if settings.dark.is_none() && settings.flat.is_none() {
        return photo.plan(open.analysis(), store, settings).or_exception();
    }
    let photo = photo.with_frames(settings).or_exception()?;
    photo.plan(&photo.analyse_as_asked(), store, settings).or_exception()
}

fn render(open: &Open, order: &Order, wish: &Wish) -> PyResult<Picture> {
    let plan = plan(open, &order.settings, &order.store)?;
    let mut view = plan.whole(order.scale);
    if let Some((x, y, width, height)) = order.region {
        let whole = view.rect;
        let rect = Rect { x, y, width, height };
        let inside = x.checked_add(width).is_some_and(|right| right <= whole.width)
            && y.checked_add(height).is_some_and(|bottom| bottom <= whole.height);
        if !inside || width == 0 || height == 0 {
            let words = format!(
                "`region` ({x}, {y}, {width}, {height}) does not lie in the picture, which has {} x {} pixels at this scale",
                whole.width, whole.height
            );
            return Err(Class::Settings.says(words));
        }
        view = View { scale: order.scale, rect };
    }
    plan.render(view, wish).or_exception()
}
