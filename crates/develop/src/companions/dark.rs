//! What a sensor gives without light, taken off: its pattern, glowing corners, and pixels that are too hot to be mended by that.

use darkroot_photo::{Capture, Counts, Layout, Mosaic};
use rayon::prelude::*;

use super::{Medians, middle};
use crate::light::{LinearLight, channels};

/// Share of the range from black to white from which on a pixel is replaced: what it counts of light drowns in the noise of
/// what it counts without.
const HOT: f32 = 0.02;
/// Share of the white level from which on a sample is left as it is: it is full, and has to stay so.
const FULL: f32 = 0.99;
/// Rows that one task takes.
const ROWS: usize = 32;
/// How far samples of its own colour are looked for around a hot pixel.
const AROUND: isize = 4;
/// Of so many of the nearest the median is taken.
const NEAREST: usize = 8;

/// A sample that integers or floating point hold.
trait Sample: Copy + Into<f32> + Send + Sync {
    fn of(count: f32) -> Self;
}

impl Sample for u16 {
    fn of(count: f32) -> Self {
        count.round().clamp(0.0, 65535.0) as Self
    }
}

impl Sample for f32 {
    fn of(count: f32) -> Self {
        count
    }
}

/// Takes the median of dark frames, of which there is at least one, off a capture, and gives pixels that are hot in them the
/// median of the nearest samples of their colour. The frames [fit](super::fits) the capture. Samples that are full stay full.
///
/// Returns the number of pixels that were replaced.
pub fn take_off(capture: &mut Capture, frames: &[Capture]) -> usize {
    let lights: Vec<LinearLight> = frames.iter().map(LinearLight::of).collect();
    let black = capture.black.values.iter().fold(0f32, |a, &b| a.max(b));
    let white = capture.white.0;
    let frame = Frame { area_x: capture.active_area.x, black, white, frames, lights: &lights };
    let rows = capture.active_area.y..capture.active_area.bottom();
    match &mut capture.counts {
        Counts::U16(mosaic) => frame.take_off(mosaic, rows, capture.active_area.width),
        Counts::F32(mosaic) => frame.take_off(mosaic, rows, capture.active_area.width),
    }
}

/// What every row needs.
struct Frame<'a> {
    area_x: usize,
    black: f32,
    white: [f32; 3],
    frames: &'a [Capture],
    lights: &'a [LinearLight],
}

impl Frame<'_> {
    fn take_off<T: Sample>(
        &self,
        mosaic: &mut Mosaic<T>,
        rows: std::ops::Range<usize>,
        width: usize,
    ) -> usize {
        let (planes, stride) = (mosaic.layout.planes(), mosaic.size.width * mosaic.layout.planes());
        let layout = mosaic.layout.clone();
        let samples = width * planes;
        let of_rows = |(first, part): (usize, &mut [T])| {
            let mut medians = Medians::new(self.frames.len(), samples);
            let mut dark = vec![0f32; samples];
            let mut hot = Vec::new();
            for (row, counts) in part.chunks_exact_mut(stride).enumerate() {
                let y = rows.start + first * ROWS + row;
                let light = |i: usize, out: &mut [f32]| {
                    self.lights[i].levelled(&self.frames[i].counts, self.area_x, y, out);
                };
                medians.row(light, &mut dark);
                let channels = channels(&layout, self.area_x, y, 1);
                let begin = self.area_x * planes;
                for (i, dark) in dark.iter().enumerate() {
                    let white = self.white[channels[i % channels.len()]];
                    let count = &mut counts[begin + i];
                    if *dark > HOT {
                        hot.push(y * stride + begin + i);
                    } else if (*count).into() < FULL * white {
                        *count = T::of((*count).into() - dark * (white - self.black));
                    }
                }
            }
            hot
        };
        let part = &mut mosaic.samples[rows.start * stride..rows.end * stride];
        let hot: Vec<usize> = part.par_chunks_mut(ROWS * stride).enumerate().flat_map_iter(of_rows).collect();
        let area = Area { x: self.area_x..self.area_x + width, y: rows };
        let mended: Vec<Option<T>> = hot.par_iter().map(|i| around(mosaic, &area, &hot, *i)).collect();
        for (i, count) in hot.iter().zip(mended) {
            if let Some(count) = count {
                mosaic.samples[*i] = count;
            }
        }
        hot.len()
    }
}

/// Columns and rows on which light falls.
struct Area {
    x: std::ops::Range<usize>,
    y: std::ops::Range<usize>,
}

/// The median of the nearest samples of the colour of sample `i` that are not hot themselves; `hot` is in rising order.
fn around<T: Sample>(mosaic: &Mosaic<T>, area: &Area, hot: &[usize], i: usize) -> Option<T> {
    let planes = mosaic.layout.planes();
    let (pixel, plane) = (i / planes, i % planes);
    let (x, y) = (pixel % mosaic.size.width, pixel / mosaic.size.width);
    let filter = |x: usize, y: usize| match &mosaic.layout {
        Layout::Cfa(cfa) => Some(cfa.at(x, y)),
        Layout::Rgb | Layout::Monochrome => None,
    };
    let places = (-AROUND..=AROUND).flat_map(|dy| (-AROUND..=AROUND).map(move |dx| (dx, dy)));
    let mut found: Vec<(isize, f32)> = places
        .filter_map(|(dx, dy)| {
            let (u, v) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            let inside = area.x.contains(&u) && area.y.contains(&v) && (dx, dy) != (0, 0);
            let at = (v * mosaic.size.width + u) * planes + plane;
            let usable = inside && filter(u, v) == filter(x, y) && hot.binary_search(&at).is_err();
            usable.then(|| (dx * dx + dy * dy, mosaic.samples[at].into()))
        })
        .collect();
    found.sort_by_key(|(away, _)| *away);
    found.truncate(NEAREST);
    let mut values: Vec<f32> = found.into_iter().map(|(_, v)| v).collect();
    (!values.is_empty()).then(|| T::of(middle(&mut values)))
}
