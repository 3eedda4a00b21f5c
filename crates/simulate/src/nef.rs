//! Captures as Nikon NEF bytes: TIFF with a maker note of type 3.
//!
//! Structure as ExifTool documents it; compression stands in `nef_huffman.rs`.

use darkroot_photo::metadata::Value;
use darkroot_photo::{AsShot, Capture, Cfa, Counts, Layout, Mosaic};

use crate::dng::{code, exif_directory, preview_directory};
use crate::tiff_writer::{Ifd, file};
use crate::{nef_huffman, tag};
use darkroot_encode::bits::Bits;

/// How the samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Storage {
    /// 14 bits in 16-bit words, or 12 bits packed from the highest bit down.
    Uncompressed,
    /// Packed from the highest bit down.
    PackedHighestFirst,
    /// Packed from the lowest bit up.
    PackedLowestFirst,
    /// Nikon's lossless compression.
    #[default]
    Lossless,
    /// Nikon's lossy compression: samples are rounded to the steps of a curve, then stored without loss.
    Lossy,
    /// Nikon's lossy compression of later cameras: below a row, large differences lose their last bits too.
    LossyWithSplit,
}

impl Storage {
    /// Number of the maker note's compression, as ExifTool documents it.
    fn number(self) -> u16 {
        match self {
            Self::Uncompressed | Self::PackedHighestFirst | Self::PackedLowestFirst => 2,
            Self::Lossless => 3,
            Self::Lossy => 1,
            Self::LossyWithSplit => 4,
        }
    }
}

/// High Efficiency in the maker note, and the first bytes of a JPEG XS (ISO/IEC 21122-1), which it is.
const HIGH_EFFICIENCY: u16 = 13;
const JPEG_XS: &[u8] = &[0xff, 0x10, 0xff, 0x50];

/// Tags of the Nikon maker note.
mod note {
    pub(super) const VERSION: u16 = 0x0001;
    pub(super) const ISO: u16 = 0x0002;
    pub(super) const QUALITY: u16 = 0x0004;
    pub(super) const WHITE_BALANCE: u16 = 0x0005;
    pub(super) const FOCUS_MODE: u16 = 0x0007;
    pub(super) const WB_RB_LEVELS: u16 = 0x000c;
    pub(super) const SERIAL_NUMBER: u16 = 0x001d;
    pub(super) const BLACK_LEVEL: u16 = 0x003d;
    pub(super) const LENS_TYPE: u16 = 0x0083;
    pub(super) const LENS: u16 = 0x0084;
    pub(super) const COMPRESSION: u16 = 0x0093;
    pub(super) const LINEARIZATION: u16 = 0x0096;
    pub(super) const SHUTTER_COUNT: u16 = 0x00a7;
}

/// The bytes of a NEF file, with a small RGB preview; `None` unless the capture is what Nikon cameras store:
/// integer samples of 12 or 14 bits under a 2x2 filter array, of even width. NEF has no place for saturation,
/// colour matrices, a masked border or a crop; decoders know them by the model.
pub fn write(capture: &Capture, storage: Storage) -> Option<Vec<u8>> {
    let (mosaic, cfa) = storable(capture)?;
    let raw = raw_directory(mosaic, cfa, capture.source.bits, storage);
    Some(whole(capture, vec![raw], maker_note(capture, storage)))
}

/// A NEF whose samples nobody can read, as High Efficiency is, with a JPEG in it as large as the picture; `None` as
/// [`write()`]. There are no samples in it at all, only the mark by which their codec is known.
pub fn write_high_efficiency(capture: &Capture, jpeg: Vec<u8>) -> Option<Vec<u8>> {
    let (mosaic, cfa) = storable(capture)?;
    let mut raw = raw_directory(mosaic, cfa, capture.source.bits, Storage::Lossless);
    raw.pieces(tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS, vec![[JPEG_XS, &[0; 4096]].concat()]);
    let mut large = Ifd::default();
    large.longs(tag::NEW_SUBFILE_TYPE, &[1]).shorts(tag::COMPRESSION, &[6]).pieces(
        tag::JPEG_INTERCHANGE_FORMAT,
        tag::JPEG_INTERCHANGE_FORMAT_LENGTH,
        vec![jpeg],
    );
    let mut note = note_directory(capture);
    note.shorts(note::COMPRESSION, &[HIGH_EFFICIENCY]);
    Some(whole(capture, vec![large, raw], note_bytes(&note)))
}

/// The mosaic of a capture that a NEF can hold.
pub(crate) fn storable(capture: &Capture) -> Option<(&Mosaic<u16>, &Cfa)> {
    let bits = capture.source.bits;
    let Counts::U16(mosaic) = &capture.counts else { return None };
    let Layout::Cfa(cfa) = &mosaic.layout else { return None };
    let fits = matches!(bits, 12 | 14) && mosaic.samples.iter().all(|&s| s >> bits == 0);
    let even = (cfa.width(), cfa.height()) == (2, 2) && mosaic.size.width.is_multiple_of(2);
    (fits && even).then_some((mosaic, cfa))
}

fn whole(capture: &Capture, below: Vec<Ifd>, note: Vec<u8>) -> Vec<u8> {
    let mut root = Ifd::default();
    preview_directory(&mut root, capture);
    root.fields(
        capture
            .metadata
            .fields()
            .iter()
            .filter(|f| f.directory == darkroot_photo::metadata::Directory::Image),
    )
    .text(tag::MAKE, &capture.camera.make)
    .text(tag::MODEL, &capture.camera.model)
    .shorts(tag::ORIENTATION, &[capture.orientation.exif()]);
    let mut exif = exif_directory(capture);
    exif.put(tag::MAKER_NOTE, Value::Undefined(note));
    root.directories(tag::SUB_IFDS, below).directories(tag::EXIF_IFD, vec![exif]);
    file(&root)
}

