//! The one place where files are opened: reading inputs whole, writing outputs whole or not at all.
//!
//! Only regular files are opened. `-` is standard input where a file is read and standard output where one is written.

mod special;
pub use special::{Special, open};

mod output;
pub use output::Output;

#[cfg(unix)]
mod unix;
#[cfg(unix)]
use unix as system;

#[cfg(not(unix))]
mod elsewhere;
#[cfg(not(unix))]
use elsewhere as system;

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};

use crate::Error;

/// The largest file that is read, in bytes: three times what a raw file of 400 megapixels has.
const LARGEST: u64 = 4 << 30;
/// The most that is taken from standard input, whose end nobody knows, in bytes.
const LARGEST_STREAM: u64 = 1 << 30;
/// The largest file that is read as text, in bytes: ten times any table of spectra.
const LARGEST_TEXT: u64 = 64 << 20;

/// Names of unfinished outputs, where they have names.
const PREFIX: &str = ".darkroot-";
const SUFFIX: &str = ".part";

/// Whether that is how an unfinished output is called.
fn is_ours(name: &[u8]) -> bool {
    name.starts_with(PREFIX.as_bytes()) && name.ends_with(SUFFIX.as_bytes())
}

/// Whether a path stands for standard input or output.
pub fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// A folder of outputs in which others may write as well: no link below it is followed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tree {
    /// The folder. Folders below it are made when they are missing.
    pub root: PathBuf,
    /// Where below it unfinished outputs lie, if they must have names.
    pub scratch: PathBuf,
}

/// Unfinished outputs that have names.
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

/// Reads an input file, or standard input.
///
/// # Errors
/// A file that is not there, is none, is larger than any input, or cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, Error> {
    read_up_to(path, LARGEST)
}

/// Reads a file that is text, or should be: spectra, references, charts, profiles, logs.
///
/// # Errors
/// As [`read`].
pub fn read_text(path: &Path) -> Result<Vec<u8>, Error> {
    read_up_to(path, LARGEST_TEXT)
}

/// SHA-256 of a file's bytes, hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

/// Reads a file of at most so many bytes.
///
/// # Errors
/// As [`read`].
pub fn read_up_to(path: &Path, most: u64) -> Result<Vec<u8>, Error> {
    let attempt = || {
        if is_stream(path) {
            return bounded(io::stdin().lock(), 0, most.min(LARGEST_STREAM));
        }
        let file = open(path)?;
        let size = file.metadata()?.len();
        bounded(file, size, most)
    };
    attempt().map_err(|e| Error::read(path, e))
}

/// All that is there, of about `size` bytes, unless it is more than `most`.
fn bounded(from: impl Read, size: u64, most: u64) -> io::Result<Vec<u8>> {
    let too_large = || io::Error::from(Special::TooLarge { most: most >> 20 });
    if size > most {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX))
        .map_err(|_| io::ErrorKind::OutOfMemory)?;
    from.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large()) } else { Ok(bytes) }
}

/// What became of writing a file.
pub(crate) enum Failed<E> {
    /// Writing itself failed.
    Io(io::Error),
    /// The writer's own reason.
    Other(E),
}

/// The folder that a path lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Flushes a folder's entries to the disk, where the system can: after a power cut a renamed file has its new name.
pub fn sync_folder(folder: &Path) {
    // Systems that cannot open folders keep their entries safe by themselves.
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

/// Opens a file below a folder to read it and to add to it, without following links below the folder. It is made where
/// it is missing.
///
/// # Errors
/// No regular file, a link, or a place that cannot be written.
pub fn open_below(root: &Path, path: &Path) -> io::Result<File> {
    system::open_below(root, path)
}

/// Reads an input file below a folder, without following links below the folder.
///
/// # Errors
/// As [`read`]; a link, or a path that is not below the folder.
pub fn read_below(root: &Path, path: &Path) -> Result<Vec<u8>, Error> {
    let attempt = || {
        let file = system::read_below(root, path)?;
        let size = file.metadata()?.len();
        bounded(file, size, LARGEST)
    };
    attempt().map_err(|e| Error::read(path, e))
}

/// The first bytes of an input file below a folder, as [`read_below`]: at most so many.
///
/// # Errors
/// As [`read_below`].
pub fn read_start_below(root: &Path, path: &Path, most: u64) -> Result<Vec<u8>, Error> {
    let attempt = || {
        let mut bytes = Vec::new();
        system::read_below(root, path)?.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    attempt().map_err(|e| Error::read(path, e))
}

/// Removes unfinished outputs that a run left in a folder below another, and the folder if it is empty then.
///
/// # Errors
/// A link, or what the system does not allow.
pub fn clear_unfinished(root: &Path, folder: &Path) -> io::Result<()> {
    system::clear(root, folder)
}

/// Adds lines to a file, behind `head` where it is new.
///
/// # Errors
/// A file that cannot be written, or is none.
pub(crate) fn append(path: &Path, head: &[u8], lines: &[u8]) -> Result<(), Error> {
    let attempt = || {
        let mut file = special::open_to_append(path)?;
        let head = if file.metadata()?.len() == 0 { head } else { &[] };
        file.write_all(&[head, lines].concat())?;
        file.sync_all()
    };
    attempt().map_err(|e| Error::write(path, e))
}

/// Writes bytes as a file through an [`Output`]; missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub(crate) fn write_whole(path: &Path, bytes: &[u8], overwrite: bool) -> Result<(), Error> {
    if !overwrite && !is_stream(path) && path.symlink_metadata().is_ok() {
        return Err(Error::Exists { path: path.to_owned() });
    }
    fs::create_dir_all(folder_of(path)).map_err(|e| Error::write(path, e))?;
    let output = Output::open(path, None).map_err(|e| Error::write(path, e))?;
    output.write_whole(path, bytes, overwrite)
}

/// Writes a text as a file, whole or not at all. Missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub fn write_text(path: &Path, text: &str, overwrite: bool) -> Result<(), Error> {
    write_whole(path, text.as_bytes(), overwrite)
}

#[cfg(test)]
mod tests;
