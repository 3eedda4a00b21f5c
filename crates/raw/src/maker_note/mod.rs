//! What makers say of lens and camera in notes of their own, where Exif has a place for it (numbers as ExifTool documents them).
//!
//! A note is a directory of the maker's own numbers. Where it begins, and what its offsets count from, differs from maker to
//! maker.

mod aspect;
pub(crate) use aspect::user_crop;
mod lens;
pub(crate) use lens::lens;

use darkroot_photo::metadata::{Directory as Place, Metadata, Value, tag};

use crate::nikon_note::{self, MAKER_NOTE};
use crate::tiff::{Directories, Directory, EXIF_IFD};

/// DNG: what converters keep of the file that they converted.
const PRIVATE_DATA: u16 = 0xc634;

/// Serial number of the camera, and of the lens.
const BODY: u16 = tag::SERIAL_NUMBERS[0];
const LENS: u16 = tag::SERIAL_NUMBERS[1];

/// A note in the file: the bytes that its offsets count in, their order, and where it begins.
struct Note<'a> {
    bytes: &'a [u8],
    little_endian: bool,
    start: usize,
}

/// Adds what the note tells and the standard's fields do not.
pub(crate) fn complete(metadata: &mut Metadata, tiff: &Directories<'_>) {
    let Some(make) = metadata.text(Place::Image, tag::MAKE).map(str::to_lowercase) else { return };
    let known: Vec<(u16, Value)> =
        notes(tiff).iter().filter_map(|note| fields(note, &make)).flatten().collect();
    for (number, value) in known {
        if metadata.get(Place::Exif, number).is_none() {
            metadata.set(Place::Exif, number, value);
        }
    }
}

/// The notes of a file: in Exif, and in what a converter kept.
fn notes<'a>(tiff: &Directories<'a>) -> Vec<Note<'a>> {
    let Some(image) = tiff.all.first() else { return Vec::new() };
    let exif = tiff.below(image, EXIF_IFD).unwrap_or_default();
    let entry = exif.entry(MAKER_NOTE);
    let own = entry.map(|entry| Note {
        bytes: tiff.bytes(),
        little_endian: tiff.is_little_endian(),
        start: entry.place(),
    });
    let kept = image.entry(PRIVATE_DATA).and_then(|entry| {
        let data = tiff.value(entry, usize::MAX)?;
        kept_note(tiff.bytes(), entry.place(), data)
    });
    own.into_iter().chain(kept).collect()
}

/// The note among Adobe's private data (DNG 1.7, DNGPrivateData, and Adobe's "MakN"): "Adobe", a zero, then blocks of a name,
/// a length and bytes. That of the note begins with the order of bytes and the place where it stood in the file before, from
/// whose beginning its offsets count.
fn kept_note<'a>(file: &'a [u8], place: usize, data: &[u8]) -> Option<Note<'a>> {
    const HEAD: usize = 6;
    /// No real file has more.
    const BLOCKS: usize = 64;
    let mut at = HEAD;
    data.starts_with(b"Adobe\0").then_some(())?;
    for _ in 0..BLOCKS {
        let name = data.get(at..at + 4)?;
        let number = |at: usize| Some(u32::from_be_bytes(data.get(at..at + 4)?.try_into().ok()?) as usize);
        let length = number(at + 4)?;
        if name == b"MakN" {
            let stood_at = number(at + 10)?;
            let stands_at = place + at + 14;
            return Some(Note {
                // Without the bytes before it, offsets lead to where they led.
                bytes: file.get(stands_at.checked_sub(stood_at)?..)?,
                little_endian: data.get(at + 8..at + 10)? == b"II",
                start: stood_at,
            });
        }
        at = at.checked_add(8)?.checked_add(length)?.checked_next_multiple_of(2)?;
    }
    None
}

/// The directory of a maker's note, and what its offsets count in.
fn directory<'a>(note: &Note<'a>, make: &str) -> Option<(Directories<'a>, Directory)> {
    let head = note.bytes.get(note.start..)?;
    let within = |base: usize, little_endian, at| {
        Directories::one(note.bytes.get(note.start + base..)?, little_endian, at)
    };
    // Offsets that count from the beginning of the file.
    let of_file = |from_start: usize| {
        Directories::one(note.bytes, note.little_endian, note.start.checked_add(from_start)?)
    };
    let order = |at: usize| head.get(at..at + 2).map(|order| order == b"II");
    match make {
        make if make.starts_with("nikon") && head.starts_with(b"Nikon\0") => {
            let tiff = nikon_note::inside(head)?;
            let first = tiff.all.first()?.clone();
            Some((tiff, first))
        }
        make if is_olympus(make) => {
            if head.starts_with(b"OLYMPUS\0") {
                within(0, order(8)?, 12)
            } else if head.starts_with(b"OM SYSTEM\0") {
                within(0, order(12)?, 16)
            } else {
                of_file(8)
            }
        }
        make if make.starts_with("panasonic") => {
            if head.starts_with(b"Panasonic\0") {
                of_file(12)
            } else {
                None
            }
        }
        make if make.starts_with("sony") => of_file(if head.starts_with(b"SONY ") { 12 } else { 0 }),
        make if make.starts_with("canon") || make.starts_with("nikon") => of_file(0),
        _ => None,
    }
}

