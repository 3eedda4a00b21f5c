//! Noise taken away on the mosaic, before anything is interpolated: there it is independent from sample to sample, and how
//! strong it is, is known.
//!
//! ```text
//! model      how the variance grows with light: from the file, else measured in the picture (measure.rs)
//! stabilise  a root that gives every sample noise of variance 1, and its unbiased inverse
//! rotation   the four samples of a Bayer block -> grey and three differences of colour
//! scales     an undecimated ("a trous") wavelet; each detail shrunk by what its surroundings tell (shrink.rs)
//! ```
//!
//! F. J. Anscombe, "The transformation of Poisson, binomial and negative-binomial data", Biometrika 35, 1948; J.-L. Starck,
//! F. Murtagh and A. Bijaoui, "Image Processing and Data Analysis: The Multiscale Approach", 1998, for the wavelet and the
//! transformation with read noise; M. K. Mihcak, I. Kozintsev, K. Ramchandran and P. Moulin, "Low-complexity image denoising
//! based on statistical modeling of wavelet coefficients", IEEE Signal Processing Letters 6(12), 1999, for shrinking; M.
//! Makitalo and A. Foi, IEEE Transactions on Image Processing 20(1), 2011, and 22(1), 2013, for the inverse.
//!
//! What is computed is the noise that is to be taken away, so that where nothing is, nothing changes. The two finest scales
//! are looked at in tiles (`bayer.rs`). The others reach far and hold little: they are found for the whole frame at once, on
//! a fourth of its rows and columns (`coarse.rs`), so that a tile needs no wide border and its surroundings have no seams.

pub mod model;
pub use model::{Line, NoiseModel};

mod any;
mod bayer;
mod coarse;
mod likeness;
mod measure;
mod pyramid;
mod rotation;
mod rows;
mod shrink;
mod stabilise;

pub(crate) use bayer::Scratch;
pub(crate) use measure::{Measured, measured};

use std::sync::{Arc, Mutex, PoisonError};

use darkroot_photo::{Capture, Cfa, Layout, Rect};

use crate::light::{LinearLight, layout_from};
use crate::mend::Mends;
use crate::recipe::DenoiseBy;
use crate::stage::{Stage, WhenSmaller};
use crate::view::{Cancel, Cancelled};
use coarse::Coarse;
use likeness::Clean;
use rotation::Rotation;
use rows::Source;
use shrink::UnitNoise;
use stabilise::Stabiliser;

/// What it asks of a tile: pixels around it, of which it gives none. What reaches farther is found before tiles begin
/// (`OfFrame`).
pub const STAGE: Stage = Stage { name: "noise", border: bayer::BORDER, when_smaller: WhenSmaller::Same };

/// How much noise is taken away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strength {
    /// Of brightness: 1 for all that the model expects, 0 for none.
    pub luma: f32,
    /// Of colour.
    pub chroma: f32,
}

/// What the filter is made of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Asked {
    pub(crate) by: DenoiseBy,
    /// Noise of the samples by their light, before the file's corrections and before balancing.
    pub(crate) model: NoiseModel,
    /// Balanced, grey has equal channels.
    pub(crate) multipliers: [f32; 3],
    /// How much of it goes.
    pub(crate) strength: Strength,
    /// Light at which each channel clips: such samples stay as they are.
    pub(crate) limits: [f32; 3],
    /// What is put right before.
    pub(crate) mends: Arc<Mends>,
}

/// The filter for one capture.
#[derive(Debug)]
pub(crate) struct Denoiser {
    pub(crate) asked: Asked,
    /// What serves in place of the rest for arrays other than Bayer's.
    any: Option<any::Filter>,
    /// Of the samples of a block of 2 x 2, row by row from the active area's corner on.
    stabilisers: [Stabiliser; 4],
    limits: [f32; 4],
    rotation: Rotation,
    unit: UnitNoise,
    /// How strongly each of the four rotated planes is shrunk.
    strengths: [f32; 4],
    /// What somebody has found out about the frame already.
    of_frame: Mutex<Option<OfFrame>>,
}

/// What a filter has to know of a frame, or of a large part of it, before it looks at tiles.
#[derive(Debug, Clone)]
pub(crate) enum OfFrame {
    /// Nothing.
    Nothing,
    /// The noise of the coarse scales.
    Coarse(Arc<Coarse>),
    /// All that there is to know.
    Clean(Arc<Clean>),
}

