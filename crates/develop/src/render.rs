//! Runs the stages over tiles, in parallel, and puts the finished tiles upright into bands of one picture.

use std::sync::{Mutex, PoisonError};

use darkroot_photo::{CameraSpace, Mosaic, Picture, PictureSpace, Rect, Rgb, Samples, Size};

use crate::demosaic::reduce::{self, Reduction};
use crate::demosaic::{self, Method, debias};
use crate::denoise::{self, Denoiser, OfFrame};
use crate::finish::Finish;
use crate::geometry::{self, Warp, brighten, resample};
use crate::grid::Grid;
use crate::highlights::{self, Treatment};
use crate::in_turn::in_turn;
use crate::plan::Plan;
use crate::recipe::{Bits, OutputSpace};
use crate::sharpen::{self, Sharpener};
use crate::stage::{Stage, tile_border};
use crate::tile::{Levelled, covered, tile, tile_ends};
use crate::transfer::Sample;
use crate::view::{Cancel, Cancelled, Scale, View};
use crate::{corrections, fringe, lateral};

/// Rows of the sensor that one task looks at.
const BAND_ROWS: usize = 192;
/// Columns of a tile within a band.
const TILE_COLUMNS: usize = 256;

impl Plan {
    /// The whole picture at a scale.
    pub fn whole(&self, scale: Scale) -> View {
        View { scale, rect: Rect::full(self.size_at(scale)) }
    }

    /// Develops a view of the picture. A rectangle at full scale is, bit for bit, that rectangle of the whole picture.
    ///
    /// # Errors
    /// Somebody cancelled it.
    pub fn render(&self, view: View, cancel: &Cancel) -> Result<Picture, Cancelled> {
        let bin = view.scale.bin();
        self.render_in_tiles(view, cancel, TILE_COLUMNS.div_ceil(bin), BAND_ROWS.div_ceil(bin))
    }

    /// As [`Plan::render`], in tiles of another size. The picture is the same.
    ///
    /// # Errors
    /// Somebody cancelled it.
    pub fn render_in_tiles(
        &self,
        view: View,
        cancel: &Cancel,
        columns: usize,
        rows: usize,
    ) -> Result<Picture, Cancelled> {
        let render = Render::of(self, view, cancel, columns)?;
        let samples = match self.bits {
            Bits::Eight => Samples::U8(render.picture(rows)?),
            Bits::Sixteen => Samples::U16(render.picture(rows)?),
            Bits::Float => Samples::F32(render.picture(rows)?),
        };
        Ok(Picture { size: render.rect.size(), samples, space: self.picture_space() })
    }

    /// Develops a view band by band: `take` gets each band of so many rows (the last one may have fewer) as soon as it is
    /// finished, on the thread that made it: its number, from the top, and the R, G, B of its pixels, row by row. The
    /// picture as a whole is nowhere. Bands come nearly in order.
    ///
    /// # Errors
    /// Somebody cancelled it, or `take` failed.
    pub fn render_bands<T: Sample, E: From<Cancelled> + Send>(
        &self,
        view: View,
        cancel: &Cancel,
        rows: usize,
        take: impl Fn(usize, &[T]) -> Result<(), E> + Sync,
    ) -> Result<(), E> {
        let render = Render::of(self, view, cancel, TILE_COLUMNS.div_ceil(view.scale.bin()))?;
        let failure = Mutex::new(None);
        // Inside there is one type of error only, so that the stages are compiled once.
        let rendered = T::render(&render, rows, &|band, samples| {
            take(band, samples).map_err(|e| {
                *failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(e);
                Cancelled
            })
        });
        match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(e) => Err(e),
            None => Ok(rendered?),
        }
    }

    /// What the samples of its picture mean.
    pub fn picture_space(&self) -> PictureSpace {
        match self.space {
            OutputSpace::Rgb(space) => PictureSpace::Rgb(space),
            OutputSpace::Camera => PictureSpace::Camera,
        }
    }

    /// Stages that change the mosaic before it becomes a picture.
    fn changes(&self) -> Vec<Stage> {
        let rebuilds = matches!(self.highlights, Treatment::Rebuild(_)) && self.demosaic != Method::None;
        let aligns = self.lateral.as_ref().map(lateral::stage);
        rebuilds.then_some(highlights::STAGE).into_iter().chain(aligns).collect()
    }

    /// Stages that read the changed mosaic.
    fn readers(&self, scale: Scale) -> Vec<Stage> {
        match (self.demosaic, scale) {
            (Method::None, _) => Vec::new(),
            (_, scale) if scale.bin() >= reduce::LEAST => vec![reduce::STAGE],
            (method, _) => vec![method.stage(), debias::STAGE, fringe::STAGE],
        }
    }
}

