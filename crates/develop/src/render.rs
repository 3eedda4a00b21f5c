//! Runs the stages over tiles, in parallel, and puts the finished tiles upright into one picture.

use darkroot_photo::{Encoded, Orientation, Picture, PictureSpace, Rect, Rgb, Samples, Scene, Size};
use rayon::prelude::*;

use crate::demosaic::reduce::{self, Reduction};
use crate::demosaic::{self, Method, debias};
use crate::highlights::{self, Treatment};
use crate::plan::Plan;
use crate::recipe::{Bits, OutputSpace};
use crate::stage::{Stage, tile_border};
use crate::tile::tile;
use crate::view::{Cancel, Cancelled, Scale, View};
use crate::{correct, corrections, exposure, fringe, gamut, tone, transfer};

/// Rows of the sensor that one task looks at.
const BAND_ROWS: usize = 96;
/// Columns of a tile within a band: its planes stay in the second-level cache.
const TILE_COLUMNS: usize = 512;

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
        let nothing = Rect { width: 0, height: 0, ..view.rect };
        let rect = view.rect.intersection(self.whole(view.scale).rect).unwrap_or(nothing);
        let count = 3 * rect.size().area();
        let render = Render {
            plan: self,
            grid: Grid::of(self, view.scale),
            rect,
            columns: columns.clamp(1, rect.width.max(1)),
            rows: rows.clamp(1, rect.height.max(1)),
            cancel,
        };
        let samples = match self.bits {
            Bits::Eight => {
                let mut out = vec![0u8; count];
                render.bands(&mut out, |v| (v * 255.0 + 0.5) as u8)?;
                Samples::U8(out)
            }
            Bits::Sixteen => {
                let mut out = vec![0u16; count];
                render.bands(&mut out, |v| (v * 65535.0 + 0.5) as u16)?;
                Samples::U16(out)
            }
            Bits::Float => {
                let mut out = vec![0f32; count];
                render.bands(&mut out, |v| v)?;
                Samples::F32(out)
            }
        };
        let space = match self.space {
            OutputSpace::Rgb(space) => PictureSpace::Rgb(space),
            OutputSpace::Camera => PictureSpace::Camera,
        };
        Ok(Picture { size: rect.size(), samples, space })
    }

    /// Stages that change the mosaic before it becomes a picture.
    fn changes(&self) -> &'static [Stage] {
        if matches!(self.highlights, Treatment::Rebuild { .. }) && self.demosaic != Method::None {
            &[highlights::STAGE]
        } else {
            &[]
        }
    }

    /// Stages that read the changed mosaic.
    fn readers(&self, scale: Scale) -> Vec<Stage> {
        match (self.demosaic, scale) {
            (Method::None, _) => Vec::new(),
            (_, scale) if scale.bin() >= reduce::LEAST => vec![reduce::STAGE],
            (method, _) => vec![method.stage(), debias::STAGE, fringe::STAGE],
        }
    }

    /// From balanced camera RGB on every stage looks at one pixel.
    fn finish(&self, camera: Rgb<darkroot_photo::CameraSpace>) -> Rgb<Encoded> {
        let Some(model) = &self.model else {
            let gained = exposure::expose(camera.into_space::<Scene>(), self.gain);
            return self.encode(gained.into_space());
        };
        let scene = correct::correct(camera, model);
        let scene = exposure::expose(scene, self.gain);
        let display = match self.curve {
            Some(curve) => gamut::fit(tone::tone(scene, curve), &self.primaries),
            None => gamut::convert(scene, &self.primaries),
        };
        self.encode(display)
    }

    fn encode(&self, display: Rgb<darkroot_photo::Display>) -> Rgb<Encoded> {
        match self.bits {
            Bits::Float => transfer::encode_unbounded(display, &self.encoder),
            Bits::Eight | Bits::Sixteen => transfer::encode(display, &self.encoder),
        }
    }
}

/// The pixels of a picture at a scale, as they lie in the frame.
struct Grid {
    bin: usize,
    /// Column and row of the frame at which they begin: left of or above the crop where its size is no multiple of
    /// the bin and the picture's upright left or top edge is the frame's right or bottom one.
    origin: (isize, isize),
    /// Number of columns and rows.
    size: Size,
    orientation: Orientation,
    border: usize,
    reduction: Option<Reduction>,
}

impl Grid {
    fn of(plan: &Plan, scale: Scale) -> Self {
        let (crop, orientation, bin) = (plan.crop, plan.orientation, scale.bin());
        let size = scale.of(crop.size());
        let upright = orientation.applied_to(size);
        // Which corner of the grid becomes the upright picture's top left one.
        let (x, y) = match (upright.width, upright.height) {
            (0, _) | (_, 0) => (0, 0),
            _ => orientation.inverse().place(0, 0, upright),
        };
        let begin = |at: usize, start: usize, end: usize, count: usize| {
            if at == 0 { start as isize } else { end as isize - (count * bin) as isize }
        };
        let origin =
            (begin(x, crop.x, crop.right(), size.width), begin(y, crop.y, crop.bottom(), size.height));
        let border = tile_border(plan.changes(), &plan.readers(scale));
        let reduction = (bin >= reduce::LEAST).then(|| Reduction::of(plan.capture.counts.layout()));
        Self { bin, origin, size, orientation, border, reduction }
    }

