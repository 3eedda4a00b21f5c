//! What a batch is going to do, decided before anything is written.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot::naming::Target;
use darkroot::{ProfileStore, path_text};
use rayon::prelude::*;

use super::crew::Crew;
use super::crew_options::CrewOptions;
use super::facts::{Header, SessionColour};
use super::find::{Source, Sources};
use super::headers::read_headers;
use super::history::History;
use super::item::{BatchPlan, FileSettings, Item, OnCollision, PlanOptions, State, Why};
use super::names::{self, Fields};
use super::plan_fault::PlanFault;
use super::settings_by_file::SettingsByFile;
use super::state::{Profiles, state};
use super::stop::Stop;

/// Decides about every file.
///
/// `headers` is asked for what stands inside files when names need it; `session` gives the colours of a file's
/// session.
///
/// # Errors
/// Wrong settings, wrong names, names that collide.
pub(crate) fn plan(
    sources: Sources,
    options: &PlanOptions,
    recipes: &mut SettingsByFile,
    history: &History,
    store: &ProfileStore,
    headers: &mut dyn FnMut(&[Source]) -> Vec<Header>,
    session: &dyn Fn(&Source) -> Arc<Vec<SessionColour>>,
) -> Result<BatchPlan, PlanFault> {
    let files = sources.files;
    let prepared = prepare(&files, options, recipes)?;
    let numbers = numbers(&files, history);
    let heads = if names::needs_headers(&options.template) { headers(&files) } else { Vec::new() };
    let mut outputs = name(&files, options, &prepared, &numbers, &heads)?;
    let collisions = names::collisions(&outputs);
    let mut left_out = Vec::new();
    if !collisions.is_empty() {
        let owner = |output: &str| history.outputs.get(output)?.done.as_ref().map(|d| d.input.clone());
        match &options.on_collision {
            OnCollision::Refuse => return Err(PlanFault::Collisions(collisions)),
            OnCollision::Suffix => names::resolve(&mut outputs, owner),
            OnCollision::Skip => left_out = names::left_out(&outputs, &[], owner),
            OnCollision::Prefer(endings) => left_out = names::left_out(&outputs, endings, owner),
        }
    }
    refuse_over_inputs(&files, &outputs, &options.out)?;

    let profiles = Profiles::of(store);
    let out: HashSet<&str> = left_out.iter().map(|left| left.input.as_str()).collect();
    let items: Vec<Item> = files
        .into_iter()
        .zip(outputs)
        .zip(prepared.into_iter().zip(numbers))
        .filter(|((file, _), _)| options.shard.has(&file.key))
        .filter(|((file, _), _)| !out.contains(file.key.as_str()))
        .map(|((source, (_, output)), (prepared, number))| {
            let session = session(&source);
            let files = profiles.files(&prepared.settings).unwrap_or_default();
            Item { source, output, number, prepared, files, session, state: State::Todo(Why::New) }
        })
        .collect();
    let mut plan = BatchPlan {
        overwrite: options.overwrite,
        out: options.out.clone(),
        template: options.template.clone(),
        items,
        left_out,
        faults: sources.faults,
    };
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
pub fn check(
    sources: &Sources,
    options: &PlanOptions,
    recipes: &mut SettingsByFile,
) -> Result<(), PlanFault> {
    let prepared = prepare(&sources.files, options, recipes)?;
    let numbers: Vec<usize> = (1..=sources.files.len()).collect();
    let outputs = name(&sources.files, options, &prepared, &numbers, &[])?;
    let collisions = names::collisions(&outputs);
    let certain = !names::needs_headers(&options.template) && options.on_collision == OnCollision::Refuse;
    if certain && !collisions.is_empty() {
        return Err(PlanFault::Collisions(collisions));
    }
    Ok(())
}

/// The settings of every file.
fn prepare(
    files: &[Source],
    options: &PlanOptions,
    recipes: &mut SettingsByFile,
) -> Result<Vec<Arc<FileSettings>>, PlanFault> {
    let target = target(&options.template)?;
    files.iter().map(|f| recipes.of(f, &target)).collect()
}

/// Every input's key with its output.
fn name(
    files: &[Source],
    options: &PlanOptions,
    prepared: &[Arc<FileSettings>],
    numbers: &[usize],
    heads: &[Header],
) -> Result<Vec<(String, String)>, PlanFault> {
    let mut outputs = Vec::with_capacity(files.len());
    for (i, file) in files.iter().enumerate() {
        let head = heads.get(i).cloned().unwrap_or_default();
        let parent = std::path::absolute(&file.path).unwrap_or_else(|_| file.path.clone());
        let fields = Fields {
            ext: prepared[i].format.extension().to_owned(),
            number: numbers[i],
            camera: head.camera,
            date: head.date,
            parent: parent.parent().and_then(Path::file_name).unwrap_or_default().to_owned(),
            ..names::fields(&file.key)
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
    recipes: &mut SettingsByFile,
    history: &History,
    store: &ProfileStore,
    crew: CrewOptions,
) -> Result<BatchPlan, PlanFault> {
    let mut crew = Crew::new(crew);
    let mut headers = |files: &[Source]| read_headers(&mut crew, files, &Stop::default());
    plan(sources, options, recipes, history, store, &mut headers, &|_| Arc::default())
}

/// What the template says of the format.
fn target(template: &str) -> Result<Target, PlanFault> {
    Ok(if template.ends_with("{ext}") || Target::Template(template.to_owned()).format().is_ok() {
        Target::Template(template.to_owned())
    } else {
        let path = PathBuf::from(template);
        return Err(darkroot::NamingError::Format { path }.into());
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

fn refuse_over_inputs(files: &[Source], outputs: &[(String, String)], out: &Path) -> Result<(), PlanFault> {
    let real = |p: &Path| std::fs::canonicalize(p).ok();
    let inputs: HashSet<PathBuf> = files.iter().filter_map(|f| real(&f.path)).collect();
    for (_, output) in outputs {
        let path = out.join(path_text::path(output));
        if real(&path).is_some_and(|path| inputs.contains(&path)) {
            return Err(PlanFault::OverInput { path });
        }
    }
    Ok(())
}
