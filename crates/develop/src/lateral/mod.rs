//! Lateral chromatic aberration, as the mosaic itself shows it: by how much red and blue lie beside green.
//!
//! A lens draws red and blue a little larger or smaller than green, so that every edge across the direction to the optical
//! centre gets a coloured seam. In blocks with strong edges the displacement of red and of blue is measured (`shift.rs`); a
//! function of the distance from the centre is fitted to all of them, and it counts only where parts of the picture that
//! had no say in it bear it out (`radial.rs`). Else nothing is known, and nothing is done.

mod align;
mod blocks;
mod radial;
mod shift;
mod taps;

use darkroot_photo::{Capture, Filter, Layout, Rect};
use rayon::prelude::*;

use crate::light::LinearLight;
use crate::survey::Survey;
pub(crate) use align::{Scratch, align, stage};
use blocks::SIDE;
pub(crate) use radial::Radial;
use radial::{Place, certain};
use shift::{Planes, displaced};

/// Side of the squares of the frame that are displaced as one, pixels.
const CELL: usize = 16;
/// Displacements beyond this are none, pixels.
const MOST: f64 = 4.0;

/// Where red and blue lie that belong to a place of green.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lateral {
    /// Column and row of the optical centre in the frame; the middle of the first pixel is (0.5, 0.5).
    centre: [f64; 2],
    /// Half the diagonal of what the maker shows, pixels.
    reach: f64,
    /// Of red and blue; `None` where nothing certain is known.
    channels: [Option<Radial>; 2],
    /// Pixels that no displacement is more than, along an axis.
    most: usize,
}

impl Lateral {
    /// By how much the colour `channel` of the middle of a cell of the frame lies beside green, pixels. All of a cell counts as
    /// its middle, which is wrong by less than 0.01 pixels.
    fn of_cell(&self, channel: usize, column: isize, row: isize) -> [f64; 2] {
        let Some(radial) = &self.channels[channel / 2] else { return [0.0; 2] };
        let middle = |at: isize| (at as f64 + 0.5) * CELL as f64;
        let (u, v) =
            ((middle(column) - self.centre[0]) / self.reach, (middle(row) - self.centre[1]) / self.reach);
        let factor = radial.factor(u * u + v * v);
        let most = self.most as f64;
        [u, v].map(|u| (factor * u).clamp(-most, most))
    }

    /// Whether anything is known of red (0) or blue (2).
    fn moves(&self, channel: usize) -> bool {
        self.channels[channel / 2].is_some()
    }

    /// By how many pixels red and blue lie farther from the centre than green, in the corners.
    pub fn corners(&self) -> [f64; 2] {
        self.channels.map(|channel| channel.map_or(0.0, |radial| radial.factor(1.0)))
    }

    /// What is done about it, in words.
    pub(crate) fn note(&self) -> String {
        let [red, blue] = self.corners();
        let most = self.channels.map(|channel| channel.map_or(0.0, |radial| radial.most()));
        format!(
            "lateral chromatic aberration is corrected as the picture shows it: in the corners red lies {red:+.2} and blue \
             {blue:+.2} pixels outside of green, at most {:.2} and {:.2}",
            most[0], most[1]
        )
    }
}

/// What a capture tells; `None` where nothing is certain, and for other sensors than Bayer.
pub(crate) fn measured(capture: &Capture, light: &LinearLight, survey: &Survey) -> Option<Lateral> {
    let Layout::Cfa(cfa) = capture.counts.layout() else { return None };
    if !cfa.is_bayer() || capture.rendered {
        return None;
    }
    let (area, shown) = (capture.active_area, capture.default_crop);
    let centre = shown.middle();
    let reach = 0.5 * (shown.width as f64).hypot(shown.height as f64);
    let chosen = blocks::chosen(survey, (area.width, area.height));
    let phase = |filter: Filter| {
        let (x, y) = cfa.shifted(area.x, area.y).first(filter).unwrap_or_default();
        (x % 2, y % 2)
    };
    let phases = [Filter::Red, Filter::Blue].map(phase);
    let found: Vec<[Option<Place>; 2]> = chosen
        .par_iter()
        .map_init(
            || (Planes::default(), vec![0f32; SIDE * SIDE]),
            |(planes, samples), &(x, y)| {
                let block = Rect { x: area.x + x, y: area.y + y, width: SIDE, height: SIDE };
                for (i, row) in samples.chunks_exact_mut(SIDE).enumerate() {
                    light.row(&capture.counts, block.x, block.y + i, row);
                }
                let middle = block.middle();
                let from_centre = [0, 1].map(|axis| (middle[axis] - centre[axis]) / reach);
                phases.map(|phase| {
                    planes.of(samples, phase);
                    let shift = displaced(planes)?;
                    // Blocks lie where their edges do.
                    let at = [0, 1].map(|axis| from_centre[axis] + shift.at[axis] / reach);
                    Some(Place::new(at, shift))
                })
            },
        )
        .collect();
    let channels = [0, 1].map(|c| {
        let places: Vec<Place> = found.iter().filter_map(|channels| channels[c]).collect();
        certain(&places)
    });
    let most = channels.iter().flatten().map(Radial::most).reduce(f64::max)?;
    // A little more, for what lies beyond the corners.
    let most = (1.1 * most).clamp(1.0, MOST).ceil() as usize;
    Some(Lateral { centre, reach, channels, most })
}
