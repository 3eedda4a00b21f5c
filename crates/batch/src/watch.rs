//! A folder that is watched: what comes in is developed, for as long as one likes.
//!
//! Again and again all files are looked up, as a batch does; those that have stopped growing and were not seen to
//! are planned and run by the same [`Batch`], with the same journal. So nothing is lost by a restart, a notification
//! that did not come, or a disk that was away.
//!
//! **What it does not do:** it develops inputs that are new or have changed, and nothing else. A picture that was made
//! with other settings, or was taken out of the output folder, is left to a batch.

use std::collections::HashSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use darkroot::{RecipeError, path_text};

use super::batch::Batch;
use super::filter::FindError;
use super::find::{Search, Source, Sources, find};
use super::item::{BatchPlan, State, Why};
use super::notice::{Notice, WatchError, WatchOptions, Watched};
use super::outcome::Event;
use super::session::Session;
use super::settings_by_file::SettingsByFile;
use super::settle::Settle;
use super::stop::Stop;
use super::wake::Wake;
use super::watch_plan::PlanOfRound;

/// After what time to try again what waits for something else than itself: a wrong recipe, an output in the way.
const RETRY: Duration = Duration::from_secs(10);

/// Watches until it is told to stop, or the disk of the outputs is full or gone.
///
/// `settings` gives the settings as they stand in files now; it is asked before each round.
///
/// # Errors
/// Settings, names and folders that are wrong from the beginning. What goes wrong later is told and waited out.
pub fn watch(
    batch: &mut Batch,
    options: &WatchOptions,
    settings: &mut dyn FnMut() -> Result<SettingsByFile, RecipeError>,
    stop: &Stop,
    on_notice: &mut dyn FnMut(Notice<'_>),
) -> Result<Watched, WatchError> {
    if let Some(input) = options.search.inputs.iter().find(|i| path_text::path(i).is_file()) {
        return Err(WatchError::NoFolder { input: input.clone() });
    }
    batch.inputs_may_vanish = true;
    check_before_waiting(batch, options, &mut settings()?, stop)?;
    let session = match &options.chart {
        Some(chart) if chart.file.is_some() => {
            batch.session(&Sources::default(), chart, stop, &mut |words| on_notice(Notice::Colours(words)))?
        }
        _ => Session::default(),
    };
    let mut wake = Wake::new(options.poll, &options.plan.out, options.search.follow_links);
    let mut watch = Watch {
        batch,
        options,
        settings,
        stop,
        on_notice,
        session,
        settle: Settle::new(options.settle),
        away: HashSet::new(),
        faults: HashSet::new(),
        colours: HashSet::new(),
        result: Watched::default(),
    };
    let mut told = false;
    let mut first = true;
    while !stop.asked() && watch.result.stopped.is_none() {
        let start = Instant::now();
        let folders = watch.folders();
        // Before the look: what comes after it wakes us.
        let why = wake.follow(&folders);
        if !told || why.is_some() {
            (watch.on_notice)(Notice::Watching { polling: wake.polling(), why: why.as_deref() });
            told = true;
        }
        let found = watch.look(&folders)?;
        let ready = found.as_ref().map(|found| watch.ready(found)).unwrap_or_default();
        let cost = start.elapsed();
        if let (Some(found), false) = (&found, ready.is_empty()) {
            watch.round(ready, found, first)?;
            first = false;
        }
        wake.wait(watch.settle.next(), cost, stop);
    }
    watch.result.held = watch.settle.held();
    Ok(watch.result)
}

/// Plans a file that is not there: wrong names and settings are found before anything is waited for.
fn check_before_waiting(
    batch: &mut Batch,
    options: &WatchOptions,
    settings: &mut SettingsByFile,
    stop: &Stop,
) -> Result<(), WatchError> {
    find(&Search { inputs: Vec::new(), ..options.search.clone() }, &options.plan.out)?;
    let pretend = |input: &String| {
        let (path, key) = (path_text::path(input).join("file.dng"), "file.dng".to_owned());
        Source { path, key, size: 0, modified: 0 }
    };
    for input in &options.search.inputs {
        let sources = Sources { files: vec![pretend(input)], ..Sources::default() };
        batch.plan(sources, &options.plan, settings, &Session::default(), stop)?;
    }
    Ok(())
}

/// A watch at work.
struct Watch<'a> {
    batch: &'a mut Batch,
    options: &'a WatchOptions,
    settings: &'a mut dyn FnMut() -> Result<SettingsByFile, RecipeError>,
    stop: &'a Stop,
    on_notice: &'a mut dyn FnMut(Notice<'_>),
    /// Colours of a chart shot that was named.
    session: Session,
    settle: Settle,
    /// Inputs that are not there.
    away: HashSet<String>,
    /// What cannot be read now, in words.
    faults: HashSet<String>,
    /// What was said of sessions' colours in the last round.
    colours: HashSet<String>,
    result: Watched,
}

