//! Exposure chosen from the picture.

use darkroot_colour::{RgbSpace, white};
use darkroot_profile::{Model, PlaneModel};
use rayon::prelude::*;

use crate::survey::{Block, Survey};

/// Luminance that the picture's middle tones are brought to: a grey card as cameras meter it (ISO 12232).
const METERED_GREY: f64 = 0.127;
/// Shares of the blocks, by luminance, between which tones are middle ones: a black frame around a slide, or a lamp, has no
/// say.
const MIDDLE: [f64; 2] = [0.1, 0.9];
/// Share of the blocks of which no channel may be brought beyond white.
const KEPT: f64 = 0.99;
/// Light that darker blocks count as.
const DARKEST: f32 = 1e-4;
/// Light that brighter blocks count as.
const BRIGHTEST: f32 = 1e4;
const MOST_STOPS: f64 = 5.0;
/// Of larger pictures about so many blocks are looked at, spread all over: a setting that a person drags must answer at
/// once.
const MOST_BLOCKS: usize = 100_000;
/// Blocks that one task looks at.
const TASK: usize = 8192;

/// Stops that bring the geometric mean of the middle tones to a metered grey, without clipping any channel of more than one
/// block in a hundred that is not clipped already.
pub(crate) fn stops(survey: &Survey, model: &Model, multipliers: [f32; 3]) -> f64 {
    let step = survey.blocks.len().div_ceil(MOST_BLOCKS).max(1);
    // A step that shares no factor with the columns walks through all of them.
    let step = (step..).find(|s| greatest_common_divisor(*s, survey.columns.max(1)) == 1).unwrap_or(step);
    let blocks: Vec<&Block> = survey.blocks.iter().step_by(step).collect();
    if blocks.is_empty() {
        return 0.0;
    }
    let to_scene = RgbSpace::REC2020.from_xyz_under(white::D50);
    let model = PlaneModel::new(&model.then(&to_scene));
    let parts: Vec<(Vec<f32>, Vec<f32>)> =
        blocks.par_chunks(TASK).map(|blocks| light(blocks, &model, multipliers)).collect();
    let (luminances, peaks): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    let mut peaks = peaks.concat();
    let peak = if peaks.is_empty() { 1.0 } else { f64::from(at(&mut peaks, KEPT)) };
    (METERED_GREY.log2() - middle(luminances.concat())).min(-peak.log2()).clamp(-MOST_STOPS, MOST_STOPS)
}

/// Mean of the logarithms of middle tones, in stops.
fn middle(mut light: Vec<f32>) -> f64 {
    let [low, high] = MIDDLE.map(|share| at(&mut light, share));
    let middle: Vec<f32> = light.into_iter().filter(|v| (low..=high).contains(v)).collect();
    // One logarithm for the product of several, none of which takes it out of the range of a double.
    let product = |light: &[f32]| light.iter().map(|v| f64::from(*v)).product::<f64>();
    middle.chunks(16).map(|light| product(light).log2()).sum::<f64>() / middle.len().max(1) as f64
}

/// What a share of the values does not exceed.
fn at(values: &mut [f32], share: f64) -> f32 {
    let rank = ((values.len() - 1) as f64 * share) as usize;
    *values.select_nth_unstable_by(rank, f32::total_cmp).1
}

/// Luminances of blocks, and, of those that are not clipped, the light of the channel of the scene's RGB that has most.
fn light(blocks: &[&Block], model: &PlaneModel, multipliers: [f32; 3]) -> (Vec<f32>, Vec<f32>) {
    let weights = RgbSpace::REC2020.to_xyz_under(white::D50).row(1).map(|v| v as f32);
    let plane = |c: usize| blocks.iter().map(|b| b.mean[c] * multipliers[c]).collect::<Vec<f32>>();
    let (mut r, mut g, mut b) = (plane(0), plane(1), plane(2));
    model.apply([&mut r, &mut g, &mut b]);
    let bounded = |v: f32| v.clamp(DARKEST, BRIGHTEST);
    let pixels = || r.iter().zip(&g).zip(&b);
    let luminance = pixels().map(|((r, g), b)| bounded(weights[0] * r + weights[1] * g + weights[2] * b));
    let whole = |block: &&Block| !block.clipped.contains(&true);
    let peaks = pixels().zip(blocks).filter(|(_, block)| whole(block));
    (luminance.collect(), peaks.map(|(((r, g), b), _)| bounded(r.max(*g).max(*b))).collect())
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn survey(colours: Vec<[f32; 3]>) -> Survey {
        let blocks = colours.into_iter().map(|mean| Block { mean, ..Block::default() }).collect();
        Survey { blocks, columns: 100, side: 8, saturation: [1.0; 3] }
    }

    fn of(colours: Vec<[f32; 3]>) -> f64 {
        let model = Model::linear(&RgbSpace::REC2020.to_xyz_under(white::D50));
        stops(&survey(colours), &model, [1.0; 3])
    }

    #[test]
    fn middle_tones_become_middle_grey_whatever_is_black_or_a_lamp() {
        let mut scene = vec![[0.03175; 3]; 1000];
        assert!((of(scene.clone()) - 2.0).abs() < 0.01);
        for frame in &mut scene[..60] {
            *frame = [0.0; 3];
        }
        scene[990] = [1.0; 3];
        assert!((of(scene) - 2.0).abs() < 0.05);
    }

    #[test]
    fn no_channel_of_what_is_bright_is_brought_beyond_white() {
        // A red flower: its luminance would allow two stops, its red channel one.
        let mut scene = vec![[0.02; 3]; 1000];
        for flower in &mut scene[..100] {
            *flower = [0.5, 0.05, 0.05];
        }
        assert!((of(scene) - 1.0).abs() < 0.01);
    }
}
