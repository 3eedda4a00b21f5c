//! AVIF: sRGB in 10 bits with full colour resolution, and Exif.
//!
//! The colours are named in the AV1 stream (primaries BT.709, curve sRGB, matrix BT.601, full range); there is
//! no ICC profile.

use std::io::Write;

use darkroot_photo::Metadata;
use ravif::{Encoder, Img, RGBA8};

use crate::format::Frame;
use crate::output::Buffered;
use crate::{Error, Format, Options, exif};

/// Number of threads, and of tiles that the picture is cut into. It is fixed, as the bytes depend on it.
const TILES: usize = 4;

pub(crate) fn write(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
) -> Result<(), Error> {
    // With opacity, which is dropped again: `encode_rgb` is compiled anew, with all of the encoder, in every crate that calls
    // it, which takes minutes.
    let pixels: Vec<RGBA8> =
        frame.bytes().chunks_exact(3).map(|p| RGBA8::new(p[0], p[1], p[2], 255)).collect();
    let mut encoder = Encoder::new()
        .with_quality(f32::from(options.quality))
        .with_speed(options.avif_speed)
        .with_num_threads(Some(TILES));
    let block = exif::block(metadata);
    if !block.is_empty() {
        encoder = encoder.with_exif(block);
    }
    let encoded = encoder
        .encode_rgba(Img::new(&pixels[..], frame.width as usize, frame.height as usize))
        .map_err(|e| Error::encoder(Format::Avif)(e.into()))?;
    out.write_all(&encoded.avif_file).map_err(Error::Io)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{SIZES, encoded, picture_for};

    #[test]
    fn the_file_names_its_kind_and_size() {
        for (width, height) in SIZES {
            let file = encoded(&picture_for(Format::Avif, width, height), Format::Avif, &Metadata::default());
            let file = file.unwrap();
            assert_eq!(&file[4..12], b"ftypavif");
            let at = file.windows(4).position(|w| w == b"ispe").unwrap() + 8;
            let side = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
            assert_eq!((side(at), side(at + 4)), (width, height));
        }
    }

    #[test]
    fn the_bytes_do_not_depend_on_the_number_of_threads() {
        let picture = picture_for(Format::Avif, 700, 600);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| encoded(&picture, Format::Avif, &Metadata::default()).unwrap())
        };
        assert!(with(1) == with(3));
    }
}
