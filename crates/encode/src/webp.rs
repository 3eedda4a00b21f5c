//! WebP: lossless, with the profile in ICCP and Exif in EXIF. The lossy kind would need a library in C.

use darkroot_photo::Metadata;
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::format::Frame;
use crate::output::Buffered;
use crate::{Error, Format, exif};

pub(crate) fn write(frame: &Frame<'_>, metadata: &Metadata, out: &mut Buffered<'_, '_>) -> Result<(), Error> {
    let failed = Error::encoder(Format::Webp);
    let mut encoder = WebPEncoder::new_lossless(out);
    encoder.set_icc_profile(frame.profile()).map_err(|e| failed(e.into()))?;
    encoder.set_exif_metadata(exif::block(metadata)).map_err(|e| failed(e.into()))?;
    encoder
        .write_image(frame.bytes(), frame.width, frame.height, ExtendedColorType::Rgb8)
        .map_err(|e| failed(e.into()))
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
