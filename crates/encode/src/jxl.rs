//! JPEG XL: lossless, 8 or 16 bits, in its container, with Exif.
//!
//! The library encodes the pixels well but has one word for all colours, sRGB, and no picture of one row. So its
//! image header is replaced by one that names the space of the picture (ISO/IEC 18181-1:2024, annex D), and its
//! frame header by one that may be larger than the picture (annex F).

use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};

use darkroot_colour::{RgbSpace, TransferCurve, Xy, white};
use darkroot_photo::{Metadata, PictureSpace, Samples};
use zune_core::bit_depth::BitDepth;
use zune_core::colorspace::ColorSpace;
use zune_core::options::EncoderOptions;
use zune_jpegxl::JxlSimpleEncoder;

use crate::format::Frame;
use crate::output::Buffered;
use crate::{Error, Format, exif};

pub(crate) fn write(frame: &Frame<'_>, metadata: &Metadata, out: &mut Buffered<'_, '_>) -> Result<(), Error> {
    let codestream = codestream(frame)?;
    write_container(&codestream, frame.samples.bits(), [&exif::block(metadata), exif::xmp(metadata)], out)
        .map_err(Error::Io)
}

/// What the library was made to do, and what it should not have done.
#[derive(Debug, thiserror::Error)]
enum Fault {
    #[error("it panicked; PNG and TIFF hold the same samples")]
    Panic,
    #[error("its headers are not those that were expected")]
    Header,
}

/// The picture as a bare codestream.
fn codestream(frame: &Frame<'_>) -> Result<Vec<u8>, Error> {
    let failed = Error::encoder(Format::Jxl);
    let canvas = Canvas::of(frame);
    let bits = frame.samples.bits();
    let enlarged;
    let bytes: &[u8] = match frame.samples {
        Samples::U8(v) if canvas.fits(frame) => v,
        Samples::U16(v) if canvas.fits(frame) => bytemuck::cast_slice(v),
        Samples::U8(v) => {
            enlarged = canvas.fill(frame, v);
            &enlarged
        }
        Samples::U16(v) => {
            enlarged = canvas.fill(frame, bytemuck::cast_slice(v));
            &enlarged
        }
        // JPEG XL is written with no such samples, and Frame::of lets none through.
        Samples::F32(_) => &[],
    };
    let depth = if bits == 8 { BitDepth::Eight } else { BitDepth::Sixteen };
    let (width, height) = (canvas.width as usize, canvas.height as usize);
    let options = EncoderOptions::new(width, height, ColorSpace::RGB, depth);
    // The library reserves 24 bits a sample of 16 bits and panics when a picture needs more, as one does that
    // jumps between opposite colours from pixel to pixel. That is an error here; the panic hook still speaks.
    let encoded = catch_unwind(AssertUnwindSafe(|| {
        let mut encoded = Vec::new();
        JxlSimpleEncoder::new(bytes, options).encode(&mut encoded).map(|_| encoded)
    }));
    let encoded = encoded.map_err(|_| failed(Fault::Panic.into()))?.map_err(|e| failed(e.into()))?;

    let theirs = [image_header(width as u32, height as u32, bits, None), frame_header(None)].concat();
    let contents = encoded.strip_prefix(&theirs[..]).ok_or_else(|| failed(Fault::Header.into()))?;
    let space = match frame.space {
        PictureSpace::Rgb(space) if !is_srgb(space) => Some(space),
        _ => None,
    };
    let mut ours = image_header(frame.width, frame.height, bits, space);
    ours.extend(frame_header((!canvas.fits(frame)).then_some(&canvas)));
    ours.extend_from_slice(contents);
    Ok(ours)
}

fn is_srgb(space: &RgbSpace) -> bool {
    crate::format::same_colours(space, &RgbSpace::SRGB)
}

/// What the library encodes: the picture, enlarged to the right and below where the library cannot take it.
#[derive(Debug, PartialEq)]
struct Canvas {
    width: u32,
    height: u32,
}

impl Canvas {
    /// The library refuses a side of 1, and for 16 bits it reserves too little when the picture is one group
    /// (256 x 256) or less.
    fn of(frame: &Frame<'_>) -> Self {
        let (width, height) = (frame.width.max(2), frame.height.max(2));
        let one_group = width <= 256 && height <= 256;
        Self { width: if one_group && frame.samples.bits() == 16 { 257 } else { width }, height }
    }

