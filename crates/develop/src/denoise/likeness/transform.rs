//! Stacks of blocks of 8 x 8, and their transformation: Haar's wavelet along the stack, cosines along columns and rows.

/// Rows and columns of a block.
pub(super) const SIDE: usize = 8;

/// Row by row.
pub(super) type Block = [[f32; SIDE]; SIDE];

/// Blocks that are like each other; their number is a power of 2.
#[derive(Clone)]
pub(super) struct Stack<const N: usize>(pub(super) [Block; N]);

impl<const N: usize> Stack<N> {
    pub(super) const EMPTY: Self = Self([[[0.0; SIDE]; SIDE]; N]);

    /// Haar's wavelet along the stack: the first block becomes the mean, the others differences.
    #[inline(always)]
    pub(super) fn haar(&mut self) {
        let mut apart = 1;
        while apart < N {
            self.turn(apart);
            apart *= 2;
        }
    }

    /// And back.
    #[inline(always)]
    pub(super) fn haar_back(&mut self) {
        let mut apart = N / 2;
        while apart > 0 {
            self.turn(apart);
            apart /= 2;
        }
    }

    /// Sums and differences of blocks so far apart.
    #[inline(always)]
    fn turn(&mut self, apart: usize) {
        for pair in self.0.chunks_exact_mut(2 * apart) {
            let (one, other) = pair.split_at_mut(apart);
            let (one, other) = (one[0].as_flattened_mut(), other[0].as_flattened_mut());
            for (a, b) in one.iter_mut().zip(other) {
                let (sum, difference) = (*a + *b, *a - *b);
                *a = std::f32::consts::FRAC_1_SQRT_2 * sum;
                *b = std::f32::consts::FRAC_1_SQRT_2 * difference;
            }
        }
    }
}

const HALF: usize = SIDE / 2;

/// The cosines, orthonormal.
pub(super) struct Cosines {
    /// A function after the other, and a place after the other.
    functions: Block,
    places: Block,
    /// Of the even and of the odd functions, their first halves.
    even: [[f32; HALF]; HALF],
    odd: [[f32; HALF]; HALF],
}

impl Cosines {
    pub(super) fn new() -> Self {
        let at = |k: usize, i: usize| {
            let phase = std::f64::consts::PI * (2 * i + 1) as f64 * k as f64 / (2 * SIDE) as f64;
            (phase.cos() * if k == 0 { 0.125f64.sqrt() } else { 0.5 }) as f32
        };
        let all = |of: &dyn Fn(usize, usize) -> f32| {
            [0, 1, 2, 3, 4, 5, 6, 7].map(|k| [0, 1, 2, 3, 4, 5, 6, 7].map(|i| of(k, i)))
        };
        let half = |first: usize| [0, 1, 2, 3].map(|k| [0, 1, 2, 3].map(|i| at(2 * k + first, i)));
        Self { functions: all(&at), places: all(&|i, k| at(k, i)), even: half(0), odd: half(1) }
    }

    /// From a block to how much of each cosine it has.
    #[inline(always)]
    pub(super) fn forth(&self, block: &mut Block) {
        // Even functions see the sum of places that lie opposite, odd ones the difference.
        let rows = *block;
        let (mut sums, mut differences) = ([[0f32; SIDE]; HALF], [[0f32; SIDE]; HALF]);
        for i in 0..HALF {
            for x in 0..SIDE {
                sums[i][x] = rows[i][x] + rows[SIDE - 1 - i][x];
                differences[i][x] = rows[i][x] - rows[SIDE - 1 - i][x];
            }
        }
        for k in 0..HALF {
            block[2 * k] = combined(&sums, &self.even[k]);
            block[2 * k + 1] = combined(&differences, &self.odd[k]);
        }
        along_rows(block, &self.places);
    }

    /// And back.
    #[inline(always)]
    pub(super) fn back(&self, block: &mut Block) {
        along_rows(block, &self.functions);
        let even = [0, 1, 2, 3].map(|k| block[2 * k]);
        let odd = [0, 1, 2, 3].map(|k| block[2 * k + 1]);
        for i in 0..HALF {
            let sum = combined(&even, &self.even.map(|function| function[i]));
            let difference = combined(&odd, &self.odd.map(|function| function[i]));
            for x in 0..SIDE {
                block[i][x] = sum[x] + difference[x];
                block[SIDE - 1 - i][x] = sum[x] - difference[x];
            }
        }
    }
}

/// The sum of rows, each so many times.
#[inline(always)]
fn combined(rows: &[[f32; SIDE]; HALF], weights: &[f32; HALF]) -> [f32; SIDE] {
    let mut sum = [0f32; SIDE];
    for x in 0..SIDE {
        sum[x] = rows[0][x] * weights[0]
            + rows[1][x] * weights[1]
            + (rows[2][x] * weights[2] + rows[3][x] * weights[3]);
    }
    sum
}

/// Rows times a matrix.
#[inline(always)]
fn along_rows(block: &mut Block, matrix: &Block) {
    for row in block {
        let mut sum = [0f32; SIDE];
        for (v, of) in row.iter().zip(matrix) {
            for x in 0..SIDE {
                sum[x] += v * of[x];
            }
        }
        *row = sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::denoise::Random;

    fn transformed(stack: &mut Stack<16>) {
        stack.haar();
        stack.0.iter_mut().for_each(|block| Cosines::new().forth(block));
    }

    #[test]
    fn it_keeps_lengths_is_undone_and_an_even_stack_is_its_first_number() {
        let mut random = Random::new(1);
        let mut stack = Stack::<16>::EMPTY;
        stack.0.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|v| *v = random.normal());
        let all = |stack: &Stack<16>| stack.0.as_flattened().as_flattened().to_vec();
        let power = |stack: &Stack<16>| all(stack).iter().map(|v| v * v).sum::<f32>();
        let before = stack.clone();
        transformed(&mut stack);
        assert!((power(&stack) / power(&before) - 1.0).abs() < 1e-5);
        stack.0.iter_mut().for_each(|block| Cosines::new().back(block));
        stack.haar_back();
        assert!(all(&stack).iter().zip(all(&before)).all(|(a, b)| (a - b).abs() < 1e-5));
        let mut even = Stack::<16>([[[1.0; SIDE]; SIDE]; 16]);
        transformed(&mut even);
        assert!((even.0[0][0][0] - 32.0).abs() < 1e-4 && (power(&even) - 1024.0).abs() < 1e-2);
    }
}
