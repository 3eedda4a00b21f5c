//! The residual over planes: its function of chromaticity baked to a table.

use super::{Out, PlanePart};
use crate::Residual;

/// Steps of the table along each side. Between its points it is linear; with the kernel's width of 0.2 the error
/// is below 1e-5 of the largest weight.
const STEPS: usize = 256;

/// XYZ for colours with the channel mean 1, by the shares of red and blue in the sum of the channels' square roots.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ResidualPlanes {
    /// Row by row, blue's share down, red's share to the right.
    table: Vec<[f32; 3]>,
}

impl ResidualPlanes {
    pub(super) fn new(part: &Residual) -> Self {
        let share = |i: usize| i as f64 / STEPS as f64;
        let at = |i: usize| {
            let (red, blue) = (share(i % (STEPS + 1)), share(i / (STEPS + 1)));
            // Shares of red and blue that sum to more than 1 belong to no colour: green's would be negative. The
            // function goes on there smoothly, so interpolation at the border is right.
            let roots = darkroot_colour::Vector3::new(red, 1.0 - red - blue, blue);
            let xyz = part.at(&roots.normalize());
            [xyz.x as f32, xyz.y as f32, xyz.z as f32]
        };
        Self { table: (0..(STEPS + 1) * (STEPS + 1)).map(at).collect() }
    }
}

impl PlanePart for ResidualPlanes {
    #[inline(always)]
    fn add(&self, [r, g, b]: [&[f32]; 3], out: &mut Out) {
        let [x, y, z] = out;
        let pixels = r.iter().zip(g).zip(b).zip(x.iter_mut().zip(y).zip(z));
        for (((&r, &g), &b), ((x, y), z)) in pixels {
            let mean = (r + g + b) / 3.0;
            let roots = [r, g, b].map(|v| v.max(0.0).sqrt());
            let sum = roots[0] + roots[1] + roots[2];
            let share = |root: f32| if sum > 0.0 { root / sum } else { 1.0 / 3.0 };
            let (red, blue) = (share(roots[0]) * STEPS as f32, share(roots[2]) * STEPS as f32);
            let column = (red as usize).min(STEPS - 1);
            let row = (blue as usize).min(STEPS - 1);
            let (right, down) = (red - column as f32, blue - row as f32);
            let first = row * (STEPS + 1) + column;
            let corner = |i: usize| &self.table[first + i];
            let (a, b, c, d) = (corner(0), corner(1), corner(STEPS + 1), corner(STEPS + 2));
            let at = |k: usize| {
                let above = a[k] + right * (b[k] - a[k]);
                let below = c[k] + right * (d[k] - c[k]);
                (above + down * (below - above)) * mean
            };
            *x += at(0);
            *y += at(1);
            *z += at(2);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::residual::direction;

    #[test]
    fn the_table_has_the_directions_of_its_colours() {
        // A colour whose roots have the shares 0.5, 0.3, 0.2.
        let rgb = [0.25, 0.09, 0.04];
        let roots = darkroot_colour::Vector3::new(0.5, 0.3, 0.2);
        assert!((direction(rgb) - roots.normalize()).norm() < 1e-12);
    }
}
