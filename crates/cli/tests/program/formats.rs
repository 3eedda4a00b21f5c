//! Every format, colour space and depth: what should work does, and opens with another reader; what cannot is
//! refused with what to do instead.

use std::io::Cursor;

use image::ImageDecoder;
use image::codecs::{jpeg::JpegDecoder, png::PngDecoder, webp::WebPDecoder};

use super::*;

const BENT: [&str; 6] = ["srgb", "display-p3", "adobe-rgb", "prophoto", "rec2020", "ecirgb-v2"];
const LINEAR: [&str; 7] = [
    "srgb-linear",
    "display-p3-linear",
    "adobe-rgb-linear",
    "prophoto-linear",
    "rec2020-linear",
    "ecirgb-v2-linear",
    "aces2065-1",
];
const FORMATS: [(&str, &str); 7] = [
    ("jpeg", "jpg"),
    ("png", "png"),
    ("tiff", "tif"),
    ("webp", "webp"),
    ("avif", "avif"),
    ("exr", "exr"),
    ("jxl", "jxl"),
];

/// Whether a format can hold a space in so many bits, as the README of `encode` promises.
fn works(format: &str, space: &str, bits: u8) -> bool {
    let camera = space == "camera";
    match format {
        "jpeg" | "webp" | "avif" => bits == 8 && !camera,
        "png" => bits != 32 && !camera,
        "tiff" => !camera || bits == 32,
        "exr" => bits == 32 && (camera || LINEAR.contains(&space)),
        // It has no name for the curves of these two.
        "jxl" => bits != 32 && !["prophoto", "ecirgb-v2", "camera"].contains(&space),
        other => panic!("{other}"),
    }
}

/// What another reader finds in a file.
struct Found {
    size: (u32, u32),
    bits: u8,
    icc: Option<Vec<u8>>,
}

fn read(format: &str, bytes: &[u8]) -> Found {
    fn of(decoder: impl ImageDecoder) -> Found {
        let mut decoder = decoder;
        let bits =
            (decoder.color_type().bits_per_pixel() / u16::from(decoder.color_type().channel_count())) as u8;
        let (size, icc) = (decoder.dimensions(), decoder.icc_profile().unwrap());
        // The pixels must be there too.
        let mut pixels = vec![0; decoder.total_bytes() as usize];
        decoder.read_image(&mut pixels).unwrap();
        assert!(pixels.iter().any(|&p| p != pixels[0]));
        Found { size, bits, icc }
    }
    let file = Cursor::new(bytes);
    match format {
        "jpeg" => of(JpegDecoder::new(file).unwrap()),
        "png" => of(PngDecoder::new(file).unwrap()),
        "webp" => of(WebPDecoder::new(file).unwrap()),
        "tiff" => {
            let mut decoder = tiff::decoder::Decoder::new(file).unwrap();
            let bits = match decoder.read_image().unwrap() {
                tiff::decoder::DecodingResult::U8(_) => 8,
                tiff::decoder::DecodingResult::U16(_) => 16,
                tiff::decoder::DecodingResult::F32(_) => 32,
                _ => panic!("samples of another type"),
            };
            let icc = decoder.get_tag_u8_vec(tiff::tags::Tag::IccProfile).ok();
            Found { size: decoder.dimensions().unwrap(), bits, icc }
        }
        "exr" => {
            use exr::prelude::*;
            let image =
                read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
            let image = image.from_buffered(file).unwrap();
            let layer = &image.layer_data[0];
            let names: Vec<String> = layer.channel_data.list.iter().map(|c| c.name.to_string()).collect();
            assert_eq!(names, ["B", "G", "R"]);
            Found { size: (layer.size.0 as u32, layer.size.1 as u32), bits: 32, icc: None }
        }
        "jxl" => {
            let image = jxl_oxide::JxlImage::builder().read(file).unwrap();
            let frame = image.render_frame(0).unwrap();
            assert!(frame.image_all_channels().buf().iter().all(|v| v.is_finite()));
            let bits = image.image_header().metadata.bit_depth.bits_per_sample() as u8;
            Found { size: (image.width(), image.height()), bits, icc: None }
        }
        "avif" => {
            // No reader is at hand: the boxes say what is in it (ISO 23008-12, `ispe`).
            assert_eq!(&bytes[4..12], b"ftypavif");
            let at = bytes.windows(4).position(|w| w == b"ispe").unwrap() + 8;
            let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
            let profile = bytes.windows(8).position(|w| w == b"colrprof");
            let icc = profile.map(|at| bytes[at + 8..at + number(at - 4) as usize - 4].to_vec());
            Found { size: (number(at), number(at + 4)), bits: 8, icc }
        }
        other => panic!("{other}"),
    }
}

