//! Where the decoder reads a file otherwise than its writer meant it.

#![allow(clippy::unwrap_used, clippy::panic)] // A test may stop.

mod tiff_file;

use std::io::Write as _;

use darkroot_photo::{Counts, Size};
use darkroot_raw::{Decoder, Error, Limits, decode};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, nef};
use tiff_file::{Field, tiff_file};

const WIDTH: usize = 60;
const HEIGHT: usize = 44;

fn samples(bytes: &[u8]) -> Vec<u16> {
    let capture = decode(bytes, Decoder::Flashraw, &Limits::default()).unwrap();
    match capture.counts {
        Counts::U16(mosaic) => mosaic.samples,
        Counts::F32(_) => panic!("floating point"),
    }
}

#[test]
fn nikon_s_packed_samples_are_read_in_the_order_that_makes_a_picture() {
    let size = Size { width: 300, height: 200 };
    for camera in [Camera::nikon_d750(), Camera::nikon_d750_12_bit()] {
        let exposure = Exposure { noise: Some(3), ..Exposure::default() };
        let capture = expose(&Scene::still_life(size), &camera, &exposure);
        let Counts::U16(mosaic) = &capture.counts else { panic!("floating point") };
        for storage in [nef::Storage::PackedHighestFirst, nef::Storage::PackedLowestFirst] {
            let bytes = nef::write(&capture, storage).unwrap();
            assert_eq!(samples(&bytes), mosaic.samples, "{storage:?}, {} bits", camera.bits);
            let decoded = decode(&bytes, Decoder::Flashraw, &Limits::default()).unwrap();
            // 12 bits from the highest down are what everybody takes for granted.
            let said = decoded.notes.iter().any(|note| note.contains("does not say how"));
            let ordinary = camera.bits == 12 && storage == nef::Storage::PackedHighestFirst;
            assert_eq!(said, !ordinary, "{storage:?}: {:?}", decoded.notes);
        }
    }
}

#[test]
fn words_of_a_small_frame_are_no_padded_rows() {
    for width in [32, 40, 64] {
        let size = Size { width, height: 24 };
        let capture = expose(&Scene::gradient(size), &Camera::nikon_d750(), &Exposure::default());
        let Counts::U16(mosaic) = &capture.counts else { panic!("floating point") };
        assert_eq!(
            samples(&nef::write(&capture, nef::Storage::Uncompressed).unwrap()),
            mosaic.samples,
            "{width}"
        );
    }
}

#[test]
fn nikon_s_packed_samples_that_fit_no_order_are_refused() {
    let size = Size { width: 300, height: 200 };
    let mut capture = expose(&Scene::still_life(size), &Camera::nikon_d750(), &Exposure::default());
    let Counts::U16(mosaic) = &mut capture.counts else { panic!("floating point") };
    mosaic.samples.fill(0);
    let flat = nef::write(&capture, nef::Storage::PackedLowestFirst).unwrap();
    let error = decode(&flat, Decoder::Flashraw, &Limits::default()).unwrap_err();
    assert!(
        matches!(&error, Error::Compression { compression, .. } if compression.contains("packing")),
        "{error}"
    );
}

/// A value for each place.
fn value(x: usize, y: usize) -> u16 {
    (x * 3 + y * 70 + (x * x + y) % 7) as u16
}

/// Rows (or columns) of these numbers in fields: every so many together.
fn fields(count: usize, factor: usize) -> Vec<usize> {
    (0..factor).flat_map(|f| (f..count).step_by(factor)).collect()
}

#[test]
fn rows_and_columns_in_fields_come_together_as_adobe_s_sdk_has_it() {
    let truth: Vec<u16> = (0..WIDTH * HEIGHT).map(|i| value(i % WIDTH, i / WIDTH)).collect();
    for (rows, columns) in [(2, 1), (1, 2), (2, 2), (3, 2)] {
        for big in [false, true] {
            let (ys, xs) = (fields(HEIGHT, rows), fields(WIDTH, columns));
            let stored = ys.iter().flat_map(|&y| xs.iter().map(move |&x| value(x, y)));
            let strip: Vec<u8> =
                stored.flat_map(|v| if big { v.to_be_bytes() } else { v.to_le_bytes() }).collect();
            let mut extra = vec![Field::long(50975, rows)];
            extra.push(Field::long(52547, columns));
            let file = tiff_file(&[bayer(16, 1), extra].concat(), vec![strip], big);
            assert_eq!(samples(&file), truth, "{rows} x {columns}");
        }
    }
}

#[test]
fn differences_of_8_bits_are_summed_in_8_bits() {
    let truth: Vec<u16> = (0..WIDTH * HEIGHT).map(|i| value(i % WIDTH, i / WIDTH) % 251).collect();
    for (predictor, step) in [(1, 0), (2, 1), (34892, 2), (34893, 4)] {
        let stored = truth.chunks(WIDTH).flat_map(|row| {
            (0..WIDTH).map(move |x| {
                let before = if step > 0 && x >= step { row[x - step] } else { 0 };
                row[x].wrapping_sub(before) as u8
            })
        });
        let mut deflate = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        deflate.write_all(&stored.collect::<Vec<u8>>()).unwrap();
        let fields = [bayer(8, 8), vec![Field::short(317, predictor)]].concat();
        let file = tiff_file(&fields, vec![deflate.finish().unwrap()], false);
        assert_eq!(samples(&file), truth, "predictor {predictor}");
    }
}

/// The fields of a DNG of one strip under a Bayer array.
fn bayer(bits: usize, compression: usize) -> Vec<Field> {
    vec![
        Field::long(254, 0),
        Field::long(256, WIDTH),
        Field::long(257, HEIGHT),
        Field::short(258, bits),
        Field::short(259, compression),
        Field::short(262, 32803),
        Field::offsets(273),
        Field::short(277, 1),
        Field::long(278, HEIGHT),
        Field::lengths(279),
        Field::shorts(33421, &[2, 2]),
        Field::bytes(33422, &[0, 1, 1, 2]),
        Field::bytes(50706, &[1, 7, 1, 0]),
    ]
}
