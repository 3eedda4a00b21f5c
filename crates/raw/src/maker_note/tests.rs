use super::*;

/// A directory in little endian, its values after it, as it lies at `at`.
pub(super) fn directory(at: usize, entries: &[(u16, u16, u32, &[u8])]) -> Vec<u8> {
    let mut out = (entries.len() as u16).to_le_bytes().to_vec();
    let mut values = Vec::new();
    let values_at = at + 2 + 12 * entries.len() + 4;
    for (number, kind, count, value) in entries {
        out.extend([number.to_le_bytes(), kind.to_le_bytes()].concat());
        out.extend(count.to_le_bytes());
        if value.len() <= 4 {
            out.extend([value, &[0u8; 4][value.len()..]].concat());
        } else {
            out.extend(((values_at + values.len()) as u32).to_le_bytes());
            values.extend_from_slice(value);
        }
    }
    out.extend([0; 4]);
    out.extend(values);
    out
}

/// A TIFF structure with a maker and a note, whose offset is given to `note`.
pub(super) fn file(make: &str, note: impl Fn(usize) -> Vec<u8>) -> Vec<u8> {
    let make = [make.as_bytes(), &[0]].concat();
    let image_at = 8;
    let exif_at = image_at + 2 + 2 * 12 + 4 + make.len();
    let note_at = exif_at + 2 + 12 + 4;
    let note = note(note_at);
    let pointer = (exif_at as u32).to_le_bytes();
    let image = [(tag::MAKE, 2, make.len() as u32, &make[..]), (EXIF_IFD, 4, 1, &pointer[..])];
    let exif = [(MAKER_NOTE, 7, note.len() as u32, &note[..])];
    [&b"II\x2a\0\x08\0\0\0"[..], &directory(image_at, &image), &directory(exif_at, &exif)].concat()
}

fn told(bytes: &[u8], make: &str) -> Metadata {
    let tiff = Directories::walk(bytes).unwrap().unwrap();
    let mut metadata = Metadata::default();
    metadata.set(Place::Image, tag::MAKE, Value::Text(make.to_owned()));
    complete(&mut metadata, &tiff);
    metadata
}

/// Lens, serial numbers of camera and lens.
fn names(metadata: &Metadata) -> [Option<&str>; 3] {
    [tag::LENS_MODEL, BODY, LENS].map(|number| metadata.text(Place::Exif, number))
}

pub(super) fn longs(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

#[test]
fn canon_names_the_lens_and_numbers_the_camera() {
    let note =
        |at| directory(at, &[(0x000c, 4, 1, &longs(&[1_530_910_263])), (0x0095, 2, 12, b"EF50mm f/1.8")]);
    let metadata = told(&file("Canon", note), "Canon");
    assert_eq!(names(&metadata), [Some("EF50mm f/1.8"), Some("1530910263"), None]);
}

#[test]
fn nikon_s_note_is_a_structure_of_its_own() {
    let lens = longs(&[180, 10, 550, 10, 35, 10, 56, 10]);
    let inner = directory(8, &[(0x001d, 2, 8, b"6438342\0"), (0x0084, 5, 4, &lens)]);
    let note = [&b"Nikon\0\x02\x10\0\0II\x2a\0\x08\0\0\0"[..], &inner].concat();
    let metadata = told(&file("NIKON CORPORATION", |_| note.clone()), "NIKON CORPORATION");
    assert_eq!(names(&metadata), [Some("18.0-55.0 mm f/3.5-5.6"), Some("6438342"), None]);
    let specification = Value::Rationals(vec![(180, 10), (550, 10), (35, 10), (56, 10)]);
    assert_eq!(metadata.get(Place::Exif, tag::LENS_SPECIFICATION), Some(&specification));
    // The first ones had none.
    let old = |at| directory(at, &[(0x0084, 5, 4, &longs(&[20, 1, 20, 1, 28, 10, 28, 10]))]);
    assert_eq!(names(&told(&file("NIKON", old), "NIKON"))[0], Some("20.0 mm f/2.8"));
}

#[test]
fn olympus_has_the_lens_among_its_equipment() {
    let equipment = |at| {
        let texts: [(u16, u16, u32, &[u8]); 3] =
            [(0x0101, 2, 9, b"BHP123456"), (0x0202, 2, 9, b"ABC000123"), (0x0203, 2, 12, b"OLYMPUS M.12")];
        directory(at, &texts)
    };
    let below = 12 + 2 + 12 + 4;
    let pointer = longs(&[below as u32]);
    let note = [&b"OLYMPUS\0II\x03\0"[..], &directory(12, &[(0x2010, 13, 1, &pointer)]), &equipment(below)];
    let metadata = told(&file("OLYMPUS CORPORATION", |_| note.concat()), "OLYMPUS CORPORATION");
    assert_eq!(names(&metadata), [Some("OLYMPUS M.12"), Some("BHP123456"), Some("ABC000123")]);
}

#[test]
fn panasonic_names_the_lens_and_says_dashes_where_it_knows_nothing() {
    let note = |at: usize| {
        let texts: [(u16, u16, u32, &[u8]); 2] =
            [(0x0051, 2, 14, b"LUMIX G 20/F1."), (0x0052, 2, 14, b"--------------")];
        [&b"Panasonic\0\0\0"[..], &directory(at + 12, &texts)].concat()
    };
    assert_eq!(names(&told(&file("Panasonic", note), "Panasonic")), [Some("LUMIX G 20/F1."), None, None]);
}

#[test]
fn what_the_standard_s_fields_say_stays_and_no_piece_of_a_note_is_a_panic() {
    let note = |at| directory(at, &[(0x0095, 2, 12, b"EF50mm f/1.8")]);
    let whole = file("Canon", note);
    let tiff = Directories::walk(&whole).unwrap().unwrap();
    let mut metadata = Metadata::default();
    metadata.set(Place::Image, tag::MAKE, Value::Text("Canon".into()));
    metadata.set(Place::Exif, tag::LENS_MODEL, Value::Text("another".into()));
    complete(&mut metadata, &tiff);
    assert_eq!(names(&metadata)[0], Some("another"));
    for length in 8..whole.len() {
        if let Ok(Some(tiff)) = Directories::walk(&whole[..length]) {
            for make in ["Canon", "Nikon", "Olympus", "Panasonic", "Sony"] {
                let mut metadata = Metadata::default();
                metadata.set(Place::Image, tag::MAKE, Value::Text(make.into()));
                complete(&mut metadata, &tiff);
            }
        }
    }
}

#[test]
fn a_note_that_a_converter_kept_counts_from_where_it_stood() {
    const STOOD: usize = 40;
    let note = directory(STOOD, &[(0x0095, 2, 12, b"EF50mm f/1.8")]);
    let head = [&b"II"[..], &(STOOD as u32).to_be_bytes()].concat();
    let block = |name: &[u8], data: &[u8]| [name, &(data.len() as u32).to_be_bytes(), data].concat();
    let data = [&b"Adobe\0"[..], &block(b"Othr", b"odd\0"), &block(b"MakN", &[head, note].concat())].concat();
    let pointer = data.len() as u32;
    let image = directory(8, &[(PRIVATE_DATA, 1, pointer, &data), (tag::MAKE, 2, 6, b"Canon\0")]);
    let bytes = [&b"II\x2a\0\x08\0\0\0"[..], &image].concat();
    assert_eq!(names(&told(&bytes, "Canon"))[0], Some("EF50mm f/1.8"));
}
