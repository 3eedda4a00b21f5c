//! Runs the stages over tiles, in parallel, and puts the finished tiles upright into bands of one picture.

use std::sync::{Arc, Mutex, PoisonError};

use darkroot_photo::{CameraSpace, Picture, PictureSpace, Rect, Rgb, Samples};

use crate::finish::Finish;
use crate::in_turn::in_turn;
use crate::kept::{Kept, Last};
use crate::neighbourhood::{self, Neighbourhood};
use crate::plan::Plan;
use crate::recipe::{Bits, OutputSpace};
use crate::transfer::Sample;
use crate::view::{Cancel, Cancelled, Scale, View};

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
        Render::of(self, view, cancel, columns)?.samples(rows)
    }

    /// As [`Plan::render`], for a view that is to be rendered again when a setting has moved: its camera RGB is kept. Where
    /// the one that is kept is of the same view, and no setting that has a say in it has changed, only the stages of single
    /// pixels are done. The picture is the same, bit for bit.
    ///
    /// # Errors
    /// Somebody cancelled it.
    pub fn render_again(&self, view: View, kept: &Kept, cancel: &Cancel) -> Result<Picture, Cancelled> {
        let bin = view.scale.bin();
        let (columns, rows) = (TILE_COLUMNS.div_ceil(bin), BAND_ROWS.div_ceil(bin));
        let mut render = Render::of(self, view, cancel, columns)?;
        if render.rect.size().area() <= Kept::LARGEST {
            render.kept = Some(match kept.of(&self.base, view) {
                Some(last) => last,
                None => kept.put(Last { base: self.base.clone(), view, camera: render.camera(rows)? }),
            });
        }
        render.samples(rows)
    }

    /// Whether [`Plan::render_again`] would take the camera RGB that is kept.
    pub fn is_kept(&self, view: View, kept: &Kept) -> bool {
        kept.of(&self.base, view).is_some()
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
            OutputSpace::Raw => PictureSpace::Raw,
        }
    }
}

/// Takes a finished band, as [`Plan::render_bands`] says, and may stop the rendering.
pub(crate) type TakeBand<'a, T> = dyn Fn(usize, &[T]) -> Result<(), Cancelled> + Sync + 'a;

/// One rendering: which rectangle of the upright picture, in tiles of how many columns.
pub struct Render<'a> {
    plan: &'a Plan,
    neighbourhood: Neighbourhood<'a>,
    rect: Rect,
    columns: usize,
    /// Camera RGB of the whole rectangle, where it is known already.
    kept: Option<Arc<Last>>,
    cancel: &'a Cancel,
}

/// What a thread works in, kept from one tile to the next.
struct Scratch<T> {
    neighbourhood: neighbourhood::Scratch,
    finish: Finish<T>,
}

impl<'a> Render<'a> {
    fn of(plan: &'a Plan, view: View, cancel: &'a Cancel, columns: usize) -> Result<Self, Cancelled> {
        let nothing = Rect { width: 0, height: 0, ..view.rect };
        let rect = view.rect.intersection(plan.whole(view.scale).rect).unwrap_or(nothing);
        let neighbourhood = Neighbourhood::of(&plan.base, view.scale, rect, cancel)?;
        let columns = neighbourhood.columns(columns).clamp(1, rect.width.max(1));
        Ok(Self { plan, neighbourhood, rect, columns, kept: None, cancel })
    }

    fn scratch<T: Sample>(&self) -> Scratch<T> {
        Scratch { neighbourhood: self.neighbourhood.scratch(), finish: Finish::new() }
    }

    /// The whole picture, in bands of so many rows.
    fn samples(&self, rows: usize) -> Result<Picture, Cancelled> {
        let samples = match self.plan.bits {
            Bits::Eight => Samples::U8(self.picture(rows)?),
            Bits::Sixteen => Samples::U16(self.picture(rows)?),
            Bits::Float => Samples::F32(self.picture(rows)?),
        };
        Ok(Picture { size: self.rect.size(), samples, space: self.plan.picture_space() })
    }

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
            let rect = self.neighbourhood.grid.of_upright(Rect { x: self.rect.x + x, width, ..band_rect });
            let Scratch { neighbourhood, finish } = &mut *scratch;
            let camera = match &self.kept {
                Some(last) => (&last.camera, self.neighbourhood.grid.of_upright(self.rect)),
                None => (self.neighbourhood.camera(rect, neighbourhood), rect),
            };
            finish.tile(self.plan, &self.neighbourhood.grid, camera, rect, (band_rect, band));
        }
        Ok(())
    }

    /// Balanced camera RGB of the whole rectangle, as it lies in the grid.
    fn camera(&self, rows: usize) -> Result<Rgb<CameraSpace>, Cancelled> {
        let whole = self.neighbourhood.grid.of_upright(self.rect);
        let mut camera = Rgb::black(whole.size());
        let columns = self.columns.min(whole.width.max(1));
        let length = rows.clamp(1, whole.height.max(1)) * whole.width.max(1);
        let [r, g, b] = camera.planes_mut().map(|plane| plane.chunks_mut(length));
        let bands = (whole.y..).step_by(length / whole.width.max(1)).zip(r.zip(g).zip(b));
        in_turn(
            bands,
            || self.neighbourhood.scratch(),
            |scratch, (y, ((r, g), b))| {
                for x in (0..whole.width).step_by(columns) {
                    if self.cancel.is_cancelled() {
                        return Err(Cancelled);
                    }
                    let width = columns.min(whole.width - x);
                    let rect = Rect { x: whole.x + x, y, width, height: r.len() / whole.width };
                    let tile = self.neighbourhood.camera(rect, scratch);
                    for (out, plane) in [&mut *r, &mut *g, &mut *b].into_iter().zip(tile.planes()) {
                        for (out, row) in out.chunks_exact_mut(whole.width).zip(plane.chunks_exact(width)) {
                            out[x..x + width].copy_from_slice(row);
                        }
                    }
                }
                Ok(())
            },
        )?;
        Ok(camera)
    }
}
