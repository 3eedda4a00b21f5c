//! What a DNG states beside its samples.

use std::io::{Seek, Write};
use std::sync::Arc;

use darkroot_colour::{Matrix3, RgbSpace, white};
use darkroot_photo::Picture;
use tiff::TiffResult;
use tiff::tags::Type;

use super::{Entries, fractions, put, signed_fractions, tag};
use crate::tiff_entries::{closed, write_bytes};

/// What a DNG states beside its samples and the fields of the shot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dng {
    /// Maker and model of the camera, "Nikon D700"; may be empty.
    pub camera: String,
    /// Name of the raw file that it was made of; may be empty.
    pub original: String,
    /// Stops by which the picture is to be made brighter than its samples are.
    pub exposure: f64,
    /// What gives the colours.
    pub colours: CameraColours,
    /// The picture to look at, in sRGB with 8 bits.
    pub preview: Option<Arc<Picture>>,
}

/// What gives the colours of camera RGB, as in a camera profile (DNG 1.7.1, chapter 6).
#[derive(Debug, Clone, PartialEq)]
pub struct CameraColours {
    /// Name of the profile.
    pub name: String,
    /// Camera RGB of a neutral surface, the largest channel 1.
    pub neutral: [f64; 3],
    /// `LightSource` of Exif 2.32 that is nearest to the light.
    pub illuminant: u16,
    /// XYZ of that light to camera RGB.
    pub color_matrix: Matrix3,
    /// Balanced camera RGB to XYZ relative to D50.
    pub forward_matrix: Matrix3,
    /// What the matrix leaves.
    pub table: Option<HueSatTable>,
}

/// A table over hue and saturation of linear ProPhoto RGB.
#[derive(Debug, Clone, PartialEq)]
pub struct HueSatTable {
    /// Number of hues and of saturations.
    pub dimensions: [usize; 2],
    /// Shift of hue in degrees, factors for saturation and value; the saturation varies fastest.
    pub nodes: Vec<[f32; 3]>,
}

impl Default for CameraColours {
    /// Camera RGB that is linear sRGB.
    fn default() -> Self {
        Self {
            name: "sRGB".to_owned(),
            neutral: [1.0; 3],
            illuminant: 23, // D50.
            color_matrix: RgbSpace::SRGB.from_xyz_under(white::D50),
            forward_matrix: RgbSpace::SRGB.to_xyz_under(white::D50),
            table: None,
        }
    }
}

/// Writes what a DNG states into its first directory.
pub(super) fn put_into<W: Write + Seek>(entries: &mut Entries<'_, W>, facts: &Dng) -> TiffResult<()> {
    let Dng { camera, original, exposure, colours, preview: _ } = facts;
    let mut text = |tag: u16, text: &str| match text.is_empty() {
        true => Ok(()),
        false => write_bytes(entries, tag, Type::ASCII, &closed(&text.replace('\0', ""))),
    };
    // A file must name its camera.
    text(tag::UNIQUE_CAMERA_MODEL, if camera.is_empty() { "Unknown" } else { camera })?;
    text(tag::ORIGINAL_RAW_FILE_NAME, original)?;
    text(tag::PROFILE_NAME, &colours.name)?;

    let by_rows = |matrix: &Matrix3| signed_fractions(matrix.transpose().iter());
    put(entries, tag::COLOR_MATRIX, &by_rows(&colours.color_matrix)[..])?;
    put(entries, tag::FORWARD_MATRIX, &by_rows(&colours.forward_matrix)[..])?;
    put(entries, tag::CALIBRATION_ILLUMINANT, colours.illuminant)?;
    put(entries, tag::AS_SHOT_NEUTRAL, &fractions(&colours.neutral)[..])?;
    put(entries, tag::BASELINE_EXPOSURE, &signed_fractions([exposure])[..])?;
    for tag in [tag::BASELINE_NOISE, tag::BASELINE_SHARPNESS, tag::LINEAR_RESPONSE_LIMIT] {
        put(entries, tag, &fractions(&[1.0])[..])?;
    }
    // Whoever has the file may use the profile, which makes no black of its own.
    put(entries, tag::EMBED_POLICY, 3_u32)?;
    put(entries, tag::BLACK_RENDER, 1_u32)?;
    if let Some(table) = &colours.table {
        let [hues, saturations] = table.dimensions.map(|n| n as u32);
        put(entries, tag::MAP_DIMENSIONS, &[hues, saturations, 1][..])?;
        put(entries, tag::MAP, table.nodes.as_flattened())?;
    }
    Ok(())
}
