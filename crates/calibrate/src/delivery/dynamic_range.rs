//! Dynamic range of a delivery: from the light that saturates the picture down to that which has a signal as large as its noise
//! (ISO 15739:2013, 6.4: incremental gain, signal-to-noise ratio 1).
//!
//! No chart of paper is as dark as that, so it is an estimate: the noise of the greys, divided by the gain of the tone response
//! there, is noise of the light; its variance is fitted as a + b L + c L^2 (reading, photons, unevenness of pixels and patches;
//! Janesick, "Photon Transfer", 2007) and followed into the dark.

use darkroot_colour::{Matrix3, Vector3};

use super::Grey;

/// L\* between greys that count as different.
const SAME: f64 = 1.0;
/// Fewest different greys: one more than what is fitted.
const FEWEST: usize = 5;
/// Standard deviations that a grey must keep from black and white for its noise to be whole.
const CLEAR: f64 = 2.0;

/// How far a picture reaches from its white into the dark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DynamicRange {
    /// Stops from saturation to where signal and noise are equal, by the noise model.
    pub stops: f64,
    /// The same with the noise of reading larger by its standard error: what can be relied on. The chart may be too light to say
    /// more.
    pub least: f64,
    /// Stops from saturation to the darkest grey whose signal is above its noise: what the chart itself shows.
    pub shown: f64,
}

/// Greys of one lightness.
#[derive(Debug, Clone, Copy)]
struct Level {
    /// Luminance by the reference.
    light: f64,
    /// Luminance in the picture.
    found: f64,
    /// Variance of that.
    variance: f64,
    /// Pixels that it was measured by.
    pixels: f64,
}

/// The dynamic range that greys, from light to dark, tell; `None` where they are too few, clipped or without noise.
pub(super) fn dynamic_range(greys: &[Grey]) -> Option<DynamicRange> {
    let levels = levels(greys);
    let lightest = levels.first()?;
    if levels.len() < FEWEST {
        return None;
    }
    let response = response(&levels)?;
    let slope = |level: &Level| response[1] + 2.0 * response[2] * level.light.ln();
    let saturation = (lightest.light.ln() - lightest.found.ln() / slope(lightest)).exp();
    // Noise as light, relative to nothing.
    let noise: Vec<[f64; 2]> = levels
        .iter()
        .map(|level| [level.light, level.variance * (level.light / (level.found * slope(level))).powi(2)])
        .collect();
    if noise.iter().any(|[_, variance]| variance.is_nan() || *variance <= 0.0) {
        return None;
    }
    let model = model(&noise)?;
    let pixels = levels.iter().map(|level| level.pixels).sum::<f64>() / levels.len() as f64;
    let stops = |reading: f64| {
        let darkest = equal_to_noise(Vector3::new(reading, model[1], model[2]))?;
        Some((saturation / darkest).log2()).filter(|stops| stops.is_finite())
    };
    let dark = noise.iter().rev().find(|[light, variance]| light * light > *variance)?;
    let worse = model[0] + reading_error(&noise, model, pixels)?;
    Some(DynamicRange { stops: stops(model[0])?, least: stops(worse)?, shown: (saturation / dark[0]).log2() })
}

fn levels(greys: &[Grey]) -> Vec<Level> {
    let mut grouped: Vec<Vec<&Grey>> = Vec::new();
    for grey in greys {
        match grouped.last_mut() {
            Some(group) if (group[0].truth.l - grey.truth.l).abs() < SAME => group.push(grey),
            _ => grouped.push(vec![grey]),
        }
    }
    let level = |group: Vec<&Grey>| {
        let mean = |of: fn(&Grey) -> f64| group.iter().map(|g| of(g)).sum::<f64>() / group.len() as f64;
        Level {
            light: mean(|grey| grey.truth.xyz(darkroot_colour::white::D50).y),
            found: mean(|grey| grey.found.xyz(darkroot_colour::white::D50).y),
            variance: mean(|grey| grey.noise.luminance.powi(2)),
            pixels: mean(|grey| grey.noise.pixels as f64) * group.len() as f64,
        }
    };
    let is_whole = |level: &Level| {
        let reach = CLEAR * level.variance.sqrt();
        level.light > 0.0 && level.found - reach > 0.0 && level.found + reach < 1.0
    };
    grouped.into_iter().map(level).filter(is_whole).collect()
}

