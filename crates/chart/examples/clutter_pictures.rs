//! Pictures of things with rows and columns that are no charts, for other programs to look at:
//! `cargo run --release -p darkroot-chart --example clutter_pictures -- FOLDER [OF-EACH-KIND]`.
//! They are those of the test `clutter`, with the curve of sRGB, as PNG; 20 of each kind if not said otherwise.

use std::path::Path;

#[path = "../tests/scene/mod.rs"]
mod scene;

use scene::clutter::{KINDS, picture};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("which folder shall the pictures go to?")?;
    let each: u64 = arguments.next().map_or(Ok(20), |n| n.parse())?;
    std::fs::create_dir_all(&folder)?;
    for kind in KINDS {
        for number in 0..each {
            let picture = picture(kind, number);
            let byte =
                |v: f32| (darkroot_colour::TransferCurve::Srgb.encode(f64::from(v)) * 255.0).round() as u8;
            let pixel = |i: usize| picture.planes.each_ref().map(|plane| byte(plane[i]));
            let bytes = (0..picture.width * picture.height).flat_map(pixel).collect();
            let (width, height) = (u32::try_from(picture.width)?, u32::try_from(picture.height)?);
            let png = image::RgbImage::from_raw(width, height, bytes).ok_or("a plane is too short")?;
            png.save(Path::new(&folder).join(format!("{}-{number}.png", kind.replace(' ', "-"))))?;
        }
    }
    Ok(())
}
