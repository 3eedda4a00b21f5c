//! Pictures and metadata for the tests.

use std::io::Cursor;

use darkroot_colour::RgbSpace;
use darkroot_photo::metadata::{Directory, Value, tag};
use darkroot_photo::{Metadata, Picture, PictureSpace, Samples, Size};

use crate::{Error, Format, Options};

/// Every space that the program offers, with its transfer curve and linear.
pub(crate) fn spaces() -> Vec<RgbSpace> {
    let curved = [
        RgbSpace::SRGB,
        RgbSpace::DISPLAY_P3,
        RgbSpace::ADOBE_RGB,
        RgbSpace::PROPHOTO,
        RgbSpace::REC2020,
        RgbSpace::ECIRGB_V2,
        RgbSpace::ACES2065_1,
    ];
    curved.iter().flat_map(|space| [*space, space.linear()]).collect()
}

/// A colourful picture: hue to the right, lightness downwards, and a little texture.
pub(crate) fn picture(width: usize, height: usize, bits: u8, space: PictureSpace) -> Picture {
    let mut values = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            let (u, v) = ((x as f64 + 0.5) / width as f64, (y as f64 + 0.5) / height as f64);
            let texture = ((x * 7919 + y * 104_729) % 17) as f64 / 400.0;
            for channel in 0..3 {
                let hue = (std::f64::consts::TAU * (u - f64::from(channel) / 3.0)).cos();
                values.push((v * (0.6 + 0.4 * hue) + texture).clamp(0.0, 1.0));
            }
        }
    }
    let samples = match bits {
        8 => Samples::U8(values.iter().map(|v| (v * 255.0).round() as u8).collect()),
        16 => Samples::U16(values.iter().map(|v| (v * 65535.0).round() as u16).collect()),
        _ => Samples::F32(values.iter().map(|&v| v as f32).collect()),
    };
    Picture { size: Size { width, height }, samples, space }
}

/// A picture that the format accepts, with its default bits.
pub(crate) fn picture_for(format: Format, width: usize, height: usize) -> Picture {
    let space = match format {
        Format::Dng => PictureSpace::Raw,
        Format::Exr => PictureSpace::Rgb(RgbSpace::SRGB.linear()),
        _ => PictureSpace::Rgb(RgbSpace::SRGB),
    };
    picture(width, height, format.default_bits(), space)
}

/// Fields of every type in every directory.
pub(crate) fn metadata() -> Metadata {
    let mut metadata = Metadata::default();
    let text = |s: &str| Value::Text(s.into());
    for (directory, tag, value) in [
        (Directory::Image, tag::MAKE, text("NIKON CORPORATION")),
        (Directory::Image, tag::MODEL, text("NIKON D700")),
        (Directory::Image, tag::ORIENTATION, Value::Shorts(vec![6])),
        (Directory::Image, tag::SOFTWARE, text("Darkroot")),
        (Directory::Image, tag::DATE_TIME, text("2024:05:06 07:08:09")),
        (Directory::Image, tag::ARTIST, text("Zoë Müller")),
        (Directory::Image, tag::COPYRIGHT, text("Zoë Müller, 2024")),
        (Directory::Exif, tag::EXPOSURE_TIME, Value::Rationals(vec![(1, 250)])),
        (Directory::Exif, tag::F_NUMBER, Value::Rationals(vec![(28, 10)])),
        (Directory::Exif, tag::ISO, Value::Shorts(vec![400])),
        (Directory::Exif, tag::DATE_TIME_ORIGINAL, text("2024:05:06 07:08:09")),
        (Directory::Exif, 0x9204, Value::SignedRationals(vec![(-2, 3)])),
        (Directory::Exif, 0x8832, Value::Longs(vec![400])),
        (Directory::Exif, tag::FOCAL_LENGTH, Value::Rationals(vec![(50, 1)])),
        (Directory::Exif, 0x9101, Value::Undefined(vec![1, 2, 3, 0])),
        (Directory::Exif, tag::LENS_MODEL, text("AF Nikkor 50mm f/1.8D")),
        (Directory::Gps, 0, Value::Bytes(vec![2, 3, 0, 0])),
        (Directory::Gps, 1, text("N")),
        (Directory::Gps, 2, Value::Rationals(vec![(52, 1), (31, 1), (12, 1)])),
        (Directory::Gps, 3, text("E")),
        (Directory::Gps, 4, Value::Rationals(vec![(13, 1), (24, 1), (18, 1)])),
    ] {
        metadata.set(directory, tag, value);
    }
    metadata
}

