//! Writes one colourful picture in every format, depth and space into a directory, to be looked at with other
//! programs, and says how long each took.
//!
//! `cargo run --release -p darkroot-encode --example every_format -- DIRECTORY [WIDTH HEIGHT [PART OF THE NAME]]`

use std::error::Error;
use std::f64::consts::TAU;
use std::fs::File;
use std::path::PathBuf;
use std::time::Instant;

use darkroot_colour::{Matrix3, RgbSpace, TransferCurve, Vector3, white};
use darkroot_encode::{Format, Options};
use darkroot_photo::metadata::{Directory, Value, tag};
use darkroot_photo::{Metadata, Picture, PictureSpace, Samples, Size};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let directory = PathBuf::from(arguments.next().ok_or("name a directory")?);
    let mut side = |otherwise| arguments.next().map_or(Ok(otherwise), |text| text.parse());
    let size = Size { width: side(601)?, height: side(401)? };

    let part = arguments.next().unwrap_or_default();

    for space in [
        RgbSpace::SRGB,
        RgbSpace::DISPLAY_P3,
        RgbSpace::ADOBE_RGB,
        RgbSpace::PROPHOTO,
        RgbSpace::REC2020,
        RgbSpace::ECIRGB_V2,
        RgbSpace::ACES2065_1,
        RgbSpace::SRGB.linear(),
        RgbSpace::REC2020.linear(),
    ] {
        let linear = if space.curve == TransferCurve::Linear { "-linear" } else { "" };
        let stem = format!("{}{linear}", space.name).replace(' ', "-");
        if !stem.contains(&part) {
            continue;
        }
        let colours = colours(size, &space);
        for format in Format::ALL {
            for &bits in format.bits() {
                let picture = picture(size, &colours, bits, PictureSpace::Rgb(space));
                if let Err(why) = format.accepts(&picture.space) {
                    eprintln!("{why}");
                    continue;
                }
                let name = format!("{stem}-{bits}.{}", format.extension());
                let mut file = File::create(directory.join(&name))?;
                let start = Instant::now();
                darkroot_encode::write(&picture, format, &Options::default(), &metadata(), &mut file)?;
                let bytes = file.metadata()?.len();
                eprintln!("{:6} ms {:9} kB  {name}", start.elapsed().as_millis(), bytes / 1000);
            }
        }
    }
    Ok(())
}

/// The same colours in every space: hue to the right, lightness downwards, with a noise of half a percent.
fn colours(size: Size, space: &RgbSpace) -> Vec<f64> {
    let from_srgb: Matrix3 = space.from_xyz_under(white::D50) * RgbSpace::SRGB.to_xyz_under(white::D50);
    let mut noise = 1_u32;
    let mut values = Vec::with_capacity(3 * size.area());
    for y in 0..size.height {
        for x in 0..size.width {
            let (u, v) = (x as f64 / size.width as f64, y as f64 / size.height as f64);
            let srgb = [0.0, 1.0, 2.0].map(|channel| {
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let grain = f64::from(noise >> 16) / 65536.0 * 0.01;
                let value = v * (0.6 + 0.4 * (TAU * (u - channel / 3.0)).cos()) + grain;
                TransferCurve::Srgb.decode(value.clamp(0.0, 1.0))
            });
            let linear = from_srgb * Vector3::from(srgb);
            values.extend(linear.iter().map(|&v| space.curve.encode(v)));
        }
    }
    values
}

fn picture(size: Size, values: &[f64], bits: u8, space: PictureSpace) -> Picture {
    let samples = match bits {
        8 => Samples::U8(values.iter().map(|v| (v * 255.0).round() as u8).collect()),
        16 => Samples::U16(values.iter().map(|v| (v * 65535.0).round() as u16).collect()),
        _ => Samples::F32(values.iter().map(|&v| v as f32).collect()),
    };
    Picture { size, samples, space }
}

fn metadata() -> Metadata {
    let mut metadata = Metadata::default();
    metadata.set(Directory::Image, tag::MAKE, Value::Text("NIKON CORPORATION".into()));
    metadata.set(Directory::Image, tag::MODEL, Value::Text("NIKON D700".into()));
    metadata.set(Directory::Image, tag::ARTIST, Value::Text("Zoë Müller".into()));
    metadata.set(Directory::Exif, tag::EXPOSURE_TIME, Value::Rationals(vec![(1, 250)]));
    metadata.set(Directory::Exif, tag::ISO, Value::Shorts(vec![400]));
    metadata.set(Directory::Exif, tag::LENS_MODEL, Value::Text("AF Nikkor 50mm f/1.8D".into()));
    metadata.set(Directory::Gps, 1, Value::Text("N".into()));
    metadata.set(Directory::Gps, 2, Value::Rationals(vec![(52, 1), (31, 1), (12, 1)]));
    metadata
}
