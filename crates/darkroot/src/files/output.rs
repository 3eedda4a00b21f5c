//! An output that is open before anything is known of it.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::{Failed, Tree, folder_of, is_stream, system};
use crate::Error;

/// An output that is open and has no name yet, or a hidden one. Dropped before it is written, it is gone.
///
/// A process that gives up its rights before it reads its input opens this first.
pub struct Output {
    /// The folder that it goes to, and the one in which it lies until then.
    folders: [PathBuf; 2],
    to: To,
}

enum To {
    File(system::Unfinished),
    /// Formats go back and forth while they write, which a stream cannot: it gets what a file without a name holds.
    Stream(File),
}

impl Output {
    /// Opens the output for a path, or for standard output. In a tree, folders that are missing are made.
    ///
    /// # Errors
    /// A place where nothing can be written.
    pub fn open(path: &Path, tree: Option<&Tree>) -> io::Result<Self> {
        let folder = folder_of(path).to_owned();
        let scratch = tree.map_or_else(|| folder.clone(), |tree| tree.scratch.clone());
        let to = if is_stream(path) {
            To::Stream(tempfile::tempfile()?)
        } else {
            To::File(system::Place::open(path, tree)?.unfinished()?)
        };
        Ok(Self { folders: [folder, scratch], to })
    }

    /// The folders in which it still must be given its name; none for standard output.
    pub fn folders(&self) -> &[PathBuf] {
        match self.to {
            To::File(_) => &self.folders,
            To::Stream(_) => &[],
        }
    }

    /// Whether it has a hidden name until it gets its own, which is then taken away.
    pub fn is_renamed(&self) -> bool {
        matches!(&self.to, To::File(unfinished) if unfinished.is_named())
    }

    /// The open file, to read what was written to it.
    ///
    /// # Errors
    /// The system has no descriptor left.
    pub fn file(&self) -> io::Result<File> {
        match &self.to {
            To::File(unfinished) => unfinished.file().try_clone(),
            To::Stream(file) => file.try_clone(),
        }
    }

    /// Writes all of these bytes, under the path for which it was opened.
    ///
    /// # Errors
    /// A file that exists and is not to be replaced, or that cannot be written.
    pub(crate) fn write_whole(self, path: &Path, bytes: &[u8], overwrite: bool) -> Result<(), Error> {
        self.write(overwrite, |out| out.write_all(bytes)).map_err(|failed| match failed {
            Failed::Io(e) if e.kind() == io::ErrorKind::AlreadyExists => {
                Error::Exists { path: path.to_owned() }
            }
            Failed::Io(e) | Failed::Other(e) => Error::write(path, e),
        })
    }

    /// Fills it through `fill`, flushes it to the disk and gives it its name. If anything fails, what had that name
    /// stays. Without `overwrite` an existing file is an [`io::ErrorKind::AlreadyExists`], even one that appears
    /// meanwhile. Standard output gets the whole of it at the end.
    pub(crate) fn write<E>(
        self,
        overwrite: bool,
        fill: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
    ) -> Result<(), Failed<E>> {
        match self.to {
            To::File(unfinished) => {
                filled(unfinished.file(), fill)?;
                unfinished.file().sync_all().map_err(Failed::Io)?;
                unfinished.finish(overwrite).map_err(Failed::Io)
            }
            To::Stream(mut file) => {
                filled(&file, fill)?;
                let mut copy = || {
                    file.seek(SeekFrom::Start(0))?;
                    let mut out = io::stdout().lock();
                    io::copy(&mut file, &mut out)?;
                    out.flush()
                };
                copy().map_err(Failed::Io)
            }
        }
    }
}

fn filled<E>(
    file: &File,
    fill: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), Failed<E>> {
    let mut out = BufWriter::with_capacity(1 << 20, file);
    fill(&mut out).map_err(Failed::Other)?;
    out.flush().map_err(Failed::Io)
}
