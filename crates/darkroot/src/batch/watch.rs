//! A folder that is watched: what comes in is developed, for as long as one likes.
//!
//! Again and again all files are looked up, as a batch does; those that have stopped growing and were not seen to
//! are planned and run by the same [`Batch`], with the same journal. So nothing is lost by a restart, a notification
//! that did not come, or a disk that was away.
//!
//! **What it does not do:** it develops inputs that are new or have changed, and nothing else. A picture that was made
//! with other settings, or was taken out of the output folder, is left to a batch.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::find::{FindError, Search, Source, Sources, find};
use super::outcome::{BatchError, Event};
use super::plan::{Item, Plan, PlanError, PlanOptions, Recipes, State, Why};
use super::run::Batch;
use super::session::{ChartShot, Session};
use super::settle::Settle;
use super::stop::Stop;
use super::wake::Wake;
use crate::RecipeError;

/// After what time to try again what waits for something else than itself: a wrong recipe, an output in the way.
const RETRY: Duration = Duration::from_secs(10);

/// What to watch, and how.
#[derive(Debug, Clone)]
pub struct WatchOptions {
    /// Folders, and what of them is taken.
    pub search: Search,
    /// Where outputs go.
    pub plan: PlanOptions,
    /// A file is taken when its size and time of change have been the same for so long.
    pub settle: Duration,
    /// Look every so often instead of waiting for notifications.
    pub poll: Option<Duration>,
    /// Where session colours come from.
    pub chart: Option<ChartShot>,
}

