//! Fields of a shot as entries of a TIFF file's directories, for TIFF and DNG.

use std::io::{Seek, Write};

use darkroot_photo::Metadata;
use darkroot_photo::metadata::{Directory, Value, tag};
use tiff::decoder::ifd::Entry;
use tiff::encoder::{DirectoryEncoder, TiffEncoder, TiffKind};
use tiff::tags::{Tag, Type};
use tiff::{Directory as Entries, TiffError, TiffResult};

use crate::exif;

/// What stands in the file begins at even places (TIFF 6.0, section 2).
pub(crate) const EVEN: usize = 2;

/// What points at the directories of Exif and GPS.
pub(crate) const EXIF_DIRECTORY: u16 = 0x8769;
const GPS_DIRECTORY: u16 = 0x8825;

/// Writes the fields of the shot that have directories of their own; what points at each, and where it is.
pub(crate) fn shot_directories<W: Write + Seek, K: TiffKind>(
    file: &mut TiffEncoder<W, K>,
    metadata: &Metadata,
) -> TiffResult<Vec<(u16, K::OffsetType)>> {
    let mut pointers = Vec::new();
    for (directory, pointer) in [(Directory::Exif, EXIF_DIRECTORY), (Directory::Gps, GPS_DIRECTORY)] {
        if exif::fields(metadata).any(|field| field.directory == directory) {
            let mut entries = file.extra_directory()?;
            write_fields(&mut entries, metadata, directory)?;
            pointers.push((pointer, entries.finish_with_offsets()?.offset));
        }
    }
    Ok(pointers)
}

/// Writes the fields of a directory.
pub(crate) fn write_fields<W: Write + Seek, K: TiffKind>(
    entries: &mut DirectoryEncoder<'_, W, K>,
    metadata: &Metadata,
    directory: Directory,
) -> Result<(), TiffError> {
    for field in exif::fields(metadata).filter(|field| field.directory == directory) {
        let (kind, bytes) = match &field.value {
            Value::Text(text) => (Type::ASCII, closed(text)),
            Value::Bytes(v) => (Type::BYTE, v.clone()),
            Value::Undefined(v) => (Type::UNDEFINED, v.clone()),
            Value::Shorts(v) => (Type::SHORT, v.iter().flat_map(|n| n.to_ne_bytes()).collect()),
            Value::Longs(v) => (Type::LONG, v.iter().flat_map(|n| n.to_ne_bytes()).collect()),
            Value::Rationals(v) => {
                (Type::RATIONAL, v.iter().flat_map(|&(n, d)| [n, d]).flat_map(u32::to_ne_bytes).collect())
            }
            Value::SignedRationals(v) => {
                (Type::SRATIONAL, v.iter().flat_map(|&(n, d)| [n, d]).flat_map(i32::to_ne_bytes).collect())
            }
        };
        let (kind, bytes) = match (field.directory, field.tag) {
            (Directory::Image, tag::IPTC) => as_longs(bytes),
            _ => (kind, bytes),
        };
        write_bytes(entries, field.tag, kind, &bytes)?;
    }
    Ok(())
}

/// A block of IPTC as Adobe and those after it store it: as if it were numbers of 32 bits.
fn as_longs(mut block: Vec<u8>) -> (Type, Vec<u8>) {
    block.resize(block.len().next_multiple_of(size_of::<u32>()), 0);
    (Type::LONG, block)
}

/// Writes a value in the byte order of the machine, which is that of the file.
pub(crate) fn write_bytes<W: Write + Seek, K: TiffKind>(
    entries: &mut DirectoryEncoder<'_, W, K>,
    tag: u16,
    kind: Type,
    bytes: &[u8],
) -> Result<(), TiffError> {
    let entry: Entry = entries.write_entry_bytes(kind, bytes)?;
    if bytes.len() > size_of::<K::OffsetType>() && !bytes.len().is_multiple_of(EVEN) {
        entries.write_data(&[0_u8][..])?;
    }
    entries.extend_from(&Entries::from_iter([(Tag::from_u16_exhaustive(tag), entry)]));
    Ok(())
}

/// Text with its closing zero.
pub(crate) fn closed(text: &str) -> Vec<u8> {
    text.bytes().chain([0]).collect()
}