/// Takes a finished band, as [`Plan::render_bands`] says, and may stop the rendering.
pub(crate) type TakeBand<'a, T> = dyn Fn(usize, &[T]) -> Result<(), Cancelled> + Sync + 'a;

/// One rendering: which rectangle of the upright picture, in tiles of how many columns.
pub struct Render<'a> {
    plan: &'a Plan,
    grid: Grid,
    /// Where the picture's pixels come from, and the grid that those are, where that is not the frame's.
    warp: Option<(&'a Warp, Grid)>,
    /// Pixels around a tile that the mosaic has more than the picture that is made from it, and that that has more than
    /// the tile.
    border: usize,
    wider: usize,
    reduction: Option<Reduction>,
    rect: Rect,
    columns: usize,
    /// What takes away noise, with what it knows of the frame.
    denoiser: Option<(&'a Denoiser, OfFrame)>,
    sharpener: Option<&'a Sharpener>,
    cancel: &'a Cancel,
}

/// What a thread works in, kept from one tile to the next.
struct Scratch<T> {
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
    finish: Finish<T>,
}

impl<'a> Render<'a> {
    fn of(plan: &'a Plan, view: View, cancel: &'a Cancel, columns: usize) -> Result<Self, Cancelled> {
        let nothing = Rect { width: 0, height: 0, ..view.rect };
        let rect = view.rect.intersection(plan.whole(view.scale).rect).unwrap_or(nothing);
        let layout = plan.capture.counts.layout();
        let reduction = (view.scale.bin() >= reduce::LEAST).then(|| Reduction::of(layout));
        let (grid, warp, columns) = match &plan.laid.warp {
            None => (Grid::of(plan, view.scale), None, columns),
            Some(warp) => {
                let of_picture = Grid::of_area(Rect::full(plan.laid.size), view.scale);
                let of_frame = Grid::of_area(plan.capture.active_area, view.scale);
                (of_frame, Some((warp, of_picture)), warp.columns(columns))
            }
        };
        let sharpener = plan.sharpener.as_ref().filter(|_| reduction.is_none());
        let mut render = Self {
            plan,
            grid,
            warp,
            border: tile_border(&plan.changes(), &plan.readers(view.scale)),
            wider: sharpener.map_or(0, |_| sharpen::STAGE.border),
            reduction,
            rect,
            columns: columns.clamp(1, rect.width.max(1)),
            denoiser: None,
            sharpener,
            cancel,
        };
        if let Some(filter) = plan.denoiser.as_ref().filter(|_| rect.size().area() > 0) {
            let (begin, size) = render.mosaic_of(render.source_of(rect));
            let needed = covered(&plan.capture, begin, size);
            render.denoiser = Some((filter, filter.of_frame((&plan.capture, &plan.light), needed, cancel)?));
        }
        Ok(render)
    }

    /// The rectangle of the grid that a rectangle of the upright picture is made of.
    fn source_of(&self, upright: Rect) -> Rect {
        match &self.warp {
            Some((warp, grid)) => warp.needs(&warp.places(upright, grid.bin), grid.bin),
            None => self.grid.of_upright(upright),
        }
    }

    /// Where the mosaic begins in the frame that a rectangle of the grid is made of, and its size.
    fn mosaic_of(&self, rect: Rect) -> ((isize, isize), Size) {
        let (x, y) = self.grid.corner(rect);
        let around = self.border + self.wider;
        let length = |count: usize| count * self.grid.bin + 2 * around;
        let size = Size { width: length(rect.width), height: length(rect.height) };
        ((x - around as isize, y - around as isize), size)
    }

    fn scratch<T: Sample>(&self) -> Scratch<T> {
        let nothing = Size { width: 0, height: 0 };
        let layout = self.plan.capture.counts.layout().clone();
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
            finish: Finish::new(),
        }
    }

    /// The whole rectangle, in bands of so many rows.
    fn picture<T: Sample>(&self, rows: usize) -> Result<Vec<T>, Cancelled> {
        let mut out = vec![T::default(); 3 * self.rect.size().area()];
        if out.is_empty() {
            return Ok(out);
        }
        let rows = rows.clamp(1, self.rect.height);
        let bands = out.chunks_mut(3 * self.rect.width * rows);
        let places = (self.rect.y..).step_by(rows);
        in_turn(places.zip(bands), || self.scratch(), |scratch, (y, band)| self.band(scratch, y, band))?;
        Ok(out)
    }

    /// The same, handed on band by band.
    pub(crate) fn bands<T: Sample>(&self, rows: usize, take: &TakeBand<'_, T>) -> Result<(), Cancelled> {
        let places = (self.rect.y..self.rect.bottom()).step_by(rows.max(1)).enumerate();
        let scratch = || (self.scratch(), Vec::new());
        in_turn(places, scratch, |(scratch, band), (i, y)| {
            band.resize(3 * self.rect.width * rows.min(self.rect.bottom() - y), T::default());
            self.band(scratch, y, band)?;
            take(i, band)
        })
    }

    /// Fills a band of the picture that begins at row `y`.
    fn band<T: Sample>(&self, scratch: &mut Scratch<T>, y: usize, band: &mut [T]) -> Result<(), Cancelled> {
        let band_rect = Rect { y, height: band.len() / (3 * self.rect.width), ..self.rect };
        for x in (0..self.rect.width).step_by(self.columns) {
            if self.cancel.is_cancelled() {
                return Err(Cancelled);
            }
            let width = self.columns.min(self.rect.width - x);
            let upright = Rect { x: self.rect.x + x, width, ..band_rect };
            if let Some((warp, grid)) = &self.warp {
                let places = warp.places(upright, grid.bin);
                let source = warp.needs(&places, grid.bin);
                self.neighbourhood_stages(source, scratch);
                let Scratch { camera, warped, mapped, .. } = &mut *scratch;
                resample(warp, (camera, source), &places, upright, mapped, warped);
                scratch.finish.tile(self.plan, grid, &scratch.warped, upright, (band_rect, band));
            } else {
                let rect = self.grid.of_upright(upright);
                self.neighbourhood_stages(rect, scratch);
                scratch.finish.tile(self.plan, &self.grid, &scratch.camera, rect, (band_rect, band));
            }
        }
        Ok(())
    }

    /// The pipeline down to camera RGB, for one rectangle of the grid.
    fn neighbourhood_stages<T>(&self, rect: Rect, scratch: &mut Scratch<T>) {
        let (plan, border, bin) = (self.plan, self.border, self.grid.bin);
        let Scratch { denoised, mosaic, ends, camera, wide, sharpened, aligned, .. } = scratch;
        let (x, y) = self.grid.corner(rect);
        let (begin, size) = self.mosaic_of(rect);
        let (capture, light) = (&*plan.capture, &*plan.light);
        let levelled: &Levelled<'_> = match &self.denoiser {
            None => &|x, y, row| plan.mends.levelled(capture, light, (x, y), row),
            Some((filter, of_frame)) => {
                filter.denoise((capture, light), of_frame, covered(capture, begin, size), denoised);
                &|x, y, row| denoised.row(x, y, row)
            }
        };
        tile(capture, (light, levelled), plan.multipliers, begin, size, mosaic);
        tile_ends(plan, begin, size, ends);
        highlights::treat(mosaic, begin, &plan.highlights, &ends.samples);
        if let Some(lateral) = &plan.lateral {
            lateral::align(mosaic, begin, lateral, aligned);
        }
        match &self.reduction {
            Some(reduction) => reduction.reduce(mosaic, border, bin, begin, camera),
            None => {
                let interpolated = if self.sharpener.is_some() { &mut *wide } else { &mut *camera };
                demosaic::demosaic(mosaic, plan.demosaic, border, interpolated);
                debias::debias(mosaic, border, &plan.noise, interpolated);
                fringe::cut(mosaic, border, &plan.highlights, interpolated);
                if let Some(sharpener) = self.sharpener {
                    sharpen::sharpen(wide, sharpener, sharpened, camera);
                }
                if bin > 1 {
                    *camera = reduce::mean(camera, bin);
                }
            }
        }
        if !plan.picture_corrections.is_empty() {
            let area = plan.capture.active_area;
            // The middle of each pixel.
            let inside = |v: isize, start: usize| (v - start as isize).max(0) as usize + (bin - 1) / 2;
            let at = (inside(x, area.x), inside(y, area.y));
            corrections::picture(camera, &plan.picture_corrections, at, bin, area.size());
        }
        if let Some((lens, middle)) = &plan.laid.vignetting {
            let from_middle = |v: isize, middle: f64| v as f64 + 0.5 * bin as f64 - middle;
            brighten(camera, lens, [from_middle(x, middle[0]), from_middle(y, middle[1])], bin);
        }
    }
}