/// The tone response: ln(found) as a parabola over ln(light), by least squares.
fn response(levels: &[Level]) -> Option<Vector3> {
    let rows = levels.iter().map(|level| {
        let x = level.light.ln();
        (Vector3::new(1.0, x, x * x), level.found.ln())
    });
    least_squares(rows)
}

/// a, b and c of the variance, none of them negative, with the least squares of relative errors.
fn model(noise: &[[f64; 2]]) -> Option<Vector3> {
    let fit = |used: usize| {
        // Terms that are left out get a column of their own kind, which makes them 0.
        let has = |k: usize| used & (1 << k) != 0;
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for row in noise.iter().map(relative) {
            let row = Vector3::from([0, 1, 2].map(|k| if has(k) { row[k] } else { 0.0 }));
            normal += row * row.transpose();
            right += row;
        }
        (0..3).filter(|k| !has(*k)).for_each(|k| normal[(k, k)] = 1.0);
        let found = solved(normal, right)?;
        found.iter().all(|v| *v >= 0.0).then(|| (error(noise, found), found))
    };
    let best = (1..8).filter_map(fit).min_by(|one, other| one.0.total_cmp(&other.0))?;
    Some(best.1)
}

/// 1, L and L^2 over the variance: what a, b and c add to 1.
fn relative([light, variance]: &[f64; 2]) -> Vector3 {
    Vector3::new(1.0, *light, light * light) / *variance
}

/// Sum of squared relative errors.
fn error(noise: &[[f64; 2]], model: Vector3) -> f64 {
    noise.iter().map(|point| (relative(point).dot(&model) - 1.0).powi(2)).sum()
}

/// Standard error of a, where b and c are free: by what is left of the fit, and not less than variances of so many pixels have.
fn reading_error(noise: &[[f64; 2]], model: Vector3, pixels: f64) -> Option<f64> {
    let normal: Matrix3 = noise.iter().map(relative).map(|row| row * row.transpose()).sum();
    let left = error(noise, model) / (noise.len() as f64 - 3.0);
    let spread = scaled_inverse(normal)?[(0, 0)];
    Some((left.max(2.0 / pixels.max(1.0)) * spread).sqrt()).filter(|error| error.is_finite())
}

/// The light L with L^2 = a + b L + c L^2.
fn equal_to_noise(model: Vector3) -> Option<f64> {
    let (a, b, rest) = (model[0], model[1], 1.0 - model[2]);
    let light = (b + (b * b + 4.0 * a * rest).sqrt()) / (2.0 * rest);
    (rest > 0.0 && light > 0.0 && light.is_finite()).then_some(light)
}

fn least_squares(rows: impl Iterator<Item = (Vector3, f64)>) -> Option<Vector3> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (row, value) in rows {
        normal += row * row.transpose();
        right += row * value;
    }
    solved(normal, right)
}

fn solved(normal: Matrix3, right: Vector3) -> Option<Vector3> {
    Some(scaled_inverse(normal)? * right).filter(|found| found.iter().all(|v| v.is_finite()))
}

/// The inverse of a symmetric matrix whose rows differ in size by many powers of ten.
fn scaled_inverse(matrix: Matrix3) -> Option<Matrix3> {
    let scale = Matrix3::from_diagonal(&Vector3::from([0, 1, 2].map(|k| 1.0 / matrix[(k, k)].sqrt())));
    let inverse = (scale * matrix * scale).try_inverse()?;
    Some(scale * inverse * scale).filter(|m| m.iter().all(|v| v.is_finite()))
}

#[cfg(test)]
mod tests;
