//! Settings of the encoders.

use std::sync::Arc;

use crate::{Dng, Error, GainMap};

/// How JPEG stores the two colour differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ChromaSubsampling {
    /// 4:4:4, every pixel has its own colour.
    #[default]
    S444,
    /// 4:2:2, two pixels side by side share theirs.
    S422,
    /// 4:2:0, a square of four pixels shares its colour: the file is about a quarter smaller, fine coloured
    /// detail is softer.
    S420,
}

/// How TIFF stores its samples; every choice is lossless.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TiffCompression {
    /// As they are: largest and fastest, and any program reads it.
    None,
    /// Deflate (Adobe's tag 8), integers as differences to their left neighbour (predictor 2).
    #[default]
    Deflate,
}

/// What WebP keeps of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WebpKind {
    /// Every sample.
    #[default]
    Lossless,
    /// What the quality says, with half the colour resolution.
    Lossy,
}

/// Settings of the encoders. Each format takes note of its own only.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Quality of JPEG, AVIF and lossy WebP, 1 (smallest file) to 100 (best picture). The two scales are not the same: AVIF
    /// looks good at lower numbers.
    pub quality: u8,
    /// Colour resolution of JPEG.
    pub subsampling: ChromaSubsampling,
    /// Whether JPEG is progressive: some per cent smaller, seen early where it comes slowly; the whole picture is in memory.
    pub progressive: bool,
    /// Whether the Exif of a JPEG in sRGB has a thumbnail, where it has any Exif. The output is then written at places before
    /// its end, too.
    pub thumbnail: bool,
    /// Compression of TIFF.
    pub compression: TiffCompression,
    /// Kind of WebP.
    pub webp: WebpKind,
    /// How little time AVIF may take, 1 (smallest file) to 10 (fastest). On two cores a picture of 24 megapixels
    /// takes about 30 s at 8, 15 s at 9 and 9 s at 10, where its file is some 7 % larger.
    pub avif_speed: u8,
    /// Light of the largest samples of an AVIF, cd/m²: the picture is then floating-point linear light of Rec. 2020, and the
    /// file says absolute light (PQ).
    pub peak: Option<f64>,
    /// How much brighter a JPEG is on a screen with room above white.
    pub gain_map: Option<Arc<GainMap>>,
    /// What a DNG states beside its samples.
    pub dng: Arc<Dng>,
}

impl Default for Options {
    /// What suits a developed photograph: quality 92 with full colour resolution, deflated TIFF, fast AVIF.
    fn default() -> Self {
        Self {
            quality: 92,
            subsampling: ChromaSubsampling::default(),
            progressive: false,
            thumbnail: false,
            compression: TiffCompression::default(),
            webp: WebpKind::default(),
            avif_speed: 10,
            peak: None,
            gain_map: None,
            dng: Arc::default(),
        }
    }
}

impl Options {
    /// Refuses numbers out of range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match self {
            Self { quality: q, .. } if !(1..=100).contains(q) => Err(Error::Quality(*q)),
            Self { avif_speed: s, .. } if !(1..=10).contains(s) => Err(Error::Speed(*s)),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_in_range() {
        assert!(Options::default().check().is_ok());
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for quality in [0, 101] {
            let refused = Options { quality, ..Options::default() }.check();
            assert!(matches!(refused, Err(Error::Quality(q)) if q == quality));
        }
        for avif_speed in [0, 11] {
            let refused = Options { avif_speed, ..Options::default() }.check();
            assert!(matches!(refused, Err(Error::Speed(s)) if s == avif_speed));
        }
    }
}
