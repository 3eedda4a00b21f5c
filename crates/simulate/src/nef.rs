//! Captures as Nikon NEF bytes: TIFF with a maker note of type 3.
//!
//! Structure as ExifTool documents it; the trees of the lossless compression are constants of the format.

use darkroot_photo::metadata::Value;
use darkroot_photo::{AsShot, Capture, Cfa, Counts, Layout, Mosaic};

use crate::bits::{Bits, category};
use crate::dng::{code, exif_directory, preview_directory};
use crate::tag;
use crate::tiff_writer::{Ifd, file};

/// How the samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Storage {
    /// 14 bits in 16-bit words, or 12 bits packed.
    Uncompressed,
    /// Nikon's lossless compression.
    #[default]
    Lossless,
}

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

/// Code lengths of the lossless trees, as numbers of codes of 1, 2, 3, ... bits, and their symbols in order.
const TREE_12: ([u8; 8], [u8; 13]) = ([0, 1, 4, 2, 3, 1, 2, 0], [5, 4, 6, 3, 7, 2, 8, 1, 9, 0, 10, 11, 12]);
const TREE_14: ([u8; 8], [u8; 15]) =
    ([0, 1, 4, 2, 2, 3, 1, 2], [7, 6, 8, 5, 9, 4, 10, 3, 11, 12, 2, 0, 1, 13, 14]);

/// The bytes of a NEF file, with a small RGB preview; `None` unless the capture is what Nikon cameras store:
/// integer samples of 12 or 14 bits under a 2x2 filter array, of even width. NEF has no place for saturation,
/// colour matrices, a masked border or a crop; decoders know them by the model.
pub fn write(capture: &Capture, storage: Storage) -> Option<Vec<u8>> {
    let bits = capture.source.bits;
    let Counts::U16(mosaic) = &capture.counts else { return None };
    let Layout::Cfa(cfa) = &mosaic.layout else { return None };
    let fits = matches!(bits, 12 | 14) && mosaic.samples.iter().all(|&s| s >> bits == 0);
    if !fits || (cfa.width(), cfa.height()) != (2, 2) || !mosaic.size.width.is_multiple_of(2) {
        return None;
    }

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
    exif.put(tag::MAKER_NOTE, Value::Undefined(maker_note(capture, storage)));
    root.directories(tag::SUB_IFDS, vec![raw_directory(mosaic, cfa, bits, storage)])
        .directories(tag::EXIF_IFD, vec![exif]);
    Some(file(&root))
}

fn raw_directory(mosaic: &Mosaic<u16>, cfa: &Cfa, bits: u8, storage: Storage) -> Ifd {
    let samples = &mosaic.samples;
    let width = mosaic.size.width;
    let (compression, bytes) = match (storage, bits) {
        (Storage::Lossless, 12) => (34713, huffman(samples, width, &codes(&TREE_12))),
        (Storage::Lossless, _) => (34713, huffman(samples, width, &codes(&TREE_14))),
        (Storage::Uncompressed, 12) => (1, packed(samples)),
        (Storage::Uncompressed, _) => (1, samples.iter().flat_map(|s| s.to_le_bytes()).collect()),
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

/// The maker note of type 3: a name, a version, and a TIFF file of its own.
fn maker_note(capture: &Capture, storage: Storage) -> Vec<u8> {
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
        .shorts(note::COMPRESSION, &[if storage == Storage::Lossless { 3 } else { 2 }])
        .longs(note::SHUTTER_COUNT, &[1]);
    if storage == Storage::Lossless {
        ifd.put(note::LINEARIZATION, Value::Undefined(linearization()));
    }
    [b"Nikon\0\x02\x11\0\0".to_vec(), file(&ifd)].concat()
}

/// Version 0x46 0x30 (lossless), the first predictions of the four filters, and a curve of no points.
fn linearization() -> Vec<u8> {
    let mut table = vec![0x46, 0x30];
    table.extend([FIRST_PREDICTION; 4].iter().flat_map(|p| p.to_le_bytes()));
    table.resize(LINEARIZATION_BYTES, 0);
    table
}

/// What the first two samples of the first two rows are predicted to be.
const FIRST_PREDICTION: u16 = 2048;
/// Readers take this much for granted.
const LINEARIZATION_BYTES: usize = 640;

/// Code and length of each symbol of a tree, in order of length.
fn codes<const N: usize>((counts, symbols): &([u8; 8], [u8; N])) -> [(u32, u32); 16] {
    let mut codes = [(0, 0); 16];
    let mut next = 0;
    let mut symbols = symbols.iter();
    for (&count, length) in counts.iter().zip(1..) {
        for &symbol in symbols.by_ref().take(usize::from(count)) {
            codes[usize::from(symbol)] = (next, length);
            next += 1;
        }
        next <<= 1;
    }
    codes
}

/// Each sample as its difference to the one two columns to the left; the first two of a row to those two rows
/// above.
fn huffman(samples: &[u16], width: usize, codes: &[(u32, u32); 16]) -> Vec<u8> {
    let mut bits = Bits::default();
    let mut first = [[i32::from(FIRST_PREDICTION); 2]; 2];
    for (y, row) in samples.chunks_exact(width.max(1)).enumerate() {
        let mut prediction = first[y % 2];
        for (x, &sample) in row.iter().enumerate() {
            let sample = i32::from(sample);
            let (symbol, extra) = category(sample - prediction[x % 2]);
            let (code, length) = codes[usize::from(symbol)];
            bits.push(code, length);
            bits.push(extra, u32::from(symbol));
            prediction[x % 2] = sample;
            if x < 2 {
                first[y % 2][x] = sample;
            }
        }
    }
    bits.finish(false)
}

/// 12 bits a sample, most significant bit first.
fn packed(samples: &[u16]) -> Vec<u8> {
    let mut bits = Bits::default();
    samples.iter().for_each(|&s| bits.push(u32::from(s), 12));
    bits.finish(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_trees_have_a_code_for_every_size_of_error_and_no_room_left() {
        for (codes, symbols) in [(codes(&TREE_12), 13), (codes(&TREE_14), 15)] {
            let space: f64 = codes.iter().filter(|c| c.1 > 0).map(|c| 0.5f64.powi(c.1 as i32)).sum();
            assert!((space - 1.0).abs() < 1e-12);
            assert!(codes[..symbols].iter().all(|c| c.1 > 0));
        }
    }
}
