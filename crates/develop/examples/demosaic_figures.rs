//! Prints what each demosaicing method reaches on two sets of reference pictures, and how fast.
//!
//! `cargo run --release -p darkroot-develop --example demosaic_figures -- [DIRECTORY [OUT]]`
//!
//! DIRECTORY has `kodak/*.png` and `mcm/*.png`; without it, `demosaic` in the directory that `DARKROOT_DATA` names.
//! The figure is the peak signal-to-noise ratio in dB over the three channels of a picture, 10 pixels cut off on each
//! side, its mean over the pictures of a set. "Display" takes the stored values for light; "Linear" decodes them
//! first, demosaics, and encodes again. OUT gets the pictures of "Linear".

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use darkroot_colour::TransferCurve::{self, Linear, Srgb};
use darkroot_develop::demosaic::{Method, demosaic};
use darkroot_photo::{CameraSpace, Cfa, Layout, Mosaic, Rgb, Size};
use image::RgbImage;

const BAYER: &str = "RGGB";
const X_TRANS: &str = "GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG";
const METHODS: [(&str, Method); 4] = [
    (BAYER, Method::Lmmse),
    (BAYER, Method::Bilinear),
    (X_TRANS, Method::XTrans),
    (X_TRANS, Method::Bilinear),
];
const SETS: [&str; 2] = ["kodak", "mcm"];
/// Pixels on each side that do not count.
const CUT: usize = 10;
/// A tile as the pipeline cuts it.
const TILE: Size = Size { width: 512, height: 96 };

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let data = || std::env::var_os("DARKROOT_DATA").map(|data| Path::new(&data).join("demosaic"));
    let directory = arguments.next().map(PathBuf::from).or_else(data).ok_or("name a directory")?;
    let out = arguments.next().map(PathBuf::from);

    println!("{:<62} {:<8} {:>13} {:>13}  MP/s on one thread", "method", "array", "Display", "Linear");
    for (letters, method) in METHODS {
        let cfa = Cfa::parse(letters).ok_or("no array")?;
        let mut figures = Vec::new();
        for curve in [Linear, Srgb] {
            for set in SETS {
                let mut ratios = Vec::new();
                for path in pictures(&directory.join(set))? {
                    let original = image::open(&path)?.to_rgb8();
                    let result = develop(&original, &cfa, method, curve);
                    ratios.push(ratio(&original, &result));
                    if let (Some(out), Srgb) = (&out, curve) {
                        let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("picture");
                        let name = format!("{set}-{name}-{}-{method:?}.png", cfa.width());
                        save(&result, original.dimensions(), &out.join(name))?;
                    }
                }
                figures.push(ratios.iter().sum::<f64>() / ratios.len().max(1) as f64);
            }
        }
        let array = if cfa.is_bayer() { BAYER } else { "X-Trans" };
        let pair = |i: usize| format!("{:.2}/{:.2}", figures[i], figures[i + 1]);
        let name = method.name();
        println!("{name:<62} {array:<8} {:>13} {:>13}  {:.1}", pair(0), pair(2), speed(&cfa, method));
    }
    Ok(())
}

fn pictures(directory: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let entries = fs::read_dir(directory).map_err(|error| format!("{}: {error}", directory.display()))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "png"));
    paths.sort();
    Ok(paths)
}

/// Takes the picture through the array, beyond its edges its mirror image, and demosaics it; encoded values.
fn develop(original: &RgbImage, cfa: &Cfa, method: Method, curve: TransferCurve) -> Vec<[f64; 3]> {
    let light: Vec<f32> = (0..=255u8).map(|v| curve.decode(f64::from(v) / 255.0) as f32).collect();
    let border = method.stage().border;
    let (width, height) = (original.width() as usize, original.height() as usize);
    let size = Size { width: width + 2 * border, height: height + 2 * border };
    let mirrored = |at: usize, length: usize| {
        let at = at.abs_diff(border);
        at.min(2 * (length - 1) - at)
    };
    let sample = |i: usize| {
        let (x, y) = (i % size.width, i / size.width);
        let pixel = original.get_pixel(mirrored(x, width) as u32, mirrored(y, height) as u32);
        light[usize::from(pixel[cfa.at(x, y).plane().unwrap_or(1)])]
    };
    let samples = (0..size.area()).map(sample).collect();
    let mut picture = Rgb::<CameraSpace>::black(size);
    let mosaic = Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples };
    demosaic(&mosaic, method, border, &mut picture);
    let [r, g, b] = picture.planes();
    let encode = |v: f32| curve.encode(f64::from(v).clamp(0.0, 1.0));
    r.iter().zip(g).zip(b).map(|((r, g), b)| [encode(*r), encode(*g), encode(*b)]).collect()
}

/// Peak signal-to-noise ratio in dB.
fn ratio(original: &RgbImage, result: &[[f64; 3]]) -> f64 {
    let (width, height) = (original.width() as usize, original.height() as usize);
    let (mut sum, mut count) = (0.0, 0.0);
    for y in CUT..height - CUT {
        for x in CUT..width - CUT {
            let pixel = original.get_pixel(x as u32, y as u32).0;
            for (a, b) in pixel.into_iter().zip(result[y * width + x]) {
                sum += (f64::from(a) / 255.0 - b).powi(2);
                count += 1.0;
            }
        }
    }
    -10.0 * (sum / count).log10()
}

fn save(result: &[[f64; 3]], (width, height): (u32, u32), path: &Path) -> Result<(), Box<dyn Error>> {
    let bytes = result.iter().flatten().map(|v| (v * 255.0 + 0.5) as u8).collect();
    let picture = RgbImage::from_raw(width, height, bytes).ok_or("no picture")?;
    Ok(picture.save(path)?)
}

/// Megapixels a second of one thread: the best of many tiles.
fn speed(cfa: &Cfa, method: Method) -> f64 {
    let border = method.stage().border;
    let size = Size { width: TILE.width + 2 * border, height: TILE.height + 2 * border };
    let samples = (0..size.area()).map(|i| (i * 7919 % 1000) as f32 / 1000.0).collect();
    let mosaic = Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples };
    let mut picture = Rgb::<CameraSpace>::black(TILE);
    let mut best = Duration::MAX;
    for _ in 0..100 {
        let start = Instant::now();
        demosaic(black_box(&mosaic), method, border, &mut picture);
        black_box(&picture);
        best = best.min(start.elapsed());
    }
    TILE.area() as f64 / best.as_secs_f64() / 1e6
}
