//! What is wrong with single samples, found once for a frame and put right where its light is read: hot and dead pixels
//! (`hot_pixels.rs`), and greens that differ (`greens.rs`). For Bayer sensors.

mod greens;
mod hot_pixels;

use darkroot_photo::{Capture, Cfa, Layout};

use crate::denoise::{Measured, NoiseModel};
use crate::light::{LinearLight, layout_from};

/// What to put right in levelled light.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Mends {
    /// Index of a sample in the frame, in rising order, and its light.
    pixels: Vec<(usize, f32)>,
    /// Columns of the frame.
    width: usize,
    /// Factors of the greens in even and in odd rows of the frame, and the columns on which they lie.
    greens: Option<[(usize, f32); 2]>,
}

impl Mends {
    /// Looks for what is wrong.
    pub(crate) fn of(
        capture: &Capture,
        light: &LinearLight,
        model: &NoiseModel,
        measured: &Measured,
    ) -> Self {
        let Some(cfa) = bayer(capture) else { return Self::default() };
        let of_area = cfa.shifted(capture.active_area.x % 2, capture.active_area.y % 2);
        let pixels = hot_pixels::found(capture, light, model, &of_area);
        Self { pixels, ..Self::of_greens(capture, measured) }
    }

    /// Looks at the greens only.
    pub(crate) fn of_greens(capture: &Capture, measured: &Measured) -> Self {
        let Some(cfa) = bayer(capture) else { return Self::default() };
        let area = capture.active_area;
        let greens = greens::factors(measured, &cfa.shifted(area.x % 2, area.y % 2)).map(|factors| {
            let green_column = |row: usize| usize::from(cfa.at(0, row).plane() != Some(1));
            [0, 1].map(|row| (green_column(row), factors[(row + area.y) % 2]))
        });
        Self { pixels: Vec::new(), width: capture.counts.size().width, greens }
    }

    /// In words.
    pub(crate) fn notes(&self) -> Vec<String> {
        let pixels = (!self.pixels.is_empty()).then(|| {
            format!("hot or dead pixels that take the light of those around them: {}", self.pixels())
        });
        let greens = self.greens().map(|factor| {
            format!(
                "the greens of odd and even rows differ by {:.1} % and are made alike",
                100.0 * (factor - 1.0).abs()
            )
        });
        pixels.into_iter().chain(greens).collect()
    }

    /// Number of pixels that are replaced.
    pub(crate) fn pixels(&self) -> usize {
        self.pixels.len()
    }

    /// Factor of the greens in the first row of the active area against those in the second, where they differ.
    pub(crate) fn greens(&self) -> Option<f32> {
        self.greens.map(|[(_, even), (_, odd)]| even / odd)
    }

    /// Levelled light of row `y` of the frame from column `x` on, put right.
    pub(crate) fn levelled(
        &self,
        capture: &Capture,
        linear: &LinearLight,
        (x, y): (usize, usize),
        light: &mut [f32],
    ) {
        linear.levelled(&capture.counts, x, y, light);
        self.row(x, y, light);
    }

    /// Puts levelled light of row `y` of the frame right, which begins at column `x`.
    fn row(&self, x: usize, y: usize, light: &mut [f32]) {
        if let Some(greens) = self.greens {
            let (column, factor) = greens[y % 2];
            for v in light.iter_mut().skip((column + x) % 2).step_by(2) {
                *v *= factor;
            }
        }
        if self.pixels.is_empty() {
            return;
        }
        let begin = y * self.width + x;
        let end = begin + light.len();
        let first = self.pixels.partition_point(|(place, _)| *place < begin);
        for (place, v) in self.pixels[first..].iter().take_while(|(place, _)| *place < end) {
            light[place - begin] = *v;
        }
    }
}

/// The filters of a Bayer capture, from the frame's corner on.
fn bayer(capture: &Capture) -> Option<Cfa> {
    match layout_from(capture.counts.layout(), 0, 0) {
        Layout::Cfa(cfa) if cfa.is_bayer() => Some(cfa),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
