//! Nikon's Z cameras, in a note of the raw picture's directory (ExifTool: NEFInfo, and in it DistortionInfo and VignetteInfo). The
//! tag DistortInfo of the main note has a switch and no numbers.

use super::Read;
use crate::nikon_note;
use crate::tiff::Directories;

const NEF_INFO: u16 = 0xc7d5;
const DISTORTION: u16 = 0x0005;
const VIGNETTING: u16 = 0x0006;
/// Where the first coefficients of each stand, fractions of four bytes each.
pub(super) const IN_DISTORTION: usize = 0x14;
pub(super) const IN_VIGNETTING: usize = 0x24;

pub(super) fn said(tiff: &Directories<'_>) -> Read {
    let note = tiff.all.iter().find_map(|directory| directory.entry(NEF_INFO));
    let note = note.and_then(|entry| tiff.value(entry, usize::MAX)).and_then(nikon_note::inside);
    let Some(note) = note else { return Ok(None) };
    let has = |number: u16, at: usize| {
        let value =
            note.all.first().and_then(|first| first.entry(number)).and_then(|e| note.value(e, 1 << 10));
        value.and_then(|value| value.get(at..at + 4)).is_some_and(|above| above.iter().any(|byte| *byte != 0))
    };
    let what = match (has(DISTORTION, IN_DISTORTION), has(VIGNETTING, IN_VIGNETTING)) {
        (false, false) => return Ok(None),
        (true, false) => "distortion",
        (false, true) => "vignetting",
        (true, true) => "distortion and vignetting",
    };
    Err(format!("in which order its numbers on {what} count, and with which scale, is not known"))
}
