//! The look that the camera gave a photograph: a curve of lightness and a factor on chroma, fitted to the embedded preview.
//!
//! Both pictures are laid over each other in small cells, borders of the preview left out. Cells without contrast of their own
//! tell what became of a lightness, whatever lies a little beside its place; the median of those of one lightness does not
//! mind local changes. A preview that no curve explains is refused.

mod cells;
mod common;

pub use cells::Cells;
pub use common::common;

use std::sync::Arc;

use darkroot_colour::{RgbSpace, statistics};
use darkroot_photo::{Capture, Picture};
use darkroot_profile::Profile;

use crate::analysis::Analysis;
use crate::error::Error;
use crate::plan::plan;
use crate::recipe::{
    Balance, Bits, Crop, Demosaic, Denoise, Exposure, Geometry, Look, Output, OutputSpace, Recipe, Tones,
};
use crate::tone::Points;
use crate::view::{Cancel, Scale};

/// Pixels along the longer side of the pictures that are compared.
const SIDE: usize = 256;
/// Bins of lightness, of which each may give a point.
const BINS: usize = 13;
/// Share of the cells that a bin must have.
const SHARE: f64 = 0.004;
/// Least distance of points, L*.
const APART: f64 = 2.0;
/// Least spread of lightness that tells of a curve, L*.
const SPREAD: f64 = 15.0;
/// Largest median difference that is left by a curve, L*.
const LEFT: f64 = 4.0;
/// Chroma (Oklab) from which on a cell tells of chroma.
const COLOURED: f64 = 0.03;
/// Cells that it takes for that.
const FEW: usize = 30;
/// Difference of colours all over the picture from which on whites differ, Oklab.
const WHITES: f64 = 0.025;
/// What a mild factor on chroma is.
const CHROMA: [f64; 2] = [0.7, 1.5];

/// Why no look of the camera can be had.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoCameraLook {
    /// There is no preview.
    #[error("has no embedded preview that would show the camera's look")]
    NoPreview,
    /// Too small, or of another shape.
    #[error("has an embedded preview that does not show the photograph (too small, or of another shape)")]
    Shape,
    /// Too few tones.
    #[error("shows too few different tones to tell the camera's look")]
    FewTones,
    /// No curve explains it.
    #[error(
        "has an embedded preview that differs from place to place ({left:.0} L* beside any curve), so its look is no curve"
    )]
    Apart {
        /// Median difference that is left, L*.
        left: f64,
    },
}

/// What the camera made of a photograph.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraLook {
    /// Lightness of the neutral look, and what the camera made of it.
    pub points: Vec<[f64; 2]>,
    /// Factor on chroma.
    pub saturation: f64,
    /// Median difference that the curve leaves, L*.
    pub left: f64,
}

impl CameraLook {
    /// As settings are written.
    pub fn words(&self) -> String {
        format!("--curve {} --saturation {:.2}", self.curve(), self.saturation)
    }

    /// The curve as the setting of that name is written.
    pub fn curve(&self) -> String {
        let points: Vec<String> = self.points.iter().map(|[a, b]| format!("{a:.0}:{b:.0}")).collect();
        points.join(",")
    }

    /// The changes of a look, with these laid over them.
    fn over(&self, tones: Tones) -> Tones {
        let curve = Points::new(&self.points).ok();
        Tones { curve, saturation: tones.saturation * self.saturation as f32, ..tones }
    }
}

/// A small picture of what the camera rendered, for [`fit`].
///
/// # Errors
/// A preview that cannot be developed.
pub fn small(rendered: Arc<Capture>) -> Result<Picture, Error> {
    shown(&Analysis::deferred(rendered), None, &plain(Tones::default()))
}

/// The recipe in which both pictures are compared: nothing but light, profile and look.
fn plain(tones: Tones) -> Recipe {
    Recipe {
        balance: Balance::AsShot,
        exposure: Exposure::default(),
        look: Look::Neutral,
        tones,
        lut: None,
        crop: Crop::default(),
        geometry: Geometry::default(),
        denoise: Denoise { amount: Some(0.0), ..Denoise::default() },
        sharpen: Some(0.0),
        demosaic: Demosaic::default(),
        output: Output { space: OutputSpace::Rgb(RgbSpace::SRGB.linear()), bits: Bits::Float },
        ..Recipe::default()
    }
}

/// A picture of about [`SIDE`] pixels.
fn shown(analysis: &Analysis, profile: Option<&Profile>, recipe: &Recipe) -> Result<Picture, Error> {
    let plan = plan(analysis, profile, recipe)?;
    let view = plan.whole(Scale::to_show(plan.size(), SIDE));
    // Nobody else has this wish, so it is never cancelled.
    plan.render(view, &Cancel::default()).map_err(|_| Error::CameraLook(NoCameraLook::NoPreview))
}

