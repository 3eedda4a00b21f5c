//! Reading inputs whole, writing outputs whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::Error;

/// Writes a path as text; what is no Unicode in it becomes a replacement character.
pub(crate) fn as_text<S: serde::Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// Temporary files that are being written now.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes every unfinished output: for a program that is told to stop at once. Finished outputs stay.
pub fn abandon() {
    for path in UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        // What cannot be removed now could not be removed later either.
        let _ = fs::remove_file(path);
    }
}

/// Keeps a temporary file on the list of [`abandon`] while it is being written.
struct Listed(PathBuf);

impl Listed {
    fn new(path: &Path) -> Self {
        UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).retain(|p| *p != self.0);
    }
}

/// Reads an input file.
///
/// # Errors
/// A file that is not there or cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let attempt = || {
        // On some systems a folder opens and only fails at the first read, with an obscure message.
        if fs::metadata(path)?.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        fs::read(path)
    };
    attempt().map_err(|e| Error::read(path, e))
}

/// What became of writing a file.
pub(crate) enum Failed<E> {
    /// Writing itself failed.
    Io(io::Error),
    /// The writer's own reason.
    Other(E),
}

/// Writes a file through `fill`: to a temporary file in the same folder, or in `scratch` on the same disk, flushed to
/// the disk, then renamed. If anything fails, the temporary file is removed and what was at `path` stays. Without
/// `overwrite` an existing file is an [`io::ErrorKind::AlreadyExists`], even one that appears meanwhile.
pub(crate) fn write<E>(
    path: &Path,
    scratch: Option<&Path>,
    overwrite: bool,
    fill: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), Failed<E>> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".darkroot-").suffix(".part");
    #[cfg(unix)]
    {
        // As a program would create it: readable for others as far as the user's umask allows.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let temporary = builder.tempfile_in(scratch.unwrap_or(folder)).map_err(Failed::Io)?;
    let _listed = Listed::new(temporary.path());
    let mut out = BufWriter::with_capacity(1 << 20, temporary.as_file());
    fill(&mut out).map_err(Failed::Other)?;
    out.flush().map_err(Failed::Io)?;
    drop(out);
    temporary.as_file().sync_all().map_err(Failed::Io)?;
    let persisted = if overwrite { temporary.persist(path) } else { temporary.persist_noclobber(path) };
    persisted.map_err(|e| Failed::Io(e.error))?;
    sync_folder(folder);
    Ok(())
}

/// Flushes a folder's entries to the disk, where the system can: after a power cut a renamed file has its new name.
pub fn sync_folder(folder: &Path) {
    // Systems that cannot open folders keep their entries safe by themselves.
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

/// Writes bytes as a file through [`write`]; missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub(crate) fn write_whole(path: &Path, bytes: &[u8], overwrite: bool) -> Result<(), Error> {
    if !overwrite && path.symlink_metadata().is_ok() {
        return Err(Error::Exists { path: path.to_owned() });
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|e| Error::write(path, e))?;
    }
    write(path, None, overwrite, |out| out.write_all(bytes)).map_err(|failed| match failed {
        Failed::Io(e) | Failed::Other(e) => Error::write(path, e),
    })
}

/// Writes a text as a file, whole or not at all. Missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub fn write_text(path: &Path, text: &str, overwrite: bool) -> Result<(), Error> {
    write_whole(path, text.as_bytes(), overwrite)
}
