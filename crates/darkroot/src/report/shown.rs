//! The picture of the chart with what was found in it.

use std::fmt::Write as _;
use std::io::Cursor;

use darkroot_chart::Quad;
use darkroot_colour::{RgbSpace, Vector3, white};
use darkroot_photo::metadata::Metadata;
use darkroot_photo::{Picture, PictureSpace, Samples, Size};

use crate::calibrate::Calibrated;
use crate::shot::{Shot, View};

/// Longest side of the picture.
const LONGEST: usize = 1000;

/// The picture in the profile's own colours, with grid, windows and numbers over it.
pub(super) fn picture(view: &View, calibrated: &Calibrated, shot: &Shot) -> String {
    let least = view.bin();
    let longest = view.size.width.max(view.size.height);
    let bin = (1..).map(|k| k * least).find(|bin| longest / bin <= LONGEST).unwrap_or(least);
    let jpeg = jpeg(view, calibrated, bin);
    let Size { width, height } = view.size;
    format!(
        "<figure class=\"picture\"><div class=\"frame\"><img alt=\"the shot\" src=\"data:image/jpeg;base64,{}\">{}</div>\
         <figcaption>The shot through the profile, with the chart as it was found.</figcaption></figure>",
        base64(&jpeg),
        overlay(shot, Size { width, height })
    )
}

/// Grid, windows and numbers as SVG in pixels of the developed picture.
fn overlay(shot: &Shot, size: Size) -> String {
    let mut svg = format!(
        "<svg viewBox=\"-0.5 -0.5 {} {}\" preserveAspectRatio=\"none\" fill=\"none\">",
        size.width, size.height
    );
    let points =
        |quad: &Quad| quad.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ");
    let stroke = size.width as f64 / 400.0;
    let _ = write!(
        svg,
        "<polygon points=\"{}\" stroke=\"#ff0\" stroke-width=\"{stroke}\"/>",
        points(&shot.corners)
    );
    for (i, window) in shot.windows.iter().enumerate() {
        let [x, y] = [0, 1].map(|k| window.iter().map(|p| p[k]).sum::<f64>() / 4.0);
        let font = (window[1][0] - window[0][0]).hypot(window[1][1] - window[0][1]) * 0.45;
        let _ = write!(
            svg,
            "<polygon points=\"{}\" stroke=\"#fff\" stroke-width=\"{}\"/><text x=\"{x:.1}\" y=\"{:.1}\" \
             font-size=\"{font:.1}\" fill=\"#fff\" text-anchor=\"middle\">{}</text>",
            points(window),
            stroke / 2.0,
            y + font / 3.0,
            i + 1
        );
    }
    svg.push_str("</svg>");
    svg
}

fn jpeg(view: &View, calibrated: &Calibrated, bin: usize) -> Vec<u8> {
    let (size, planes) = view.binned(bin);
    let to_srgb = RgbSpace::SRGB.from_xyz_under(white::D50);
    let pixel = |i: usize| {
        let balanced = [0, 1, 2].map(|c| f64::from(planes[c][i]) / calibrated.white_rgb[c]);
        let linear: [f64; 3] = (to_srgb * Vector3::from(calibrated.calibration.model.xyz(balanced))).into();
        linear.map(|v| (RgbSpace::SRGB.curve.encode(v.clamp(0.0, 1.0)) * 255.0).round() as u8)
    };
    let samples = (0..size.area()).flat_map(pixel).collect();
    let picture = Picture { size, samples: Samples::U8(samples), space: PictureSpace::Rgb(RgbSpace::SRGB) };
    let mut out = Cursor::new(Vec::new());
    let options = darkroot_encode::Options { quality: 85, ..darkroot_encode::Options::default() };
    // In memory, of a picture of ordinary size: nothing that could fail. A missing picture would be seen.
    let _ = darkroot_encode::write(
        &picture,
        darkroot_encode::Format::Jpeg,
        &options,
        &Metadata::default(),
        &mut out,
    );
    out.into_inner()
}

/// RFC 4648, section 4.
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0u32, |w, b| w << 8 | u32::from(*b)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        // RFC 4648, section 10.
        for (bytes, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