    fn fits(&self, frame: &Frame<'_>) -> bool {
        (self.width, self.height) == (frame.width, frame.height)
    }

    /// The bytes of the picture with its last column and row repeated.
    fn fill(&self, frame: &Frame<'_>, bytes: &[u8]) -> Vec<u8> {
        let pixel = 3 * usize::from(frame.samples.bits()) / 8;
        let mut filled = Vec::with_capacity(self.width as usize * self.height as usize * pixel);
        for row in bytes.chunks_exact(frame.width as usize * pixel) {
            filled.extend_from_slice(row);
            for _ in frame.width..self.width {
                filled.extend_from_slice(&row[row.len() - pixel..]);
            }
        }
        for _ in frame.height..self.height {
            let last = filled.len() - self.width as usize * pixel;
            filled.extend_from_within(last..);
        }
        filled
    }
}

/// Signature, SizeHeader, ImageMetadata and default transforms (annex D); `None` is sRGB. It ends at a byte.
fn image_header(width: u32, height: u32, bits: u8, space: Option<&RgbSpace>) -> Vec<u8> {
    let mut header = Bits::default();
    header.put(16, 0x0aff);
    header.put(1, 0); // Size is not in multiples of 8.
    header.side(height);
    header.put(3, 0); // No fixed ratio.
    header.side(width);

    header.put(1, 0); // ImageMetadata: not all default.
    header.put(1, 0); // No extra fields.
    header.put(1, 0); // Integers.
    if bits == 8 {
        header.put(2, 0);
    } else {
        header.put(2, 3);
        header.put(6, u32::from(bits) - 1);
    }
    header.put(1, u32::from(bits == 8)); // Whether 16 bits are enough for a decoder to compute with.
    header.put(2, 0); // No extra channels.
    header.put(1, 0); // Not XYB.
    match space {
        None => header.put(1, 1),
        Some(space) => header.colours(space),
    }
    header.put(2, 0); // No extensions.
    header.put(1, 1); // Default transforms.
    header.bytes()
}

/// FrameHeader of a single modular frame (annex F), followed by "the table of contents is in order". It ends
/// at a byte, as the table of contents begins at one. `None` is a frame of the size of the picture.
fn frame_header(canvas: Option<&Canvas>) -> Vec<u8> {
    let mut header = Bits::default();
    header.put(1, 0); // Not all default.
    header.put(2, 0); // A regular frame,
    header.put(1, 1); // modular,
    header.put(2, 0); // without flags,
    header.put(1, 0); // not YCbCr,
    header.put(2, 0); // not upsampled,
    header.put(2, 1); // groups of 256 x 256,
    header.put(2, 0); // one pass.
    match canvas {
        None => header.put(1, 0),
        Some(canvas) => {
            header.put(1, 1); // A size of its own, from the top left corner.
            header.extent(0);
            header.extent(0);
            header.extent(canvas.width);
            header.extent(canvas.height);
        }
    }
    header.put(2, 0); // It replaces what was there.
    header.put(1, 1); // The last one.
    header.put(2, 0); // No name.
    header.put(1, 0); // Restoration filter: not all default,
    header.put(1, 0); // no Gabor-like filter,
    header.put(2, 0); // no edge-preserving filter,
    header.put(2, 0); // no extensions.
    header.put(2, 0); // No extensions of the frame.
    header.put(1, 0); // The table of contents is in order.
    header.bytes()
}

/// Bits from the least significant of each byte on (annex B).
#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    pending: u64,
    count: u32,
}

impl Bits {
    /// `count` bits (at most 32) of `value`.
    fn put(&mut self, count: u32, value: u32) {
        self.pending |= u64::from(value) << self.count;
        self.count += count;
        while self.count >= 8 {
            self.bytes.push(self.pending as u8);
            self.pending >>= 8;
            self.count -= 8;
        }
    }

    /// U32 of four ranges, each with its first value and number of bits: the first one that holds the value.
    fn ranged(&mut self, ranges: [(u32, u32); 4], value: u32) {
        for (selector, (first, bits)) in (0..).zip(ranges) {
            if value >= first && u64::from(value - first) < 1 << bits {
                self.put(2, selector);
                self.put(bits, value - first);
                return;
            }
        }
    }

