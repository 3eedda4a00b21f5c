//! Floating-point samples in JPEG XL (DNG 1.7, compression 52546), which flashraw does not read.
//!
//! Everything but the samples comes from flashraw's reading of the headers.

use darkroot_colour::{Matrix3, RgbSpace, Vector3};
use flashraw::{Compression, FrameInfo, SampleFormat};
use jxl_oxide::color::{ColourEncoding, ColourSpace, Primaries, TransferFunction, WhitePoint};
use jxl_oxide::{AllocTracker, EnumColourEncoding, JxlImage, JxlThreadPool};
use rayon::prelude::*;

use crate::pieces::{Grid, tag};
use crate::tiff::{Directories, Directory};
use crate::{Damage, Error, Limits, TooLarge};

/// TIFF's number of JPEG XL.
const JPEG_XL: u64 = 52546;
/// TIFF SampleFormat of floating-point numbers.
const FLOAT: u64 = 3;
/// Bytes that decoding a sample may take, and what it may take in any case.
const BYTES_A_SAMPLE: usize = 96;
const BYTES_AT_LEAST: usize = 64 << 20;

/// Whether the frame is stored so.
pub(crate) fn is_stored_so(info: &FrameInfo) -> bool {
    info.compression == Compression::JpegXl && info.sample_format == SampleFormat::F32
}

/// Decodes the samples, row by row. 1.0 in a stream is 1.0 here: the file's levels say what that means.
pub(crate) fn decode(tiff: &Directories<'_>, info: &FrameInfo, limits: &Limits) -> Result<Vec<f32>, Error> {
    let (width, height, planes) = (info.width as usize, info.height as usize, info.cpp as usize);
    let samples = width.saturating_mul(height).saturating_mul(planes);
    if samples as u64 > limits.max_samples {
        return Err(Error::TooLarge(TooLarge::Samples(samples as u64)));
    }
    let directory = tiff.all.iter().find(|d| is_of(tiff, d, info)).ok_or_else(missing)?;
    let grid = Grid::of(tiff, directory, width, height).ok_or_else(missing)?;
    let mut frame = vec![0f32; samples];
    let across = width.div_ceil(grid.width);
    frame.par_chunks_mut(grid.height * width * planes).enumerate().try_for_each(|(row, rows)| {
        for column in 0..across {
            let bytes = grid.piece(tiff, row * across + column).ok_or_else(missing)?;
            let left = column * grid.width;
            place(bytes, rows, (left, grid.width.min(width - left)), (width, planes))?;
        }
        Ok::<(), Error>(())
    })?;
    Ok(frame)
}

/// Whether a directory is that of the frame.
fn is_of(tiff: &Directories<'_>, directory: &Directory, info: &FrameInfo) -> bool {
    let is = |tag, value: u64| directory.number(tiff, tag) == Some(value);
    directory.number(tiff, tag::NEW_SUBFILE_TYPE).unwrap_or(0) == 0
        && is(tag::COMPRESSION, JPEG_XL)
        && is(tag::SAMPLE_FORMAT, FLOAT)
        && is(tag::IMAGE_WIDTH, info.width.into())
        && is(tag::IMAGE_LENGTH, info.height.into())
}

/// Decodes a tile into the rows of its part of the frame, from column `left` on.
fn place(
    bytes: &[u8],
    rows: &mut [f32],
    (left, columns): (usize, usize),
    (width, planes): (usize, usize),
) -> Result<(), Error> {
    let height = rows.len() / (width * planes);
    let room = rows.len().saturating_mul(BYTES_A_SAMPLE).max(BYTES_AT_LEAST);
    let mut image = JxlImage::builder()
        .pool(JxlThreadPool::none())
        .alloc_tracker(AllocTracker::with_limit(room))
        .read(bytes)
        .map_err(|e| damaged(&*e))?;
    let matrix = unmapped(&mut image)?;
    let render = image.render_frame(0).map_err(|e| damaged(&*e))?;
    let decoded = render.image_all_channels();
    if decoded.channels() < planes || decoded.width() < columns || decoded.height() < height {
        return Err(missing());
    }
    let stride = decoded.width() * decoded.channels();
    for (line, row) in decoded.buf().chunks_exact(stride).zip(rows.chunks_exact_mut(width * planes)) {
        let pixels = line.chunks_exact(decoded.channels());
        for (to, from) in row[left * planes..][..columns * planes].chunks_exact_mut(planes).zip(pixels) {
            to.copy_from_slice(&from[..planes]);
            if let (Some(matrix), [r, g, b]) = (&matrix, to) {
                let [x, y, z] = (matrix * Vector3::new(f64::from(*r), f64::from(*g), f64::from(*b))).into();
                (*r, *g, *b) = (x as f32, y as f32, z as f32);
            }
        }
    }
    Ok(())
}

/// Asks for the colours of a stream as they are, and gives the matrix to the primaries that it names; `None` where they are
/// those already.
///
/// Lossy streams are stored in XYB (ISO/IEC 18181-1, annex L). To wide primaries jxl-oxide does not only convert it: it maps
/// what it takes for HDR into 0..=1, which light of a sensor is not. Linear sRGB comes unmapped, also outside of it.
fn unmapped(image: &mut JxlImage) -> Result<Option<Matrix3>, Error> {
    let metadata = &image.image_header().metadata;
    let encoding = match &metadata.colour_encoding {
        _ if !metadata.xyb_encoded => return Ok(None),
        ColourEncoding::Enum(encoding) => encoding.clone(),
        ColourEncoding::IccProfile(_) => return Err(unusual()),
    };
    let space = match (&encoding.primaries, &encoding.white_point, &encoding.tf, encoding.colour_space) {
        (Primaries::Srgb, WhitePoint::D65, TransferFunction::Linear, ColourSpace::Rgb) => RgbSpace::SRGB,
        (Primaries::Bt2100, WhitePoint::D65, TransferFunction::Linear, ColourSpace::Rgb) => RgbSpace::REC2020,
        (Primaries::P3, WhitePoint::D65, TransferFunction::Linear, ColourSpace::Rgb) => RgbSpace::DISPLAY_P3,
        _ => return Err(unusual()),
    };
    image.request_color_encoding(EnumColourEncoding { primaries: Primaries::Srgb, ..encoding });
    Ok(space.to_xyz().try_inverse().map(|from_xyz| from_xyz * RgbSpace::SRGB.to_xyz()))
}

fn unusual() -> Error {
    let compression = "floating-point JPEG XL in unusual colours".to_owned();
    Error::Compression { compression, decoder: "this program" }
}

fn damaged(e: &dyn std::error::Error) -> Error {
    Damage::Decoder { message: format!("JPEG XL: {e}") }.into()
}

fn missing() -> Error {
    Damage::Decoder { message: "a tile of its samples is missing or too small".to_owned() }.into()
}
