//! What is noise in a stack: small numbers, and those that the first estimate does not have.

use super::groups::TakeNoise;
use super::transform::{Block, Cosines, SIDE, Stack};

/// The first step: numbers that noise alone could be are cut off.
pub(super) struct Cut;
/// The second one: numbers are weighed by the power that the first estimate has there.
pub(super) struct Weigh;

impl Cut {
    /// Blocks of a stack.
    pub(super) const GROUP: usize = 8;
}

impl Weigh {
    pub(super) const GROUP: usize = 8;
}

/// Standard deviations of noise up to which numbers are cut off.
pub(super) const FAR: f32 = 3.0;
/// How much above its variance noise is taken for noise in the second one.
pub(super) const MARGIN: f32 = 1.1;
/// The least variance that divides.
const TINY: f32 = 1e-6;
/// Power of a block of the first estimate, against the variance of noise, below which there is nothing in it.
pub(super) const NOTHING: f32 = 2.0;

impl<const N: usize> TakeNoise<N> for Cut {
    const GUIDED: bool = false;

    #[inline(always)]
    fn take(stack: &mut Stack<N>, _: &mut Stack<N>, strength: f32, cosines: &Cosines) -> f32 {
        stack.haar();
        let limit = FAR * strength;
        let mut kept = 0;
        for (n, block) in stack.0.iter_mut().enumerate() {
            cosines.forth(block);
            let mean = block[0][0];
            let of_block = cut(block, limit);
            // The mean always stays.
            let stays = u32::from(n == 0 && mean.abs() < limit);
            if n == 0 {
                block[0][0] = mean;
            }
            if of_block + stays > 0 {
                cosines.back(block);
            }
            kept += of_block + stays;
        }
        stack.haar_back();
        kept as f32 / (SIDE * SIDE * N) as f32
    }
}

/// Cuts numbers off below a limit, and counts the others.
#[inline(always)]
fn cut(block: &mut Block, limit: f32) -> u32 {
    let numbers = block.as_flattened_mut();
    let kept = numbers.iter().map(|v| u32::from(v.abs() >= limit)).sum();
    for v in numbers {
        *v = if v.abs() >= limit { *v } else { 0.0 };
    }
    kept
}

impl<const N: usize> TakeNoise<N> for Weigh {
    const GUIDED: bool = true;

    #[inline(always)]
    fn take(stack: &mut Stack<N>, guide: &mut Stack<N>, strength: f32, cosines: &Cosines) -> f32 {
        stack.haar();
        guide.haar();
        let noise = (MARGIN * strength * strength).max(TINY);
        let mut left = 0.0;
        for (n, (block, guide)) in stack.0.iter_mut().zip(&mut guide.0).enumerate() {
            if n > 0 && power(guide) < NOTHING * noise {
                *block = [[0.0; SIDE]; SIDE];
                continue;
            }
            cosines.forth(block);
            cosines.forth(guide);
            let mean = block[0][0];
            weigh(block, guide, noise);
            left += power(guide);
            if n == 0 {
                // The mean always stays.
                left += 1.0 - guide[0][0] * guide[0][0];
                block[0][0] = mean;
            }
            cosines.back(block);
        }
        stack.haar_back();
        left / (SIDE * SIDE * N) as f32
    }
}

/// Weighs numbers, and puts the weights in the guide's place.
#[inline(always)]
fn weigh(block: &mut Block, guide: &mut Block, noise: f32) {
    for (v, guide) in block.as_flattened_mut().iter_mut().zip(guide.as_flattened_mut()) {
        let power = *guide * *guide;
        *guide = power / (power + noise);
        *v *= *guide;
    }
}

/// The sum of squares.
#[inline(always)]
fn power(block: &Block) -> f32 {
    let mut sums = [0f32; SIDE];
    for row in block {
        for x in 0..SIDE {
            sums[x] += row[x] * row[x];
        }
    }
    sums.iter().sum()
}
