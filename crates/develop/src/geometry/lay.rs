//! From what was asked to a rectangle of the frame, or to a map into it.

use darkroot_colour::Matrix3;
use darkroot_photo::{Capture, Orientation, Rect, Size};

use super::homography::{moved, place, scaled, turned};
use super::lens::LensWarp;
use super::optics::optics;
use super::vignetting::Vignetting;
use super::warp::Warp;
use super::{Crop, Flip, Geometry, Resize, Turn, perspective};
use crate::error::{Error, GeometryFault};

/// Longest side of a picture.
const LONGEST: f64 = 65_500.0;

/// Where the picture lies in the frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Laid {
    /// Size of the picture, upright.
    pub(crate) size: Size,
    /// What it shows of the frame, where it shows pixels of the frame as they are.
    pub(crate) crop: Rect,
    /// How that must be turned to stand upright.
    pub(crate) orientation: Orientation,
    /// Where its pixels come from, where that is between pixels.
    pub(crate) warp: Option<Warp>,
    /// What is known of the light that the lens lost, and the middle of its picture, in columns and rows of the frame.
    pub(crate) vignetting: Option<(Vignetting, [f64; 2])>,
    /// What became of the correction of the lens that the file carries, and of what the maker's note says.
    pub(crate) lens_note: Option<String>,
}

impl Laid {
    /// Whether a correction of the lens moves red, green and blue apart.
    pub(crate) fn splits_colours(&self) -> bool {
        self.warp.as_ref().is_some_and(Warp::splits_colours)
    }

    /// The pixel of the frame at a pixel of the picture.
    pub(crate) fn in_frame(&self, capture: &Capture, x: usize, y: usize) -> (usize, usize) {
        match &self.warp {
            None => {
                let (u, v) = self.orientation.inverse().place(x, y, self.size);
                (self.crop.x + u, self.crop.y + v)
            }
            Some(warp) => {
                let area = capture.active_area;
                let [u, v] = warp.place(1, x as f64 + 0.5, y as f64 + 0.5);
                let inside = |v: f64, length: usize| (v.max(0.0) as usize).min(length - 1);
                (area.x + inside(u, area.width), area.y + inside(v, area.height))
            }
        }
    }
}

/// Lays a picture into the frame. Nobody who measures gets the file's correction of the lens unasked. A picture that is made
/// smaller is sharpened by so much, 0..=2.
///
/// # Errors
/// A crop, corners or a size that cannot be.
pub(crate) fn lay(
    capture: &Capture,
    crop: Crop,
    asked: &Geometry,
    measuring: bool,
    sharpening: f32,
) -> Result<Laid, Error> {
    let shown = match crop {
        Crop::Active => capture.active_area,
        Crop::Default => capture.shown(),
        Crop::Aspect(_) | Crop::Share(_) | Crop::Rect { .. } => capture.default_crop,
    };
    let orientation = oriented(capture.orientation, asked.turn, asked.flip);
    let canvas = orientation.applied_to(shown.size());
    let area = capture.active_area;
    let in_area = |rect: Rect| Rect { x: rect.x - area.x, y: rect.y - area.y, ..rect };
    let optics = optics(capture, asked, measuring, in_area(capture.default_crop));
    let fitted = optics.warps.first().filter(|_| optics.is_to_fit);
    let zoom = fitted.map_or(1.0, |lens| zoom(lens, in_area(shown), area.size()));
    let (lens, vignetting, lens_note) = (optics.warps, optics.vignetting, optics.note);
    let straight = asked.straighten == 0.0 && asked.perspective.is_none();
    let to_canvas = to_canvas(canvas, asked)?;
    let part = part(crop, canvas, &to_canvas, straight)?;
    let (width, height) = (part.width, part.height);
    let size = resized(asked, width, height)?;
    let whole = (size.width as f64, size.height as f64) == (width, height);
    if straight && whole && lens.is_empty() {
        let upright = Rect { x: part.x as usize, y: part.y as usize, width: size.width, height: size.height };
        let cut = orientation.inverse().place_rect(upright, canvas);
        let crop = Rect { x: shown.x + cut.x, y: shown.y + cut.y, ..cut };
        return Ok(Laid { size, crop, orientation, warp: None, vignetting, lens_note });
    }
    let (across, down) = (width / size.width as f64, height / size.height as f64);
    let in_area = in_area(shown);
    let [x, y] = in_area.middle();
    let to_frame = moved(x, y)
        * scaled(zoom, zoom)
        * moved(in_area.x as f64 - x, in_area.y as f64 - y)
        * unturned(orientation, canvas, shown.size())
        * to_canvas
        * moved(part.x, part.y)
        * scaled(across, down);
    let warp = Warp::new(to_frame, lens, area.size(), zoom * across.max(down), sharpening);
    Ok(Laid { size, crop: shown, orientation, warp: Some(warp), vignetting, lens_note })
}

