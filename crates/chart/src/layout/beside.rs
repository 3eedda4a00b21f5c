//! What a target shows beside its grid of patches: single patches and slanted edges, in millimetres. So a target with a geometry
//! of its own is found by its grid, or placed by hand, and all of it is measured.

use serde::Deserialize;

use super::{LayoutError, PatchPlace};
use crate::slanted_edge::EdgeLine;
use crate::{Homography, Quad};

/// Most patches and edges: a bound for hostile files.
const MOST: usize = 400;
/// Largest target, millimetres.
const LARGEST: f64 = 5000.0;

/// Patches and edges beside a grid. Places are in millimetres from the outer corner of the grid's first patch: x along its first
/// row, y down.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// Width and height of the grid, between the outer edges of its corner patches.
    pub size: [f64; 2],
    /// Patches, each with its left, top, right and bottom.
    pub patches: Vec<(PatchPlace, [f64; 4])>,
    /// Edges that are straight.
    pub edges: Vec<EdgePlace>,
}

/// A straight edge between two even surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgePlace {
    /// One end.
    pub from: [f64; 2],
    /// The other.
    pub to: [f64; 2],
    /// How far both sides are even.
    pub clear: f64,
}

impl Beside {
    /// The part of each patch that is measured, where the grid has these corners; `inset` of a side is left out at each edge.
    /// `None` when the corners are no quadrilateral.
    pub fn windows(&self, corners: &Quad, inset: f64) -> Option<Vec<Quad>> {
        let map = self.map(corners)?;
        let window = |[left, top, right, bottom]: [f64; 4]| {
            let (x, y) = (inset * (right - left), inset * (bottom - top));
            let (left, top, right, bottom) = (left + x, top + y, right - x, bottom - y);
            [[left, top], [right, top], [right, bottom], [left, bottom]].map(&map)
        };
        Some(self.patches.iter().map(|(_, at)| window(*at)).collect())
    }

    /// The edges in pixels, where the grid has these corners. `None` when these are no quadrilateral.
    pub fn edge_lines(&self, corners: &Quad) -> Option<Vec<EdgeLine>> {
        let map = self.map(corners)?;
        let line = |edge: &EdgePlace| {
            let [dx, dy] = [0, 1].map(|k| edge.to[k] - edge.from[k]);
            let length = dx.hypot(dy);
            let middle = [0, 1].map(|k| (edge.from[k] + edge.to[k]) / 2.0);
            let aside = [middle[0] - dy / length * edge.clear, middle[1] + dx / length * edge.clear];
            let (from, to, middle, aside) = (map(edge.from), map(edge.to), map(middle), map(aside));
            EdgeLine { from, to, clear: (aside[0] - middle[0]).hypot(aside[1] - middle[1]) }
        };
        Some(self.edges.iter().map(line).collect())
    }

    /// Millimetres between the middles of two patches of a row, the mean over the grid, which is so many patch widths wide.
    pub fn pitch(&self, columns: usize, patch_widths: f64) -> f64 {
        (self.size[0] - self.size[0] / patch_widths) / (columns.max(2) - 1) as f64
    }

    /// From millimetres to pixels.
    fn map(&self, corners: &Quad) -> Option<impl Fn([f64; 2]) -> [f64; 2] + use<>> {
        let (map, size) = (Homography::onto(corners)?, self.size);
        Some(move |[x, y]: [f64; 2]| map.apply([x / size[0], y / size[1]]))
    }