    /// The pixels that become a rectangle of the upright picture.
    fn of_upright(&self, upright: Rect) -> Rect {
        let size = self.orientation.applied_to(self.size);
        let back = self.orientation.inverse();
        let (x0, y0) = back.place(upright.x, upright.y, size);
        let (x1, y1) = back.place(upright.right() - 1, upright.bottom() - 1, size);
        Rect { x: x0.min(x1), y: y0.min(y1), width: x0.abs_diff(x1) + 1, height: y0.abs_diff(y1) + 1 }
    }
}

/// One rendering: which rectangle of the upright picture, in which tiles.
struct Render<'a> {
    plan: &'a Plan,
    grid: Grid,
    rect: Rect,
    columns: usize,
    rows: usize,
    cancel: &'a Cancel,
}

impl Render<'_> {
    fn bands<T: Copy + Send>(
        &self,
        out: &mut [T],
        sample: impl Fn(f32) -> T + Sync,
    ) -> Result<(), Cancelled> {
        let rect = self.rect;
        if out.is_empty() {
            return Ok(());
        }
        out.par_chunks_mut(3 * rect.width * self.rows).enumerate().try_for_each(|(i, band)| {
            let height = band.len() / (3 * rect.width);
            let band_rect = Rect { y: rect.y + i * self.rows, height, ..rect };
            for x in (0..rect.width).step_by(self.columns) {
                if self.cancel.is_cancelled() {
                    return Err(Cancelled);
                }
                let width = self.columns.min(rect.width - x);
                let place = self.grid.of_upright(Rect { x: rect.x + x, width, ..band_rect });
                self.place(&self.stages(place), place, band_rect, band, &sample);
            }
            Ok(())
        })
    }

    /// The pipeline, from top to bottom, for one rectangle of the grid.
    fn stages(&self, rect: Rect) -> Rgb<Encoded> {
        let (plan, &Grid { bin, border, .. }) = (self.plan, &self.grid);
        let (x, y) = self.corner(rect);
        let size = Size { width: rect.width * bin + 2 * border, height: rect.height * bin + 2 * border };
        let begin = (x - border as isize, y - border as isize);
        let mut mosaic = tile(&plan.capture, &plan.light, plan.multipliers, begin, size);
        highlights::treat(&mut mosaic, &plan.highlights);
        let mut camera = match &self.grid.reduction {
            Some(reduction) => reduction.reduce(&mosaic, border, bin, begin),
            None => {
                let mut camera = demosaic::demosaic(&mosaic, plan.demosaic, border);
                debias::debias(&mosaic, border, &plan.noise, &mut camera);
                fringe::cut(&mosaic, border, &plan.highlights, &mut camera);
                if bin == 1 { camera } else { reduce::mean(&camera, bin) }
            }
        };
        drop(mosaic);
        if !plan.picture_corrections.is_empty() {
            let area = plan.capture.active_area;
            // The middle of each pixel.
            let inside = |v: isize, start: usize| (v - start as isize).max(0) as usize + (bin - 1) / 2;
            let at = (inside(x, area.x), inside(y, area.y));
            corrections::picture(&mut camera, &plan.picture_corrections, at, bin, area.size());
        }
        highlights::neutralise(&mut camera, &plan.highlights);
        plan.finish(camera)
    }

    /// Column and row of the frame at which a rectangle of the grid begins.
    fn corner(&self, rect: Rect) -> (isize, isize) {
        let &Grid { bin, origin, .. } = &self.grid;
        (origin.0 + (rect.x * bin) as isize, origin.1 + (rect.y * bin) as isize)
    }

    /// Writes a finished tile, which lies at `rect` of the grid, into its band of the upright picture.
    fn place<T>(
        &self,
        tile: &Rgb<Encoded>,
        rect: Rect,
        band_rect: Rect,
        band: &mut [T],
        sample: impl Fn(f32) -> T,
    ) {
        let [r, g, b] = tile.planes();
        let &Grid { orientation, size, .. } = &self.grid;
        let at = |x: usize, y: usize| {
            let (u, v) = orientation.place(rect.x + x, rect.y + y, size);
            ((v - band_rect.y) * band_rect.width + u - band_rect.x) * 3
        };
        for y in 0..rect.height {
            let line = y * rect.width;
            if orientation == Orientation::Upright {
                let at = at(0, y);
                let pixels = band[at..at + 3 * rect.width].chunks_exact_mut(3);
                let planes = r[line..].iter().zip(&g[line..]).zip(&b[line..]);
                for (pixel, ((r, g), b)) in pixels.zip(planes) {
                    pixel[0] = sample(*r);
                    pixel[1] = sample(*g);
                    pixel[2] = sample(*b);
                }
                continue;
            }
            for x in 0..rect.width {
                let at = at(x, y);
                band[at] = sample(r[line + x]);
                band[at + 1] = sample(g[line + x]);
                band[at + 2] = sample(b[line + x]);
            }
        }
    }
}
