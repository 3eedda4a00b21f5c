//! A worker: takes a task and answers. A process does one file, so that what one does to it is nothing to the next.
//!
//! Raw decoders meet hostile files here and nowhere else in a batch. If one aborts in a worker process, that process
//! is gone and the parent knows which file it was.

use std::error::Error as StdError;
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};

use darkroot::files::{self, Output};
use darkroot::{Error, ProfileStore, Settings};
use darkroot_sandbox::{Breach, Reach};

use super::develop_task::{Opened, develop};
use super::facts::{CameraNames, ChartLook, Identity, modified};
use super::failure::FailureKind;
use super::raw_head::RawHead;
use super::task::{Answer, Calibrate, Developed, Fault, Order, Task, TaskError};
use super::{chart_shot, develop_task, hash, need, process_limits, reach, thumbnail};
use darkroot::shown;

/// Works as a worker process: for one file, then it ends. `words` words errors for people;
/// `&|error| error.to_string()` gives their own text.
///
/// With `sandbox`, everything but this file and its output is given up before a byte of it is read, as far as the system
/// offers that; see `darkroot_sandbox`. The process must have no other threads then.
///
/// # Errors
/// stdin or stdout fails.
pub fn serve(
    orders: impl BufRead,
    answers: impl Write,
    store: &ProfileStore,
    words: &dyn Fn(&(dyn StdError + 'static)) -> String,
    sandbox: bool,
) -> std::io::Result<()> {
    process_limits::prepare();
    let mut connection = JsonLines { orders: orders.lines(), answers };
    work(&mut connection, &Host { store, words, own_process: true, sandbox }).map(drop)
}

/// The line to the crew.
pub(crate) trait Connection {
    /// The next order; none when no more will come.
    fn next(&mut self) -> std::io::Result<Option<Order>>;
    fn say(&mut self, answer: Answer) -> std::io::Result<()>;
}

/// A JSON object a line, each way.
struct JsonLines<R, W> {
    orders: R,
    answers: W,
}

impl<R: Iterator<Item = std::io::Result<String>>, W: Write> Connection for JsonLines<R, W> {
    fn next(&mut self) -> std::io::Result<Option<Order>> {
        let Some(line) = self.orders.next() else { return Ok(None) };
        serde_json::from_str(&line?).map(Some).map_err(std::io::Error::from)
    }

    fn say(&mut self, answer: Answer) -> std::io::Result<()> {
        serde_json::to_writer(&mut self.answers, &answer)?;
        self.answers.write_all(b"\n")?;
        self.answers.flush()
    }
}

/// What a worker works with.
pub(crate) struct Host<'a> {
    pub(crate) store: &'a ProfileStore,
    /// Words an error.
    pub(crate) words: &'a dyn Fn(&(dyn StdError + 'static)) -> String,
    /// Whether the process is the worker's own, so that its memory can be limited.
    pub(crate) own_process: bool,
    /// Whether it gives up what a task does not need.
    pub(crate) sandbox: bool,
}

impl Host<'_> {
    /// No more memory than that, where the process is the worker's own.
    fn limit_memory(&self, bytes: u64) {
        if self.own_process {
            process_limits::limit_memory(bytes);
        }
    }

    fn unlimit_memory(&self) {
        if self.own_process {
            process_limits::unlimit_memory();
        }
    }

    /// Gives up what the task does not need.
    fn confine(&self, path: &Path, ready: &Ready) -> Result<(), TaskError> {
        if !self.sandbox {
            return Ok(());
        }
        // The parent tells what the system does not offer.
        darkroot_sandbox::confine(&ready.reach(), Breach::Ends).map(drop).map_err(|error| TaskError {
            kind: FailureKind::File,
            words: format!("{}: {}", shown(path), (self.words)(&error)),
        })
    }

    fn fault(&self, fault: Fault) -> TaskError {
        match fault {
            Fault::Task(error) => error,
            Fault::Library(error) => self.error(&error),
        }
    }

    fn error(&self, error: &Error) -> TaskError {
        let kind = match error {
            Error::DiskFull { .. } => FailureKind::DiskFull,
            Error::Write { .. } => FailureKind::Output,
            _ => FailureKind::File,
        };
        TaskError { kind, words: (self.words)(error) }
    }
}

