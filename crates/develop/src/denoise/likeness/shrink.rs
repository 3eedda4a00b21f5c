//! What is noise in a stack: small numbers, and those that the first estimate does not have.

use super::groups::Clean;
use super::transform::Stack;

/// The first step: numbers that noise alone could be are cut off.
pub(super) struct Cut;
/// The second one: numbers are weighed by the power that the first estimate has there.
pub(super) struct Weigh;

impl Cut {
    /// Blocks of a stack.
    pub(super) const GROUP: usize = 16;
}

impl Weigh {
    pub(super) const GROUP: usize = 16;
}

/// Standard deviations of noise up to which numbers are cut off.
const FAR: f32 = 2.7;

impl<const N: usize> Clean<N> for Cut {
    const GUIDED: bool = false;

    #[inline(always)]
    fn clean(stack: &mut Stack<N>, _: &Stack<N>, strength: f32) -> f32 {
        let mean = stack.0[0][0][0];
        let limit = FAR * strength;
        let mut kept = [0f32; 8];
        for block in stack.0.as_flattened_mut() {
            for (v, kept) in block.iter_mut().zip(&mut kept) {
                let large = v.abs() >= limit;
                *v = if large { *v } else { 0.0 };
                *kept += if large { 1.0 } else { 0.0 };
            }
        }
        // The mean always stays.
        let of_mean = if mean.abs() >= limit { 0.0 } else { 1.0 };
        stack.0[0][0][0] = mean;
        (kept.iter().sum::<f32>() + of_mean) / (64 * N) as f32
    }
}

impl<const N: usize> Clean<N> for Weigh {
    const GUIDED: bool = true;

    #[inline(always)]
    fn clean(stack: &mut Stack<N>, guide: &Stack<N>, strength: f32) -> f32 {
        let mean = stack.0[0][0][0];
        let noise = (strength * strength).max(1e-6);
        let mut left = [0f32; 8];
        for (block, guide) in stack.0.as_flattened_mut().iter_mut().zip(guide.0.as_flattened()) {
            for ((v, guide), left) in block.iter_mut().zip(guide).zip(&mut left) {
                let power = guide * guide;
                let weight = power / (power + noise);
                *v *= weight;
                *left += weight * weight;
            }
        }
        stack.0[0][0][0] = mean;
        (left.iter().sum::<f32>() + 1.0) / (64 * N) as f32
    }
}
