//! Look-up tables that are laid over a look: `.cube` and CLF files.

mod clf;
mod cube;
mod fault;

pub use fault::LutFault;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use darkroot_develop::Overlay;
use darkroot_develop::lut::Lut;

use crate::settings::Settings;
use crate::{Error, files};

/// The table that was read last, with its file and the time at which that was changed: who drags a slider keeps it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Last(Arc<Mutex<Option<Read>>>);

#[derive(Debug)]
struct Read {
    path: PathBuf,
    changed: Option<SystemTime>,
    lut: Arc<Lut>,
}

impl Last {
    /// The table that the settings ask for.
    ///
    /// # Errors
    /// A file that cannot be read or is no table.
    pub(crate) fn of(&self, settings: &Settings) -> Result<Option<Overlay>, Error> {
        let Some(path) = &settings.lut else { return Ok(None) };
        let changed = path.metadata().and_then(|data| data.modified()).ok();
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let lut = match &*last {
            Some(read) if read.path == *path && read.changed == changed => Arc::clone(&read.lut),
            _ => Arc::new(read(path)?),
        };
        *last = Some(Read { path: path.clone(), changed, lut: Arc::clone(&lut) });
        Ok(Some(Overlay { lut, space: settings.lut_space }))
    }
}

/// A file: CLF where it is XML, else `.cube`.
///
/// # Errors
/// A file that cannot be read or is no table.
pub fn read(path: &Path) -> Result<Lut, Error> {
    let bytes = files::read_text(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let fault = |source| Error::Lut { path: path.to_owned(), source };
    parse(&text).map_err(fault)
}

/// What a file says.
///
/// # Errors
/// A text that is no table.
pub fn parse(text: &str) -> Result<Lut, LutFault> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim_start().starts_with('<') { clf::parse(text) } else { cube::parse(text) }
}

#[cfg(test)]
mod tests;
