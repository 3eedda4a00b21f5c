//! What is wrong with samples, found once for a frame and put right where its light is read: hot and dead pixels
//! (`hot_pixels.rs`), rows that lie too high or too low (`banding.rs`), and greens that differ (`greens.rs`). For Bayer sensors.

mod banding;
mod greens;
mod hot_pixels;
mod masked;

use darkroot_photo::{Capture, Cfa, Layout};

use crate::denoise::{Measured, NoiseModel};
use crate::light::{LinearLight, layout_from};
use banding::Banding;

/// What to put right in levelled light.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Mends {
    /// Index of a sample in the frame, in rising order, and its light.
    pixels: Vec<(usize, f32)>,
    /// Columns of the frame.
    width: usize,
    /// Factors of the greens in even and in odd rows of the frame, and the columns on which they lie.
    greens: Option<[(usize, f32); 2]>,
    /// The first row of the active area, and the offsets of its rows.
    banding: Option<(usize, Banding)>,
}

/// What is looked for; greens always are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wanted {
    pub(crate) hot_pixels: bool,
    pub(crate) banding: bool,
}

impl Mends {
    /// Looks for what is wrong.
    pub(crate) fn of(
        (capture, light): (&Capture, &LinearLight),
        (model, measured): (&NoiseModel, &Measured),
        wanted: Wanted,
    ) -> Self {
        let Some(cfa) = bayer(capture) else { return Self::default() };
        let area = capture.active_area;
        let of_area = cfa.shifted(area.x % 2, area.y % 2);
        let greens = greens::factors(measured, &of_area).map(|factors| {
            let green_column = |row: usize| usize::from(cfa.at(0, row).plane() != Some(1));
            [0, 1].map(|row| (green_column(row), factors[(row + area.y) % 2]))
        });
        let pixels = wanted.hot_pixels.then(|| hot_pixels::found(capture, light, model, &of_area));
        let banding = wanted.banding.then(|| banding::found(capture, light, model, &of_area)).flatten();
        Self {
            pixels: pixels.unwrap_or_default(),
            width: capture.counts.size().width,
            greens,
            banding: banding.map(|banding| (area.y, banding)),
        }
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
        let banding = self.banding().map(|strength| {
            format!("banding of rows, {:.0} % of the noise of dark samples, is taken away", 100.0 * strength)
        });
        pixels.into_iter().chain(greens).chain(banding).collect()
    }

    /// Standard deviation of the offsets of rows against that of the noise of dark samples, where there are any.
    pub(crate) fn banding(&self) -> Option<f32> {
        self.banding.as_ref().map(|(_, banding)| banding.strength)
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
        if let Some((top, banding)) = &self.banding {
            let offset = y.checked_sub(*top).and_then(|y| banding.offsets.get(y)).copied().unwrap_or(0.0);
            for v in light.iter_mut() {
                *v -= offset;
            }
        }
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
mod banding_tests;
#[cfg(test)]
mod tests;
