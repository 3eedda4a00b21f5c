//! What the loops use: everything computed once for one capture, one profile and one recipe.

use darkroot_colour::temperature::{Temperature, daylight_xy};
use darkroot_colour::{RgbSpace, TransferCurve, Xy, white};
use darkroot_photo::{AsShot, Capture, Correction, Layout, Orientation, Rect, Size};
use darkroot_profile::{Model, PlaneModel, Profile};

use crate::corrections::is_supported;
use crate::demosaic::Method;
use crate::gamut::Primaries;
use crate::highlights::{self, Treatment};
use crate::level::Levels;
use crate::noise::Noise;
use crate::recipe::{Balance, Bits, Crop, Highlights, OutputSpace, Recipe};
use crate::survey::{self, Survey};
use crate::tone::Curve;
use crate::transfer::Encoder;
use crate::white::{self as camera_white, CameraMatrix};

/// Why a capture cannot be developed as asked. Each message completes "FILE: ".
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The sensor has filters of other colours.
    #[error("has a sensor with the filters {filters}, which cannot be developed yet; `inspect` still works")]
    Filters {
        /// The filter array.
        filters: String,
    },
    /// A temperature was asked of a camera without matrices.
    #[error(
        "has no colour matrix, so a colour temperature means nothing for it; use `--white-balance as-shot`, `auto` or \
         multipliers"
    )]
    NoMatrix,
    /// A temperature that is no light.
    #[error(
        "cannot be balanced for {kelvin} K with tint {tint}: use 2000 to 25000 K and a tint of -150 to 150"
    )]
    Temperature {
        /// What was asked.
        kelvin: f64,
        /// What was asked.
        tint: f64,
    },
    /// Multipliers that are not positive numbers.
    #[error(
        "cannot be balanced with these multipliers: all three must be more than 0 (and at most 100 apart)"
    )]
    Multipliers,
    /// A grey spot outside the picture, or too dark or clipped.
    #[error("has no usable grey at {x},{y}: {why}; choose a spot inside the {width} x {height} picture")]
    Spot {
        /// Column asked for.
        x: usize,
        /// Row asked for.
        y: usize,
        /// What is wrong with it.
        why: &'static str,
        /// Width of the picture.
        width: usize,
        /// Height of the picture.
        height: usize,
    },
}

/// What the colours of a picture were computed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// A profile.
    Profile,
    /// The maker's matrices, from the file or the decoder's list.
    CameraMatrix,
    /// Nothing is known of the camera: its RGB was taken for linear sRGB.
    Assumed,
    /// Monochrome sensor.
    Grey,
}

/// A recipe made ready for one capture.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What the colours are computed with.
    pub colours: Colours,
    /// White of the light; `None` when nothing tells it.
    pub white: Option<Temperature>,
    /// White-balance multipliers; the smallest is 1.
    pub multipliers: [f32; 3],
    /// Factor on scene-linear light.
    pub gain: f32,
    /// Demosaicing method.
    pub demosaic: Method,
    /// What had to be assumed or left out, in words.
    pub notes: Vec<String>,
    pub(crate) crop: Rect,
    pub(crate) orientation: Orientation,
    pub(crate) levels: Levels,
    pub(crate) mosaic_corrections: Vec<Correction>,
    pub(crate) picture_corrections: Vec<Correction>,
    pub(crate) highlights: Treatment,
    pub(crate) noise: Noise,
    /// Balanced camera RGB to linear Rec. 2020; `None` for camera output.
    pub(crate) model: Option<PlaneModel>,
    pub(crate) curve: Option<Curve>,
    pub(crate) primaries: Primaries,
    pub(crate) encoder: Encoder,
    pub(crate) space: OutputSpace,
    pub(crate) bits: Bits,
}

impl Plan {
    /// Size of the developed picture, upright.
    pub fn size(&self) -> Size {
        self.orientation.applied_to(self.crop.size())
    }
}

