//! Captures as the files of cameras that write down what their lens did: Sony ARW, Olympus ORF, Fujifilm RAF.
//!
//! Structures as ExifTool documents them, with no more in them than a decoder needs, and what the caller says of the lens.

use darkroot_photo::metadata::{Directory, Value};
use darkroot_photo::{AsShot, Capture, Cfa, Mosaic, Rect};

use crate::dng::{code, exif_directory, preview_directory};
use crate::nef::{highest_first, storable};
use crate::tag;
use crate::tiff_writer::{Ifd, after, file};

/// A list of numbers in a note: its tag, and the numbers in the type that the maker has.
pub type List<T> = (u16, Vec<T>);

/// The bytes of a Sony ARW with these lists in the directory of the raw picture, and this size of the camera's picture in Exif;
/// `None` unless the capture is one of 14 bits under a 2x2 filter array, of even width.
pub fn arw(capture: &Capture, lens: &[List<i16>], picture: Option<(usize, usize)>) -> Option<Vec<u8>> {
    let (mosaic, cfa) = storable(capture).filter(|_| capture.source.bits == 14)?;
    let samples = mosaic.samples.iter().flat_map(|s| s.to_le_bytes()).collect();
    let mut raw = raw_directory(mosaic, cfa, 14, samples);
    let [r, g, b] = balance(capture);
    let black = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| capture.black.at(x, y, 0).round() as u16);
    raw.shorts(sony::BLACK, &black)
        .signed_shorts(sony::BALANCE, &[r, g, g, b].map(|v| v as i16))
        .shorts(tag::WHITE_LEVEL, &[capture.white.0[0] as u16]);
    crop(&mut raw, capture.default_crop);
    for (tag, numbers) in lens {
        raw.signed_shorts(*tag, numbers);
    }
    let mut exif = exif_directory(capture);
    if let Some((width, height)) = picture {
        exif.longs(EXIF_WIDTH, &[width]).longs(EXIF_HEIGHT, &[height]);
    }
    Some(file(&root(capture, "SONY", "ILCE-7M3", exif).directories(tag::SUB_IFDS, vec![raw]).clone()))
}

/// The bytes of an Olympus ORF with these lists in the note's directory of image processing; `None` unless the capture is one of 12
/// bits under a 2x2 filter array, of a width that is a multiple of 8.
pub fn orf(capture: &Capture, lens: &[List<f32>]) -> Option<Vec<u8>> {
    let fits = |capture: &Capture| capture.source.bits == 12 && capture.counts.size().width.is_multiple_of(8);
    let (mosaic, cfa) = storable(capture).filter(|_| fits(capture))?;
    // The highest bit first, in words of 32 bits whose lowest byte comes first.
    let packed = highest_first(&mosaic.samples, mosaic.size.width, 12);
    let words = packed.as_chunks::<4>().0.iter().flat_map(|&[a, b, c, d]| [d, c, b, a]).collect();
    let [r, _, b] = balance(capture);
    let black = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| capture.black.at(x, y, 0).round() as u16);
    let crop = capture.default_crop;
    let mut processing = Ifd::default();
    processing.shorts(olympus::BALANCE, &[r, b].map(|v| v / 4)).shorts(olympus::BLACK, &black);
    for (tag, number) in (olympus::CROP..).zip([crop.x, crop.y, crop.width, crop.height]) {
        processing.shorts(tag, &[number as u16]);
    }
    for (tag, numbers) in lens {
        processing.floats(*tag, numbers);
    }
    let mut note = Ifd::default();
    note.directories(olympus::PROCESSING, vec![processing]);
    let mut exif = exif_directory(capture);
    exif.put(tag::MAKER_NOTE, Value::Undefined(after(b"OLYMPUS\0II\x03\0", &note)));
    let mut first = raw_directory(mosaic, cfa, 12, words);
    first
        .text(tag::MAKE, "OLYMPUS CORPORATION")
        .text(tag::MODEL, "E-M1MarkII")
        .shorts(tag::ORIENTATION, &[capture.orientation.exif()])
        .directories(tag::EXIF_IFD, vec![exif]);
    Some(after(b"IIRO\x08\0\0\0", &first))
}

