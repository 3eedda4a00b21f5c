//! WebP: lossless, with the profile in ICCP, Exif in EXIF and XMP in "XMP ". The lossy kind would need a library in C.

use darkroot_photo::Metadata;
use image_webp::{ColorType, WebPEncoder};

use crate::format::Frame;
use crate::output::Buffered;
use crate::{Error, Format, exif};

pub(crate) fn write(frame: &Frame<'_>, metadata: &Metadata, out: &mut Buffered<'_, '_>) -> Result<(), Error> {
    let failed = Error::encoder(Format::Webp);
    let mut encoder = WebPEncoder::new(out);
    encoder.set_icc_profile(frame.profile());
    encoder.set_exif_metadata(exif::block(metadata));
    encoder.set_xmp_metadata(exif::xmp(metadata).to_vec());
    encoder.encode(frame.bytes(), frame.width, frame.height, ColorType::Rgb8).map_err(|e| failed(e.into()))
}

#[cfg(test)]
mod tests {
    use crate::Format;
    use crate::testing::assert_lossless;
    use darkroot_colour::RgbSpace;
    use darkroot_photo::PictureSpace;

    #[test]
    fn the_samples_come_back() {
        assert_lossless(Format::Webp, 8, PictureSpace::Rgb(RgbSpace::DISPLAY_P3));
    }
}
