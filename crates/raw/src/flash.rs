//! The default decoder: flashraw.

use std::sync::Arc;

use darkroot_photo::{Capture, Cfa, Counts, Filter, Layout, Mosaic, Orientation, Size, Source};
use flashraw::{
    CorruptionPolicy, DecodeOptions, FlashRaw, FrameInfo, OutputFormat, RawFrame, RawMetadata, RawPixelData,
    SampleFormat,
};

use crate::dng_mends::Fields;
use crate::flash_facts::{
    as_shot, black_level, calibrations, camera, compression_name, layout, noise_profile, pixel_aspect, rect,
    white_level,
};
use crate::screen::{Container, DNG_VERSION, WHITE_LEVEL};
use crate::{
    Damage, Error, Limits, TooLarge, Unknown, dng_extras, dng_jxl, dng_mends, exif, local_tone, maker_note,
    nef_packing, opcode_work, opcodes,
};

/// What [`Source::decoder`] says.
const NAME: &str = "flashraw 0.1.1";

/// DNG / TIFF-EP tags of the filter array, and its index for green.
const CFA_PATTERN: u16 = 0x828e;
const CFA_PLANE_COLOR: u16 = 0xc616;
const GREEN: u8 = 1;

/// Decodes the whole file.
pub(crate) fn decode(bytes: &[u8], container: &Container<'_>, limits: &Limits) -> Result<Capture, Error> {
    if let Some(named) = name_colours(bytes, container) {
        return named.restore(decode_named(&named.bytes, container, limits)?);
    }
    decode_named(bytes, container, limits)
}

fn decode_named(bytes: &[u8], container: &Container<'_>, limits: &Limits) -> Result<Capture, Error> {
    let fields = container.tiff.as_ref().map_or(Ok(None), Fields::of)?;
    match fields {
        Some(fields) => decode_whole(&fields.bytes, container, limits).map(|capture| fields.join(capture)),
        None => decode_whole(bytes, container, limits),
    }
}

fn decode_whole(bytes: &[u8], container: &Container<'_>, limits: &Limits) -> Result<Capture, Error> {
    let raw = open(bytes, limits)?;
    if let Some(capture) = decode_ourselves(bytes, container, &raw, limits)? {
        return Ok(capture);
    }
    let float = raw.frame_info().sample_format == SampleFormat::F32;
    let options = DecodeOptions {
        output: if float { OutputFormat::RawF32 } else { OutputFormat::RawU16 },
        corruption_policy: CorruptionPolicy::Strict,
        limits: flash_limits(limits),
        ..DecodeOptions::default()
    };
    let frame = on_threads_that_help(raw.frame_info(), || raw.decode(options))
        .map_err(|e| decode_error(&e, raw.frame_info()))?;
    let mut capture = describe(bytes, container, raw.metadata(), raw.frame_info())?;
    let layout = capture.counts.layout().clone();
    let size = Size { width: frame.width as usize, height: frame.height as usize };
    capture.black = black_level(&frame.black_level)?;
    capture.notes.extend(opcode_notes(&frame));
    capture.counts = match frame.data {
        RawPixelData::U16(samples) => Counts::U16(whole(Mosaic { size, layout, samples })?),
        RawPixelData::F32(samples) => Counts::F32(whole(Mosaic { size, layout, samples })?),
        _ => return Err(Error::DecoderFailed { decoder: "flashraw" }),
    };
    if let Some(tiff) = &container.tiff {
        dng_mends::mend(tiff, raw.frame_info(), &mut capture.counts)?;
    }
    Ok(capture)
}

