//! The picture that the camera embedded in the raw file.

use darkroot_photo::{Orientation, Size};
use flashraw::{FlashRaw, PreviewEncoding};

use crate::{Error, Limits, guarded, screen};

/// An embedded JPEG.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Preview {
    /// The JPEG file, as stored.
    pub jpeg: Vec<u8>,
    /// Its size as the container states it.
    pub size: Size,
    /// How to turn it upright.
    pub orientation: Orientation,
}

/// The largest embedded JPEG, `None` when there is none. Works even where the samples cannot be decoded.
///
/// # Errors
/// [`Error::NotRaw`] or [`Error::Damaged`] when the container cannot be read.
pub fn preview(bytes: &[u8]) -> Result<Option<Preview>, Error> {
    screen::screen(bytes, &Limits::default())?;
    guarded("flashraw", || {
        let raw = FlashRaw::open(bytes).map_err(|e| crate::flash::error(&e))?;
        let largest = raw
            .previews()
            .iter()
            .filter(|p| p.encoding == PreviewEncoding::Jpeg)
            .max_by_key(|p| (u64::from(p.width) * u64::from(p.height), p.length));
        let Some(info) = largest else { return Ok(None) };
        let jpeg = raw.preview_bytes(info).map_err(|e| crate::flash::error(&e))?;
        // A preview is shown as it is: make sure that it is one.
        if !jpeg.starts_with(&[0xff, 0xd8]) {
            return Ok(None);
        }
        Ok(Some(Preview {
            jpeg: jpeg.to_vec(),
            size: Size { width: info.width as usize, height: info.height as usize },
            orientation: Orientation::from_exif(info.orientation.exif()),
        }))
    })
}
