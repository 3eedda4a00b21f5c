//! Texts from outside (names of files, what a camera or a photographer wrote into one) as people are shown them.
//!
//! Such a text can hold what moves the cursor of a terminal, colours it, or begins a new line that looks like one of
//! ours. Everything that is shown passes [`shown`].

use std::ffi::OsStr;

/// The text in one line: whatever is no character to be seen stands there as an escape (`\n`, `\u{1b}`), and a byte that
/// is no Unicode as `\xff`.
pub fn shown(text: &(impl AsRef<OsStr> + ?Sized)) -> String {
    let mut line = String::new();
    for chunk in text.as_ref().as_encoded_bytes().utf8_chunks() {
        for c in chunk.valid().chars() {
            push(&mut line, c);
        }
        for byte in chunk.invalid() {
            line += &format!("\\x{byte:02x}");
        }
    }
    line
}

/// As [`shown`], and no longer than a person wants to read of what stands in a file where something else should.
pub fn quoted(text: &str) -> String {
    /// Characters that tell which place is meant.
    const MOST: usize = 200;
    let mut line = shown(text);
    if let Some((end, _)) = line.char_indices().nth(MOST) {
        line.truncate(end);
        line += "...";
    }
    line
}

/// Lines of ours that may hold texts from outside: their line breaks stay, all else is as in [`shown`].
pub fn lines(text: &str) -> String {
    let mut lines = String::with_capacity(text.len());
    for c in text.chars() {
        if c == '\n' { lines.push(c) } else { push(&mut lines, c) }
    }
    lines
}

/// JSON, line by line: what would order a terminal about is written as JSON writes it in texts, where alone it can stand.
pub fn json_lines(text: &str) -> String {
    let mut lines = String::with_capacity(text.len());
    for c in text.chars() {
        if c != '\n' && is_unseen(c) { lines += &format!("\\u{:04x}", u32::from(c)) } else { lines.push(c) }
    }
    lines
}

fn push(line: &mut String, c: char) {
    if is_unseen(c) { line.extend(c.escape_default()) } else { line.push(c) }
}

/// Whether a character is an order to whoever shows it: controls of both kinds, line breaks, and what turns the
/// direction of writing, so that a name reads as another.
fn is_unseen(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_order_a_terminal_about_is_written_out() {
        assert_eq!(shown("a\x1b[31mb\nc\u{9b}2J\u{202e}gpj.exe"), r"a\u{1b}[31mb\nc\u{9b}2J\u{202e}gpj.exe");
        assert_eq!(shown("Ünïcode 写真 (1).nef"), "Ünïcode 写真 (1).nef");
        assert_eq!(lines("ours\n  \x07note: theirs\r"), "ours\n  \\u{7}note: theirs\\r");
    }

    #[test]
    fn json_stays_json() {
        assert_eq!(json_lines("{\"a\":\"\u{9b}2J\u{7f}ü\"}\n"), "{\"a\":\"\\u009b2J\\u007fü\"}\n");
    }

    #[test]
    fn what_is_quoted_is_short() {
        assert_eq!(quoted(&"ä".repeat(201)), "ä".repeat(200) + "...");
        assert_eq!(quoted("5\n"), r"5\n");
    }

    #[cfg(unix)]
    #[test]
    fn bytes_that_are_no_unicode_are_told_apart() {
        use std::os::unix::ffi::OsStrExt;
        assert_eq!(shown(OsStr::from_bytes(b"a\xff\xfe.nef")), r"a\xff\xfe.nef");
    }
}
