//! The part of the frame that a person chose in the camera by an aspect ratio: raw files keep all of the frame, and makers' notes
//! say which part the camera showed (numbers as ExifTool documents them).

use darkroot_photo::{Rect, metadata::tag};

use super::{below_olympus, directory, is_olympus, notes};
use crate::dng_extras;
use crate::tiff::{Directories, Directory};

/// Canon's AspectInfo: a ratio, then width, height, left and top.
const CANON: u16 = 0x009a;
/// Olympus' ImageProcessing, and in it AspectFrame: left, top, and the last column and row.
const OLYMPUS_PROCESSING: u16 = 0x2040;
const OLYMPUS_FRAME: u16 = 0x1113;

/// The part of the maker's picture that was chosen: as a DNG says it, or as the maker's note does in the maker's own file.
pub(crate) fn user_crop(tiff: &Directories<'_>, is_dng: bool, shown: Rect) -> Option<Rect> {
    if is_dng { dng_extras::user_crop(tiff, shown) } else { chosen(tiff, shown) }
}

/// What of the maker's picture was chosen; `None` where that is all of it, or nothing plausible.
fn chosen(tiff: &Directories<'_>, shown: Rect) -> Option<Rect> {
    let image = tiff.all.first()?;
    let make = image.entries.iter().find(|entry| entry.tag == tag::MAKE)?;
    let make = String::from_utf8_lossy(tiff.value(make, 64)?).to_lowercase();
    let [left, top, width, height] = notes(tiff).iter().find_map(|note| {
        let (tiff, directory) = directory(note, &make)?;
        match make.as_str() {
            make if make.starts_with("canon") => canon(&tiff, &directory),
            make if is_olympus(make) => olympus(&tiff, &directory),
            _ => None,
        }
    })?;
    let fits = |from: usize, length: usize, whole: usize| {
        length > 0 && from.checked_add(length).is_some_and(|end| end <= whole)
    };
    // A ratio cuts two opposite sides; where more is gone, the numbers count in another picture.
    let is_whole = |length: usize, whole: usize| whole - length <= SLACK;
    let rect = Rect { x: shown.x + left, y: shown.y + top, width, height };
    let plausible = fits(left, width, shown.width)
        && fits(top, height, shown.height)
        && (is_whole(width, shown.width) || is_whole(height, shown.height))
        && !(is_whole(width, shown.width) && is_whole(height, shown.height));
    plausible.then_some(rect)
}

/// Pixels by which the side that stays may be shorter than the maker's picture.
const SLACK: usize = 32;

fn canon(tiff: &Directories<'_>, directory: &Directory) -> Option<[usize; 4]> {
    let entry = directory.entries.iter().find(|entry| entry.tag == CANON)?;
    let [_, width, height, left, top] = tiff.longs(tiff.value(entry, 20)?)[..] else { return None };
    Some([left, top, width, height].map(|v| v as usize))
}

fn olympus(tiff: &Directories<'_>, directory: &Directory) -> Option<[usize; 4]> {
    let processing = below_olympus(tiff, directory, OLYMPUS_PROCESSING)?;
    let entry = processing.entries.iter().find(|entry| entry.tag == OLYMPUS_FRAME && entry.kind == 3)?;
    let [left, top, right, bottom] = tiff.shorts(tiff.value(entry, 8)?)[..] else { return None };
    let side =
        |from: u16, last: u16| usize::from(last).checked_sub(usize::from(from)).map(|length| length + 1);
    Some([usize::from(left), usize::from(top), side(left, right)?, side(top, bottom)?])
}

#[cfg(test)]
mod tests {
    use super::super::tests::{directory, file, longs};
    use super::*;

    const SHOWN: Rect = Rect { x: 8, y: 12, width: 5184, height: 3456 };

    fn cut(bytes: &[u8], shown: Rect) -> Option<Rect> {
        user_crop(&Directories::walk(bytes).unwrap().unwrap(), false, shown)
    }

    fn canon(numbers: [u32; 5]) -> Vec<u8> {
        file("Canon", |at| directory(at, &[(CANON, 4, 5, &longs(&numbers))]))
    }

    #[test]
    fn canon_says_what_was_chosen() {
        let square = Rect { x: 8 + 864, y: 12, width: 3456, height: 3456 };
        assert_eq!(cut(&canon([1, 3456, 3456, 864, 0]), SHOWN), Some(square));
        let wide = Rect { x: 8, y: 12 + 270, width: 5184, height: 2916 };
        assert_eq!(cut(&canon([7, 5184, 2916, 0, 270]), SHOWN), Some(wide));
        for nothing in [
            [0, 5184, 3456, 0, 0],    // All of it.
            [0, 0, 0, 0, 0],          // Nothing is known.
            [1, 3456, 3456, 1800, 0], // Beyond the picture.
            [7, 2592, 1458, 0, 135],  // Of a smaller picture.
            [7, u32::MAX, 2, u32::MAX, 0],
        ] {
            assert_eq!(cut(&canon(nothing), SHOWN), None, "{nothing:?}");
        }
    }

    #[test]
    fn olympus_says_the_last_column_and_row() {
        let note = |frame: [u16; 4]| {
            let frame: Vec<u8> = frame.iter().flat_map(|v| v.to_le_bytes()).collect();
            file("OLYMPUS IMAGING CORP.", move |_| {
                let head = b"OLYMPUS\0II\x03\0";
                // Offsets count from the beginning of the note.
                let below_at = 12 + 2 + 12 + 4;
                let own = directory(12, &[(OLYMPUS_PROCESSING, 4, 1, &longs(&[below_at as u32]))]);
                [&head[..], &own, &directory(below_at, &[(OLYMPUS_FRAME, 3, 4, &frame)])].concat()
            })
        };
        let shown = Rect { x: 0, y: 0, width: 4608, height: 3456 };
        let wide = Rect { x: 0, y: 432, width: 4608, height: 2592 };
        assert_eq!(cut(&note([0, 432, 4607, 3023]), shown), Some(wide));
        assert_eq!(cut(&note([0, 0, 4607, 3455]), shown), None);
        assert_eq!(cut(&note([0, 3000, 4607, 100]), shown), None);
    }

    #[test]
    fn other_makers_and_converted_files_are_left() {
        let other =
            file("NIKON CORPORATION", |at| directory(at, &[(CANON, 4, 5, &longs(&[1, 3456, 3456, 864, 0]))]));
        assert_eq!(cut(&other, SHOWN), None);
        let tiff = canon([1, 3456, 3456, 864, 0]);
        assert_eq!(user_crop(&Directories::walk(&tiff).unwrap().unwrap(), true, SHOWN), None);
    }
}
