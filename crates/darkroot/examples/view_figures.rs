//! How far smaller views are from the whole picture reduced to their size, in dE2000: mean and 95th percentile for each
//! file and scale.
//!
//! `cargo run --release -p darkroot --example view_figures -- FILES`

use std::error::Error;

use darkroot::{Cancel, Limits, Photo, ProfileStore, Scale, Settings};
use darkroot_colour::difference::de2000;
use darkroot_colour::{Lab, RgbSpace, Vector3, Xyz, white};
use darkroot_photo::{Picture, Samples, Size};

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
    let light: Vec<f64> = (0..=255u8).map(|v| RgbSpace::SRGB.curve.decode(f64::from(v) / 255.0)).collect();
    let (Samples::U8(all), Samples::U8(small)) = (&whole.samples, &view.samples) else { return (0.0, 0.0) };
    let linear = |samples: &[u8], size: Size, x: usize, y: usize, c: usize| {
        light[usize::from(samples[3 * (y * size.width + x) + c])]
    };
    let to_xyz = RgbSpace::SRGB.to_xyz_under(white::D50);
    let lab = |rgb: [f64; 3]| -> Lab { Xyz::from(to_xyz * Vector3::from(rgb)).lab(white::D50) };
    let mut off = Vec::new();
    for y in 0..whole.size.height / bin {
        for x in 0..whole.size.width / bin {
            let reduced = [0, 1, 2].map(|c| {
                let all =
                    (0..bin * bin).map(|i| linear(all, whole.size, x * bin + i % bin, y * bin + i / bin, c));
                all.sum::<f64>() / (bin * bin) as f64
            });
            let seen = [0, 1, 2].map(|c| linear(small, view.size, x, y, c));
            off.push(de2000(lab(reduced), lab(seen)));
        }
    }
    off.sort_by(f64::total_cmp);
    let mean = off.iter().sum::<f64>() / off.len().max(1) as f64;
    (mean, off.get(off.len() * 95 / 100).copied().unwrap_or(0.0))
}
