//! A recipe file to a layer. TOML: names are those of flags, values are texts, numbers or switches.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::{Layer, Origin, RecipeError, Unreadable};
use crate::files;
use crate::settings::{Key, NotAValue};

/// No recipe is as large as that, in bytes.
const LARGEST: u64 = 1 << 20;

/// A `darkroot.toml`.
#[derive(Debug, Clone)]
pub(super) struct FolderFile {
    pub(super) layer: Layer,
    /// Whether the folders above are not looked at.
    pub(super) root: bool,
}

/// A recipe that must be there.
pub(super) fn read(path: &Path, origin: impl Fn(PathBuf) -> Origin) -> Result<Layer, RecipeError> {
    let text = text_of(path).map_err(|e| unreadable(path, &e))?;
    parse(path, &text, origin(path.to_owned())).and_then(|found| found.without_root(path, &text))
}

/// A recipe that is a text.
pub(super) fn read_text(text: &str) -> Result<Layer, RecipeError> {
    let path = Path::new("the recipe");
    parse(path, text, Origin::Recipe(path.to_owned())).and_then(|found| found.without_root(path, text))
}

/// A recipe that may be missing.
pub(super) fn read_if_there(
    path: &Path,
    origin: impl Fn(PathBuf) -> Origin,
) -> Result<Option<Layer>, RecipeError> {
    if is_missing(path) { Ok(None) } else { read(path, origin).map(Some) }
}

/// A `darkroot.toml` that may be missing.
pub(super) fn read_folder_file(path: &Path) -> Result<Option<FolderFile>, RecipeError> {
    if is_missing(path) {
        return Ok(None);
    }
    let text = text_of(path).map_err(|e| unreadable(path, &e))?;
    parse(path, &text, Origin::Folder(path.to_owned())).map(Some)
}

/// Whether there can be no such recipe: it does not exist, its name would be too long, or its folder is closed to
/// us. A link that leads nowhere is not missing: somebody wants something from there.
fn is_missing(path: &Path) -> bool {
    use io::ErrorKind::{InvalidFilename, NotADirectory, NotFound, PermissionDenied};
    path.symlink_metadata()
        .is_err_and(|e| matches!(e.kind(), NotFound | NotADirectory | InvalidFilename | PermissionDenied))
}

fn text_of(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    files::open(path)?.take(LARGEST + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LARGEST {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    Ok(text)
}

fn unreadable(path: &Path, error: &io::Error) -> RecipeError {
    let source = match error.kind() {
        io::ErrorKind::NotFound => Unreadable::Missing,
        io::ErrorKind::IsADirectory => Unreadable::Folder,
        io::ErrorKind::InvalidData => Unreadable::NotText,
        io::ErrorKind::FileTooLarge => Unreadable::TooLarge,
        _ => Unreadable::System { message: error.to_string() },
    };
    RecipeError::Read { path: path.to_owned(), source }
}

fn parse(path: &Path, text: &str, origin: Origin) -> Result<FolderFile, RecipeError> {
    let line = |at: usize| text.as_bytes().iter().take(at).filter(|b| **b == b'\n').count() + 1;
    let table = DeTable::parse(text).map_err(|error| RecipeError::Syntax {
        path: path.to_owned(),
        line: line(error.span().map_or(0, |s| s.start)),
        message: error.message().trim().replace('\n', ", "),
    })?;
    let table = table.get_ref();
    if table.get("format").and_then(|v| v.get_ref().as_str()) == Some("darkroot profile") {
        return Err(RecipeError::Profile { path: path.to_owned() });
    }
    let mut found = FolderFile { layer: Layer::empty(origin), root: false };
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(name, _)| name.span().start);
    for (name, value) in entries {
        let (path, line) = (path.to_owned(), line(name.span().start));
        let name = name.get_ref().as_ref();
        let value = value.get_ref();
        if name == "root" {
            found.root = value.as_bool().ok_or_else(|| RecipeError::Type {
                path,
                line,
                name: name.to_owned(),
                found: kind(value),
                allowed: "true or false".to_owned(),
            })?;
            continue;
        }
        let Some(key) = Key::from_name(name) else {
            return Err(RecipeError::Key { path, line, name: name.to_owned(), nearest: Key::nearest(name) });
        };
        let Some(text) = text_for(key, value) else {
            return Err(RecipeError::Type {
                path,
                line,
                name: name.to_owned(),
                found: kind(value),
                allowed: key.setting().example(),
            });
        };
        let set = beside(key, &text, &path).and_then(|text| found.layer.set(key, &text));
        set.map_err(|wrong| RecipeError::Value { path, line, key, wrong })?;
    }
    Ok(found)
}

impl FolderFile {
    /// The layer of a file that is no `darkroot.toml`.
    fn without_root(self, path: &Path, text: &str) -> Result<Layer, RecipeError> {
        if !self.root {
            return Ok(self.layer);
        }
        let line = text.lines().position(|l| l.trim_start().starts_with("root")).unwrap_or(0) + 1;
        Err(RecipeError::Root { path: path.to_owned(), line })
    }
}

/// A value as it would be written on the command line; `None` if it is of a type that the key does not have.
fn text_for(key: Key, value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Boolean(switch) if key.is_switch() => Some(switch.to_string()),
        DeValue::Integer(n) if key.is_number() => {
            Some(i64::from_str_radix(n.as_str(), n.radix()).map_or_else(|_| n.to_string(), |n| n.to_string()))
        }
        DeValue::Float(n) if key.is_number() => Some(n.as_str().to_owned()),
        _ => None,
    }
}