/// Decodes what flashraw does not read, or reads wrongly; `None` for all others.
fn decode_ourselves(
    bytes: &[u8],
    container: &Container<'_>,
    raw: &FlashRaw<'_>,
    limits: &Limits,
) -> Result<Option<Capture>, Error> {
    let Some(tiff) = &container.tiff else { return Ok(None) };
    let info = raw.frame_info();
    let describe = || describe(bytes, container, raw.metadata(), info);
    if dng_jxl::is_stored_so(info) {
        let samples = dng_jxl::decode(tiff, info, limits)?;
        let mut capture = describe()?;
        let (size, layout) = (capture.counts.size(), capture.counts.layout().clone());
        capture.counts = Counts::F32(whole(Mosaic { size, layout, samples })?);
        if info.opcodes.as_ref().is_some_and(|o| !o.lists[0].is_empty()) {
            capture.notes.push("OpcodeList1 is not applied to floating-point JPEG XL".to_owned());
        }
        return Ok(Some(capture));
    }
    let Some((samples, note)) = nef_packing::samples(tiff, raw.metadata(), info)? else { return Ok(None) };
    let mut capture = describe()?;
    let (size, layout) = (capture.counts.size(), capture.counts.layout().clone());
    capture.counts = Counts::U16(whole(Mosaic { size, layout, samples })?);
    capture.notes.push(note);
    Ok(Some(capture))
}

/// Fewest threads on which guessing where Huffman codes begin is faster than reading them one after the other: it takes
/// 2.4 times the work and twice the memory.
const THREADS_FOR_GUESSING: usize = 4;

/// Runs a decoder on all threads, or on one where more would only be in its way.
fn on_threads_that_help<T: Send>(info: &FrameInfo, decode: impl FnOnce() -> T + Send) -> T {
    let guesses = info.compression == flashraw::Compression::NikonHuffman;
    let too_few = (2..THREADS_FOR_GUESSING).contains(&rayon::current_num_threads());
    if !(guesses && too_few) {
        return decode();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(one) => one.install(decode),
        Err(_) => decode(),
    }
}

/// Everything but the samples.
pub(crate) fn header(bytes: &[u8], container: &Container<'_>, limits: &Limits) -> Result<Capture, Error> {
    if let Some(named) = name_colours(bytes, container) {
        return named.restore(header_named(&named.bytes, container, limits)?);
    }
    header_named(bytes, container, limits)
}

fn header_named(bytes: &[u8], container: &Container<'_>, limits: &Limits) -> Result<Capture, Error> {
    let raw = open(bytes, limits)?;
    describe(bytes, container, raw.metadata(), raw.frame_info())
}

/// A DNG whose filter array uses a colour that its CFAPlaneColor does not name. flashraw refuses it, although
/// the samples are sound: it gets a copy in which that colour is called green, and the truth is restored after.
struct NamedColours {
    bytes: Vec<u8>,
    pattern: Vec<u8>,
    planes: usize,
}

fn name_colours(bytes: &[u8], container: &Container<'_>) -> Option<NamedColours> {
    let tiff = container.tiff.as_ref().filter(|t| t.has(DNG_VERSION))?;
    let planes = match tiff.byte_positions(CFA_PLANE_COLOR).len() {
        0 => 3,
        n => n,
    };
    let positions = tiff.byte_positions(CFA_PATTERN);
    let pattern = bytes.get(positions.clone())?.to_vec();
    if !pattern.iter().any(|&i| usize::from(i) >= planes) {
        return None;
    }
    let mut bytes = bytes.to_vec();
    for i in bytes.get_mut(positions)?.iter_mut().filter(|i| usize::from(**i) >= planes) {
        *i = GREEN;
    }
    Some(NamedColours { bytes, pattern, planes })
}

impl NamedColours {
    fn restore(&self, mut capture: Capture) -> Result<Capture, Error> {
        let layout = match &mut capture.counts {
            Counts::U16(m) => &mut m.layout,
            Counts::F32(m) => &mut m.layout,
        };
        if let Layout::Cfa(cfa) = layout {
            // The decoder gives the pattern from the first sample on, the file from the active area on.
            let (x0, y0) = (capture.active_area.x % cfa.width(), capture.active_area.y % cfa.height());
            let (width, height) = (cfa.width(), cfa.height());
            let filters = (0..width * height).map(|i| {
                let (x, y) = ((i % width + width - x0) % width, (i / width + height - y0) % height);
                let unnamed = self.pattern.get(y * width + x).is_some_and(|&c| usize::from(c) >= self.planes);
                if unnamed { Filter::Other('E') } else { cfa.at(i % width, i / width) }
            });
            *cfa = Cfa::new(width, filters.collect()).ok_or(Error::DecoderFailed { decoder: "flashraw" })?;
        }
        capture
            .notes
            .push("the filter array has a colour that the file does not name (shown as E)".to_owned());
        Ok(capture)
    }
}

