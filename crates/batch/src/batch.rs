//! An output folder with its journal and its workers: plans, sessions, runs.

use std::collections::{HashMap, HashSet, VecDeque};
use std::path::PathBuf;
use std::time::Instant;

use darkroot::{ProfileStore, files};

use super::batch_error::BatchError;
use super::crew::Crew;
use super::crew_options::CrewOptions;
use super::facts::FOLDER;
use super::find::{Source, Sources};
use super::headers::read_headers;
use super::history::History;
use super::item::{BatchPlan, Item, PlanOptions, State, Why};
use super::journal::{self, Journal};
use super::outcome::{Event, Summary};
use super::plan::plan;
use super::record::Record;
use super::run::Run;
use super::session::{ChartSearch, ChartShot, Session};
use super::settings_by_file::SettingsByFile;
use super::split::Split;
use super::stop::Stop;
use super::task::{Answer, Develop, Task};
use super::wording::Wording;
use super::work::{Next, Progress, Work};

/// An output folder with its journal and its workers.
pub struct Batch {
    out: PathBuf,
    scratch: PathBuf,
    journal: Journal,
    _split: Split,
    history: History,
    store: ProfileStore,
    crew: Crew,
    thumbnails: bool,
    /// Whether files may vanish before their turn comes.
    pub(crate) inputs_may_vanish: bool,
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
        let split = Split::join(&out, options.shard.count)?;
        let (journal, own) = Journal::open(&out, &suffix)?;
        let mut history = own;
        for (name, other) in journal::read_all(&out)? {
            if !journal.is_named(&name) {
                history.merge(other);
            }
        }
        let scratch = out.join(FOLDER).join(format!("unfinished{suffix}"));
        let batch = Self {
            out,
            scratch,
            journal,
            _split: split,
            history,
            store,
            crew: Crew::new(crew),
            thumbnails: false,
            inputs_may_vanish: false,
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

    /// How errors are worded.
    pub(crate) fn wording(&self) -> &Wording {
        self.crew.wording()
    }

    /// What is left of a run that was ended at once is no output.
    fn clear_scratch(&self) {
        // What cannot be removed does no harm there.
        let _ = files::clear_unfinished(&self.out, &self.scratch);
    }

    /// Decides about every file; workers read headers where names need them.
    ///
    /// # Errors
    /// Wrong settings, wrong names, names that collide.
    pub fn plan(
        &mut self,
        sources: Sources,
        options: &PlanOptions,
        settings: &mut SettingsByFile,
        session: &Session,
        stop: &Stop,
    ) -> Result<BatchPlan, BatchError> {
        let Self { crew, history, store, .. } = self;
        let mut headers = |files: &[Source]| read_headers(crew, files, stop);
        let session = |source: &Source| session.colours_of(&source.key);
        Ok(plan(sources, options, settings, history, store, &mut headers, &session)?)
    }

    /// Looks for charts in the files, or in the one named, and makes a profile for each folder and camera. `say` is
    /// told in words what was found.
    ///
    /// # Errors
    /// A chart shot that was named and shows none.
    pub fn session(
        &mut self,
        sources: &Sources,
        chart: &ChartShot,
        stop: &Stop,
        say: &mut dyn FnMut(&str),
    ) -> Result<Session, BatchError> {
        let folder = self.out.join(FOLDER).join("session");
        let Self { crew, history, journal, .. } = self;
        let known = history.charts.clone();
        let mut note = |record: Record| {
            journal.append(std::slice::from_ref(&record))?;
            history.add(record);
            Ok(())
        };
        let place = &folder;
        ChartSearch { crew, chart, out: &self.out, place, known: &known, note: &mut note, stop }
            .find(sources, say)
    }

    /// Runs a plan.
    ///
    /// # Errors
    /// Workers that cannot be started. Everything else is an event or stands in the summary.
    pub fn run(
        &mut self,
        plan: &BatchPlan,
        stop: &Stop,
        on_event: &mut dyn FnMut(Event<'_>),
    ) -> Result<Summary, BatchError> {
        let start = Instant::now();
        let mut run = Run {
            plan,
            out: &self.out,
            journal: &mut self.journal,
            history: &mut self.history,
            summary: Summary::default(),
            tries: HashMap::new(),
            in_doubt: HashSet::new(),
            inputs_may_vanish: self.inputs_may_vanish,
            on_event,
            wording: self.crew.wording().clone(),
        };
        let mut queue = VecDeque::new();
        for (id, item) in plan.items.iter().enumerate() {
            match &item.state {
                State::Done(_) => run.summary.skipped += 1,
                State::Conflict(conflict) => run.conflict(item, conflict),
                State::Todo(why) => {
                    // Whatever stands at the place of a new output stays; the plan knows the others for ours.
                    let overwrite = *why != Why::New || plan.overwrite;
                    let task = Develop {
                        overwrite,
                        thumbnail: self.thumbnails,
                        ..item.task(item.place(&self.out), &self.out, &self.scratch)
                    };
                    let size = item.source.size;
                    queue.push_back(Work::new(id, Task::Develop(task), size));
                }
            }
        }
        let todo = queue.len();
        let before = (run.summary.done, run.summary.failed);
        self.crew
            .perform(queue, stop, &mut |work, progress| run.on_progress(work, progress))
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
        plan: &BatchPlan,
        stop: &Stop,
        take: &mut dyn FnMut(&Item, &str),
    ) -> Result<(), BatchError> {
        let done = |(id, item): (usize, &Item)| match &item.state {
            State::Done(done) => {
                let task = Task::Thumbnail { picture: item.place(&self.out) };
                Some(Work::new(id, task, done.written.size))
            }
            _ => None,
        };
        let queue: VecDeque<Work> = plan.items.iter().enumerate().filter_map(done).collect();
        self.crew
            .perform(queue, stop, &mut |work, progress| {
                if let Progress::Ended(Ok(Answer::Thumbnail(Some(picture)))) = progress {
                    take(&plan.items[work.id], &picture);
                }
                Next::GoOn
            })
            .map_err(BatchError::Worker)
    }
}
