//! The directories of a TIFF-based raw file, walked within bounds.
//!
//! Only what the screen and a few facts need: which tags there are, and small integer values. Decoders read the
//! rest themselves.

use std::collections::HashSet;

use crate::{Damage, Error};

/// Tags whose values point to further directories.
const SUB_IFDS: u16 = 0x014a;
pub(crate) const EXIF_IFD: u16 = 0x8769;
pub(crate) const GPS_IFD: u16 = 0x8825;

/// No real raw file has more directories than this (bursts in one DNG have a few dozen).
const MAX_DIRECTORIES: usize = 512;
/// No real directory has more entries than this.
const MAX_ENTRIES: usize = 4096;
/// Directories inside directories: image, sub-image, Exif, interoperability.
const MAX_DEPTH: usize = 8;

/// One entry of a directory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) tag: u16,
    pub(crate) kind: u16,
    pub(crate) count: u64,
    /// Where the value stands in the file.
    offset: usize,
}

/// One directory (IFD).
#[derive(Debug, Clone, Default)]
pub(crate) struct Directory {
    pub(crate) entries: Vec<Entry>,
}

impl Entry {
    /// Where the value stands in the file.
    pub(crate) fn place(&self) -> usize {
        self.offset
    }
}

impl Directory {
    /// The first entry with this tag.
    pub(crate) fn entry(&self, tag: u16) -> Option<&Entry> {
        self.entries.iter().find(|e| e.tag == tag)
    }

    /// The first integer of the entry with this tag.
    pub(crate) fn number(&self, tiff: &Directories<'_>, tag: u16) -> Option<u64> {
        tiff.integers(self.entry(tag)?, 1).first().copied()
    }
}

/// All directories of a file, in the order met.
#[derive(Debug, Clone)]
pub(crate) struct Directories<'a> {
    bytes: &'a [u8],
    little_endian: bool,
    big: bool,
    pub(crate) all: Vec<Directory>,
}

impl<'a> Directories<'a> {
    /// Walks the directories of a TIFF structure; `None` when the bytes have no TIFF header.
    ///
    /// # Errors
    /// [`Error::Damaged`] when directories point at themselves or each other, are nested too deep or too many.
    pub(crate) fn walk(bytes: &'a [u8]) -> Result<Option<Self>, Error> {
        let (little_endian, big) = match bytes.get(..4) {
            // Besides TIFF's 42 and BigTIFF's 43: Olympus (RO, RS) and Panasonic (U).
            Some([b'I', b'I', 42, 0] | [b'I', b'I', b'R', b'O' | b'S'] | [b'I', b'I', b'U', 0]) => {
                (true, false)
            }
            Some([b'M', b'M', 0, 42] | [b'M', b'M', b'O', b'R']) => (false, false),
            Some([b'I', b'I', 43, 0]) => (true, true),
            Some([b'M', b'M', 0, 43]) => (false, true),
            _ => return Ok(None),
        };
        let mut walked = Self { bytes, little_endian, big, all: Vec::new() };
        let first = if big { walked.word(8) } else { walked.word(4) };
        if let Some(first) = first {
            let mut seen = HashSet::new();
            walked.chain(first, 0, &mut seen)?;
        }
        Ok(Some(walked))
    }

    /// One directory of bytes that have no header, and nothing below it.
    pub(crate) fn one(bytes: &'a [u8], little_endian: bool, at: usize) -> Option<(Self, Directory)> {
        let alone = Self { bytes, little_endian, big: false, all: Vec::new() };
        let directory = alone.directory_at(at)?;
        Some((alone, directory))
    }

    /// The directory at a place of the file.
    pub(crate) fn directory_at(&self, at: usize) -> Option<Directory> {
        self.directory(at as u64).ok().flatten().map(|(directory, _)| directory)
    }

    /// Follows a chain of directories from `offset`.
    fn chain(&mut self, mut offset: u64, depth: usize, seen: &mut HashSet<u64>) -> Result<(), Error> {
        while offset != 0 {
            if depth > MAX_DEPTH {
                return Err(Damage::DeepDirectories.into());
            }
            if !seen.insert(offset) {
                return Err(Damage::CircularDirectories.into());
            }
            if self.all.len() >= MAX_DIRECTORIES {
                return Err(Damage::ManyDirectories.into());
            }
            let Some((directory, next)) = self.directory(offset)? else {
                // A chain that runs out of the file is common in truncated files and harmless in some whole
                // ones; the decoder decides.
                return Ok(());
            };
            let children: Vec<u64> = directory
                .entries
                .iter()
                .filter(|e| matches!(e.tag, SUB_IFDS | EXIF_IFD | GPS_IFD))
                .flat_map(|e| self.integers(e, MAX_DIRECTORIES))
                .collect();
            self.all.push(directory);
            for child in children {
                self.chain(child, depth + 1, seen)?;
            }
            offset = next;
        }
        Ok(())
    }

