//! A batch of this window: a thread that runs it, and what is to be said of it.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use darkroot::recipe::Layers;
use darkroot::{ProfileStore, path_text};
use darkroot_batch::{
    Batch, ChartShot, CrewOptions, Event, PlanOptions, Search, Session, SettingsByFile, Sheet, State, Stop,
    Summary, Wording, find,
};
use serde::Serialize;

use crate::state::locked;

/// What is to be developed, and how.
#[derive(Clone)]
pub(crate) struct Request {
    pub(crate) search: Search,
    pub(crate) options: PlanOptions,
    pub(crate) layers: Layers,
    pub(crate) chart: Option<ChartShot>,
    /// Where a contact sheet is written, if one is wanted.
    pub(crate) sheet: Option<PathBuf>,
}

/// Where a batch is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Phase {
    /// It looks for files and decides about each.
    #[default]
    Planning,
    Running,
    /// No more files are begun.
    Pausing,
    Paused,
    /// Nothing is left to do.
    Done,
    /// It could not be run at all.
    Failed,
}

/// What is to be said of a batch.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Told {
    pub(crate) kind: &'static str,
    pub(crate) phase: Phase,
    /// Files in all, where that is known.
    pub(crate) total: Option<usize>,
    pub(crate) done: usize,
    pub(crate) failed: usize,
    /// Files that were done before.
    pub(crate) skipped: usize,
    /// Megapixels developed.
    pub(crate) megapixels: f64,
    /// Megapixels a second.
    pub(crate) rate: Option<f64>,
    /// Seconds since it began, and how many it will take from now on.
    pub(crate) seconds: f64,
    pub(crate) left: Option<f64>,
    /// Files in work.
    pub(crate) at_work: Vec<String>,
    /// What failed, the last first.
    pub(crate) failures: Vec<Failure>,
    /// What was done, the last first.
    pub(crate) recent: Vec<Finished>,
    /// What a person should know.
    pub(crate) notes: Vec<String>,
}

/// A file that failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Failure {
    pub(crate) input: String,
    pub(crate) words: String,
}

/// A file that is done.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Finished {
    pub(crate) input: String,
    pub(crate) output: String,
    pub(crate) seconds: f64,
}

/// Lines of each list, at most.
pub(crate) const LINES: usize = 200;

/// A batch of this window.
pub(crate) struct Running {
    pub(crate) request: Request,
    crew: CrewOptions,
    store: Arc<ProfileStore>,
    wording: Wording,
    progress: Mutex<Progress>,
}

#[derive(Default)]
struct Progress {
    told: Told,
    stop: Stop,
    begun: Option<Instant>,
    /// Files that were done or had failed before this part of the run.
    before: usize,
    /// Of each file by its path.
    states: HashMap<PathBuf, &'static str>,
}

impl Running {
    /// Begins.
    pub(crate) fn start(
        request: Request,
        crew: CrewOptions,
        store: Arc<ProfileStore>,
        wording: Wording,
    ) -> Arc<Self> {
        let progress = Mutex::default();
        let running = Arc::new(Self { request, crew, store, wording, progress });
        running.spawn();
        running
    }

    /// Goes on with what is left.
    ///
    /// # Errors
    /// It is at work.
    pub(crate) fn resume(this: &Arc<Self>) -> Result<(), String> {
        {
            let mut progress = locked(&this.progress);
            if !matches!(progress.told.phase, Phase::Paused | Phase::Done | Phase::Failed) {
                return Err("this batch is at work".to_owned());
            }
            *progress = Progress { states: std::mem::take(&mut progress.states), ..Progress::default() };
        }
        this.spawn();
        Ok(())
    }

    /// Finishes the files in flight and begins no more.
    pub(crate) fn pause(&self) {
        let mut progress = locked(&self.progress);
        if matches!(progress.told.phase, Phase::Planning | Phase::Running) {
            progress.stop.ask();
            progress.told.phase = Phase::Pausing;
        }
    }

    /// What is to be said.
    pub(crate) fn told(&self) -> Told {
        let progress = locked(&self.progress);
        let mut told = progress.told.clone();
        told.kind = "run";
        if let Some(begun) = progress.begun {
            let seconds = begun.elapsed().as_secs_f64();
            let ended = told.done + told.failed - progress.before.min(told.done + told.failed);
            let left = told.total.map(|total| total.saturating_sub(told.done + told.failed + told.skipped));
            // Tenths are enough, and do not change all the time.
            told.seconds = (seconds * 10.0).round() / 10.0;
            told.rate = (told.megapixels > 0.0).then(|| told.megapixels / seconds);
            told.left = left.filter(|_| ended > 0).map(|left| (left as f64 * seconds / ended as f64).round());
        }
        told
    }

    /// What became of files.
    pub(crate) fn states(&self) -> Vec<(PathBuf, &'static str)> {
        locked(&self.progress).states.iter().map(|(path, state)| (path.clone(), *state)).collect()
    }

