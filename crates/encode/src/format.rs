//! The formats, and what each can hold.

use std::fmt;

use darkroot_colour::{RgbSpace, TransferCurve};
use darkroot_photo::{Picture, PictureSpace, Samples, Size};

use crate::{Error, Options};

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// JPEG (JFIF), baseline.
    Jpeg,
    /// Portable Network Graphics.
    Png,
    /// TIFF 6.0; BigTIFF where the file would not fit in 4 GB.
    Tiff,
    /// WebP, lossless.
    Webp,
    /// AV1 Image File Format.
    Avif,
    /// OpenEXR.
    Exr,
    /// JPEG XL, lossless.
    Jxl,
    /// Digital Negative: linear camera RGB for other raw developers.
    Dng,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 8] =
        [Self::Jpeg, Self::Png, Self::Tiff, Self::Webp, Self::Avif, Self::Exr, Self::Jxl, Self::Dng];

    /// The format that files with this extension have (without the dot, in any case); `None` when it is not one
    /// of jpg, jpeg, jpe, png, tif, tiff, webp, avif, exr, jxl and dng.
    pub fn from_extension(ext: &str) -> Option<Self> {
        match ext.to_ascii_lowercase().as_str() {
            "jpg" | "jpeg" | "jpe" => Some(Self::Jpeg),
            "png" => Some(Self::Png),
            "tif" | "tiff" => Some(Self::Tiff),
            "webp" => Some(Self::Webp),
            "avif" => Some(Self::Avif),
            "exr" => Some(Self::Exr),
            "jxl" => Some(Self::Jxl),
            "dng" => Some(Self::Dng),
            _ => None,
        }
    }

    /// The usual extension, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Jpeg => "jpg",
            Self::Png => "png",
            Self::Tiff => "tif",
            Self::Webp => "webp",
            Self::Avif => "avif",
            Self::Exr => "exr",
            Self::Jxl => "jxl",
            Self::Dng => "dng",
        }
    }

    /// Name as people write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Jpeg => "JPEG",
            Self::Png => "PNG",
            Self::Tiff => "TIFF",
            Self::Webp => "WebP",
            Self::Avif => "AVIF",
            Self::Exr => "OpenEXR",
            Self::Jxl => "JPEG XL",
            Self::Dng => "DNG",
        }
    }

    /// Bits that a sample may have, in rising order: 8 and 16 are integers, 32 is floating point.
    pub fn bits(self) -> &'static [u8] {
        match self {
            Self::Jpeg | Self::Webp | Self::Avif => &[8],
            Self::Png | Self::Jxl => &[8, 16],
            Self::Tiff => &[8, 16, 32],
            Self::Exr => &[32],
            Self::Dng => &[16],
        }
    }

    /// Bits a sample where nobody asks for others: 16 in TIFF, as it is for further work, else the fewest.
    pub fn default_bits(self) -> u8 {
        match self {
            Self::Tiff | Self::Dng => 16,
            Self::Exr => 32,
            Self::Jpeg | Self::Png | Self::Webp | Self::Avif | Self::Jxl => 8,
        }
    }

    /// Bits that a sample of so many bits has in the file: AVIF codes 8 bits in 10, so that its rounding adds none.
    pub fn stored_bits(self, bits: u8) -> u8 {
        if self == Self::Avif { 10 } else { bits }
    }

    /// Largest width and height in pixels.
    pub fn largest_side(self) -> usize {
        match self {
            Self::Jpeg | Self::Avif | Self::Dng => 65_535,
            Self::Webp => 16_383,
            Self::Png | Self::Exr | Self::Tiff => i32::MAX as usize,
            Self::Jxl => (1 << 30) - 1,
        }
    }

    /// Width and height of a picture of that size and so many bits, if the format can hold it: both at least 1.
    pub(crate) fn sides(self, size: Size, bits: u8) -> Result<(u32, u32), Error> {
        if !self.bits().contains(&bits) {
            return Err(Error::Bits { format: self, bits });
        }
        if size.width == 0 || size.height == 0 {
            return Err(Error::Empty(size));
        }
        let limit = self.largest_side();
        match (u32::try_from(size.width), u32::try_from(size.height)) {
            (Ok(width), Ok(height)) if size.width <= limit && size.height <= limit => Ok((width, height)),
            _ => Err(Error::TooLarge { format: self, size, limit }),
        }
    }

    /// Whether a file of this format can be written while its picture is made: see
    /// [`write_in_bands`](crate::write_in_bands).
    pub fn takes_bands(self) -> bool {
        matches!(self, Self::Jpeg | Self::Png | Self::Tiff | Self::Dng)
    }

    /// Whether the format can hold a picture in that space and say so to whoever reads it.
    ///
    /// # Errors
    ///
    /// [`Error::Space`], whose message says why not and what to choose instead.
    pub fn accepts(self, space: &PictureSpace) -> Result<(), Error> {
        let refused = match (self, space) {
            (Self::Dng, PictureSpace::Raw) => None,
            (Self::Dng, _) => Some("it holds what the sensor saw; leave out the space, or choose TIFF"),
            (_, PictureSpace::Raw) => Some("it is no raw file; choose DNG"),
            (Self::Tiff, _) => None,
            (Self::Exr, PictureSpace::Rgb(rgb)) => (rgb.curve != TransferCurve::Linear)
                .then_some("its numbers are linear; choose the `-linear` variant of the space"),
            (Self::Exr, PictureSpace::Camera) => None,
            (_, PictureSpace::Camera) => {
                Some("it has no way to say what the numbers are; choose TIFF or OpenEXR")
            }
            (Self::Jxl, PictureSpace::Rgb(rgb)) => {
                matches!(rgb.curve, TransferCurve::Romm | TransferCurve::LStar).then_some(
                    "it has no name for the transfer curve; choose PNG or TIFF, or another space such as Rec. 2020",
                )
            }
            (Self::Jpeg | Self::Png | Self::Webp | Self::Avif, PictureSpace::Rgb(_)) => None,
        };
        match refused {
            None => Ok(()),
            Some(instead) => Err(Error::Space { format: self, space: space.name(), instead }),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Whether two spaces mean the same by the same numbers, whatever they are called.
pub(crate) fn same_colours(a: &RgbSpace, b: &RgbSpace) -> bool {
    a.primaries == b.primaries && a.white == b.white && a.curve == b.curve
}

/// ICC profile of a space; empty when none can describe it.
pub(crate) fn profile_of(space: &PictureSpace) -> Vec<u8> {
    match space {
        PictureSpace::Rgb(space) => crate::icc::profile(space),
        PictureSpace::Camera | PictureSpace::Raw => Vec::new(),
    }
}

/// A picture that has been checked against the format: it has pixels, as many samples as they need, and no more
/// of them a side than the format allows.
pub(crate) struct Frame<'a> {
    /// Pixels in a row, at least 1.
    pub(crate) width: u32,
    /// Number of rows, at least 1.
    pub(crate) height: u32,
    /// `3 * width * height` samples.
    pub(crate) samples: &'a Samples,
    /// What the samples mean; the format accepts it.
    pub(crate) space: &'a PictureSpace,
}

impl<'a> Frame<'a> {
    /// Checks `picture` against `format`, all but its space.
    pub(crate) fn of(picture: &'a Picture, format: Format, options: &Options) -> Result<Self, Error> {
        let Picture { size, samples, space } = picture;
        let is_absolute = format == Format::Avif && options.peak.is_some() && samples.bits() == 32;
        let bits = if is_absolute { format.default_bits() } else { samples.bits() };
        let (width, height) = format.sides(*size, bits)?;
        let count = match samples {
            Samples::U8(v) => v.len(),
            Samples::U16(v) => v.len(),
            Samples::F32(v) => v.len(),
        };
        if size.width.checked_mul(size.height).and_then(|area| area.checked_mul(3)) != Some(count) {
            return Err(Error::SampleCount { size: *size, samples: count });
        }
        Ok(Self { width, height, samples, space })
    }

    /// ICC profile of the picture; empty when none can describe it.
    pub(crate) fn profile(&self) -> Vec<u8> {
        profile_of(self.space)
    }

    /// Samples of a row.
    pub(crate) fn row(&self) -> usize {
        3 * self.width as usize
    }

    /// The samples of 8 bits; none in a format that has no others, as the bits were checked.
    pub(crate) fn bytes(&self) -> &'a [u8] {
        match self.samples {
            Samples::U8(v) => v,
            Samples::U16(_) | Samples::F32(_) => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{encoded, picture, picture_for, spaces};
    use darkroot_photo::Metadata;

    const SRGB: PictureSpace = PictureSpace::Rgb(RgbSpace::SRGB);

    #[test]
    fn every_extension_leads_to_its_format_in_any_case() {
        for format in Format::ALL {
            assert_eq!(Format::from_extension(format.extension()), Some(format));
        }
        for (extension, format) in [("JPEG", Format::Jpeg), ("jpe", Format::Jpeg), ("TIFF", Format::Tiff)] {
            assert_eq!(Format::from_extension(extension), Some(format));
        }
        assert_eq!(Format::from_extension("nef"), None);
        assert_eq!(Format::from_extension(".png"), None);
    }

    #[test]
    fn the_default_bits_are_among_those_allowed() {
        for format in Format::ALL {
            assert!(format.bits().contains(&format.default_bits()), "{format}");
        }
    }

    #[test]
    fn camera_rgb_goes_into_tiff_and_openexr_only() {
        for format in Format::ALL {
            let accepted = format.accepts(&PictureSpace::Camera).is_ok();
            assert_eq!(accepted, matches!(format, Format::Tiff | Format::Exr), "{format}");
            assert_eq!(format.accepts(&PictureSpace::Raw).is_ok(), format == Format::Dng, "{format}");
        }
    }

    #[test]
    fn formats_with_a_place_for_a_profile_take_every_space() {
        for space in spaces() {
            for format in [Format::Tiff, Format::Png, Format::Jpeg, Format::Webp, Format::Avif] {
                assert!(format.accepts(&PictureSpace::Rgb(space)).is_ok(), "{format} {}", space.name);
            }
        }
    }

    #[test]
    fn a_refusal_says_what_to_do() {
        let why = |format: Format, space: PictureSpace| format.accepts(&space).unwrap_err().to_string();
        assert_eq!(
            why(Format::Exr, PictureSpace::Rgb(RgbSpace::PROPHOTO)),
            "OpenEXR cannot hold a picture in ProPhoto RGB: its numbers are linear; choose the `-linear` \
             variant of the space"
        );
        assert!(why(Format::Jpeg, PictureSpace::Camera).ends_with("choose TIFF or OpenEXR"));
        assert!(why(Format::Jxl, PictureSpace::Rgb(RgbSpace::ECIRGB_V2)).contains("transfer curve"));
    }

    #[test]
    fn a_space_by_another_name_is_the_same_space() {
        let space = RgbSpace { name: "IEC 61966-2-1", ..RgbSpace::SRGB };
        assert!(same_colours(&space, &RgbSpace::SRGB) && !same_colours(&space, &RgbSpace::REC2020));
    }

    #[test]
    fn bits_that_the_format_lacks_are_refused() {
        for format in Format::ALL {
            for bits in [8, 16, 32].into_iter().filter(|bits| !format.bits().contains(bits)) {
                let space = picture_for(format, 1, 1).space;
                let picture = picture(2, 2, bits, space);
                match encoded(&picture, format, &Metadata::default()) {
                    Err(Error::Bits { .. }) => {}
                    other => panic!("{format} {bits}: {other:?}"),
                }
            }
        }
        let picture = picture(2, 2, 32, SRGB);
        let why = encoded(&picture, Format::Png, &Metadata::default()).unwrap_err().to_string();
        assert_eq!(why, "PNG has no samples of 32 bits: choose 8 or 16");
    }

    #[test]
    fn a_picture_that_is_too_wide_is_refused() {
        for (format, width) in [(Format::Jpeg, 65_536), (Format::Webp, 16_384), (Format::Avif, 65_536)] {
            let picture = picture(width, 1, 8, SRGB);
            let refused = encoded(&picture, format, &Metadata::default());
            assert!(matches!(refused, Err(Error::TooLarge { .. })), "{format}");
        }
    }

    #[test]
    fn a_picture_without_pixels_is_refused() {
        for format in Format::ALL {
            let mut picture = picture_for(format, 1, 1);
            picture.size.height = 0;
            let refused = encoded(&picture, format, &Metadata::default());
            assert!(matches!(refused, Err(Error::Empty(_))), "{format}");
        }
    }

    #[test]
    fn a_picture_whose_samples_do_not_fill_it_is_refused() {
        for (width, height, fits) in [(3, 2, true), (2, 3, true), (usize::MAX, 2, false)] {
            let mut picture = picture_for(Format::Png, 2, 2);
            picture.size = Size { width, height };
            match encoded(&picture, Format::Png, &Metadata::default()) {
                Err(Error::SampleCount { .. }) => assert!(fits),
                Err(Error::TooLarge { .. }) => assert!(!fits),
                other => panic!("{width} x {height}: {other:?}"),
            }
        }
    }
}
