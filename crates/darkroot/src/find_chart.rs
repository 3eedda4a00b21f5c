//! Finding charts in a file, and showing what was found.

use std::path::Path;

pub use darkroot_chart::Found;
use darkroot_chart::{ChartLayout, Options, Quad, Rejected, Search, SearchImage, measure, windows};
use darkroot_colour::RgbSpace;
use darkroot_photo::metadata::Metadata;
use darkroot_photo::{Mosaic, PictureSpace, Samples, Size};

use crate::fault::ChartError;
use crate::shot::View;
use crate::{Error, Settings, files};

/// Share of a patch's side that is left out at each edge when it is measured.
pub(crate) const INSET: f64 = 0.22;
/// Longest side of a preview.
const LONGEST: usize = 1000;

/// Where a chart stands in the developed picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Place {
    pub(crate) corners: Quad,
    /// Whole patches.
    pub(crate) patches: Vec<Quad>,
    /// The part of each patch that is measured.
    pub(crate) windows: Vec<Quad>,
    pub(crate) confidence: f64,
}

/// The charts of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundCharts {
    /// Size of the developed picture.
    pub size: Size,
    /// Charts, the surest first, in pixels of the developed picture; or what came nearest.
    pub search: Search,
}

/// Looks for charts in a raw file or a rendered picture.
///
/// # Errors
/// A file that cannot be read.
pub fn find_charts(path: &Path, layouts: &[ChartLayout], settings: &Settings) -> Result<FoundCharts, Error> {
    Ok(find_in(&View::open_any(path, settings)?, layouts))
}

/// Looks for charts in a file that is open already.
pub fn find_in(view: &View, layouts: &[ChartLayout]) -> FoundCharts {
    FoundCharts { size: view.size, search: search(view, layouts) }
}

/// Looks for charts in a picture of linear light, R, G and B side by side.
pub fn find_charts_in(light: Mosaic<f32>, layouts: &[ChartLayout]) -> FoundCharts {
    let view = View::of_picture(light);
    FoundCharts { size: view.size, search: search(&view, layouts) }
}

/// Charts in pixels of the developed picture.
pub(crate) fn search(view: &View, layouts: &[ChartLayout]) -> Search {
    let bin = view.bin();
    let (size, planes) = view.binned(bin);
    let picture = SearchImage { width: size.width, height: size.height, planes };
    let mut search = darkroot_chart::detect::search(&picture, layouts, &Options::default());
    // The middle of a bin of 2 x 2 pixels lies half a pixel beyond its first.
    let scaled = |q: &Quad| q.map(|p| p.map(|v| v * bin as f64 + (bin as f64 - 1.0) / 2.0));
    for found in &mut search.found {
        found.corners = scaled(&found.corners);
        found.patch_pixels *= bin as f64;
    }
    if let Some(rejected) = &mut search.rejected {
        rejected.corners = rejected.corners.as_ref().map(scaled);
    }
    search
}

/// The surest chart of a layout.
pub(crate) fn best(view: &View, layout: &ChartLayout) -> Result<Place, ChartError> {
    let search = search(view, std::slice::from_ref(layout));
    if let Some(found) = search.found.first() {
        return Ok(place(found));
    }
    let reason = search.rejected.map(|Rejected { reason, .. }| reason);
    Err(ChartError::NotFound { chart: layout.title.clone(), reason })
}

/// A chart at corners given by hand.
pub(crate) fn by_hand(layout: &ChartLayout, corners: &Quad) -> Result<Place, ChartError> {
    let of_patches = |inset: f64| windows::windows(layout, corners, inset).ok_or(ChartError::Corners);
    Ok(Place { corners: *corners, patches: of_patches(0.0)?, windows: of_patches(INSET)?, confidence: 1.0 })
}

/// Where the patches of a found chart stand.
pub(crate) fn place(found: &Found) -> Place {
    let all = |inset: f64| (0..found.columns * found.rows).map(|i| found.patch(i, inset)).collect();
    Place { corners: found.corners, patches: all(0.0), windows: all(INSET), confidence: found.confidence }
}