/// Looks at the whole capture once and prepares every stage. Without a profile the camera's own matrices serve.
///
/// # Errors
/// A sensor that cannot be developed, or a white balance that is impossible for this capture.
pub fn plan(capture: &Capture, profile: Option<&Profile>, recipe: &Recipe) -> Result<Plan, Error> {
    let layout = capture.counts.layout();
    let demosaic =
        Method::of(layout, recipe.demosaic).ok_or_else(|| Error::Filters { filters: filters(layout) })?;
    let levels = Levels::new(capture);
    let crop = match recipe.crop {
        Crop::Default => capture.default_crop,
        Crop::Active => capture.active_area,
    };
    let mut notes = Vec::new();
    let mut seen = None;
    let matrix = CameraMatrix::of(capture);
    let neutral = neutral(capture, recipe, matrix.as_ref(), &levels, crop, &mut seen, &mut notes)?;
    let multipliers = multipliers(neutral);

    let white = white_xy(capture, neutral, matrix.as_ref());
    let (colours, model) = colours(capture, profile, matrix.as_ref(), neutral, white, &mut notes);
    let linear_look = Curve::of(recipe.look).is_none();
    let treatment = match recipe.highlights {
        // A measurement must not contain what was guessed.
        Highlights::Rebuild if linear_look => Treatment::Keep,
        Highlights::Rebuild => {
            let survey = seen.get_or_insert_with(|| survey::whole(capture, &levels));
            Treatment::Rebuild { limits: limits(survey, multipliers), offsets: offsets(survey, multipliers) }
        }
        Highlights::Clip => {
            let survey = seen.get_or_insert_with(|| survey::whole(capture, &levels));
            let lowest = limits(survey, multipliers).iter().fold(f32::MAX, |a, &b| a.min(b));
            Treatment::Clip { limit: lowest }
        }
        Highlights::Keep => Treatment::Keep,
    };
    let mut stops = recipe.exposure.stops;
    if !linear_look {
        stops += capture.baseline_exposure;
    }
    if recipe.exposure.auto {
        let survey = seen.get_or_insert_with(|| survey::whole(capture, &levels));
        stops += auto_exposure(survey, &model, multipliers)
            - if linear_look { 0.0 } else { capture.baseline_exposure };
    }
    let (space, curve) = match recipe.output.space {
        OutputSpace::Rgb(space) => (space, space.curve),
        OutputSpace::Camera => (RgbSpace::REC2020, TransferCurve::Linear),
    };
    let to_scene = RgbSpace::REC2020.from_xyz_under(white::D50);
    let camera_output = recipe.output.space == OutputSpace::Camera;
    for correction in capture.mosaic_corrections.iter().chain(&capture.picture_corrections) {
        if !is_supported(correction) {
            notes.push("the file's lens distortion correction (WarpRectilinear) is not applied".to_owned());
        }
    }
    let mosaic_corrections = supported(&capture.mosaic_corrections);
    let noise = match demosaic {
        Method::Lmmse => Noise::measure(capture, &levels, &mosaic_corrections, multipliers),
        _ => Noise::NONE,
    };
    Ok(Plan {
        colours,
        white: white.map(Temperature::of),
        multipliers,
        gain: 2f64.powf(stops) as f32,
        demosaic,
        notes,
        crop,
        orientation: capture.orientation,
        levels,
        mosaic_corrections,
        noise,
        picture_corrections: supported(&capture.picture_corrections),
        highlights: if camera_output { Treatment::Keep } else { treatment },
        model: (!camera_output).then(|| PlaneModel::new(&model.then(&to_scene))),
        curve: Curve::of(recipe.look),
        primaries: Primaries::new(&space),
        encoder: Encoder::new(curve),
        space: recipe.output.space,
        bits: recipe.output.bits,
    })
}

fn supported(corrections: &[Correction]) -> Vec<Correction> {
    corrections.iter().filter(|c| is_supported(c)).cloned().collect()
}

fn filters(layout: &Layout) -> String {
    if let Layout::Cfa(cfa) = layout { cfa.to_string() } else { String::new() }
}

