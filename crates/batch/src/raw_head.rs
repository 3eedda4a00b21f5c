//! What stands at the head of a raw file: the one place that reads it.

use std::path::Path;

use darkroot::{Error, naming};
use darkroot_photo::{Camera, Counts};

use super::facts::Header;

/// What a worker must know of a raw file before it decodes it.
#[derive(Debug, Clone, Default)]
pub(crate) struct RawHead {
    pub(crate) header: Header,
    pub(crate) camera: Camera,
    /// Numbers that decoding will give.
    pub(crate) samples: u64,
    /// Whether they are floating point.
    pub(crate) float: bool,
}

impl RawHead {
    /// Reads it from the bytes of a file.
    pub(crate) fn of(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let capture = darkroot_raw::header(bytes, &darkroot_raw::Limits::default())
            .map_err(|source| Error::Raw { path: path.to_owned(), source })?;
        let (camera, date) = naming::header_of(&capture);
        let size = capture.counts.size();
        let pixels = size.width as u64 * size.height as u64;
        Ok(Self {
            header: Header { camera, date, pixels },
            samples: pixels * capture.counts.layout().planes() as u64,
            float: matches!(capture.counts, Counts::F32(_)),
            camera: capture.camera,
        })
    }
}
