//! Runs the stages over tiles, in parallel, and puts the finished tiles upright into one picture.

use darkroot_photo::{Capture, Encoded, Picture, PictureSpace, Rect, Rgb, Samples, Scene, Size};
use rayon::prelude::*;

use crate::plan::{Plan, border};
use crate::recipe::{Bits, OutputSpace};
use crate::tile::tile;
use crate::{correct, corrections, demosaic, exposure, fringe, gamut, highlights, tone, transfer};

/// Rows of the finished picture that one task makes.
const BAND_ROWS: usize = 96;
/// Columns of a tile within a band: its planes stay in the second-level cache.
const TILE_COLUMNS: usize = 512;

impl Plan {
    /// Develops the capture that this plan was made for.
    pub fn render(&self, capture: &Capture) -> Picture {
        self.render_in_tiles(capture, TILE_COLUMNS, BAND_ROWS)
    }

    /// As [`Plan::render`], in tiles of another size. The picture is the same.
    pub fn render_in_tiles(&self, capture: &Capture, columns: usize, rows: usize) -> Picture {
        let size = self.size();
        let count = 3 * size.area();
        let cut = Cut {
            size,
            columns: columns.clamp(1, size.width.max(1)),
            rows: rows.clamp(1, size.height.max(1)),
        };
        let samples = match self.bits {
            Bits::Eight => {
                let mut out = vec![0u8; count];
                self.bands(capture, cut, &mut out, |v| (v * 255.0 + 0.5) as u8);
                Samples::U8(out)
            }
            Bits::Sixteen => {
                let mut out = vec![0u16; count];
                self.bands(capture, cut, &mut out, |v| (v * 65535.0 + 0.5) as u16);
                Samples::U16(out)
            }
            Bits::Float => {
                let mut out = vec![0f32; count];
                self.bands(capture, cut, &mut out, |v| v);
                Samples::F32(out)
            }
        };
        let space = match self.space {
            OutputSpace::Rgb(space) => PictureSpace::Rgb(space),
            OutputSpace::Camera => PictureSpace::Camera,
        };
        Picture { size, samples, space }
    }

    fn bands<T: Copy + Send>(
        &self,
        capture: &Capture,
        cut: Cut,
        out: &mut [T],
        sample: impl Fn(f32) -> T + Sync,
    ) {
        let Cut { size, columns, rows } = cut;
        if out.is_empty() {
            return;
        }
        out.par_chunks_mut(3 * size.width * rows).enumerate().for_each(|(i, band)| {
            let y = i * rows;
            let height = band.len() / (3 * size.width);
            for x in (0..size.width).step_by(columns) {
                let upright = Rect { x, y, width: columns.min(size.width - x), height };
                let (rect, picture) = self.develop_tile(capture, upright);
                self.place(&picture, rect, upright, size, band, &sample);
            }
        });
    }

    /// Develops one rectangle of the upright picture; gives it as it lies in the frame, with its place there.
    fn develop_tile(&self, capture: &Capture, upright: Rect) -> (Rect, Rgb<Encoded>) {
        let size = self.size();
        let back = self.orientation.inverse();
        let (x0, y0) = back.place(upright.x, upright.y, size);
        let (x1, y1) = back.place(upright.right() - 1, upright.bottom() - 1, size);
        let rect = Rect {
            x: self.crop.x + x0.min(x1),
            y: self.crop.y + y0.min(y1),
            width: x0.abs_diff(x1) + 1,
            height: y0.abs_diff(y1) + 1,
        };
        (rect, self.stages(capture, rect))
    }

    /// The pipeline, from top to bottom, for one rectangle of the frame.
    fn stages(&self, capture: &Capture, rect: Rect) -> Rgb<Encoded> {
        let border = border(self);
        let mut mosaic = tile(capture, self, rect, border);
        highlights::treat(&mut mosaic, &self.highlights);
        let mut camera = demosaic::demosaic(&mosaic, self.demosaic, border);
        demosaic::debias::debias(&mosaic, border, &self.noise, &mut camera);
        fringe::cut(&mosaic, border, &self.highlights, &mut camera);
        drop(mosaic);
        if !self.picture_corrections.is_empty() {
            let area = capture.active_area;
            let place = Rect { x: rect.x - area.x, y: rect.y - area.y, ..rect };
            corrections::picture(&mut camera, &self.picture_corrections, place, area.size());
        }
        highlights::neutralise(&mut camera, &self.highlights);
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

    /// Writes a finished tile into its band of the upright picture.
    fn place<T>(
        &self,
        tile: &Rgb<Encoded>,
        rect: Rect,
        upright: Rect,
        size: Size,
        band: &mut [T],
        sample: impl Fn(f32) -> T,
    ) {
        let [r, g, b] = tile.planes();
        let crop = self.crop;
        for y in 0..rect.height {
            let line = y * rect.width;
            let (u0, v0) = self.orientation.place(rect.x - crop.x, rect.y - crop.y + y, crop.size());
            let at = ((v0 - upright.y) * size.width + u0) * 3;
            if self.orientation == darkroot_photo::Orientation::Upright {
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
                let (u, v) = self.orientation.place(rect.x - crop.x + x, rect.y - crop.y + y, crop.size());
                let at = ((v - upright.y) * size.width + u) * 3;
                band[at] = sample(r[line + x]);
                band[at + 1] = sample(g[line + x]);
                band[at + 2] = sample(b[line + x]);
            }
        }
    }
}

/// How a picture is cut into tiles.
#[derive(Clone, Copy)]
struct Cut {
    size: Size,
    columns: usize,
    rows: usize,
}
