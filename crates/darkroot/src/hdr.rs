//! What of a photograph is brighter than white, for screens that show it.

use darkroot_colour::{RgbSpace, white};
use darkroot_develop::{Bits, Output, OutputSpace, Recipe, Tones};
use darkroot_encode::GainMap;
use darkroot_encode::gain_map::OFFSET;
use darkroot_photo::{Picture, PictureSpace, Samples};

/// Light of white on paper in a picture with light above it, cd/m² (ITU-R BT.2408-7).
const WHITE: f64 = 203.0;

/// Name of what such a picture's samples mean.
pub(crate) const SPACE: &str = "Rec. 2100, PQ";

/// Light of the brightest samples there is room for, cd/m².
pub(crate) fn peak(stops: f32) -> f64 {
    WHITE * f64::from(stops).exp2()
}

/// The recipe of a picture in absolute light: linear, in Rec. 2020, 1 for [`peak`].
pub(crate) fn absolute(recipe: &Recipe, stops: f32) -> Recipe {
    in_light(recipe, OutputSpace::Rgb(RgbSpace::REC2020.linear()), stops)
}

/// Halvings from the picture to its gain map: a quarter of its width and height.
pub(crate) const HALVINGS: u8 = 2;
/// Gains below that are none, stops.
const LEAST: f64 = 0.05;

/// The recipe of display light, and of such light with room above white.
pub(crate) fn recipes(recipe: &Recipe, stops: f32) -> [Recipe; 2] {
    let space = match recipe.output.space {
        OutputSpace::Rgb(space) => OutputSpace::Rgb(space.linear()),
        other => other,
    };
    [0.0, stops].map(|headroom| in_light(recipe, space, headroom))
}

/// A recipe of floating-point samples in a linear space, with room above white.
fn in_light(recipe: &Recipe, space: OutputSpace, headroom: f32) -> Recipe {
    let tones = Tones { headroom, ..recipe.tones };
    Recipe { tones, output: Output { space, bits: Bits::Float }, ..recipe.clone() }
}

/// The gain map of a picture, of views of both recipes; `None` where nothing is brighter than white.
pub(crate) fn gain_map([shown, brighter]: [&Picture; 2], stops: f32) -> Option<GainMap> {
    let PictureSpace::Rgb(space) = shown.space else { return None };
    let (shown, size, peak) = (luminances(shown, &space)?, shown.size, f64::from(stops).exp2());
    let gains: Vec<f64> = shown
        .zip(luminances(brighter, &space)?)
        .map(|(shown, brighter)| ((peak * brighter + OFFSET) / (shown + OFFSET)).log2().max(0.0))
        .collect();
    let most = gains.iter().copied().fold(0.0, f64::max);
    let sample = |gain: &f64| (255.0 * gain / most).round() as u8;
    (most > LEAST).then(|| GainMap { size, samples: gains.iter().map(sample).collect(), most })
}

/// Luminance of each pixel, 1 for white.
fn luminances(picture: &Picture, space: &RgbSpace) -> Option<impl Iterator<Item = f64>> {
    let Samples::F32(samples) = &picture.samples else { return None };
    let to_xyz = space.to_xyz_under(white::D50);
    let weights = [0, 1, 2].map(|c| to_xyz[(1, c)]);
    let light =
        move |rgb: &[f32]| (0..3).map(|c| weights[c] * f64::from(rgb[c])).sum::<f64>().clamp(0.0, 1.0);
    Some(samples.chunks_exact(3).map(light))
}
