//! Exposure chosen from the picture.

use darkroot_profile::{Model, PlaneModel};
use rayon::prelude::*;

use crate::survey::{Block, Survey};

/// Luminance that the picture's geometric mean is brought to: a grey card as cameras meter it (ISO 12232).
const METERED_GREY: f64 = 0.127;
/// Luminance that darker blocks count as.
const DARKEST: f32 = 1e-4;
/// Luminance that brighter blocks count as.
const BRIGHTEST: f32 = 1e4;
const MOST_STOPS: f64 = 5.0;
/// Of larger pictures about so many blocks are looked at, spread all over: a setting that a person drags must answer at
/// once.
const MOST_BLOCKS: usize = 100_000;
/// Blocks that one task looks at.
const TASK: usize = 8192;

/// Stops that bring the picture's geometric mean luminance to that of a metered grey, without clipping more than
/// one block in a hundred.
pub(crate) fn stops(survey: &Survey, model: &Model, multipliers: [f32; 3]) -> f64 {
    let step = survey.blocks.len().div_ceil(MOST_BLOCKS).max(1);
    // A step that shares no factor with the columns walks through all of them.
    let step = (step..).find(|s| greatest_common_divisor(*s, survey.columns.max(1)) == 1).unwrap_or(step);
    let blocks: Vec<&Block> = survey.blocks.iter().step_by(step).collect();
    let model = PlaneModel::new(model);
    let parts: Vec<(Vec<f32>, f64)> =
        blocks.par_chunks(TASK).map(|blocks| luminances(blocks, &model, multipliers)).collect();
    let mean_log = parts.iter().map(|(_, logs)| logs).sum::<f64>() / blocks.len().max(1) as f64;
    let mut light: Vec<f32> = parts.into_iter().flat_map(|(light, _)| light).collect();
    if light.is_empty() {
        return 0.0;
    }
    let rank = (light.len() - 1) * 99 / 100;
    let bright = f64::from(*light.select_nth_unstable_by(rank, f32::total_cmp).1);
    (METERED_GREY.log2() - mean_log).min(-bright.log2()).clamp(-MOST_STOPS, MOST_STOPS)
}

/// Luminances of blocks, and the sum of their logarithms.
fn luminances(blocks: &[&Block], model: &PlaneModel, multipliers: [f32; 3]) -> (Vec<f32>, f64) {
    let plane = |c: usize| blocks.iter().map(|b| b.mean[c] * multipliers[c]).collect::<Vec<f32>>();
    let (mut x, mut y, mut z) = (plane(0), plane(1), plane(2));
    model.apply([&mut x, &mut y, &mut z]);
    for v in &mut y {
        *v = v.clamp(DARKEST, BRIGHTEST);
    }
    // One logarithm for the product of several, none of which takes it out of the range of a double.
    let product = |light: &[f32]| light.iter().map(|v| f64::from(*v)).product::<f64>();
    let logs = y.chunks(16).map(|light| product(light).log2()).sum();
    (y, logs)
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