/// What a value is, in words.
fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// The text, or for a relative path to a profile the path from the recipe's own place.
fn beside(key: Key, text: &str, recipe: &Path) -> Result<String, NotAValue> {
    let recipe = std::path::absolute(recipe).unwrap_or_else(|_| recipe.to_owned());
    let path = recipe.parent().unwrap_or(Path::new("")).join(text);
    // A file beside the recipe may be called as it likes.
    let lies_there = key.may_be_file(text) && path.is_file();
    if !key.is_file(text) && !lies_there {
        return Ok(text.to_owned());
    }
    match path.to_str() {
        Some(path) => Ok(path.to_owned()),
        None => Err(NotAValue::not_utf8(text)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<FolderFile, String> {
        let path = Path::new("/photos/darkroot.toml");
        parse(path, text, Origin::Folder(path.to_owned())).map_err(|e| e.to_string())
    }

    #[test]
    fn values_are_written_as_is_natural() {
        let found = parsed(
            "root = true\nbits = 16\nexposure = -0.50\nchroma = \"420\"\nauto-exposure = true\n\
             white-balance = \"5200K,+8\"\nprofile = \"cameras/d750.toml\"\nquality = 0x50",
        )
        .unwrap();
        assert!(found.root);
        let is = |key, text| assert_eq!(found.layer.get(key), Some(text));
        is(Key::named("bits"), "16");
        is(Key::named("exposure"), "-0.5");
        is(Key::named("chroma"), "420");
        is(Key::named("auto-exposure"), "true");
        is(Key::named("white-balance"), "5200K,+8");
        is(Key::named("profile"), "/photos/cameras/d750.toml");
        is(Key::named("quality"), "80");
        assert_eq!(found.layer.get(Key::named("look")), None);
    }

    #[test]
    fn auto_and_matrix_are_words_and_no_profiles_beside_the_recipe() {
        for word in ["auto", "matrix"] {
            let found = parsed(&format!("profile = \"{word}\"")).unwrap();
            assert_eq!(found.layer.get(Key::named("profile")), Some(word));
        }
    }

    #[test]
    fn an_amount_may_be_a_number() {
        for text in ["sharpen = 1", "sharpen = 0.5", "denoise = 2", "sharpen = \"off\"", "straighten = -1.5"]
        {
            assert!(parsed(text).is_ok(), "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line_and_what_is_allowed() {
        for (text, words) in [
            ("\nspcae = \"srgb\"", [":2:", "`spcae`", "`space`?"]),
            ("clarity = 1", [":1:", "`clarity`", "white-balance"]),
            ("bits = 16\n\nlook = 3", [":3:", "a number", "\"vivid\""]),
            ("white-balance = [2.1, 1, 1.5]", [":1:", "a list", "\"2.1,1,1.5\""]),
            ("white-balance = \"warm\"", [":1:", "`warm`", "5200K"]),
            ("exposure = true", [":1:", "true or false", "0.5"]),
            ("bits = 12", [":1:", "`12`", "8, 16 or 32"]),
            ("auto-exposure = 1", [":1:", "a number", "true or false"]),
            ("[look]\nname = \"vivid\"", [":1:", "a table", "\"vivid\""]),
            ("root = \"yes\"", [":1:", "`root`", "true or false"]),
            ("look = vivid", [":1:", "TOML", "in quotes"]),
            ("crop = 3", [":1:", "a number", "\"3:2\""]),
            ("exposure = inf", [":1:", "exposure", "-20 to 20"]),
        ] {
            let message = parsed(text).unwrap_err();
            for word in ["/photos/darkroot.toml"].into_iter().chain(words) {
                assert!(message.contains(word), "no `{word}` in {message}");
            }
        }
    }
}
