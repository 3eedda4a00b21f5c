//! Weights that even out how densely colours lie over chromaticity.

use crate::residual::direction;

/// Width of the neighbourhood, in units of the sphere of directions.
const WIDTH: f64 = 0.08;
/// 1 would make the density even, 0 leave it.
const EVENNESS: f64 = 0.75;

/// The weights, each times a power of the density of colours around it; their mean factor over the first `real`
/// colours is 1.
pub(super) fn evened(rgb: &[[f64; 3]], weights: &[f64], real: usize) -> Vec<f64> {
    let directions: Vec<_> = rgb.iter().map(|rgb| direction(*rgb)).collect();
    let count = directions.len() as f64;
    let factor = |x: &colour::Vector3| {
        let near = |z: &colour::Vector3| (-(x - z).norm_squared() / (2.0 * WIDTH * WIDTH)).exp();
        (directions.iter().map(near).sum::<f64>() / count).powf(-EVENNESS)
    };
    let factors: Vec<f64> = directions.iter().map(factor).collect();
    let mean = factors.iter().take(real).sum::<f64>() / real.max(1) as f64;
    factors.iter().zip(weights).map(|(f, w)| f * w / mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rare_colours_weigh_more() {
        let mut rgb = vec![[0.5, 0.5, 0.5]; 20];
        rgb.push([0.9, 0.1, 0.05]);
        let weights = evened(&rgb, &[1.0; 21], 21);
        assert!(weights[20] > 5.0 * weights[0], "{weights:?}");
        assert!((weights.iter().sum::<f64>() / 21.0 - 1.0).abs() < 1e-12);
    }
}
