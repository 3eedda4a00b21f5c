//! PNG: 8 or 16 bits, with the profile in iCCP and Exif in eXIf.

use std::borrow::Cow;
use std::io::Write;

use darkroot_photo::{Metadata, Samples};
use png::{BitDepth, ColorType, DeflateCompression, Encoder, EncodingError, Filter, Info};

use crate::format::Frame;
use crate::{Error, Format, exif};

pub(crate) fn write(frame: &Frame<'_>, metadata: &Metadata, out: &mut impl Write) -> Result<(), Error> {
    encode(frame, metadata, out).map_err(|e| Error::encoder(Format::Png)(e.into()))
}

fn encode(frame: &Frame<'_>, metadata: &Metadata, out: &mut impl Write) -> Result<(), EncodingError> {
    let mut info = Info::with_size(frame.width, frame.height);
    info.color_type = ColorType::Rgb;
    info.bit_depth = match frame.samples {
        Samples::U8(_) => BitDepth::Eight,
        Samples::U16(_) | Samples::F32(_) => BitDepth::Sixteen,
    };
    info.icc_profile = Some(Cow::Owned(frame.profile()));
    let block = exif::block(metadata);
    info.exif_metadata = (!block.is_empty()).then_some(Cow::Owned(block));

    let mut encoder = Encoder::with_info(out, info)?;
    encoder.set_deflate_compression(DeflateCompression::Level(LEVEL));
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer_with_size(1 << 17)?;
    match frame.samples {
        Samples::U8(samples) => rows.write_all(samples)?,
        Samples::U16(samples) => {
            let mut bytes = Vec::with_capacity(2 * frame.row());
            for row in samples.chunks_exact(frame.row()) {
                bytes.clear();
                bytes.extend(row.iter().flat_map(|s| s.to_be_bytes()));
                rows.write_all(&bytes)?;
            }
        }
        // PNG has no such samples, and Frame::of lets none through.
        Samples::F32(_) => {}
    }
    rows.finish()?;
    writer.finish()
}

/// Level of deflate. Higher ones take five times as long for a file that is one in a hundred smaller: what is
/// left of a photograph after the filter is mostly noise.
const LEVEL: u8 = 1;

#[cfg(test)]
mod tests {
    use crate::Format;
    use crate::testing::assert_lossless;
    use darkroot_colour::RgbSpace;
    use darkroot_photo::PictureSpace;

    #[test]
    fn samples_of_8_bits_come_back() {
        assert_lossless(Format::Png, 8, PictureSpace::Rgb(RgbSpace::SRGB));
    }

    #[test]
    fn samples_of_16_bits_come_back() {
        assert_lossless(Format::Png, 16, PictureSpace::Rgb(RgbSpace::REC2020));
    }
}
