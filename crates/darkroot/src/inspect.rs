//! What a raw file is, without developing it.

use std::path::{Path, PathBuf};

use darkroot_colour::temperature::Temperature;
use darkroot_develop::{Analysis, Histogram, Whites};
use darkroot_photo::metadata::{Directory, Metadata, tag};
use darkroot_photo::{AsShot, Calibration, Capture, Layout, MakerLens};
use serde::Serialize;

use crate::files;
use crate::photo::Photo;
use crate::store::ProfileStore;
use crate::{Error, Settings};

/// Facts about one raw file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inspection {
    /// The file.
    #[serde(serialize_with = "crate::path_text::serialize")]
    pub input: PathBuf,
    /// Camera, by its common name.
    pub camera: String,
    /// Container ("NEF").
    pub format: String,
    /// Compression.
    pub compression: String,
    /// Bits a stored sample.
    pub bits: u8,
    /// Decoder and version.
    pub decoder: String,
    /// Width and height of the whole frame, masked borders included.
    pub frame: [usize; 2],
    /// Active area: x, y, width, height.
    pub active_area: [usize; 4],
    /// What is shown: x, y, width, height.
    pub crop: [usize; 4],
    /// Orientation as Exif counts it, 1..=8.
    pub orientation: u16,
    /// Colour filter array, "linear RGB" or "monochrome".
    pub filters: String,
    /// Black level: the repeating block, row by row.
    pub black: Vec<f32>,
    /// Whether black level deltas by row or column are there.
    pub black_deltas: bool,
    /// White level for red, green and blue.
    pub white: [f32; 3],
    /// Multipliers as shot, green 1; none when the file does not say.
    pub multipliers: Option<[f64; 3]>,
    /// Temperature of the light as shot, K.
    pub kelvin: Option<f64>,
    /// Tint of the light as shot.
    pub tint: Option<f64>,
    /// The maker's calibrations.
    pub calibrations: Vec<CalibrationFacts>,
    /// DNG BaselineExposure, stops.
    pub baseline_exposure: f64,
    /// Number of DNG corrections before and after demosaicing.
    pub corrections: [usize; 2],
    /// The profile that `develop` would use; none for the camera's matrix.
    pub profile: Option<String>,
    /// Exposure, lens and date as written by the camera.
    pub shot: Shot,
    /// Share of the white level at which red, green and blue clip in this picture (1 when nothing else shows).
    pub saturation: [f32; 3],
    /// How blurred the picture is where it is sharpest, pixels (standard deviation); none where too few edges tell.
    pub blur: Option<f32>,
    /// Share of clipped samples of red, green and blue, 0..=1.
    pub clipped: [f64; 3],
    /// Number of samples by square root of light, 64 bins, for red, green and blue.
    pub histogram: Vec<Vec<u64>>,
    /// Hash of the decoded samples, when asked for.
    pub samples_hash: Option<String>,
    /// Mean of the decoded samples, when the hash was asked for.
    pub samples_mean: Option<f64>,
    /// What had to be assumed or left out.
    pub notes: Vec<String>,
}

/// One calibration of the maker.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CalibrationFacts {
    /// Temperature of its light, K.
    pub kelvin: Option<f64>,
    /// XYZ to camera, row by row.
    pub color_matrix: [f64; 9],
    /// Balanced camera to XYZ D50, row by row.
    pub forward_matrix: Option<[f64; 9]>,
}

/// What the camera wrote about the shot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shot {
    /// Date and time, as the camera writes it.
    pub date: Option<String>,
    /// Lens.
    pub lens: Option<String>,
    /// Exposure time, s.
    pub exposure_time: Option<f64>,
    /// f-number.
    pub f_number: Option<f64>,
    /// ISO speed.
    pub iso: Option<f64>,
    /// Focal length, mm.
    pub focal_length: Option<f64>,
    /// Photographer.
    pub artist: Option<String>,
    /// Copyright.
    pub copyright: Option<String>,
}

impl Shot {
    /// What stands in the metadata of a capture.
    pub fn of(metadata: &Metadata) -> Self {
        let text = |directory, tag| metadata.text(directory, tag).map(str::to_owned);
        // Some programs write 0 for what they do not know.
        let number = |tag| metadata.number(Directory::Exif, tag).filter(|v| *v > 0.0);
        Self {
            date: text(Directory::Exif, tag::DATE_TIME_ORIGINAL),
            lens: text(Directory::Exif, tag::LENS_MODEL),
            exposure_time: number(tag::EXPOSURE_TIME),
            f_number: number(tag::F_NUMBER),
            iso: number(tag::ISO),
            focal_length: number(tag::FOCAL_LENGTH),
            artist: text(Directory::Image, tag::ARTIST),
            copyright: text(Directory::Image, tag::COPYRIGHT),
        }
    }
}

/// Looks at one file.
///
/// # Errors
/// A file that cannot be read or decoded.
pub fn inspect(
    input: &Path,
    settings: &Settings,
    store: &ProfileStore,
    samples_hash: bool,
) -> Result<Inspection, Error> {
    let photo = Photo::open_with(&files::read(input)?, settings.decoder, &settings.limits)
        .map_err(|source| Error::Raw { path: input.to_owned(), source })?;
    inspect_photo(input, &photo, &photo.analyse_as_asked(), settings, store, samples_hash)
}

