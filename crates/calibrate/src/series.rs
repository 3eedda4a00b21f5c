//! Several shots under one light: how far they agree, and one measurement of them all.
//!
//! Shots at several exposures are a bracket and tell whether the sensor is linear; shots at one exposure are averaged and
//! tell whether anything moved.

use darkroot_colour::statistics::median;

use crate::gates::Departure;
use crate::{CrossValidation, MeasuredPatch};

/// Shots nearer than this in light, in stops, are shots at one exposure.
const ONE_EXPOSURE: f64 = 0.2;

/// One shot of a series.
#[derive(Debug, Clone, Copy)]
pub struct Member<'a> {
    /// Its patches.
    pub patches: &'a [MeasuredPatch],
    /// The same, corrected without the help of some.
    pub cross_validation: &'a [CrossValidation],
}

/// Two shots of one exposure, by their place in the series, if there are any.
pub fn same_exposure(shots: &[Member<'_>]) -> Option<(usize, usize)> {
    let first = shots.first()?;
    let light: Vec<f64> = shots.iter().map(|s| stops(first, s)).collect();
    let mut pairs = (0..shots.len()).flat_map(|i| (i + 1..shots.len()).map(move |j| (i, j)));
    pairs.find(|(i, j)| (light[*i] - light[*j]).abs() <= ONE_EXPOSURE)
}

/// How far the shots at other exposures than the first depart from it, and how far those at the same do: the place of the
/// worst shot and its departure. `None` where there is no such shot.
pub fn departures(shots: &[Member<'_>]) -> [Option<(usize, f64)>; 2] {
    let Some(first) = shots.first() else { return [None, None] };
    let worst = |differs: bool| {
        let compared = shots.iter().enumerate().skip(1);
        compared
            .filter(|(_, s)| (stops(first, s).abs() > ONE_EXPOSURE) == differs)
            .map(|(i, s)| (i, departure(first.patches, s.patches)))
            .max_by(|(_, a), (_, b)| a.total_cmp(b))
    };
    [worst(true), worst(false)]
}

impl Departure {
    /// Of a shot with a name.
    pub fn of(worst: &str, relative: f64) -> Self {
        Self { relative, worst: worst.to_owned() }
    }
}

fn stops(first: &Member<'_>, other: &Member<'_>) -> f64 {
    ratio(first.patches, other.patches).log2()
}

/// Shots under one light as one: each scaled to the exposure of the first, patches that are clipped in a shot taken
/// from the others.
pub fn combined(shots: &[&[MeasuredPatch]]) -> Vec<MeasuredPatch> {
    let Some((first, others)) = shots.split_first() else { return Vec::new() };
    if others.is_empty() {
        return first.to_vec();
    }
    let scales: Vec<f64> = shots.iter().map(|s| ratio(first, s)).collect();
    let one = |i: usize| {
        let usable: Vec<(&MeasuredPatch, f64)> = shots
            .iter()
            .zip(&scales)
            .map(|(s, k)| (&s[i], *k))
            .filter(|(p, _)| p.excluded.is_none())
            .collect();
        let mut patch = first[i].clone();
        let Some(((best, _), count)) = usable.first().zip(Some(usable.len() as f64)) else { return patch };
        patch.excluded = None;
        patch.clipped = best.clipped;
        patch.rgb = [0, 1, 2].map(|c| usable.iter().map(|(p, k)| p.rgb[c] * k).sum::<f64>() / count);
        patch.uncertainty = [0, 1, 2]
            .map(|c| usable.iter().map(|(p, k)| (p.uncertainty[c] * k).powi(2)).sum::<f64>().sqrt() / count);
        patch
    };
    (0..first.len()).map(one).collect()
}

/// The same for what each shot is without the help of some patches. A shot that was not corrected is the same in every
/// round.
pub fn combined_cross_validation(shots: &[Member<'_>]) -> Vec<CrossValidation> {
    let corrected = shots.iter().max_by_key(|s| s.cross_validation.len());
    let rounds = corrected.map_or(&[][..], |s| s.cross_validation);
    let round = |(k, round): (usize, &CrossValidation)| {
        let corrected: Vec<Vec<MeasuredPatch>> = shots
            .iter()
            .map(|shot| {
                let mut patches = shot.patches.to_vec();
                let rgb = shot.cross_validation.get(k).into_iter().flat_map(|round| &round.rgb);
                for (patch, rgb) in patches.iter_mut().zip(rgb) {
                    patch.rgb = *rgb;
                }
                patches
            })
            .collect();
        let all: Vec<&[MeasuredPatch]> = corrected.iter().map(Vec::as_slice).collect();
        let rgb = combined(&all).iter().map(|p| p.rgb).collect();
        CrossValidation { left_out: round.left_out.clone(), rgb }
    };
    rounds.iter().enumerate().map(round).collect()
}

/// Light of one set of patches over that of another: the median over patches that both have.
fn ratio(one: &[MeasuredPatch], other: &[MeasuredPatch]) -> f64 {
    let usable = |p: &MeasuredPatch| p.excluded.is_none();
    let mut ratios: Vec<f64> = one
        .iter()
        .zip(other)
        .filter(|(a, b)| usable(a) && usable(b) && b.rgb[1] > 0.0)
        .map(|(a, b)| a.rgb[1] / b.rgb[1])
        .collect();
    median(&mut ratios).unwrap_or(1.0)
}

/// How far two sets of patches are from being the same scaled: the largest relative departure of a channel of a patch
/// from the channel's median ratio, less three standard errors of its noise.
fn departure(one: &[MeasuredPatch], other: &[MeasuredPatch]) -> f64 {
    let pairs: Vec<(&MeasuredPatch, &MeasuredPatch)> =
        one.iter().zip(other).filter(|(a, b)| a.excluded.is_none() && b.excluded.is_none()).collect();
    let of_channel = |c: usize| {
        let ratio = |(a, b): &(&MeasuredPatch, &MeasuredPatch)| a.rgb[c] / b.rgb[c];
        let mut ratios: Vec<f64> = pairs.iter().map(ratio).collect();
        let Some(scale) = median(&mut ratios) else { return 0.0 };
        let beyond = |pair: &(&MeasuredPatch, &MeasuredPatch)| {
            let (a, b) = pair;
            let noise = (a.uncertainty[c] / a.rgb[c]).hypot(b.uncertainty[c] / b.rgb[c]);
            (ratio(pair) / scale - 1.0).abs() - 3.0 * noise
        };
        pairs.iter().map(beyond).fold(0.0, f64::max)
    };
    (0..3).map(of_channel).fold(0.0, f64::max)
}
