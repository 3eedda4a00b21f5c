//! Geometric distortion, by the chart's own grid: how far its patches lie from where a plane chart would have them in any view
//! without distortion.

use darkroot_photo::Mosaic;
use rayon::prelude::*;

use crate::slanted_edge::centre_shift;
use crate::{ChartLayout, Homography, Quad, windows};

/// Fewest patches whose edges tell.
const FEWEST: usize = 8;

/// How far patches lie from a plane grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distortion {
    /// Largest distance of a patch from its place, percent of the chart's diagonal.
    pub percent: f64,
    /// The same in pixels.
    pub pixels: f64,
    /// Patches whose edges told their place.
    pub patches: usize,
}

/// Measures the grid of a chart in a finished picture. `patches` are whole patches as they were found, in pixels; their real
/// centres follow from their edges, and a homography, which is any view of a plane through a lens without distortion, is fitted
/// to them. `None` where too few patches have edges with contrast, and for charts that fold.
pub fn distortion(
    light: &Mosaic<f32>,
    luminance: [f64; 3],
    patches: &[Quad],
    layout: &ChartLayout,
) -> Option<Distortion> {
    // A chart that folds need not lie in one plane.
    if layout.hinge.is_some() {
        return None;
    }
    let places = windows::places(layout);
    let found: Vec<([f64; 2], [f64; 2])> = patches
        .par_iter()
        .zip(&places)
        .filter_map(|(quad, place)| {
            let shift = centre_shift(light, luminance, quad, layout.gap)?;
            let centre = |k: usize| quad.iter().map(|p| p[k]).sum::<f64>() / 4.0 + shift[k];
            Some((*place, [centre(0), centre(1)]))
        })
        .collect();
    if found.len() < FEWEST {
        return None;
    }
    let plane = Homography::fitted(&found)?;
    let off = |(place, centre): &([f64; 2], [f64; 2])| {
        let [x, y] = plane.apply(*place);
        (centre[0] - x).hypot(centre[1] - y)
    };
    let pixels = found.iter().map(off).fold(0.0, f64::max);
    let (first, last) = (patches.first()?, patches.last()?);
    let diagonal = (last[2][0] - first[0][0]).hypot(last[2][1] - first[0][1]);
    let percent = 100.0 * pixels / diagonal;
    percent.is_finite().then_some(Distortion { percent, pixels, patches: found.len() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::{Layout, Size};

    const SIZE: Size = Size { width: 500, height: 360 };

    /// The classic chart, six by four light patches of 60 pixels on black with gaps of 12, seen through a lens that moves what
    /// lies at a distance r from the centre by `strength` r^3.
    fn seen(strength: f64) -> (Mosaic<f32>, Vec<Quad>, ChartLayout) {
        let layout = ChartLayout { gap: 0.2, ..ChartLayout::by_name("classic24").unwrap() };
        let (cx, cy) = (249.5, 179.5);
        let light = |x: f64, y: f64| {
            let (dx, dy) = ((x - cx) / 250.0, (y - cy) / 250.0);
            let back = 1.0 - strength * (dx * dx + dy * dy);
            let (u, v) = (250.0 * dx * back + cx - 40.0, 250.0 * dy * back + cy - 42.0);
            let within = |v: f64, n: f64| v >= 0.0 && v < 72.0 * n - 12.0 && v.rem_euclid(72.0) < 60.0;
            if within(u, 6.0) && within(v, 4.0) { 0.8f32 } else { 0.05 }
        };
        let mut samples = Vec::new();
        for i in 0..SIZE.area() {
            let at = |k: usize| {
                light(
                    (i % SIZE.width) as f64 + [-0.25, 0.25][k % 2],
                    (i / SIZE.width) as f64 + [-0.25, 0.25][k / 2],
                )
            };
            samples.extend([(0..4).map(at).sum::<f32>() / 4.0; 3]);
        }
        let quad = |i: usize| {
            let (x, y) = (40.0 + 72.0 * (i % 6) as f64 - 0.5, 42.0 + 72.0 * (i / 6) as f64 - 0.5);
            [[x, y], [x + 60.0, y], [x + 60.0, y + 60.0], [x, y + 60.0]]
        };
        (Mosaic { size: SIZE, layout: Layout::Rgb, samples }, (0..24).map(quad).collect(), layout)
    }

    #[test]
    fn a_plane_chart_has_none_and_a_barrel_is_told_by_how_much() {
        let (light, patches, layout) = seen(0.0);
        let none = distortion(&light, [0.2, 0.7, 0.1], &patches, &layout).unwrap();
        assert!(none.patches == 24 && none.pixels < 0.1, "{none:?}");
        let (light, patches, layout) = seen(0.02);
        let found = distortion(&light, [0.2, 0.7, 0.1], &patches, &layout).unwrap();
        // The truth: centres moved outwards by about 0.02 r^3, and the plane grid that fits them best.
        let places = windows::places(&layout);
        let moved = |quad: &Quad| {
            let [x, y] = [0, 1].map(|k| quad.iter().map(|p| p[k]).sum::<f64>() / 4.0);
            let (dx, dy) = ((x - 249.5) / 250.0, (y - 179.5) / 250.0);
            let out = 1.0 + 0.02 * (dx * dx + dy * dy);
            [249.5 + 250.0 * dx * out, 179.5 + 250.0 * dy * out]
        };
        let pairs: Vec<_> = places.iter().zip(&patches).map(|(place, quad)| (*place, moved(quad))).collect();
        let plane = Homography::fitted(&pairs).unwrap();
        let off = |(place, there): &([f64; 2], [f64; 2])| {
            let [x, y] = plane.apply(*place);
            (there[0] - x).hypot(there[1] - y)
        };
        let truth = pairs.iter().map(off).fold(0.0, f64::max);
        assert!(truth > 0.5 && (found.pixels - truth).abs() < 0.25 * truth, "{found:?} {truth}");
    }
}
