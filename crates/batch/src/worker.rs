//! A worker: takes tasks one after the other and answers.
//!
//! Raw decoders meet hostile files here and nowhere else in a batch. If one aborts in a worker process, that process
//! is gone and the parent knows which file it was.

use std::error::Error as StdError;
use std::io::{BufRead, Write};
use std::path::Path;

use darkroot::{Error, ProfileStore, Settings, files};

use super::develop_task::{develop, settings};
use super::facts::{CameraNames, ChartLook, Identity, modified};
use super::failure::FailureKind;
use super::raw_head::RawHead;
use super::task::{Answer, Developed, Fault, Order, Task, TaskError};
use super::{chart_shot, hash, need, process_limits, thumbnail};
use darkroot::shown;

/// Works as a worker process until stdin ends: the parent is done, or gone. `words` words errors for people;
/// `&|error| error.to_string()` gives their own text.
///
/// # Errors
/// stdin or stdout fails.
pub fn serve(
    orders: impl BufRead,
    answers: impl Write,
    store: &ProfileStore,
    words: &dyn Fn(&(dyn StdError + 'static)) -> String,
) -> std::io::Result<()> {
    process_limits::prepare();
    let mut connection = JsonLines { orders: orders.lines(), answers };
    work_until_end(&mut connection, &Host { store, words, own_process: true })
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

    fn error(&self, error: &Error) -> TaskError {
        let kind = match error {
            Error::DiskFull { .. } => FailureKind::DiskFull,
            Error::Write { .. } => FailureKind::Output,
            _ => FailureKind::File,
        };
        TaskError { kind, words: (self.words)(error) }
    }
}

/// Takes tasks until there are no more.
///
/// # Errors
/// The connection fails.
pub(crate) fn work_until_end(connection: &mut dyn Connection, host: &Host<'_>) -> std::io::Result<()> {
    let mut threads = Threads::default();
    while let Some(order) = connection.next()? {
        // Go and Drop belong to a task; alone they are left over from one that failed early.
        if let Order::Task(task) = order {
            let answer = perform(*task, connection, &mut threads, host)?;
            connection.say(answer)?;
        }
    }
    Ok(())
}

/// The pool of the last task, kept for the next one of the same size.
#[derive(Default)]
struct Threads(Option<(usize, rayon::ThreadPool)>);

impl Threads {
    /// Runs with so many threads; where the system has none to give, in this one.
    fn run<T: Send>(&mut self, count: usize, work: impl FnOnce() -> T + Send) -> T {
        if self.0.as_ref().is_none_or(|(n, _)| *n != count) {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
            self.0 = pool.ok().map(|pool| (count, pool));
        }
        match &self.0 {
            Some((_, pool)) => pool.install(work),
            None => work(),
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

fn read(task: &Task, host: &Host<'_>) -> Result<Input, TaskError> {
    let path = task.input();
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
        Task::Thumbnail { .. } => None,
        _ => Some(RawHead::of(path, &bytes).map_err(|e| host.error(&e))?),
    };
    Ok(Input { bytes, identity, head })
}

fn changing(path: &Path) -> TaskError {
    let words = format!("{}: is still being written; run again when it is complete", shown(path));
    TaskError { kind: FailureKind::Changing, words }
}

/// One task from its file to the answer.
fn perform(
    task: Task,
    connection: &mut dyn Connection,
    threads: &mut Threads,
    host: &Host<'_>,
) -> std::io::Result<Answer> {
    let path = task.input().clone();
    let ready = guarded(&path, || {
        let input = read(&task, host)?;
        let bytes = needed(&task, &input)?;
        Ok((input, bytes))
    });
    let (input, bytes) = match ready {
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
    let result = threads.run(count, || guarded_result(&path, || execute(task, input, bytes, store)));
    host.unlimit_memory();
    Ok(result.unwrap_or_else(|error| {
        Answer::Failed(match error {
            Fault::Task(error) => error,
            Fault::Library(error) => host.error(&error),
        })
    }))
}

/// Bytes that the task takes.
fn needed(task: &Task, input: &Input) -> Result<u64, TaskError> {
    let len = input.bytes.len() as u64;
    let head = input.head.as_ref();
    let (samples, float, pixels) = head.map_or((0, false, 0), |h| (h.samples, h.float, h.header.pixels));
    Ok(match task {
        Task::Header { .. } => need::head(len),
        // A JPEG holds up to some twenty times its size in pixels.
        Task::Thumbnail { .. } => need::WORKER + 40 * len,
        Task::Look { .. } | Task::Calibrate(_) => need::chart(len, samples, pixels),
        Task::Develop(task) => {
            let (settings, format) = settings(task)?;
            need::develop(len, samples, float, pixels, &settings, format)
        }
    })
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

fn execute(task: Task, input: Input, needed: u64, store: &ProfileStore) -> Result<Answer, Fault> {
    let path = task.input().clone();
    let head = input.head.clone().unwrap_or_default();
    match task {
        Task::Header { .. } => Ok(Answer::Header(head.header)),
        Task::Develop(task) => {
            let developed = develop(&task, input.bytes, input.identity, &head.camera, store)?;
            Ok(Answer::Developed(Box::new(Developed { needed, ..developed })))
        }
        Task::Look { layout, .. } => {
            let sha256 = input.identity.sha256.clone();
            let look = || chart_shot::look(&path, layout.as_deref(), &Settings::default());
            let chart = with_same_content(&path, &sha256, look)?;
            let camera = CameraNames::from(&head.camera);
            Ok(Answer::Looked(ChartLook { camera, chart, source: input.identity }))
        }
        Task::Calibrate(task) => {
            drop(input);
            let calibrate = || chart_shot::calibrate(&task, &Settings::default());
            let colour = with_same_content(&path, &task.sha256, calibrate)?;
            Ok(Answer::Calibrated(Box::new(colour)))
        }
        Task::Thumbnail { .. } => Ok(Answer::Thumbnail(thumbnail::of_file(&input.bytes))),
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