#[test]
fn every_format_space_and_depth_that_should_work_opens_with_another_reader() {
    let desk = Desk::with_dng();
    for (format, ending) in FORMATS {
        for space in BENT.into_iter().chain(LINEAR).chain(["camera"]) {
            for bits in [8, 16, 32] {
                if !works(format, space, bits) {
                    continue;
                }
                let name = format!("o.{ending}");
                desk.develop(&[
                    "a.dng",
                    "-o",
                    &name,
                    "--overwrite",
                    "--space",
                    space,
                    "--bits",
                    &bits.to_string(),
                ]);
                let found = read(format, &desk.read(&name));
                let what = format!("{format} {space} {bits}");
                assert_eq!((found.size, found.bits), ((WIDTH, HEIGHT), bits), "{what}");
                // AVIF names these by number.
                let is_named = format == "avif" && ["srgb", "display-p3", "rec2020"].contains(&space);
                let has_profile = ["jpeg", "png", "tiff", "webp", "avif"].contains(&format)
                    && space != "camera"
                    && !is_named;
                assert_eq!(found.icc.is_some(), has_profile, "{what}");
                if let Some(icc) = found.icc {
                    assert_eq!(&icc[36..40], b"acsp", "{what}");
                    assert_eq!(&icc[12..24], b"mntrRGB XYZ ", "{what}");
                    assert_eq!(
                        u32::from_be_bytes(icc[..4].try_into().unwrap()) as usize,
                        icc.len(),
                        "{what}"
                    );
                }
            }
        }
    }
    assert_eq!(desk.names().len(), 1 + FORMATS.len());
}