/// Camera RGB of the light's white, as the recipe wants it.
fn neutral(
    capture: &Capture,
    recipe: &Recipe,
    matrix: Option<&CameraMatrix>,
    levels: &Levels,
    crop: Rect,
    seen: &mut Option<Survey>,
    notes: &mut Vec<String>,
) -> Result<[f64; 3], Error> {
    if *capture.counts.layout() == Layout::Monochrome {
        return Ok([1.0; 3]);
    }
    // Samples that the camera has balanced already: its white is (1,1,1) in them, and another white is relative.
    let stored = |neutral: [f64; 3]| match (capture.balance_applied, capture.as_shot) {
        (true, Some(AsShot::Neutral(shot))) => [0, 1, 2].map(|c| neutral[c] / shot[c]),
        _ => neutral,
    };
    let of_white = |xy: Xy| matrix.and_then(|m| m.neutral_of(xy)).map(stored).ok_or(Error::NoMatrix);
    let mut estimated = || {
        let survey = seen.get_or_insert_with(|| survey::whole(capture, levels));
        camera_white::estimate(survey, matrix)
    };
    match recipe.balance {
        Balance::AsShot => match capture.as_shot {
            _ if capture.balance_applied => Ok([1.0; 3]),
            Some(AsShot::Neutral(neutral)) => Ok(neutral),
            Some(AsShot::White(xy)) => of_white(xy),
            // Linear files without a neutral are balanced.
            None if *capture.counts.layout() == Layout::Rgb => Ok([1.0; 3]),
            None => {
                notes.push("no white balance is recorded; it was estimated from the picture".to_owned());
                Ok(estimated().unwrap_or([1.0; 3]))
            }
        },
        Balance::Auto => Ok(estimated().unwrap_or_else(|| {
            notes.push(
                "the picture is too dark or too bright to estimate a white balance; none was applied".into(),
            );
            [1.0; 3]
        })),
        Balance::Daylight => of_white(daylight_xy(5503.0)),
        Balance::Kelvin { kelvin, tint } => {
            if !((2000.0..=25000.0).contains(&kelvin) && (-150.0..=150.0).contains(&tint)) {
                return Err(Error::Temperature { kelvin, tint });
            }
            of_white(Temperature::from_kelvin_tint(kelvin, tint).xy())
        }
        Balance::Spot { x, y, side } => spot(capture, levels, crop, x, y, side),
        Balance::Multipliers(m) => {
            let (low, high) =
                (m.iter().copied().fold(f64::MAX, f64::min), m.iter().copied().fold(0.0, f64::max));
            let sound = m.iter().all(|v| v.is_finite()) && low > 0.0 && high / low <= 100.0;
            if sound { Ok(m.map(|v| 1.0 / v)) } else { Err(Error::Multipliers) }
        }
    }
}

/// Neutral of a grey spot, given in pixels of the developed picture.
fn spot(
    capture: &Capture,
    levels: &Levels,
    crop: Rect,
    x: usize,
    y: usize,
    side: usize,
) -> Result<[f64; 3], Error> {
    let upright = capture.orientation.applied_to(crop.size());
    let wrong = |why| Error::Spot { x, y, why, width: upright.width, height: upright.height };
    if x >= upright.width || y >= upright.height {
        return Err(wrong("it lies outside"));
    }
    let (u, v) = capture.orientation.inverse().place(x, y, upright);
    let side = side.clamp(8, 4096);
    let around = Rect {
        x: (crop.x + u).saturating_sub(side / 2),
        y: (crop.y + v).saturating_sub(side / 2),
        width: side,
        height: side,
    };
    let around = around.intersection(crop).ok_or_else(|| wrong("it lies outside"))?;
    if around.width < 8 || around.height < 8 {
        return Err(wrong("the picture is too small there"));
    }
    let mean = survey::mean(capture, levels, around);
    if mean.iter().any(|&v| v < 1e-3) {
        return Err(wrong("it is too dark"));
    }
    if mean.iter().any(|&v| v > 0.95) {
        return Err(wrong("it is clipped"));
    }
    Ok(mean)
}

/// Multipliers of a neutral, the smallest 1.
fn multipliers(neutral: [f64; 3]) -> [f32; 3] {
    let largest = neutral.iter().copied().fold(0.0, f64::max);
    neutral.map(|v| (largest / v) as f32)
}

/// Chromaticity of the light's white, where something tells it.
fn white_xy(capture: &Capture, neutral: [f64; 3], matrix: Option<&CameraMatrix>) -> Option<Xy> {
    let matrix = matrix?;
    Some(match (capture.balance_applied, capture.as_shot) {
        (true, Some(AsShot::Neutral(shot))) => matrix.white_of([0, 1, 2].map(|c| neutral[c] * shot[c])),
        _ => matrix.white_of(neutral),
    })
}

