//! CGATS.17 text files (ISO 28178) and what Argyll makes of them.

use super::table::Table;
use super::{NotAReference, ReferenceError};

/// Reads the first table of the file.
pub(super) fn parse(text: &str) -> Result<Table, ReferenceError> {
    let mut columns: Vec<String> = Vec::new();
    let mut cells: Vec<String> = Vec::new();
    let mut state = State::Header;
    for line in text.lines() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        match (state, line.split_whitespace().next().unwrap_or_default()) {
            (State::Header, "BEGIN_DATA_FORMAT") => state = State::Format,
            (State::Format, "END_DATA_FORMAT") => state = State::Header,
            (State::Format, _) => columns.extend(words(line)),
            (State::Header, "BEGIN_DATA") => state = State::Data,
            (State::Data, "END_DATA") => break,
            (State::Data, _) => cells.extend(words(line)),
            (State::Header, _) => {}
        }
    }
    if columns.is_empty() {
        return Err(NotAReference::NoDataFormat.into());
    }
    if cells.is_empty() {
        return Err(NotAReference::NoData.into());
    }
    if !cells.len().is_multiple_of(columns.len()) {
        return Err(NotAReference::Rows { values: cells.len(), columns: columns.len() }.into());
    }
    let rows = cells.chunks(columns.len()).map(<[String]>::to_vec).collect();
    Ok(Table { columns, rows })
}

#[derive(Clone, Copy)]
enum State {
    Header,
    Format,
    Data,
}

/// Words of a line; quotes hold blanks together.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c.is_whitespace() && !quoted => {
                if !word.is_empty() {
                    words.push(std::mem::take(&mut word));
                }
            }
            c => word.push(c),
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::super::{Reference, ReferenceColour};

    const FILE: &str = "CGATS.17\nORIGINATOR \"a test\"\nNUMBER_OF_FIELDS 5\nBEGIN_DATA_FORMAT\nSAMPLE_ID \
                        SAMPLE_NAME LAB_L LAB_A\nLAB_B\nEND_DATA_FORMAT\nNUMBER_OF_SETS 2\nBEGIN_DATA\n1 \"dark \
                        skin\" 37.5 14.4 14.9\n2 white 96.0 -0.5 1.2\nEND_DATA\n";

    #[test]
    fn a_table_is_read_whatever_its_line_breaks() {
        let reference = Reference::parse(FILE).unwrap();
        assert_eq!(reference.patches.len(), 2);
        assert_eq!(reference.patches[0].0, "dark skin");
        assert!(matches!(reference.patches[1].1, ReferenceColour::Lab(lab) if (lab.l - 96.0).abs() < 1e-12));
    }

    #[test]
    fn broken_tables_are_named() {
        for (from, to, words) in [
            ("37.5 14.4", "37.5", "do not fill rows"),
            ("BEGIN_DATA_FORMAT", "DATA", "no BEGIN_DATA_FORMAT"),
            ("37.5", "x", "`x` is not a number"),
        ] {
            let message = Reference::parse(&FILE.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(message.contains(words), "{from}: {message}");
        }
    }
}
