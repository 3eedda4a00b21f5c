//! Where an output goes, as an open folder: what is renamed or linked meanwhile leads nowhere else.

use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use rustix::fs::{
    AtFlags, Mode, OFlags, RenameFlags, linkat, mkdirat, openat, renameat, renameat_with, statat, unlinkat,
};
use rustix::io::Errno;

use super::{Listed, Special, Tree, is_ours, special};

/// Outputs are readable for others as far as the user's umask allows.
const OUTPUT: Mode = Mode::from_raw_mode(0o666);
const FOLDER: Mode = Mode::from_raw_mode(0o777);

/// A folder is only a place here, which asks for no right to list it.
const PLACE: OFlags = if cfg!(target_os = "linux") {
    OFlags::from_bits_retain(OFlags::PATH.bits() | OFlags::DIRECTORY.bits() | OFlags::CLOEXEC.bits())
} else {
    OFlags::from_bits_retain(OFlags::DIRECTORY.bits() | OFlags::CLOEXEC.bits())
};

/// An open folder, and the name of an output in it.
pub(crate) struct Place {
    folder: OwnedFd,
    name: OsString,
    /// Where what is unfinished lies if it must have a name, and its path.
    scratch: (OwnedFd, PathBuf),
}

impl Place {
    /// Opens the folder of an output. In a tree, folders that are missing are made and links are not followed.
    pub(crate) fn open(path: &Path, tree: Option<&Tree>) -> io::Result<Self> {
        let name = path.file_name().ok_or(io::ErrorKind::IsADirectory)?.to_owned();
        let folder = super::folder_of(path);
        let (folder, scratch) = match tree {
            Some(Tree { root, scratch }) => (below(root, folder)?, (below(root, scratch)?, scratch.clone())),
            None => (place(folder)?, (place(folder)?, folder.to_owned())),
        };
        Ok(Self { folder, name, scratch })
    }

    /// An empty file that nobody sees: without a name where the system has such, so that it is gone with this process
    /// whatever ends it.
    pub(crate) fn unfinished(self) -> io::Result<Unfinished> {
        if let Some(file) = nameless(&self.folder)? {
            return Ok(Unfinished { place: self, file, named: None });
        }
        loop {
            let name = fresh();
            let flags = OFlags::CREATE | OFlags::EXCL | OFlags::RDWR | OFlags::CLOEXEC | OFlags::NOFOLLOW;
            match openat(&self.scratch.0, name.as_str(), flags, OUTPUT) {
                Ok(file) => {
                    let listed = Listed::new(&self.scratch.1.join(&name));
                    return Ok(Unfinished { place: self, file: file.into(), named: Some((name, listed)) });
                }
                Err(Errno::EXIST) => {}
                Err(error) => return Err(error.into()),
            }
        }
    }
}

/// A file without a name, where system and disk have such and can give it one later.
#[cfg(target_os = "linux")]
fn nameless(folder: &OwnedFd) -> io::Result<Option<File>> {
    match openat(folder, ".", OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC, OUTPUT) {
        Ok(file) => {
            let file = File::from(file);
            // Without /proc it could never get a name.
            Ok(proc_path(&file).symlink_metadata().is_ok().then_some(file))
        }
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::INVAL | Errno::NOENT | Errno::NOSYS) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &OwnedFd) -> io::Result<Option<File>> {
    Ok(None)
}

/// The name that the system itself has for an open file.
fn proc_path(file: &File) -> PathBuf {
    use std::os::fd::AsRawFd;
    format!("/proc/self/fd/{}", file.as_raw_fd()).into()
}

/// A name that nothing has.
fn fresh() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let time = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.as_nanos());
    format!("{}{}-{number}-{time:x}{}", super::PREFIX, std::process::id(), super::SUFFIX)
}

/// An output that is being written.
pub(crate) struct Unfinished {
    place: Place,
    file: File,
    /// Its name, where it has one.
    named: Option<(String, Listed)>,
}

impl Unfinished {
    pub(crate) fn file(&self) -> &File {
        &self.file
    }

    /// Whether it has a hidden name meanwhile.
    pub(crate) fn is_named(&self) -> bool {
        self.named.is_some()
    }

    /// Gives it its name. Without `overwrite` something that has it already is an [`io::ErrorKind::AlreadyExists`], even if
    /// it appears at this moment.
    pub(crate) fn finish(mut self, overwrite: bool) -> io::Result<()> {
        if overwrite {
            self.check_replaced()?;
        }
        let Place { folder, name, scratch } = &self.place;
        match &self.named {
            Some((temporary, _)) if overwrite => renameat(&scratch.0, temporary.as_str(), folder, name)?,
            Some((temporary, _)) => rename_new(&scratch.0, temporary, folder, name)?,
            None => self.link(overwrite)?,
        }
        self.named = None;
        sync(&self.place.folder);
        Ok(())
    }

    /// A name for the file that has none.
    fn link(&self, overwrite: bool) -> io::Result<()> {
        let Place { folder, name, scratch } = &self.place;
        let file = proc_path(&self.file);
        let named =
            |at: &OwnedFd, name: &OsStr| linkat(rustix::fs::CWD, &file, at, name, AtFlags::SYMLINK_FOLLOW);
        match named(folder, name) {
            Err(Errno::EXIST) if overwrite => {}
            result => return Ok(result?),
        }
        // A link replaces nothing; only a file with a name can.
        let temporary = fresh();
        named(&scratch.0, OsStr::new(&temporary))?;
        renameat(&scratch.0, temporary.as_str(), folder, name).map_err(|error| {
            // The reason why it was not renamed counts more.
            let _ = unlinkat(&scratch.0, temporary.as_str(), AtFlags::empty());
            error.into()
        })
    }

