//! Running a plan: events as files come and go, the journal, and what stops it all.

use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::crew::{Crew, CrewOptions, Moment, Next, Work};
use super::find::{Source, Sources, modified};
use super::history::History;
use super::journal::{self, Journal, JournalError};
use super::outcome::{BatchError, Event, Summary};
use super::plan::{Item, Plan, PlanOptions, Recipes, State, Why, plan};
use super::record::{Done, Failed, Record};
use super::session::{Lookout, News, Session};
use super::stop::Stop;
use super::task::{Answer, Develop, Developed, Task, Trouble, TroubleKind};
use super::{Header, names};
use crate::{ProfileStore, VERSION};

/// How often a file that is still being written is tried again, and after what pause.
const TRIES: usize = 5;
const PAUSE: Duration = Duration::from_secs(2);
/// A damaged file that was changed less than this ago may be one that is still being written.
const FRESH: Duration = Duration::from_secs(3);

/// An output folder with its journal and its workers.
pub struct Batch {
    out: PathBuf,
    scratch: PathBuf,
    journal: Journal,
    history: History,
    store: ProfileStore,
    pub(super) crew: Crew,
    thumbnails: bool,
    /// Whether files may vanish before their turn comes.
    pub(super) fleeting: bool,
}

impl Batch {
    /// Opens the output folder: makes it, its journal, and clears away what an interrupted run left unfinished.
    ///
    /// # Errors
    /// A folder that cannot be written, or another run at work in it.
    pub fn open(options: &PlanOptions, crew: CrewOptions, store: ProfileStore) -> Result<Self, BatchError> {
        let out = options.out.clone();
        std::fs::create_dir_all(&out).map_err(|reason| BatchError::Out { path: out.clone(), reason })?;
        let suffix = options.shard.suffix();
        let (journal, own) = Journal::open(&out, &suffix)?;
        let mut history = own;
        for (name, other) in journal::read_all(&out)? {
            if !journal.is_named(&name) {
                history.merge(other);
            }
        }
        let scratch = out.join(journal::FOLDER).join(format!("unfinished{suffix}"));
        let batch = Self {
            out,
            scratch,
            journal,
            history,
            store,
            crew: Crew::new(crew),
            thumbnails: false,
            fleeting: false,
        };
        batch.clear_scratch();
        Ok(batch)
    }

    /// Whether small pictures of outputs are made along the way, for a contact sheet.
    pub fn with_thumbnails(mut self, yes: bool) -> Self {
        self.thumbnails = yes;
        self
    }

    /// What was done before.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// What is left of a run that was ended at once is no output.
    fn clear_scratch(&self) {
        // What cannot be removed does no harm there.
        let _ = std::fs::remove_dir_all(&self.scratch);
    }

    /// Decides about every file; workers read headers where names need them.
    ///
    /// # Errors
    /// Wrong settings, wrong names, names that collide.
    pub fn plan(
        &mut self,
        sources: Sources,
        options: &PlanOptions,
        recipes: &mut Recipes,
        session: &Session,
        stop: &Stop,
    ) -> Result<Plan, BatchError> {
        let Self { crew, history, store, .. } = self;
        let mut headers = |files: &[Source]| read_headers(crew, files, stop);
        let session = |source: &Source| session.colours_of(&source.key);
        Ok(plan(sources, options, recipes, history, store, &mut headers, &session)?)
    }

    /// Looks for charts in the files, or in the one named, and makes a profile for each folder and camera. `say` hears in
    /// words what was found.
    ///
    /// # Errors
    /// A chart shot that was named and shows none.
    pub fn session(
        &mut self,
        sources: &Sources,
        chart: &super::ChartShot,
        stop: &Stop,
        say: &mut dyn FnMut(&str),
    ) -> Result<Session, BatchError> {
        let folder = self.out.join(journal::FOLDER).join("session");
        let Self { crew, history, journal, .. } = self;
        let known = history.charts.clone();
        let mut note = |news: News| {
            let record = match news {
                News::Looked(looked) => Record::Looked(looked),
                News::Calibrated(calibrated) => Record::Calibrated(calibrated),
            };
            journal.append(std::slice::from_ref(&record))?;
            history.add(record);
            Ok(())
        };
        let place = &folder;
        Lookout { crew, chart, place, known: &known, note: &mut note, stop }.find(sources, say)
    }