/// Takes the next task to its end. Says whether there was one.
///
/// # Errors
/// The connection fails.
pub(crate) fn work(connection: &mut dyn Connection, host: &Host<'_>) -> std::io::Result<bool> {
    while let Some(order) = connection.next()? {
        // Go and Drop belong to a task; alone they are left over from one that failed early.
        if let Order::Task(task) = order {
            let answer = perform(*task, connection, host)?;
            connection.say(answer)?;
            return Ok(true);
        }
    }
    Ok(false)
}

/// Runs with so many threads; where the system has none to give, in this one.
fn in_threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(count).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// A task with everything open that it writes.
enum Ready {
    Header(PathBuf),
    Develop(Box<Opened>),
    Look { input: PathBuf, layout: Option<String> },
    Calibrate(Box<Calibrate>, Output),
    Thumbnail(PathBuf),
}

impl Ready {
    fn of(task: Task) -> Result<Self, Fault> {
        Ok(match task {
            Task::Header { input } => Self::Header(input),
            Task::Develop(task) => Self::Develop(Box::new(develop_task::open(task)?)),
            Task::Look { input, layout } => Self::Look { input, layout },
            Task::Calibrate(task) => {
                let output = chart_shot::open(&task)?;
                Self::Calibrate(Box::new(task), output)
            }
            Task::Thumbnail { picture } => Self::Thumbnail(picture),
        })
    }

    /// What it still needs.
    fn reach(&self) -> Reach {
        match self {
            Self::Header(input) | Self::Thumbnail(input) => reach::reading(input),
            Self::Develop(opened) => reach::developing(opened),
            Self::Look { input, layout } => reach::looking(input, layout.as_deref()),
            Self::Calibrate(task, output) => reach::calibrating(task, output),
        }
    }
}

/// A file as it was read.
struct Input {
    bytes: Vec<u8>,
    identity: Identity,
    /// What stands at its head; none for pictures, which are no raw files.
    head: Option<RawHead>,
}

fn read(path: &Path, task: &Ready, host: &Host<'_>) -> Result<Input, TaskError> {
    let stat = || std::fs::metadata(path).map_err(|e| host.error(&Error::read(path, e)));
    let before = stat()?;
    // Heads are read by foreign code too.
    host.limit_memory(need::head(before.len()));
    let bytes = files::read(path).map_err(|e| host.error(&e))?;
    let after = stat()?;
    let same = before.len() == after.len() && modified(&before) == modified(&after);
    if !same || bytes.len() as u64 != after.len() {
        return Err(changing(path));
    }
    let identity = Identity { size: after.len(), modified: modified(&after), sha256: hash::bytes(&bytes) };
    let head = match task {
        Ready::Thumbnail(_) => None,
        _ => Some(RawHead::of(path, &bytes).map_err(|e| host.error(&e))?),
    };
    Ok(Input { bytes, identity, head })
}

fn changing(path: &Path) -> TaskError {
    let words = format!("{}: is still being written; run again when it is complete", shown(path));
    TaskError { kind: FailureKind::Changing, words }
}

/// One task from its file to the answer.
fn perform(task: Task, connection: &mut dyn Connection, host: &Host<'_>) -> std::io::Result<Answer> {
    let path = task.input().clone();
    let ready = guarded(&path, || {
        let task = Ready::of(task).map_err(|fault| host.fault(fault))?;
        host.confine(&path, &task)?;
        let input = read(&path, &task, host)?;
        let bytes = needed(&task, &input);
        Ok((task, input, bytes))
    });
    let (task, input, bytes) = match ready {
        Ok(ready) => ready,
        Err(error) => {
            host.unlimit_memory();
            return Ok(Answer::Failed(error));
        }
    };
    connection.say(Answer::Needs { bytes })?;
    let count = match connection.next()? {
        Some(Order::Go { threads }) => threads.max(1),
        Some(_) | None => {
            host.unlimit_memory();
            return Ok(Answer::Dropped);
        }
    };
    host.limit_memory(bytes);
    // Only the profiles go to other threads: words may be anybody's function and stay in this one.
    let store = host.store;
    let result = in_threads(count, || guarded_result(&path, || execute(&path, task, input, bytes, store)));
    host.unlimit_memory();
    Ok(result.unwrap_or_else(|fault| Answer::Failed(host.fault(fault))))
}

