//! Stacks of blocks of 8 x 8, and their transformation: cosines along rows and columns, Haar's wavelet along the stack.

/// Rows and columns of a block.
pub(super) const SIDE: usize = 8;

/// Blocks that are like each other: row by row, in each row one after the other.
#[derive(Clone)]
pub(super) struct Stack<const N: usize>(pub(super) [[[f32; SIDE]; N]; SIDE]);

/// The cosines, a function after the other: orthonormal.
pub(super) struct Cosines {
    functions: [[f32; SIDE]; SIDE],
    /// The same, a place after the other.
    places: [[f32; SIDE]; SIDE],
}

impl Cosines {
    pub(super) fn new() -> Self {
        let at = |k: usize, i: usize| {
            let phase = std::f64::consts::PI * (2 * i + 1) as f64 * k as f64 / (2 * SIDE) as f64;
            (phase.cos() * if k == 0 { 0.125f64.sqrt() } else { 0.5 }) as f32
        };
        let table = |of: &dyn Fn(usize, usize) -> f32| {
            let row = |k: usize| std::array::from_fn(|i| of(k, i));
            std::array::from_fn(row)
        };
        Self { functions: table(&at), places: table(&|i, k| at(k, i)) }
    }
}

impl<const N: usize> Stack<N> {
    pub(super) const EMPTY: Self = Self([[[0.0; SIDE]; N]; SIDE]);

    /// From blocks to what they are made of.
    #[inline(always)]
    pub(super) fn forth(&mut self, cosines: &Cosines) {
        self.along_rows(&cosines.places);
        self.down(&cosines.functions);
        self.haar();
    }

    /// And back.
    #[inline(always)]
    pub(super) fn back(&mut self, cosines: &Cosines) {
        self.haar_back();
        self.down(&cosines.places);
        self.along_rows(&cosines.functions);
    }

    /// Rows of blocks times a matrix.
    #[inline(always)]
    fn along_rows(&mut self, matrix: &[[f32; SIDE]; SIDE]) {
        for row in self.0.as_flattened_mut() {
            let mut sum = [0f32; SIDE];
            for (v, of) in row.iter().zip(matrix) {
                for (sum, of) in sum.iter_mut().zip(of) {
                    *sum += v * of;
                }
            }
            *row = sum;
        }
    }

    /// A matrix times columns of blocks.
    #[inline(always)]
    fn down(&mut self, matrix: &[[f32; SIDE]; SIDE]) {
        for n in 0..N {
            let rows: [[f32; SIDE]; SIDE] = std::array::from_fn(|r| self.0[r][n]);
            for (out, weights) in self.0.iter_mut().zip(matrix) {
                let mut sum = [0f32; SIDE];
                for (row, weight) in rows.iter().zip(weights) {
                    for (sum, v) in sum.iter_mut().zip(row) {
                        *sum += weight * v;
                    }
                }
                out[n] = sum;
            }
        }
    }

    /// Haar's wavelet along the stack: the mean first, then differences, the coarsest first.
    #[inline(always)]
    fn haar(&mut self) {
        for row in &mut self.0 {
            let mut count = N;
            while count > 1 {
                let half = count / 2;
                let blocks = *row;
                for i in 0..half {
                    for x in 0..SIDE {
                        let (a, b) = (blocks[2 * i][x], blocks[2 * i + 1][x]);
                        row[i][x] = std::f32::consts::FRAC_1_SQRT_2 * (a + b);
                        row[half + i][x] = std::f32::consts::FRAC_1_SQRT_2 * (a - b);
                    }
                }
                count = half;
            }
        }
    }

    #[inline(always)]
    fn haar_back(&mut self) {
        for row in &mut self.0 {
            let mut half = 1;
            while half < N {
                let blocks = *row;
                for i in 0..half {
                    for x in 0..SIDE {
                        let (sum, difference) = (blocks[i][x], blocks[half + i][x]);
                        row[2 * i][x] = std::f32::consts::FRAC_1_SQRT_2 * (sum + difference);
                        row[2 * i + 1][x] = std::f32::consts::FRAC_1_SQRT_2 * (sum - difference);
                    }
                }
                half *= 2;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::denoise::Random;

    #[test]
    fn it_keeps_lengths_is_undone_and_an_even_stack_is_its_first_number() {
        let cosines = Cosines::new();
        let mut random = Random::new(1);
        let mut stack = Stack::<16>::EMPTY;
        stack.0.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|v| *v = random.normal());
        let power =
            |stack: &Stack<16>| stack.0.as_flattened().as_flattened().iter().map(|v| v * v).sum::<f32>();
        let before = stack.clone();
        stack.forth(&cosines);
        assert!((power(&stack) / power(&before) - 1.0).abs() < 1e-5);
        stack.back(&cosines);
        let pairs = stack.0.as_flattened().as_flattened().iter().zip(before.0.as_flattened().as_flattened());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-5));
        let mut even = Stack::<16>([[[1.0; SIDE]; 16]; SIDE]);
        even.forth(&cosines);
        assert!((even.0[0][0][0] - 32.0).abs() < 1e-4 && (power(&even) - 1024.0).abs() < 1e-2);
    }
}