/// What a watch tells.
#[derive(Debug)]
pub enum Notice<'a> {
    /// It watches now; `polling` if it looks every so often, and `why` if that was not asked for.
    Watching {
        /// How often it looks.
        polling: Option<Duration>,
        /// Why there are no notifications.
        why: Option<&'a str>,
    },
    /// Something happened to a file.
    File(Event<'a>),
    /// A file cannot be developed as long as this is so. Said once for each reason.
    Held {
        /// The file.
        source: &'a Source,
        /// One sentence.
        error: &'a str,
    },
    /// Something cannot be read. Said once, as long as it is so.
    Fault(&'a str),
    /// An input folder is not there; it is waited for.
    Away(&'a str),
    /// It is there again.
    Back(&'a str),
    /// So many pictures are not as they would be made now, and are left so.
    Outdated(usize),
    /// About the colours of a session.
    Colours(&'a str),
}

/// How a watch came out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Watched {
    /// Files developed.
    pub done: usize,
    /// Files that failed.
    pub failed: usize,
    /// Files that wait for something: a recipe to be corrected, an output to be moved.
    pub held: usize,
    /// Why it ended by itself, if it did.
    pub stopped: Option<String>,
}

/// Why nothing is watched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WatchError {
    /// The batch behind it.
    #[error(transparent)]
    Batch(#[from] BatchError),
    /// A pattern.
    #[error(transparent)]
    Find(#[from] FindError),
    /// Settings.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// Not a folder.
    #[error("{input}: is no folder; name the folder that it lies in, and choose files with `--include`")]
    NoFolder {
        /// As it was given.
        input: String,
    },
}

/// Watches until it is told to stop, or the disk of the outputs is full or gone.
///
/// `recipes` gives the settings as they stand in files now; it is asked before each round.
///
/// # Errors
/// Settings, names and folders that are wrong from the beginning. What goes wrong later is told and waited out.
pub fn watch(
    batch: &mut Batch,
    options: &WatchOptions,
    recipes: &mut dyn FnMut() -> Result<Recipes, RecipeError>,
    stop: &Stop,
    hear: &mut dyn FnMut(Notice<'_>),
) -> Result<Watched, WatchError> {
    if let Some(input) = options.search.inputs.iter().find(|i| PathBuf::from(i).is_file()) {
        return Err(WatchError::NoFolder { input: input.clone() });
    }
    batch.fleeting = true;
    rehearse(batch, options, &mut recipes()?, stop)?;
    let session = match &options.chart {
        Some(chart) if chart.file.is_some() => {
            batch.session(&Sources::default(), chart, stop, &mut |words| hear(Notice::Colours(words)))?
        }
        _ => Session::default(),
    };
    let mut wake = Wake::new(options.poll, &options.plan.out, options.search.follow_links);
    let mut watch = Watch {
        batch,
        options,
        recipes,
        stop,
        hear,
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
            (watch.hear)(Notice::Watching { polling: wake.polling(), why: why.as_deref() });
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
fn rehearse(
    batch: &mut Batch,
    options: &WatchOptions,
    recipes: &mut Recipes,
    stop: &Stop,
) -> Result<(), WatchError> {
    find(&Search { inputs: Vec::new(), ..options.search.clone() }, &options.plan.out)?;
    let pretend = |input: &String| {
        let (path, key) = (PathBuf::from(input).join("file.dng"), "file.dng".to_owned());
        Source { path, key, size: 0, modified: 0 }
    };
    for input in &options.search.inputs {
        let sources = Sources { files: vec![pretend(input)], ..Sources::default() };
        batch.plan(sources, &options.plan, recipes, &Session::default(), stop)?;
    }
    Ok(())
}

/// A watch at work.
struct Watch<'a> {
    batch: &'a mut Batch,
    options: &'a WatchOptions,
    recipes: &'a mut dyn FnMut() -> Result<Recipes, RecipeError>,
    stop: &'a Stop,
    hear: &'a mut dyn FnMut(Notice<'_>),
    /// Colours of a chart shot that was named.
    session: Session,
    settle: Settle,
    /// Inputs that are not there.
    away: HashSet<String>,
    /// What cannot be read at the moment.
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
            let path = PathBuf::from(input);
            if path.is_dir() {
                if self.away.remove(input) {
                    (self.hear)(Notice::Back(input));
                }
                there.push(path);
            } else if self.away.insert(input.clone()) {
                (self.hear)(Notice::Away(input));
            }
        }
        there
    }

    /// All files in these folders; nothing if one of them went this very moment.
    fn look(&mut self, folders: &[PathBuf]) -> Result<Option<Sources>, WatchError> {
        let text = |path: &PathBuf| path.to_str().map(str::to_owned);
        let search = Search {
            inputs: folders.iter().filter_map(text).collect(),
            // Keys stay what they are when one of several folders is away.
            apart: self.options.search.inputs.len() > 1,
            ..self.options.search.clone()
        };
        let found = match find(&search, &self.options.plan.out) {
            Ok(found) => found,
            Err(FindError::Missing { .. }) => return Ok(None),
            Err(error) => return Err(error.into()),
        };
        let faults: HashSet<String> = found.faults.iter().cloned().collect();
        for fault in found.faults.iter().filter(|f| !self.faults.contains(*f)) {
            (self.hear)(Notice::Fault(fault));
        }
        self.faults = faults;
        Ok(Some(found))
    }

    /// Files that can be developed now.
    fn ready(&mut self, found: &Sources) -> Vec<Source> {
        let away: Vec<PathBuf> = self.away.iter().map(PathBuf::from).collect();
        self.settle.look(&found.files, &away, Instant::now())
    }

    /// Plans and runs these files.
    fn round(&mut self, ready: Vec<Source>, found: &Sources, first: bool) -> Result<(), WatchError> {
        let mut reasons = self.settle.reasons();
        let mut recipes = match (self.recipes)() {
            Ok(recipes) => recipes,
            Err(error) => {
                for source in &ready {
                    self.hold(source, error.to_string(), &mut reasons);
                }
                return Ok(());
            }
        };
        let session = self.session_of(&ready, found)?;
        let mut plan = self.plan(ready, found, &mut recipes, &session, &mut reasons)?;
        let mut outdated = 0;
        let items = std::mem::take(&mut plan.items);
        for item in items {
            match &item.state {
                State::Todo(why) if is_about_input(*why) => {
                    plan.items.push(item);
                    continue;
                }
                State::Conflict(reason) => {
                    self.hold(&item.source, reason.clone(), &mut reasons);
                    continue;
                }
                State::Todo(_) => outdated += 1,
                State::Done(_) => {}
            }
            self.settle.take(&item.source.path);
        }
        if first && outdated > 0 {
            (self.hear)(Notice::Outdated(outdated));
        }
        self.run(&plan)
    }

    fn run(&mut self, plan: &Plan) -> Result<(), WatchError> {
        let Self { batch, settle, hear, stop, .. } = self;
        let summary = batch.run(plan, stop, &mut |event| {
            if let Event::Done { item, .. } | Event::Failed { item, .. } = &event {
                settle.take(&item.source.path);
            }
            hear(Notice::File(event));
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
                (self.hear)(Notice::Colours(words));
            }
        })?;
        self.colours = said;
        Ok(session)
    }

    /// A plan for these files, without those that must wait.
    ///
    /// Others that are there take part where they have an output that one of these would get, so that names collide,
    /// or are resolved, as in a batch of all.
    fn plan(
        &mut self,
        ready: Vec<Source>,
        found: &Sources,
        recipes: &mut Recipes,
        session: &Session,
        reasons: &mut HashSet<String>,
    ) -> Result<Plan, WatchError> {
        let wanted: HashSet<String> = ready.iter().map(|s| s.key.clone()).collect();
        let mut owners = self.owners(found);
        let mut files = ready;
        loop {
            let sources = Sources { files: files.clone(), ..Sources::default() };
            match self.batch.plan(sources, &self.options.plan, recipes, session, self.stop) {
                Ok(mut plan) => {
                    let others = others(&plan.items, &owners, &files);
                    if others.is_empty() {
                        plan.items.retain(|item| wanted.contains(&item.source.key));
                        // What belongs to another shard is none of this watch's business.
                        let here: HashSet<&str> = plan.items.iter().map(|i| i.source.key.as_str()).collect();
                        let elsewhere =
                            |f: &&Source| wanted.contains(&f.key) && !here.contains(f.key.as_str());
                        for file in files.iter().filter(elsewhere) {
                            self.settle.take(&file.path);
                        }
                        return Ok(plan);
                    }
                    files.extend(others.into_iter().cloned());
                    files.sort_by(|a, b| a.key.cmp(&b.key));
                }
                Err(BatchError::Plan(PlanError::Collisions(collisions))) => {
                    for collision in collisions {
                        let (output, inputs) = (&collision.output, collision.inputs.join(", "));
                        let words = format!(
                            "{output}: would be written from more than one input ({inputs}); add `--on-collision \
                             suffix`, or name them apart with `--name`"
                        );
                        for file in files.extract_if(.., |f| collision.inputs.contains(&f.key)) {
                            if wanted.contains(&file.key) {
                                self.hold(&file, words.clone(), reasons);
                            }
                        }
                        owners.retain(|_, owner| !collision.inputs.contains(&owner.key));
                    }
                }
                Err(BatchError::Plan(error)) => {
                    let before = files.len();
                    // Those that were developed earlier are only asked for their names.
                    files.retain(|f| wanted.contains(&f.key));
                    owners.clear();
                    files = self.sound(files, recipes, session, reasons)?;
                    if files.len() == before {
                        // Each is right and all together are not.
                        for file in files.drain(..) {
                            self.hold(&file, error.to_string(), reasons);
                        }
                    }
                }
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// The files that can be planned; others wait, such as those whose recipe is wrong.
    fn sound(
        &mut self,
        files: Vec<Source>,
        recipes: &mut Recipes,
        session: &Session,
        reasons: &mut HashSet<String>,
    ) -> Result<Vec<Source>, WatchError> {
        let mut sound = Vec::new();
        for file in files {
            let sources = Sources { files: vec![file.clone()], ..Sources::default() };
            match self.batch.plan(sources, &self.options.plan, recipes, session, self.stop) {
                Ok(_) => sound.push(file),
                Err(BatchError::Plan(error)) => self.hold(&file, error.to_string(), reasons),
                Err(error) => return Err(error.into()),
            }
        }
        Ok(sound)
    }

    /// Which of the files that are there an output was made from, by the output in lower case.
    fn owners<'s>(&self, found: &'s Sources) -> HashMap<String, &'s Source> {
        let there: HashMap<&str, &Source> = found.files.iter().map(|s| (s.key.as_str(), s)).collect();
        let owner = |(output, known): (&String, &super::history::Known)| {
            let done = known.done.as_ref().map(|d| d.input.as_str());
            let input = done.or_else(|| known.failed.as_ref().map(|f| f.input.as_str()))?;
            Some((output.to_lowercase(), *there.get(input)?))
        };
        self.batch.history().outputs.iter().filter_map(owner).collect()
    }

    fn hold(&mut self, source: &Source, words: String, reasons: &mut HashSet<String>) {
        if reasons.insert(words.clone()) {
            (self.hear)(Notice::Held { source, error: &words });
        }
        self.settle.hold(&source.path, words, Instant::now() + RETRY);
    }
}

/// Whether the input is the reason, so that a watch sees to it.
fn is_about_input(why: Why) -> bool {
    matches!(why, Why::New | Why::Interrupted | Why::FailedBefore | Why::InputChanged)
}

/// Files that are not planned, but have an output that one of the items would get.
fn others<'s>(items: &[Item], owners: &HashMap<String, &'s Source>, planned: &[Source]) -> Vec<&'s Source> {
    let planned: HashSet<&str> = planned.iter().map(|s| s.key.as_str()).collect();
    let mut found = HashSet::new();
    items
        .iter()
        .filter_map(|item| owners.get(&item.output.to_lowercase()).copied())
        .filter(|owner| !planned.contains(owner.key.as_str()) && found.insert(owner.key.as_str()))
        .collect()
}
