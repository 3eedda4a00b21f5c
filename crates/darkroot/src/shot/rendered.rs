//! A rendered picture (JPEG, PNG, TIFF) as something to look for a chart in: its sRGB curve is taken off, but what the
//! maker's tone curve and gamut mapping did stays in.

use std::path::Path;

use darkroot_colour::RgbSpace;
use darkroot_photo::{Layout, Mosaic, Size};

use crate::fault::ChartError;
use crate::{Error, files};

/// Most pixels of a rendered picture.
const MOST_PIXELS: u64 = 200_000_000;

/// Whether a file is named like a rendered picture.
pub(super) fn is_rendered(path: &Path) -> bool {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    matches!(ending.as_str(), "jpg" | "jpeg" | "png" | "tif" | "tiff")
}

/// Reads a picture as linear RGB, 1 = white.
pub(super) fn read(path: &Path) -> Result<Mosaic<f32>, Error> {
    let mut reader = image::ImageReader::new(std::io::Cursor::new(files::read(path)?))
        .with_guessed_format()
        .map_err(|e| Error::read(path, e))?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(MOST_PIXELS * 8);
    reader.limits(limits);
    let picture = reader.decode().map_err(|e| Error::chart(path, ChartError::Picture(e)))?;
    let picture = picture.into_rgb32f();
    let size = Size { width: picture.width() as usize, height: picture.height() as usize };
    if size.area() == 0 {
        return Err(Error::chart(path, ChartError::Empty));
    }
    let linear = |v: f32| RgbSpace::SRGB.curve.decode(f64::from(v)) as f32;
    let samples = picture.into_raw().into_iter().map(linear).collect();
    Ok(Mosaic { size, layout: Layout::Rgb, samples })
}
