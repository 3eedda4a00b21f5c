use super::super::tests::{directory, file};
use super::nikon::{IN_DISTORTION, IN_VIGNETTING};
use super::*;
use crate::tiff::Directories;

fn said(bytes: &[u8]) -> (Option<MakerLens>, Vec<String>) {
    let mut notes = Vec::new();
    let tiff = Directories::walk(bytes).ok().flatten();
    let lens = lens(bytes, tiff.as_ref(), &mut notes);
    (lens, notes)
}

/// A file whose first directory has a maker and one entry more.
fn with_entry(make: &[u8], head: &[u8], (tag, kind, count, value): (u16, u16, u32, &[u8])) -> Vec<u8> {
    let make_entry = (0x010f, 2, make.len() as u32, make);
    let entries = if tag < 0x010f {
        [(tag, kind, count, value), make_entry]
    } else {
        [make_entry, (tag, kind, count, value)]
    };
    [head, &directory(8, &entries)].concat()
}

const TIFF: &[u8] = b"II\x2a\0\x08\0\0\0";

fn words(numbers: &[i16]) -> Vec<u8> {
    numbers.iter().flat_map(|v| v.to_le_bytes()).collect()
}

#[test]
fn nikon_s_coefficients_are_named_and_not_used() {
    let block = |coefficient: i32, at: usize, length: usize| {
        let mut bytes = vec![0; length];
        bytes[..4].copy_from_slice(b"0100");
        bytes[at..at + 4].copy_from_slice(&coefficient.to_le_bytes());
        bytes
    };
    let note = |distortion: i32, vignetting: i32| {
        let blocks = [block(distortion, IN_DISTORTION, 84), block(vignetting, IN_VIGNETTING, 116)];
        let inner = directory(8, &[(5, 7, 84, &blocks[0]), (6, 7, 116, &blocks[1])]);
        let note = [b"Nikon\0\x02\x11\0\0II\x2a\0\x08\0\0\0", &inner[..]].concat();
        with_entry(b"NIKON CORPORATION\0", TIFF, (0xc7d5, 7, note.len() as u32, &note))
    };
    for (file, what) in [
        (note(19097, -5), "distortion and vignetting"),
        (note(19097, 0), "distortion "),
        (note(0, 7), "vignetting "),
    ] {
        let (lens, notes) = said(&file);
        assert!(lens.is_none());
        assert!(
            notes.len() == 1 && notes[0].starts_with("Nikon's note") && notes[0].contains(what),
            "{notes:?}"
        );
    }
    assert_eq!(said(&note(0, 0)), (None, Vec::new()));
}

#[test]
fn panasonic_s_polynomial_is_named_where_it_is_on_and_not_used() {
    let file = |switch: i16, a: i16| {
        let mut numbers = [0i16; 16];
        (numbers[7], numbers[8], numbers[12]) = (switch, a, 2500);
        with_entry(b"Panasonic\0", b"IIU\0\x08\0\0\0", (0x0119, 7, 32, &words(&numbers)))
    };
    let (lens, notes) = said(&file(1, 3967));
    assert!(lens.is_none() && notes.len() == 1 && notes[0].starts_with("Panasonic's note"), "{notes:?}");
    for nothing in [file(0, 3967), file(1, 0)] {
        assert_eq!(said(&nothing), (None, Vec::new()));
    }
}

#[test]
fn sony_s_factors_are_those_of_its_knots() {
    let file = with_entry(b"SONY\0", TIFF, (0x7037, 8, 5, &words(&[4, 0, 164, 328, 492])));
    let (lens, notes) = said(&file);
    let lens = lens.unwrap();
    assert!(notes.is_empty() && lens.has_distortion() && !lens.has_fringes() && lens.gain.is_none());
    for (radius, v) in [(0.5 / 3.0, 0.0), (1.5 / 3.0, 164.0), (2.5 / 3.0, 328.0), (3.5 / 3.0, 492.0)] {
        assert!((lens.places[1].at(radius) - (1.0 + v / 16384.0)).abs() < 1e-4, "{radius}");
    }
    // Some say unsigned.
    let file = with_entry(b"SONY\0", TIFF, (0x7037, 3, 5, &words(&[4, 0, -164, -328, -492])));
    assert!((said(&file).0.unwrap().places[1].at(0.5) - (1.0 - 164.0 / 16384.0)).abs() < 1e-5);
}

#[test]
fn other_makers_say_nothing_and_no_piece_of_a_note_is_a_panic() {
    assert_eq!(
        said(&with_entry(b"Canon\0", TIFF, (0x7037, 8, 5, &words(&[4, 0, 164, 328, 492])))),
        (None, Vec::new())
    );
    let olympus = |_| {
        let below = 12 + 2 + 12 + 4;
        let own = directory(12, &[(0x2040, 4, 1, &(below as u32).to_le_bytes())]);
        let floats: Vec<u8> = [-0.1f32, 0.02, 0.0, 1.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        [b"OLYMPUS\0II\x03\0", &own[..], &directory(below, &[(0x150a, 11, 4, &floats)])].concat()
    };
    let whole = file("OLYMPUS IMAGING CORP.", olympus);
    let lens = said(&whole).0.unwrap();
    assert!((lens.places[1].at(1.0) - 0.92).abs() < 1e-5 && lens.maker == "Olympus");
    for length in 8..whole.len() {
        said(&whole[..length]);
    }
}
