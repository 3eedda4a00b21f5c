//! WebP, lossless or lossy, with the profile in ICCP, Exif in EXIF and XMP in "XMP ".
//!
//! The lossless kind is written by image-webp, the lossy kind by libwebp; the chunks around the latter
//! (RFC 9649, section 2.7) are ours.

use std::io::Write;

use darkroot_photo::Metadata;
use image_webp::{ColorType, WebPEncoder};

use crate::format::Frame;
use crate::options::WebpKind;
use crate::output::Buffered;
use crate::{Error, Format, Options, exif};

pub(crate) fn write(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
) -> Result<(), Error> {
    match options.webp {
        WebpKind::Lossless => lossless(frame, metadata, out),
        WebpKind::Lossy => lossy(frame, options.quality, metadata, out),
    }
}

fn lossless(frame: &Frame<'_>, metadata: &Metadata, out: &mut Buffered<'_, '_>) -> Result<(), Error> {
    let failed = Error::encoder(Format::Webp);
    let mut encoder = WebPEncoder::new(out);
    encoder.set_icc_profile(frame.profile());
    encoder.set_exif_metadata(exif::block(metadata));
    encoder.set_xmp_metadata(exif::xmp(metadata).to_vec());
    encoder.encode(frame.bytes(), frame.width, frame.height, ColorType::Rgb8).map_err(|e| failed(e.into()))
}

fn lossy(
    frame: &Frame<'_>,
    quality: u8,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
) -> Result<(), Error> {
    let failed = |words: String| Error::encoder(Format::Webp)(words.into());
    let mut config = webp::WebPConfig::new().map_err(|()| failed("it has another version".to_owned()))?;
    config.quality = f32::from(quality);
    // Colour edges stay sharp at half the resolution.
    config.use_sharp_yuv = 1;
    let encoder = webp::Encoder::from_rgb(frame.bytes(), frame.width, frame.height);
    let coded = encoder.encode_advanced(&config).map_err(|e| failed(format!("{e:?}")))?;
    // RIFF, size, WEBP, and then the chunk with the picture.
    let picture = coded.get(12..).ok_or_else(|| failed("it wrote no picture".to_owned()))?;
    let parts = Parts {
        width: frame.width,
        height: frame.height,
        profile: &frame.profile(),
        picture,
        exif: &exif::block(metadata),
        xmp: exif::xmp(metadata),
    };
    out.write_all(&parts.file()).map_err(Error::Io)
}

/// What a file is made of.
struct Parts<'a> {
    width: u32,
    height: u32,
    profile: &'a [u8],
    /// With the head of its chunk.
    picture: &'a [u8],
    exif: &'a [u8],
    xmp: &'a [u8],
}

impl Parts<'_> {
    fn file(&self) -> Vec<u8> {
        const PROFILE: u8 = 0x20;
        const EXIF: u8 = 0x08;
        const XMP: u8 = 0x04;
        let has = |flag: u8, part: &[u8]| if part.is_empty() { 0 } else { flag };
        let flags = has(PROFILE, self.profile) | has(EXIF, self.exif) | has(XMP, self.xmp);
        let mut head = vec![flags, 0, 0, 0];
        for side in [self.width, self.height] {
            head.extend(&(side - 1).to_le_bytes()[..3]);
        }
        let mut body = b"WEBP".to_vec();
        chunk(&mut body, b"VP8X", &head);
        chunk(&mut body, b"ICCP", self.profile);
        body.extend(self.picture);
        chunk(&mut body, b"EXIF", self.exif);
        chunk(&mut body, b"XMP ", self.xmp);
        let mut file = b"RIFF".to_vec();
        file.extend((body.len() as u32).to_le_bytes());
        file.extend(body);
        file
    }
}

/// A chunk of an even number of bytes; none of nothing.
fn chunk(out: &mut Vec<u8>, name: &[u8; 4], bytes: &[u8]) {
    if bytes.is_empty() {
        return;
    }
    out.extend(name);
    out.extend((bytes.len() as u32).to_le_bytes());
    out.extend(bytes);
    out.resize(out.len().next_multiple_of(2), 0);
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use crate::options::WebpKind;
    use crate::testing::{assert_lossless, decoded, metadata, picture};
    use crate::{Format, Options, exif, icc};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::{PictureSpace, Samples};
    use image::ImageDecoder;
    use image::codecs::webp::WebPDecoder;

    #[test]
    fn the_samples_come_back() {
        assert_lossless(Format::Webp, 8, PictureSpace::Rgb(RgbSpace::DISPLAY_P3));
    }

    #[test]
    fn the_lossy_kind_is_much_smaller_and_says_the_same_of_the_picture() {
        let picture = picture(301, 200, 8, PictureSpace::Rgb(RgbSpace::DISPLAY_P3));
        let file = |webp, quality| {
            let options = Options { webp, quality, ..Options::default() };
            let mut file = Cursor::new(Vec::new());
            crate::write(&picture, Format::Webp, &options, &metadata(), &mut file).unwrap();
            file.into_inner()
        };
        let (lossless, lossy) = (file(WebpKind::Lossless, 92), file(WebpKind::Lossy, 92));
        assert!(2 * lossy.len() < lossless.len() && file(WebpKind::Lossy, 40).len() < lossy.len());
        let (size, samples) = decoded(Format::Webp, &lossy);
        let (Samples::U8(there), Samples::U8(back)) = (&picture.samples, &samples) else { panic!() };
        let off: u64 = there.iter().zip(back).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        assert!(size == picture.size && (off as f64) < 12.0 * there.len() as f64, "{off}");
        let of = |file: &[u8]| {
            let mut reader = WebPDecoder::new(Cursor::new(file.to_vec())).unwrap();
            let parts = (reader.icc_profile().unwrap(), reader.exif_metadata().unwrap());
            (parts, reader.xmp_metadata().unwrap())
        };
        let ((profile, exif), _) = of(&lossy);
        assert_eq!(profile.unwrap(), icc::profile(&RgbSpace::DISPLAY_P3));
        let about = exif::of_picture(&metadata(), picture.size, &picture.space, Format::Webp);
        assert!(exif.unwrap().starts_with(&exif::block(&about)) && of(&lossy) == of(&lossless));
    }
}
