//! The worker process: takes tasks on stdin, one after the other, and answers on stdout.
//!
//! Raw decoders meet hostile files here and nowhere else in a batch: if one aborts, this process is gone and the
//! parent knows which file it was.

use std::io::{BufRead, Write};
use std::path::Path;
use std::time::Instant;

use super::find::modified;
use super::record::{CameraNames, Identity};
use super::task::{Answer, Develop, Developed, Header, Order, Task, Trouble, TroubleKind};
use super::{hash, need, session, thumbnail};
use crate::job::develop_bytes;
use crate::recipe::{Effective, RecipeError};
use crate::{Error, Format, Job, ProfileStore, Settings, files, naming};

/// Works until stdin ends: the parent is done, or gone.
///
/// # Errors
/// stdin or stdout fails.
pub fn serve(orders: impl BufRead, mut answers: impl Write, store: &ProfileStore) -> std::io::Result<()> {
    system::prepare();
    let mut talk = Talk { orders: orders.lines(), answers: &mut answers };
    let mut threads = Threads::default();
    while let Some(order) = talk.next()? {
        // Go and Drop belong to a task; alone they are left over from one that failed early.
        if let Order::Task(task) = order {
            let answer = perform(*task, &mut talk, &mut threads, store)?;
            talk.say(&answer)?;
        }
    }
    Ok(())
}

/// The line to the parent.
struct Talk<'a, R, W> {
    orders: R,
    answers: &'a mut W,
}

impl<R: Iterator<Item = std::io::Result<String>>, W: Write> Talk<'_, R, W> {
    fn next(&mut self) -> std::io::Result<Option<Order>> {
        let Some(line) = self.orders.next() else { return Ok(None) };
        serde_json::from_str(&line?).map(Some).map_err(std::io::Error::from)
    }

    fn say(&mut self, answer: &Answer) -> std::io::Result<()> {
        serde_json::to_writer(&mut self.answers, answer)?;
        self.answers.write_all(b"\n")?;
        self.answers.flush()
    }
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
}

fn read(path: &Path) -> Result<Input, Trouble> {
    let stat = || std::fs::metadata(path).map_err(|e| file(&Error::read(path, &e)));
    let before = stat()?;
    let bytes = files::read(path).map_err(|e| file(&e))?;
    let after = stat()?;
    let same = before.len() == after.len() && modified(&before) == modified(&after);
    if !same || bytes.len() as u64 != after.len() {
        let error = format!("{}: is still being written; run again when it is complete", path.display());
        return Err(Trouble { kind: TroubleKind::Changing, error });
    }
    let identity = Identity { size: after.len(), modified: modified(&after), sha256: hash::bytes(&bytes) };
    Ok(Input { bytes, identity })
}

fn file(error: &Error) -> Trouble {
    let kind = match error {
        Error::DiskFull { .. } => TroubleKind::DiskFull,
        Error::Write { .. } => TroubleKind::Output,
        _ => TroubleKind::File,
    };
    Trouble { kind, error: error.to_string() }
}

/// One task from its file to the answer.
fn perform<R, W>(
    task: Task,
    talk: &mut Talk<'_, R, W>,
    threads: &mut Threads,
    store: &ProfileStore,
) -> std::io::Result<Answer>
where
    R: Iterator<Item = std::io::Result<String>>,
    W: Write,
{
    let path = task.input().clone();
    let read = match read(&path) {
        Ok(read) => read,
        Err(trouble) => return Ok(Answer::Failed(trouble)),
    };
    let bytes = match needed(&task, &read.bytes) {
        Ok(bytes) => bytes,
        Err(trouble) => return Ok(Answer::Failed(trouble)),
    };
    talk.say(&Answer::Needs { bytes })?;
    let count = match talk.next()? {
        Some(Order::Go { threads }) => threads.max(1),
        Some(_) => return Ok(Answer::Dropped),
        None => return Ok(Answer::Dropped),
    };
    system::limit_memory(bytes);
    let work = || guarded(&path, || execute(task, read, bytes, store));
    let answer = threads.run(count, work);
    system::unlimit_memory();
    Ok(answer.unwrap_or_else(Answer::Failed))
}

/// Bytes that the task takes.
fn needed(task: &Task, bytes: &[u8]) -> Result<u64, Trouble> {
    let len = bytes.len() as u64;
    let path = task.input();
    let samples = || {
        let header = header(path, bytes)?;
        let size = header.counts.size();
        let pixels = size.width as u64 * size.height as u64;
        let float = matches!(header.counts, darkroot_photo::Counts::F32(_));
        Ok::<_, Trouble>((pixels * header.counts.layout().planes() as u64, float, pixels))
    };
    Ok(match task {
        Task::Header { .. } => need::WORKER + 2 * len,
        // A JPEG holds up to some twenty times its size in pixels.
        Task::Thumbnail { .. } => need::WORKER + 40 * len,
        Task::Look { .. } | Task::Calibrate { .. } => {
            let (samples, _, pixels) = samples()?;
            need::chart(len, samples, pixels)
        }
        Task::Develop(task) => {
            let (samples, float, pixels) = samples()?;
            let (settings, format) = settings(task)?;
            need::develop(len, samples, float, pixels, &settings, format)
        }
    })
}

/// What stands at the head of a raw file.
fn header(path: &Path, bytes: &[u8]) -> Result<darkroot_photo::Capture, Trouble> {
    darkroot_raw::header(bytes, &darkroot_raw::Limits::default())
        .map_err(|source| file(&Error::Raw { path: path.to_owned(), source }))
}

