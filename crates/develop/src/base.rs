//! What decides the balanced camera RGB of a picture, on which every later stage looks at one pixel alone.

use std::sync::Arc;

use darkroot_photo::{Capture, Correction};

use crate::demosaic::{Method, debias, reduce};
use crate::denoise::Denoiser;
use crate::fringe;
use crate::geometry::Laid;
use crate::highlights::{self, Treatment};
use crate::lateral::{self, Lateral};
use crate::light::LinearLight;
use crate::mend::Mends;
use crate::noise::Noise;
use crate::sharpen::Sharpener;
use crate::stage::Stage;
use crate::view::Scale;

/// All that the neighbourhood stages use: two plans whose bases are the same have the same camera RGB. A stage that needs more
/// puts it here.
#[derive(Debug, Clone)]
pub(crate) struct Base {
    pub(crate) capture: Arc<Capture>,
    pub(crate) light: Arc<LinearLight>,
    /// Where the picture lies in the frame.
    pub(crate) laid: Laid,
    /// White-balance multipliers; the smallest is 1.
    pub(crate) multipliers: [f32; 3],
    pub(crate) demosaic: Method,
    pub(crate) picture_corrections: Vec<Correction>,
    pub(crate) highlights: Treatment,
    pub(crate) noise: Noise,
    /// What is put right in single samples.
    pub(crate) mends: Arc<Mends>,
    /// What takes noise from the mosaic; `None` for nothing.
    pub(crate) denoiser: Option<Arc<Denoiser>>,
    /// Where red and blue are to be brought from to where green is; `None` for nothing.
    pub(crate) lateral: Option<Lateral>,
    /// What sharpens the picture; `None` for nothing.
    pub(crate) sharpener: Option<Sharpener>,
}

impl Base {
    /// Stages that change the mosaic before it becomes a picture.
    pub(crate) fn changes(&self) -> Vec<Stage> {
        let rebuilds = matches!(self.highlights, Treatment::Rebuild(_)) && self.demosaic != Method::None;
        let aligns = self.lateral.as_ref().map(lateral::stage);
        rebuilds.then_some(highlights::STAGE).into_iter().chain(aligns).collect()
    }

    /// Stages that read the changed mosaic.
    pub(crate) fn readers(&self, scale: Scale) -> Vec<Stage> {
        match (self.demosaic, scale) {
            (Method::None, _) => Vec::new(),
            (_, scale) if scale.bin() >= reduce::LEAST => vec![reduce::STAGE],
            (method, _) => vec![method.stage(), debias::STAGE, fringe::STAGE],
        }
    }
}

impl PartialEq for Base {
    /// Whether both give the same camera RGB. Captures are the same only if they are one and the same.
    fn eq(&self, other: &Self) -> bool {
        let Self {
            capture,
            light,
            laid,
            multipliers,
            demosaic,
            picture_corrections,
            highlights,
            noise,
            mends,
            denoiser,
            lateral,
            sharpener,
        } = other;
        let asked = |denoiser: &Option<Arc<Denoiser>>| denoiser.as_ref().map(|d| d.asked.clone());
        Arc::ptr_eq(&self.capture, capture)
            && Arc::ptr_eq(&self.light, light)
            && self.laid == *laid
            && self.multipliers.map(f32::to_bits) == multipliers.map(f32::to_bits)
            && self.demosaic == *demosaic
            && self.picture_corrections == *picture_corrections
            && self.highlights == *highlights
            && self.noise == *noise
            && self.mends == *mends
            && asked(&self.denoiser) == asked(denoiser)
            && self.lateral == *lateral
            && self.sharpener == *sharpener
    }
}