/// The maker that the file names, in small letters.
fn maker(tiff: &Directories<'_>) -> Option<String> {
    let make = tiff.all.first()?.entry(tag::MAKE)?;
    Some(String::from_utf8_lossy(tiff.value(make, 64)?).to_lowercase())
}

fn is_olympus(make: &str) -> bool {
    make.starts_with("olympus") || make.starts_with("om digital")
}

/// What the note of a maker says, as fields of Exif.
fn fields(note: &Note<'_>, make: &str) -> Option<Vec<(u16, Value)>> {
    let (tiff, directory) = directory(note, make)?;
    let texts: &[(u16, u16)] = match make {
        make if make.starts_with("nikon") => return Some(nikon(&tiff, &directory)),
        make if is_olympus(make) => return Some(olympus(&tiff, &directory)),
        make if make.starts_with("panasonic") => &[(0x0051, tag::LENS_MODEL), (0x0052, LENS)],
        make if make.starts_with("sony") => &[(0x2031, BODY)],
        _ => &[(0x0095, tag::LENS_MODEL)],
    };
    let mut known = texts_of(&tiff, &directory, texts);
    if make.starts_with("canon") {
        // A number, shown with ten digits as it stands on the camera.
        let number = directory.number(&tiff, 0x000c).filter(|number| *number > 0);
        known.extend(number.map(|number| (BODY, Value::Text(format!("{number:010}")))));
    }
    Some(known)
}

fn nikon(tiff: &Directories<'_>, directory: &Directory) -> Vec<(u16, Value)> {
    let mut known = texts_of(tiff, directory, &[(0x001d, BODY)]);
    let lens = directory.entries.iter().find(|entry| entry.tag == 0x0084 && entry.kind == 5);
    let numbers = lens.and_then(|entry| tiff.value(entry, 32)).map(|bytes| tiff.longs(bytes));
    if let Some(&[a, b, c, d, e, f, g, h]) = numbers.as_deref() {
        let pairs = [(a, b), (c, d), (e, f), (g, h)];
        known.extend(lens_of_numbers(pairs).map(|name| (tag::LENS_MODEL, Value::Text(name))));
        if pairs.iter().all(|&(above, below)| above > 0 && below > 0) {
            known.push((tag::LENS_SPECIFICATION, Value::Rationals(pairs.to_vec())));
        }
    }
    known
}

/// The name that Nikon's newer cameras give a lens in Exif, of its least and greatest focal length, mm, and the f-numbers
/// there: "18.0-55.0 mm f/3.5-5.6".
fn lens_of_numbers(pairs: [(u32, u32); 4]) -> Option<String> {
    let [short, long, wide, narrow] = pairs.map(|(above, below)| f64::from(above) / f64::from(below));
    let sane = |v: f64, most: f64| v.is_finite() && v > 0.0 && v < most;
    if ![short, long].iter().all(|&v| sane(v, 3000.0)) || ![wide, narrow].iter().all(|&v| sane(v, 100.0)) {
        return None;
    }
    let range = |from: f64, to: f64| {
        if (to - from).abs() < 0.05 { format!("{from:.1}") } else { format!("{from:.1}-{to:.1}") }
    };
    Some(format!("{} mm f/{}", range(short, long), range(wide, narrow)))
}

/// The directory of the equipment lies below the note's.
fn olympus(tiff: &Directories<'_>, directory: &Directory) -> Vec<(u16, Value)> {
    const EQUIPMENT: u16 = 0x2010;
    let below = below_olympus(tiff, directory, EQUIPMENT);
    let wanted = [(0x0101, BODY), (0x0202, LENS), (0x0203, tag::LENS_MODEL)];
    below.map_or_else(Vec::new, |equipment| texts_of(tiff, &equipment, &wanted))
}

/// A directory below that of Olympus' note. In older cameras it is the value itself.
fn below_olympus(tiff: &Directories<'_>, directory: &Directory, number: u16) -> Option<Directory> {
    let entry = directory.entry(number)?;
    if entry.kind == 7 { tiff.directory_at(entry.place()) } else { tiff.below(directory, number) }
}

/// Texts of a note, as fields.
fn texts_of(tiff: &Directories<'_>, directory: &Directory, wanted: &[(u16, u16)]) -> Vec<(u16, Value)> {
    /// No real name or number is longer.
    const LONGEST: usize = 128;
    let one = |&(number, field): &(u16, u16)| {
        let entry = directory.entries.iter().find(|entry| entry.tag == number && entry.kind == 2)?;
        let text = tiff.value(entry, LONGEST)?.split(|&b| b == 0).next()?;
        let text = std::str::from_utf8(text).ok()?.trim();
        // Where nothing is known there are dashes, zeros or "N/A".
        let is_told = text.chars().any(|c| c.is_alphanumeric() && c != '0') && text != "N/A";
        let is_clean = !text.chars().any(char::is_control);
        (is_told && is_clean).then(|| (field, Value::Text(text.to_owned())))
    };
    wanted.iter().filter_map(one).collect()
}

#[cfg(test)]
mod tests;
