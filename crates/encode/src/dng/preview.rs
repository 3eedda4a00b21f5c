//! Pictures to look at: a JPEG, and a small one that programs find which know nothing of raw files.

use std::io::{Cursor, Seek, Write};

use darkroot_photo::{Metadata, Picture, Samples, Size};
use tiff::TiffResult;
use tiff::encoder::{Rational, TiffEncoder, TiffKindStandard};
use tiff::tags::{PhotometricInterpretation, Tag, Type};

use super::{Entries, put, tag, value};
use crate::tiff_entries::{closed, write_bytes};
use crate::{Error, Format, Options};

/// Longest side of the small picture, pixels: what the DNG specification proposes.
const LONGEST: usize = 256;

/// The picture as a JPEG.
pub(super) fn jpeg(picture: &Picture) -> Result<Vec<u8>, Error> {
    let mut jpeg = Cursor::new(Vec::new());
    crate::write(picture, Format::Jpeg, &Options::default(), &Metadata::default(), &mut jpeg)?;
    Ok(jpeg.into_inner())
}

/// The directory of the JPEG; its offset.
pub(super) fn directory<W: Write + Seek>(
    file: &mut TiffEncoder<W, TiffKindStandard>,
    size: Size,
    jpeg: &[u8],
) -> TiffResult<u32> {
    // Luma from 0 to 255, colour differences around 128 (JFIF 1.02).
    const JFIF_RANGE: [u32; 6] = [0, 255, 128, 255, 128, 255];
    let mut entries = file.extra_directory()?;
    picture(&mut entries, size, value::JPEG, PhotometricInterpretation::YCbCr, jpeg)?;
    entries.write_tag(Tag::from_u16_exhaustive(530), &[1_u16, 1][..])?; // Every pixel has its own colour.
    entries.write_tag(Tag::from_u16_exhaustive(532), &JFIF_RANGE.map(|n| Rational { n, d: 1 })[..])?;
    Ok(entries.finish_with_offsets()?.offset)
}

/// The small picture, in the first directory; where there is none to look at, one black pixel, as that directory must show
/// something.
pub(super) fn thumbnail<W: Write + Seek>(
    entries: &mut Entries<'_, W>,
    preview: Option<&Picture>,
) -> TiffResult<()> {
    const UNCOMPRESSED: u16 = 1;
    let one_pixel = || (Size { width: 1, height: 1 }, vec![0; 3]);
    let (size, bytes) = preview.and_then(reduced).unwrap_or_else(one_pixel);
    picture(entries, size, UNCOMPRESSED, PhotometricInterpretation::RGB, &bytes)
}

/// A picture in one strip.
fn picture<W: Write + Seek>(
    entries: &mut Entries<'_, W>,
    size: Size,
    compression: u16,
    photometric: PhotometricInterpretation,
    bytes: &[u8],
) -> TiffResult<()> {
    const REDUCED: u32 = 1;
    const SRGB: u32 = 2;
    let even = [bytes, &[0][..bytes.len() % 2]].concat();
    let offset = entries.write_data(&even[..])?;
    entries.write_tag(Tag::NewSubfileType, REDUCED)?;
    entries.write_tag(Tag::ImageWidth, size.width as u32)?;
    entries.write_tag(Tag::ImageLength, size.height as u32)?;
    entries.write_tag(Tag::BitsPerSample, &[8_u16; 3][..])?;
    entries.write_tag(Tag::Compression, compression)?;
    entries.write_tag(Tag::PhotometricInterpretation, photometric.to_u16())?;
    entries.write_tag(Tag::SamplesPerPixel, 3_u16)?;
    entries.write_tag(Tag::PlanarConfiguration, 1_u16)?;
    entries.write_tag(Tag::RowsPerStrip, size.height as u32)?;
    entries.write_tag(Tag::StripOffsets, u32::try_from(offset)?)?;
    entries.write_tag(Tag::StripByteCounts, bytes.len() as u32)?;
    write_bytes(entries, tag::PREVIEW_APPLICATION, Type::ASCII, &closed("Darkroot"))?;
    put(entries, tag::PREVIEW_COLOR_SPACE, SRGB)
}

/// Means of squares of pixels, so that the longest side has [`LONGEST`] at most; `None` for anything but 8 bits.
fn reduced(picture: &Picture) -> Option<(Size, Vec<u8>)> {
    let Samples::U8(samples) = &picture.samples else { return None };
    let Size { width, height } = picture.size;
    let side = width.max(height).div_ceil(LONGEST).max(1);
    let size = Size { width: width.div_ceil(side), height: height.div_ceil(side) };
    let mut bytes = Vec::with_capacity(3 * size.area());
    for y in (0..height).step_by(side) {
        for x in (0..width).step_by(side) {
            let (right, bottom) = ((x + side).min(width), (y + side).min(height));
            let places = || (y..bottom).flat_map(move |y| (x..right).map(move |x| 3 * (y * width + x)));
            let count = (right - x) * (bottom - y);
            bytes.extend((0..3).map(|c| {
                let sum: usize = places().map(|at| usize::from(samples[at + c])).sum();
                ((sum + count / 2) / count) as u8
            }));
        }
    }
    Some((size, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::picture;
    use darkroot_colour::RgbSpace;
    use darkroot_photo::PictureSpace;

    #[test]
    fn the_small_picture_is_no_longer_than_it_may_be() {
        for (width, height) in [(1, 1), (256, 170), (257, 200), (1500, 1000), (999, 1501)] {
            let whole = picture(width, height, 8, PictureSpace::Rgb(RgbSpace::SRGB));
            let (size, bytes) = reduced(&whole).unwrap();
            assert!(size.width.max(size.height) <= LONGEST, "{size:?}");
            assert_eq!(bytes.len(), 3 * size.area());
        }
        let grey = Picture {
            samples: Samples::U8(vec![77; 3 * 700 * 300]),
            ..picture(700, 300, 8, PictureSpace::Camera)
        };
        assert!(reduced(&grey).unwrap().1.iter().all(|v| *v == 77));
    }
}
