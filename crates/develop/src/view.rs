//! Which part of a picture is rendered, and how large.

use std::sync::atomic::{AtomicBool, Ordering};

use darkroot_photo::{Rect, Size};

/// Size of a view against the whole picture: 1, 1/2, 1/4 and so on to 1/64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Scale {
    halvings: u8,
}

impl Scale {
    /// Pixel for pixel.
    pub const FULL: Self = Self { halvings: 0 };
    /// 1/2.
    pub const HALF: Self = Self { halvings: 1 };
    /// 1/4.
    pub const QUARTER: Self = Self { halvings: 2 };
    /// 1/64, the smallest.
    pub const LEAST: Self = Self { halvings: 6 };

    /// Half as large so many times; `None` beyond [`Scale::LEAST`].
    pub fn halved(halvings: u8) -> Option<Self> {
        (halvings <= Self::LEAST.halvings).then_some(Self { halvings })
    }

    /// The smallest scale at which the longer side of a picture has at least so many pixels, or the full size where
    /// it has not.
    pub fn to_show(size: Size, longest: usize) -> Self {
        let side = size.width.max(size.height);
        let fits = |halvings: &u8| side >> halvings >= longest;
        let halvings = (0..=Self::LEAST.halvings).rev().find(fits).unwrap_or(0);
        Self { halvings }
    }

    /// Pixels of the whole picture along the side of one pixel of the view: 1, 2, 4 ... 64.
    pub fn bin(self) -> usize {
        1 << self.halvings
    }

    /// Size of a picture at this scale; a last column or row that is not whole counts.
    pub fn of(self, size: Size) -> Size {
        Size { width: size.width.div_ceil(self.bin()), height: size.height.div_ceil(self.bin()) }
    }
}

/// A rectangle of a picture at a scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct View {
    /// How large.
    pub scale: Scale,
    /// Which part, in pixels of the upright picture as it is at that scale; what lies outside is left out.
    pub rect: Rect,
}

impl View {
    /// A part of the picture, pixel for pixel.
    pub fn of(rect: Rect) -> Self {
        Self { scale: Scale::FULL, rect }
    }
}

/// A wish to stop rendering, which any thread may utter.
#[derive(Debug, Default)]
pub struct Cancel(AtomicBool);

impl Cancel {
    /// Whoever renders with this stops within a tile.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Rendering was cancelled; there is no picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the rendering was cancelled")]
pub struct Cancelled;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_that_shows_a_picture_is_the_smallest_that_is_large_enough() {
        let size = Size { width: 4000, height: 6000 };
        for (longest, bin) in [(7000, 1), (6000, 1), (3001, 1), (3000, 2), (1400, 4), (1, 64)] {
            assert_eq!(Scale::to_show(size, longest).bin(), bin, "{longest}");
        }
        assert_eq!(Scale::halved(7), None);
    }
}