/// The model of the camera under this light, and where it is from.
fn colours(
    capture: &Capture,
    profile: Option<&Profile>,
    matrix: Option<&CameraMatrix>,
    neutral: [f64; 3],
    white: Option<Xy>,
    notes: &mut Vec<String>,
) -> (Colours, Model) {
    let assumed = Model::linear(&RgbSpace::SRGB.to_xyz_under(white::D50));
    if *capture.counts.layout() == Layout::Monochrome {
        return (Colours::Grey, assumed);
    }
    match (profile, matrix) {
        (Some(profile), _) => {
            let kelvin = white.map_or(5003.0, |xy| Temperature::of(xy).kelvin);
            if white.is_none() && profile.calibrations().len() > 1 {
                notes.push(
                    "the light's temperature is not known; the profile was used as for 5003 K".to_owned(),
                );
            }
            (Colours::Profile, profile.model_for(kelvin))
        }
        (None, Some(matrix)) => {
            let white = white.unwrap_or(white::D50_XY);
            (Colours::CameraMatrix, Model::linear(&matrix.to_xyz_d50(neutral, white)))
        }
        (None, None) => {
            notes.push("no colour matrix is known for this camera: its RGB was taken for sRGB".to_owned());
            (Colours::Assumed, assumed)
        }
    }
}

/// Balanced value at which each channel clips.
fn limits(survey: &Survey, multipliers: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|c| multipliers[c] * survey.saturation[c])
}

/// Typical difference between a channel and the mean of the two others, balanced, where the picture begins to
/// clip: in blocks that are whole, next to blocks that are not.
fn offsets(survey: &Survey, multipliers: [f32; 3]) -> [f32; 3] {
    let columns = survey.columns.max(1);
    let rows = survey.blocks.len() / columns;
    let mut sums = [0f64; 3];
    let mut counts = [0f64; 3];
    for (i, block) in survey.blocks.iter().enumerate() {
        if block.clipped.contains(&true) {
            continue;
        }
        let (x, y) = (i % columns, i / columns);
        let mut beside = [false; 3];
        for v in y.saturating_sub(1)..(y + 2).min(rows) {
            for u in x.saturating_sub(1)..(x + 2).min(columns) {
                let clipped = survey.blocks[v * columns + u].clipped;
                beside = [0, 1, 2].map(|c| beside[c] || clipped[c]);
            }
        }
        let balanced = [0, 1, 2].map(|c| f64::from(block.mean[c] * multipliers[c]));
        for c in (0..3).filter(|&c| beside[c]) {
            sums[c] += balanced[c] - (balanced[(c + 1) % 3] + balanced[(c + 2) % 3]) / 2.0;
            counts[c] += 1.0;
        }
    }
    [0, 1, 2].map(|c| (sums[c] / counts[c].max(1.0)) as f32)
}

/// Stops that bring the picture's geometric mean luminance to that of a metered grey, without clipping more than
/// one block in a hundred.
fn auto_exposure(survey: &Survey, model: &Model, multipliers: [f32; 3]) -> f64 {
    const METERED_GREY: f64 = 0.127;
    const DARKEST: f64 = 1e-4;
    const MOST_STOPS: f64 = 5.0;
    let mut light: Vec<f64> = survey
        .blocks
        .iter()
        .map(|b| model.xyz([0, 1, 2].map(|c| f64::from(b.mean[c] * multipliers[c]))).y.max(DARKEST))
        .collect();
    if light.is_empty() {
        return 0.0;
    }
    light.sort_by(f64::total_cmp);
    let mean_log = light.iter().map(|y| y.log2()).sum::<f64>() / light.len() as f64;
    let bright = light[(light.len() - 1) * 99 / 100];
    (METERED_GREY.log2() - mean_log).min(-bright.log2()).clamp(-MOST_STOPS, MOST_STOPS)
}

/// Border of a tile: what highlights and demosaicing look at.
pub(crate) fn border(plan: &Plan) -> usize {
    match plan.demosaic {
        Method::None => 0,
        method => method.border() + highlights::BORDER,
    }
}
