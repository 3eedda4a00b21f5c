//! PNG: 8 or 16 bits, with the profile in iCCP and Exif in eXIf.
//!
//! Each band is filtered and deflated on its own, up to a whole byte (a "sync flush", RFC 1951, 3.2.4), so that bands can be
//! joined to one stream of zlib (RFC 1950); between two of them only the checksum has to be carried on.

use std::borrow::Cow;
use std::io::Write;

use darkroot_photo::Metadata;
use flate2::{Compress, Compression, FlushCompress, Status};
use png::{BitDepth, ColorType, Encoder, EncodingError, Info, Writer, chunk};

use crate::bands::{self, MakeBands, Outline, Sink};
use crate::format::profile_of;
use crate::output::Buffered;
use crate::{Error, Format, Sample, exif};

mod filter;

/// Rows of a band.
const BAND_ROWS: usize = 192;

/// Level of deflate. Higher ones take five times as long for a file that is one in a hundred smaller: what is
/// left of a photograph after the filter is mostly noise.
const LEVEL: u32 = 1;

/// Writes a picture of a size that [`Format::sides`] has allowed.
pub(crate) fn write<T: Sample>(
    outline: &Outline,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
    make: &mut MakeBands<'_, T>,
) -> Result<(), Error> {
    let Outline { size, space } = outline;
    let mut info = Info::with_size(size.width as u32, size.height as u32);
    info.color_type = ColorType::Rgb;
    info.bit_depth = if T::BITS == 8 { BitDepth::Eight } else { BitDepth::Sixteen };
    info.icc_profile = Some(Cow::Owned(profile_of(space)));
    let block = exif::block(metadata);
    info.exif_metadata = (!block.is_empty()).then_some(Cow::Owned(block));
    let mut file = Encoder::with_info(out, info).and_then(Encoder::write_header).map_err(error)?;

    let packet = exif::xmp(metadata);
    if !packet.is_empty() {
        // Not compressed, of no language (PNG 11.3.3.4; XMP specification, part 3, 1.1.5).
        let text = [b"XML:com.adobe.xmp\0\0\0\0\0", packet].concat();
        file.write_chunk(chunk::iTXt, &text).map_err(error)?;
    }
    // Deflate with a window of 32 KiB, the fastest level.
    file.write_chunk(chunk::IDAT, &[0x78, 0x01]).map_err(error)?;
    let last = size.height.div_ceil(BAND_ROWS) - 1;
    let code = |band, samples: &[T]| deflated(samples, size.width, band == last).map_err(Error::Io);
    let stream = bands::code(*size, BAND_ROWS, Stream { file, checksum: 1 }, code, make)?;
    let mut file = stream.file;
    file.write_chunk(chunk::IDAT, &stream.checksum.to_be_bytes()).map_err(error)?;
    file.finish().map_err(error)
}

fn error(e: EncodingError) -> Error {
    Error::encoder(Format::Png)(e.into())
}

/// A band of the stream.
struct Deflated {
    bytes: Vec<u8>,
    /// Of what was deflated.
    checksum: u32,
    length: usize,
}

/// Filters and deflates a band.
fn deflated<T: Sample>(samples: &[T], width: usize, last: bool) -> std::io::Result<Deflated> {
    // What an empty block of a sync flush ends with.
    const FLUSHED: [u8; 4] = [0, 0, 0xff, 0xff];
    let filtered = filter::band(samples, width);
    let mut deflate = Compress::new(Compression::new(LEVEL), false);
    let mut bytes = Vec::with_capacity(filtered.len());
    let flush = if last { FlushCompress::Finish } else { FlushCompress::Sync };
    // One flush does not always bring out all: flate2's writer stops as soon as there is room left, and then something is lost.
    loop {
        let (taken, there) = (deflate.total_in() as usize, bytes.len());
        let status = deflate.compress_vec(&filtered[taken..], &mut bytes, flush)?;
        let all_taken = deflate.total_in() as usize == filtered.len();
        let ended = if last { status == Status::StreamEnd } else { all_taken && bytes.ends_with(&FLUSHED) };
        if ended {
            break;
        }
        if deflate.total_in() as usize == taken && bytes.len() == there && bytes.len() < bytes.capacity() {
            return Err(std::io::Error::other("deflate does not go on"));
        }
        bytes.reserve(filtered.len() / 64 + 4096);
    }
    let checksum = adler2::adler32_slice(&filtered);
    Ok(Deflated { bytes, checksum, length: filtered.len() })
}

