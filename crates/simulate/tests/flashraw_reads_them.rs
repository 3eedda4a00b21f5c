//! The decoder that Darkroot uses reads what this crate writes.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.

use darkroot_colour::Spectrum;
use darkroot_photo::{AsShot, BlackLevel, Capture, Counts, Filter, Layout, Mosaic, Orientation, Size};
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, dng, nef};
use flashraw::{CfaColor, DecodeOptions, FlashRaw, OutputFormat, RawFrame};

const SIZE: Size = Size { width: 300, height: 200 };

fn capture(camera: &Camera) -> Capture {
    let exposure = Exposure { noise: Some(3), stops: 1.0, ..Exposure::default() };
    expose(&Scene::gradient(SIZE), camera, &exposure)
}

/// Decodes `bytes` and checks that camera and samples are those of `capture`.
fn decode(capture: &Capture, bytes: Vec<u8>) -> RawFrame {
    let raw = FlashRaw::open(bytes).unwrap();
    let metadata = raw.metadata();
    assert_eq!(metadata.make, capture.camera.make);
    assert_eq!(metadata.model, capture.camera.model);
    assert_eq!(metadata.exposure.iso, Some(100));
    assert_eq!(metadata.exposure.f_number, Some(8.0));
    let options = DecodeOptions { output: OutputFormat::RawU16, ..DecodeOptions::default() };
    let frame = raw.decode(options).unwrap();
    assert!(frame.warnings().is_empty(), "{:?}", frame.warnings());
    let Counts::U16(mosaic) = &capture.counts else { panic!("counts are integers") };
    assert_eq!(frame.as_u16().unwrap(), mosaic.samples);
    frame
}

/// Black level, saturation, filters and white balance, sample by sample.
fn check(capture: &Capture, frame: &RawFrame) {
    let Counts::U16(mosaic) = &capture.counts else { panic!("counts are integers") };
    let planes = mosaic.layout.planes();
    let area = capture.active_area; // DNG says nothing of the black level beyond it.
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1), (17, 12), (200, 101)] {
        let (x, y) = (area.x + x, area.y + y);
        for plane in 0..planes {
            let black = frame.black_level.at(x, y, plane);
            assert!((black - capture.black.at(x, y, plane)).abs() < 1e-3, "{black} at {x}, {y}");
        }
        if let Layout::Cfa(cfa) = &mosaic.layout {
            let filter = match frame.color_at(x as u32, y as u32) {
                Some(CfaColor::Red) => Filter::Red,
                Some(CfaColor::Blue) => Filter::Blue,
                _ => Filter::Green,
            };
            assert_eq!(filter, cfa.at(x, y), "{x}, {y}");
        }
    }
    let Some(AsShot::Neutral(neutral)) = capture.as_shot else { panic!("the neutral is known") };
    let balance = frame.white_balance.unwrap();
    for c in 0..3 {
        let product = f64::from(balance.coeffs[c]) * neutral[c] / f64::from(balance.coeffs[1]) / neutral[1];
        assert!((product - 1.0).abs() < 1e-4, "{balance:?} {neutral:?}");
    }
}

#[test]
fn every_storage_of_dng_gives_back_the_samples() {
    let small = Camera { layout: Layout::Rgb, ..Camera::simulated_one() };
    for camera in [Camera::simulated_one(), small, Camera { masked: (7, 3), ..Camera::simulated_one() }] {
        let capture = capture(&camera);
        for storage in [dng::Storage::Uncompressed, dng::Storage::JpegStrip, dng::Storage::JpegTiles] {
            let frame = decode(&capture, dng::write(&capture, storage));
            check(&capture, &frame);
            assert_eq!(
                f64::from(frame.white_level.values[0]).to_bits(),
                f64::from(capture.white.0[0]).to_bits()
            );
        }
    }
}

#[test]
fn every_storage_of_nef_gives_back_the_samples() {
    for camera in [Camera::nikon_d750(), Camera::nikon_d750_12_bit()] {
        let capture = capture(&camera);
        for storage in [nef::Storage::Uncompressed, nef::Storage::Lossless] {
            let frame = decode(&capture, nef::write(&capture, storage).unwrap());
            check(&capture, &frame);
        }
    }
}