/// What a flashraw error means to the person who has the file.
pub(crate) fn error(e: &flashraw::Error) -> Error {
    use flashraw::Error as E;
    match e {
        E::UnsupportedFormat(_) => Error::NotRaw { found: "its format is not known" },
        E::UnsupportedCompression { compression, .. } => {
            Error::Compression { compression: compression.clone(), decoder: "flashraw" }
        }
        // A file that ends before its samples, as previews cut from raw files do.
        E::CameraUnsupported { reason, .. } if reason.contains("no lossless-JPEG raw stream") => {
            Error::NoRawData { message: reason.clone() }
        }
        E::CameraUnsupported { make, model, reason } => Error::Camera {
            camera: if model.starts_with(make.as_str()) { model.clone() } else { format!("{make} {model}") },
            reason: match reason.as_str() {
                "" => Unknown::Camera,
                message => Unknown::Decoder { message: message.to_owned() },
            },
            decoder: "flashraw",
        },
        E::OutOfMemory(message) | E::LimitExceeded(message) => {
            Error::TooLarge(TooLarge::Decoder { message: message.clone() })
        }
        E::NotAvailable(message) => Error::NoRawData { message: message.clone() },
        E::InvalidMetadata(message) if message.contains("no raw") => {
            Error::NoRawData { message: message.clone() }
        }
        other => {
            let message = other.to_string();
            let message = message.strip_prefix("corrupt file: ").unwrap_or(&message).to_owned();
            Damage::Decoder { message }.into()
        }
    }
}

/// As [`error`], with the name of the compression that could not be decoded.
fn decode_error(e: &flashraw::Error, info: &FrameInfo) -> Error {
    match error(e) {
        Error::Compression { compression, decoder } => {
            let compression = match info.compression {
                flashraw::Compression::Uncompressed => compression,
                _ => format!("{} ({compression})", compression_name(info)),
            };
            Error::Compression { compression, decoder }
        }
        other => other,
    }
}

fn open<'a>(bytes: &'a [u8], limits: &Limits) -> Result<FlashRaw<'a>, Error> {
    let raw = FlashRaw::open_with(bytes, flash_limits(limits)).map_err(|e| match error(&e) {
        Error::NotRaw { .. } if bytes.starts_with(b"II") || bytes.starts_with(b"MM") => {
            Error::NotRaw { found: "it is a TIFF file without raw samples that this program knows" }
        }
        other => other,
    })?;
    bytes_suffice(bytes.len() as u64, raw.frame_info())?;
    opcode_work::check(raw.frame_info())?;
    Ok(raw)
}

/// Refuses a frame that cannot come of so few bytes. Files that were merely cut off pass: the decoder says where they end.
fn bytes_suffice(bytes: u64, info: &FrameInfo) -> Result<(), Error> {
    use flashraw::Compression as C;
    /// A sample takes one bit at least where it is coded by itself; eight times less is a file that was cut off.
    const SINGLE: u64 = 64;
    /// Deflate makes 1032 bytes of one at most; others code blocks of even colour in some bits.
    const BLOCKS: u64 = 4096;
    let by_blocks = matches!(info.compression, C::Deflate | C::LossyJpeg | C::JpegXl | C::CanonCrx | C::Vc5);
    let of_byte = if by_blocks { BLOCKS } else { SINGLE };
    let samples = u64::from(info.width).saturating_mul(info.height.into()).saturating_mul(info.cpp.into());
    if samples > bytes.saturating_mul(of_byte) {
        return Err(Damage::FewBytes { bytes, samples }.into());
    }
    Ok(())
}

