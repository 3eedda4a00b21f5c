//! Floating-point JPEG XL in a DNG: strips and tiles, in the bits of half floats.

#![allow(clippy::unwrap_used)] // A test may stop.
#![allow(clippy::float_cmp)] // Stored without loss.

mod tiff_file;

use darkroot_colour::RgbSpace;
use darkroot_encode::{Format, Options};
use darkroot_photo::{Counts, Layout, Metadata, Picture, PictureSpace, Samples, Size};
use darkroot_raw::{Decoder, Limits, decode};
use tiff_file::{Field, tiff_file};

const WIDTH: usize = 150;
const HEIGHT: usize = 100;

/// Bits of a half float: a slope in each colour, from 0.125 to about 2.
fn half_bits(x: usize, y: usize, plane: usize) -> u16 {
    (0x3000 + 25 * x + 3 * y + 40 * plane) as u16
}

/// The number that they mean (IEEE 754, all of them normal).
fn value(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10), f32::from(bits & 0x3ff));
    (1.0 + fraction / 1024.0) * 2f32.powi(exponent - 15)
}

/// A rectangle of the picture as a JPEG XL of half floats: our own of 16-bit integers with another image header.
fn jpeg_xl((left, top): (usize, usize), size: Size) -> Vec<u8> {
    let mut samples = Vec::new();
    for y in top..top + size.height {
        for x in left..left + size.width {
            samples.extend((0..3).map(|plane| half_bits(x.min(WIDTH - 1), y.min(HEIGHT - 1), plane)));
        }
    }
    let picture = Picture { size, space: PictureSpace::Rgb(RgbSpace::SRGB), samples: Samples::U16(samples) };
    let mut file = std::io::Cursor::new(Vec::new());
    darkroot_encode::write(&picture, Format::Jxl, &Options::default(), &Metadata::default(), &mut file)
        .unwrap();
    let file = file.into_inner();
    let start = file.windows(4).position(|w| w == b"jxlc").unwrap() + 4;
    as_float(&file[start..])
}

/// Replaces the bit depth in the image header (ISO/IEC 18181-1, D.3.4): 16 bits, 5 of them of an exponent.
fn as_float(stream: &[u8]) -> Vec<u8> {
    let bit = |i: usize| stream[i / 8] >> (i % 8) & 1;
    let side = |at: usize| at + 2 + [9, 13][usize::from(bit(at))];
    // Signature, small, height, ratio, width, all defaults, extra fields.
    let depth = side(side(16 + 1) + 3) + 2;
    // Integers: a flag, a selector of two bits, six bits. Then what follows the depth.
    let rest = depth + 1 + 2 + 6;
    let mut bits: Vec<u8> = (0..depth).map(bit).collect();
    bits.extend([1, /* 16 bits */ 1, 0, /* exponent of 4 + 1 */ 0, 0, 1, 0]);
    let end = (rest + 8).next_multiple_of(8);
    bits.extend((rest..rest + 8).map(bit));
    bits.resize(bits.len().next_multiple_of(8), 0);
    let header = bits.chunks(8).map(|byte| byte.iter().enumerate().map(|(i, b)| b << i).sum::<u8>());
    header.chain(stream[end / 8..].iter().copied()).collect()
}

/// A DNG in either byte order, in tiles or strips of `piece`, without its last bytes.
fn dng(piece: Size, tiled: bool, big: bool, cut: usize) -> Vec<u8> {
    let mut pieces = Vec::new();
    for y in (0..HEIGHT).step_by(piece.height) {
        for x in (0..WIDTH).step_by(piece.width) {
            let height = if tiled { piece.height } else { piece.height.min(HEIGHT - y) };
            pieces.push(jpeg_xl((x, y), Size { height, ..piece }));
        }
    }
    let mut fields = vec![
        Field::long(254, 0),
        Field::long(256, WIDTH),
        Field::long(257, HEIGHT),
        Field::shorts(258, &[16; 3]),
        Field::short(259, 52546),
        Field::short(262, 34892),
        Field::short(277, 3),
        Field::shorts(339, &[3; 3]),
        Field::bytes(50706, &[1, 7, 0, 0]),
        Field::longs(50717, &[1; 3]),
    ];
    fields.extend(if tiled {
        vec![
            Field::long(322, piece.width),
            Field::long(323, piece.height),
            Field::offsets(324),
            Field::lengths(325),
        ]
    } else {
        vec![Field::long(278, piece.height), Field::offsets(273), Field::lengths(279)]
    });
    let mut file = tiff_file(&fields, pieces, big);
    file.truncate(file.len() - cut);
    file
}

#[test]
fn every_sample_arrives_bit_for_bit_from_strips_and_tiles_of_both_byte_orders() {
    for (piece, tiled) in [
        (Size { width: WIDTH, height: HEIGHT }, false),
        (Size { width: WIDTH, height: 37 }, false),
        (Size { width: 64, height: 48 }, true),
        (Size { width: 160, height: 112 }, true),
    ] {
        for big in [false, true] {
            let capture = decode(&dng(piece, tiled, big, 0), Decoder::Flashraw, &Limits::default()).unwrap();
            let Counts::F32(mosaic) = &capture.counts else { unreachable!("{piece:?}") };
            assert_eq!((mosaic.size, &mosaic.layout), (Size { width: WIDTH, height: HEIGHT }, &Layout::Rgb));
            for (i, &sample) in mosaic.samples.iter().enumerate() {
                let (x, y) = (i / 3 % WIDTH, i / 3 / WIDTH);
                assert_eq!(sample, value(half_bits(x, y, i % 3)), "{piece:?} at {x}, {y}");
            }
            assert_eq!((capture.source.compression.as_str(), capture.source.bits), ("JPEG XL", 16));
        }
    }
}

#[test]
fn what_is_cut_off_or_damaged_is_a_sentence() {
    let piece = Size { width: 64, height: 48 };
    for cut in [1, 50, 5000] {
        let error = decode(&dng(piece, true, false, cut), Decoder::Flashraw, &Limits::default()).unwrap_err();
        assert!(error.to_string().contains("is damaged"), "{error}");
    }
    let whole = dng(piece, true, false, 0);
    for at in (whole.len() / 4..whole.len()).step_by(whole.len() / 40) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x55;
        if let Err(error) = decode(&bytes, Decoder::Flashraw, &Limits::default()) {
            assert!(error.to_string().len() > 20, "{error}");
        }
    }
    let limits = Limits { max_samples: 1000, ..Limits::default() };
    let error = decode(&whole, Decoder::Flashraw, &limits).unwrap_err();
    assert!(error.to_string().contains("too large"), "{error}");
}
