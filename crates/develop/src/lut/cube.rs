//! A table over three channels and a range of each.

use darkroot_profile::export::grid::{Grid, SIZES};

/// Nodes over a range of each channel, between which [`Grid`] interpolates in tetrahedra.
#[derive(Debug, Clone, PartialEq)]
pub struct Cube {
    least: [f32; 3],
    most: [f32; 3],
    nodes: Grid,
}

impl Cube {
    /// Nodes along each side that a table may have.
    pub const SIZES: std::ops::RangeInclusive<usize> = SIZES;

    /// `size`^3 nodes over `least..=most` of each channel, red changing slowest; `None` where their number, the range or a
    /// value is none.
    pub fn new(size: usize, [least, most]: [[f32; 3]; 2], nodes: Vec<[f32; 3]>) -> Option<Self> {
        let rises = (0..3).all(|c| least[c] < most[c] && (most[c] - least[c]).is_finite());
        let nodes = Grid::new(size, nodes.into_iter().map(|node| node.map(f64::from)).collect())?;
        rises.then_some(Self { least, most, nodes })
    }

    /// What stands for a colour; beyond the range, what stands at its end.
    #[inline]
    pub fn at(&self, v: [f32; 3]) -> [f32; 3] {
        // What is no number counts as the least.
        let place = |c: usize| ((v[c] - self.least[c]) / (self.most[c] - self.least[c])).max(0.0);
        self.nodes.at([0, 1, 2].map(|c| f64::from(place(c)))).map(|v| v as f32)
    }
}