/// What a RAF says besides its samples.
#[derive(Debug, Clone, Default)]
pub struct RafNotes {
    /// Lists of the lens, in the directory for development; fractions of a million.
    pub lens: Vec<List<f64>>,
    /// Records about the raw picture, besides its size and crop.
    pub records: Vec<List<u16>>,
    /// Which part of the sensor was read, in Fujifilm's note.
    pub part: u16,
}

/// The bytes of a Fujifilm RAF; `None` unless the capture is one of 14 bits under RGGB, of even width.
pub fn raf(capture: &Capture, notes: &RafNotes) -> Option<Vec<u8>> {
    let (mosaic, cfa) = storable(capture).filter(|_| capture.source.bits == 14)?;
    (code(cfa.at(0, 0)) == 0 && code(cfa.at(1, 1)) == 2).then_some(())?;
    let (size, crop) = (mosaic.size, capture.default_crop);
    let mut development = Ifd::default();
    let [r, g, b] = balance(capture);
    development
        .longs(fujifilm::WIDTH, &[size.width])
        .longs(fujifilm::HEIGHT, &[size.height])
        .longs(fujifilm::BITS, &[14])
        .longs(fujifilm::BLACK, &[capture.black.at(0, 0, 0).round() as usize; 4])
        .longs(fujifilm::BALANCE, &[g, r, b].map(usize::from))
        .pieces(
            fujifilm::OFFSETS,
            fujifilm::LENGTHS,
            vec![mosaic.samples.iter().flat_map(|s| s.to_le_bytes()).collect()],
        );
    for (tag, numbers) in &notes.lens {
        let fractions = numbers.iter().map(|v| ((v * 1e6).round() as i32, 1_000_000)).collect();
        development.put(*tag, Value::SignedRationals(fractions));
    }
    let mut first = Ifd::default();
    first.directories(fujifilm::DEVELOPMENT, vec![development]);

    let mut note = Ifd::default();
    note.shorts(fujifilm::CROP_MODE, &[notes.part]);
    let mut exif = exif_directory(capture);
    exif.put(tag::MAKER_NOTE, Value::Undefined(after(b"FUJIFILM\x0c\0\0\0", &note)));
    let jpeg = jpeg_with_exif(&file(&root(capture, "FUJIFILM", "X-A10", exif).clone()));

    let pair = |a: usize, b: usize| vec![a as u16, b as u16];
    let mut records: Vec<List<u16>> = vec![
        (fujifilm::RAW_SIZE, pair(size.height, size.width)),
        (fujifilm::CROP_AT, pair(crop.y, crop.x)),
        (fujifilm::CROP_SIZE, pair(crop.height, crop.width)),
        (fujifilm::PICTURE_SIZE, pair(size.height, size.width)),
    ];
    records.extend(notes.records.iter().cloned());
    Some(sections(&jpeg, &records, &file(&first)))
}

/// A RAF of its three sections.
fn sections(jpeg: &[u8], records: &[List<u16>], development: &[u8]) -> Vec<u8> {
    let mut about = (records.len() as u32).to_be_bytes().to_vec();
    for (number, values) in records {
        about.extend([number.to_be_bytes(), (2 * values.len() as u16).to_be_bytes()].concat());
        about.extend(values.iter().flat_map(|v| v.to_be_bytes()));
    }
    const HEAD: usize = 0x94;
    let mut bytes = b"FUJIFILMCCD-RAW 0201FF383501X-A10".to_vec();
    bytes.resize(60, 0);
    bytes.extend(b"0100");
    bytes.resize(HEAD, 0);
    for (place, section) in [(84, jpeg), (92, &about[..]), (100, development)] {
        bytes.resize(bytes.len().next_multiple_of(16), 0);
        let start = bytes.len() as u32;
        bytes[place..place + 4].copy_from_slice(&start.to_be_bytes());
        bytes[place + 4..place + 8].copy_from_slice(&(section.len() as u32).to_be_bytes());
        bytes.extend_from_slice(section);
    }
    bytes
}