/// The bytes of a file, or why there are none.
pub(crate) fn encoded(picture: &Picture, format: Format, metadata: &Metadata) -> Result<Vec<u8>, Error> {
    let mut file = Cursor::new(Vec::new());
    crate::write(picture, format, &Options::default(), metadata, &mut file)?;
    Ok(file.into_inner())
}

/// Width, height and samples as a reader other than the writer sees them; AVIF has none in pure Rust.
pub(crate) fn decoded(format: Format, file: &[u8]) -> (Size, Samples) {
    match format {
        Format::Jpeg => decoded_by_image(image::ImageFormat::Jpeg, file),
        Format::Png => decoded_by_image(image::ImageFormat::Png, file),
        Format::Tiff => decoded_by_image(image::ImageFormat::Tiff, file),
        Format::Webp => decoded_by_image(image::ImageFormat::WebP, file),
        Format::Exr => decoded_by_exr(file),
        Format::Jxl => decoded_by_jxl_oxide(file),
        Format::Dng => decoded_by_flashraw(file),
        Format::Avif => panic!("no decoder of AV1"),
    }
}

fn decoded_by_image(format: image::ImageFormat, file: &[u8]) -> (Size, Samples) {
    use image::DynamicImage::{ImageRgb8, ImageRgb16, ImageRgb32F};
    let image = image::load_from_memory_with_format(file, format).unwrap();
    let size = Size { width: image.width() as usize, height: image.height() as usize };
    let samples = match image {
        ImageRgb8(image) => Samples::U8(image.into_raw()),
        ImageRgb16(image) => Samples::U16(image.into_raw()),
        ImageRgb32F(image) => Samples::F32(image.into_raw()),
        other => panic!("{:?}", other.color()),
    };
    (size, samples)
}

fn decoded_by_exr(file: &[u8]) -> (Size, Samples) {
    use exr::prelude::*;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), vec![0.0_f32; 3 * size.area()]),
            |(width, samples), at, (r, g, b): (f32, f32, f32)| {
                let start = 3 * (at.y() * *width + at.x());
                samples[start..start + 3].copy_from_slice(&[r, g, b]);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(file))
        .unwrap();
    let size = image.layer_data.size;
    let samples = image.layer_data.channel_data.pixels.1;
    (Size { width: size.width(), height: size.height() }, Samples::F32(samples))
}

fn decoded_by_flashraw(file: &[u8]) -> (Size, Samples) {
    use flashraw::{DecodeOptions, FlashRaw, OutputFormat};
    let options = DecodeOptions { output: OutputFormat::RawU16, ..DecodeOptions::default() };
    let frame = FlashRaw::open(file.to_vec()).unwrap().decode(options).unwrap();
    let size = Size { width: frame.width as usize, height: frame.height as usize };
    (size, Samples::U16(frame.as_u16().unwrap().to_vec()))
}

fn decoded_by_jxl_oxide(file: &[u8]) -> (Size, Samples) {
    let image = jxl_oxide::JxlImage::builder().read(file).unwrap();
    let frame = image.render_frame(0).unwrap().image_all_channels();
    let size = Size { width: frame.width(), height: frame.height() };
    let samples = frame.buf();
    let samples = match image.image_header().metadata.bit_depth.bits_per_sample() {
        8 => Samples::U8(samples.iter().map(|v| (v * 255.0).round() as u8).collect()),
        _ => Samples::U16(samples.iter().map(|v| (v * 65535.0).round() as u16).collect()),
    };
    (size, samples)
}

/// Sizes that have made encoders stumble: one pixel, one row, one column, odd, one more than a block or group.
pub(crate) const SIZES: [(usize, usize); 8] =
    [(1, 1), (7, 1), (1, 7), (2, 2), (17, 13), (33, 300), (256, 256), (257, 259)];

/// The samples come back exactly, in every size and with each of these bits.
#[track_caller]
pub(crate) fn assert_lossless(format: Format, bits: u8, space: PictureSpace) {
    for (width, height) in SIZES {
        let picture = picture(width, height, bits, space);
        let file = encoded(&picture, format, &Metadata::default()).unwrap();
        let (size, samples) = decoded(format, &file);
        assert_eq!(size, picture.size);
        assert!(samples == picture.samples, "{format} {bits} {width} x {height}");
    }
}