#[test]
fn lossy_nef_gives_back_what_the_curve_and_dropped_bits_leave() {
    for (camera, dropped) in [(Camera::nikon_d750(), 1 << 5), (Camera::nikon_d750_12_bit(), 1 << 5)] {
        let capture = capture(&camera);
        let Counts::U16(mosaic) = &capture.counts else { panic!("counts are integers") };
        // A step of the curve is three counts at most, and so is each of the bits that are dropped.
        for (storage, most) in [(nef::Storage::Lossy, 3), (nef::Storage::LossyWithSplit, 3 * dropped)] {
            let raw = FlashRaw::open(nef::write(&capture, storage).unwrap()).unwrap();
            let frame = raw.decode(DecodeOptions::default()).unwrap();
            let pairs = || frame.as_u16().unwrap().iter().zip(&mosaic.samples);
            let (above, below) = (pairs().take(mosaic.samples.len() / 5), pairs());
            assert!(above.clone().all(|(a, b)| a.abs_diff(*b) <= 3), "{storage:?}");
            assert!(below.clone().all(|(a, b)| a.abs_diff(*b) <= most), "{storage:?}");
            // Something is lost, and little.
            let sum: u64 = below.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            assert!(sum > 0 && sum < 12 * mosaic.samples.len() as u64, "{storage:?}: {sum}");
        }
    }
}

#[test]
fn every_filter_array_arrives() {
    for layout in [filters("RGGB"), filters("GRBG"), filters("GBRG"), filters("BGGR"), x_trans()] {
        for masked in [(0, 0), (5, 3)] {
            let capture = capture(&Camera { layout: layout.clone(), masked, ..Camera::simulated_one() });
            let frame = decode(&capture, dng::write(&capture, dng::Storage::JpegTiles));
            check(&capture, &frame);
            let area = frame.active_area;
            assert_eq!((area.x as usize, area.y as usize), masked);
            assert_eq!((area.width as usize, area.height as usize), (SIZE.width, SIZE.height));
            assert_eq!(frame.crop.x as usize, capture.default_crop.x);
            assert_eq!(frame.crop.width as usize, capture.default_crop.width);
        }
    }
}

#[test]
fn black_levels_arrive_with_their_drift() {
    let mut black = BlackLevel {
        columns: 2,
        rows: 2,
        values: vec![500.0, 510.0, 520.5, 530.0],
        ..BlackLevel::uniform(0.0)
    };
    black.row_deltas = (0..203).map(|y| y as f32 / 64.0).collect();
    black.column_deltas = (0..305).map(|x| -(x as f32) / 128.0).collect();
    let capture = capture(&Camera { black, masked: (5, 3), ..Camera::simulated_one() });
    let frame = decode(&capture, dng::write(&capture, dng::Storage::JpegStrip));
    check(&capture, &frame);
}

#[test]
fn floating_point_samples_arrive_as_they_are() {
    let mut capture = capture(&Camera::simulated_one());
    let Counts::U16(mosaic) = &capture.counts else { panic!("counts are integers") };
    let samples: Vec<f32> = mosaic.samples.iter().map(|&s| f32::from(s) / 16384.0).collect();
    let (size, layout) = (mosaic.size, mosaic.layout.clone());
    capture.counts = Counts::F32(Mosaic { size, layout, samples: samples.clone() });
    capture.black = BlackLevel::uniform(0.03125);
    let raw = FlashRaw::open(dng::write(&capture, dng::Storage::JpegTiles)).unwrap();
    let options = DecodeOptions { output: OutputFormat::RawF32, ..DecodeOptions::default() };
    assert_eq!(raw.decode(options).unwrap().as_f32().unwrap(), samples);
}

#[test]
fn black_levels_of_a_nef_arrive() {
    let values = vec![600.0, 601.0, 602.0, 603.0];
    let black = BlackLevel { columns: 2, rows: 2, values, ..BlackLevel::uniform(0.0) };
    let capture = capture(&Camera { black, ..Camera::nikon_d750() });
    let frame = decode(&capture, nef::write(&capture, nef::Storage::Lossless).unwrap());
    check(&capture, &frame);
}

#[test]
fn matrices_arrive() {
    let capture = capture(&Camera::simulated_one());
    let frame = decode(&capture, dng::write(&capture, dng::Storage::JpegStrip));
    let found = &frame.color_matrices;
    for (i, calibration) in capture.calibrations.iter().enumerate() {
        let forward = calibration.forward_matrix.unwrap();
        for (matrix, expected) in [(&found.color[i], calibration.color_matrix), (&found.forward[i], forward)]
        {
            let expected = expected.transpose();
            assert!(
                matrix.values.iter().zip(expected.iter()).all(|(&a, &b)| (f64::from(a) - b).abs() < 1e-6)
            );
        }
    }
}

#[test]
fn every_orientation_arrives() {
    for exif in 1..=8 {
        let exposure = Exposure { orientation: Orientation::from_exif(exif), ..Exposure::default() };
        let capture = expose(&Scene::flat(SIZE, Spectrum::constant(0.18)), &Camera::nikon_d750(), &exposure);
        for bytes in [
            dng::write(&capture, dng::Storage::JpegStrip),
            nef::write(&capture, nef::Storage::Lossless).unwrap(),
        ] {
            assert_eq!(decode(&capture, bytes).orientation as u32, exif);
        }
    }
}