/// Writes a PNG of the picture with grid, windows and numbers over it; windows with clipped samples are red.
///
/// # Errors
/// A file that cannot be read or written.
pub fn preview(
    input: &Path,
    found: &FoundCharts,
    output: &Path,
    overwrite: bool,
    settings: &Settings,
) -> Result<(), Error> {
    let view = View::open_any(input, settings)?;
    let longest = view.size.width.max(view.size.height);
    let bin = (1..).map(|k| k * view.bin()).find(|bin| longest / bin <= LONGEST).unwrap_or(1);
    let (size, planes) = view.binned(bin);
    let mut canvas = Canvas::new(size, &planes);
    let at = |[x, y]: [f64; 2]| [x, y].map(|v| (v - (bin as f64 - 1.0) / 2.0) / bin as f64);
    for chart in &found.search.found {
        canvas.polygon(&chart.corners.map(at), YELLOW);
        let place = place(chart);
        let in_frame: Vec<Quad> = place.windows.iter().map(|q| q.map(|p| view.to_frame(p))).collect();
        let measured = measure(&view.frame.light, view.frame.saturation, &in_frame);
        for (i, (window, m)) in place.windows.iter().zip(&measured).enumerate() {
            canvas.polygon(&window.map(at), if m.clipped > 0.001 { RED } else { WHITE });
            canvas.number(i + 1, at(chart.centre(i)));
        }
    }
    let picture = darkroot_photo::Picture {
        size,
        samples: Samples::U8(canvas.rgb),
        space: PictureSpace::Rgb(RgbSpace::SRGB),
    };
    let mut out = std::io::Cursor::new(Vec::new());
    darkroot_encode::write(
        &picture,
        darkroot_encode::Format::Png,
        &darkroot_encode::Options::default(),
        &Metadata::default(),
        &mut out,
    )
    .map_err(|source| Error::Encode { path: output.to_owned(), source })?;
    files::write_whole(output, out.get_ref(), overwrite)
}

const YELLOW: [u8; 3] = [255, 225, 0];
const WHITE: [u8; 3] = [255, 255, 255];
const RED: [u8; 3] = [255, 40, 40];

/// Digits of three by five cells, a row after the other.
const DIGITS: [u16; 10] = [
    0b111_101_101_101_111,
    0b010_110_010_010_111,
    0b111_001_111_100_111,
    0b111_001_111_001_111,
    0b101_101_111_001_001,
    0b111_100_111_001_111,
    0b111_100_111_101_111,
    0b111_001_010_010_010,
    0b111_101_111_101_111,
    0b111_101_111_001_111,
];

/// Eight bits of R, G, B to draw on.
struct Canvas {
    size: Size,
    rgb: Vec<u8>,
}

impl Canvas {
    /// The picture in camera colours, balanced to a grey mean and brightened to white at its 99.5th percentile.
    fn new(size: Size, planes: &[Vec<f32>; 3]) -> Self {
        let top = planes.each_ref().map(|plane| {
            let mut values: Vec<f32> = plane.iter().copied().filter(|v| v.is_finite()).collect();
            let at = (values.len().saturating_sub(1)) * 995 / 1000;
            if values.is_empty() { 1.0 } else { *values.select_nth_unstable_by(at, f32::total_cmp).1 }
                .max(1e-6)
        });
        let byte = |v: f32| (RgbSpace::SRGB.curve.encode(f64::from(v.clamp(0.0, 1.0))) * 255.0).round() as u8;
        let rgb = (0..size.area()).flat_map(|i| [0, 1, 2].map(|c| byte(planes[c][i] / top[c]))).collect();
        Self { size, rgb }
    }

    fn dot(&mut self, x: f64, y: f64, colour: [u8; 3]) {
        let (x, y) = (x.round(), y.round());
        if x >= 0.0 && y >= 0.0 && x < self.size.width as f64 && y < self.size.height as f64 {
            let first = 3 * (y as usize * self.size.width + x as usize);
            self.rgb[first..first + 3].copy_from_slice(&colour);
        }
    }

    fn polygon(&mut self, quad: &Quad, colour: [u8; 3]) {
        for i in 0..4 {
            let ([ax, ay], [bx, by]) = (quad[i], quad[(i + 1) % 4]);
            let steps = (bx - ax).abs().max((by - ay).abs()).ceil().clamp(1.0, 10_000.0);
            for k in 0..=steps as usize {
                let t = k as f64 / steps;
                self.dot(ax + t * (bx - ax), ay + t * (by - ay), colour);
            }
        }
    }

    fn number(&mut self, number: usize, [x, y]: [f64; 2]) {
        let digits = number.to_string();
        let left = x - 2.0 * digits.len() as f64;
        for (place, digit) in digits.bytes().enumerate() {
            let shape = DIGITS[usize::from(digit - b'0') % 10];
            for cell in 0..15 {
                let (column, row) = ((cell % 3) as f64, (cell / 3) as f64);
                let colour = if shape >> (14 - cell) & 1 == 1 { WHITE } else { [0, 0, 0] };
                self.dot(left + 4.0 * place as f64 + column, y - 2.0 + row, colour);
            }
        }
    }
}