/// The look of the camera, by a small picture of what it rendered.
///
/// # Errors
/// A preview that tells none, or a photograph that cannot be developed.
pub fn fit(analysis: &Analysis, profile: Option<&Profile>, rendered: &Picture) -> Result<CameraLook, Error> {
    let theirs = Cells::of_whole(rendered);
    let ours = |tones| {
        let picture = shown(analysis, profile, &plain(tones))?;
        theirs.beside(&picture).ok_or(Error::CameraLook(NoCameraLook::Shape))
    };
    let (plain, preview) = ours(Tones::default())?;
    let mut look = curve(&plain, &preview).map_err(Error::CameraLook)?;
    // Chroma follows lightness, so it is looked at when that is right.
    let (curved, preview) = ours(look.over(Tones::default()))?;
    look.saturation = saturation(&curved, &preview);
    Ok(look)
}

/// The recipe with the look of the camera in it.
pub fn with(look: &CameraLook, recipe: Recipe) -> Recipe {
    Recipe { look: Look::Neutral, tones: look.over(recipe.tones), ..recipe }
}

/// The curve from one set of cells to the other.
fn curve(ours: &Cells, theirs: &Cells) -> Result<CameraLook, NoCameraLook> {
    let mut pairs = ours.calm_pairs(theirs);
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let at = |share: f64| pairs.get((share * pairs.len() as f64) as usize).map_or(0.0, |pair| pair[0]);
    if pairs.is_empty() || at(0.95) - at(0.05) < SPREAD {
        return Err(NoCameraLook::FewTones);
    }
    let least = ((SHARE * pairs.len() as f64) as usize).max(4);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for bin in 0..BINS {
        let [from, to] = [bin, bin + 1].map(|b| 100.0 * b as f64 / BINS as f64);
        let first = pairs.partition_point(|pair| pair[0] < from);
        let inside = &pairs[first..first + pairs[first..].partition_point(|pair| pair[0] < to)];
        if inside.len() < least {
            continue;
        }
        let middle = [0, 1].map(|i| median(inside.iter().map(|pair| pair[i]).collect()));
        let far = points.last().is_none_or(|last| middle[0] - last[0] >= APART);
        if far && middle[0] > APART && middle[0] < 100.0 - APART {
            points.push(middle);
        }
    }
    if points.len() < 3 {
        return Err(NoCameraLook::FewTones);
    }
    let points = smooth(&points);
    let curve = Points::new(&points).map_err(|_| NoCameraLook::FewTones)?;
    let left = median(pairs.iter().map(|[a, b]| (curve.lightness(*a) - b).abs()).collect());
    if left > LEFT {
        return Err(NoCameraLook::Apart { left });
    }
    Ok(CameraLook { points, saturation: 1.0, left })
}

/// Points with what each differs by smoothed, so that they never fall, in tenths.
fn smooth(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let differences: Vec<f64> = points.iter().map(|[a, b]| b - a).collect();
    let at = |i: usize| differences[i];
    let last = points.len() - 1;
    let mut high = 0.0f64;
    let tenths = |v: f64| (10.0 * v).round() / 10.0;
    (0..points.len())
        .map(|i| {
            let smooth = match i {
                0 => at(0),
                _ if i == last => at(last),
                _ => 0.25 * at(i - 1) + 0.5 * at(i) + 0.25 * at(i + 1),
            };
            high = tenths((points[i][0] + smooth).clamp(high, 100.0));
            [tenths(points[i][0]), high]
        })
        .collect()
}

/// Factor on chroma; 1 where the whites of the two differ, so that it would tell nothing.
fn saturation(ours: &Cells, theirs: &Cells) -> f64 {
    let pairs = ours.calm_colours(theirs);
    let shift = [0, 1].map(|i| median(pairs.iter().map(|[a, b]| b[i] - a[i]).collect()));
    let chroma = |[a, b]: [f64; 2]| a.hypot(b);
    let coloured = pairs.iter().map(|pair| pair.map(chroma)).filter(|[a, _]| *a > COLOURED);
    let ratios: Vec<f64> = coloured.map(|[a, b]| b / a).collect();
    if ratios.len() < FEW || chroma(shift) > WHITES {
        return 1.0;
    }
    let hundredths = (100.0 * median(ratios)).round() / 100.0;
    hundredths.clamp(CHROMA[0], CHROMA[1])
}

/// The median; 0 of nothing.
fn median(mut values: Vec<f64>) -> f64 {
    statistics::median(&mut values).unwrap_or_default()
}

#[cfg(test)]
mod tests;
