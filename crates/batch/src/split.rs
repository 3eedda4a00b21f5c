//! Into how many parts the files of an output folder are split now: runs beside each other must agree on it.
//!
//! Two runs of one split share no file. A run over all files beside one over a part, or halves beside thirds, would each
//! find the other's pictures in their way.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::Duration;

use darkroot::files;

use super::facts::FOLDER;
use super::journal::JournalError;

/// A run that begins needs the file to itself for less than this in all.
const TRIES: u32 = 200;
const PAUSE: Duration = Duration::from_millis(10);

/// Held by a run as long as it goes on.
#[derive(Debug)]
pub(crate) struct Split {
    /// Its lock goes when it is closed.
    _file: File,
}

impl Split {
    /// Joins the runs of a folder that are at work.
    ///
    /// # Errors
    /// A run with another split is at work, or the folder cannot be written.
    pub(crate) fn join(out: &Path, parts: u64) -> Result<Self, JournalError> {
        let path = out.join(FOLDER).join("running");
        let io = |reason| JournalError::Io { path: path.clone(), doing: "made", reason };
        let mut file = files::open_below(out, &path).map_err(io)?;
        for _ in 0..TRIES {
            // Whoever is alone says which split it is; the others see whether it is theirs.
            match file.try_lock() {
                Ok(()) => write(&mut file, parts).map_err(io)?,
                Err(TryLockError::WouldBlock) => {}
                // Network disks without locks: runs beside each other would cost work, not outputs.
                Err(TryLockError::Error(_)) => return Ok(Self { _file: file }),
            }
            if file.try_lock_shared().is_ok() {
                return match read(&mut file).map_err(io)? {
                    Some(running) if running != parts => Err(JournalError::OtherSplit { path, running }),
                    _ => Ok(Self { _file: file }),
                };
            }
            // Another run that begins has it to itself for a moment.
            std::thread::sleep(PAUSE);
        }
        Err(JournalError::Locked { path })
    }
}

fn write(file: &mut File, parts: u64) -> io::Result<()> {
    file.set_len(0)?;
    file.write_all(parts.to_string().as_bytes())
}

fn read(file: &mut File) -> io::Result<Option<u64>> {
    let mut text = String::new();
    file.seek(SeekFrom::Start(0))?;
    file.take(20).read_to_string(&mut text)?;
    Ok(text.trim().parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_beside_each_other_have_one_split() {
        let out = tempfile::tempdir().unwrap();
        let join = |parts| Split::join(out.path(), parts);
        for (first, other) in [(1, 2), (2, 1), (2, 3)] {
            let one = join(first).unwrap();
            let beside = join(first).unwrap();
            let fault = join(other).unwrap_err();
            assert!(matches!(fault, JournalError::OtherSplit { running, .. } if running == first), "{fault}");
            drop(one);
            assert!(join(other).is_err());
            drop(beside);
        }
        assert!(join(7).is_ok());
    }

    #[test]
    fn runs_of_one_split_may_begin_at_once() {
        let out = tempfile::tempdir().unwrap();
        let folder = out.path();
        std::thread::scope(|scope| {
            let begin = || scope.spawn(move || Split::join(folder, 8).map(|_| std::thread::sleep(PAUSE)));
            let all: Vec<_> = (0..8).map(|_| begin()).collect();
            assert!(all.into_iter().all(|run| run.join().unwrap().is_ok()));
        });
    }
}
