//! The journal: what a batch did, line by line, so that the next run knows.
//!
//! A text file of JSON, a record a line, only ever added to and flushed to the disk after each addition. Every line
//! ends with a checksum of itself. A power cut can tear the last line; a torn or damaged line is left where it is and
//! skipped, and counts as never written. The first line names the format and its version.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use darkroot::{files, shown};
use sha2::{Digest, Sha256};

use super::facts::FOLDER;
use super::history::History;
use super::record::Record;

/// Version of the format that this program writes and reads.
const VERSION: u32 = 1;

/// Why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// It cannot be read or written.
    #[error("{path}: the journal cannot be {doing}: {reason}", path = shown(path))]
    Io {
        /// The journal.
        path: PathBuf,
        /// "read", "made", "written".
        doing: &'static str,
        /// What the system says.
        reason: io::Error,
    },
    /// Another run has it open.
    #[error("{path}: another run writes to this folder", path = shown(path))]
    Locked {
        /// The journal.
        path: PathBuf,
    },
    /// Another run shares the folder's files out in another way.
    #[error("{path}: {} writes to this folder", others(*running), path = shown(path))]
    OtherSplit {
        /// The file that says so.
        path: PathBuf,
        /// Parts of the run that is at work.
        running: u64,
    },
    /// It is of another program or a later version.
    #[error(
        "{path}: is no journal that this version reads ({cause}); use the Darkroot that wrote it, or choose another \
         output folder",
        path = shown(path)
    )]
    Foreign {
        /// The journal.
        path: PathBuf,
        /// What it is.
        cause: ForeignJournal,
    },
}

fn others(parts: u64) -> String {
    if parts == 1 { "a run over all files".to_owned() } else { format!("a run over one of {parts} parts") }
}

/// Why a file is no journal that this version reads.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForeignJournal {
    /// A later version wrote it.
    #[error("version {version} by darkroot {program}")]
    Later {
        /// Version of the format.
        version: u32,
        /// Version of Darkroot.
        program: String,
    },
    /// A whole line that this version does not know.
    #[error("{0}")]
    Line(serde_json::Error),
    /// Not one line of it is one of a journal.
    #[error("no line of it is one")]
    NoLine,
}

/// An open journal; no other process can open it meanwhile.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens or begins the journal of an output folder, and tells what is in it. `shard` is "" or "-2-of-8".
    ///
    /// # Errors
    /// A folder that cannot be written, a journal in use by another process or of a later version.
    pub fn open(out: &Path, shard: &str) -> Result<(Self, History), JournalError> {
        let folder = out.join(FOLDER);
        let path = folder.join(file_name(shard));
        let io = |doing| {
            let path = path.clone();
            move |reason| JournalError::Io { path, doing, reason }
        };
        let file = files::open_below(out, &path).map_err(io("made"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(JournalError::Locked { path }),
            // Network disks without locks: two runs at once would cost work, not outputs.
            Err(TryLockError::Error(_)) => {}
        }
        let mut text = Vec::new();
        (&file).read_to_end(&mut text).map_err(io("read"))?;
        let (history, any) = parse(&path, &text)?;
        let mut journal = Self { path: path.clone(), file };
        if text.last().is_some_and(|&b| b != b'\n') {
            // A torn line gets its end, so that the next one stands alone.
            journal.file.write_all(b"\n").map_err(io("written"))?;
        }
        if !any {
            let program = darkroot::VERSION.to_owned();
            journal.append(&[Record::Journal { version: VERSION, program }])?;
            darkroot::files::sync_folder(&folder);
        }
        Ok((journal, history))
    }

    /// Adds records; they are on the disk when this returns.
    ///
    /// # Errors
    /// A disk that is full or gone.
    pub fn append(&mut self, records: &[Record]) -> Result<(), JournalError> {
        let mut lines = String::new();
        for record in records {
            lines += &line(record);
        }
        let write = || -> io::Result<()> {
            self.file.write_all(lines.as_bytes())?;
            self.file.sync_data()
        };
        let mut write = write;
        write().map_err(|reason| JournalError::Io { path: self.path.clone(), doing: "written", reason })
    }

    /// Whether this is the journal of that file name.
    pub(crate) fn is_named(&self, name: &str) -> bool {
        self.path.file_name().is_some_and(|n| n == name)
    }

    /// Whether the journal's file is still where it was made: else its folder was removed or unmounted.
    pub fn is_there(&self) -> bool {
        self.path.is_file()
    }
}

