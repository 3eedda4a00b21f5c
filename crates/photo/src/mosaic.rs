//! Samples as the sensor gives them.

use serde::{Deserialize, Serialize};

use crate::Size;

/// Colour of one filter of a colour filter array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Filter {
    /// Red; plane 0.
    Red,
    /// Green; plane 1.
    Green,
    /// Blue; plane 2.
    Blue,
    /// Any other filter (cyan, emerald, none, ...), by its letter. Such sensors decode but do not develop.
    Other(char),
}

impl Filter {
    /// Plane of an RGB picture that this filter samples: 0, 1, 2; `None` for other filters.
    pub fn plane(self) -> Option<usize> {
        match self {
            Self::Red => Some(0),
            Self::Green => Some(1),
            Self::Blue => Some(2),
            Self::Other(_) => None,
        }
    }

    /// One letter: R, G, B or that of the other filter.
    pub fn letter(self) -> char {
        match self {
            Self::Red => 'R',
            Self::Green => 'G',
            Self::Blue => 'B',
            Self::Other(letter) => letter,
        }
    }
}

/// A repeating colour filter array; its first filter lies over the first stored sample.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cfa {
    width: usize,
    height: usize,
    filters: Vec<Filter>,
}

impl Cfa {
    /// An array of `width` columns that repeats; `filters` row by row. `None` unless it is a full rectangle.
    pub fn new(width: usize, filters: Vec<Filter>) -> Option<Self> {
        let whole = width > 0 && !filters.is_empty() && filters.len().is_multiple_of(width);
        whole.then(|| Self { width, height: filters.len() / width, filters })
    }

    /// A Bayer array by the letters of its 2x2 block, row by row ("RGGB"), or any square array by its letters.
    pub fn parse(letters: &str) -> Option<Self> {
        let filters: Vec<Filter> = letters
            .chars()
            .filter(char::is_ascii_alphabetic)
            .map(|c| match c.to_ascii_uppercase() {
                'R' => Filter::Red,
                'G' => Filter::Green,
                'B' => Filter::Blue,
                other => Filter::Other(other),
            })
            .collect();
        let width = filters.len().isqrt();
        (width * width == filters.len()).then(|| Self::new(width, filters)).flatten()
    }

    /// Columns after which it repeats.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows after which it repeats.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Filter over the sample in column `x` of row `y`.
    pub fn at(&self, x: usize, y: usize) -> Filter {
        self.filters[(y % self.height) * self.width + x % self.width]
    }

    /// Column and row of the first place with a filter, row by row.
    pub fn first(&self, filter: Filter) -> Option<(usize, usize)> {
        let i = self.filters.iter().position(|f| *f == filter)?;
        Some((i % self.width, i / self.width))
    }

    /// The array as seen from (`x`, `y`) on.
    #[must_use]
    pub fn shifted(&self, x: usize, y: usize) -> Self {
        let filters =
            (0..self.filters.len()).map(|i| self.at(x + i % self.width, y + i / self.width)).collect();
        Self { filters, ..*self }
    }

    /// Two greens on one diagonal, red and blue on the other.
    pub fn is_bayer(&self) -> bool {
        let same_diagonal = |a: Filter, b: Filter| a == Filter::Green && b == Filter::Green;
        let red_and_blue = |a: Filter, b: Filter| {
            matches!((a, b), (Filter::Red, Filter::Blue) | (Filter::Blue, Filter::Red))
        };
        match self.filters[..] {
            [a, b, c, d] if self.width == 2 => {
                same_diagonal(a, d) && red_and_blue(b, c) || same_diagonal(b, c) && red_and_blue(a, d)
            }
            _ => false,
        }
    }

    /// A 6x6 array of 20 green, 8 red and 8 blue filters (Fujifilm X-Trans).
    pub fn is_xtrans(&self) -> bool {
        let count = |f: Filter| self.filters.iter().filter(|&&g| g == f).count();
        self.width == 6
            && self.height == 6
            && (count(Filter::Green), count(Filter::Red), count(Filter::Blue)) == (20, 8, 8)
    }

