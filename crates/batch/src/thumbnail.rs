//! Small pictures for contact sheets.

use darkroot_colour::RgbSpace;
use darkroot_encode::{ChromaSubsampling, Format, Options};
use darkroot_photo::{Metadata, Picture, PictureSpace, Samples, Size};

/// Longest side in pixels.
const LONGEST: usize = 240;
/// Pixels of a box that are looked at, each way.
const LOOKS: usize = 3;
/// JPEG quality.
const QUALITY: u8 = 78;

/// A small JPEG of a developed picture, as base 64.
pub(crate) fn of_picture(picture: &Picture) -> Option<String> {
    let space = match picture.space {
        PictureSpace::Rgb(space) => space,
        PictureSpace::Camera | PictureSpace::Raw => RgbSpace::SRGB.linear(),
    };
    let white = darkroot_colour::white::D65;
    let to_srgb = RgbSpace::SRGB.from_xyz_under(white) * space.to_xyz_under(white);
    let value = |i: usize| match &picture.samples {
        Samples::U8(s) => f64::from(s[i]) / 255.0,
        Samples::U16(s) => f64::from(s[i]) / 65535.0,
        Samples::F32(s) => f64::from(s[i]),
    };
    let pixel = |x: usize, y: usize| {
        let at = 3 * (y * picture.size.width + x);
        let linear = [0, 1, 2].map(|c| space.curve.decode(value(at + c).clamp(0.0, 1.0)));
        (to_srgb * darkroot_colour::Vector3::from(linear)).into()
    };
    small(picture.size, pixel)
}

/// A small JPEG of a picture's file; `None` for formats that this cannot read.
pub(crate) fn of_file(bytes: &[u8]) -> Option<String> {
    let picture = image::load_from_memory(bytes).ok()?.into_rgb8();
    let size = Size { width: picture.width() as usize, height: picture.height() as usize };
    let curve = RgbSpace::SRGB.curve;
    let pixel = |x: usize, y: usize| {
        picture.get_pixel(x as u32, y as u32).0.map(|v| curve.decode(f64::from(v) / 255.0))
    };
    small(size, pixel)
}

/// Averages linear sRGB over boxes, from a few pixels of each.
fn small(size: Size, pixel: impl Fn(usize, usize) -> [f64; 3]) -> Option<String> {
    if size.area() == 0 {
        return None;
    }
    let scale = (size.width.max(size.height)).div_ceil(LONGEST).max(1);
    let small = Size { width: (size.width / scale).max(1), height: (size.height / scale).max(1) };
    let step = scale.div_ceil(LOOKS);
    let mut samples = Vec::with_capacity(3 * small.area());
    for y in 0..small.height {
        for x in 0..small.width {
            let mut sum = [0.0; 3];
            let mut count = 0.0;
            for row in (y * scale..((y + 1) * scale).min(size.height)).step_by(step) {
                for column in (x * scale..((x + 1) * scale).min(size.width)).step_by(step) {
                    let p = pixel(column, row);
                    sum = [sum[0] + p[0], sum[1] + p[1], sum[2] + p[2]];
                    count += 1.0;
                }
            }
            let curve = RgbSpace::SRGB.curve;
            samples.extend(sum.map(|v| {
                let encoded = curve.encode((v / count).clamp(0.0, 1.0));
                (encoded * 255.0 + 0.5) as u8
            }));
        }
    }
    let picture =
        Picture { size: small, samples: Samples::U8(samples), space: PictureSpace::Rgb(RgbSpace::SRGB) };
    let options = Options { quality: QUALITY, subsampling: ChromaSubsampling::S420, ..Options::default() };
    let mut out = std::io::Cursor::new(Vec::new());
    darkroot_encode::write(&picture, Format::Jpeg, &options, &Metadata::default(), &mut out).ok()?;
    Some(darkroot::page::base64(&out.into_inner()))
}