impl Denoiser {
    /// The filter for a capture; `None` where it is of no use: for sensors without filters, or at no strength.
    pub(crate) fn of(capture: &Capture, asked: Asked) -> Option<Self> {
        let area = capture.active_area;
        let layout = layout_from(capture.counts.layout(), area.x as isize, area.y as isize);
        let Layout::Cfa(cfa) = layout else { return None };
        let Strength { luma, chroma } = asked.strength;
        if luma <= 0.0 && chroma <= 0.0 || area.width < 4 || area.height < 4 {
            return None;
        }
        let any = any::Array::of(&cfa).map(|array| any::Filter {
            array,
            stabilisers: asked.model.channels.map(Stabiliser::of),
            limits: asked.limits,
            // Colours are not parted into brightness and differences.
            strength: luma,
        });
        if any.is_none() && !cfa.is_bayer() {
            return None;
        }
        let channels = block(&cfa);
        let stabilisers = channels.map(|c| Stabiliser::of(asked.model.channels[c]));
        let grey = [0, 1, 2, 3].map(|i| stabilisers[i].slope_of_grey(asked.multipliers[channels[i]]));
        Some(Self {
            any,
            stabilisers,
            limits: channels.map(|c| asked.limits[c]),
            rotation: Rotation::with_grey(grey, channels),
            unit: UnitNoise::new(),
            strengths: [luma, chroma, chroma, chroma],
            of_frame: Mutex::new(None),
            asked,
        })
    }

    /// What is to be known of the frame before this rectangle of it can be denoised (inside the active area), found when it is
    /// first asked for. Two who ask at once both look for it, and find the same: nobody waits for a lock while threads of one
    /// pool help each other.
    ///
    /// # Errors
    /// Somebody cancelled it.
    pub(crate) fn of_frame(
        &self,
        (capture, light): (&Capture, &LinearLight),
        rect: Rect,
        cancel: &Cancel,
    ) -> Result<OfFrame, Cancelled> {
        if self.any.is_some() {
            return Ok(OfFrame::Nothing);
        }
        let known = || self.of_frame.lock().unwrap_or_else(PoisonError::into_inner);
        match &*known() {
            Some(OfFrame::Clean(clean)) if !clean.covers(rect) => {}
            Some(of_frame) => return Ok(of_frame.clone()),
            None => {}
        }
        let found = match self.compares(capture) {
            true => OfFrame::Clean(Arc::new(Clean::of(self, (capture, light), rect, cancel)?)),
            false => OfFrame::Coarse(Arc::new(Coarse::of(self, capture, light, cancel)?)),
        };
        *known() = Some(found.clone());
        Ok(found)
    }

    /// Whether noise is told by likeness.
    fn compares(&self, capture: &Capture) -> bool {
        let area = capture.active_area;
        self.asked.by == DenoiseBy::Likeness && area.width.min(area.height) >= likeness::SMALLEST
    }

    fn source<'a>(&'a self, capture: &'a Capture, light: &'a LinearLight) -> Source<'a> {
        Source { capture, light, mends: &self.asked.mends }
    }

    /// Share of the variance that is left where there is nothing but noise.
    pub(crate) fn left(&self) -> f32 {
        let Strength { luma, chroma } = self.asked.strength;
        let kept = |s: f32| match self.asked.by {
            DenoiseBy::Scales => (1.0 - shrink::removed(shrink::threshold(1.0, s), 1.0)).powi(2),
            DenoiseBy::Likeness => likeness::left_of_noise(s),
        };
        if self.any.is_some() {
            return 1.0;
        }
        // Of the four planes three are colour.
        (kept(luma) + 3.0 * kept(chroma)) / 4.0
    }

    /// The light of a rectangle of the frame (inside the active area) without noise, into `scratch`, which tells its rows.
    pub(crate) fn denoise(
        &self,
        (capture, light): (&Capture, &LinearLight),
        of_frame: &OfFrame,
        rect: Rect,
        scratch: &mut Scratch,
    ) {
        let source = self.source(capture, light);
        match (of_frame, &self.any) {
            (OfFrame::Coarse(coarse), _) => bayer::denoise(self, source, coarse, rect, scratch),
            (OfFrame::Clean(clean), _) => clean.denoise(rect, scratch),
            (OfFrame::Nothing, Some(any)) => any.denoise(source, rect, scratch),
            (OfFrame::Nothing, None) => unreachable!("filters of Bayer arrays know something of the frame"),
        }
    }
}

/// Channels of a block of 2 x 2 samples, row by row.
fn block(cfa: &Cfa) -> [usize; 4] {
    [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| cfa.at(x, y).plane().unwrap_or(1))
}

#[cfg(test)]
mod slow;
#[cfg(test)]
mod tests;
#[cfg(test)]
pub(crate) use tests::Random;
