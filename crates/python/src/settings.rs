//! Settings as Python names them: keywords with underscores, values of Python's types.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot::recipe::{Layer, Layers};
use darkroot::settings::{Changes, ChartShot};
use darkroot::{Key, Limits, ProfileStore, RecipeError, Settings, light};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use crate::fault::{Class, OrException};
use crate::profile::Profile;
use crate::recipe::Recipe;
use crate::{json, store};

/// Every setting as a dictionary: name, default, help, what is allowed, type, range, words.
#[pyfunction]
pub(crate) fn describe(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    json::python(py, darkroot::settings::describe())
}

/// What a call asks for.
pub(crate) struct Asked {
    values: Vec<(Key, String)>,
    /// A profile that is in memory.
    profile: Option<Arc<darkroot_profile::Profile>>,
}

impl Asked {
    /// A recipe (a [`Recipe`], a dictionary or a file) and keywords, which count more.
    pub(crate) fn of(
        recipe: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let mut asked = Self { values: Vec::new(), profile: None };
        if let Some(recipe) = recipe {
            asked.take_recipe(recipe)?;
        }
        if let Some(keywords) = keywords {
            asked.take(keywords)?;
        }
        Ok(asked)
    }

    fn take_recipe(&mut self, recipe: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(recipe) = recipe.cast::<Recipe>() {
            self.values.extend(recipe.get().values());
        } else if let Ok(dict) = recipe.cast::<PyDict>() {
            self.take(dict)?;
        } else {
            let layer = Layer::read(&recipe.extract::<PathBuf>()?).or_exception()?;
            self.values.extend(layer.iter().map(|(key, text)| (key, text.to_owned())));
        }
        Ok(())
    }

    fn take(&mut self, keywords: &Bound<'_, PyDict>) -> PyResult<()> {
        for (name, value) in keywords {
            let key = key(&name.extract::<String>()?)?;
            if key == Key::named("profile")
                && let Ok(profile) = value.cast::<Profile>()
            {
                self.profile = Some(profile.get().shared());
            } else if let Some(text) = text_of(key, &value)? {
                self.values.push((key, text));
            }
        }
        Ok(())
    }

    /// The texts alone, for what cannot take a profile from memory.
    pub(crate) fn texts(self) -> PyResult<Vec<(Key, String)>> {
        match self.profile {
            None => Ok(self.values),
            Some(_) => {
                Err(Class::Settings.says("a profile goes by its file here; save it and give the file's name"))
            }
        }
    }

    /// The profiles that serve.
    pub(crate) fn store(&self) -> Arc<ProfileStore> {
        match &self.profile {
            Some(profile) => Arc::new(ProfileStore::of_one((**profile).clone())),
            None => store::store(),
        }
    }

    /// The settings for a file; with `folders` also what `darkroot.toml` and sidecars say.
    pub(crate) fn for_file(&self, path: &Path, folders: bool) -> Result<Settings, RecipeError> {
        Layers::new(None, Layer::flags(self.values.clone())?, folders)?.for_file(path)?.settings()
    }

    /// The settings for a photograph in memory. What had a say when it was opened, or needs files, is refused.
    pub(crate) fn for_photo(&self) -> PyResult<Settings> {
        let decoding = |(key, _): &&(Key, String)| key.setting().changes == Changes::Photo;
        if let Some((key, _)) = self.values.iter().find(decoding) {
            let words = format!("`{key}` counts when a file is read: give it to `develop` or `develop_file`");
            return Err(Class::Settings.says(words));
        }
        let settings = self.for_file(Path::new(""), false).or_exception()?;
        if settings.chart.shot != ChartShot::None {
            let words = "`exposure-from-chart` goes with files: give it to `develop_file`";
            return Err(Class::Settings.says(words));
        }
        Ok(settings)
    }
}

/// How files are decoded where a call says nothing.
pub(crate) fn limits() -> Limits {
    Limits::default()
}

/// The setting of a keyword.
pub(crate) fn key(name: &str) -> PyResult<Key> {
    let written = name.replace('_', "-");
    Key::from_name(&written).ok_or(RecipeError::Name { name: written }).or_exception()
}

/// A keyword's name.
pub(crate) fn keyword(key: Key) -> String {
    key.name().replace('-', "_")
}

/// A value as it would be written on the command line; nothing for `None`.
pub(crate) fn text_of(key: Key, value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    let text = if value.is_none() {
        return Ok(None);
    } else if let Ok(switch) = value.cast::<PyBool>() {
        switch.is_true().to_string()
    } else if let Ok(text) = value.cast::<PyString>() {
        text.to_string()
    } else if value.is_instance_of::<PyInt>() || value.is_instance_of::<PyFloat>() {
        value.repr()?.to_string()
    } else if value.is_instance_of::<PyTuple>() || value.is_instance_of::<PyList>() {
        let parts = value.try_iter()?.map(|part| Ok(text_of(key, &part?)?.unwrap_or_default()));
        parts.collect::<PyResult<Vec<_>>>()?.join(",")
    } else if let Ok(path) = value.extract::<PathBuf>() {
        path.to_str().map(str::to_owned).ok_or_else(|| {
            Class::Settings.says(format!("`{key}`: names of files in settings are written in Unicode"))
        })?
    } else {
        // Numbers of NumPy say what they are by their own text.
        value.str()?.to_string()
    };
    if key.name() == "illuminant" {
        return light::without_file(&text).or_exception().map(Some);
    }
    Ok(Some(text))
}