    /// Whether every number means something, and no patch has the name of another.
    pub(super) fn checked(self, grid: &[PatchPlace]) -> Result<Self, LayoutError> {
        let wrong = |what| Err(LayoutError::Beside(what));
        if self.patches.len() > MOST || self.edges.len() > MOST {
            return wrong("there are more than 400 patches or edges");
        }
        if !self.size.iter().all(|length| (1.0..=LARGEST).contains(length)) {
            return wrong("`size` has 1 to 5000 mm");
        }
        let near = |v: &f64| v.abs() <= LARGEST;
        let is_box = |[left, top, right, bottom]: &[f64; 4]| left < right && top < bottom;
        if !self.patches.iter().all(|(_, at)| at.iter().all(near) && is_box(at)) {
            return wrong("`at` is left, top, right and bottom in mm");
        }
        let is_edge = |edge: &EdgePlace| {
            edge.from.iter().chain(&edge.to).all(near)
                && (0.1..=LARGEST).contains(&edge.clear)
                && (edge.to[0] - edge.from[0]).hypot(edge.to[1] - edge.from[1]) >= 0.1
        };
        if !self.edges.iter().all(is_edge) {
            return wrong("an edge goes `from` one place `to` another and is `clear` by 0.1 mm at least");
        }
        let names = || grid.iter().chain(self.patches.iter().map(|(place, _)| place)).map(|p| &p.name);
        if names().enumerate().any(|(i, name)| names().skip(i + 1).any(|other| other == name)) {
            return wrong("two patches have the same name");
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ChartLayout;

    const TARGET: &str = "name = \"mine\"\ncolumns = 2\nrows = 2\ngap = 0.5\nsize = [25, 50]\n\
        [[patch]]\nname = \"A1\"\nlab = [50, 10, 0]\n[[patch]]\nname = \"B1\"\nlab = [60, 0, 0]\n\
        [[patch]]\nname = \"A2\"\nlab = [20, 10, 0]\n[[patch]]\nname = \"B2\"\nlab = [80, 0, 9]\n\
        [[beside]]\nname = \"K\"\nlab = [20, 0, 0]\nat = [30, 10, 40, 20]\n\
        [[edge]]\nfrom = [-10, 5]\nto = [-10, 15]\nclear = 4\n";
    /// Two pixels a millimetre, turned by a quarter: x goes down, y to the left.
    const TURNED: Quad = [[200.0, 100.0], [200.0, 150.0], [100.0, 150.0], [100.0, 100.0]];

    #[test]
    fn places_in_millimetres_are_found_in_the_picture() {
        let beside = ChartLayout::from_toml(TARGET).unwrap().beside.unwrap();
        let window = beside.windows(&TURNED, 0.2).unwrap()[0];
        for (found, truth) in
            window.iter().zip([[176.0, 164.0], [176.0, 176.0], [164.0, 176.0], [164.0, 164.0]])
        {
            assert!((found[0] - truth[0]).hypot(found[1] - truth[1]) < 1e-6, "{window:?}");
        }
        let EdgeLine { from, to, clear } = beside.edge_lines(&TURNED).unwrap()[0];
        assert!((from[0] - 190.0).hypot(from[1] - 80.0) < 1e-6 && (to[0] - 170.0).hypot(to[1] - 80.0) < 1e-6);
        assert!((clear - 8.0).abs() < 1e-6, "{clear}");
        // Two patches of 10 mm with 5 between them.
        assert!((beside.pitch(2, 2.5) - 15.0).abs() < 1e-9);
    }

    #[test]
    fn what_means_nothing_is_an_error_that_says_what() {
        for (from, to, words) in [
            ("size = [25, 50]", "size = [0, 50]", "`size`"),
            ("size = [25, 50]\n", "", "`size`"),
            ("at = [30, 10, 40, 20]", "at = [30, 10, 30, 20]", "`at`"),
            ("at = [30, 10, 40, 20]", "at = [30, 10, nan, 20]", "`at`"),
            ("to = [-10, 15]", "to = [-10, 5]", "an edge"),
            ("clear = 4", "clear = -1", "an edge"),
            ("name = \"K\"", "name = \"A1\"", "same name"),
        ] {
            let fault = ChartLayout::from_toml(&TARGET.replace(from, to)).unwrap_err();
            assert!(fault.to_string().contains(words), "{from} -> {to}: {fault}");
        }
    }
}
