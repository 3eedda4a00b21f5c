//! Demosaic: from one colour a pixel to three.
//!
//! Every method works on the signed square root of the balanced samples and squares its result: interpolation
//! on linear light smears bright into dark, and the square root is nearly even for shot noise. Unlike a curve
//! with a toe it is homogeneous, so twice the light still gives twice the picture.

use darkroot_photo::{CameraSpace, Layout, Mosaic, Rgb, Size};

use crate::Demosaic;
use crate::stage::{Stage, WhenSmaller};

pub mod bilinear;
pub mod debias;
mod kriging;
pub mod lmmse;
pub mod reduce;
mod reduce_any;
mod reduce_bayer;
mod rows;
pub mod xtrans;

/// A demosaicing method for one sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Directional LMMSE, for Bayer.
    Lmmse,
    /// Linear prediction under several models, for X-Trans.
    XTrans,
    /// Weighted mean of the nearest samples of each colour, for any array.
    Bilinear,
    /// Nothing to interpolate: linear RGB or monochrome.
    None,
}

impl Method {
    /// The method for a sensor; `None` for filter arrays with other colours than red, green and blue.
    pub fn of(layout: &Layout, wanted: Demosaic) -> Option<Self> {
        match layout {
            Layout::Rgb | Layout::Monochrome => Some(Self::None),
            Layout::Cfa(cfa) if !cfa.is_rgb() => None,
            Layout::Cfa(cfa) if cfa.is_bayer() && wanted == Demosaic::Best => Some(Self::Lmmse),
            Layout::Cfa(cfa) if xtrans::phase(cfa).is_some() && wanted == Demosaic::Best => {
                Some(Self::XTrans)
            }
            Layout::Cfa(_) => Some(Self::Bilinear),
        }
    }

    /// What it asks of a tile.
    pub const fn stage(self) -> Stage {
        let border = match self {
            Self::Lmmse => lmmse::BORDER,
            Self::XTrans => xtrans::BORDER,
            Self::Bilinear => bilinear::BORDER,
            Self::None => 0,
        };
        Stage { name: self.name(), border, when_smaller: WhenSmaller::Skipped }
    }

    /// Name and source, for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lmmse => "directional LMMSE (Zhang and Wu 2005)",
            Self::XTrans => "kriging under eight models (after Matheron 1963, Dubrule 1983)",
            Self::Bilinear => "bilinear",
            Self::None => "none",
        }
    }
}

/// Interpolates the inner part of a balanced mosaic: `border` pixels, at least those of [`Method::stage`], are cut off
/// on each side. `picture` takes the size of what is left.
pub fn demosaic(mosaic: &Mosaic<f32>, method: Method, border: usize, picture: &mut Rgb<CameraSpace>) {
    let inner = Size { width: mosaic.size.width - 2 * border, height: mosaic.size.height - 2 * border };
    picture.resize(inner);
    match (method, &mosaic.layout) {
        (Method::Lmmse, Layout::Cfa(cfa)) => lmmse::demosaic(mosaic, cfa, border, picture),
        (Method::XTrans, Layout::Cfa(cfa)) => match xtrans::phase(cfa) {
            Some(phase) => xtrans::demosaic(mosaic, phase, border, picture),
            None => bilinear::demosaic(mosaic, cfa, border, picture),
        },
        (_, Layout::Cfa(cfa)) => bilinear::demosaic(mosaic, cfa, border, picture),
        (_, Layout::Rgb | Layout::Monochrome) => split(mosaic, border, picture),
    }
}

/// Splits the inner pixels, of one or three samples, into planes.
fn split(mosaic: &Mosaic<f32>, border: usize, picture: &mut Rgb<CameraSpace>) {
    let Size { width, height } = picture.size();
    let planes = mosaic.layout.planes();
    for (c, plane) in picture.planes_mut().into_iter().enumerate() {
        for y in 0..height {
            let start = ((y + border) * mosaic.size.width + border) * planes;
            let row = mosaic.samples[start..start + width * planes].iter().skip(c.min(planes - 1));
            for (out, v) in plane[y * width..][..width].iter_mut().zip(row.step_by(planes)) {
                *out = *v;
            }
        }
    }
}

/// Square root that keeps the sign.
#[inline(always)]
pub(crate) fn signed_sqrt(v: f32) -> f32 {
    v.abs().sqrt().copysign(v)
}

/// Square that keeps the sign: the inverse of [`signed_sqrt`].
#[inline(always)]
pub(crate) fn signed_square(v: f32) -> f32 {
    v * v.abs()
}

#[cfg(test)]
mod lmmse_slow;
#[cfg(test)]
mod tests;
