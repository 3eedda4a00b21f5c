//! A small picture inside of Exif, for programs that list files (Exif 2.32, 4.5.5). It is made of the bands as they come; a
//! place is left for it before, and filled at the end.

use std::io::{Seek, Write};
use std::sync::{Mutex, PoisonError};

use darkroot_colour::RgbSpace;
use darkroot_photo::{PictureSpace, Size};

use super::header::{END, Header};
use super::units::{Scan, Subsampling};
use crate::format::same_colours;
use crate::output::fill;
use crate::{ChromaSubsampling, Error};

/// Pixels of its longest side.
const LONGEST: usize = 160;
/// Pixels of the picture that are looked at along the side of one of the thumbnail, about.
const LOOKS: usize = 4;
/// Bytes of its place.
const PLACE: usize = 8 << 10;
/// Tried until it fits.
const QUALITIES: [u8; 4] = [80, 60, 40, 15];
/// What its place begins with until it is filled.
const MARK: &[u8] = b"darkroot: place of a thumbnail\0";

/// A thumbnail that is being made.
pub(super) struct Thumbnail {
    size: Size,
    /// Pixels of the picture along the side of one, and from one that is looked at to the next.
    side: usize,
    step: usize,
    sums: Mutex<Vec<u32>>,
}

impl Thumbnail {
    /// For a picture of a size; `None` where it would have no use: for one that is small itself, and for other colours than
    /// those of sRGB, which thumbnails have.
    pub(super) fn of(size: Size, space: &PictureSpace) -> Option<Self> {
        let is_srgb = matches!(space, PictureSpace::Rgb(space) if same_colours(space, &RgbSpace::SRGB));
        let side = size.width.max(size.height).div_ceil(LONGEST);
        let small = Size { width: size.width / side, height: size.height / side };
        (is_srgb && side > 1 && small.area() > 0).then(|| Self {
            size: small,
            side,
            step: side.div_ceil(LOOKS),
            sums: Mutex::new(vec![0; 3 * small.area()]),
        })
    }

    /// Takes a band, whose first row is that of the picture, and whose rows have so many pixels. Bands come in any order.
    pub(super) fn add(&self, first: usize, width: usize, samples: &[u8]) {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        for (y, row) in (first..self.size.height * self.side).zip(samples.chunks_exact(3 * width)) {
            if !(y % self.side).is_multiple_of(self.step) {
                continue;
            }
            let sums = &mut sums[3 * self.size.width * (y / self.side)..][..3 * self.size.width];
            for (sum, cell) in sums.chunks_exact_mut(3).zip(row.chunks_exact(3 * self.side)) {
                for pixel in cell.chunks_exact(3).step_by(self.step) {
                    for (sum, &v) in sum.iter_mut().zip(pixel) {
                        *sum += u32::from(v);
                    }
                }
            }
        }
    }

    /// What is written in its place until it is there.
    pub(super) fn place() -> Vec<u8> {
        let mut place = MARK.to_vec();
        place.resize(PLACE, 0);
        place
    }

    /// The file of it; `None` if it does not fit at any quality.
    fn jpeg(&self) -> Option<Vec<u8>> {
        let looks = self.side.div_ceil(self.step).pow(2) as u32;
        let sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        let samples: Vec<u8> = sums.iter().map(|sum| ((sum + looks / 2) / looks) as u8).collect();
        let subsampling = Subsampling::of(ChromaSubsampling::S420);
        let of_quality = |quality| {
            let nothing: &[u8] = &[];
            let header = Header {
                size: self.size,
                subsampling,
                quality,
                restart: 0,
                profile: nothing,
                exif: nothing,
                xmp: nothing,
                iptc: nothing,
                more: &[],
            };
            let scan = Scan::new(subsampling, quality).encode(&samples, self.size.width);
            [header.bytes(), scan, END.to_vec()].concat()
        };
        QUALITIES.into_iter().map(of_quality).find(|jpeg| jpeg.len() <= PLACE)
    }

