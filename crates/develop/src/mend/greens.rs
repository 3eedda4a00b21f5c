//! Whether the two greens of a Bayer array see the same light with different gains.
//!
//! In windows of the picture their ratio is that of the gains, in the median: shading and texture make it larger as often as
//! smaller. Only a difference that is certain and can be seen counts; it is shared by both, so that brightness stays.

use darkroot_photo::Cfa;

use crate::denoise::Measured;

/// Fewest windows that tell something.
const FEWEST: usize = 100;
/// How many standard errors from 1 the ratio must be.
const CERTAIN: f64 = 6.0;
/// Smallest difference that matters, and the largest that is believed.
const VISIBLE: f64 = 0.003;
const LARGEST: f64 = 0.2;

/// Factors for the greens in the first and in the second row of the active area; `None` where they do not differ.
pub(super) fn factors(measured: &Measured, cfa: &Cfa) -> Option<[f32; 2]> {
    // Of the places of a block, row by row.
    let first = usize::from(cfa.at(0, 0).plane() != Some(1));
    let second = 3 - first;
    let mut ratios: Vec<f64> = measured
        .light
        .iter()
        .map(|light| (f64::from(light[first]), f64::from(light[second])))
        .filter(|(a, b)| *a > 0.0 && *b > 0.0 && a + b > f64::from(measured.mean[1]))
        .map(|(a, b)| (a / b).ln())
        .collect();
    if ratios.len() < FEWEST {
        return None;
    }
    let middle = median(&mut ratios);
    let mut deviations: Vec<f64> = ratios.iter().map(|r| (r - middle).abs()).collect();
    // Of a median of normal numbers whose spread is told by that of their middle half.
    let error = 1.25 * 1.483 * median(&mut deviations) / (ratios.len() as f64).sqrt();
    let certain = middle.abs() > CERTAIN * error && (VISIBLE..LARGEST).contains(&middle.abs());
    certain.then(|| [(-middle / 2.0).exp() as f32, (middle / 2.0).exp() as f32])
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
