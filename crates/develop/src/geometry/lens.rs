//! Lens corrections that a DNG carries: where a point of the corrected picture lies in the picture as taken.

use darkroot_photo::correction::{Projection, Warp};
use darkroot_photo::{Capture, Correction, Size};

/// DNG WarpRectilinear and WarpFisheye (DNG 1.7, chapter 7), for a picture of known size.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LensWarp {
    /// Column and row of the optical centre; the middle of the first pixel is (0.5, 0.5).
    centre: [f64; 2],
    /// Distance of the farthest corner from it, pixels.
    reach: f64,
    projection: Projection,
    /// One set of coefficients, or one for each of red, green and blue.
    planes: Vec<[f64; 6]>,
}

impl LensWarp {
    /// The warps of a capture's picture, in the order in which they are to be applied.
    pub(super) fn of(capture: &Capture) -> Vec<Self> {
        let size = capture.active_area.size();
        let warps = capture.picture_corrections.iter().filter_map(|correction| match correction {
            Correction::Warp(warp) => Self::new(warp, size),
            _ => None,
        });
        warps.filter(|warp| !warp.is_nothing()).collect()
    }

    /// `None` where there is nothing that could be a lens's.
    fn new(warp: &Warp, size: Size) -> Option<Self> {
        let last = [size.width, size.height].map(|side| side as f64 - 1.0);
        let centre = [0.5 + warp.centre.0 * last[0], 0.5 + warp.centre.1 * last[1]];
        let farthest = |i: usize| (centre[i] - 0.5).abs().max((last[i] + 0.5 - centre[i]).abs());
        let reach = farthest(0).hypot(farthest(1));
        let planes = match warp.planes.len() {
            0 => return None,
            1 | 2 => warp.planes[..1].to_vec(),
            _ => warp.planes[..3].to_vec(),
        };
        (reach > 0.0).then_some(Self { centre, reach, projection: warp.projection, planes })
    }

    /// Whether red, green and blue come from different places.
    pub(super) fn splits_colours(&self) -> bool {
        self.planes.iter().any(|plane| !alike(plane, &self.planes[0]))
    }

    fn is_nothing(&self) -> bool {
        self.projection == Projection::Rectilinear
            && self.planes.iter().all(|plane| alike(plane, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
    }

    /// Where the colour `channel` of a point comes from.
    pub(super) fn place(&self, channel: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k0, k1, k2, k3, t0, t1] = self.planes[channel.min(self.planes.len() - 1)];
        let (dx, dy) = ((x - self.centre[0]) / self.reach, (y - self.centre[1]) / self.reach);
        let square = dx * dx + dy * dy;
        let factor = match self.projection {
            Projection::Rectilinear => k0 + square * (k1 + square * (k2 + square * k3)),
            Projection::Fisheye => {
                let radius = square.sqrt();
                let angle = radius.atan();
                let bent = angle * angle;
                // The angle over the radius is 1 in the middle.
                let share = if radius > 1e-9 { angle / radius } else { 1.0 };
                share * (k0 + bent * (k1 + bent * (k2 + bent * k3)))
            }
        };
        let (tangential_x, tangential_y) = (
            t0 * 2.0 * dx * dy + t1 * (square + 2.0 * dx * dx),
            t1 * 2.0 * dx * dy + t0 * (square + 2.0 * dy * dy),
        );
        [
            self.centre[0] + self.reach * (factor * dx + tangential_x),
            self.centre[1] + self.reach * (factor * dy + tangential_y),
        ]
    }
}

/// Whether two sets of coefficients move nothing in different ways.
fn alike(one: &[f64; 6], other: &[f64; 6]) -> bool {
    one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9)
}