    /// Fills its place in a file whose `header` stands at `start`, and goes back to where the file ends.
    pub(super) fn fill(&self, header: &[u8], start: u64, out: &mut (impl Write + Seek)) -> Result<(), Error> {
        let find = |what: &[u8]| header.windows(what.len()).position(|window| window == what);
        // The length, as Exif has it: tag 0x0202, one number of 32 bits.
        let length = [&[2, 2, 4, 0, 1, 0, 0, 0][..], &(PLACE as u32).to_le_bytes()].concat();
        let places = (find(MARK), find(&length));
        let (Some(jpeg), (Some(place), Some(length))) = (self.jpeg(), places) else { return Ok(()) };
        let number = (jpeg.len() as u32).to_le_bytes();
        fill(out, &[(start + place as u64, &jpeg), (start + length as u64 + 8, &number)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{decoded, metadata};
    use crate::{Format, Options};
    use darkroot_photo::{Picture, Samples};
    use exif::{In, Tag};

    /// Left half red, right half grey, 1000 x 700.
    fn picture(space: RgbSpace) -> Picture {
        let size = Size { width: 1000, height: 700 };
        let pixel = |i: usize| if i % size.width < 500 { [200, 30, 30] } else { [128; 3] };
        let samples = Samples::U8((0..size.area()).flat_map(pixel).collect());
        Picture { size, samples, space: PictureSpace::Rgb(space) }
    }

    fn file(picture: &Picture, options: &Options) -> Vec<u8> {
        let mut file = std::io::Cursor::new(b"before".to_vec());
        file.set_position(6);
        crate::write(picture, Format::Jpeg, options, &metadata(), &mut file).unwrap();
        file.into_inner().split_off(6)
    }

    /// The thumbnail of a file, as a reader of Exif finds it.
    fn thumbnail(file: &[u8]) -> Option<Vec<u8>> {
        let exif = exif::Reader::new().read_from_container(&mut std::io::Cursor::new(file)).unwrap();
        let number = |tag| exif.get_field(tag, In::THUMBNAIL)?.value.get_uint(0);
        assert_eq!(number(Tag::Compression).unwrap_or(6), 6);
        let start = number(Tag::JPEGInterchangeFormat)? as usize;
        Some(exif.buf()[start..][..number(Tag::JPEGInterchangeFormatLength)? as usize].to_vec())
    }

    #[test]
    fn a_thumbnail_shows_the_picture() {
        let picture = picture(RgbSpace::SRGB);
        for progressive in [false, true] {
            let options = Options { thumbnail: true, progressive, ..Options::default() };
            let file = file(&picture, &options);
            let (size, samples) = decoded(Format::Jpeg, &thumbnail(&file).unwrap());
            assert_eq!(size, Size { width: 142, height: 100 });
            let Samples::U8(samples) = samples else { panic!("8 bits") };
            let at = |x: usize, y: usize| &samples[3 * (y * 142 + x)..][..3];
            for (x, wanted) in [(20, [200, 30, 30]), (120, [128; 3])] {
                for y in [5, 50, 95] {
                    let near = at(x, y).iter().zip(wanted).all(|(a, b)| a.abs_diff(b) < 6);
                    assert!(near, "{x}, {y}: {:?}", at(x, y));
                }
            }
            // The picture itself is what it is without one.
            let without = self::file(&picture, &Options { thumbnail: false, ..options });
            assert!(decoded(Format::Jpeg, &file).1 == decoded(Format::Jpeg, &without).1);
        }
    }

    #[test]
    fn there_is_none_unasked_and_of_other_colours() {
        let asked = Options { thumbnail: true, ..Options::default() };
        assert_eq!(thumbnail(&file(&picture(RgbSpace::SRGB), &Options::default())), None);
        assert_eq!(thumbnail(&file(&picture(RgbSpace::ADOBE_RGB), &asked)), None);
    }

    #[test]
    fn the_most_restless_picture_fits_its_place() {
        let mut picture = picture(RgbSpace::SRGB);
        let mut state = 1u32;
        let Samples::U8(samples) = &mut picture.samples else { panic!("8 bits") };
        for block in samples.chunks_mut(3 * 7) {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            block.fill((state >> 24) as u8);
        }
        let file = file(&picture, &Options { thumbnail: true, ..Options::default() });
        assert!(thumbnail(&file).unwrap().len() <= PLACE);
    }
}
