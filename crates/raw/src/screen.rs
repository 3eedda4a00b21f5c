//! The first look at a file: is it a raw container at all, and is it safe to hand to a decoder?

use crate::tiff::Directories;
use crate::{Error, Limits, pieces};

/// What the screen learnt of a file's container.
#[derive(Debug)]
pub(crate) struct Container<'a> {
    /// The directories when it is TIFF-based (NEF, DNG, CR2, ARW, PEF, ORF, RW2, ...).
    pub(crate) tiff: Option<Directories<'a>>,
}

/// DNG's own tags begin with DNGVersion.
pub(crate) const DNG_VERSION: u16 = 0xc612;
/// DNG WhiteLevel.
pub(crate) const WHITE_LEVEL: u16 = 0xc61d;
/// DNG LinearizationTable.
pub(crate) const LINEARIZATION_TABLE: u16 = 0xc618;

/// Refuses what is no raw file, and TIFF structures that would send a careless decoder round in circles or make it ask
/// for gigabytes.
pub(crate) fn screen<'a>(bytes: &'a [u8], limits: &Limits) -> Result<Container<'a>, Error> {
    if let Some(found) = known_other(bytes) {
        return Err(Error::NotRaw { found });
    }
    let tiff = Directories::walk(bytes)?;
    if let Some(tiff) = &tiff {
        pieces::check(tiff, limits)?;
    }
    Ok(Container { tiff })
}

/// Names common files that are no raw photographs, by their first bytes.
fn known_other(bytes: &[u8]) -> Option<&'static str> {
    let brand = bytes.get(8..12);
    Some(match bytes {
        [] => "it is empty",
        [0xff, 0xd8, 0xff, ..] => "it is a JPEG picture",
        [0x89, b'P', b'N', b'G', ..] => "it is a PNG picture",
        [b'G', b'I', b'F', b'8', ..] => "it is a GIF picture",
        [b'%', b'P', b'D', b'F', ..] => "it is a PDF document",
        [b'P', b'K', 3, 4, ..] => "it is a ZIP archive",
        [b'8', b'B', b'P', b'S', ..] => "it is a Photoshop document",
        [0x76, 0x2f, 0x31, 0x01, ..] => "it is an OpenEXR picture",
        [b'R', b'I', b'F', b'F', ..] if brand == Some(b"WEBP") => "it is a WebP picture",
        [_, _, _, _, b'f', b't', b'y', b'p', ..] if brand != Some(b"crx ") => "it is a video or HEIF picture",
        [b'<', ..] => "it is a text document",
        _ => return None,
    })
}
