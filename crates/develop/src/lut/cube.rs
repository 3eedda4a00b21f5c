//! A table over three channels, between whose nodes colours are interpolated in tetrahedra.
//!
//! The cube of eight nodes around a colour is cut into six tetrahedra along its grey diagonal, and the four nodes of the one
//! that holds the colour are weighted (Sakamoto and Itooka, US patent 4,275,413, 1981, expired). Unlike eight weights it keeps
//! greys clean.

/// Nodes over a range of each channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Cube {
    size: usize,
    least: [f32; 3],
    /// Steps between nodes for each unit of a channel.
    scale: [f32; 3],
    /// Red changes slowest.
    nodes: Vec<[f32; 3]>,
}

impl Cube {
    /// Nodes along each side that a table may have.
    pub const SIZES: std::ops::RangeInclusive<usize> = 2..=129;

    /// `size`^3 nodes over `least..=most` of each channel, red changing slowest; `None` where their number, the range or a
    /// value is none.
    pub fn new(size: usize, [least, most]: [[f32; 3]; 2], nodes: Vec<[f32; 3]>) -> Option<Self> {
        let fits = Self::SIZES.contains(&size) && nodes.len() == size.pow(3);
        let finite = nodes.iter().flatten().all(|v| v.is_finite());
        let rises = (0..3).all(|c| least[c] < most[c] && (most[c] - least[c]).is_finite());
        let scale = [0, 1, 2].map(|c| (size - 1) as f32 / (most[c] - least[c]));
        (fits && finite && rises).then_some(Self { size, least, scale, nodes })
    }

    /// What stands for a colour; beyond the range, what stands at its end.
    #[inline]
    pub fn at(&self, v: [f32; 3]) -> [f32; 3] {
        let last = self.size - 1;
        let (mut first, mut part) = ([0usize; 3], [0f32; 3]);
        for c in 0..3 {
            let place = (v[c] - self.least[c]) * self.scale[c];
            let place = if place > 0.0 { place.min(last as f32) } else { 0.0 };
            first[c] = (place as usize).min(last - 1);
            part[c] = place - first[c] as f32;
        }
        let steps = [self.size * self.size, self.size, 1];
        let base = first[0] * steps[0] + first[1] * steps[1] + first[2];
        // From the near corner to the far one along the axes, the longest part first.
        let mut order = [0, 1, 2];
        if part[order[0]] < part[order[1]] {
            order.swap(0, 1);
        }
        if part[order[1]] < part[order[2]] {
            order.swap(1, 2);
        }
        if part[order[0]] < part[order[1]] {
            order.swap(0, 1);
        }
        let [a, b, c] = order;
        let corners =
            [base, base + steps[a], base + steps[a] + steps[b], base + steps[a] + steps[b] + steps[c]];
        let weights = [1.0 - part[a], part[a] - part[b], part[b] - part[c], part[c]];
        let mut out = [0.0; 3];
        for (corner, weight) in corners.into_iter().zip(weights) {
            let node = self.nodes[corner];
            for c in 0..3 {
                out[c] += weight * node[c];
            }
        }
        out
    }
}
