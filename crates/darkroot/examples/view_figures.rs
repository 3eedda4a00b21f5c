//! How far smaller views are from the whole picture reduced to their size, in dE2000: mean and 95th percentile for each
//! file and scale.
//!
//! `cargo run --release -p darkroot --example view_figures -- FILES`

#![allow(clippy::print_stdout)] // Figures are what it is for.

use std::error::Error;

use darkroot::{Cancel, Limits, Photo, ProfileStore, Scale, Settings};
use darkroot_colour::difference::de2000;
use darkroot_colour::{Lab, RgbSpace, Vector3, Xyz, white};
use darkroot_photo::{Picture, Samples};

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:<44} {:>6} {:>7} {:>7}", "file", "scale", "mean", "95 %");
    for path in std::env::args().skip(1) {
        let Ok(photo) = Photo::open(&std::fs::read(&path)?, &Limits::default()) else { continue };
        let plan = photo.plan(&photo.analyse(), &ProfileStore::builtin(), &Settings::default())?;
        let whole = plan.render(plan.whole(Scale::FULL), &Cancel::default())?;
        let name = path.rsplit('/').next().unwrap_or_default();
        for scale in [Scale::HALF, Scale::QUARTER] {
            let view = plan.render(plan.whole(scale), &Cancel::default())?;
            let (mean, most) = differences(&whole, &view, scale.bin());
            println!("{name:<44} {:>6} {mean:>7.3} {most:>7.3}", format!("1/{}", scale.bin()));
        }
    }
    Ok(())
}

/// Mean and 95th percentile over the pixels that are whole.
fn differences(whole: &Picture, view: &Picture, bin: usize) -> (f64, f64) {
    let to_xyz = RgbSpace::SRGB.to_xyz_under(white::D50);
    let lab = |rgb: [f64; 3]| -> Lab { Xyz::from(to_xyz * Vector3::from(rgb)).lab(white::D50) };
    let mut off = Vec::new();
    for y in 0..whole.size.height / bin {
        for x in 0..whole.size.width / bin {
            let mut reduced = [0.0; 3];
            for i in 0..bin * bin {
                let rgb = linear(whole, x * bin + i % bin, y * bin + i / bin);
                reduced = [0, 1, 2].map(|c| reduced[c] + rgb[c] / (bin * bin) as f64);
            }
            off.push(de2000(lab(reduced), lab(linear(view, x, y))));
        }
    }
    off.sort_by(f64::total_cmp);
    let mean = off.iter().sum::<f64>() / off.len().max(1) as f64;
    (mean, off.get(off.len() * 95 / 100).copied().unwrap_or(0.0))
}

/// Linear light of a pixel in sRGB.
fn linear(picture: &Picture, x: usize, y: usize) -> [f64; 3] {
    let first = 3 * (y * picture.size.width + x);
    [0, 1, 2].map(|c| match &picture.samples {
        Samples::U8(v) => RgbSpace::SRGB.curve.decode(f64::from(v[first + c]) / 255.0),
        Samples::U16(v) => RgbSpace::SRGB.curve.decode(f64::from(v[first + c]) / 65535.0),
        Samples::F32(v) => f64::from(v[first + c]),
    })
}