/// What all journals of an output folder say together, without opening any for writing: journal by journal and
/// merged.
///
/// # Errors
/// Journals that cannot be read or are of a later version.
pub fn read_all(out: &Path) -> Result<Vec<(String, History)>, JournalError> {
    let folder = out.join(FOLDER);
    let io = |path: &Path| {
        let path = path.to_owned();
        move |reason| JournalError::Io { path, doing: "read", reason }
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(io(&folder))? {
        let path = entry.map_err(io(&folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.starts_with("journal") && name.ends_with(".jsonl") {
            let text = read(&path)?;
            found.push((name, parse(&path, &text)?.0));
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}

/// What all journals of an output folder know, added up; nothing where there is no journal.
///
/// # Errors
/// As [`read_all`].
pub fn read_merged(out: &Path) -> Result<History, JournalError> {
    let mut all = History::default();
    if out.join(FOLDER).is_dir() {
        for (_, history) in read_all(out)? {
            all.merge(history);
        }
    }
    Ok(all)
}

/// The whole of a journal.
fn read(path: &Path) -> Result<Vec<u8>, JournalError> {
    let attempt = || {
        let mut text = Vec::new();
        files::open(path)?.read_to_end(&mut text).map(|_| text)
    };
    attempt().map_err(|reason| JournalError::Io { path: path.to_owned(), doing: "read", reason })
}

fn file_name(shard: &str) -> String {
    format!("journal{shard}.jsonl")
}

/// The record as a line with its checksum: the JSON object has one more member, `sum`, at its end.
fn line(record: &Record) -> String {
    // Records are plain data: they always serialise.
    let json = serde_json::to_string(record).unwrap_or_default();
    let body = json.strip_suffix('}').unwrap_or(&json);
    format!("{body},\"sum\":\"{}\"}}\n", sum(body))
}

fn sum(body: &str) -> String {
    Sha256::digest(body.as_bytes()).iter().take(4).map(|b| format!("{b:02x}")).collect()
}

/// The record of a line; `None` for a torn or damaged one.
fn record(line: &str) -> Option<serde_json::Result<Record>> {
    let (body, tail) = line.rsplit_once(",\"sum\":\"")?;
    let stated = tail.strip_suffix("\"}")?;
    if stated != sum(body) {
        return None;
    }
    // A whole line that we do not understand is from a later version.
    Some(serde_json::from_str(&format!("{body}}}")))
}

/// Reads all lines; the flag says whether there was any sound one.
fn parse(path: &Path, text: &[u8]) -> Result<(History, bool), JournalError> {
    let foreign = |cause| JournalError::Foreign { path: path.to_owned(), cause };
    let mut history = History::default();
    let mut any = false;
    for bytes in text.split(|&b| b == b'\n').filter(|l| !l.is_empty()) {
        let parsed = std::str::from_utf8(bytes).ok().and_then(record);
        let Some(record) = parsed else {
            history.damaged += 1;
            continue;
        };
        let record = record.map_err(|e| foreign(ForeignJournal::Line(e)))?;
        if let Record::Journal { version, program } = &record
            && *version > VERSION
        {
            return Err(foreign(ForeignJournal::Later { version: *version, program: program.clone() }));
        }
        any = true;
        history.add(record);
    }
    if !any && history.damaged > 1 {
        return Err(foreign(ForeignJournal::NoLine));
    }
    Ok((history, any))
}

/// Now, RFC 3339, UTC, to the second.
pub(crate) fn now() -> String {
    humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::{CameraNames, Identity};
    use crate::record::Done;

    fn done(output: &str) -> Record {
        let identity = Identity { size: 3, modified: 1_700_000_000_123_456_789, sha256: "ab".into() };
        Record::Done(Box::new(Done {
            input: "a \"b\".nef".into(),
            output: output.into(),
            source: identity.clone(),
            settings: "cd".into(),
            camera: CameraNames::default(),
            profile: String::new(),
            files: String::new(),
            written: identity,
            width: 6,
            height: 4,
            seconds: 0.25,
            notes: vec!["a\nb".into()],
            number: Some(7),
            program: "0".into(),
            at: now(),
        }))
    }

    #[test]
    fn what_is_written_is_read_again() {
        let out = tempfile::tempdir().unwrap();
        let (mut journal, history) = Journal::open(out.path(), "").unwrap();
        assert_eq!(history, History::default());
        let Record::Done(expected) = done("x.jpg") else { unreachable!() };
        journal.append(&[done("x.jpg"), done("y.jpg")]).unwrap();
        drop(journal);
        let (_journal, history) = Journal::open(out.path(), "").unwrap();
        assert_eq!(history.outputs["x.jpg"].done.as_ref(), Some(&*expected));
        assert_eq!((history.outputs.len(), history.damaged), (2, 0));
    }

    #[test]
    fn a_journal_cut_anywhere_loses_its_last_line_at_most() {
        let out = tempfile::tempdir().unwrap();
        let (mut journal, _) = Journal::open(out.path(), "").unwrap();
        for i in 0..5 {
            journal.append(&[done(&format!("{i}.jpg"))]).unwrap();
        }
        drop(journal);
        let path = out.path().join(FOLDER).join("journal.jsonl");
        let whole = std::fs::read(&path).unwrap();
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let complete = whole[..cut].iter().filter(|&&b| b == b'\n').count().saturating_sub(1);
            let (mut journal, history) = Journal::open(out.path(), "").unwrap();
            // The line may be whole but for its end.
            assert!(history.outputs.len() - complete <= 1 && history.damaged <= 1, "cut at {cut}");
            journal.append(&[done("next.jpg")]).unwrap();
            drop(journal);
            let (_journal, history) = Journal::open(out.path(), "").unwrap();
            assert!(history.outputs.contains_key("next.jpg"), "cut at {cut}");
        }
    }

    #[test]
    fn a_line_that_rotted_is_skipped_and_counted() {
        let out = tempfile::tempdir().unwrap();
        let (mut journal, _) = Journal::open(out.path(), "").unwrap();
        journal.append(&[done("x.jpg"), done("y.jpg")]).unwrap();
        drop(journal);
        let path = out.path().join(FOLDER).join("journal.jsonl");
        let text = std::fs::read_to_string(&path).unwrap().replace("x.jpg", "z.jpg");
        std::fs::write(&path, text).unwrap();
        let (_journal, history) = Journal::open(out.path(), "").unwrap();
        assert_eq!((history.outputs.len(), history.damaged), (1, 1));
    }

    #[test]
    fn two_runs_cannot_write_one_journal_and_later_versions_are_refused() {
        let out = tempfile::tempdir().unwrap();
        let (journal, _) = Journal::open(out.path(), "").unwrap();
        assert!(matches!(Journal::open(out.path(), ""), Err(JournalError::Locked { .. })));
        assert!(Journal::open(out.path(), "-1-of-2").is_ok());
        drop(journal);
        let path = out.path().join(FOLDER).join("journal.jsonl");
        let later = line(&Record::Journal { version: VERSION + 1, program: "9.0".into() });
        std::fs::write(&path, later).unwrap();
        let error = Journal::open(out.path(), "").unwrap_err().to_string();
        assert!(error.contains("9.0"), "{error}");
    }
}