    /// Only a file, or a link to whatever, is replaced: never a device.
    fn check_replaced(&self) -> io::Result<()> {
        let Ok(there) = statat(&self.place.folder, &self.place.name, AtFlags::SYMLINK_NOFOLLOW) else {
            return Ok(());
        };
        match rustix::fs::FileType::from_raw_mode(there.st_mode) {
            rustix::fs::FileType::RegularFile | rustix::fs::FileType::Symlink => Ok(()),
            rustix::fs::FileType::Directory => Err(io::ErrorKind::IsADirectory.into()),
            rustix::fs::FileType::Fifo => Err(Special::NotAFile { kind: "a pipe" }.into()),
            _ => Err(Special::NotAFile { kind: "a device" }.into()),
        }
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if let Some((name, _)) = &self.named {
            // What cannot be removed now could not be removed later either.
            let _ = unlinkat(&self.place.scratch.0, name.as_str(), AtFlags::empty());
        }
    }
}

/// Renames without replacing anything.
fn rename_new(from: &OwnedFd, temporary: &str, folder: &OwnedFd, name: &OsStr) -> io::Result<()> {
    match renameat_with(from, temporary, folder, name, RenameFlags::NOREPLACE) {
        Err(Errno::INVAL | Errno::NOSYS | Errno::OPNOTSUPP) => {}
        result => return Ok(result?),
    }
    linkat(from, temporary, folder, name, AtFlags::empty())?;
    Ok(unlinkat(from, temporary, AtFlags::empty())?)
}

/// A folder as a path leads to it.
fn place(folder: &Path) -> io::Result<OwnedFd> {
    Ok(openat(rustix::fs::CWD, folder, PLACE, Mode::empty())?)
}

/// A folder below another; folders that are missing are made, links are not followed.
fn below(root: &Path, folder: &Path) -> io::Result<OwnedFd> {
    descend(root, folder, |at, part| match mkdirat(at, part, FOLDER) {
        // Another worker was faster.
        Ok(()) | Err(Errno::EXIST) => Ok(()),
        Err(error) => Err(error.into()),
    })
}

/// As [`below`]; `make` is asked for what is missing.
fn descend(
    root: &Path,
    folder: &Path,
    make: impl Fn(&OwnedFd, &OsStr) -> io::Result<()>,
) -> io::Result<OwnedFd> {
    let mut at = place(root)?;
    let parts = folder.strip_prefix(root).map_err(|_| io::ErrorKind::InvalidFilename)?;
    let mut path = root.to_owned();
    for part in parts.components() {
        // A path that leads up again is below nothing.
        let std::path::Component::Normal(part) = part else {
            return Err(io::ErrorKind::InvalidFilename.into());
        };
        path.push(part);
        at = match openat(&at, part, PLACE | OFlags::NOFOLLOW, Mode::empty()) {
            Err(Errno::NOENT) => {
                make(&at, part)?;
                opened(openat(&at, part, PLACE | OFlags::NOFOLLOW, Mode::empty()), &path)?
            }
            result => opened(result, &path)?,
        };
    }
    Ok(at)
}

fn opened(result: rustix::io::Result<OwnedFd>, path: &Path) -> io::Result<OwnedFd> {
    match result {
        Err(Errno::LOOP | Errno::NOTDIR) if path.is_symlink() => {
            Err(Special::Linked { path: path.to_owned() }.into())
        }
        result => Ok(result?),
    }
}

/// Flushes a folder's entries to the disk.
fn sync(folder: &OwnedFd) {
    // A disk that cannot keeps its entries safe by itself.
    if let Ok(folder) =
        openat(folder, ".", OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC, Mode::empty())
    {
        let _ = rustix::fs::fsync(folder);
    }
}

/// Opens a regular file below a folder to read it and to add to it. It is made if it is missing, with the folders above
/// it; links are not followed.
pub(super) fn open_below(root: &Path, path: &Path) -> io::Result<File> {
    let name = path.file_name().ok_or(io::ErrorKind::IsADirectory)?;
    let folder = below(root, super::folder_of(path))?;
    let flags = OFlags::RDWR | OFlags::APPEND | OFlags::CREATE | OFlags::CLOEXEC;
    let waitless = OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::NOCTTY;
    match openat(&folder, name, flags | waitless, OUTPUT) {
        Ok(file) => special::checked(file.into()),
        Err(Errno::LOOP) => Err(Special::Linked { path: path.to_owned() }.into()),
        Err(error) => Err(error.into()),
    }
}

/// Opens a regular file below a folder to read it; links are not followed.
pub(super) fn read_below(root: &Path, path: &Path) -> io::Result<File> {
    let name = path.file_name().ok_or(io::ErrorKind::IsADirectory)?;
    let folder = descend(root, super::folder_of(path), |_, _| Err(io::ErrorKind::NotFound.into()))?;
    let flags = OFlags::RDONLY | OFlags::CLOEXEC | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::NOCTTY;
    special::checked(opened(openat(&folder, name, flags, Mode::empty()), path)?.into())
}

/// Removes what an unfinished run left in a folder below another, and the folder if nothing else is in it.
pub(super) fn clear(root: &Path, folder: &Path) -> io::Result<()> {
    if folder.symlink_metadata().is_err() {
        return Ok(());
    }
    let at = below(root, folder)?;
    let listed = openat(&at, ".", OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC, Mode::empty())?;
    for entry in rustix::fs::Dir::new(listed)? {
        let entry = entry?;
        if is_ours(entry.file_name().to_bytes()) {
            unlinkat(&at, entry.file_name(), AtFlags::empty())?;
        }
    }
    let (above, name) = (below(root, super::folder_of(folder))?, folder.file_name().unwrap_or_default());
    Ok(unlinkat(above.as_fd(), name, AtFlags::REMOVEDIR)?)
}
