//! Where the patches of a chart lie in a picture once its corners are known.

use crate::{ChartLayout, Homography, Quad};

/// The part of every patch that is measured: `inset` of a patch's side is left out at each edge (0.2 leaves the middle
/// 60 %). `corners` are the outer corners of the corner patches. `None` when they are no quadrilateral.
pub fn windows(layout: &ChartLayout, corners: &Quad, inset: f64) -> Option<Vec<Quad>> {
    let map = Homography::onto(corners)?;
    // Edges are in patch widths; the map takes the unit square.
    let (width, height) = (layout.column_edges(layout.columns - 1)[1], layout.row_edges(layout.rows - 1)[1]);
    let window = |i: usize| {
        let ([left, right], [top, bottom]) =
            (layout.column_edges(i % layout.columns), layout.row_edges(i / layout.columns));
        let corner = |x: f64, y: f64| {
            map.apply([(left + x * (right - left)) / width, (top + y * (bottom - top)) / height])
        };
        [
            corner(inset, inset),
            corner(1.0 - inset, inset),
            corner(1.0 - inset, 1.0 - inset),
            corner(inset, 1.0 - inset),
        ]
    };
    Some((0..layout.columns * layout.rows).map(window).collect())
}

/// Middle of each patch on the chart itself: x and y from -1 (left, top) to 1.
pub fn places(layout: &ChartLayout) -> Vec<[f64; 2]> {
    let along = |i: usize, n: usize| if n < 2 { 0.0 } else { 2.0 * i as f64 / (n - 1) as f64 - 1.0 };
    (0..layout.columns * layout.rows)
        .map(|i| [along(i % layout.columns, layout.columns), along(i / layout.columns, layout.rows)])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_lie_inside_of_their_patches() {
        let layout = ChartLayout::by_name("classic24").unwrap();
        let corners = [[0.0, 0.0], [600.0, 0.0], [600.0, 400.0], [0.0, 400.0]];
        let all = windows(&layout, &corners, 0.2).unwrap();
        assert_eq!(all.len(), 24);
        // The first patch is 600 / (6 + 5 * 0.15) = 88.9 pixels wide.
        assert!((all[0][0][0] - 17.78).abs() < 0.01 && (all[0][1][0] - 71.1).abs() < 0.02, "{:?}", all[0]);
        assert!((all[23][2][0] - (600.0 - 17.78)).abs() < 0.01);
        assert_eq!(windows(&layout, &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], 0.2), None);
    }

    #[test]
    fn places_reach_from_edge_to_edge() {
        let places = places(&ChartLayout::by_name("classic24").unwrap());
        assert_eq!((places[0], places[23]), ([-1.0, -1.0], [1.0, 1.0]));
    }
}
