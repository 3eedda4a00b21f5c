//! From the mosaic to a picture that is a quarter as long and as high, or less: binning instead of interpolation.
//!
//! A pixel of the smaller picture is the mean light of a square of the sensor. Green is told best, by most samples; red
//! and blue are green less their difference from it, which is smooth: for Bayer arrays see `reduce_bayer`, for others
//! `reduce_any`. All of it is linear in the samples: in a mean over many of them there is little
//! left to choose a direction for.

use darkroot_photo::{CameraSpace, Layout, Mosaic, Rgb, Size};

use super::reduce_any::Weights;
use super::{Method, reduce_any, reduce_bayer};
use crate::stage::{Stage, WhenSmaller};

/// Pixels around a square that have a say in its colours.
pub const BORDER: usize = 6;

const _: () = assert!(reduce_bayer::BORDER <= BORDER && reduce_any::BORDER <= BORDER);

/// What it asks of a tile.
pub const STAGE: Stage = Stage { name: "binning", border: BORDER, when_smaller: WhenSmaller::Same };

/// Smallest side of a square that is binned. Squares of two pixels hold too few samples to do without a direction: there
/// the picture is interpolated, and the mean taken after that.
pub const LEAST: usize = 4;

/// How the mosaic of one sensor is binned.
#[derive(Debug, Clone)]
pub(crate) enum Reduction {
    /// Differences from green.
    Bayer,
    /// Weights for each place of the array.
    Other(Weights),
    /// Every pixel has all colours.
    Whole,
}

impl Reduction {
    /// Prepares binning for a layout.
    pub(crate) fn of(layout: &Layout) -> Self {
        match layout {
            Layout::Cfa(cfa) if cfa.is_bayer() => Self::Bayer,
            Layout::Cfa(cfa) => Self::Other(Weights::new(cfa)),
            Layout::Rgb | Layout::Monochrome => Self::Whole,
        }
    }

    /// Reduces the inner part of a balanced mosaic: `border` pixels, at least [`BORDER`], are cut off on each side, and
    /// what is left becomes one pixel of `picture`, which takes its size, for each square of `bin` pixels, at least
    /// [`LEAST`]. `begin` is the place in the frame at which the mosaic begins.
    pub(crate) fn reduce(
        &self,
        mosaic: &Mosaic<f32>,
        border: usize,
        bin: usize,
        begin: (isize, isize),
        picture: &mut Rgb<CameraSpace>,
    ) {
        let inner = |v: usize| (v - 2 * border) / bin;
        let size = Size { width: inner(mosaic.size.width), height: inner(mosaic.size.height) };
        match (self, &mosaic.layout) {
            (Self::Bayer, Layout::Cfa(cfa)) => {
                picture.resize(size);
                reduce_bayer::reduce(mosaic, cfa, border, bin, picture);
            }
            (Self::Other(weights), _) => {
                let squares = reduce_any::reduce(mosaic, border, begin, weights, size, bin);
                *picture = mean(&squares, bin / reduce_any::SIDE);
            }
            _ => {
                super::demosaic(mosaic, Method::None, border, picture);
                *picture = mean(picture, bin);
            }
        }
    }
}

/// Means over squares of `side` pixels of a picture that is a whole number of them.
pub(crate) fn mean(picture: &Rgb<CameraSpace>, side: usize) -> Rgb<CameraSpace> {
    let whole = picture.size();
    let size = Size { width: whole.width / side, height: whole.height / side };
    let mut smaller = Rgb::black(size);
    let share = 1.0 / (side * side) as f32;
    for (out, plane) in smaller.planes_mut().into_iter().zip(picture.planes()) {
        for (y, out) in out.chunks_exact_mut(size.width.max(1)).enumerate() {
            for row in plane[y * side * whole.width..(y + 1) * side * whole.width].chunks_exact(whole.width) {
                for (out, pixels) in out.iter_mut().zip(row.chunks_exact(side)) {
                    *out += pixels.iter().sum::<f32>() * share;
                }
            }
        }
    }
    smaller
}
