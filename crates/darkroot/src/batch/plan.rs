//! What a batch is going to do, decided before anything is written.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot_encode::Format;
use rayon::prelude::*;

use super::crew::{Crew, CrewOptions};
use super::find::{Source, Sources};
use super::history::History;
use super::names::{self, Collision, Fields};
use super::record::{CameraNames, Done};
use super::session::SessionColour;
use super::shard::Shard;
use super::state::{Profiles, state};
use super::stop::Stop;
use super::{Header, hash};
use crate::naming::Target;
use crate::recipe::Layers;
use crate::{ProfileStore, Settings};

/// What outputs with one name become.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnCollision {
    /// Nothing is done at all.
    #[default]
    Refuse,
    /// They get different names.
    Suffix,
}

/// How a plan is made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanOptions {
    /// The output folder.
    pub out: PathBuf,
    /// Names of outputs below it; [`names::MIRRORED`] mirrors the inputs' tree.
    pub template: String,
    /// Outputs with one name.
    pub on_collision: OnCollision,
    /// Whether files that no journal knows may be replaced.
    pub overwrite: bool,
    /// Whether everything is done again.
    pub redo: bool,
    /// Whether outputs are read again and compared with the journal.
    pub verify: bool,
    /// Which part.
    pub shard: Shard,
}

impl PlanOptions {
    /// Everything that is to be done, into this folder.
    pub fn into(out: &Path) -> Self {
        Self {
            out: out.to_owned(),
            template: names::MIRRORED.to_owned(),
            on_collision: OnCollision::Refuse,
            overwrite: false,
            redo: false,
            verify: false,
            shard: Shard::WHOLE,
        }
    }
}

/// Why a file is to be developed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// It never was.
    New,
    /// A run ended in the middle of it.
    Interrupted,
    /// It failed before.
    FailedBefore,
    /// The input has another content than then.
    InputChanged,
    /// Other settings than then.
    SettingsChanged,
    /// The profile is another than then.
    ProfileChanged,
    /// The output is gone.
    OutputMissing,
    /// The output was damaged on the disk: another content at the same time of change.
    OutputDamaged,
    /// It was asked for.
    Asked,
}

/// What is to be done with a file.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// Develop it.
    Todo(Why),
    /// Nothing: done and unchanged.
    Done(Box<Done>),
    /// It cannot be done, for this reason.
    Conflict(String),
}

/// Settings that hold for one or more files.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Every setting as text.
    pub texts: BTreeMap<String, String>,
    /// The same, typed.
    pub settings: Settings,
    /// Format of the outputs.
    pub format: Format,
    /// What hashes go by: texts without the profile's path.
    canonical: String,
}

/// One file of a plan.
#[derive(Debug, Clone)]
pub struct Item {
    /// The input.
    pub source: Source,
    /// The output's path below the output folder, with forward slashes.
    pub output: String,
    /// Its number.
    pub number: usize,
    /// Its settings.
    pub prepared: Arc<Prepared>,
    /// Colours of its session.
    pub session: Arc<Vec<SessionColour>>,
    /// What is to be done.
    pub state: State,
}

impl Item {
    /// SHA-256 of all that a file of this camera is developed with, without where the profile's file lies.
    pub(super) fn settings_hash(&self, camera: &CameraNames) -> String {
        let mut text = self.prepared.canonical.clone();
        if let Some(c) = self.session.iter().find(|c| c.camera == *camera) {
            text += &format!("session={} {} {:?}\n", c.chart, c.sha256, c.multipliers);
        }
        hash::text(&text)
    }
}

/// A batch, ready to run.
#[derive(Debug, Clone, Default)]
pub struct Plan {
    /// The output folder.
    pub out: PathBuf,
    /// Names of outputs.
    pub template: String,
    /// All files of the shard.
    pub items: Vec<Item>,
    /// What could not be read while looking for inputs.
    pub faults: Vec<String>,
}

