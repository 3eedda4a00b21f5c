//! A table over a cube of three numbers, read between its nodes.

use rayon::prelude::*;

/// Values at the nodes of a regular grid over 0..=1 in three dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Nodes along each side, at least 2.
    size: usize,
    /// `size`^3 values; the third coordinate varies fastest.
    nodes: Vec<[f64; 3]>,
}

/// Nodes along a side that files may have: programs that read them stop somewhere, and a table of 129 has two
/// million nodes.
pub const SIZES: std::ops::RangeInclusive<usize> = 2..=129;

impl Grid {
    /// The table of a function; `size` is brought into [`SIZES`].
    pub fn sample(size: usize, value: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Self {
        let size = size.clamp(*SIZES.start(), *SIZES.end());
        let place = |i: usize| i as f64 / (size - 1) as f64;
        let at = |i: usize| value([place(i / (size * size)), place(i / size % size), place(i % size)]);
        Self { size, nodes: (0..size * size * size).into_par_iter().map(at).collect() }
    }

    /// A table of these values, the third coordinate varying fastest. `None` when the size is not one of [`SIZES`],
    /// their number does not fit or one is not finite.
    pub fn new(size: usize, nodes: Vec<[f64; 3]>) -> Option<Self> {
        let sound = SIZES.contains(&size)
            && nodes.len() == size * size * size
            && nodes.iter().flatten().all(|v| v.is_finite());
        sound.then_some(Self { size, nodes })
    }

    /// Nodes along each side.
    pub fn size(&self) -> usize {
        self.size
    }

    /// All values, the third coordinate varying fastest.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// The same table with the first coordinate varying fastest.
    pub fn first_fastest(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let n = self.size;
        (0..n * n * n).map(move |i| self.nodes[((i % n) * n + i / n % n) * n + i / (n * n)])
    }

    /// The value between the nodes by tetrahedral interpolation (Kasson, Nin, Plouffe and Hafner, "Performing color
    /// space conversions with three-dimensional linear interpolation", J. Electronic Imaging 4(3), 1995): exact along
    /// the diagonal where greys stand. Coordinates are limited to 0..=1.
    pub fn at(&self, coordinates: [f64; 3]) -> [f64; 3] {
        let last = self.size - 1;
        let steps = [self.size * self.size, self.size, 1];
        let mut place = 0;
        let mut shares = [0.0; 3];
        for (axis, v) in coordinates.into_iter().enumerate() {
            let scaled = v.clamp(0.0, 1.0) * last as f64;
            let first = (scaled as usize).min(last - 1);
            place += first * steps[axis];
            shares[axis] = scaled - first as f64;
        }
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
        // From the near corner to the far one along the axes by falling share.
        let mut value = self.nodes[place];
        for axis in axes {
            let before = self.nodes[place];
            place += steps[axis];
            let after = self.nodes[place];
            for k in 0..3 {
                value[k] += shares[axis] * (after[k] - before[k]);
            }
        }
        value
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // Nodes are exact.
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn linear([r, g, b]: [f64; 3]) -> [f64; 3] {
        [0.2 * r + 0.5 * g, 0.1 - b, r + g + b]
    }

    proptest! {
        #[test]
        fn a_linear_function_is_read_back_exactly(r in 0f64..=1.0, g in 0f64..=1.0, b in 0f64..=1.0) {
            let found = Grid::sample(5, linear).at([r, g, b]);
            for (f, e) in found.into_iter().zip(linear([r, g, b])) {
                prop_assert!((f - e).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn nodes_stand_in_the_sequence_of_the_files() {
        let grid = Grid::sample(3, |c| c);
        assert_eq!(grid.nodes()[1], [0.0, 0.0, 0.5]);
        assert_eq!(grid.first_fastest().nth(1), Some([0.5, 0.0, 0.0]));
        assert_eq!(grid.first_fastest().nth(9), Some([0.0, 0.0, 0.5]));
    }

    #[test]
    fn coordinates_beyond_the_cube_are_those_of_its_face() {
        let grid = Grid::sample(4, linear);
        assert_eq!(grid.at([2.0, 0.5, -3.0]), grid.at([1.0, 0.5, 0.0]));
        assert!(grid.at([f64::NAN, 0.5, 0.5]).iter().all(|v| v.is_nan() || v.is_finite()));
    }

    #[test]
    fn tables_of_a_wrong_size_are_refused() {
        assert_eq!(Grid::new(2, vec![[0.0; 3]; 7]), None);
        assert_eq!(Grid::new(1, vec![[0.0; 3]]), None);
        assert_eq!(Grid::new(2, vec![[f64::INFINITY; 3]; 8]), None);
    }
}
