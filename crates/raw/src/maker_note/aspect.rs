//! The part of the frame that a person chose in the camera by an aspect ratio: raw files keep all of the frame, and makers' notes
//! say which part the camera showed (numbers as ExifTool documents them).

use darkroot_photo::Rect;

use super::{below_olympus, directory, is_olympus, maker, notes};
use crate::dng_extras;
use crate::raf::Raf;
use crate::tiff::{Directories, Directory, EXIF_IFD};

/// Canon's AspectInfo: a ratio, then width, height, left and top.
const CANON: u16 = 0x009a;
/// Olympus' ImageProcessing, and in it AspectFrame: left, top, and the last column and row.
const OLYMPUS_PROCESSING: u16 = 0x2040;
const OLYMPUS_FRAME: u16 = 0x1113;
/// Exif's size of the camera's picture, which Sony cuts from the middle.
const EXIF_SIZE: [u16; 2] = [0xa002, 0xa003];
/// Panasonic's CropLeft, CropTop, CropRight and CropBottom, in columns and rows of the frame.
const PANASONIC: [u16; 4] = [0x0030, 0x002f, 0x0032, 0x0031];
/// Fujifilm's RawImageAspectRatio, RawZoomActive, RawZoomTopLeft and RawZoomSize, each with the rows first.
const FUJIFILM_RATIO: u16 = 0x0115;
const FUJIFILM_ZOOM: [u16; 3] = [0x0117, 0x0118, 0x0119];

/// The part of the maker's picture that was chosen: as a DNG says it, or as the maker's note does in the maker's own file.
pub(crate) fn user_crop(
    bytes: &[u8],
    tiff: Option<&Directories<'_>>,
    is_dng: bool,
    shown: Rect,
) -> Option<Rect> {
    match (Raf::of(bytes), tiff) {
        (Some(raf), _) => fujifilm(raf, shown),
        (None, Some(tiff)) if is_dng => dng_extras::user_crop(tiff, shown),
        (None, Some(tiff)) => chosen(tiff, shown),
        (None, None) => None,
    }
}

