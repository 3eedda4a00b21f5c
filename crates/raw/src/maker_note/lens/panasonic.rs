//! Panasonic and Leica, in the first directory of an RW2 (ExifTool: DistortionInfo, sixteen whole numbers).

use super::Read;
use crate::tiff::Directories;

const DISTORTION: u16 = 0x0119;
/// The switch, and the numbers of a polynomial.
const SWITCH: usize = 7;
const COEFFICIENTS: [usize; 3] = [8, 4, 11];

pub(super) fn said(tiff: &Directories<'_>) -> Read {
    let entry = tiff.all.first().and_then(|directory| directory.entry(DISTORTION));
    let numbers = entry.and_then(|entry| tiff.value(entry, 32)).map(|bytes| tiff.shorts(bytes));
    let Some(numbers) = numbers.filter(|numbers| numbers.len() == 16) else { return Ok(None) };
    let is_on = numbers[SWITCH] & 0xf != 0;
    if !is_on || COEFFICIENTS.iter().all(|&i| numbers[i] == 0) {
        return Ok(None);
    }
    Err("published readings of its numbers on distortion hold for some lenses and not for others".to_owned())
}
