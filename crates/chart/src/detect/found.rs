//! What a search gives back.

use super::refusal::Refusal;
use crate::geometry::contains;
use crate::layout::Hinge;
use crate::{Homography, Quad};

/// A chart found in a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Name of its layout; of layouts with the same patches the one whose gaps are nearest.
    pub layout: String,
    /// Outer corners of the corner patches: top left, top right, bottom right, bottom left of the chart as printed.
    pub corners: Quad,
    /// 0 to 1: 0 for colours and edges that are only just accepted, 1 for perfect ones.
    pub confidence: f64,
    /// Turn of the chart's top edge on the screen, clockwise, -180 to 180.
    pub rotation_degrees: f64,
    /// Side of a patch: the root of the mean area of the patches.
    pub patch_pixels: f64,
    /// Gaps between columns and rows as found, as shares of a patch's width and height.
    pub gap: [f64; 2],
    /// Patches from left to right.
    pub columns: usize,
    /// Patches from top to bottom.
    pub rows: usize,
    /// The wider gap of a chart that folds.
    pub hinge: Option<Hinge>,
    /// Distance of the edges that were seen from where they should be: root of the median square, in patches.
    pub edge_error: f64,
    /// Share of the patches' edges that were seen in their places.
    pub edges_seen: f64,
    /// Share of the colours' variance that light, camera and shade do not explain: 0 for a perfect chart.
    pub unexplained: f64,
}

impl Found {
    /// The part of patch `i` (row by row from the top left) that is left when `inset` of its side is taken away at each
    /// edge.
    pub fn patch(&self, i: usize, inset: f64) -> Quad {
        let [left, right] = edges(i % self.columns, self.gap[0], self.hinge);
        let [top, bottom] = edges(i / self.columns, self.gap[1], None);
        let (x, y) = (inset * (right - left), inset * (bottom - top));
        let (left, right, top, bottom) = (left + x, right - x, top + y, bottom - y);
        [[left, top], [right, top], [right, bottom], [left, bottom]].map(|p| self.point(p))
    }

    /// The middle of patch `i`.
    pub fn centre(&self, i: usize) -> [f64; 2] {
        let [left, right] = edges(i % self.columns, self.gap[0], self.hinge);
        let [top, bottom] = edges(i / self.columns, self.gap[1], None);
        self.point([(left + right) / 2.0, (top + bottom) / 2.0])
    }

    /// Where a point of the chart lies, in patch widths and heights from its top left corner.
    fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let width = edges(self.columns - 1, self.gap[0], self.hinge)[1];
        let height = edges(self.rows - 1, self.gap[1], None)[1];
        // Corners of a chart that was found are a convex quadrilateral.
        Homography::onto(&self.corners).map_or([f64::NAN; 2], |map| map.apply([x / width, y / height]))
    }
}

/// Both edges of a column or row in patches.
fn edges(i: usize, gap: f64, hinge: Option<Hinge>) -> [f64; 2] {
    let start = i as f64 * (1.0 + gap) + hinge.filter(|h| i >= h.after).map_or(0.0, |h| h.width);
    [start, start + 1.0]
}

/// What came nearest to a chart and was refused.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejected {
    /// Name of the layout it was read as; empty when nothing was in rows and columns.
    pub layout: String,
    /// Where it is, when it is anywhere.
    pub corners: Option<Quad>,
    /// Why it is refused.
    pub reason: Refusal,
    /// How near it came: 1 is enough.
    pub nearness: f64,
}

impl Rejected {
    /// For so many flat regions in rows and columns whose colours are those of no known chart.
    pub(super) fn lattice(patches: usize) -> Self {
        let reason = Refusal::UnknownColours { patches };
        if patches == 0 { Self::nothing() } else { Self { reason, nearness: 0.1, ..Self::nothing() } }
    }

    pub(super) fn nothing() -> Self {
        Self { layout: String::new(), corners: None, reason: Refusal::NoLattice, nearness: 0.0 }
    }
}

/// What a search found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Search {
    /// Charts, the most certain first.
    pub found: Vec<Found>,
    /// What came nearest, when there is no chart.
    pub rejected: Option<Rejected>,
}

impl Search {
    pub(super) fn note(&mut self, rejected: Rejected) {
        if self.rejected.as_ref().is_none_or(|known| known.nearness < rejected.nearness) {
            self.rejected = Some(rejected);
        }
    }
}

/// Whether the middle of one quadrilateral lies in the other.
pub(super) fn overlap(one: &Quad, two: &Quad) -> bool {
    let middle = |q: &Quad| [0, 1].map(|k| q.iter().map(|p| p[k]).sum::<f64>() / 4.0);
    contains(one, middle(two)) || contains(two, middle(one))
}
