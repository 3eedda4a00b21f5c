//! Folders to folders.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use darkroot::path_text;
use darkroot::recipe::{Layer, Layers};
use darkroot_batch::{
    Batch, BatchError, CrewOptions, Event, OnCollision, PlanOptions, Search, Session, SettingsByFile, Shard,
    Stop, Summary, Workers, find,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};

use crate::fault::{Class, OrException};
use crate::settings::Asked;
use crate::{json, run, store};

/// Endings of raw files.
#[pyfunction]
pub(crate) fn endings() -> Vec<&'static str> {
    darkroot_batch::filter::RAW_ENDINGS.to_vec()
}

/// What a batch is asked for beside its settings, as Python gives it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Said {
    inputs: Vec<PathBuf>,
    out: PathBuf,
    name: Option<String>,
    on_collision: String,
    overwrite: bool,
    redo: bool,
    verify: bool,
    recursive: bool,
    include: Vec<String>,
    exclude: Vec<String>,
    shard: Option<String>,
    /// The program whose processes are the workers; threads of this process without it.
    program: Option<PathBuf>,
    jobs: Option<usize>,
    threads: Option<usize>,
    memory: Option<u64>,
    timeout: f64,
    folders: bool,
}

impl Said {
    fn search(&self) -> Search {
        Search {
            inputs: self.inputs.iter().map(|input| path_text::text(input)).collect(),
            flat: !self.recursive,
            include: self.include.clone(),
            exclude: self.exclude.clone(),
            ..Search::default()
        }
    }

    fn plan(&self) -> PyResult<PlanOptions> {
        let mut options = PlanOptions::into(&self.out);
        if let Some(name) = &self.name {
            options.template.clone_from(name);
        }
        options.on_collision = match self.on_collision.as_str() {
            "refuse" => OnCollision::Refuse,
            "suffix" => OnCollision::Suffix,
            other => {
                let words = format!("`on_collision` cannot be `{other}`; it is refuse or suffix");
                return Err(Class::Settings.says(words));
            }
        };
        options.overwrite = self.overwrite;
        options.redo = self.redo;
        options.verify = self.verify;
        if let Some(shard) = &self.shard {
            let parsed = Shard::parse(shard, |name| std::env::var(name).ok());
            options.shard = parsed.map_err(|fault| Class::Settings.says(fault.to_string()))?;
        }
        Ok(options)
    }

    fn crew(&self) -> PyResult<CrewOptions> {
        let usual = match &self.program {
            Some(program) => CrewOptions::new(program.clone(), vec!["worker".into()]),
            None => CrewOptions::in_process((*store::store()).clone()),
        };
        let timeout = Duration::try_from_secs_f64(self.timeout).ok().filter(|time| !time.is_zero());
        let threads = self.threads.unwrap_or(usual.threads).max(1);
        Ok(CrewOptions {
            threads,
            jobs: self.jobs.unwrap_or(threads).max(1),
            memory: self.memory.unwrap_or(usual.memory),
            timeout: timeout
                .ok_or_else(|| Class::Settings.says("`timeout` is a number of seconds above 0"))?,
            ..usual
        })
    }
}

/// Develops folders; :func:`darkroot.batch` says more. `on_event` gets a dictionary for each event.
#[pyfunction]
pub(crate) fn batch<'py>(
    py: Python<'py>,
    said: Said,
    on_event: Option<Py<PyAny>>,
    recipe: Option<&Bound<'py, PyAny>>,
    settings: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyAny>> {
    let flags = Layer::flags(Asked::of(recipe, Some(settings))?.texts()?).or_exception()?;
    let layers = Layers::new(None, flags, said.folders).or_exception()?;
    let (search, options, crew) = (said.search(), said.plan()?, said.crew()?);
    let in_processes = matches!(crew.workers, Workers::Processes(..));
    let stop = Stop::default();
    let asked = stop.clone();
    // Ctrl-C abandons worker processes at once; threads finish the files that they have.
    let ask = move || {
        stop.ask();
        if in_processes {
            stop.ask();
        }
    };
    let work =
        move |_: &darkroot::Cancel| develop(&search, &options, crew, layers, &asked, on_event.as_ref());
    let done = run::run_until(py, &Arc::default(), ask, work)?;
    json::python(py, done?)
}

fn develop(
    search: &Search,
    options: &PlanOptions,
    crew: CrewOptions,
    layers: Layers,
    stop: &Stop,
    on_event: Option<&Py<PyAny>>,
) -> PyResult<Value> {
    let of_batch = |fault: BatchError| match fault {
        BatchError::Out { .. } | BatchError::Journal(_) | BatchError::Worker(_) => {
            Class::Storage.says(fault.to_string())
        }
        other => Class::Settings.says(other.to_string()),
    };
    let mut settings = SettingsByFile::new(layers);
    let sources = find(search, &options.out).map_err(|fault| Class::Missing.says(fault.to_string()))?;
    darkroot_batch::check(&sources, options, &mut settings)
        .map_err(|fault| Class::Settings.says(fault.to_string()))?;
    let mut batch = Batch::open(options, crew, (*store::store()).clone()).map_err(of_batch)?;
    let plan = batch.plan(sources, options, &mut settings, &Session::default(), stop).map_err(of_batch)?;
    let mut raised = None;
    let mut failures = Vec::new();
    let mut hear = |event: Event<'_>| {
        let told = words(&event);
        if told["event"] == "failed" {
            failures.push(told.clone());
        }
        if let (Some(callback), true) = (on_event, raised.is_none()) {
            let heard = Python::attach(|py| callback.call1(py, (json::python(py, told)?,)).map(drop));
            if let Err(fault) = heard {
                // What the callback raises ends the batch.
                raised = Some(fault);
                stop.ask();
            }
        }
    };
    let summary = batch.run(&plan, stop, &mut hear).map_err(of_batch)?;
    match raised {
        Some(fault) => Err(fault),
        None => Ok(told(&summary, &failures, plan.faults.iter().map(ToString::to_string).collect())),
    }
}

fn told(summary: &Summary, failures: &[Value], faults: Vec<String>) -> Value {
    json!({
        "done": summary.done, "failed": summary.failed, "skipped": summary.skipped, "left": summary.left,
        "interrupted": summary.interrupted, "seconds": summary.seconds, "pixels": summary.pixels,
        "peak_memory": summary.peak, "failures": failures, "faults": faults,
        "stopped": summary.stopped.as_ref().map(ToString::to_string),
    })
}

/// An event as the program's `--json` has it.
fn words(event: &Event<'_>) -> Value {
    let input = |item: &darkroot_batch::Item| path_text::text(&item.source.path);
    match event {
        Event::Begun(item) => json!({ "event": "begun", "input": input(item), "output": item.output }),
        Event::Done { item, done, colours, .. } => {
            let mut told = serde_json::to_value(done).unwrap_or_default();
            told["event"] = "done".into();
            told["input"] = input(item).into();
            told["colours"] = (*colours).into();
            told
        }
        Event::Failed { item, words, .. } => {
            json!({ "event": "failed", "input": input(item), "output": item.output, "error": words })
        }
        Event::Later(item) => json!({ "event": "later", "input": input(item) }),
        Event::Gone(item) => json!({ "event": "gone", "input": input(item) }),
        Event::Stopping { words, .. } => json!({ "event": "stopping", "error": words }),
    }
}
