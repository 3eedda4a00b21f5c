//! A photograph that is open: samples, what the frame shows, and what is kept for the next picture.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use darkroot::{Analysis, Photo as Core, Plan, ProfileStore, Settings};
use darkroot_develop::{Kept, Look};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;

use crate::fault::OrException;
use crate::settings::limits;

/// Where the bytes are from, for what is read later.
#[derive(Clone)]
pub(crate) enum Source {
    File(PathBuf),
    Memory(Arc<PyBackedBytes>),
}

impl Source {
    /// Does something with the bytes of the file.
    pub(crate) fn with<T>(&self, work: impl FnOnce(&[u8]) -> T) -> Result<T, darkroot::Error> {
        match self {
            Self::File(path) => darkroot::files::read(path).map(|bytes| work(&bytes)),
            Self::Memory(bytes) => Ok(work(bytes)),
        }
    }
}

/// What is open.
pub(crate) struct Open {
    pub(crate) photo: Core,
    /// What the frame shows; looked for when it is first wanted, and kept.
    analysis: OnceLock<Analysis>,
    /// What the photograph is called in messages.
    pub(crate) name: PathBuf,
    pub(crate) source: Source,
    /// Camera RGB of the view that was made last.
    pub(crate) kept: Kept,
}

impl Open {
    pub(crate) fn new(photo: Core, name: PathBuf, source: Source) -> Self {
        Self { photo, analysis: OnceLock::new(), name, source, kept: Kept::default() }
    }

    pub(crate) fn analysis(&self) -> &Analysis {
        self.analysis.get_or_init(|| self.photo.analyse_as_asked())
    }

    /// How a picture is made of it.
    pub(crate) fn plan(&self, settings: &Settings, store: &ProfileStore) -> PyResult<Plan> {
        let mut photo = self.photo.clone();
        if settings.recipe.look == Look::Camera {
            photo = self.source.with(|bytes| photo.with_preview(bytes, &limits())).or_exception()?;
        }
        if settings.dark.is_none() && settings.flat.is_none() {
            return photo.plan(self.analysis(), store, settings).or_exception();
        }
        let photo = photo.with_frames(settings).or_exception()?;
        photo.plan(&photo.analyse_as_asked(), store, settings).or_exception()
    }
}
