//! From counts to linear light: the one way, for every part that looks at a capture.

use darkroot_colour::simd::vectorised;
use darkroot_photo::{Capture, Cfa, Correction, Counts, Layout, Rect};

use crate::corrections::{self, Run, is_supported};
use crate::level::Levels;

/// What turns the counts of one capture into linear light, prepared once.
#[derive(Debug, Clone)]
pub struct LinearLight {
    levels: Levels,
    /// DNG OpcodeList2, as far as it can be applied.
    corrections: Vec<Correction>,
    area: Rect,
    planes: usize,
    width: usize,
}

impl LinearLight {
    /// Prepares black level, white level and the corrections that the file carries for its samples.
    pub fn of(capture: &Capture) -> Self {
        Self {
            levels: Levels::new(capture),
            corrections: capture.mosaic_corrections.iter().filter(|c| is_supported(c)).cloned().collect(),
            area: capture.active_area,
            planes: capture.counts.layout().planes(),
            width: capture.counts.size().width,
        }
    }

    /// Linear light (0 = black, 1 = the white level) of the samples of row `y` from column `x` on, both in pixels of the
    /// frame and inside the active area; as many as `light` holds, whole pixels.
    pub fn row(&self, counts: &Counts, x: usize, y: usize, light: &mut [f32]) {
        self.levelled(counts, x, y, light);
        self.correct(x, y, light);
    }

    /// As [`row`](Self::row), before the file's corrections: where samples pile up, the converter ends.
    pub fn levelled(&self, counts: &Counts, x: usize, y: usize, light: &mut [f32]) {
        let first = x * self.planes;
        let start = y * self.width * self.planes + first;
        let end = start + light.len();
        let levels = &self.levels;
        match counts {
            Counts::U16(m) => vectorised(
                #[inline(always)]
                || levels.row(&m.samples[start..end], first, y, light),
            ),
            Counts::F32(m) => vectorised(
                #[inline(always)]
                || levels.row(&m.samples[start..end], first, y, light),
            ),
        }
    }

    /// Whether the file corrects its samples.
    pub fn is_corrected(&self) -> bool {
        !self.corrections.is_empty()
    }

    /// Applies the file's corrections to levelled samples of row `y` from column `x` on.
    pub fn correct(&self, x: usize, y: usize, light: &mut [f32]) {
        if !self.corrections.is_empty() {
            let (x, y) = (x - self.area.x, y - self.area.y);
            let run = Run { x, y, planes: self.planes, step: 1, active: self.area.size() };
            corrections::row(light, &self.corrections, run);
        }
    }
}

/// The colours (0 red, 1 green, 2 blue) of the samples of row `y` from column `x` on, after which they repeat. Filters
/// of other colours count as `other`; the one sample of a monochrome pixel as red.
pub(crate) fn channels(layout: &Layout, x: usize, y: usize, other: usize) -> Vec<usize> {
    match layout {
        Layout::Cfa(cfa) => (0..cfa.width()).map(|i| cfa.at(x + i, y).plane().unwrap_or(other)).collect(),
        Layout::Rgb => vec![0, 1, 2],
        Layout::Monochrome => vec![0],
    }
}

/// Columns and rows after which the samples' colours repeat.
pub(crate) fn period(layout: &Layout) -> (usize, usize) {
    match layout {
        Layout::Cfa(cfa) => (cfa.width(), cfa.height()),
        Layout::Monochrome | Layout::Rgb => (1, 1),
    }
}

/// The layout as seen from a place that may lie left of or above the frame.
pub(crate) fn layout_from(layout: &Layout, x: isize, y: isize) -> Layout {
    let from = |cfa: &Cfa| {
        let phase = |at: isize, period: usize| at.rem_euclid(period as isize) as usize;
        cfa.shifted(phase(x, cfa.width()), phase(y, cfa.height()))
    };
    match layout {
        Layout::Cfa(cfa) => Layout::Cfa(from(cfa)),
        other => other.clone(),
    }
}
