//! Texts that become parts of paths: the one way from the one to the other.

use std::ffi::{OsStr, OsString};

/// One part of a path: a name in the folder where it is put. It is never empty, never `.` or `..`, and never more than
/// one part, whatever text it was made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathPart(OsString);

impl PathPart {
    /// Of any text. What cannot stand in a name becomes `_`, and so do the dots of a name that has nothing but dots.
    /// Bytes that are no Unicode stay as they are where the system knows such names.
    pub fn of(text: &(impl AsRef<OsStr> + ?Sized)) -> Self {
        let bytes = text.as_ref().as_encoded_bytes();
        let nothing_but_dots = bytes.iter().all(|b| matches!(b, b'.' | b' '));
        let clean = |c: char| match c {
            c if std::path::is_separator(c) || c == '\0' => '_',
            '.' if nothing_but_dots => '_',
            // A name on one system can be a disk or a stream on another.
            ':' if cfg!(windows) => '_',
            c => c,
        };
        let mut part = OsString::new();
        for chunk in bytes.utf8_chunks() {
            part.push(chunk.valid().chars().map(clean).collect::<String>());
            part.push(raw(chunk.invalid()));
        }
        if part.is_empty() {
            part.push("_");
        }
        Self(part)
    }

    /// The name.
    pub fn name(&self) -> &OsStr {
        &self.0
    }
}

#[cfg(unix)]
fn raw(bytes: &[u8]) -> OsString {
    use std::os::unix::ffi::OsStrExt;
    OsStr::from_bytes(bytes).to_owned()
}

#[cfg(not(unix))]
fn raw(bytes: &[u8]) -> OsString {
    "_".repeat(bytes.len()).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::{Component, Path};

    #[test]
    fn a_part_stays_in_its_folder_whatever_it_is_made_of() {
        for (text, name) in [
            ("Nikon D700", "Nikon D700"),
            ("..", "__"),
            (".", "_"),
            ("", "_"),
            (". .", "_ _"),
            ("../../etc/passwd", ".._.._etc_passwd"),
            ("/", "_"),
            ("\0", "_"),
            (".hidden", ".hidden"),
            ("x.v2", "x.v2"),
        ] {
            let part = PathPart::of(text);
            assert_eq!(part.name(), name, "{text:?}");
            let parts: Vec<Component<'_>> = Path::new(part.name()).components().collect();
            assert_eq!(parts, [Component::Normal(name.as_ref())], "{text:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn bytes_that_are_no_unicode_are_kept() {
        use std::os::unix::ffi::OsStrExt;
        assert_eq!(PathPart::of(OsStr::from_bytes(b"a\xff/b")).name().as_bytes(), b"a\xff_b");
    }
}
