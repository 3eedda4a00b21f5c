//! Where an output goes, on systems that know no open folders: by its path.

use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use super::{Listed, Special, Tree, is_ours, special};

/// The path of an output.
pub(crate) struct Place {
    path: PathBuf,
    scratch: PathBuf,
}

impl Place {
    /// In a tree, folders that are missing are made and links are not followed.
    pub(crate) fn open(path: &Path, tree: Option<&Tree>) -> io::Result<Self> {
        let folder = super::folder_of(path);
        let scratch = match tree {
            Some(Tree { root, scratch }) => {
                below(root, folder)?;
                below(root, scratch)?;
                scratch
            }
            None => folder,
        };
        Ok(Self { path: path.to_owned(), scratch: scratch.to_owned() })
    }

    /// An empty file with a hidden name.
    pub(crate) fn unfinished(self) -> io::Result<Unfinished> {
        let file = tempfile::Builder::new()
            .prefix(super::PREFIX)
            .suffix(super::SUFFIX)
            .tempfile_in(&self.scratch)?;
        let listed = Listed::new(file.path());
        Ok(Unfinished { path: self.path, file, _listed: listed })
    }
}

/// An output that is being written.
pub(crate) struct Unfinished {
    path: PathBuf,
    file: tempfile::NamedTempFile,
    _listed: Listed,
}

impl Unfinished {
    pub(crate) fn file(&self) -> &File {
        self.file.as_file()
    }

    /// Whether it has a hidden name meanwhile.
    pub(crate) fn is_named(&self) -> bool {
        true
    }

    /// Gives it its name. Without `overwrite` something that has it already is an [`io::ErrorKind::AlreadyExists`].
    pub(crate) fn finish(self, overwrite: bool) -> io::Result<()> {
        let named =
            if overwrite { self.file.persist(&self.path) } else { self.file.persist_noclobber(&self.path) };
        named.map(|_| ()).map_err(|e| e.error)
    }
}

fn below(root: &Path, folder: &Path) -> io::Result<()> {
    let parts = folder.strip_prefix(root).map_err(|_| io::ErrorKind::InvalidFilename)?;
    let mut path = root.to_owned();
    for part in parts.components() {
        let Component::Normal(part) = part else { return Err(io::ErrorKind::InvalidFilename.into()) };
        path.push(part);
        if path.is_symlink() {
            return Err(Special::Linked { path }.into());
        }
        match fs::create_dir(&path) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
            _ => {}
        }
    }
    Ok(())
}

/// Opens a regular file below a folder to read it and to add to it.
pub(super) fn open_below(root: &Path, path: &Path) -> io::Result<File> {
    below(root, super::folder_of(path))?;
    if path.is_symlink() {
        return Err(Special::Linked { path: path.to_owned() }.into());
    }
    special::open_to_append(path)
}

/// Opens a regular file below a folder to read it; links are not followed.
pub(super) fn read_below(root: &Path, path: &Path) -> io::Result<File> {
    let parts = path.strip_prefix(root).map_err(|_| io::ErrorKind::InvalidFilename)?;
    let mut at = root.to_owned();
    for part in parts.components() {
        let Component::Normal(part) = part else { return Err(io::ErrorKind::InvalidFilename.into()) };
        at.push(part);
        if at.is_symlink() {
            return Err(Special::Linked { path: at }.into());
        }
    }
    special::open(path)
}

/// Removes what an unfinished run left in a folder below another, and the folder if nothing else is in it.
pub(super) fn clear(root: &Path, folder: &Path) -> io::Result<()> {
    if folder.symlink_metadata().is_err() {
        return Ok(());
    }
    below(root, folder)?;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if is_ours(entry.file_name().as_encoded_bytes()) {
            fs::remove_file(entry.path())?;
        }
    }
    fs::remove_dir(folder)
}
