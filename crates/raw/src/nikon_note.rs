//! What Nikon's note of type 3 says of the samples and of the camera's own JPEG (numbers as ExifTool documents them).

use crate::Error;
use crate::tiff::{Directories, EXIF_IFD};

pub(crate) const MAKER_NOTE: u16 = 0x927c;
/// "Nikon", a zero, a version: a TIFF structure of its own follows.
const HEAD: usize = 10;
/// 1 is sRGB, 2 Adobe RGB.
const COLOR_SPACE: u16 = 0x001e;
/// How the samples are compressed, in cameras until about 2018.
const COMPRESSION: u16 = 0x0093;
/// Facts of newer cameras; the compression stands at this byte.
const FACTS: u16 = 0x0051;
const COMPRESSION_IN_FACTS: usize = 10;

/// The note's directories; `None` where there is none.
fn note<'a>(tiff: &Directories<'a>) -> Option<Directories<'a>> {
    let exif = tiff.below(tiff.all.first()?, EXIF_IFD)?;
    inside(tiff.value(exif.entry(MAKER_NOTE)?, usize::MAX)?)
}

/// The directories inside of a note of this type; `None` for any other.
pub(crate) fn inside(note: &[u8]) -> Option<Directories<'_>> {
    let inside = note.starts_with(b"Nikon\0").then(|| note.get(HEAD..)).flatten()?;
    Directories::walk(inside).ok().flatten()
}

/// Number of the colour space of the camera's own JPEG: 1 is sRGB, 2 Adobe RGB.
pub(crate) fn colour_space(tiff: &Directories<'_>) -> Option<u64> {
    let note = note(tiff)?;
    note.all.first()?.number(&note, COLOR_SPACE)
}

/// Refuses High Efficiency, by what the camera itself says: its codec is secret, and read as anything else such samples are
/// no picture.
pub(crate) fn refuse_high_efficiency(tiff: &Directories<'_>) -> Result<(), Error> {
    let compressions = note(tiff).map(|note| compressions(&note)).unwrap_or_default();
    let name = compressions.into_iter().flatten().find_map(|number| match number {
        13 => Some("HE"),
        14 => Some("HE*"),
        _ => None,
    });
    match name {
        None => Ok(()),
        Some(name) => Err(Error::Compression {
            compression: format!("Nikon's High Efficiency ({name}), a secret codec"),
            decoder: "this program",
        }),
    }
}

/// What the two places of the note say, where they are.
fn compressions(note: &Directories<'_>) -> [Option<u64>; 2] {
    let Some(directory) = note.all.first() else { return [None; 2] };
    let facts = directory.entry(FACTS).and_then(|e| note.value(e, 1 << 16));
    let in_facts = facts.and_then(|f| f.get(COMPRESSION_IN_FACTS..COMPRESSION_IN_FACTS + 2));
    let in_facts = in_facts.and_then(|two| note.shorts(two).first().copied());
    [directory.number(note, COMPRESSION), in_facts.map(u64::from)]
}
