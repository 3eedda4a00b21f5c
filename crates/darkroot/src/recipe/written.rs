//! Settings as the text of a recipe file.

use std::fmt::Write;
use std::path::Path;

use super::{Layer, sidecar};
use crate::files::{Output, Tree};
use crate::{Error, Key};

/// A value as TOML has it.
pub(super) fn written(key: Key, text: &str) -> String {
    let bare = key.is_switch() || key.is_number() && text.parse::<f64>().is_ok_and(f64::is_finite);
    if bare {
        return text.to_owned();
    }
    // A recipe may be put anywhere, and what is relative in it is relative to its place.
    let absolute = key.is_file(text).then(|| std::path::absolute(text).ok()).flatten();
    let text = absolute.as_deref().and_then(Path::to_str).unwrap_or(text);
    toml::Value::from(text).to_string()
}

/// Writes the sidecar of a raw file in a folder, or in one below it, whole or not at all; one that is there is replaced, but for
/// the comments at its top. No link below the folder is followed. A layer that says nothing takes the sidecar away.
///
/// # Errors
/// A place that cannot be written, or where no file stands that could be a sidecar.
pub fn write_sidecar(root: &Path, input: &Path, edits: &Layer) -> Result<(), Error> {
    let path = sidecar(input);
    let comments = comments(&path);
    let failed = |e| Error::write(&path, e);
    if edits.iter().next().is_none() && comments.is_empty() {
        return match std::fs::remove_file(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(failed(e)),
            _ => Ok(()),
        };
    }
    let mut text = comments;
    for (key, value) in edits.iter() {
        let _ = writeln!(text, "{key} = {}", written(key, value));
    }
    let folder = crate::files::folder_of(&path).to_owned();
    let tree = Tree { root: root.to_owned(), scratch: folder };
    Output::open(&path, Some(&tree)).map_err(failed)?.write_whole(&path, text.as_bytes(), true)
}

/// The lines of comment at the top of a recipe, as they are.
fn comments(path: &Path) -> String {
    let bytes = crate::files::read_text(path).unwrap_or_default();
    let text = String::from_utf8(bytes).unwrap_or_default();
    text.lines().take_while(|line| line.starts_with('#')).map(|line| format!("{line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::edits;

    fn layer(input: &Path, values: &[(&str, &str)]) -> Layer {
        let values = values.iter().map(|(name, text)| (Key::from_name(name).unwrap(), (*text).to_owned()));
        Layer::sidecar(input, values).unwrap()
    }

    #[test]
    fn what_is_written_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("a b.nef");
        assert_eq!(edits(&input).unwrap(), None);
        let said = [
            ("exposure", "-0.5"),
            ("white-balance", "5200K,+8"),
            ("lens", "off"),
            ("artist", "Ann \"A\""),
            ("auto-exposure", "true"),
        ];
        let edited = layer(&input, &said);
        write_sidecar(folder.path(), &input, &edited).unwrap();
        assert_eq!(edits(&input).unwrap(), Some(edited));

        // Comments at the top stay; nothing to say and no comment: no file.
        let path = sidecar(&input);
        std::fs::write(&path, "# for the wall\nexposure = 1\n").unwrap();
        write_sidecar(folder.path(), &input, &layer(&input, &[("look", "flat")])).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "# for the wall\nlook = \"flat\"\n");
        std::fs::write(&path, "exposure = 1\n").unwrap();
        write_sidecar(folder.path(), &input, &layer(&input, &[])).unwrap();
        assert!(!path.exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_sidecar_that_is_a_link_is_replaced_and_what_it_leads_to_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (input, elsewhere) = (folder.path().join("a.nef"), folder.path().join("mine.toml"));
        std::fs::write(&elsewhere, "exposure = 1").unwrap();
        std::os::unix::fs::symlink(&elsewhere, sidecar(&input)).unwrap();
        write_sidecar(folder.path(), &input, &layer(&input, &[("exposure", "2")])).unwrap();
        assert_eq!(std::fs::read_to_string(&elsewhere).unwrap(), "exposure = 1");
        assert!(sidecar(&input).symlink_metadata().unwrap().is_file());
    }
}
