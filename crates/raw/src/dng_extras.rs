//! What a DNG holds besides its samples and is not used here: said in words, so that nobody takes it for applied.

use std::collections::BTreeMap;

use darkroot_photo::Rect;

use crate::pieces::tag;
use crate::screen::DNG_VERSION;
use crate::tiff::Directories;

/// DNG SemanticName of a mask.
const SEMANTIC_NAME: u16 = 0xcd2e;
/// Longest name of a mask that is shown.
const MAX_NAME: usize = 64;

/// DNG RGBTables: a rendering that belongs to the maker's look.
const RGB_TABLES: u16 = 0xcd3f;

/// Notes on all of them.
pub(crate) fn notes(tiff: &Directories<'_>) -> Vec<String> {
    if !tiff.has(DNG_VERSION) {
        return Vec::new();
    }
    let mut notes = Vec::new();
    if tiff.has(RGB_TABLES) {
        notes.push(
            "the file's colour tables (RGBTables) belong to the maker's look and are not applied".to_owned(),
        );
    }
    let mut others: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for directory in &tiff.all {
        let Some(what) = directory.number(tiff, tag::NEW_SUBFILE_TYPE).and_then(kind) else { continue };
        let name = directory.entry(SEMANTIC_NAME);
        let name = name
            .and_then(|e| tiff.value(e, MAX_NAME))
            .map(|bytes| String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned());
        others.entry(what).or_default().extend(name);
    }
    notes.extend(others.into_iter().map(|(what, names)| match names.join(", ").as_str() {
        "" => format!("the file also holds {what}, which is not used"),
        names => format!("the file also holds {what} ({names}), which is not used"),
    }));
    notes
}

/// DNG DefaultUserCrop: top, left, bottom and right as shares of the default crop.
const USER_CROP: u16 = 0xc7b5;

/// The part of the default crop that the file says was chosen; `None` where it is all of it, or none.
pub(crate) fn user_crop(tiff: &Directories<'_>, shown: Rect) -> Option<Rect> {
    let entry = tiff.all.iter().flat_map(|d| &d.entries).find(|e| e.tag == USER_CROP)?;
    let numbers = tiff.longs(tiff.value(entry, 32)?);
    let shares: Vec<f64> = numbers.as_chunks().0.iter().map(|&[n, d]| f64::from(n) / f64::from(d)).collect();
    let [top, left, bottom, right] = shares[..] else { return None };
    let within = |from: f64, to: f64| from >= 0.0 && from < to && to <= 1.0;
    if !within(top, bottom) || !within(left, right) {
        return None;
    }
    let pixels = |share: f64, side: usize| (share * side as f64).round() as usize;
    let (x, y) = (pixels(left, shown.width), pixels(top, shown.height));
    let (width, height) = (pixels(right, shown.width) - x, pixels(bottom, shown.height) - y);
    let crop = Rect { x: shown.x + x, y: shown.y + y, width, height };
    (width > 0 && height > 0 && crop != shown).then_some(crop)
}

/// What a picture is besides the main one and previews (DNG 1.7, NewSubFileType).
fn kind(subfile: u64) -> Option<&'static str> {
    Some(match subfile {
        4 => "a transparency mask",
        8 => "a depth map",
        16 => "a picture enhanced by its writer",
        0x1_0004 => "semantic masks",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A DNG of two directories: the version with a local tone map, and one of this kind.
    fn dng(subfile: u32, name: &[u8; 4]) -> Vec<u8> {
        let entry = |tag: u16, kind: u16, count: u32, value: [u8; 4]| {
            [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value].concat()
        };
        let directory = |entries: &[Vec<u8>], next: u32| {
            [&(entries.len() as u16).to_le_bytes()[..], &entries.concat(), &next.to_le_bytes()].concat()
        };
        let first = [entry(DNG_VERSION, 1, 4, [1, 7, 1, 0]), entry(RGB_TABLES, 7, 4, [0; 4])];
        let second =
            [entry(tag::NEW_SUBFILE_TYPE, 4, 1, subfile.to_le_bytes()), entry(SEMANTIC_NAME, 2, 4, *name)];
        let first_length = 2 + 12 * first.len() as u32 + 4;
        [&b"II\x2a\0\x08\0\0\0"[..], &directory(&first, 8 + first_length), &directory(&second, 0)].concat()
    }

    #[test]
    fn masks_and_colour_tables_are_said() {
        let said = |subfile, name| notes(&Directories::walk(&dng(subfile, name)).unwrap().unwrap());
        let tone = "the file's colour tables (RGBTables) belong to the maker's look and are not applied";
        let mask = "the file also holds semantic masks (sky), which is not used";
        assert_eq!(said(0x1_0004, b"sky\0"), [tone, mask]);
        assert_eq!(said(8, b"\0\0\0\0"), [tone, "the file also holds a depth map, which is not used"]);
        assert_eq!(said(0, b"sky\0"), [tone]);
        assert_eq!(said(1, b"sky\0"), [tone]);
    }
}
