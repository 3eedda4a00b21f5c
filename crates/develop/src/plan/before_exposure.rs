//! What the stages before exposure get of what was asked for, of what suits the look, and of what the capture shows.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::analysis::Analysis;
use crate::demosaic::Method;
use crate::denoise::{Asked, Denoiser, Strength};
use crate::geometry::{Geometry, Laid, Lens};
use crate::highlights::{CLIPPED, Rebuild, Treatment, least};
use crate::lateral::Lateral;
use crate::mend::{Mends, Wanted};
use crate::noise::Noise;
use crate::recipe::{Denoise, Mending, Recipe};
use crate::sharpen::Sharpener;

/// Noise that is left when a mosaic is interpolated, where that method has a bias by it.
pub(super) fn noise_left(
    analysis: &Analysis,
    demosaic: Method,
    denoiser: Option<&Denoiser>,
    multipliers: [f32; 3],
) -> Noise {
    let left = denoiser.map_or(1.0, Denoiser::left);
    if demosaic == Method::Lmmse && left > 0.0 {
        Noise::of(analysis.noise(), multipliers).times(left)
    } else {
        Noise::NONE
    }
}

/// What is put right in samples. A measurement gets them as they are.
pub(super) fn mends(analysis: &Analysis, recipe: &Recipe, measuring: bool) -> Arc<Mends> {
    if measuring || analysis.capture().rendered {
        return Arc::default();
    }
    let [hot_pixels, banding] = [recipe.hot_pixels, recipe.banding].map(|mending| mending == Mending::Auto);
    Arc::clone(analysis.mends(Wanted { hot_pixels, banding }))
}

/// Lateral chromatic aberration that is to be corrected: where something certain is known, and no correction of the lens has its
/// own. A measurement gets the samples where they are.
pub(super) fn lateral(
    analysis: &Analysis,
    asked: &Geometry,
    measuring: bool,
    laid: &Laid,
) -> Option<Lateral> {
    let is_kept = measuring || asked.keep_fringes || asked.lens == Lens::Off || laid.splits_colours();
    if is_kept { None } else { analysis.lateral() }
}

/// What takes away noise: as much as is asked for, or as suits the look.
pub(super) fn denoiser(
    analysis: &Analysis,
    asked: Denoise,
    measuring: bool,
    multipliers: [f32; 3],
    mends: &Arc<Mends>,
) -> Option<Arc<Denoiser>> {
    let amount = asked.amount.unwrap_or(if measuring { 0.0 } else { 1.0 });
    let strength = Strength { luma: amount * asked.luma, chroma: amount * asked.chroma };
    if analysis.capture().rendered || strength.luma <= 0.0 && strength.chroma <= 0.0 {
        return None;
    }
    let model = analysis.noise_model()?;
    let limits = analysis.survey().saturation.map(|limit| CLIPPED * limit);
    analysis.denoiser(Asked { by: asked.by, model, multipliers, strength, limits, mends: Arc::clone(mends) })
}

/// Blurs that are undone, pixels: below the first there is nothing to do; beyond the last a picture is not in focus.
const BLURS: RangeInclusive<f32> = 0.3..=0.9;
/// Blur of a picture that does not tell its own.
const USUAL_BLUR: f32 = 0.4;

/// What sharpens the picture.
pub(super) fn sharpener(
    analysis: &Analysis,
    amount: f32,
    multipliers: [f32; 3],
    highlights: &Treatment,
) -> Option<Sharpener> {
    if analysis.capture().rendered || amount <= 0.0 {
        return None;
    }
    let blur = analysis.blur().unwrap_or(USUAL_BLUR).min(*BLURS.end());
    let white = match highlights {
        Treatment::Rebuild(Rebuild { limits, uneven: false, .. }) => least(*limits),
        _ => f32::MAX,
    };
    (blur >= *BLURS.start()).then(|| Sharpener::of(blur, amount, analysis.noise_model(), multipliers, white))
}
