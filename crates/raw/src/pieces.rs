//! Strips and tiles: whether they can be what their directory says.
//!
//! Decoders believe what a piece says of itself. So a piece that is a JPEG or a JPEG XL must not be much larger than its place in
//! the picture, and no byte of a file may belong to two pieces: a hundred kilobytes would else become gigabytes.

use crate::tiff::{Directories, Directory};
use crate::{Damage, Error, Limits, TooLarge, jpeg_frame, jxl_frame};

pub(crate) mod tag {
    pub(crate) const NEW_SUBFILE_TYPE: u16 = 0x00fe;
    pub(crate) const IMAGE_WIDTH: u16 = 0x0100;
    pub(crate) const IMAGE_LENGTH: u16 = 0x0101;
    pub(crate) const BITS_PER_SAMPLE: u16 = 0x0102;
    pub(crate) const COMPRESSION: u16 = 0x0103;
    pub(crate) const STRIP_OFFSETS: u16 = 0x0111;
    pub(crate) const SAMPLES_PER_PIXEL: u16 = 0x0115;
    pub(crate) const ROWS_PER_STRIP: u16 = 0x0116;
    pub(crate) const STRIP_BYTE_COUNTS: u16 = 0x0117;
    pub(crate) const TILE_WIDTH: u16 = 0x0142;
    pub(crate) const TILE_LENGTH: u16 = 0x0143;
    pub(crate) const TILE_OFFSETS: u16 = 0x0144;
    pub(crate) const TILE_BYTE_COUNTS: u16 = 0x0145;
    pub(crate) const SAMPLE_FORMAT: u16 = 0x0153;
    pub(crate) const ROW_INTERLEAVE: u16 = 0xc71f;
    pub(crate) const COLUMN_INTERLEAVE: u16 = 0xcd43;
}

/// Strips or tiles, row by row; a strip is a tile as wide as the picture.
#[derive(Debug)]
pub(crate) struct Grid {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Offset and length of each.
    pub(crate) pieces: Vec<(usize, usize)>,
}

impl Grid {
    /// The strips or tiles of a picture; `None` where there are too few, or they have no size.
    pub(crate) fn of(
        tiff: &Directories<'_>,
        directory: &Directory,
        width: usize,
        height: usize,
    ) -> Option<Self> {
        let number = |tag| directory.number(tiff, tag).and_then(|n| usize::try_from(n).ok());
        let tile = number(tag::TILE_WIDTH).zip(number(tag::TILE_LENGTH));
        let strip = (width, number(tag::ROWS_PER_STRIP).unwrap_or(height).min(height));
        let (tile_width, tile_height) = tile.unwrap_or(strip);
        let pieces = pieces(tiff, directory);
        let wanted = width.div_ceil(tile_width.max(1)).saturating_mul(height.div_ceil(tile_height.max(1)));
        let whole = tile_width > 0 && tile_height > 0 && pieces.len() >= wanted;
        whole.then_some(Self { width: tile_width, height: tile_height, pieces })
    }

    /// The bytes of a strip or tile; `None` where they are not in the file.
    pub(crate) fn piece<'a>(&self, tiff: &Directories<'a>, i: usize) -> Option<&'a [u8]> {
        let &(offset, length) = self.pieces.get(i)?;
        tiff.bytes().get(offset..offset.checked_add(length)?)
    }
}

/// How many times more samples than its place a JPEG may hold: Canon's smaller raw files have six where the directory
/// counts one, and tiles reach beyond the picture.
const FRAME_SLACK: u64 = 8;
/// Samples that a JPEG may hold in any case.
const SMALL_FRAME: u64 = 1 << 16;
/// Samples that a byte of JPEG can hold where no size is stated: even a grey sky takes some bits for 64 pixels.
const SAMPLES_PER_BYTE: u64 = 256;

/// Refuses pictures in strips or tiles that overlap, or whose pieces are larger than their place. Reduced pictures are
/// not looked at: nobody decodes them here.
pub(crate) fn check(tiff: &Directories<'_>, limits: &Limits) -> Result<(), Error> {
    for directory in &tiff.all {
        let number = |tag| directory.number(tiff, tag);
        let reduced = number(tag::NEW_SUBFILE_TYPE).is_some_and(|kind| kind & 1 == 1);
        if !reduced {
            let pieces = pieces(tiff, directory);
            apart(&pieces)?;
            let place = place(tiff, directory);
            for &(offset, length) in &pieces {
                let end = offset.saturating_add(length).min(tiff.bytes().len());
                let Some(bytes) = tiff.bytes().get(offset..end) else { continue };
                frame_fits(bytes, place, limits)?;
            }
        }
    }
    Ok(())
}

