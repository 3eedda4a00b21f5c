//! Sizes, rectangles and orientations, in pixels.

use serde::{Deserialize, Serialize};

/// Width and height of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Size {
    /// Pixels in a row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

impl Size {
    /// Number of pixels.
    pub fn area(self) -> usize {
        self.width * self.height
    }

    /// Number of pixels in millions.
    pub fn megapixels(self) -> f64 {
        self.area() as f64 / 1e6
    }
}

/// A rectangle of pixels; the origin is the top left corner of the picture it lies in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rect {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

impl Rect {
    /// The whole of a picture.
    pub fn full(size: Size) -> Self {
        Self { x: 0, y: 0, width: size.width, height: size.height }
    }

    /// First column to the right of it.
    pub fn right(self) -> usize {
        self.x + self.width
    }

    /// First row below it.
    pub fn bottom(self) -> usize {
        self.y + self.height
    }

    /// Width and height.
    pub fn size(self) -> Size {
        Size { width: self.width, height: self.height }
    }

    /// Column and row of its middle; the middle of the first pixel is (0.5, 0.5).
    pub fn middle(self) -> [f64; 2] {
        [self.x as f64 + 0.5 * self.width as f64, self.y as f64 + 0.5 * self.height as f64]
    }

    /// The common part of two rectangles; `None` when there is none.
    pub fn intersection(self, other: Self) -> Option<Self> {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let (right, bottom) = (self.right().min(other.right()), self.bottom().min(other.bottom()));
        (right > x && bottom > y).then(|| Self { x, y, width: right - x, height: bottom - y })
    }
}

/// How the stored picture must be turned to stand upright (Exif 2.32, tag 0x0112).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Orientation {
    /// 1: as stored.
    #[default]
    Upright,
    /// 2: mirrored left to right.
    MirrorHorizontal,
    /// 3: turned by half a turn.
    Rotate180,
    /// 4: mirrored top to bottom.
    MirrorVertical,
    /// 5: mirrored about the diagonal from the top left.
    Transpose,
    /// 6: to be turned a quarter turn clockwise.
    Rotate90,
    /// 7: mirrored about the diagonal from the top right.
    Transverse,
    /// 8: to be turned a quarter turn anticlockwise.
    Rotate270,
}

impl Orientation {
    /// From the Exif value; anything outside 1..=8 counts as upright.
    pub fn from_exif(value: u32) -> Self {
        match value {
            2 => Self::MirrorHorizontal,
            3 => Self::Rotate180,
            4 => Self::MirrorVertical,
            5 => Self::Transpose,
            6 => Self::Rotate90,
            7 => Self::Transverse,
            8 => Self::Rotate270,
            _ => Self::Upright,
        }
    }

    /// The Exif value, 1..=8.
    pub fn exif(self) -> u16 {
        self as u16 + 1
    }

    /// Whether rows become columns.
    pub fn swaps_axes(self) -> bool {
        matches!(self, Self::Transpose | Self::Rotate90 | Self::Transverse | Self::Rotate270)
    }

    /// Size of the upright picture.
    pub fn applied_to(self, size: Size) -> Size {
        if self.swaps_axes() { Size { width: size.height, height: size.width } } else { size }
    }

    /// What turns a picture as this orientation does, and then as another.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        let size = Size { width: 2, height: 3 };
        let both = |x: usize, y: usize| {
            let (u, v) = self.place(x, y, size);
            next.place(u, v, self.applied_to(size))
        };
        // Two neighbouring corners tell orientations apart.
        let as_both =
            |one: &Self| [(0, 0), (1, 0)].into_iter().all(|(x, y)| one.place(x, y, size) == both(x, y));
        (1..=8).map(Self::from_exif).find(as_both).unwrap_or(self)
    }

    /// The orientation that undoes this one.
    #[must_use]
    pub fn inverse(self) -> Self {
        match self {
            Self::Rotate90 => Self::Rotate270,
            Self::Rotate270 => Self::Rotate90,
            own_inverse => own_inverse,
        }
    }

    /// Where a rectangle, of a pixel at least, that is stored in a picture of `size` stands in the upright picture.
    pub fn place_rect(self, rect: Rect, size: Size) -> Rect {
        let (x0, y0) = self.place(rect.x, rect.y, size);
        let (x1, y1) = self.place(rect.right() - 1, rect.bottom() - 1, size);
        Rect { x: x0.min(x1), y: y0.min(y1), width: x0.abs_diff(x1) + 1, height: y0.abs_diff(y1) + 1 }
    }

    /// Where the pixel stored at (`x`, `y`) in a picture of `size` stands in the upright picture.
    pub fn place(self, x: usize, y: usize, size: Size) -> (usize, usize) {
        let (right, bottom) = (size.width - 1 - x, size.height - 1 - y);
        match self {
            Self::Upright => (x, y),
            Self::MirrorHorizontal => (right, y),
            Self::Rotate180 => (right, bottom),
            Self::MirrorVertical => (x, bottom),
            Self::Transpose => (y, x),
            Self::Rotate90 => (bottom, x),
            Self::Transverse => (bottom, right),
            Self::Rotate270 => (y, right),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_clockwise_takes_the_top_left_to_the_top_right() {
        let size = Size { width: 3, height: 2 };
        assert_eq!(Orientation::Rotate90.place(0, 0, size), (1, 0));
        assert_eq!(Orientation::Rotate270.place(0, 0, size), (0, 2));
    }

    #[test]
    fn every_orientation_fills_the_upright_picture_once() {
        let size = Size { width: 3, height: 2 };
        for exif in 1..=8 {
            let orientation = Orientation::from_exif(exif);
            assert_eq!(u32::from(orientation.exif()), exif);
            let upright = orientation.applied_to(size);
            let mut seen = vec![false; size.area()];
            for y in 0..size.height {
                for x in 0..size.width {
                    let (u, v) = orientation.place(x, y, size);
                    assert_eq!(orientation.inverse().place(u, v, upright), (x, y));
                    seen[v * upright.width + u] = true;
                }
            }
            assert!(seen.iter().all(|&s| s), "{orientation:?}");
        }
    }

    #[test]
    fn rectangles_that_only_touch_have_nothing_in_common() {
        let left = Rect { x: 0, y: 0, width: 2, height: 2 };
        assert_eq!(left.intersection(Rect { x: 2, ..left }), None);
        assert_eq!(left.intersection(Rect { x: 1, ..left }), Some(Rect { x: 1, y: 0, width: 1, height: 2 }));
    }
}
