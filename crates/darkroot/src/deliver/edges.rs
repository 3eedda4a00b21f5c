//! Sharpness of a finished picture, by the slanted edges of the target, or those of its grey patches.

use darkroot_calibrate::delivery::Edges;
use darkroot_chart::{ChartLayout, EdgeLine, EdgeResponse, Quad, slanted_edge};
use darkroot_colour::statistics::median;
use darkroot_photo::Mosaic;

/// Chroma up to which a patch is grey, and L\* from which its edge to the dark frame has contrast.
const GREY: f64 = 8.0;
const LIGHT: f64 = 45.0;
/// Fewest edges that tell.
const FEWEST: usize = 3;

/// The median over all edges that tell, `own` being those that the target has beside its grid; `None` where too few do.
pub(super) fn edges(
    light: &Mosaic<f32>,
    luminance: [f64; 3],
    patches: &[Quad],
    layout: &ChartLayout,
    own: &[EdgeLine],
) -> Option<Edges> {
    let is_grey = |i: &usize| {
        let lab = layout.patches[*i].lab;
        lab.a.hypot(lab.b) <= GREY && lab.l >= LIGHT
    };
    let greys: Vec<Quad> =
        (0..patches.len().min(layout.patches.len())).filter(is_grey).map(|i| patches[i]).collect();
    // Edges that a target has for this purpose are better than those of its patches.
    let made_for_it = slanted_edge::responses_of(light, luminance, own);
    let found = match made_for_it.len() {
        FEWEST.. => made_for_it,
        _ => slanted_edge::responses(light, luminance, &greys, layout.gap),
    };
    if found.len() < FEWEST {
        return None;
    }
    let middle = |of: &dyn Fn(&EdgeResponse) -> f64| median(&mut found.iter().map(of).collect::<Vec<_>>());
    Some(Edges {
        count: found.len(),
        sfr50: middle(&|edge| edge.falls_to(0.5))?,
        // Beyond half a cycle a pixel is nothing that a file could hold.
        sfr10: middle(&|edge| edge.falls_to(0.1).min(0.5))?,
        peak: middle(&|edge| edge.peak())?,
        misregistration: middle(&|edge| edge.shifts[0].abs().max(edge.shifts[1].abs()))?,
    })
}
