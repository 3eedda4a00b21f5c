//! A rendered picture (JPEG, PNG, TIFF). As something to look for a chart in, its sRGB curve is taken off, but what the
//! maker's tone curve and gamut mapping did stays in.

use std::path::Path;

use darkroot_colour::RgbSpace;
use darkroot_photo::metadata::tag;
use darkroot_photo::{Layout, Mosaic, Size};
use image::ImageDecoder;

use crate::fault::ChartError;
use crate::{Error, files};

/// Bytes that a picture and the numbers that it becomes may take together: 200 megapixels of three bytes each.
const MOST_BYTES: u64 = 200_000_000 * (3 + BYTES_OF_PIXEL);
/// TIFF: the ICC profile.
const ICC_PROFILE: u16 = 0x8773;
/// Bytes of a pixel of linear RGB.
const BYTES_OF_PIXEL: u64 = 12;

/// Whether a file is named like a rendered picture.
pub(crate) fn is_rendered(path: &Path) -> bool {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    matches!(ending.as_str(), "jpg" | "jpeg" | "png" | "tif" | "tiff")
}

/// Reads a picture as linear RGB, 1 = white.
pub(super) fn read(path: &Path) -> Result<Mosaic<f32>, Error> {
    let Encoded { size, mut samples, .. } = encoded(path, &files::read(path)?)?;
    for v in &mut samples {
        *v = RgbSpace::SRGB.curve.decode(f64::from(*v)) as f32;
    }
    Ok(Mosaic { size, layout: Layout::Rgb, samples })
}

/// A picture as it is stored, and what it says of its colours.
pub(crate) struct Encoded {
    pub(crate) size: Size,
    /// R, G, B of each pixel as they are encoded, 0..=1.
    pub(crate) samples: Vec<f32>,
    /// Bits of a sample in the file.
    pub(crate) bits: u16,
    pub(crate) icc: Option<Vec<u8>>,
    pub(crate) xmp: Option<Vec<u8>>,
}

/// Decodes a picture, within bounds.
pub(crate) fn encoded(path: &Path, bytes: &[u8]) -> Result<Encoded, Error> {
    let reader = image::ImageReader::new(std::io::Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| Error::read(path, e))?;
    let unreadable = |e| Error::chart(path, ChartError::Picture(e));
    let mut decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    // A picture of one bit becomes twelve bytes a pixel: what it becomes is counted, not what it is.
    let each = u64::from(decoder.color_type().bytes_per_pixel()) + BYTES_OF_PIXEL;
    if u64::from(width) * u64::from(height) > MOST_BYTES / each {
        return Err(Error::chart(path, ChartError::Large { width, height }));
    }
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(MOST_BYTES);
    decoder.set_limits(limits).map_err(unreadable)?;
    // What TIFF has is read without its decoder, which gives up at large profiles.
    let of_tiff = |tag: u16| darkroot_encode::tiff_field::bytes_of(bytes, tag).map(<[u8]>::to_vec);
    let icc = of_tiff(ICC_PROFILE).or_else(|| decoder.icc_profile().ok().flatten());
    let xmp = of_tiff(tag::XMP).or_else(|| decoder.xmp_metadata().ok().flatten());
    let colour = decoder.color_type();
    let bits = 8 * u16::from(colour.bytes_per_pixel()) / u16::from(colour.channel_count().max(1));
    let picture = image::DynamicImage::from_decoder(decoder).map_err(unreadable)?;
    let picture = picture.into_rgb32f();
    let size = Size { width: picture.width() as usize, height: picture.height() as usize };
    if size.area() == 0 {
        return Err(Error::chart(path, ChartError::Empty));
    }
    Ok(Encoded { size, samples: picture.into_raw(), bits, icc, xmp })
}