fn raw_directory(mosaic: &Mosaic<u16>, cfa: &Cfa, bits: u8, storage: Storage) -> Ifd {
    let samples = &mosaic.samples;
    let width = mosaic.size.width;
    let (compression, bytes) = match (storage, bits) {
        (Storage::Uncompressed, 14) => (1, samples.iter().flat_map(|s| s.to_le_bytes()).collect()),
        (Storage::Uncompressed | Storage::PackedHighestFirst, _) => (1, highest_first(samples, width, bits)),
        (Storage::PackedLowestFirst, _) => (1, lowest_first(samples, width, bits)),
        (Storage::Lossless, _) => (34713, nef_huffman::lossless(samples, width, bits)),
        (Storage::Lossy, _) => (34713, nef_huffman::lossy(samples, width, bits, None)),
        (Storage::LossyWithSplit, _) => {
            (34713, nef_huffman::lossy(samples, width, bits, Some(split_row(mosaic.size.height))))
        }
    };
    let filters = (0..4).map(|i| code(cfa.at(i % 2, i / 2))).collect();
    let mut ifd = Ifd::default();
    ifd.longs(tag::NEW_SUBFILE_TYPE, &[0])
        .longs(tag::IMAGE_WIDTH, &[width])
        .longs(tag::IMAGE_LENGTH, &[mosaic.size.height])
        .shorts(tag::BITS_PER_SAMPLE, &[u16::from(bits)])
        .shorts(tag::COMPRESSION, &[compression])
        .shorts(tag::PHOTOMETRIC, &[32803])
        .shorts(tag::SAMPLES_PER_PIXEL, &[1])
        .longs(tag::ROWS_PER_STRIP, &[mosaic.size.height])
        .fractions(tag::X_RESOLUTION, &[300.0])
        .fractions(tag::Y_RESOLUTION, &[300.0])
        .shorts(tag::RESOLUTION_UNIT, &[2])
        .shorts(tag::PLANAR_CONFIGURATION, &[1])
        .shorts(tag::CFA_REPEAT_PATTERN_DIM, &[2, 2])
        .put(tag::CFA_PATTERN, Value::Bytes(filters))
        .shorts(tag::SENSING_METHOD, &[2])
        .pieces(tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS, vec![bytes]);
    ifd
}

/// The row from which on large differences lose bits: cameras store a few hundred above it.
fn split_row(height: usize) -> usize {
    height / 4
}

/// Each row by itself, the most significant bit first.
pub(crate) fn highest_first(samples: &[u16], width: usize, bits: u8) -> Vec<u8> {
    let row = |row: &[u16]| {
        let mut packed = Bits::default();
        row.iter().for_each(|&s| packed.push(u32::from(s), bits.into()));
        packed.finish(false)
    };
    samples.chunks(width.max(1)).flat_map(row).collect()
}

/// Each row by itself, the least significant bit first: the same with all bits of samples and bytes turned round.
fn lowest_first(samples: &[u16], width: usize, bits: u8) -> Vec<u8> {
    let turned: Vec<u16> = samples.iter().map(|s| s.reverse_bits() >> (16 - bits)).collect();
    highest_first(&turned, width, bits).into_iter().map(u8::reverse_bits).collect()
}

/// The maker note of type 3: a name, a version, and a TIFF file of its own.
fn maker_note(capture: &Capture, storage: Storage) -> Vec<u8> {
    let mut ifd = note_directory(capture);
    ifd.shorts(note::COMPRESSION, &[storage.number()]);
    let bits = capture.source.bits;
    let table = match storage {
        Storage::Lossless => Some(nef_huffman::lossless_table()),
        Storage::Lossy => Some(nef_huffman::lossy_table(bits, None)),
        Storage::LossyWithSplit => {
            Some(nef_huffman::lossy_table(bits, Some(split_row(capture.counts.size().height))))
        }
        _ => None,
    };
    if let Some(table) = table {
        ifd.put(note::LINEARIZATION, Value::Undefined(table));
    }
    note_bytes(&ifd)
}

fn note_bytes(ifd: &Ifd) -> Vec<u8> {
    [b"Nikon\0\x02\x11\0\0".to_vec(), file(ifd)].concat()
}

/// What the note says of every file.
fn note_directory(capture: &Capture) -> Ifd {
    let balance = match capture.as_shot {
        Some(AsShot::Neutral([r, g, b])) => [g / r, g / b, 1.0, 1.0],
        _ => [1.0; 4],
    };
    // The tag counts in 14 bits whatever the samples have.
    let to_14_bits = f32::from(1u16 << (14 - capture.source.bits.min(14)));
    let black = [(0, 0), (1, 0), (0, 1), (1, 1)]
        .map(|(x, y)| (capture.black.at(x, y, 0) * to_14_bits).round() as u16);
    let mut ifd = Ifd::default();
    ifd.put(note::VERSION, Value::Undefined(b"0211".to_vec()))
        .shorts(note::ISO, &[0, 100])
        .text(note::QUALITY, "RAW    ")
        .text(note::WHITE_BALANCE, "SUNNY       ")
        .text(note::FOCUS_MODE, "MANUAL")
        .fractions(note::WB_RB_LEVELS, &balance)
        .text(note::SERIAL_NUMBER, "0000001")
        .shorts(note::BLACK_LEVEL, &black)
        .put(note::LENS_TYPE, Value::Bytes(vec![6])) // D and G: no aperture ring.
        .fractions(note::LENS, &[85.0, 85.0, 1.8, 1.8])
        .longs(note::SHUTTER_COUNT, &[1]);
    ifd
}
