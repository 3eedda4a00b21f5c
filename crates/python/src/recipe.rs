//! Settings as a value of their own.

use std::collections::BTreeMap;
use std::path::PathBuf;

use darkroot::Key;
use darkroot::recipe::Layer;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::fault::OrException;
use crate::json;
use crate::settings::{Asked, key, keyword};

/// Settings for development, checked when they are made.
///
/// Keywords are the names of the program's settings with underscores (:func:`darkroot.settings` lists them). A recipe is a
/// mapping, so ``photo.develop(**recipe)`` works; it can be pickled, compared and hashed, and is equal to the TOML file that
/// :meth:`save` writes and the program's ``--recipe`` reads.
///
/// >>> recipe = Recipe(look="linear", exposure=0.5, white_balance="5200K")
/// >>> dict(recipe)
/// {'exposure': 0.5, 'white_balance': '5200K', 'look': 'linear'}
/// >>> print(recipe.to_toml(), end="")
/// exposure = 0.5
/// white-balance = "5200K"
/// look = "linear"
/// >>> Recipe.from_toml(recipe.to_toml()) == recipe
/// True
/// >>> recipe | {"exposure": 1}
/// Recipe(exposure=1, white_balance='5200K', look='linear')
/// >>> Recipe(expsoure=1)
/// Traceback (most recent call last):
/// darkroot.SettingsError: `expsoure` is no setting; did you mean `exposure`?
#[pyclass(module = "darkroot", frozen, eq, hash, mapping)]
#[derive(PartialEq, Eq, Hash)]
pub(crate) struct Recipe(BTreeMap<Key, String>);

impl Recipe {
    /// What it says, as texts.
    pub(crate) fn values(&self) -> impl Iterator<Item = (Key, String)> {
        self.0.iter().map(|(key, text)| (*key, text.clone()))
    }

    fn of(layer: &Layer) -> Self {
        Self(layer.iter().map(|(key, text)| (key, text.to_owned())).collect())
    }

    fn layer(&self) -> PyResult<Layer> {
        Layer::flags(self.values()).or_exception()
    }
}

#[pymethods]
impl Recipe {
    #[new]
    #[pyo3(signature = (**settings))]
    fn new(settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let layer = Layer::flags(Asked::of(None, settings)?.texts()?).or_exception()?;
        Ok(Self::of(&layer))
    }

    /// Reads a recipe file.
    #[classmethod]
    fn load(_: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Ok(Self::of(&Layer::read(&path).or_exception()?))
    }

    /// What a text of TOML says.
    #[classmethod]
    fn from_toml(_: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        Ok(Self::of(&Layer::parse(text).or_exception()?))
    }

    /// Writes it as a file, whole or not at all.
    #[pyo3(signature = (path, *, overwrite = false))]
    fn save(&self, path: PathBuf, overwrite: bool) -> PyResult<()> {
        darkroot::write_text(&path, &self.to_toml()?, overwrite).or_exception()
    }

    /// As a text of TOML, a line for each setting that it says something about.
    fn to_toml(&self) -> PyResult<String> {
        Ok(self.layer()?.to_toml())
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let key = key(name)?;
        let text = self.0.get(&key).ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        json::python(py, key.as_json(text))
    }

    /// The value of a setting, or `default` where the recipe says nothing about it.
    #[pyo3(signature = (name, default = None))]
    fn get<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        default: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let key = key(name)?;
        self.0.get(&key).map_or(Ok(default), |text| json::python(py, key.as_json(text)).map(Some))
    }

    fn __contains__(&self, name: &str) -> bool {
        key(name).is_ok_and(|key| self.0.contains_key(&key))
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    /// The names of the settings that it says something about, as keywords.
    fn keys(&self) -> Vec<String> {
        self.0.keys().copied().map(keyword).collect()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(PyTuple::new(py, self.keys())?.try_iter()?.into_any())
    }

    fn __or__(&self, other: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut asked = self.0.clone();
        let more = Layer::flags(Asked::of(Some(other), None)?.texts()?).or_exception()?;
        asked.extend(more.iter().map(|(key, text)| (key, text.to_owned())));
        Ok(Self(asked))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let from_toml = py.get_type::<Self>().getattr("from_toml")?;
        Ok((from_toml, (self.to_toml()?,)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let one = |(key, text): (&Key, &String)| {
            Ok(format!("{}={}", keyword(*key), json::python(py, key.as_json(text))?.repr()?))
        };
        Ok(format!("Recipe({})", self.0.iter().map(one).collect::<PyResult<Vec<_>>>()?.join(", ")))
    }
}
