//! The sections of a Fujifilm RAF, as ExifTool documents them: a JPEG with Exif, records about the raw picture, and a TIFF structure
//! with what development needs. Numbers of the file itself have their highest byte first.

use crate::exif;
use crate::nikon_note::MAKER_NOTE;
use crate::tiff::{Directories, Directory, EXIF_IFD};

/// Where the places and lengths of the sections stand.
const JPEG: usize = 84;
const RECORDS: usize = 92;
const RAW: usize = 100;

/// No real file has more records.
const MOST_RECORDS: u32 = 255;

/// The directory with what development needs.
const DEVELOPMENT: u16 = 0xf000;

/// A RAF file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raf<'a> {
    bytes: &'a [u8],
}

impl<'a> Raf<'a> {
    /// `None` for any other file.
    pub(crate) fn of(bytes: &'a [u8]) -> Option<Self> {
        bytes.starts_with(b"FUJIFILMCCD-RAW").then_some(Self { bytes })
    }

    fn long(self, at: usize) -> Option<u32> {
        Some(u32::from_be_bytes(self.bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
    }

    fn section(self, at: usize) -> Option<&'a [u8]> {
        let (start, length) = (self.long(at)? as usize, self.long(at + 4)? as usize);
        self.bytes.get(start..start.checked_add(length)?)
    }

    /// The numbers of 16 bits of a record.
    pub(crate) fn record(self, wanted: u16) -> Option<Vec<u16>> {
        let records = self.section(RECORDS)?;
        let count = u32::from_be_bytes(records.get(..4)?.try_into().ok()?);
        let mut at = 4;
        for _ in 0..count.min(MOST_RECORDS) {
            let short = |at: usize| Some(u16::from_be_bytes(records.get(at..at + 2)?.try_into().ok()?));
            let (number, length) = (short(at)?, usize::from(short(at + 2)?));
            let value = records.get(at + 4..at + 4 + length)?;
            if number == wanted {
                return Some(value.as_chunks().0.iter().map(|&two| u16::from_be_bytes(two)).collect());
            }
            at += 4 + length;
        }
        None
    }

    /// The structure with what development needs, and its directory.
    pub(crate) fn development(self) -> Option<(Directories<'a>, Directory)> {
        let tiff = Directories::walk(self.section(RAW)?).ok().flatten()?;
        let directory = tiff.below(tiff.all.first()?, DEVELOPMENT)?;
        Some((tiff, directory))
    }

    /// Fujifilm's note, whose offsets count from its beginning.
    pub(crate) fn note(self) -> Option<(Directories<'a>, Directory)> {
        let tiff = Directories::walk(exif::exif_of_jpeg(self.section(JPEG)?)?).ok().flatten()?;
        let exif = tiff.below(tiff.all.first()?, EXIF_IFD)?;
        let entry = exif.entry(MAKER_NOTE)?;
        let note = tiff.value(entry, usize::MAX).filter(|note| note.starts_with(b"FUJIFILM"))?;
        let at = u32::from_le_bytes(note.get(8..12)?.try_into().ok()?) as usize;
        Directories::one(note, true, at)
    }
}
