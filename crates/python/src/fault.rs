//! Errors of the library as exceptions of the package, by whose fault it is. The classes stand in `darkroot/_errors.py`.

use std::io;

use darkroot::{Error, PlanError, RecipeError, SettingsError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyModule, PyType};

/// A class of exceptions in `darkroot._errors`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Class {
    /// The raw file: damaged, no raw file, beyond the limits.
    File,
    /// The raw file is sound, and this program does not know its kind.
    Unsupported,
    /// The caller: a setting that is none, settings that contradict each other.
    Settings,
    /// A profile, spectra or a fit that cannot be used.
    Profile,
    /// A shot of a chart, a chart or a reference.
    Chart,
    /// A file that is not there.
    Missing,
    /// A file that is there and must not be replaced.
    Exists,
    /// The system: rights, disks, folders.
    Storage,
    /// Somebody cancelled it.
    Cancelled,
    /// Something else, which is a fault of the program.
    Error,
}

impl Class {
    fn name(self) -> &'static str {
        match self {
            Self::File => "FileError",
            Self::Unsupported => "UnsupportedError",
            Self::Settings => "SettingsError",
            Self::Profile => "ProfileError",
            Self::Chart => "ChartError",
            Self::Missing => "MissingError",
            Self::Exists => "ExistsError",
            Self::Storage => "StorageError",
            Self::Cancelled => "Cancelled",
            Self::Error => "Error",
        }
    }

    /// An exception of this class with a sentence.
    pub(crate) fn says(self, sentence: impl Into<String>) -> PyErr {
        static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
        let sentence = sentence.into();
        Python::attach(|py| {
            let module = MODULE.get_or_try_init(py, || py.import("darkroot._errors").map(Bound::unbind));
            let class = module.and_then(|m| Ok(m.bind(py).getattr(self.name())?.cast_into::<PyType>()?));
            class.map_or_else(|fault| fault, |class| PyErr::from_type(class, sentence))
        })
    }
}

/// A fault of the system.
pub(crate) fn storage(sentence: String) -> PyErr {
    Class::Storage.says(sentence)
}

/// A panic: nothing that a caller can have done.
pub(crate) fn ours() -> PyErr {
    Class::Error.says("the work ended by a fault of Darkroot itself; please report it with the file")
}

/// A fault of the library as an exception.
pub(crate) trait IntoException {
    /// With the sentence that the program says.
    fn exception(self) -> PyErr;
}

/// As [`IntoException`], for results.
pub(crate) trait OrException<T> {
    /// What there is, or the exception.
    fn or_exception(self) -> PyResult<T>;
}

impl<T, E: IntoException> OrException<T> for Result<T, E> {
    fn or_exception(self) -> PyResult<T> {
        self.map_err(IntoException::exception)
    }
}

fn of_raw(error: &darkroot_raw::Error) -> Class {
    use darkroot_raw::Error as E;
    match error {
        E::Compression { .. } | E::Camera { .. } | E::WrongDecoder { .. } => Class::Unsupported,
        _ => Class::File,
    }
}

fn of_plan(error: &darkroot_develop::Error) -> Class {
    match error {
        darkroot_develop::Error::Filters { .. } => Class::Unsupported,
        _ => Class::Settings,
    }
}

fn of_io(error: &io::Error) -> Class {
    if error.kind() == io::ErrorKind::NotFound { Class::Missing } else { Class::Storage }
}

fn of(error: &Error) -> Class {
    match error {
        Error::Read { source, .. } => of_io(source),
        Error::Raw { source, .. } => of_raw(source),
        Error::Plan { source, .. } => of_plan(source),
        Error::NoPreview { .. } | Error::Frame { .. } => Class::File,
        Error::Profile { .. }
        | Error::Dcp { .. }
        | Error::Spectra { .. }
        | Error::NoProfile { .. }
        | Error::NoCamera { .. }
        | Error::Neutral { .. }
        | Error::Fit { .. }
        | Error::NotListed { .. }
        | Error::Prior
        | Error::OtherCamera { .. } => Class::Profile,
        Error::Chart { .. } | Error::SeveralShots { .. } => Class::Chart,
        Error::Light { .. }
        | Error::LightOfMatrix { .. }
        | Error::Lut { .. }
        | Error::NoLight
        | Error::Settings { .. }
        | Error::Encode { .. }
        | Error::OverInput { .. } => Class::Settings,
        Error::Exists { .. } => Class::Exists,
        Error::Write { .. } | Error::DiskFull { .. } => Class::Storage,
        Error::Cancelled { .. } => Class::Cancelled,
        _ => Class::Error,
    }
}

impl IntoException for Error {
    fn exception(self) -> PyErr {
        of(&self).says(self.to_string())
    }
}

impl IntoException for PlanError {
    fn exception(self) -> PyErr {
        match self {
            Self::Settings(fault) => fault.exception(),
            Self::File(fault) => fault.exception(),
            Self::Develop(fault) => of_plan(&fault).says(format!("the photograph {fault}")),
            other => Class::Error.says(other.to_string()),
        }
    }
}

impl IntoException for RecipeError {
    fn exception(self) -> PyErr {
        Class::Settings.says(self.to_string())
    }
}

impl IntoException for SettingsError {
    fn exception(self) -> PyErr {
        Class::Settings.says(self.to_string())
    }
}

impl IntoException for darkroot::Cancelled {
    fn exception(self) -> PyErr {
        Class::Cancelled.says(self.to_string())
    }
}