/// The picture's stream of zlib.
struct Stream<W: Write> {
    file: Writer<W>,
    /// Adler-32 of what has been written.
    checksum: u32,
}

impl<W: Write + Send> Sink for Stream<W> {
    type Coded = Deflated;

    fn put(&mut self, coded: Deflated) -> Result<(), Error> {
        self.checksum = joined(self.checksum, &coded);
        self.file.write_chunk(chunk::IDAT, &coded.bytes).map_err(error)
    }
}

/// The checksum of what has one and of a band behind it (RFC 1950, 8.2): two sums, the second one of all states of the first.
fn joined(before: u32, band: &Deflated) -> u32 {
    const MODULUS: u64 = 65_521;
    let sums = |checksum: u32| (u64::from(checksum & 0xffff), u64::from(checksum >> 16));
    let ((a, b), (band_a, band_b)) = (sums(before), sums(band.checksum));
    // The band's sums began with 1.
    let sum_a = (a + band_a + MODULUS - 1) % MODULUS;
    let sum_b = (b + band_b + band.length as u64 % MODULUS * (a + MODULUS - 1)) % MODULUS;
    (sum_b << 16 | sum_a) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_lossless;
    use darkroot_colour::RgbSpace;
    use darkroot_photo::PictureSpace;

    /// Adler-32 as RFC 1950 has it.
    fn slow(bytes: &[u8]) -> u32 {
        let step = |(a, b): (u32, u32), byte: &u8| {
            let a = (a + u32::from(*byte)) % 65_521;
            (a, (b + a) % 65_521)
        };
        let (a, b) = bytes.iter().fold((1, 0), step);
        b << 16 | a
    }

    /// Bands of photographs of many lengths: each must be there to its last byte before the next one begins.
    #[test]
    fn every_band_ends_at_a_whole_byte_with_nothing_left_behind() {
        let mut state = 1u32;
        let mut noise = |limit: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % limit
        };
        for width in (300..2000).step_by(17) {
            let grain = 1 + width as u32 % 23;
            let samples: Vec<u8> =
                (0..3 * width * 48).map(|i| (i / 700 % 200 + noise(grain) as usize) as u8).collect();
            let filtered = filter::band(&samples, width);
            for last in [false, true] {
                let band = deflated(&samples, width, last).unwrap();
                assert_eq!(band.length, filtered.len());
                let mut back = Vec::with_capacity(filtered.len() + 1);
                let mut inflate = flate2::Decompress::new(false);
                inflate.decompress_vec(&band.bytes, &mut back, flate2::FlushDecompress::Sync).unwrap();
                assert!(back == filtered, "{width} {last}: {} of {} bytes", back.len(), filtered.len());
                assert!(last || band.bytes.ends_with(&[0, 0, 0xff, 0xff]), "{width}");
            }
        }
    }

    /// Readers in Rust do not look at the checksum, others do.
    #[test]
    fn the_stream_ends_with_the_checksum_of_all_bands() {
        let picture = crate::testing::picture(4000, 300, 8, PictureSpace::Rgb(RgbSpace::SRGB));
        let file = crate::testing::encoded(&picture, Format::Png, &Metadata::default()).unwrap();
        let (mut at, mut stream) = (8, Vec::new());
        while at < file.len() {
            let length = u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
            if &file[at + 4..at + 8] == b"IDAT" {
                stream.extend_from_slice(&file[at + 8..at + 8 + length]);
            }
            at += 12 + length;
        }
        let mut filtered = Vec::new();
        let (deflated, checksum) = stream[2..].split_at(stream.len() - 6);
        std::io::Read::read_to_end(&mut flate2::read::DeflateDecoder::new(deflated), &mut filtered).unwrap();
        assert_eq!(filtered.len(), 300 * (3 * 4000 + 1));
        assert_eq!(u32::from_be_bytes(checksum.try_into().unwrap()), slow(&filtered));
    }

    #[test]
    fn samples_of_8_bits_come_back() {
        assert_lossless(Format::Png, 8, PictureSpace::Rgb(RgbSpace::SRGB));
    }

    #[test]
    fn samples_of_16_bits_come_back() {
        assert_lossless(Format::Png, 16, PictureSpace::Rgb(RgbSpace::REC2020));
    }
}
