//! Records of IPTC-IIM (IPTC-NAA Information Interchange Model 4.2): what newsrooms and older archives read.

/// A dataset of the application record: its number and its text. A dataset that may be repeated stands once for each value.
pub type Dataset = (u8, String);

/// Marks the begin of a dataset.
const MARK: u8 = 0x1c;
/// The record about the envelope, and its dataset that names the set of characters.
const ENVELOPE: u8 = 1;
const CHARACTERS: u8 = 90;
/// UTF-8 (ISO 2022).
const UTF_8: &[u8] = b"\x1b%G";
/// The record about the content, and its version.
const APPLICATION: u8 = 2;
const VERSION: (u8, [u8; 2]) = (0, [0, 4]);
/// No text is longer; longer ones have a form of their own, which no text of a photograph needs.
const LONGEST: usize = 0x7fff;
/// No record of a photograph has more datasets.
const MOST: usize = 2000;

/// The datasets of the application record. What is broken ends the list.
pub fn read(mut block: &[u8]) -> Vec<Dataset> {
    let mut found = Vec::new();
    let mut is_utf_8 = false;
    while let [MARK, record, dataset, high, low, rest @ ..] = block {
        let length = usize::from(u16::from_be_bytes([*high, *low]));
        let Some((value, after)) = rest.split_at_checked(length).filter(|_| length <= LONGEST) else { break };
        block = after;
        match (*record, *dataset) {
            (ENVELOPE, CHARACTERS) => is_utf_8 = value == UTF_8,
            (APPLICATION, dataset) if dataset != VERSION.0 && found.len() < MOST => {
                // Else nobody knows; most are Latin-1, and those that are not often UTF-8 all the same.
                let text = match std::str::from_utf8(value) {
                    Ok(text) => text.to_owned(),
                    Err(_) if is_utf_8 => String::from_utf8_lossy(value).into_owned(),
                    Err(_) => value.iter().map(|&b| char::from(b)).collect(),
                };
                found.push((dataset, text));
            }
            _ => (),
        }
    }
    found
}

/// The block of these datasets, in UTF-8; nothing where there are none. Texts are cut at the length that the standard gives
/// each dataset, at a character.
pub fn write(datasets: &[Dataset]) -> Vec<u8> {
    if datasets.is_empty() {
        return Vec::new();
    }
    let mut out = Vec::new();
    let mut put = |record: u8, dataset: u8, value: &[u8]| {
        let length = (value.len() as u16).to_be_bytes();
        out.extend_from_slice(&[MARK, record, dataset, length[0], length[1]]);
        out.extend_from_slice(value);
    };
    put(ENVELOPE, CHARACTERS, UTF_8);
    put(APPLICATION, VERSION.0, &VERSION.1);
    for (dataset, text) in datasets {
        let mut end = text.len().min(longest(*dataset));
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        put(APPLICATION, *dataset, &text.as_bytes()[..end]);
    }
    out
}

/// Bytes that the standard gives the text of a dataset.
fn longest(dataset: u8) -> usize {
    match dataset {
        5 | 25 | 101 | 103 => 64,
        40 | 105 => 256,
        80 | 85 | 90 | 92 | 95 | 110 | 115 => 32,
        116 => 128,
        100 => 3,
        120 => 2000,
        _ => 256,
    }
}

/// The block as Photoshop's image resources keep it in a JPEG (Adobe Photoshop File Formats: resource 0x0404).
pub(crate) fn resources(block: &[u8]) -> Vec<u8> {
    let mut out = b"Photoshop 3.0\x008BIM\x04\x04\0\0".to_vec();
    out.extend_from_slice(&(block.len() as u32).to_be_bytes());
    out.extend_from_slice(block);
    out.resize(out.len().next_multiple_of(2), 0);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let datasets = vec![(5, "Früh".to_owned()), (25, "a".to_owned()), (25, "b".to_owned())];
        assert_eq!(read(&write(&datasets)), datasets);
        assert!(write(&[]).is_empty());
        let long = vec![(90, "ü".repeat(40))];
        assert_eq!(read(&write(&long)), [(90, "ü".repeat(16))]);
    }

    #[test]
    fn broken_blocks_give_what_stands_before() {
        let whole = write(&[(5, "title".to_owned()), (120, "text".to_owned())]);
        for end in 0..whole.len() {
            assert!(read(&whole[..end]).len() <= 1, "{end}");
        }
        assert_eq!(read(&[whole.as_slice(), b"\x1c\x02"].concat()).len(), 2);
        assert_eq!(read(b"\x1c\x02\x05\x00\x01\xfc"), [(5, "ü".to_owned())]);
    }
}