    /// Runs a plan.
    ///
    /// # Errors
    /// Workers that cannot be started. Everything else is an event or stands in the summary.
    pub fn run(
        &mut self,
        plan: &Plan,
        stop: &Stop,
        hear: &mut dyn FnMut(Event<'_>),
    ) -> Result<Summary, BatchError> {
        let start = Instant::now();
        let mut run = Run {
            plan,
            out: &self.out,
            journal: &mut self.journal,
            history: &mut self.history,
            summary: Summary::default(),
            tries: HashMap::new(),
            fleeting: self.fleeting,
            hear,
        };
        let mut queue = VecDeque::new();
        for (id, item) in plan.items.iter().enumerate() {
            match &item.state {
                State::Done(_) => run.summary.skipped += 1,
                State::Conflict(reason) => {
                    run.summary.failed += 1;
                    (run.hear)(Event::Failed { item, error: reason });
                }
                State::Todo(why) => {
                    let task = develop_task(item, *why, &self.out, &self.scratch, self.thumbnails);
                    let size = item.source.size;
                    queue.push_back(Work::new(id, Task::Develop(task), size));
                }
            }
        }
        let todo = queue.len();
        if todo > 0 {
            std::fs::create_dir_all(&self.scratch)
                .map_err(|reason| BatchError::Out { path: self.out.clone(), reason })?;
        }
        let before = (run.summary.done, run.summary.failed);
        self.crew
            .perform(queue, stop, &mut |work, moment| run.moment(work, moment))
            .map_err(BatchError::Worker)?;
        let mut summary = run.summary;
        summary.left = todo - (summary.done - before.0) - (summary.failed - before.1) - summary.gone;
        summary.interrupted = stop.asked() && summary.left > 0;
        summary.seconds = start.elapsed().as_secs_f64();
        self.clear_scratch();
        Ok(summary)
    }

    /// Small pictures of outputs that were made earlier, as base 64.
    ///
    /// # Errors
    /// Workers that cannot be started.
    pub fn thumbnails_of_done(
        &mut self,
        plan: &Plan,
        stop: &Stop,
        take: &mut dyn FnMut(&Item, &str),
    ) -> Result<(), BatchError> {
        let done = |(id, item): (usize, &Item)| match &item.state {
            State::Done(done) => {
                let task = Task::Thumbnail { picture: self.out.join(&item.output) };
                Some(Work::new(id, task, done.written.size))
            }
            _ => None,
        };
        let queue: VecDeque<Work> = plan.items.iter().enumerate().filter_map(done).collect();
        self.crew
            .perform(queue, stop, &mut |work, moment| {
                if let Moment::Came(Ok(Answer::Thumbnail(Some(picture)))) = moment {
                    take(&plan.items[work.id], &picture);
                }
                Next::GoOn
            })
            .map_err(BatchError::Worker)
    }
}

fn develop_task(item: &Item, why: Why, out: &Path, scratch: &Path, thumbnail: bool) -> Develop {
    let output = out.join(&item.output);
    // Whatever stands at the place of a new output stays; the plan knows the others for ours.
    let overwrite = why != Why::New || output.symlink_metadata().is_ok();
    Develop {
        input: item.source.path.clone(),
        output,
        texts: item.prepared.texts.clone(),
        format: item.prepared.format.extension().to_owned(),
        session: Vec::clone(&item.session),
        overwrite,
        scratch: scratch.to_owned(),
        thumbnail,
    }
}

/// Camera and date of every file; of those that cannot be read, nothing.
pub(super) fn read_headers(crew: &mut Crew, sources: &[Source], stop: &Stop) -> Vec<Header> {
    let mut headers = vec![Header::default(); sources.len()];
    let queue = sources
        .iter()
        .enumerate()
        .map(|(id, s)| Work::new(id, Task::Header { input: s.path.clone() }, s.size))
        .collect();
    let taken = crew.perform(queue, stop, &mut |work, moment| {
        if let Moment::Came(Ok(Answer::Header(header))) = moment {
            headers[work.id] = header;
        }
        Next::GoOn
    });
    // Without workers the run itself will say so.
    drop(taken);
    headers
}

/// A run in progress.
struct Run<'a> {
    plan: &'a Plan,
    out: &'a Path,
    journal: &'a mut Journal,
    history: &'a mut History,
    summary: Summary,
    /// How often a file was tried again.
    tries: HashMap<usize, usize>,
    fleeting: bool,
    hear: &'a mut dyn FnMut(Event<'_>),
}

impl<'a> Run<'a> {
    fn moment(&mut self, work: &Work, moment: Moment) -> Next {
        let item = &self.plan.items[work.id];
        match moment {
            Moment::Begun => self.begun(item),
            Moment::Came(Ok(Answer::Developed(developed))) => self.done(item, *developed),
            Moment::Came(Ok(_)) => Next::GoOn,
            Moment::Came(Err(trouble)) => self.failed(work.id, item, trouble),
        }
    }

