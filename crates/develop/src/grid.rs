//! Where the pixels of a picture lie in the frame.

use darkroot_photo::{Orientation, Rect, Size};

use crate::base::Base;
use crate::view::Scale;

/// The pixels of a picture at a scale, as they lie in the frame.
pub(crate) struct Grid {
    /// Pixels of the frame along the side of one.
    pub(crate) bin: usize,
    /// Column and row of the frame at which they begin: left of or above the crop where its size is no multiple of
    /// the bin and the picture's upright left or top edge is the frame's right or bottom one.
    origin: (isize, isize),
    /// Number of columns and rows.
    size: Size,
    pub(crate) orientation: Orientation,
}

impl Grid {
    pub(crate) fn of(base: &Base, scale: Scale) -> Self {
        let (crop, orientation, bin) = (base.laid.crop, base.laid.orientation, scale.bin());
        let size = scale.of(crop.size());
        let upright = orientation.applied_to(size);
        // Which corner of the grid becomes the upright picture's top left one.
        let (x, y) = match (upright.width, upright.height) {
            (0, _) | (_, 0) => (0, 0),
            _ => orientation.inverse().place(0, 0, upright),
        };
        let begin = |at: usize, start: usize, end: usize, count: usize| {
            if at == 0 { start as isize } else { end as isize - (count * bin) as isize }
        };
        let origin =
            (begin(x, crop.x, crop.right(), size.width), begin(y, crop.y, crop.bottom(), size.height));
        Self { bin, origin, size, orientation }
    }

    /// The pixels of an area of the frame, from its corner on.
    pub(crate) fn of_area(area: Rect, scale: Scale) -> Self {
        let origin = (area.x as isize, area.y as isize);
        Self { bin: scale.bin(), origin, size: scale.of(area.size()), orientation: Orientation::Upright }
    }

    /// The pixels that become a rectangle of the upright picture.
    pub(crate) fn of_upright(&self, upright: Rect) -> Rect {
        self.orientation.inverse().place_rect(upright, self.orientation.applied_to(self.size))
    }

    /// Column and row of the upright picture that a pixel becomes.
    #[inline(always)]
    pub(crate) fn upright(&self, x: usize, y: usize) -> (usize, usize) {
        self.orientation.place(x, y, self.size)
    }

    /// Where the middle of a pixel lies once the lens is corrected, as shares of the width and height of the active area.
    pub(crate) fn share(&self, base: &Base, x: usize, y: usize) -> [f32; 2] {
        let area = base.capture.active_area;
        let middle = |origin: isize, at: usize| origin as f64 + (at as f64 + 0.5) * self.bin as f64;
        let at = [middle(self.origin.0, x), middle(self.origin.1, y)];
        let [x, y] = match &base.laid.warp {
            None => [at[0] - area.x as f64, at[1] - area.y as f64],
            Some(warp) => warp.corrected(at[0], at[1]),
        };
        [(x / area.width as f64) as f32, (y / area.height as f64) as f32]
    }

    /// Column and row of the frame at which a rectangle begins.
    pub(crate) fn corner(&self, rect: Rect) -> (isize, isize) {
        (self.origin.0 + (rect.x * self.bin) as isize, self.origin.1 + (rect.y * self.bin) as isize)
    }
}
