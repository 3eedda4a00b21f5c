//! Finding charts in a picture of linear light, without help.
//!
//! Flat regions are grown at several scales (`regions`), grouped into lattices (`lattice`), each lattice is read as every
//! known chart in every place and turn, mirrored ones too (`placement`), and the colours decide (`colours`). What they
//! accept is fitted to the edges of all patches at full resolution (`refine`) and judged again (`verdict`).
//!
//! **What it does not do:** it measures no patch; the corners it gives say where to measure.

mod colours;
mod found;
mod lattice;
mod pixels;
mod placement;
mod refine;
mod refusal;
mod regions;
mod verdict;

use rayon::prelude::*;

pub use found::{Found, Rejected, Search};
pub use pixels::SearchImage;
pub use refusal::Refusal;

use crate::ChartLayout;
use pixels::Reduced;
use placement::{Candidate, Family};

/// How hard to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The longer side of the largest picture that is searched for patches, in pixels; edges are refined in the
    /// picture as it came.
    pub search_side: usize,
    /// Most charts that are given back.
    pub most: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { search_side: 1200, most: 16 }
    }
}

/// Pictures smaller than this on their longer side hold no chart that could be measured.
const SMALLEST_SIDE: usize = 40;
/// Most candidates that are refined.
const MOST_CANDIDATES: usize = 24;

/// The charts of a picture, the most certain first.
pub fn find(picture: &SearchImage, layouts: &[ChartLayout], options: &Options) -> Vec<Found> {
    search(picture, layouts, options).found
}

/// The charts of a picture and, where there is none, what came nearest and why it was refused.
pub fn search(picture: &SearchImage, layouts: &[ChartLayout], options: &Options) -> Search {
    let Some(picture) = picture.checked().filter(|p| p.width.max(p.height) >= SMALLEST_SIDE) else {
        return Search { found: Vec::new(), rejected: Some(Rejected::nothing()) };
    };
    let families = Family::of(layouts);
    let scales = scales(&picture, options);
    let seen: Vec<(usize, Vec<Candidate>)> = scales.par_iter().map(|s| at_scale(s, &families)).collect();
    let largest = seen.iter().map(|(largest, _)| *largest).max().unwrap_or(0);
    let mut candidates: Vec<Candidate> = seen.into_iter().flat_map(|(_, candidates)| candidates).collect();
    candidates.sort_by(|a, b| b.rank().total_cmp(&a.rank()));
    let mut result = Search::default();
    let mut tried = 0;
    for candidate in &candidates {
        if result.found.iter().any(|f| found::overlap(&f.corners, &candidate.corners())) {
            continue;
        }
        if tried == MOST_CANDIDATES || result.found.len() == options.most {
            break;
        }
        tried += 1;
        match verdict::judge(&picture, candidate, &families) {
            Ok(found) if result.found.iter().any(|f| found::overlap(&f.corners, &found.corners)) => {}
            Ok(found) => result.found.push(found),
            Err(rejected) => result.note(*rejected),
        }
    }
    result.found.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
    if !result.found.is_empty() {
        result.rejected = None;
    } else if result.rejected.is_none() {
        result.rejected = Some(Rejected::lattice(largest));
    }
    result
}

/// The picture at `search_side` and at halves of it.
fn scales(picture: &SearchImage, options: &Options) -> Vec<Reduced> {
    let side = picture.width.max(picture.height);
    let first = side.div_ceil(options.search_side.max(SMALLEST_SIDE));
    let factors: Vec<usize> =
        (0..3).map(|k| first << k).take_while(|f| *f == first || side / f >= 200).collect();
    factors.par_iter().filter_map(|factor| Reduced::of(picture, *factor)).collect()
}

/// Regions of the largest lattice, and what may be charts.
fn at_scale(picture: &Reduced, families: &[Family]) -> (usize, Vec<Candidate>) {
    let regions = regions::regions(picture);
    let lattices = lattice::lattices(&regions);
    let largest = lattices.first().map_or(0, |l| l.members.len());
    let readings = |lattice| placement::candidates(picture, lattice, families);
    (largest, lattices.par_iter().flat_map_iter(readings).collect())
}
