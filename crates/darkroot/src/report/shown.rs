//! The picture of the chart with what was found in it.

use std::io::Cursor;

use darkroot_chart::Quad;
use darkroot_colour::{RgbSpace, Vector3, white};
use darkroot_photo::metadata::Metadata;
use darkroot_photo::{Picture, PictureSpace, Samples, Size};
use maud::{Markup, html};

use crate::page::base64;
use crate::shot::{Shot, View};
use darkroot_calibrate::Calibrated;

/// Longest side of the picture.
const LONGEST: usize = 1000;

/// The picture in the profile's own colours, with grid, windows and numbers over it.
pub(super) fn picture(view: &View, calibrated: &Calibrated, shot: &Shot) -> Markup {
    let least = view.bin();
    let longest = view.size.width.max(view.size.height);
    let bin = (1..).map(|k| k * least).find(|bin| longest / bin <= LONGEST).unwrap_or(least);
    let jpeg = jpeg(view, calibrated, bin);
    html! {
        figure.picture {
            div.frame {
                img alt="the shot" src=(format!("data:image/jpeg;base64,{}", base64(&jpeg)));
                (overlay(&shot.corners, &shot.windows, view.size))
            }
            figcaption { "The shot through the profile, with the chart as it was found." }
        }
    }
}

/// Grid, windows and numbers as SVG in pixels of the developed picture.
pub(super) fn overlay(corners: &Quad, windows: &[Quad], size: Size) -> Markup {
    let points =
        |quad: &Quad| quad.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ");
    let stroke = size.width as f64 / 400.0;
    let number = |i: usize, window: &Quad| {
        let [x, y] = [0, 1].map(|k| window.iter().map(|p| p[k]).sum::<f64>() / 4.0);
        let font = (window[1][0] - window[0][0]).hypot(window[1][1] - window[0][1]) * 0.45;
        let (x, y, size) = (format!("{x:.1}"), format!("{:.1}", y + font / 3.0), format!("{font:.1}"));
        html! { text x=(x) y=(y) font-size=(size) fill="#fff" text-anchor="middle" { (i + 1) } }
    };
    let view_box = format!("-0.5 -0.5 {} {}", size.width, size.height);
    html! {
        svg viewBox=(view_box) preserveAspectRatio="none" fill="none" {
            polygon points=(points(corners)) stroke="#ff0" stroke-width=(stroke) {}
            @for (i, window) in windows.iter().enumerate() {
                polygon points=(points(window)) stroke="#fff" stroke-width=(stroke / 2.0) {}
                (number(i, window))
            }
        }
    }
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
    jpeg_of(size, samples)
}

/// Eight bits of sRGB as a JPEG.
pub(super) fn jpeg_of(size: Size, samples: Vec<u8>) -> Vec<u8> {
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
