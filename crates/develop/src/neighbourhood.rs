//! The stages that look at a pixel's neighbours: from the samples of the sensor to the balanced camera RGB of a part of the
//! picture.

use std::sync::Arc;

use darkroot_photo::{CameraSpace, Mosaic, Rect, Rgb, Size};

use crate::base::Base;
use crate::demosaic::reduce::{self, Reduction};
use crate::demosaic::{self, debias};
use crate::denoise::{self, Coarse, Denoiser};
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
    /// What takes away noise, with that of the coarse scales.
    denoiser: Option<(&'a Denoiser, Arc<Coarse>)>,
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
    pub(crate) fn of(base: &'a Base, scale: Scale, cancel: &Cancel) -> Result<Self, Cancelled> {
        let layout = base.capture.counts.layout();
        let coarse =
            |filter: &'a Arc<Denoiser>| Ok((&**filter, filter.coarse(&base.capture, &base.light, cancel)?));
        let reduction = (scale.bin() >= reduce::LEAST).then(|| Reduction::of(layout));
        let (grid, warp) = match &base.laid.warp {
            None => (Grid::of(base, scale), None),
            Some(warp) => {
                let of_picture = Grid::of_area(Rect::full(base.laid.size), scale);
                (of_picture, Some((warp, Grid::of_area(base.capture.active_area, scale))))
            }
        };
        let sharpener = base.sharpener.as_ref().filter(|_| reduction.is_none());
        Ok(Self {
            base,
            grid,
            warp,
            border: tile_border(&base.changes(), &base.readers(scale)),
            wider: sharpener.map_or(0, |_| sharpen::STAGE.border),
            reduction,
            denoiser: base.denoiser.as_ref().map(coarse).transpose()?,
            sharpener,
        })
    }

    /// How many columns a tile best has, where so many would be best for pixels of the frame as they are.
    pub(crate) fn columns(&self, columns: usize) -> usize {
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
        let around = border + self.wider;
        let size = Size { width: rect.width * bin + 2 * around, height: rect.height * bin + 2 * around };
        let begin = (x - around as isize, y - around as isize);
        let (capture, light) = (&*base.capture, &*base.light);
        let levelled: &Levelled<'_> = match &self.denoiser {
            None => &|x, y, row| base.mends.levelled(capture, light, (x, y), row),
            Some((filter, coarse)) => {
                filter.denoise((capture, light), coarse, covered(capture, begin, size), denoised);
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
