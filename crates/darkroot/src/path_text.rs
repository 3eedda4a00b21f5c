//! Paths as text: what journals, JSON lines and workers say to each other, without loss.
//!
//! A path that is Unicode is written as it is. On Unix a name may hold any bytes; one that is no Unicode is written as a
//! zero and two hexadecimal digits. No name holds a zero, so nothing else is ever written so.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer, Serializer};

/// A path as text, from which [`path`] makes the same path again.
pub fn text(path: &Path) -> String {
    let mut text = String::new();
    for chunk in path.as_os_str().as_encoded_bytes().utf8_chunks() {
        text += chunk.valid();
        for byte in chunk.invalid() {
            text += &format!("\0{byte:02x}");
        }
    }
    text
}

/// The path of a text.
pub fn path(text: &str) -> PathBuf {
    let mut parts = text.split('\0');
    let mut bytes = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        match part.get(..2).and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                bytes.extend_from_slice(&part.as_bytes()[2..]);
            }
            // A zero that we did not write; no path has one.
            None => bytes.extend_from_slice(part.as_bytes()),
        }
    }
    of_bytes(bytes)
}

#[cfg(unix)]
fn of_bytes(bytes: Vec<u8>) -> PathBuf {
    use std::os::unix::ffi::OsStringExt;
    std::ffi::OsString::from_vec(bytes).into()
}

#[cfg(not(unix))]
fn of_bytes(bytes: Vec<u8>) -> PathBuf {
    String::from_utf8_lossy(&bytes).into_owned().into()
}

/// For serde: `#[serde(with = "darkroot::path_text")]`.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&text(path))
}

/// For serde: `#[serde(with = "darkroot::path_text")]`.
///
/// # Errors
/// Those of the deserializer.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<PathBuf, D::Error> {
    String::deserialize(deserializer).map(|text| path(&text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unicode_stays_as_it_is() {
        for name in ["a/ü.nef", "", "100%/\\x.nef"] {
            assert_eq!((text(Path::new(name)).as_str(), path(name)), (name, PathBuf::from(name)));
        }
        // Nothing that a stranger writes is a fault.
        assert_eq!(path("a\0zzb\0"), PathBuf::from("azzb"));
    }

    #[cfg(unix)]
    #[test]
    fn any_bytes_come_back() {
        use std::os::unix::ffi::OsStrExt;
        for bytes in [&b"a\xff/\xfe1.nef"[..], b"\xff", b"\xf0\x9f\x92", b"x\x80\xc3\xbc"] {
            let name = Path::new(std::ffi::OsStr::from_bytes(bytes));
            assert_eq!(path(&text(name)), name);
        }
    }
}
