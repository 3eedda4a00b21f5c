//! The second decoder: rawloader. Only its samples are used; what they mean comes from the headers as
//! [`crate::flash`] and our own screen read them.

use darkroot_photo::{Capture, Counts, Layout, Mosaic, Size};
use rawloader::RawImageData;

use crate::dng_mends::Fields;
use crate::screen::{DNG_VERSION, LINEARIZATION_TABLE};
use crate::tiff::Directories;
use crate::{Error, Limits, TooLarge, Unknown};

/// How the library begins to say that it panicked: it catches that itself, so that our guard does not see it.
const PANICKED: &str = "Caught a panic";

/// Decodes the samples of `header` with rawloader.
pub(crate) fn decode(bytes: &[u8], header: Capture, limits: &Limits) -> Result<Capture, Error> {
    if let Some(reason) = known_wrong(bytes, &header)? {
        return Err(Error::WrongDecoder { reason });
    }
    let size = header.counts.size();
    if (size.area() * header.counts.layout().planes()) as u64 > limits.max_samples {
        return Err(Error::TooLarge(TooLarge::Frame(size)));
    }
    let image = rawloader::decode(&mut std::io::Cursor::new(bytes)).map_err(|e| {
        // The library puts a word before the sentence, and where it panicked a plea to its users behind it.
        let text = e.to_string();
        let message = text.trim_start_matches("RawLoaderError: ").trim_matches('"');
        if message.starts_with(PANICKED) {
            return Error::DecoderFailed { decoder: "rawloader" };
        }
        unknown(&header, Unknown::Decoder { message: message.to_owned() })
    })?;
    let seen = Size { width: image.width, height: image.height };
    let samples = header.counts.layout().planes();
    if seen != size || image.cpp != samples {
        return Err(unknown(&header, Unknown::Frame { seen, seen_samples: image.cpp, size, samples }));
    }
    let layout = header.counts.layout().clone();
    let counts = match image.data {
        RawImageData::Integer(samples) => Counts::U16(Mosaic { size, layout, samples }),
        RawImageData::Float(samples) => Counts::F32(Mosaic { size, layout, samples }),
    };
    let mut capture = Capture { counts, ..header };
    capture.source.decoder = "rawloader 0.37.2".to_owned();
    if capture.source.format == "NEF" {
        capture
            .notes
            .push("rawloader dithers Nikon samples: they differ slightly from the stored ones".into());
    }
    Ok(capture)
}

fn unknown(header: &Capture, reason: Unknown) -> Error {
    Error::Camera { camera: header.camera.name(), reason, decoder: "rawloader" }
}

/// Files that rawloader decodes wrongly without saying so (measured against known-truth files).
fn known_wrong(bytes: &[u8], header: &Capture) -> Result<Option<&'static str>, Error> {
    let Some(tiff) = Directories::walk(bytes)? else { return Ok(None) };
    if !tiff.has(DNG_VERSION) {
        return Ok(None);
    }
    let bits = header.source.bits;
    let packed = bits < 16 && bits != 8 && header.source.compression == "uncompressed";
    let big_endian = bytes.starts_with(b"MM") && header.source.compression == "uncompressed";
    Ok(if Fields::of(&tiff)?.is_some() {
        Some("it takes rows and columns in fields for a picture")
    } else if tiff.has(LINEARIZATION_TABLE) {
        Some("it does not apply this file's linearisation table")
    } else if packed && bits == 10 {
        Some("it misreads packed 10-bit samples")
    } else if big_endian && bits == 16 {
        Some("it misreads big-endian 16-bit samples")
    } else if header.source.compression == "uncompressed" && !strips_touch(&tiff, header) {
        Some("it takes strips that lie apart for one block")
    } else if !matches!(header.counts.layout(), Layout::Cfa(_)) && header.source.compression == "lossy JPEG" {
        Some("it does not undo the encoding of lossy linear DNG files")
    } else {
        None
    })
}

/// Whether the strips of the samples follow each other without a gap and hold nothing but samples.
fn strips_touch(tiff: &Directories<'_>, header: &Capture) -> bool {
    const IMAGE_WIDTH: u16 = 0x0100;
    const STRIP_OFFSETS: u16 = 0x0111;
    const ROWS_PER_STRIP: u16 = 0x0116;
    const STRIP_BYTE_COUNTS: u16 = 0x0117;
    const MAX_STRIPS: usize = 1 << 16;
    let size = header.counts.size();
    let row_bits = (size.width * header.counts.layout().planes() * usize::from(header.source.bits)) as u64;
    tiff.all.iter().all(|directory| {
        let values = |tag: u16| {
            let entry = directory.entry(tag);
            entry.map(|e| tiff.integers(e, MAX_STRIPS)).unwrap_or_default()
        };
        let (offsets, counts) = (values(STRIP_OFFSETS), values(STRIP_BYTE_COUNTS));
        if offsets.len() < 2 || values(IMAGE_WIDTH) != [size.width as u64] {
            return true;
        }
        let rows = values(ROWS_PER_STRIP).first().copied().unwrap_or(size.height as u64);
        let length = (row_bits * rows).div_ceil(8);
        let touching = offsets.windows(2).all(|w| w[0].saturating_add(length) == w[1]);
        touching && counts.iter().rev().skip(1).all(|&c| c == length)
    })
}