/// Why there is no plan. Each message says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// Names of outputs.
    #[error(transparent)]
    Naming(#[from] crate::NamingError),
    /// Settings.
    #[error(transparent)]
    Recipe(#[from] crate::RecipeError),
    /// Settings that contradict each other.
    #[error("{input}: {source}")]
    Settings {
        /// The first input that they hold for.
        input: String,
        /// What contradicts.
        source: crate::SettingsError,
    },
    /// Outputs with one name.
    #[error("{}", collision_list(.0))]
    Collisions(Vec<Collision>),
    /// An output is an input.
    #[error("{path}: is an input of this batch and would be overwritten by a picture; choose another `-o`")]
    OverInput {
        /// The file.
        path: String,
    },
}

fn collision_list(collisions: &[Collision]) -> String {
    const SHOWN: usize = 20;
    let mut text = format!(
        "several inputs would be written to one output, for {} of them; add `--on-collision suffix`, or name them \
         apart with `--name`:",
        collisions.len()
    );
    for c in collisions.iter().take(SHOWN) {
        text += &format!("\n  {}: {}", c.output, c.inputs.join(", "));
    }
    if collisions.len() > SHOWN {
        text += &format!("\n  and {} more", collisions.len() - SHOWN);
    }
    text
}

/// Settings by folder and file, each kind kept once.
#[derive(Debug)]
pub struct Recipes {
    layers: Layers,
    kept: HashMap<String, Arc<Prepared>>,
}

impl Recipes {
    /// From layers of settings.
    pub fn new(layers: Layers) -> Self {
        Self { layers, kept: HashMap::new() }
    }

    /// What holds for a file. `target` tells the format where no setting does.
    fn of(&mut self, source: &Source, target: &Target) -> Result<Arc<Prepared>, PlanError> {
        let effective = self.layers.for_file(&source.path)?;
        let mut settings = effective.settings()?;
        let format = effective.format(target, &settings, self.layers.flags())?;
        settings.format = Some(format);
        let texts = effective.texts();
        let mut canonical = format!("format={}\n", format.extension());
        for (name, text) in &texts {
            let file = name == "profile" && text != "auto" && text != "matrix";
            let text = if file { "(a file)" } else { text };
            canonical += &format!("{name}={text}\n");
        }
        let place = texts.get("profile").cloned().unwrap_or_default();
        let kept = self.kept.entry(canonical.clone() + &place);
        if let std::collections::hash_map::Entry::Occupied(kept) = kept {
            return Ok(Arc::clone(kept.get()));
        }
        settings.resolve(format).map_err(|e| PlanError::Settings { input: source.key.clone(), source: e })?;
        let prepared = Arc::new(Prepared { texts, settings, format, canonical });
        Ok(Arc::clone(kept.or_insert(prepared)))
    }
}

/// Decides about every file.
///
/// `headers` is asked for what stands inside files when names need it; `session` gives the colours of a file's
/// session.
///
/// # Errors
/// Wrong settings, wrong names, names that collide.
pub(super) fn plan(
    sources: Sources,
    options: &PlanOptions,
    recipes: &mut Recipes,
    history: &History,
    store: &ProfileStore,
    headers: &mut dyn FnMut(&[Source]) -> Vec<Header>,
    session: &dyn Fn(&Source) -> Arc<Vec<SessionColour>>,
) -> Result<Plan, PlanError> {
    let files = sources.files;
    let prepared = prepare(&files, options, recipes)?;
    let numbers = numbers(&files, history);
    let heads = if names::needs_headers(&options.template) { headers(&files) } else { Vec::new() };
    let mut outputs = name(&files, options, &prepared, &numbers, &heads)?;
    let collisions = names::collisions(&outputs);
    if !collisions.is_empty() {
        if options.on_collision == OnCollision::Refuse {
            return Err(PlanError::Collisions(collisions));
        }
        let owner = |output: &str| history.outputs.get(output)?.done.as_ref().map(|d| d.input.clone());
        names::resolve(&mut outputs, owner);
    }
    refuse_over_inputs(&files, &outputs, &options.out)?;

    let items: Vec<Item> = files
        .into_iter()
        .zip(outputs)
        .zip(prepared.into_iter().zip(numbers))
        .filter(|((file, _), _)| options.shard.has(&file.key))
        .map(|((source, (_, output)), (prepared, number))| {
            let session = session(&source);
            Item { source, output, number, prepared, session, state: State::Todo(Why::New) }
        })
        .collect();
    let mut plan =
        Plan { out: options.out.clone(), template: options.template.clone(), items, faults: sources.faults };
    let profiles = Profiles::of(store);
    let states: Vec<State> = plan
        .items
        .par_iter()
        .map(|item| state(item, options, history.outputs.get(&item.output), &profiles))
        .collect();
    for (item, state) in plan.items.iter_mut().zip(states) {
        item.state = state;
    }
    Ok(plan)
}

/// Finds what is wrong with settings and names before even the output folder is made.
///
/// # Errors
/// Wrong settings, wrong names, names that collide, as far as they do not depend on what stands inside the files.
pub fn check(sources: &Sources, options: &PlanOptions, recipes: &mut Recipes) -> Result<(), PlanError> {
    let prepared = prepare(&sources.files, options, recipes)?;
    let numbers: Vec<usize> = (1..=sources.files.len()).collect();
    let outputs = name(&sources.files, options, &prepared, &numbers, &[])?;
    let collisions = names::collisions(&outputs);
    let certain = !names::needs_headers(&options.template) && options.on_collision == OnCollision::Refuse;
    if certain && !collisions.is_empty() {
        return Err(PlanError::Collisions(collisions));
    }
    Ok(())
}

/// The settings of every file.
fn prepare(
    files: &[Source],
    options: &PlanOptions,
    recipes: &mut Recipes,
) -> Result<Vec<Arc<Prepared>>, PlanError> {
    let target = target(&options.template)?;
    files.iter().map(|f| recipes.of(f, &target)).collect()
}

/// Every input's key with its output.
fn name(
    files: &[Source],
    options: &PlanOptions,
    prepared: &[Arc<Prepared>],
    numbers: &[usize],
    heads: &[Header],
) -> Result<Vec<(String, String)>, PlanError> {
    let mut outputs = Vec::with_capacity(files.len());
    for (i, file) in files.iter().enumerate() {
        let head = heads.get(i).cloned().unwrap_or_default();
        let parent = std::path::absolute(&file.path).unwrap_or_else(|_| file.path.clone());
        let parent = parent.parent().and_then(Path::file_name).map(|n| n.to_string_lossy().into_owned());
        let fields = Fields {
            key: file.key.clone(),
            ext: prepared[i].format.extension().to_owned(),
            number: numbers[i],
            camera: head.camera,
            date: head.date,
            parent: parent.unwrap_or_default(),
        };
        outputs.push((file.key.clone(), names::fill(&options.template, &fields)?));
    }
    Ok(outputs)
}

/// A plan for looking at only: nothing is written, no session is coloured.
///
/// # Errors
/// Wrong settings, wrong names, names that collide.
pub fn plan_only(
    sources: Sources,
    options: &PlanOptions,
    recipes: &mut Recipes,
    history: &History,
    store: &ProfileStore,
    crew: CrewOptions,
) -> Result<Plan, PlanError> {
    let mut crew = Crew::new(crew);
    let mut headers = |files: &[Source]| super::run::read_headers(&mut crew, files, &Stop::default());
    plan(sources, options, recipes, history, store, &mut headers, &|_| Arc::default())
}

/// What the template says of the format.
fn target(template: &str) -> Result<Target, PlanError> {
    Ok(if template.ends_with("{ext}") || Target::Template(template.to_owned()).format().is_ok() {
        Target::Template(template.to_owned())
    } else {
        let path = PathBuf::from(template);
        return Err(crate::NamingError::Format { path }.into());
    })
}

/// The number of each file: the one that it had before, else the next after the largest.
fn numbers(files: &[Source], history: &History) -> Vec<usize> {
    let mut next = history.numbers.values().max().map_or(1, |n| n + 1);
    let mut number = |file: &Source| {
        history.numbers.get(&file.key).copied().unwrap_or_else(|| {
            next += 1;
            next - 1
        })
    };
    files.iter().map(&mut number).collect()
}

fn refuse_over_inputs(files: &[Source], outputs: &[(String, String)], out: &Path) -> Result<(), PlanError> {
    let real = |p: &Path| std::fs::canonicalize(p).ok();
    let inputs: std::collections::HashSet<PathBuf> = files.iter().filter_map(|f| real(&f.path)).collect();
    for (_, output) in outputs {
        if real(&out.join(output)).is_some_and(|path| inputs.contains(&path)) {
            return Err(PlanError::OverInput { path: output.clone() });
        }
    }
    Ok(())
}