#[test]
fn every_format_space_and_depth_that_cannot_work_is_refused_with_what_to_do() {
    let desk = Desk::with_dng();
    for (format, ending) in FORMATS {
        for space in BENT.into_iter().chain(LINEAR).chain(["camera"]) {
            for bits in [8, 16, 32] {
                if works(format, space, bits) {
                    continue;
                }
                let name = format!("o.{ending}");
                let arguments =
                    ["develop", "a.dng", "-o", &name, "--space", space, "--bits", &bits.to_string()];
                let run = desk.fails(2, &arguments, &[]);
                let helpful = ["choose", "write a", "use `"].iter().any(|word| run.err.contains(word));
                assert!(helpful, "{format} {space} {bits}: {}", run.err);
            }
        }
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn a_picture_in_another_space_is_another_profile() {
    let desk = Desk::with_dng();
    let mut profiles = Vec::new();
    for space in BENT.into_iter().chain(LINEAR) {
        desk.develop(&["a.dng", "-o", "o.png", "--overwrite", "--space", space]);
        profiles.push(read("png", &desk.read("o.png")).icc.unwrap());
    }
    let count = profiles.len();
    profiles.sort();
    profiles.dedup();
    assert_eq!(profiles.len(), count);
}

#[test]
fn without_options_each_format_has_its_usual_depth_and_space() {
    let desk = Desk::with_dng();
    for (format, ending, bits) in [
        ("jpeg", "jpg", 8),
        ("png", "png", 8),
        ("tiff", "tif", 16),
        ("webp", "webp", 8),
        ("jxl", "jxl", 8),
        ("exr", "exr", 32),
    ] {
        let name = format!("o.{ending}");
        let run = desk.develop(&["a.dng", "-o", &name]);
        assert_eq!(read(format, &desk.read(&name)).bits, bits, "{format}");
        let space = if format == "exr" { "sRGB, linear" } else { "sRGB" };
        assert!(run.err.contains(&format!("{space}, {bits} bits")), "{format}: {}", run.err);
    }
}

#[test]
fn lossless_formats_hold_the_same_pixels() {
    let desk = Desk::with_dng();
    for bits in ["8", "16"] {
        desk.develop(&["a.dng", "-o", "o.png", "--bits", bits, "--overwrite"]);
        let png = image::open(desk.path("o.png")).unwrap();
        desk.develop(&["a.dng", "-o", "o.tif", "--bits", bits, "--overwrite"]);
        assert!(image::open(desk.path("o.tif")).unwrap() == png, "TIFF of {bits} bits");
        if bits == "8" {
            desk.develop(&["a.dng", "-o", "o.webp"]);
            assert!(image::open(desk.path("o.webp")).unwrap() == png, "WebP");
        }
        desk.develop(&["a.dng", "-o", "o.jxl", "--bits", bits, "--overwrite"]);
        let jxl = jxl_oxide::JxlImage::builder().open(desk.path("o.jxl")).unwrap();
        let frame = jxl.render_frame(0).unwrap().image_all_channels();
        let png: Vec<f32> = png.to_rgb32f().into_raw();
        let most = frame.buf().iter().zip(&png).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most < 1e-5, "JPEG XL of {bits} bits: {most}");
    }
}

#[test]
fn lossy_formats_come_close_and_quality_makes_them_larger() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "o.png"]);
    let png = image::open(desk.path("o.png")).unwrap().to_rgb8();
    let mut sizes = Vec::new();
    for quality in ["20", "92", "100"] {
        desk.develop(&["a.dng", "-o", "o.jpg", "--quality", quality, "--overwrite"]);
        sizes.push(desk.read("o.jpg").len());
    }
    assert!(sizes[0] < sizes[1] && sizes[1] < sizes[2], "{sizes:?}");
    let jpeg = image::open(desk.path("o.jpg")).unwrap().to_rgb8();
    let sum: u64 = jpeg.iter().zip(png.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    assert!(sum < 2 * jpeg.len() as u64, "{}", sum as f64 / jpeg.len() as f64);
    let full = sizes[2];
    desk.develop(&["a.dng", "-o", "o.jpg", "--quality", "100", "--chroma", "420", "--overwrite"]);
    assert!(desk.read("o.jpg").len() < full);
}

#[test]
fn the_linear_look_is_written_linear_or_not_at_all() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "--look", "linear"]);
    let found = read("tiff", &desk.read("a.tif"));
    assert_eq!(found.bits, 16);
    desk.develop(&["a.dng", "--look", "linear", "-o", "o.exr"]);
    desk.fails(2, &["develop", "a.dng", "--look", "linear", "-o", "o.jpg"], &["8 bits", ".tif", "--look"]);
    let bent = ["develop", "a.dng", "--look", "linear", "-o", "o.tif", "--space", "adobe-rgb"];
    desk.fails(2, &bent, &["adobe-rgb-linear"]);
    assert_eq!(desk.names(), ["a.dng", "a.tif", "o.exr"]);
}

#[test]
fn an_exr_and_a_floating_point_tiff_hold_the_same_light() {
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "--look", "linear", "-o", "o.exr"]);
    desk.develop(&["a.dng", "--look", "linear", "-o", "o.tif", "--bits", "32"]);
    let exr = exr::prelude::read_first_rgba_layer_from_file(
        desk.path("o.exr"),
        |size, _| (size.0, vec![[0f32; 3]; size.0 * size.1]),
        |(width, pixels), at, (r, g, b, _): (f32, f32, f32, f32)| pixels[at.1 * *width + at.0] = [r, g, b],
    )
    .unwrap();
    let exr: Vec<f32> = exr.layer_data.channel_data.pixels.1.into_iter().flatten().collect();
    let mut decoder = tiff::decoder::Decoder::new(Cursor::new(desk.read("o.tif"))).unwrap();
    let tiff::decoder::DecodingResult::F32(tiff) = decoder.read_image().unwrap() else { panic!("floats") };
    assert!(exr == tiff);
}