/// Runs foreign and own code so that a panic costs one file.
fn guarded(path: &Path, work: impl FnOnce() -> Result<Answer, Trouble>) -> Result<Answer, Trouble> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)).unwrap_or_else(|_| {
        let error = format!(
            "{}: Darkroot failed over it, which is a fault of Darkroot; please report it with this file",
            path.display()
        );
        Err(Trouble { kind: TroubleKind::File, error })
    })
}

fn execute(task: Task, read: Input, needed: u64, store: &ProfileStore) -> Result<Answer, Trouble> {
    match task {
        Task::Header { input } => {
            let capture = header(&input, &read.bytes)?;
            let (camera, date) = naming::header_of(&capture);
            let pixels = capture.counts.size().area() as u64;
            Ok(Answer::Header(Header { camera, date, pixels }))
        }
        Task::Develop(task) => {
            let developed = develop(&task, read, store)?;
            Ok(Answer::Developed(Box::new(Developed { needed, ..developed })))
        }
        Task::Look { input, layout } => {
            let chart =
                session::look(&input, layout.as_deref(), &Settings::default()).map_err(|e| file(&e))?;
            let camera = CameraNames::from(&header(&input, &read.bytes)?.camera);
            Ok(Answer::Looked(session::Sight { camera, chart, source: read.identity }))
        }
        Task::Calibrate { input, layout, reference, light, profile } => {
            drop(read);
            let settings = Settings::default();
            session::calibrate(&input, &layout, reference.as_deref(), &light, &profile, &settings)
                .map(|c| Answer::Calibrated(Box::new(c)))
                .map_err(|e| file(&e))
        }
        Task::Thumbnail { .. } => Ok(Answer::Thumbnail(thumbnail::of_file(&read.bytes))),
    }
}

/// Settings and format of a task. The parent has checked them.
fn settings(task: &Develop) -> Result<(Settings, Format), Trouble> {
    let wrong =
        |e: RecipeError| Trouble { kind: TroubleKind::File, error: format!("{}: {e}", task.input.display()) };
    let effective = Effective::from_texts(&task.texts).map_err(wrong)?;
    let settings = effective.settings().map_err(wrong)?;
    let format = Format::from_extension(&task.format).unwrap_or_else(|| settings.default_format());
    Ok((settings, format))
}

fn develop(task: &Develop, read: Input, store: &ProfileStore) -> Result<Developed, Trouble> {
    let start = Instant::now();
    let (mut settings, format) = settings(task)?;
    settings.format = Some(format);
    settings.overwrite = task.overwrite;
    settings.scratch = Some(task.scratch.clone());
    let header = header(&task.input, &read.bytes)?;
    let names = CameraNames::from(&header.camera);
    let colour = task.session.iter().find(|c| c.camera == names);
    if let Some(colour) = colour {
        colour.apply(&mut settings);
    }
    let Input { bytes, identity } = read;
    let job = Job { input: task.input.clone(), output: task.output.clone() };
    let mut small = None;
    let mut seen = |_: &darkroot_photo::Camera, picture: &darkroot_photo::Picture| {
        if task.thumbnail {
            small = thumbnail::of_picture(picture);
        }
    };
    let report =
        develop_bytes(&job, || Ok(bytes), &settings, store, &|_| {}, &mut seen).map_err(|e| file(&e))?;
    let profile = hash::profile(&settings, &header.camera, store).map_err(|e| file(&e))?;
    let written = written(&task.output).map_err(|e| file(&Error::read(&task.output, &e)))?;
    let mut notes = report.notes;
    if let Some(colour) = colour {
        notes.push(format!("white balance and profile from the chart in {}", colour.chart));
    }
    Ok(Developed {
        source: identity,
        written,
        camera: names,
        profile,
        colours: report.colours,
        width: report.width,
        height: report.height,
        seconds: start.elapsed().as_secs_f64(),
        notes,
        thumbnail: small,
        peak: system::peak(),
        needed: 0,
    })
}

/// What a finished output is.
fn written(path: &Path) -> std::io::Result<Identity> {
    let data = std::fs::metadata(path)?;
    Ok(Identity { size: data.len(), modified: modified(&data), sha256: hash::file(path)? })
}

/// What only some systems have.
mod system {
    /// What a task may take beyond what it said: estimates are not exact, and memory of the last one may linger.
    #[cfg(target_os = "linux")]
    const SLACK: u64 = 256 << 20;

    /// The worker ends with its parent, however that ends, and is the first to go when memory runs out.
    pub(super) fn prepare() {
        #[cfg(target_os = "linux")]
        {
            // Without these the worker still ends when its stdin does.
            let _ = rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL));
            let _ = std::fs::write("/proc/self/oom_score_adj", "800");
        }
    }

    /// No more memory than twice what was said: a decoder that is led astray fails here, not the machine.
    pub(super) fn limit_memory(bytes: u64) {
        #[cfg(target_os = "linux")]
        set(Some(2 * bytes + SLACK));
        #[cfg(not(target_os = "linux"))]
        let _ = bytes;
    }

    pub(super) fn unlimit_memory() {
        #[cfg(target_os = "linux")]
        set(None);
    }

    #[cfg(target_os = "linux")]
    fn set(bytes: Option<u64>) {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
        let maximum = getrlimit(Resource::Data).maximum;
        let current = bytes.or(maximum);
        let _ = setrlimit(Resource::Data, Rlimit { current, maximum });
    }

    /// Most memory that this process held, in bytes; 0 where the system does not tell.
    pub(super) fn peak() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|l| l.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
        kilobytes.unwrap_or(0) * 1024
    }
}