    /// The directory at `offset` and the offset of the next; `None` when it does not lie in the file.
    fn directory(&self, offset: u64) -> Result<Option<(Directory, u64)>, Error> {
        let Ok(start) = usize::try_from(offset) else { return Ok(None) };
        let (head, size, inline) = if self.big { (8, 20, 8) } else { (2, 12, 4) };
        let count = if self.big { self.long8(start) } else { self.short(start).map(u64::from) };
        let Some(count) = count.and_then(|c| usize::try_from(c).ok()) else { return Ok(None) };
        if count > MAX_ENTRIES {
            return Err(Damage::ManyEntries.into());
        }
        let mut entries = Vec::with_capacity(count);
        for i in 0..count {
            let at = start + head + i * size;
            let (Some(tag), Some(kind), Some(n)) = (
                self.short(at),
                self.short(at + 2),
                if self.big { self.long8(at + 4) } else { self.long(at + 4).map(u64::from) },
            ) else {
                return Ok(None);
            };
            let value_at = at + 4 + inline;
            let length = n.saturating_mul(size_of_kind(kind));
            let offset = if length <= inline as u64 {
                Some(value_at)
            } else {
                self.word(value_at).and_then(|o| usize::try_from(o).ok())
            };
            if let Some(offset) = offset {
                entries.push(Entry { tag, kind, count: n, offset });
            }
        }
        let next = self.word(start + head + count * size).unwrap_or(0);
        Ok(Some((Directory { entries }, next)))
    }

    /// The first `limit` integers of an entry; fewer when the file ends before.
    pub(crate) fn integers(&self, entry: &Entry, limit: usize) -> Vec<u64> {
        let size = size_of_kind(entry.kind) as usize;
        (0..entry.count.min(limit as u64) as usize)
            .map_while(|i| {
                let at = entry.offset.checked_add(i * size)?;
                match entry.kind {
                    1 | 7 => self.bytes.get(at).map(|&b| u64::from(b)),
                    3 => self.short(at).map(u64::from),
                    4 | 13 => self.long(at).map(u64::from),
                    16 | 18 => self.long8(at),
                    _ => None,
                }
            })
            .collect()
    }

    /// The directory that an entry of another points to, as Exif and GPS have it.
    pub(crate) fn below(&self, directory: &Directory, tag: u16) -> Option<Directory> {
        let offset = directory.number(self, tag)?;
        self.directory(offset).ok().flatten().map(|(directory, _)| directory)
    }

    /// The bytes of an entry's value; `None` when there are more than `limit` or they do not lie in the file.
    pub(crate) fn value(&self, entry: &Entry, limit: usize) -> Option<&'a [u8]> {
        let length = usize::try_from(entry.count.checked_mul(size_of_kind(entry.kind))?).ok()?;
        if length > limit {
            return None;
        }
        self.bytes.get(entry.offset..entry.offset.checked_add(length)?)
    }

    /// Numbers of 16 bits in the byte order of the file.
    pub(crate) fn shorts(&self, bytes: &[u8]) -> Vec<u16> {
        let read = if self.little_endian { u16::from_le_bytes } else { u16::from_be_bytes };
        bytes.as_chunks().0.iter().map(|&b| read(b)).collect()
    }

    /// Numbers of 32 bits in the byte order of the file.
    pub(crate) fn longs(&self, bytes: &[u8]) -> Vec<u32> {
        let read = if self.little_endian { u32::from_le_bytes } else { u32::from_be_bytes };
        bytes.as_chunks().0.iter().map(|&b| read(b)).collect()
    }

    /// Where the single bytes of the first entry with this tag stand in the file; empty for other types.
    pub(crate) fn byte_positions(&self, tag: u16) -> std::ops::Range<usize> {
        let entry =
            self.all.iter().flat_map(|d| &d.entries).find(|e| e.tag == tag && matches!(e.kind, 1 | 7));
        entry.map_or(0..0, |e| {
            let end = e.offset.saturating_add(e.count.min(MAX_ENTRIES as u64) as usize);
            e.offset.min(self.bytes.len())..end.min(self.bytes.len())
        })
    }

    /// Puts a number in place of the first of every entry with this tag, in a copy of the file.
    pub(crate) fn overwrite(&self, tag: u16, number: u16, copy: &mut [u8]) {
        for entry in self.all.iter().flat_map(|d| &d.entries).filter(|e| e.tag == tag) {
            let size = size_of_kind(entry.kind).min(4) as usize;
            let long = if self.little_endian {
                u32::from(number).to_le_bytes()
            } else {
                (u32::from(number) << (8 * (4 - size))).to_be_bytes()
            };
            if let Some(place) = copy.get_mut(entry.offset..entry.offset.saturating_add(size)) {
                place.copy_from_slice(&long[..size]);
            }
        }
    }

    /// Whether its numbers begin with their lowest byte.
    pub(crate) fn is_little_endian(&self) -> bool {
        self.little_endian
    }

    /// The whole file.
    pub(crate) fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Whether any directory has the tag.
    pub(crate) fn has(&self, tag: u16) -> bool {
        self.all.iter().any(|d| d.entry(tag).is_some())
    }

    fn array<const N: usize>(&self, at: usize) -> Option<[u8; N]> {
        self.bytes.get(at..at.checked_add(N)?)?.try_into().ok()
    }

    fn short(&self, at: usize) -> Option<u16> {
        let b = self.array(at)?;
        Some(if self.little_endian { u16::from_le_bytes(b) } else { u16::from_be_bytes(b) })
    }

    fn long(&self, at: usize) -> Option<u32> {
        let b = self.array(at)?;
        Some(if self.little_endian { u32::from_le_bytes(b) } else { u32::from_be_bytes(b) })
    }

    fn long8(&self, at: usize) -> Option<u64> {
        let b = self.array(at)?;
        Some(if self.little_endian { u64::from_le_bytes(b) } else { u64::from_be_bytes(b) })
    }

    /// An offset in the size of this kind of TIFF.
    fn word(&self, at: usize) -> Option<u64> {
        if self.big { self.long8(at) } else { self.long(at).map(u64::from) }
    }
}

/// Bytes of one value of a TIFF field type; 1 for unknown types.
fn size_of_kind(kind: u16) -> u64 {
    match kind {
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => 1,
    }
}
