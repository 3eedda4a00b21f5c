//! A small developed picture for the first directory of a file.

use darkroot_colour::{Matrix3, RgbSpace, Vector3, white};
use darkroot_photo::{AsShot, Capture, Counts, Layout, Size};

use crate::exact::root_2_4;

/// Longest side of a preview, pixels.
const LONGEST: usize = 160;

/// 8-bit sRGB of the active area, as stored (not turned): R, G, B of each pixel.
pub(crate) fn preview(capture: &Capture) -> (Size, Vec<u8>) {
    let area = capture.active_area;
    let block = area.width.max(area.height).div_ceil(LONGEST).max(block_of(capture.counts.layout()));
    let size = Size { width: (area.width / block).max(1), height: (area.height / block).max(1) };
    let neutral = match capture.as_shot {
        Some(AsShot::Neutral(neutral)) => Vector3::from(neutral),
        _ => Vector3::repeat(1.0),
    };
    let forward =
        capture.calibrations.last().and_then(|c| c.forward_matrix).unwrap_or_else(Matrix3::identity);
    let to_srgb = RgbSpace::SRGB.from_xyz_under(white::D50) * forward;

    let mut bytes = Vec::with_capacity(3 * size.area());
    for y in 0..size.height {
        for x in 0..size.width {
            let rgb = Vector3::from(mean(capture, area.x + x * block, area.y + y * block, block));
            let balanced = rgb.component_div(&neutral).map(|v| v.min(1.0));
            bytes.extend((to_srgb * balanced).iter().map(|&v| encode(v)));
        }
    }
    (size, bytes)
}

/// Side of a block that holds every filter.
fn block_of(layout: &Layout) -> usize {
    match layout {
        Layout::Cfa(cfa) => cfa.width().max(cfa.height()),
        Layout::Monochrome | Layout::Rgb => 1,
    }
}

/// Mean share of saturation of the samples of each colour in a square block.
fn mean(capture: &Capture, left: usize, top: usize, block: usize) -> [f64; 3] {
    let (mut sums, mut numbers) = ([0.0; 3], [0.0f64; 3]);
    let size = capture.counts.size();
    let planes = capture.counts.layout().planes();
    for y in top..(top + block).min(size.height) {
        for x in left..(left + block).min(size.width) {
            for plane in 0..planes {
                let i = (y * size.width + x) * planes + plane;
                let value = match &capture.counts {
                    Counts::U16(m) => f64::from(m.samples[i]),
                    Counts::F32(m) => f64::from(m.samples[i]),
                };
                let black = f64::from(capture.black.at(x, y, plane));
                let share = (value - black) / (f64::from(capture.white.0[plane]) - black);
                let colours = match capture.counts.layout() {
                    Layout::Rgb => plane..plane + 1,
                    Layout::Cfa(cfa) => cfa.at(x, y).plane().map_or(0..0, |p| p..p + 1),
                    Layout::Monochrome => 0..3,
                };
                for c in colours {
                    sums[c] += share;
                    numbers[c] += 1.0;
                }
            }
        }
    }
    std::array::from_fn(|c| sums[c] / numbers[c].max(1.0))
}

/// The sRGB curve (IEC 61966-2-1) in 8 bits.
fn encode(linear: f64) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * root_2_4(v) - 0.055 };
    (encoded * 255.0).round() as u8
}