    /// Whether red, green and blue filters are all there and no others.
    pub fn is_rgb(&self) -> bool {
        (0..3).all(|plane| self.filters.iter().any(|f| f.plane() == Some(plane)))
            && self.filters.iter().all(|f| f.plane().is_some())
    }
}

impl std::fmt::Display for Cfa {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, row) in self.filters.chunks(self.width).enumerate() {
            if i > 0 && self.width > 2 {
                f.write_str("/")?;
            }
            f.write_str(&row.iter().map(|f| f.letter()).collect::<String>())?;
        }
        Ok(())
    }
}

/// What the samples of a mosaic stand for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Layout {
    /// One sample a pixel, under a colour filter array.
    Cfa(Cfa),
    /// One sample a pixel, no filters.
    Monochrome,
    /// Three samples a pixel, R, G, B side by side (linear DNG, sRAW).
    Rgb,
}

impl Layout {
    /// Samples a pixel: 1 or 3.
    pub fn planes(&self) -> usize {
        match self {
            Self::Cfa(_) | Self::Monochrome => 1,
            Self::Rgb => 3,
        }
    }
}

/// A frame of sensor samples, row by row, including any masked border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mosaic<T> {
    /// Size in pixels.
    pub size: Size,
    /// What the samples stand for.
    pub layout: Layout,
    /// `size.area() * layout.planes()` samples, row by row, the samples of a pixel side by side.
    pub samples: Vec<T>,
}

/// Samples as decoded, before black level and white level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Counts {
    /// Integer counts (nearly every file).
    U16(Mosaic<u16>),
    /// Floating-point samples (some DNG files).
    F32(Mosaic<f32>),
}

impl Counts {
    /// Size of the frame in pixels.
    pub fn size(&self) -> Size {
        match self {
            Self::U16(m) => m.size,
            Self::F32(m) => m.size,
        }
    }

    /// What the samples stand for.
    pub fn layout(&self) -> &Layout {
        match self {
            Self::U16(m) => &m.layout,
            Self::F32(m) => &m.layout,
        }
    }

    /// Number of samples that are there: none in what was read of a header alone.
    pub fn samples(&self) -> usize {
        match self {
            Self::U16(m) => m.samples.len(),
            Self::F32(m) => m.samples.len(),
        }
    }

    /// Whether there are as many samples as the size and the layout ask for, or none, and the layout is one.
    pub fn is_sound(&self) -> bool {
        let size = self.size();
        let whole = size.width.checked_mul(size.height).and_then(|n| n.checked_mul(self.layout().planes()));
        let is_layout = match self.layout() {
            Layout::Cfa(cfa) => Cfa::new(cfa.width, cfa.filters.clone()).is_some(),
            Layout::Monochrome | Layout::Rgb => true,
        };
        is_layout && whole.is_some_and(|whole| [0, whole].contains(&self.samples()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_phases_of_bayer_are_bayer() {
        let rggb = Cfa::parse("RGGB").unwrap();
        for (x, y, name) in [(0, 0, "RGGB"), (1, 0, "GRBG"), (0, 1, "GBRG"), (1, 1, "BGGR")] {
            let shifted = rggb.shifted(x, y);
            assert!(shifted.is_bayer() && shifted.is_rgb());
            assert_eq!(shifted.to_string(), name);
        }
        assert!(!Cfa::parse("RGBG").unwrap().is_bayer());
        assert!(!Cfa::parse("RGBE").unwrap().is_rgb());
    }

    #[test]
    fn x_trans_is_known_by_its_counts() {
        assert!(Cfa::parse("GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG").unwrap().is_xtrans());
    }

    #[test]
    fn an_array_that_is_no_rectangle_is_refused() {
        assert_eq!(Cfa::new(2, vec![Filter::Red; 3]), None);
        assert_eq!(Cfa::new(0, vec![]), None);
    }
}
