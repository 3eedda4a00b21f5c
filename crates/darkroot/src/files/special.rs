//! What is no regular file: pipes, devices, sockets, folders and links where none may be.

use std::fs::{File, FileType, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Why something with a name is not read or written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Special {
    /// It is there, but no file.
    #[error("it is {kind}, not a file")]
    NotAFile {
        /// What it is, in words.
        kind: &'static str,
    },
    /// It is larger than anything that is read.
    #[error("it has more than {most} MB, which is more than is read")]
    TooLarge {
        /// What is read, in MB.
        most: u64,
    },
    /// A link in a folder where links are not followed.
    #[error(
        "{} is a symbolic link, and pictures are not written through it; move it away",
        crate::shown(path)
    )]
    Linked {
        /// The link.
        path: PathBuf,
    },
}

impl From<Special> for io::Error {
    fn from(special: Special) -> Self {
        Self::new(io::ErrorKind::InvalidInput, special)
    }
}

impl Special {
    /// What a failure of the system is about, if it is one of these.
    pub fn of(error: &io::Error) -> Option<&Self> {
        error.get_ref()?.downcast_ref()
    }
}

/// Opens a regular file to read. Nothing else is opened, as a pipe would block and a device might do anything; what takes
/// the file's place meanwhile is opened without waiting, and refused.
///
/// # Errors
/// No regular file, or one that cannot be read.
pub fn open(path: &Path) -> io::Result<File> {
    check(std::fs::metadata(path)?.file_type())?;
    checked(at_once(OpenOptions::new().read(true)).open(path)?)
}

/// Opens a regular file to read it and to add to it; made if it is missing.
///
/// # Errors
/// No regular file, or one that cannot be written.
pub(super) fn open_to_append(path: &Path) -> io::Result<File> {
    match std::fs::metadata(path) {
        Ok(data) => check(data.file_type())?,
        Err(e) if e.kind() == io::ErrorKind::NotFound => {}
        Err(e) => return Err(e),
    }
    checked(at_once(OpenOptions::new().read(true).append(true).create(true)).open(path)?)
}

/// Opens without waiting for anybody.
fn at_once(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        let flags = rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY;
        options.custom_flags(flags.bits().cast_signed());
    }
    options
}

/// The file, if it is a regular one.
pub(super) fn checked(file: File) -> io::Result<File> {
    check(file.metadata()?.file_type())?;
    Ok(file)
}

/// Whether it is a regular file.
pub(super) fn check(kind: FileType) -> io::Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    Err(Special::NotAFile { kind: name(kind) }.into())
}

#[cfg(unix)]
fn name(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match kind {
        k if k.is_fifo() => "a pipe",
        k if k.is_socket() => "a socket",
        k if k.is_char_device() || k.is_block_device() => "a device",
        _ => "something special",
    }
}

#[cfg(not(unix))]
fn name(_: FileType) -> &'static str {
    "something special"
}