/// Offset and length of each strip or tile.
fn pieces(tiff: &Directories<'_>, directory: &Directory) -> Vec<(usize, usize)> {
    let all = |tag| {
        let entry = directory.entry(tag);
        entry.map_or_else(Vec::new, |e| tiff.integers(e, usize::MAX))
    };
    let (mut offsets, mut lengths) = (all(tag::TILE_OFFSETS), all(tag::TILE_BYTE_COUNTS));
    if offsets.is_empty() {
        (offsets, lengths) = (all(tag::STRIP_OFFSETS), all(tag::STRIP_BYTE_COUNTS));
    }
    let size = |n: u64| usize::try_from(n).unwrap_or(usize::MAX);
    offsets.into_iter().zip(lengths).map(|(offset, length)| (size(offset), size(length))).collect()
}

/// No byte belongs to two pieces.
fn apart(pieces: &[(usize, usize)]) -> Result<(), Error> {
    let mut sorted: Vec<_> = pieces.iter().filter(|(_, length)| *length > 0).collect();
    sorted.sort_unstable();
    let overlap = sorted.windows(2).any(|pair| pair[0].0.saturating_add(pair[0].1) > pair[1].0);
    if overlap { Err(Damage::OverlappingPieces.into()) } else { Ok(()) }
}

/// Samples of the place of a strip or tile; `None` where the directory does not say.
fn place(tiff: &Directories<'_>, directory: &Directory) -> Option<u64> {
    let number = |tag| directory.number(tiff, tag);
    let planes = number(tag::SAMPLES_PER_PIXEL).unwrap_or(1);
    let (width, height) = match (number(tag::TILE_WIDTH), number(tag::TILE_LENGTH)) {
        (Some(width), Some(height)) => (width, height),
        _ => {
            let height = number(tag::IMAGE_LENGTH)?;
            (number(tag::IMAGE_WIDTH)?, number(tag::ROWS_PER_STRIP).map_or(height, |rows| rows.min(height)))
        }
    };
    Some(width.saturating_mul(height).saturating_mul(planes))
}

/// A piece that is a JPEG or a JPEG XL holds no more than its place has room for.
fn frame_fits(piece: &[u8], place: Option<u64>, limits: &Limits) -> Result<(), Error> {
    let stated = jpeg_frame::most_samples(piece).or_else(|| jxl_frame::most_samples(piece));
    let Some(samples) = stated else { return Ok(()) };
    let room = match place {
        Some(place) => place.saturating_mul(FRAME_SLACK),
        None => SAMPLES_PER_BYTE.saturating_mul(piece.len() as u64),
    };
    if samples > room.max(SMALL_FRAME) {
        return Err(Damage::LargeFrame.into());
    }
    if samples > limits.max_samples.saturating_mul(FRAME_SLACK) {
        return Err(Error::TooLarge(TooLarge::Samples(samples)));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_that_touch_are_apart_and_those_that_share_a_byte_are_not() {
        assert_eq!(apart(&[(10, 5), (0, 10), (15, 0), (15, 3)]), Ok(()));
        let overlapping = Err(Damage::OverlappingPieces.into());
        assert_eq!(apart(&[(10, 5), (0, 11)]), overlapping);
        assert_eq!(apart(&[(7, 1), (7, 1)]), overlapping);
        assert_eq!(apart(&[(0, usize::MAX), (9, usize::MAX)]), overlapping);
    }

    #[test]
    fn a_jpeg_may_be_somewhat_larger_than_its_place() {
        let limits = Limits::default();
        let jpeg = |w: u16, h: u16| {
            let mut jpeg = b"\xff\xd8\xff\xc3\0\x0b\x0e".to_vec();
            jpeg.extend([h.to_be_bytes(), w.to_be_bytes()].concat());
            jpeg.extend(b"\x01\0\x11\0");
            jpeg
        };
        assert_eq!(frame_fits(&jpeg(512, 512), Some(512 * 512), &limits), Ok(()));
        assert_eq!(frame_fits(&jpeg(1024, 512), Some(512 * 512), &limits), Ok(()));
        let large = Err(Damage::LargeFrame.into());
        assert_eq!(frame_fits(&jpeg(65_535, 65_535), Some(512 * 512), &limits), large);
        assert_eq!(frame_fits(&jpeg(65_535, 65_535), None, &limits), large);
        let whole = frame_fits(&jpeg(65_535, 65_535), Some(65_535 * 65_535), &limits);
        assert!(matches!(whole, Err(Error::TooLarge(_))), "{whole:?}");
    }
}