/// The head of a JPEG with Exif, and nothing of a picture.
fn jpeg_with_exif(exif: &[u8]) -> Vec<u8> {
    let length = (exif.len() + 8) as u16;
    [b"\xff\xd8\xff\xe1", &length.to_be_bytes()[..], b"Exif\0\0", exif, b"\xff\xd9"].concat()
}

/// The first directory of a file whose raw picture lies below it or elsewhere.
fn root(capture: &Capture, make: &str, model: &str, exif: Ifd) -> Ifd {
    let mut root = Ifd::default();
    preview_directory(&mut root, capture);
    root.fields(capture.metadata.fields().iter().filter(|f| f.directory == Directory::Image))
        .text(tag::MAKE, make)
        .text(tag::MODEL, model)
        .shorts(tag::ORIENTATION, &[capture.orientation.exif()])
        .directories(tag::EXIF_IFD, vec![exif]);
    root
}

fn raw_directory(mosaic: &Mosaic<u16>, cfa: &Cfa, bits: u16, samples: Vec<u8>) -> Ifd {
    let mut raw = Ifd::default();
    raw.longs(tag::NEW_SUBFILE_TYPE, &[0])
        .longs(tag::IMAGE_WIDTH, &[mosaic.size.width])
        .longs(tag::IMAGE_LENGTH, &[mosaic.size.height])
        .shorts(tag::BITS_PER_SAMPLE, &[bits])
        .shorts(tag::COMPRESSION, &[1])
        .shorts(tag::PHOTOMETRIC, &[32803])
        .shorts(tag::SAMPLES_PER_PIXEL, &[1])
        .longs(tag::ROWS_PER_STRIP, &[mosaic.size.height])
        .shorts(tag::CFA_REPEAT_PATTERN_DIM, &[2, 2])
        .put(tag::CFA_PATTERN, Value::Bytes((0..4).map(|i| code(cfa.at(i % 2, i / 2))).collect()))
        .pieces(tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS, vec![samples]);
    raw
}

fn crop(raw: &mut Ifd, crop: Rect) {
    raw.longs(sony::CROP_AT, &[crop.x, crop.y]).longs(sony::CROP_SIZE, &[crop.width, crop.height]);
}

/// Multipliers of red, green and blue, in 1024ths.
fn balance(capture: &Capture) -> [u16; 3] {
    match capture.as_shot {
        Some(AsShot::Neutral(neutral)) => neutral.map(|v| (1024.0 * neutral[1] / v).round() as u16),
        _ => [1024; 3],
    }
}

/// Exif PixelXDimension and PixelYDimension.
const EXIF_WIDTH: u16 = 0xa002;
const EXIF_HEIGHT: u16 = 0xa003;

mod sony {
    pub(super) const BLACK: u16 = 0x7310;
    pub(super) const BALANCE: u16 = 0x7313;
    pub(super) const CROP_AT: u16 = 0x74c7;
    pub(super) const CROP_SIZE: u16 = 0x74c8;
}

mod olympus {
    pub(super) const PROCESSING: u16 = 0x2040;
    pub(super) const BALANCE: u16 = 0x0100;
    pub(super) const BLACK: u16 = 0x0600;
    /// Left, top, width and height follow each other.
    pub(super) const CROP: u16 = 0x0612;
}

mod fujifilm {
    pub(super) const DEVELOPMENT: u16 = 0xf000;
    pub(super) const WIDTH: u16 = 0xf001;
    pub(super) const HEIGHT: u16 = 0xf002;
    pub(super) const BITS: u16 = 0xf003;
    pub(super) const OFFSETS: u16 = 0xf007;
    pub(super) const LENGTHS: u16 = 0xf008;
    pub(super) const BLACK: u16 = 0xf00a;
    pub(super) const BALANCE: u16 = 0xf00e;
    pub(super) const CROP_MODE: u16 = 0x104d;
    pub(super) const RAW_SIZE: u16 = 0x0100;
    pub(super) const CROP_AT: u16 = 0x0110;
    pub(super) const CROP_SIZE: u16 = 0x0111;
    pub(super) const PICTURE_SIZE: u16 = 0x0121;
}