    fn begun(&mut self, item: &'a Item) -> Next {
        if let Some(reason) = self.vanished() {
            return self.stop(reason);
        }
        let number = names::needs_number(&self.plan.template).then_some(item.number);
        let record = Record::Begun { input: item.source.key.clone(), output: item.output.clone(), number };
        if let Err(error) = self.write(record) {
            return self.stop(error.to_string());
        }
        let place = self.out.join(&item.output);
        if let Some(folder) = place.parent() {
            // If it cannot be made, the worker says so with the file's name.
            let _ = std::fs::create_dir_all(folder);
        }
        (self.hear)(Event::Begun(item));
        Next::GoOn
    }

    fn done(&mut self, item: &'a Item, developed: Developed) -> Next {
        let Developed { colours, thumbnail, peak, needed, .. } = &developed;
        let (colours, thumbnail, peak, needed) = (colours.clone(), thumbnail.clone(), *peak, *needed);
        let done = Done {
            input: item.source.key.clone(),
            output: item.output.clone(),
            source: developed.source,
            settings: item.settings_hash(&developed.camera),
            camera: developed.camera,
            profile: developed.profile,
            written: developed.written,
            width: developed.width,
            height: developed.height,
            seconds: developed.seconds,
            notes: developed.notes,
            number: names::needs_number(&self.plan.template).then_some(item.number),
            program: VERSION.to_owned(),
            at: journal::now(),
        };
        if let Err(error) = self.write(Record::Done(Box::new(done.clone()))) {
            // The picture is there; the next run makes it again, as the journal does not know of it.
            return self.stop(error.to_string());
        }
        self.summary.done += 1;
        self.summary.pixels += done.width as u64 * done.height as u64;
        self.summary.peak = self.summary.peak.max(peak);
        self.summary.estimated = self.summary.estimated.max(needed);
        (self.hear)(Event::Done { item, done: &done, colours: &colours, thumbnail: thumbnail.as_deref() });
        Next::GoOn
    }

    fn failed(&mut self, id: usize, item: &'a Item, trouble: Trouble) -> Next {
        if self.fleeting && item.source.path.symlink_metadata().is_err() {
            return self.gone(item);
        }
        match trouble.kind {
            TroubleKind::DiskFull => return self.stop(trouble.error),
            TroubleKind::Output | TroubleKind::Died => {
                if let Some(reason) = self.vanished() {
                    return self.stop(reason);
                }
            }
            TroubleKind::Changing | TroubleKind::File => {
                let tries = self.tries.entry(id).or_default();
                let unsettled = trouble.kind == TroubleKind::Changing || is_fresh(&item.source);
                if unsettled && *tries < TRIES {
                    *tries += 1;
                    (self.hear)(Event::Later(item));
                    return Next::Again(PAUSE);
                }
            }
        }
        let record = Record::Failed(Failed {
            input: item.source.key.clone(),
            output: item.output.clone(),
            error: trouble.error.clone(),
            died: trouble.kind == TroubleKind::Died,
            program: VERSION.to_owned(),
            at: journal::now(),
        });
        if let Err(error) = self.write(record) {
            return self.stop(error.to_string());
        }
        self.summary.failed += 1;
        (self.hear)(Event::Failed { item, error: &trouble.error });
        Next::GoOn
    }

    fn gone(&mut self, item: &'a Item) -> Next {
        let record = Record::Gone { input: item.source.key.clone(), output: item.output.clone() };
        if let Err(error) = self.write(record) {
            return self.stop(error.to_string());
        }
        self.summary.gone += 1;
        (self.hear)(Event::Gone(item));
        Next::GoOn
    }

    fn write(&mut self, record: Record) -> Result<(), JournalError> {
        self.journal.append(std::slice::from_ref(&record))?;
        self.history.add(record);
        Ok(())
    }

    /// What is wrong when the output folder is not there any more.
    fn vanished(&self) -> Option<String> {
        (!self.journal.is_there()).then(|| {
            format!("{}: the output folder is gone; bring it back and run again", self.out.display())
        })
    }

    fn stop(&mut self, reason: String) -> Next {
        if self.summary.stopped.is_none() {
            (self.hear)(Event::Stopping(&reason));
            self.summary.stopped = Some(reason);
        }
        Next::Finish
    }
}

/// Whether a file changed since the plan was made, or a moment ago.
fn is_fresh(source: &Source) -> bool {
    let Ok(data) = std::fs::metadata(&source.path) else { return false };
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos() as i64);
    let age = now - modified(&data);
    let moment_ago = (0..FRESH.as_nanos() as i64).contains(&age);
    moment_ago || data.len() != source.size
}