/// By what a corrected picture must be multiplied about its middle so that all of it comes from the frame, and most of the
/// frame is in it: found by halving.
fn zoom(lens: &LensWarp, shown: Rect, area: Size) -> f64 {
    const STEPS: usize = 32;
    let [x, y] = shown.middle();
    let border = (0..4 * STEPS).map(|i| {
        let along = (i % STEPS) as f64 / STEPS as f64;
        let (u, v) = [(along, 0.0), (1.0, along), (1.0 - along, 1.0), (0.0, 1.0 - along)][i / STEPS];
        [(u - 0.5) * shown.width as f64, (v - 0.5) * shown.height as f64]
    });
    let border: Vec<[f64; 2]> = border.collect();
    let is_whole = |zoom: f64| {
        border.iter().all(|[u, v]| {
            (0..3).all(|channel| {
                let [x, y] = lens.place(channel, [x + zoom * u, y + zoom * v]);
                (0.0..=area.width as f64).contains(&x) && (0.0..=area.height as f64).contains(&y)
            })
        })
    };
    let (mut whole, mut beyond) = (0.5, 1.5);
    for _ in 0..30 {
        let between = 0.5 * (whole + beyond);
        if is_whole(between) { whole = between } else { beyond = between }
    }
    whole
}

/// What stands upright after one orientation, a turn and a mirroring, as one.
fn oriented(camera: Orientation, turn: Turn, flip: Flip) -> Orientation {
    let turn = match turn {
        Turn::None => Orientation::Upright,
        Turn::Right => Orientation::Rotate90,
        Turn::Half => Orientation::Rotate180,
        Turn::Left => Orientation::Rotate270,
    };
    let flip = match flip {
        Flip::None => Orientation::Upright,
        Flip::Horizontal => Orientation::MirrorHorizontal,
        Flip::Vertical => Orientation::MirrorVertical,
    };
    camera.then(turn).then(flip)
}

/// From places of the straightened picture to those of the upright one.
fn to_canvas(canvas: Size, asked: &Geometry) -> Result<Matrix3, Error> {
    if !(-45.0..=45.0).contains(&asked.straighten) {
        return Err(Error::Geometry { fault: GeometryFault::Angle, size: canvas });
    }
    let middle = [canvas.width as f64 / 2.0, canvas.height as f64 / 2.0];
    let straightened = turned(-asked.straighten, middle);
    let Some(asked) = &asked.perspective else { return Ok(straightened) };
    let undone =
        perspective::undone(asked, canvas).map_err(|fault| Error::Geometry { fault, size: canvas })?;
    Ok(undone * straightened)
}