    fn spawn(self: &Arc<Self>) {
        const STACK: usize = 8 << 20;
        let this = Arc::clone(self);
        let run = move || {
            let result = this.run();
            let mut progress = locked(&this.progress);
            progress.begun = None;
            let told = &mut progress.told;
            told.at_work.clear();
            match result {
                Ok(summary) => {
                    told.phase =
                        if summary.interrupted || summary.left > 0 { Phase::Paused } else { Phase::Done };
                    told.seconds = summary.seconds;
                    told.rate = (summary.pixels > 0).then(|| summary.pixels as f64 / 1e6 / summary.seconds);
                }
                Err(words) => {
                    told.phase = Phase::Failed;
                    told.notes.insert(0, words);
                }
            }
        };
        let thread = std::thread::Builder::new().name("batch".to_owned()).stack_size(STACK).spawn(run);
        if let Err(error) = thread {
            let mut progress = locked(&self.progress);
            progress.told.phase = Phase::Failed;
            progress.told.notes.push(format!("the batch cannot be started: {error}"));
        }
    }

    fn run(&self) -> Result<Summary, String> {
        let words = |error: &(dyn std::error::Error + 'static)| self.wording.of(error);
        let stop = locked(&self.progress).stop.clone();
        let Request { search, options, layers, chart, sheet } = &self.request;
        let mut settings = SettingsByFile::new(layers.clone());
        let sources = find(search, &options.out).map_err(|e| words(&e))?;
        darkroot_batch::check(&sources, options, &mut settings).map_err(|e| words(&e))?;
        let store = ProfileStore::clone(&self.store);
        let mut sheet = Sheet::new(sheet.as_slice()).map_err(|e| words(&e))?;
        let batch = Batch::open(options, self.crew.clone(), store).map_err(|e| words(&e))?;
        let mut batch = batch.with_thumbnails(sheet.wants_thumbnails());
        let session = match chart {
            Some(chart) => {
                let mut say = |note: &str| self.note(note);
                batch.session(&sources, chart, &stop, &mut say).map_err(|e| words(&e))?
            }
            None => Session::default(),
        };
        let plan = batch.plan(sources, options, &mut settings, &session, &stop).map_err(|e| words(&e))?;
        plan.faults.iter().for_each(|fault| self.note(&words(fault)));
        {
            let mut progress = locked(&self.progress);
            let skipped = plan.items.iter().filter(|item| matches!(item.state, State::Done(_)));
            let paths: Vec<PathBuf> = skipped.map(|item| item.source.path.clone()).collect();
            progress.told.total = Some(plan.items.len());
            progress.told.skipped = paths.len();
            progress.states.extend(paths.into_iter().map(|path| (path, "done")));
            progress.begun = Some(Instant::now());
            if progress.told.phase == Phase::Planning {
                progress.told.phase = Phase::Running;
            }
        }
        let mut on_event = |event: Event<'_>| {
            sheet.record(&event);
            self.hear(&event);
        };
        let summary = batch.run(&plan, &stop, &mut on_event).map_err(|e| words(&e))?;
        if sheet.wants_thumbnails() && !summary.interrupted {
            let mut take = |item: &darkroot_batch::Item, picture: &str| sheet.picture(item, picture);
            batch.thumbnails_of_done(&plan, &stop, &mut take).map_err(|e| words(&e))?;
        }
        if !plan.items.is_empty() {
            sheet.write(&plan, &summary).map_err(|e| words(&e))?;
        }
        Ok(summary)
    }

    fn note(&self, words: &str) {
        let notes = &mut locked(&self.progress).told.notes;
        notes.push(words.to_owned());
        notes.truncate(LINES);
    }

    fn hear(&self, event: &Event<'_>) {
        let mut progress = locked(&self.progress);
        let Progress { told, states, .. } = &mut *progress;
        let shown = |item: &darkroot_batch::Item| darkroot::shown(&path_text::path(&item.source.key));
        match event {
            Event::Begun(item) => told.at_work.push(shown(item)),
            Event::Later(item) | Event::Gone(item) => told.at_work.retain(|name| *name != shown(item)),
            Event::Done { item, done, .. } => {
                let input = shown(item);
                told.at_work.retain(|name| *name != input);
                told.done += 1;
                told.megapixels += (done.width * done.height) as f64 / 1e6;
                states.insert(item.source.path.clone(), "done");
                told.recent.insert(0, Finished { input, output: item.output_shown(), seconds: done.seconds });
                told.recent.truncate(LINES);
            }
            Event::Failed { item, words, .. } => {
                let input = shown(item);
                told.at_work.retain(|name| *name != input);
                told.failed += 1;
                states.insert(item.source.path.clone(), "failed");
                told.failures.insert(0, Failure { input, words: (*words).to_owned() });
                told.failures.truncate(LINES);
            }
            Event::Stopping { words, .. } => told.notes.insert(0, (*words).to_owned()),
        }
    }
}