impl Watch<'_> {
    /// The input folders that are there; those that went or came are told.
    fn folders(&mut self) -> Vec<PathBuf> {
        let mut there = Vec::new();
        for input in &self.options.search.inputs {
            let path = path_text::path(input);
            if path.is_dir() {
                if self.away.remove(input) {
                    (self.on_notice)(Notice::Back(input));
                }
                there.push(path);
            } else if self.away.insert(input.clone()) {
                (self.on_notice)(Notice::Away(input));
            }
        }
        there
    }

    /// All files in these folders; nothing if one of them has just gone.
    fn look(&mut self, folders: &[PathBuf]) -> Result<Option<Sources>, WatchError> {
        let search = Search {
            inputs: folders.iter().map(|folder| path_text::text(folder)).collect(),
            // Keys stay what they are when one of several folders is away.
            apart: self.options.search.inputs.len() > 1,
            ..self.options.search.clone()
        };
        let found = match find(&search, &self.options.plan.out) {
            Ok(found) => found,
            Err(FindError::Missing { .. }) => return Ok(None),
            Err(error) => return Err(error.into()),
        };
        let faults: HashSet<String> = found.faults.iter().map(ToString::to_string).collect();
        for fault in found.faults.iter().filter(|f| !self.faults.contains(&f.to_string())) {
            (self.on_notice)(Notice::Fault(fault));
        }
        self.faults = faults;
        Ok(Some(found))
    }

    /// Files that can be developed now.
    fn ready(&mut self, found: &Sources) -> Vec<Source> {
        let away: Vec<PathBuf> = self.away.iter().map(|input| path_text::path(input)).collect();
        self.settle.look(&found.files, &away, Instant::now())
    }

    /// Plans and runs these files.
    fn round(&mut self, ready: Vec<Source>, found: &Sources, first: bool) -> Result<(), WatchError> {
        let mut reasons = self.settle.reasons();
        let mut settings = match (self.settings)() {
            Ok(settings) => settings,
            Err(error) => {
                for source in &ready {
                    self.hold(source, &error, &mut reasons);
                }
                return Ok(());
            }
        };
        let session = self.session_of(&ready, found)?;
        let mut plan = self.plan(ready, found, &mut settings, &session, &mut reasons)?;
        let mut outdated = 0;
        let items = std::mem::take(&mut plan.items);
        for item in items {
            match &item.state {
                State::Todo(why) if is_about_input(*why) => {
                    plan.items.push(item);
                    continue;
                }
                State::Conflict(conflict) => {
                    self.hold(&item.source, conflict, &mut reasons);
                    continue;
                }
                State::Todo(_) => outdated += 1,
                State::Done(_) => {}
            }
            self.settle.take(&item.source.path);
        }
        if first && outdated > 0 {
            (self.on_notice)(Notice::Outdated(outdated));
        }
        self.run(&plan)
    }

    fn run(&mut self, plan: &BatchPlan) -> Result<(), WatchError> {
        let Self { batch, settle, on_notice, stop, .. } = self;
        let summary = batch.run(plan, stop, &mut |event| {
            if let Event::Done { item, .. } | Event::Failed { item, .. } = &event {
                settle.take(&item.source.path);
            }
            on_notice(Notice::File(event));
        })?;
        self.result.done += summary.done;
        self.result.failed += summary.failed;
        self.result.stopped = summary.stopped;
        Ok(())
    }

    /// Colours for these files: the chart shot that was named, or those in the folders that they lie in.
    fn session_of(&mut self, ready: &[Source], found: &Sources) -> Result<Session, WatchError> {
        let Some(chart) = self.options.chart.as_ref().filter(|c| c.file.is_none()) else {
            return Ok(self.session.clone());
        };
        let now = Instant::now();
        let folders: HashSet<_> = ready.iter().map(|s| s.path.parent()).collect();
        let near = |s: &&Source| folders.contains(&s.path.parent()) && self.settle.is_settled(&s.path, now);
        let files = found.files.iter().filter(near).cloned().collect();
        let sources = Sources { files, ..Sources::default() };
        let mut said = HashSet::new();
        let session = self.batch.session(&sources, chart, self.stop, &mut |words| {
            if said.insert(words.to_owned()) && !self.colours.contains(words) {
                (self.on_notice)(Notice::Colours(words));
            }
        })?;
        self.colours = said;
        Ok(session)
    }

    /// A plan for these files, without those that must wait.
    fn plan(
        &mut self,
        ready: Vec<Source>,
        found: &Sources,
        settings: &mut SettingsByFile,
        session: &Session,
        reasons: &mut HashSet<String>,
    ) -> Result<BatchPlan, WatchError> {
        let Self { batch, options, stop, .. } = self;
        let round = PlanOfRound { batch, options: &options.plan, settings, session, stop };
        let planned = round.make(ready, found)?;
        for (source, reason) in &planned.held {
            self.hold(source, &**reason, reasons);
        }
        for source in &planned.elsewhere {
            self.settle.take(&source.path);
        }
        Ok(planned.plan)
    }

    fn hold(
        &mut self,
        source: &Source,
        reason: &(dyn std::error::Error + 'static),
        reasons: &mut HashSet<String>,
    ) {
        let words = self.batch.wording().of(reason);
        if reasons.insert(words.clone()) {
            (self.on_notice)(Notice::Held { source, words: &words });
        }
        self.settle.hold(&source.path, words, Instant::now() + RETRY);
    }
}

/// Whether the input is the reason, so that a watch sees to it.
fn is_about_input(why: Why) -> bool {
    matches!(why, Why::New | Why::Interrupted | Why::FailedBefore | Why::InputChanged)
}