/// A part of the straightened picture.
#[derive(Debug, Clone, Copy)]
struct Part {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

/// What is shown of the straightened picture: nothing that is not in the upright one, whole pixels.
fn part(crop: Crop, canvas: Size, to_canvas: &Matrix3, straight: bool) -> Result<Part, Error> {
    let (width, height) = (canvas.width as f64, canvas.height as f64);
    let wrong = |fault| Error::Geometry { fault, size: canvas };
    if let Crop::Rect { x, y, width: w, height: h } = crop {
        let ends = (x.checked_add(w), y.checked_add(h));
        let within = ends.0.is_some_and(|x| x <= canvas.width) && ends.1.is_some_and(|y| y <= canvas.height);
        let part = Part { x: x as f64, y: y as f64, width: w as f64, height: h as f64 };
        return match within && w > 0 && h > 0 {
            false => Err(wrong(GeometryFault::Crop)),
            true if !straight && !is_inside(part, canvas, to_canvas) => Err(wrong(GeometryFault::CropCorner)),
            true => Ok(part),
        };
    }
    let ratio = match crop {
        Crop::Aspect(ratio) if width >= height => ratio,
        Crop::Aspect(ratio) => 1.0 / ratio,
        _ => width / height,
    };
    if !(ratio.is_finite() && ratio > 0.0) {
        return Err(wrong(GeometryFault::Crop));
    }
    let (full_width, full_height) = (width.min(height * ratio), height.min(width / ratio));
    let centred = |share: f64| {
        let (w, h) = (share * full_width, share * full_height);
        Part { x: 0.5 * (width - w), y: 0.5 * (height - h), width: w, height: h }
    };
    let mut share = 1.0;
    if !straight {
        // The largest that is inside, by halving.
        let (mut least, mut most) = (0.0, 1.0);
        for _ in 0..40 {
            share = 0.5 * (least + most);
            if is_inside(centred(share), canvas, to_canvas) { least = share } else { most = share }
        }
        share = least;
    }
    if let Crop::Share(of) = crop {
        share *= of;
    }
    let part = centred(share);
    let (w, h) = if straight {
        (part.width.round(), part.height.round())
    } else {
        (part.width.floor(), part.height.floor())
    };
    if !(w >= 1.0 && h >= 1.0) {
        return Err(wrong(GeometryFault::Nothing));
    }
    let start = |whole: f64, w: f64| if straight { (0.5 * (whole - w)).floor() } else { 0.5 * (whole - w) };
    Ok(Part { x: start(width, w), y: start(height, h), width: w, height: h })
}

/// Whether a part of the straightened picture lies in the upright one.
fn is_inside(part: Part, canvas: Size, to_canvas: &Matrix3) -> bool {
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    corners.into_iter().all(|(u, v)| {
        let corner = place(to_canvas, [part.x + u * part.width, part.y + v * part.height]);
        corner.is_some_and(|[x, y]| {
            let within = |v: f64, length: usize| (-1e-6..=length as f64 + 1e-6).contains(&v);
            within(x, canvas.width) && within(y, canvas.height)
        })
    })
}

/// Size of a picture of so many columns and rows.
fn resized(asked: &Geometry, width: f64, height: f64) -> Result<Size, Error> {
    let factor = match asked.resize {
        Resize::None => 1.0,
        Resize::Long(side) => side as f64 / width.max(height),
        Resize::Short(side) => side as f64 / width.min(height),
        Resize::Fit { width: w, height: h } => (w as f64 / width).min(h as f64 / height),
        Resize::Share(share) => share,
        Resize::Megapixels(mp) => (mp * 1e6 / (width * height)).sqrt(),
    };
    let may_grow = asked.enlarge || matches!(asked.resize, Resize::Share(_));
    let factor = if may_grow || factor.is_nan() { factor } else { factor.min(1.0) };
    let size = Size {
        width: (width * factor).round().max(1.0) as usize,
        height: (height * factor).round().max(1.0) as usize,
    };
    if !(factor > 0.0 && width.max(height) * factor <= LONGEST) {
        return Err(Error::Geometry { fault: GeometryFault::Size, size });
    }
    Ok(size)
}

/// From places of the upright picture to those of what is shown of the frame.
fn unturned(orientation: Orientation, canvas: Size, shown: Size) -> Matrix3 {
    let back = orientation.inverse();
    let two = Size { width: 2, height: 2 };
    let at = |x: usize, y: usize| {
        let (u, v) = back.place(x, y, two);
        [u as f64, v as f64]
    };
    let (origin, right, below) = (at(0, 0), at(1, 0), at(0, 1));
    let step = |to: [f64; 2], axis: usize| to[axis] - origin[axis];
    let turn =
        Matrix3::new(step(right, 0), step(below, 0), 0.0, step(right, 1), step(below, 1), 0.0, 0.0, 0.0, 1.0);
    let half = |size: Size| (0.5 * size.width as f64, 0.5 * size.height as f64);
    let ((u, v), (x, y)) = (half(canvas), half(shown));
    moved(x, y) * turn * moved(-u, -v)
}