/// As [`inspect()`], where the photograph is open already; `input` is how it is called.
///
/// # Errors
/// A profile that cannot be used.
pub fn inspect_photo(
    input: &Path,
    photo: &Photo,
    analysis: &Analysis,
    settings: &Settings,
    store: &ProfileStore,
    samples_hash: bool,
) -> Result<Inspection, Error> {
    let capture = photo.capture();
    let saturation = analysis.survey().saturation;
    let Histogram { bins, clipped } = darkroot_develop::histogram(capture, analysis.light(), saturation);
    let chosen = photo.profile(store, settings).map_err(|e| *e)?;
    let whites = Whites::of(analysis.matrix(), chosen.as_ref().map(|c| c.profile.as_ref()));
    let neutral = match capture.as_shot {
        Some(AsShot::Neutral(n)) => Some(n),
        Some(AsShot::White(xy)) => whites.neutral_of(xy),
        None => None,
    };
    let white = whites.as_shot(capture).map(Temperature::of);
    let rect = |r: darkroot_photo::Rect| [r.x, r.y, r.width, r.height];
    let size = capture.counts.size();
    let (hash, mean) = if samples_hash { hash_and_mean(capture) } else { (None, None) };
    Ok(Inspection {
        input: input.to_owned(),
        camera: capture.camera.name(),
        format: capture.source.format.clone(),
        compression: capture.source.compression.clone(),
        bits: capture.source.bits,
        decoder: capture.source.decoder.clone(),
        frame: [size.width, size.height],
        active_area: rect(capture.active_area),
        crop: rect(capture.shown()),
        orientation: capture.orientation.exif(),
        filters: match capture.counts.layout() {
            Layout::Cfa(cfa) => cfa.to_string(),
            Layout::Rgb => "linear RGB".to_owned(),
            Layout::Monochrome => "monochrome".to_owned(),
        },
        black: capture.black.values.clone(),
        black_deltas: !(capture.black.row_deltas.is_empty() && capture.black.column_deltas.is_empty()),
        white: capture.white.0,
        multipliers: neutral.map(|n| n.map(|v| n[1] / v)),
        kelvin: white.map(|w| w.kelvin),
        tint: white.map(|w| w.tint()),
        calibrations: capture.calibrations.iter().map(calibration).collect(),
        baseline_exposure: capture.baseline_exposure,
        corrections: [capture.mosaic_corrections.len(), capture.picture_corrections.len()],
        profile: store.find(&capture.camera).map(|f| format!("{} ({})", f.profile.camera().name(), f.place)),
        shot: Shot::of(&capture.metadata),
        saturation,
        blur: analysis.blur(),
        clipped,
        histogram: bins.iter().map(|h| h.to_vec()).collect(),
        samples_hash: hash,
        samples_mean: mean,
        notes: capture.notes.iter().cloned().chain(capture.maker_lens.as_ref().map(of_lens)).collect(),
    })
}

/// What the maker's note says of the lens.
fn of_lens(lens: &MakerLens) -> String {
    format!(
        "{}'s note describes the lens ({}); that could not be checked against pictures of the camera, and it is corrected only \
         where that is asked for{}",
        lens.maker,
        lens.parts(),
        lens.and_left()
    )
}

/// Writes the embedded preview of a raw file, as it is stored.
///
/// # Errors
/// No preview, or input or output cannot be used.
pub fn save_preview(input: &Path, output: &Path, overwrite: bool) -> Result<darkroot_raw::Preview, Error> {
    if crate::naming::same(input, output) {
        return Err(Error::OverInput { path: input.to_owned() });
    }
    let bytes = files::read(input)?;
    let preview =
        darkroot_raw::preview(&bytes).map_err(|source| Error::Raw { path: input.to_owned(), source })?;
    let preview = preview.ok_or_else(|| Error::NoPreview { path: input.to_owned() })?;
    files::write_whole(output, &preview.jpeg, overwrite)?;
    Ok(preview)
}

fn hash_and_mean(capture: &Capture) -> (Option<String>, Option<f64>) {
    let hash = format!("{:016x}", darkroot_raw::samples_hash(&capture.counts));
    let mean = match &capture.counts {
        darkroot_photo::Counts::U16(m) => {
            m.samples.iter().map(|&v| f64::from(v)).sum::<f64>() / m.samples.len() as f64
        }
        darkroot_photo::Counts::F32(m) => {
            m.samples.iter().map(|&v| f64::from(v)).sum::<f64>() / m.samples.len() as f64
        }
    };
    (Some(hash), Some(mean))
}

fn calibration(c: &Calibration) -> CalibrationFacts {
    let rows = |m: &darkroot_colour::Matrix3| std::array::from_fn(|i| m[(i / 3, i % 3)]);
    CalibrationFacts {
        kelvin: c.kelvin,
        color_matrix: rows(&c.color_matrix),
        forward_matrix: c.forward_matrix.as_ref().map(rows),
    }
}
