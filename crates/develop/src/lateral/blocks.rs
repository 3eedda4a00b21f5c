//! Which blocks of a frame are looked at: those with the most contrast of each part of it.

use crate::survey::Survey;

/// Side of a block, pixels.
pub(super) const SIDE: usize = 64;
/// Parts of the frame along its width and its height.
const PARTS: (usize, usize) = (12, 8);
/// Blocks of a part that are looked at, at most.
const MOST: usize = 8;
/// Steps of light between neighbours in the survey, as a share of their mean, that a block must have in the mean.
const CONTRAST: f32 = 0.02;

/// Columns and rows of the corners of blocks in the active area, which has this width and height.
pub(super) fn chosen(survey: &Survey, (width, height): (usize, usize)) -> Vec<(usize, usize)> {
    let per_block = SIDE / survey.side.max(1);
    if per_block * survey.side != SIDE || survey.columns == 0 {
        return Vec::new();
    }
    let rows = survey.blocks.len() / survey.columns;
    let (across, down) = (survey.columns / per_block, rows / per_block);
    let mut by_part = vec![Vec::new(); PARTS.0 * PARTS.1];
    for (i, j) in (0..down).flat_map(|j| (0..across).map(move |i| (i, j))) {
        let corner = (i * SIDE, j * SIDE);
        if corner.0 + SIDE > width || corner.1 + SIDE > height {
            continue;
        }
        if let Some(contrast) = contrast(survey, (i * per_block, j * per_block), per_block) {
            let part = j * PARTS.1 / down * PARTS.0 + i * PARTS.0 / across;
            by_part[part].push((contrast, corner));
        }
    }
    let best = by_part.iter_mut().flat_map(|part| {
        part.sort_by(|a, b| b.0.total_cmp(&a.0));
        part.iter().take(MOST).map(|(_, corner)| *corner)
    });
    best.collect()
}

/// How uneven the light of a block is; `None` where it clips, is dark or even.
fn contrast(survey: &Survey, (x, y): (usize, usize), side: usize) -> Option<f32> {
    let at = |i: usize, j: usize| &survey.blocks[(y + j) * survey.columns + x + i];
    let (mut steps, mut sum) = (0f32, 0f32);
    for (i, j) in (0..side).flat_map(|j| (0..side).map(move |i| (i, j))) {
        let here = at(i, j);
        if here.clipped.contains(&true) {
            return None;
        }
        sum += here.mean[1];
        let mut step = |other: f32| steps += (here.mean[1] - other).abs();
        if i > 0 {
            step(at(i - 1, j).mean[1]);
        }
        if j > 0 {
            step(at(i, j - 1).mean[1]);
        }
    }
    // Steps that count for the noise of photons, which grows as the root of the light.
    let is_uneven = sum > 0.0 && steps > CONTRAST * 2.0 * sum;
    is_uneven.then(|| steps / sum.sqrt()).filter(|contrast| contrast.is_finite())
}
