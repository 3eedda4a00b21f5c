//! The picture that the camera embedded in the raw file.

use darkroot_colour::{Matrix3, RgbSpace};
use darkroot_photo::{
    AsShot, Calibration, Capture, Counts, Layout, Mosaic, Orientation, Rect, Size, Source, WhiteLevel,
};
use flashraw::{FlashRaw, PreviewEncoding};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::elsewhere::{Answer, Question};
use crate::screen::Container;
use crate::{
    Damage, Error, Limits, TooLarge, elsewhere, exif, flash, guarded, jpeg_frame, nikon_note, screen,
};

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
    preview_to_show(bytes, u32::MAX)
}

/// The smallest embedded JPEG whose longer side has at least so many pixels, or the largest where none has; as [`preview`].
///
/// # Errors
/// As [`preview`].
pub fn preview_to_show(bytes: &[u8], longest: u32) -> Result<Option<Preview>, Error> {
    if let Some(place) = elsewhere::place() {
        return match place.ask(Question::Preview { longest }, bytes, &Limits::default())? {
            Answer::Preview(preview) => Ok(Some(preview)),
            Answer::Nothing => Ok(None),
            _ => Err(elsewhere::another()),
        };
    }
    screen::screen(bytes, &Limits::default())?;
    guarded("flashraw", || {
        let raw = FlashRaw::open(bytes).map_err(|e| crate::flash::error(&e))?;
        let jpegs = || raw.previews().iter().filter(|p| p.encoding == PreviewEncoding::Jpeg);
        let enough = jpegs()
            .filter(|p| p.width.max(p.height) >= longest)
            .min_by_key(|p| (u64::from(p.width) * u64::from(p.height), p.length));
        let largest = || jpegs().max_by_key(|p| (u64::from(p.width) * u64::from(p.height), p.length));
        let Some(info) = enough.or_else(largest) else { return Ok(None) };
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

/// The largest embedded JPEG as a capture: what the camera rendered for display, made linear again; `None` when there is
/// none. Camera and metadata are those of the raw file. Works where the samples cannot be decoded.
///
/// # Errors
/// As [`preview`], [`Error::Damaged`] for a JPEG that cannot be decoded, [`Error::TooLarge`] for one beyond the limits.
pub fn decode_preview(bytes: &[u8], limits: &Limits) -> Result<Option<Capture>, Error> {
    if let Some(place) = elsewhere::place() {
        return match place.ask(Question::DevelopedPreview, bytes, limits)? {
            Answer::Capture(capture) => Ok(Some(*capture)),
            Answer::Nothing => Ok(None),
            _ => Err(elsewhere::another()),
        };
    }
    let Some(preview) = preview(bytes)? else { return Ok(None) };
    let container = screen::screen(bytes, limits)?;
    let (size, rgb) = preview_pixels(&preview.jpeg, limits)?;
    let (space, is_stated) = colour_space(&container);
    let linear: Vec<u16> =
        (0..=255u8).map(|v| (space.curve.decode(f64::from(v) / 255.0) * 65535.0).round() as u16).collect();
    let samples = rgb.iter().map(|&v| linear[usize::from(v)]).collect();
    let header = guarded("flashraw", || flash::header(bytes, &container, limits));
    let (camera, metadata, format) = match header {
        Ok(header) => (header.camera, header.metadata, header.source.format),
        // What cannot be decoded may still say whose it is.
        Err(_) => (Default::default(), exif::of_container(&container), "raw".to_owned()),
    };
    let assumed = if is_stated { "" } else { " (assumed: the file does not say)" };
    Ok(Some(Capture {
        camera,
        metadata,
        orientation: preview.orientation,
        white: WhiteLevel([65535.0; 3]),
        as_shot: Some(AsShot::Neutral([1.0; 3])),
        balance_applied: true,
        calibrations: vec![Calibration {
            kelvin: None,
            color_matrix: space.to_xyz().try_inverse().unwrap_or_else(Matrix3::identity),
            forward_matrix: None,
            camera_calibration: None,
        }],
        rendered: true,
        source: Source {
            format,
            compression: "embedded JPEG".to_owned(),
            bits: 8,
            decoder: "zune-jpeg".to_owned(),
        },
        notes: vec![format!(
            "this is the embedded JPEG, which the camera rendered for display in {}{assumed}, {} x {} pixels of 8 bits: \
             look, profile, demosaicing and highlights have no say in it",
            space.name, size.width, size.height
        )],
        default_crop: Rect::full(size),
        user_crop: None,
        active_area: Rect::full(size),
        ..Capture::bare(Counts::U16(Mosaic { size, layout: Layout::Rgb, samples }))
    }))
}

/// Size and pixels of an embedded JPEG as it is stored: red, green and blue of each, 8 bits, row by row.
///
/// # Errors
/// [`Error::Damaged`] for one that cannot be decoded, [`Error::TooLarge`] for one beyond the limits.
pub fn preview_pixels(jpeg: &[u8], limits: &Limits) -> Result<(Size, Vec<u8>), Error> {
    if let Some(place) = elsewhere::place() {
        return match place.ask(Question::Pixels, jpeg, limits)? {
            Answer::Pixels(size, rgb) => Ok((size, rgb)),
            _ => Err(elsewhere::another()),
        };
    }
    guarded("zune-jpeg", || pixels(jpeg, limits))
}

fn pixels(jpeg: &[u8], limits: &Limits) -> Result<(Size, Vec<u8>), Error> {
    let samples = jpeg_frame::most_samples(jpeg).unwrap_or(u64::MAX);
    if samples > limits.max_samples {
        return Err(Error::TooLarge(TooLarge::Samples(samples)));
    }
    let damaged = |e| Error::from(Damage::Decoder { message: format!("its embedded JPEG: {e}") });
    let side = limits.max_side as usize;
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(side)
        .set_max_height(side)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(std::io::Cursor::new(jpeg), options);
    let rgb = decoder.decode().map_err(damaged)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    if rgb.is_empty() || rgb.len() != width * height * 3 {
        return Err(Error::DecoderFailed { decoder: "zune-jpeg" });
    }
    Ok((Size { width, height }, rgb))
}

/// The colour space of the camera's JPEG, and whether the file says so: by Exif, by DNG, or by Nikon's note.
fn colour_space(container: &Container<'_>) -> (RgbSpace, bool) {
    const SRGB: u64 = 1;
    let Some(tiff) = &container.tiff else { return (RgbSpace::SRGB, false) };
    let of_preview = tiff.all.iter().find_map(|d| d.number(tiff, PREVIEW_COLOR_SPACE));
    match (of_preview, nikon_note::colour_space(tiff), exif::colour_space(tiff)) {
        (Some(3), ..) | (None, Some(2), _) => (RgbSpace::ADOBE_RGB, true),
        (Some(2), ..) | (None, Some(1), _) | (None, None, Some(SRGB)) => (RgbSpace::SRGB, true),
        _ => (RgbSpace::SRGB, false),
    }
}

/// DNG: 2 is sRGB, 3 Adobe RGB.
const PREVIEW_COLOR_SPACE: u16 = 0xc71a;
