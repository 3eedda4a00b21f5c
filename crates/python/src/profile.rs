//! What a camera's colours mean.

use std::path::PathBuf;
use std::sync::Arc;

use darkroot_profile::lint;
use numpy::{AllowTypeChange, PyArrayDyn, PyArrayLikeDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::fault::{Class, OrException};
use crate::{json, store};

/// What one camera's colours mean: from its linear RGB to XYZ. :class:`darkroot.Profile` says more.
#[pyclass(module = "darkroot._core", frozen, subclass, eq)]
#[derive(PartialEq)]
pub(crate) struct Profile(Arc<darkroot_profile::Profile>);

impl Profile {
    pub(crate) fn shared(&self) -> Arc<darkroot_profile::Profile> {
        Arc::clone(&self.0)
    }
}

impl From<darkroot_profile::Profile> for Profile {
    fn from(profile: darkroot_profile::Profile) -> Self {
        Self(Arc::new(profile))
    }
}

#[pymethods]
impl Profile {
    /// Reads the text of a profile file.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let profile = darkroot_profile::file::parse(text);
        Ok(profile.map_err(|fault| Class::Profile.says(format!("the text {fault}")))?.into())
    }
}
