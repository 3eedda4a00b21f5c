//! From balanced camera RGB on every stage looks at one pixel: a few rows go through all of them while they stay in the
//! nearest cache.

use darkroot_photo::{CameraSpace, Display, Orientation, Rect, Rgb, Scene, Size};

use crate::gamut::Mapping;
use crate::grid::Grid;
use crate::plan::Plan;
use crate::recipe::OutputSpace;
use crate::shown::Shown;
use crate::transfer::{self, Sample};
use crate::{balance, correct, exposure, gamut, highlights, local_tone, lut, tally, tone};

/// Pixels that go through the stages together.
const PIXELS: usize = 2048;

/// What the stages work in.
pub(crate) struct Finish<T> {
    strip: Rgb<CameraSpace>,
    row: Vec<T>,
}

impl<T: Sample> Finish<T> {
    pub(crate) fn new() -> Self {
        Self { strip: Rgb::black(Size { width: 0, height: 0 }), row: Vec::new() }
    }

    /// Finishes a tile, which lies at `rect` of the grid, and writes it into its band of the upright picture. `camera` is the
    /// light of a part of the grid, `held`, in which the tile lies.
    pub(crate) fn tile(
        &mut self,
        plan: &Plan,
        grid: &Grid,
        (camera, held): (&Rgb<CameraSpace>, Rect),
        rect: Rect,
        (band_rect, band): (Rect, &mut [T]),
    ) {
        let rows = (PIXELS / rect.width.max(1)).max(1);
        for top in (0..rect.height).step_by(rows) {
            let size = Size { width: rect.width, height: rows.min(rect.height - top) };
            let mut strip = std::mem::replace(&mut self.strip, Rgb::black(Size { width: 0, height: 0 }));
            strip.resize(size);
            for (out, plane) in strip.planes_mut().into_iter().zip(camera.planes()) {
                for (y, out) in out.chunks_exact_mut(size.width).enumerate() {
                    let at = (rect.y - held.y + top + y) * held.width + rect.x - held.x;
                    out.copy_from_slice(&plane[at..][..size.width]);
                }
            }
            let place =
                |i: usize| grid.share(&plan.base, rect.x + i % size.width, rect.y + top + i / size.width);
            let display = stages(strip, plan, place);
            for y in 0..size.height {
                let planes = display.planes().map(|plane| &plane[y * size.width..][..size.width]);
                let start =
                    |(u, v): (usize, usize)| ((v - band_rect.y) * band_rect.width + u - band_rect.x) * 3;
                let at = |x: usize| start(grid.upright(rect.x + x, rect.y + top + y));
                if grid.orientation == Orientation::Upright {
                    let at = at(0);
                    transfer::encode(planes, &plan.encoder, &mut band[at..at + 3 * size.width]);
                } else {
                    self.row.resize(3 * size.width, T::default());
                    transfer::encode(planes, &plan.encoder, &mut self.row);
                    for (x, pixel) in self.row.chunks_exact(3).enumerate() {
                        let at = at(x);
                        band[at..at + 3].copy_from_slice(pixel);
                    }
                }
            }
            self.strip = display.into_space();
        }
    }
}

/// All stages of one pixel but the last. `place` tells where a pixel lies in the active area, by its number.
fn stages(camera: Rgb<CameraSpace>, plan: &Plan, place: impl Fn(usize) -> [f32; 2]) -> Rgb<Display> {
    let Some(model) = &plan.model else {
        if plan.space == OutputSpace::Raw {
            return balance::undo(camera, plan.base.multipliers).into_space();
        }
        return exposure::expose(camera.into_space::<Scene>(), plan.gain).into_space();
    };
    let whitening = highlights::Whitening::of(&camera, &plan.base.highlights);
    let mut scene = correct::correct(exposure::darken(camera, plan.veil), model);
    highlights::whiten(&mut scene, &whitening);
    if let Some(local) = &plan.local_tone {
        local_tone::brighten(&mut scene, local, place);
    }
    let scene = exposure::expose(scene, plan.gain);
    let primaries = &plan.primaries;
    let shown = |scene, look: &Shown| {
        let toned = match look {
            Shown::Curve(curve) => tone::tone(scene, curve),
            Shown::Profile(look) => tone::show(scene, look),
        };
        plan.lut.iter().fold(toned, lut::look_up)
    };
    match (&plan.shown, plan.gamut) {
        (Some(look), Mapping::Mapped) => gamut::fit(shown(scene, look), primaries),
        (Some(look), _) => tally::clip(gamut::unfitted(shown(scene, look), primaries), &plan.tally),
        (None, Mapping::Mapped) => gamut::fit(gamut::untoned(scene, primaries), primaries),
        (None, Mapping::Clipped) => tally::clip(gamut::convert(scene, primaries), &plan.tally),
        (None, Mapping::Kept) => gamut::convert(scene, primaries),
    }
}
