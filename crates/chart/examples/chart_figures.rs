//! Figures of chart detection on photographs with labelled charts:
//! `cargo run --release -p darkroot-chart --example chart_figures -- FOLDER [OVERLAYS]`.
//! FOLDER holds `labels.json` as its README describes it; with OVERLAYS pictures of what was found are written there.

#![allow(clippy::print_stdout)]

use std::path::Path;
use std::time::Instant;

use darkroot_chart::{ChartLayout, Found, Options, detect};

#[path = "../tests/labelled/mod.rs"]
mod labelled;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("which folder of labelled charts?")?;
    let overlays = arguments.next();
    let layouts = ChartLayout::builtin();
    let mut totals = labelled::Totals::default();
    println!("{:44} {:>10} {:>7} {:>8} {:>7} {:>5}", "picture", "label", "usable", "error", "turned", "ms");
    for photo in labelled::read(Path::new(&folder))? {
        let picture = labelled::open(&photo.path)?;
        let start = Instant::now();
        let search = detect::search(&picture, &layouts, &Options::default());
        let milliseconds = start.elapsed().as_millis();
        let mut outcome = labelled::compare(&photo, &search.found);
        totals.add(&outcome);
        let name: String = photo.name.chars().take(44).collect();
        for line in outcome.lines.drain(..) {
            println!("{name:44} {line} {milliseconds:>5}");
        }
        for found in &outcome.invented {
            println!("{name:44} INVENTED {} at {:?}", found.layout, found.corners[0]);
        }
        for f in &search.found {
            println!(
                "    {} confidence {:.2} turn {:.1} gap {:.3} {:.3} patch {:.1} edges {:.2} error {:.4} unexplained {:.3}",
                f.layout,
                f.confidence,
                f.rotation_degrees,
                f.gap[0],
                f.gap[1],
                f.patch_pixels,
                f.edges_seen,
                f.edge_error,
                f.unexplained
            );
        }
        if let Some(rejected) = &search.rejected {
            println!("    refused ({:.2}): {}", rejected.nearness, rejected.reason);
        }
        if let Some(overlays) = &overlays {
            overlay(&photo.path, &search.found, &Path::new(overlays).join(format!("{}.png", photo.name)))?;
        }
    }
    println!("{totals}");
    Ok(())
}

fn overlay(from: &Path, found: &[Found], to: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut picture = image::open(from)?.to_rgb8();
    for f in found {
        for i in 0..f.columns * f.rows {
            let quad = f.patch(i, 0.0);
            let colour = if i == 0 { [255, 0, 0] } else { [255, 255, 255] };
            for k in 0..4 {
                let (a, b) = (quad[k], quad[(k + 1) % 4]);
                for step in 0..=400 {
                    let t = f64::from(step) / 400.0;
                    let (x, y) = (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
                    if let Some(pixel) = picture.get_pixel_mut_checked(x.round() as u32, y.round() as u32) {
                        *pixel = image::Rgb(colour);
                    }
                }
            }
        }
    }
    image::DynamicImage::from(picture).thumbnail(1000, 1000).save(to)?;
    Ok(())
}