/// What of the maker's picture was chosen; `None` where that is all of it, or nothing plausible.
fn chosen(tiff: &Directories<'_>, shown: Rect) -> Option<Rect> {
    let make = maker(tiff)?;
    let of_note = || {
        notes(tiff).iter().find_map(|note| {
            let (tiff, directory) = directory(note, &make)?;
            if is_olympus(&make) { olympus(&tiff, &directory) } else { canon(&tiff, &directory) }
        })
    };
    let [left, top, width, height] = match make.as_str() {
        make if make.starts_with("sony") => sony(tiff, shown)?,
        make if make.starts_with("panasonic") || make.starts_with("leica") => panasonic(tiff, shown)?,
        make if make.starts_with("canon") || is_olympus(make) => of_note()?,
        _ => return None,
    };
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
    let entry = directory.entry(CANON)?;
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

fn sony(tiff: &Directories<'_>, shown: Rect) -> Option<[usize; 4]> {
    let exif = tiff.below(tiff.all.first()?, EXIF_IFD)?;
    let [width, height] = EXIF_SIZE.map(|number| exif.number(tiff, number));
    let (width, height) = (usize::try_from(width?).ok()?, usize::try_from(height?).ok()?);
    let before = |length: usize, whole: usize| whole.checked_sub(length).map(|rest| rest / 2);
    Some([before(width, shown.width)?, before(height, shown.height)?, width, height])
}

fn panasonic(tiff: &Directories<'_>, shown: Rect) -> Option<[usize; 4]> {
    let numbers = PANASONIC.map(|number| tiff.all.first()?.number(tiff, number));
    let [Some(left), Some(top), Some(right), Some(bottom)] = numbers.map(|n| usize::try_from(n?).ok()) else {
        return None;
    };
    let (x, y) = (left.checked_sub(shown.x)?, top.checked_sub(shown.y)?);
    Some([x, y, right.checked_sub(left)?, bottom.checked_sub(top)?])
}

/// A digital zoom, and in it the largest middle part of a ratio.
fn fujifilm(raf: Raf<'_>, shown: Rect) -> Option<Rect> {
    let [active, place, size] = FUJIFILM_ZOOM.map(|number| raf.record(number));
    let is_active = active.is_some_and(|two| two.iter().any(|v| *v != 0));
    let zoom = match (place.as_deref(), size.as_deref()) {
        (Some(&[top, left]), Some(&[height, width])) if is_active => {
            let [x, y, width, height] = [left, top, width, height].map(usize::from);
            let part = Rect { x: shown.x + x, y: shown.y + y, width, height };
            let is_part =
                width > 0 && height > 0 && part.right() <= shown.right() && part.bottom() <= shown.bottom();
            is_part.then_some(part)
        }
        _ => None,
    };
    let whole = zoom.unwrap_or(shown);
    let of_ratio = |ratio: Vec<u16>| {
        let &[down, across] = &ratio[..] else { return None };
        let [down, across] = [down, across].map(usize::from);
        let plausible = down > 0 && across > 0 && down.max(across) <= 10 * down.min(across);
        let part = |side: usize, times: usize, over: usize| (side * times + over / 2) / over;
        plausible.then(|| {
            let width = whole.width.min(part(whole.height, across, down));
            let height = whole.height.min(part(whole.width, down, across));
            let (x, y) = (whole.x + (whole.width - width) / 2, whole.y + (whole.height - height) / 2);
            Rect { x, y, width, height }
        })
    };
    let cut = raf.record(FUJIFILM_RATIO).and_then(of_ratio).unwrap_or(whole);
    let is_less = |part: usize, whole: usize| whole - part > SLACK;
    (zoom.is_some() || is_less(cut.width, whole.width) || is_less(cut.height, whole.height)).then_some(cut)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{directory, file, longs};
    use super::*;
    use darkroot_photo::metadata::tag;

    const SHOWN: Rect = Rect { x: 8, y: 12, width: 5184, height: 3456 };

    fn cut(bytes: &[u8], shown: Rect) -> Option<Rect> {
        user_crop(bytes, Directories::walk(bytes).unwrap().as_ref(), false, shown)
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
    fn panasonic_says_the_edges_in_columns_and_rows_of_the_frame() {
        let file = |edges: [u16; 4]| {
            let [top, left, bottom, right] = edges.map(|v| v.to_le_bytes());
            let entries: [(u16, u16, u32, &[u8]); 5] = [
                (0x002f, 3, 1, &top),
                (0x0030, 3, 1, &left),
                (0x0031, 3, 1, &bottom),
                (0x0032, 3, 1, &right),
                (tag::MAKE, 2, 10, b"Panasonic\0"),
            ];
            [b"IIU\0\x08\0\0\0", &directory(8, &entries)[..]].concat()
        };
        let wide = Rect { x: 8, y: 12 + 270, width: 5184, height: 2916 };
        assert_eq!(cut(&file([282, 8, 3198, 5192]), SHOWN), Some(wide));
        for nothing in
            [[12, 8, 3468, 5192], [0; 4], [3198, 8, 282, 5192], [0, 0, 3456, 5184], [282, 8, 9000, 5192]]
        {
            assert_eq!(cut(&file(nothing), SHOWN), None, "{nothing:?}");
        }
    }

    #[test]
    fn other_makers_and_converted_files_are_left() {
        let other =
            file("NIKON CORPORATION", |at| directory(at, &[(CANON, 4, 5, &longs(&[1, 3456, 3456, 864, 0]))]));
        assert_eq!(cut(&other, SHOWN), None);
        let tiff = canon([1, 3456, 3456, 864, 0]);
        assert_eq!(user_crop(&tiff, Directories::walk(&tiff).unwrap().as_ref(), true, SHOWN), None);
    }
}