    /// Width or height of the picture, 1..=2^30.
    fn side(&mut self, pixels: u32) {
        self.ranged([(1, 9), (1, 13), (1, 18), (1, 30)], pixels);
    }

    /// Place or size of a frame; values from 0 on.
    fn extent(&mut self, value: u32) {
        self.ranged([(0, 8), (256, 11), (2304, 14), (18688, 30)], value);
    }

    /// Enum.
    fn name(&mut self, value: u32) {
        self.ranged([(0, 0), (1, 0), (2, 4), (18, 6)], value);
    }

    /// Customxy: chromaticity in millionths, negative ones allowed.
    fn xy(&mut self, xy: Xy) {
        for v in [xy.x, xy.y] {
            let millionths = (v * 1e6).round() as i32;
            let unsigned = (millionths << 1) ^ (millionths >> 31);
            self.ranged([(0, 19), (524_288, 19), (1_048_576, 20), (2_097_152, 21)], unsigned as u32);
        }
    }

    /// ColourEncoding of an RGB space (table E.1).
    fn colours(&mut self, space: &RgbSpace) {
        const CUSTOM: u32 = 2;
        self.put(1, 0); // Not all default.
        self.put(1, 0); // No ICC profile.
        self.name(0); // RGB.
        if space.white == white::D65_XY {
            self.name(1);
        } else {
            self.name(CUSTOM);
            self.xy(space.white);
        }
        let named = [(RgbSpace::SRGB, 1), (RgbSpace::REC2020, 9), (RgbSpace::DISPLAY_P3, 11)];
        match named.iter().find(|(known, _)| known.primaries == space.primaries) {
            Some((_, name)) => self.name(*name),
            None => {
                self.name(CUSTOM);
                space.primaries.iter().for_each(|p| self.xy(*p));
            }
        }
        match space.curve {
            TransferCurve::Gamma(gamma) => {
                self.put(1, 1);
                self.put(24, (1e7 / gamma).round() as u32);
            }
            curve => {
                self.put(1, 0);
                self.name(match curve {
                    TransferCurve::Linear => 8,
                    // The curve of BT.709, of which that of BT.2020 is the precise form.
                    TransferCurve::Rec2020 => 1,
                    _ => 13,
                });
            }
        }
        self.name(1); // Rendering intent: relative.
    }

    /// The bytes, filled up with zeros.
    fn bytes(mut self) -> Vec<u8> {
        if self.count > 0 {
            self.bytes.push(self.pending as u8);
        }
        self.bytes
    }
}

/// Boxes around the codestream (ISO/IEC 18181-2): signature, file type, level, Exif, XMP, codestream.
fn write_container(
    codestream: &[u8],
    bits: u8,
    [exif, xmp]: [&[u8]; 2],
    out: &mut impl Write,
) -> std::io::Result<()> {
    out.write_all(b"\0\0\0\x0cJXL \r\n\x87\n")?;
    out.write_all(b"\0\0\0\x14ftypjxl \0\0\0\0jxl ")?;
    if bits > 8 {
        // Level 10, as a decoder must compute with more than 16 bits.
        out.write_all(b"\0\0\0\x09jxll\x0a")?;
    }
    if !exif.is_empty() {
        write_box(b"Exif", &[b"\0\0\0\0", exif], out)?; // The block follows at once.
    }
    if !xmp.is_empty() {
        write_box(b"xml ", &[xmp], out)?;
    }
    write_box(b"jxlc", &[codestream], out)
}

fn write_box(kind: &[u8; 4], contents: &[&[u8]], out: &mut impl Write) -> std::io::Result<()> {
    let length = contents.iter().map(|c| c.len() as u64).sum::<u64>();
    match u32::try_from(length + 8) {
        Ok(short) => {
            out.write_all(&short.to_be_bytes())?;
            out.write_all(kind)?;
        }
        Err(_) => {
            out.write_all(&1_u32.to_be_bytes())?;
            out.write_all(kind)?;
            out.write_all(&(length + 16).to_be_bytes())?;
        }
    }
    contents.iter().try_for_each(|c| out.write_all(c))
}

#[cfg(test)]
mod tests;