/// Bytes that the task takes.
fn needed(task: &Ready, input: &Input) -> u64 {
    let len = input.bytes.len() as u64;
    let head = input.head.as_ref();
    let (samples, float, pixels) = head.map_or((0, false, 0), |h| (h.samples, h.float, h.header.pixels));
    match task {
        Ready::Header(_) => need::head(len),
        // A JPEG holds up to some twenty times its size in pixels.
        Ready::Thumbnail(_) => need::WORKER + 40 * len,
        Ready::Look { .. } | Ready::Calibrate(..) => need::chart(len, samples, pixels),
        Ready::Develop(opened) => need::develop(len, samples, float, pixels, &opened.settings, opened.format),
    }
}

/// Runs foreign and own code so that a panic costs one file.
fn guarded<T>(path: &Path, work: impl FnOnce() -> Result<T, TaskError>) -> Result<T, TaskError> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)).unwrap_or_else(|_| Err(panicked(path)))
}

/// As [`guarded`], for faults.
fn guarded_result<T>(path: &Path, work: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err(Fault::Task(panicked(path))))
}

fn panicked(path: &Path) -> TaskError {
    let words = format!(
        "{}: Darkroot failed over it, which is a fault of Darkroot; please report it with this file",
        shown(path)
    );
    TaskError { kind: FailureKind::File, words }
}

fn execute(
    path: &Path,
    task: Ready,
    input: Input,
    needed: u64,
    store: &ProfileStore,
) -> Result<Answer, Fault> {
    let head = input.head.clone().unwrap_or_default();
    match task {
        Ready::Header(_) => Ok(Answer::Header(head.header)),
        Ready::Develop(opened) => {
            let developed = develop(*opened, input.bytes, input.identity, &head.camera, store)?;
            Ok(Answer::Developed(Box::new(Developed { needed, ..developed })))
        }
        Ready::Look { layout, .. } => {
            let sha256 = input.identity.sha256.clone();
            let look = || chart_shot::look(path, layout.as_deref(), &Settings::default());
            let chart = with_same_content(path, &sha256, look)?;
            let camera = CameraNames::from(&head.camera);
            Ok(Answer::Looked(ChartLook { camera, chart, source: input.identity }))
        }
        Ready::Calibrate(task, output) => {
            drop(input);
            let calibrate = || chart_shot::calibrate(output, &task, &Settings::default());
            let colour = with_same_content(path, &task.sha256, calibrate)?;
            Ok(Answer::Calibrated(Box::new(colour)))
        }
        Ready::Thumbnail(_) => Ok(Answer::Thumbnail(thumbnail::of_file(&input.bytes))),
    }
}

/// Runs what reads a file by its path, and checks that it still has the content that is recorded.
fn with_same_content<T>(
    path: &Path,
    sha256: &str,
    work: impl FnOnce() -> Result<T, Error>,
) -> Result<T, Fault> {
    let result = work()?;
    let now = hash::file(path).map_err(|e| Error::read(path, e))?;
    if now == sha256 { Ok(result) } else { Err(Fault::Task(changing(path))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_changes_while_it_is_looked_at_is_not_recorded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.nef");
        std::fs::write(&path, b"first").unwrap();
        let first = hash::bytes(b"first");
        assert!(matches!(with_same_content(&path, &first, || Ok(7)), Ok(7)));
        let replaced = || {
            std::fs::write(&path, b"other").unwrap();
            Ok(7)
        };
        let result = with_same_content(&path, &first, replaced);
        assert!(matches!(result, Err(Fault::Task(TaskError { kind: FailureKind::Changing, .. }))));
        // Now it is another one from the beginning.
        assert!(with_same_content(&path, &first, || Ok(7)).is_err());
    }

    #[test]
    fn a_panic_is_an_error_that_names_the_file() {
        let result: Result<(), TaskError> = guarded(Path::new("a.nef"), || panic!("a decoder"));
        assert!(result.unwrap_err().words.starts_with("a.nef: "));
    }
}
