//! The stages that look at a pixel's neighbours: from the samples of the sensor to the balanced camera RGB of a part of the
//! picture.

use darkroot_photo::{CameraSpace, Mosaic, Rect, Rgb, Size};

use crate::base::Base;
use crate::demosaic::reduce::{self, Reduction};
use crate::demosaic::{self, debias};
use crate::denoise::{self, Denoiser, OfFrame};
use crate::geometry::{self, Warp, brighten, resample};
use crate::grid::Grid;
use crate::sharpen::{self, Sharpener};
use crate::stage::tile_border;
use crate::tile::{Levelled, covered, tile, tile_ends};
use crate::view::{Cancel, Cancelled, Scale};
use crate::{corrections, fringe, highlights, lateral};

/// The stages, made ready for one base at one scale.
pub(crate) struct Neighbourhood<'a> {
    base: &'a Base,
    /// The picture's pixels before they are turned upright.
    pub(crate) grid: Grid,
    /// Where those come from, where that is between pixels, and the grid of the frame that they are made of.
    warp: Option<(&'a Warp, Grid)>,
    /// Pixels around a tile that the mosaic has more than the picture that is made from it, and that that has more than
    /// the tile.
    border: usize,
    wider: usize,
    reduction: Option<Reduction>,
    /// What takes away noise, with what it knows of the frame.
    denoiser: Option<(&'a Denoiser, OfFrame)>,
    sharpener: Option<&'a Sharpener>,
}

/// What a thread works in, kept from one tile to the next.
pub(crate) struct Scratch {
    denoised: denoise::Scratch,
    mosaic: Mosaic<f32>,
    /// Where each sample of the mosaic clips, when the file's corrections make that differ.
    ends: Mosaic<f32>,
    camera: Rgb<CameraSpace>,
    /// The same before it is sharpened, and more of it.
    wide: Rgb<CameraSpace>,
    sharpened: sharpen::Scratch,
    aligned: lateral::Scratch,
    /// The picture, where it is not made of the frame's pixels as they are.
    warped: Rgb<CameraSpace>,
    mapped: geometry::Scratch,
}

impl<'a> Neighbourhood<'a> {
    /// For a rectangle of the upright picture.
    pub(crate) fn of(
        base: &'a Base,
        scale: Scale,
        upright: Rect,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let layout = base.capture.counts.layout();
        let reduction = (scale.bin() >= reduce::LEAST).then(|| Reduction::of(layout));
        let (grid, warp) = match &base.laid.warp {
            None => (Grid::of(base, scale), None),
            Some(warp) => {
                let of_picture = Grid::of_area(Rect::full(base.laid.size), scale);
                (of_picture, Some((warp, Grid::of_area(base.capture.active_area, scale))))
            }
        };
        let sharpener = base.sharpener.as_ref().filter(|_| reduction.is_none());
        let mut made = Self {
            base,
            grid,
            warp,
            border: tile_border(&base.changes(), &base.readers(scale)),
            wider: sharpener.map_or(0, |_| sharpen::STAGE.border),
            reduction,
            denoiser: None,
            sharpener,
        };
        if let Some(filter) = base.denoiser.as_ref().filter(|_| upright.size().area() > 0) {
            let rect = made.grid.of_upright(upright);
            let (begin, size) = match &made.warp {
                None => made.mosaic_of(&made.grid, rect),
                Some((warp, of_frame)) => {
                    made.mosaic_of(of_frame, warp.needs(&warp.places(rect, made.grid.bin), made.grid.bin))
                }
            };
            let needed = covered(&base.capture, begin, size);
            made.denoiser = Some((filter, filter.of_frame((&base.capture, &base.light), needed, cancel)?));
        }
        Ok(made)
    }

    /// Where the mosaic begins in the frame that a rectangle of its grid is made of, and its size.
    fn mosaic_of(&self, grid: &Grid, rect: Rect) -> ((isize, isize), Size) {
        let (x, y) = grid.corner(rect);
        let around = self.border + self.wider;
        let length = |count: usize| count * grid.bin + 2 * around;
        let size = Size { width: length(rect.width), height: length(rect.height) };
        ((x - around as isize, y - around as isize), size)
    }

    /// How many columns a tile best has, where so many would be best for pixels of the frame as they are. Twice as many where the
    /// lens is corrected: tiles overlap more then.
    pub(crate) fn columns(&self, columns: usize) -> usize {
        let corrects = self.warp.is_some() || self.base.lateral.is_some();
        let columns = if corrects { 2 * columns } else { columns };
        self.warp.as_ref().map_or(columns, |(warp, _)| warp.columns(columns))
    }

    pub(crate) fn scratch(&self) -> Scratch {
        let nothing = Size { width: 0, height: 0 };
        let layout = self.base.capture.counts.layout().clone();
        Scratch {
            denoised: denoise::Scratch::default(),
            mosaic: Mosaic { size: nothing, layout: layout.clone(), samples: Vec::new() },
            ends: Mosaic { size: nothing, layout, samples: Vec::new() },
            camera: Rgb::black(nothing),
            wide: Rgb::black(nothing),
            sharpened: sharpen::Scratch::default(),
            aligned: lateral::Scratch::default(),
            warped: Rgb::black(nothing),
            mapped: geometry::Scratch::default(),
        }
    }

    /// Balanced camera RGB of a rectangle of the grid.
    pub(crate) fn camera<'s>(&self, rect: Rect, scratch: &'s mut Scratch) -> &'s Rgb<CameraSpace> {
        let Some((warp, of_frame)) = &self.warp else {
            self.stages(&self.grid, rect, scratch);
            return &scratch.camera;
        };
        let places = warp.places(rect, self.grid.bin);
        let source = warp.needs(&places, self.grid.bin);
        self.stages(of_frame, source, scratch);
        let Scratch { camera, warped, mapped, .. } = scratch;
        resample(warp, (camera, source), &places, rect, mapped, warped);
        warped
    }

    /// The pipeline, for one rectangle of the frame's grid.
    fn stages(&self, grid: &Grid, rect: Rect, scratch: &mut Scratch) {
        let (base, border, bin) = (self.base, self.border, grid.bin);
        let Scratch { denoised, mosaic, ends, camera, wide, sharpened, aligned, .. } = scratch;
        let (x, y) = grid.corner(rect);
        let (begin, size) = self.mosaic_of(grid, rect);
        let (capture, light) = (&*base.capture, &*base.light);
        let levelled: &Levelled<'_> = match &self.denoiser {
            None => &|x, y, row| base.mends.levelled(capture, light, (x, y), row),
            Some((filter, of_frame)) => {
                filter.denoise((capture, light), of_frame, covered(capture, begin, size), denoised);
                &|x, y, row| denoised.row(x, y, row)
            }
        };
        tile(capture, (light, levelled), base.multipliers, begin, size, mosaic);
        tile_ends(base, begin, size, ends);
        highlights::treat(mosaic, begin, &base.highlights, &ends.samples);
        if let Some(lateral) = &base.lateral {
            lateral::align(mosaic, begin, lateral, aligned);
        }
        match &self.reduction {
            Some(reduction) => reduction.reduce(mosaic, border, bin, begin, camera),
            None => {
                let interpolated = if self.sharpener.is_some() { &mut *wide } else { &mut *camera };
                demosaic::demosaic(mosaic, base.demosaic, border, interpolated);
                debias::debias(mosaic, border, &base.noise, interpolated);
                fringe::cut(mosaic, border, &base.highlights, interpolated);
                if let Some(sharpener) = self.sharpener {
                    sharpen::sharpen(wide, sharpener, sharpened, camera);
                }
                if bin > 1 {
                    *camera = reduce::mean(camera, bin);
                }
            }
        }
        if !base.picture_corrections.is_empty() {
            let area = base.capture.active_area;
            // The middle of each pixel.
            let inside = |v: isize, start: usize| (v - start as isize).max(0) as usize + (bin - 1) / 2;
            let at = (inside(x, area.x), inside(y, area.y));
            corrections::picture(camera, &base.picture_corrections, at, bin, area.size());
        }
        if let Some((lens, middle)) = &base.laid.vignetting {
            let from_middle = |v: isize, middle: f64| v as f64 + 0.5 * bin as f64 - middle;
            brighten(camera, lens, [from_middle(x, middle[0]), from_middle(y, middle[1])], bin);
        }
    }
}