fn flash_limits(limits: &Limits) -> flashraw::Limits {
    flashraw::Limits::default().with_max_samples(limits.max_samples).with_max_dimension(limits.max_side)
}

/// A mosaic whose sample count fits its size; a decoder that breaks this promise is not trusted further.
fn whole<T>(mosaic: Mosaic<T>) -> Result<Mosaic<T>, Error> {
    let expected = mosaic.size.area() * mosaic.layout.planes();
    if mosaic.samples.len() == expected && expected > 0 {
        Ok(mosaic)
    } else {
        Err(Error::DecoderFailed { decoder: "flashraw" })
    }
}

/// The capture of these headers, with no samples yet.
fn describe(
    bytes: &[u8],
    container: &Container<'_>,
    meta: &RawMetadata,
    info: &FrameInfo,
) -> Result<Capture, Error> {
    let mut notes = Vec::new();
    let size = Size { width: info.width as usize, height: info.height as usize };
    let layout = layout(info)?;
    let tiff = container.tiff.as_ref();
    let is_dng = tiff.is_some_and(|t| t.has(DNG_VERSION));
    if is_dng && !tiff.is_some_and(|t| t.has(WHITE_LEVEL)) {
        notes.push(format!("the file names no white level; {} is assumed", info.white_level.max()));
    }
    notes.extend(tiff.map(dng_extras::notes).unwrap_or_default());
    let default_crop = rect(info.crop, size);
    let user_crop = maker_note::user_crop(bytes, tiff, is_dng, default_crop);
    // What a converter wrote for the lens stands in the DNG's own lists.
    let maker_lens = if is_dng { None } else { maker_note::lens(bytes, tiff, &mut notes) };
    let white = white_level(info, &layout);
    let (calibrations, analog_balance) = calibrations(&info.color_matrices);
    let as_shot = as_shot(meta, info);
    let no_light = as_shot.is_none() && !info.white_balance_applied && layout.planes() == 1;
    if no_light && layout != Layout::Monochrome {
        notes.push("the file records no white balance".to_owned());
    }
    let (mut mosaic_corrections, mut picture_corrections) = (Vec::new(), Vec::new());
    if let Some(opcodes) = &info.opcodes {
        mosaic_corrections = opcodes::parse(&opcodes.lists[1], "OpcodeList2", &mut notes);
        picture_corrections = opcodes::parse(&opcodes.lists[2], "OpcodeList3", &mut notes);
    }
    let local_tone =
        tiff.filter(|_| is_dng).and_then(|tiff| local_tone::read(tiff, &mut notes)).map(Arc::new);
    let mut metadata = exif::read(bytes, container, meta);
    exif::complete(&mut metadata, meta);
    Ok(Capture {
        camera: camera(meta),
        counts: Counts::U16(Mosaic { size, layout, samples: Vec::new() }),
        active_area: rect(info.active_area, size),
        default_crop,
        user_crop,
        orientation: Orientation::from_exif(info.orientation.exif()),
        pixel_aspect: pixel_aspect(meta, info),
        black: black_level(&info.black_level)?,
        white,
        as_shot,
        balance_applied: info.white_balance_applied,
        rendered: false,
        calibrations,
        analog_balance,
        baseline_exposure: meta
            .dng
            .as_ref()
            .and_then(|d| d.baseline_exposure)
            .unwrap_or(0.0)
            .clamp(-10.0, 10.0),
        noise_profile: noise_profile(meta),
        mosaic_corrections,
        picture_corrections,
        maker_lens,
        local_tone,
        metadata,
        source: Source {
            format: meta.format.map_or("raw", |f| f.name()).to_owned(),
            compression: compression_name(info),
            bits: info.bits_per_sample,
            decoder: NAME.to_owned(),
        },
        notes,
    })
}

/// What flashraw says of OpcodeList1, which it applies itself: only what it left out.
fn opcode_notes(frame: &RawFrame) -> Vec<String> {
    let first = frame.stats.opcodes.iter().filter(|n| n.starts_with("OpcodeList1: not applied"));
    first.cloned().collect()
}
