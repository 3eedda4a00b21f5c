//! Batches: started here, or watched by the journal of one that was started elsewhere.

use std::convert::Infallible;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use axum::Json;
use axum::extract::{Path, State};
use axum::http::header::{CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::response::IntoResponse;
use axum::response::sse::{Event, KeepAlive, Sse};
use darkroot::path_text;
use darkroot::recipe::{Layer, Layers};
use darkroot_batch::facts::FOLDER;
use darkroot_batch::{ChartShot, PlanOptions, Search};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use tokio_stream::wrappers::ReceiverStream;

use super::aside;
use super::asked::{Body, Edits};
use crate::fault::Fault;
use crate::guard::REPORT_POLICY;
use crate::running::{Request, Running};
use crate::state::{Shared, locked};
use crate::watched::Watched;

/// Every batch that this window knows, in the order in which they were opened.
#[derive(Default)]
pub(crate) struct Batches {
    known: Mutex<Vec<(u64, Known)>>,
    last: AtomicU64,
}

/// A batch.
#[derive(Clone)]
enum Known {
    /// Of this window.
    Running(Arc<Running>),
    /// Of a terminal, or of yesterday.
    Watched(Arc<Watched>),
}

impl Known {
    fn told(&self) -> Value {
        match self {
            Self::Running(running) => json!(running.told()),
            Self::Watched(watched) => json!(watched.told()),
        }
    }

    fn out(&self) -> &std::path::Path {
        match self {
            Self::Running(running) => &running.request.options.out,
            Self::Watched(watched) => &watched.out,
        }
    }
}

/// Batches that are remembered, at most.
const KNOWN: usize = 50;

impl Batches {
    fn add(&self, batch: Known) -> u64 {
        let id = self.last.fetch_add(1, Ordering::SeqCst) + 1;
        let mut known = locked(&self.known);
        known.push((id, batch));
        if known.len() > KNOWN {
            known.remove(0);
        }
        id
    }

    fn get(&self, id: u64) -> Result<Known, Fault> {
        let known = locked(&self.known);
        let found = known.iter().find(|(of, _)| *of == id).map(|(_, batch)| batch.clone());
        found.ok_or_else(|| Fault::missing("this window knows no such batch"))
    }
}

fn told(id: u64, batch: &Known) -> Value {
    let mut told = batch.told();
    told["id"] = id.into();
    told["sheet"] = batch.out().join(SHEET).is_file().into();
    told["out"] = darkroot::shown(batch.out()).into();
    told
}

/// A batch that is to be run.
#[derive(Debug, Deserialize)]
pub(crate) struct Start {
    /// Folders and files.
    inputs: Vec<String>,
    /// Folder of the pictures; it is made if it is missing.
    out: String,
    /// Settings that hold for all of them, less than what stands in their sidecars.
    #[serde(default)]
    settings: Edits,
    /// Everything again, also what is done and unchanged.
    #[serde(default)]
    redo: bool,
    /// Replace pictures that no journal knows.
    #[serde(default)]
    overwrite: bool,
    /// What becomes of files whose pictures would have one name, as `--on-collision` has it; refused if this is missing.
    on_collision: Option<String>,
    /// Shot of a chart that gives white balance and profile; `auto` looks for one in each folder.
    chart_shot: Option<String>,
    /// Whether a contact sheet is written beside the pictures, `sheet.html`.
    #[serde(default)]
    sheet: bool,
}

/// Name of the contact sheet.
const SHEET: &str = "sheet.html";

/// Begins a batch.
pub(crate) async fn start(
    State(shared): State<Arc<Shared>>,
    Body(start): Body<Start>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let request = request(&shared, start)?;
        let running = Running::start(request, shared.crew.clone(), shared.store(), shared.wording.clone());
        let batch = Known::Running(running);
        let id = shared.batches.add(batch.clone());
        Ok(Json(told(id, &batch)))
    })
    .await
}

fn request(shared: &Shared, start: Start) -> Result<Request, Fault> {
    if start.inputs.is_empty() {
        return Err(Fault::asked("choose folders or files to develop"));
    }
    let mut inputs = Vec::new();
    for name in &start.inputs {
        let place = shared.roots.place(name)?;
        place.check()?;
        inputs.push(path_text::text(&place.path));
    }
    let out = shared.roots.place(&start.out)?;
    out.check()?;
    let values = super::asked::layer(shared, &out, &start.settings)?;
    let values = values.iter().map(|(key, text)| (key, text.to_owned()));
    let flags = Layer::flags(values).map_err(|e| Fault::asked(e.to_string()))?;
    let chart = match start.chart_shot.as_deref() {
        None | Some("") => None,
        Some("auto") => Some(of_chart(None)),
        Some(file) => Some(of_chart(Some(shared.roots.file(file)?.path))),
    };
    let mut options = PlanOptions::into(&out.path);
    options.redo = start.redo;
    options.overwrite = start.overwrite;
    if let Some(way) = &start.on_collision {
        options.on_collision =
            way.parse().map_err(|words| Fault::asked(format!("`on_collision`: {words}")))?;
    }
    Ok(Request {
        search: Search { inputs, ..Search::default() },
        options,
        layers: Layers::new(None, flags, true).map_err(|e| Fault::asked(e.to_string()))?,
        chart,
        sheet: start.sheet.then(|| out.path.join(SHEET)),
    })
}

/// Any chart with a built-in reference, in this file or in the one of each folder that shows one.
fn of_chart(file: Option<PathBuf>) -> ChartShot {
    ChartShot { file, layout: None, reference: None, light: None }
}

/// A folder of pictures.
#[derive(Debug, Deserialize)]
pub(crate) struct Out {
    out: String,
}

/// Watches the journal of a folder of pictures, whoever writes it.
pub(crate) async fn watch(
    State(shared): State<Arc<Shared>>,
    Body(Out { out }): Body<Out>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let place = shared.roots.place(&out)?;
        place.check()?;
        let same = |known: &Known| matches!(known, Known::Watched(watched) if watched.out == place.path);
        let found = locked(&shared.batches.known).iter().find(|(_, known)| same(known)).cloned();
        if let Some((id, batch)) = found {
            return Ok(Json(told(id, &batch)));
        }
        let watched = Watched::open(place.path).map_err(|e| Fault::missing(shared.wording.of(&e)))?;
        let batch = Known::Watched(Arc::new(watched));
        let id = shared.batches.add(batch.clone());
        Ok(Json(told(id, &batch)))
    })
    .await
}

/// Every batch, the newest first.
pub(crate) async fn list(State(shared): State<Arc<Shared>>) -> Result<Json<Vec<Value>>, Fault> {
    aside(move || {
        let known = locked(&shared.batches.known).clone();
        Ok(Json(known.iter().rev().map(|(id, batch)| told(*id, batch)).collect()))
    })
    .await
}

/// One batch.
pub(crate) async fn one(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
) -> Result<Json<Value>, Fault> {
    aside(move || Ok(Json(told(id, &shared.batches.get(id)?)))).await
}

/// The contact sheet of a batch, a page of its own.
pub(crate) async fn sheet(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
) -> Result<impl IntoResponse, Fault> {
    aside(move || {
        let out = shared.batches.get(id)?.out().join(SHEET);
        let name = shared.roots.name(&out).ok_or_else(|| Fault::missing("there is no contact sheet"))?;
        let place = shared.roots.file(&name)?;
        let page = place.read().map_err(|e| Fault::missing(e.to_string()))?;
        Ok(([(CONTENT_TYPE, "text/html; charset=utf-8"), (CONTENT_SECURITY_POLICY, REPORT_POLICY)], page))
    })
    .await
}

/// How often a batch tells what changed.
const OFTEN: Duration = Duration::from_millis(250);

/// A stream of events: what is to be said of a batch, whenever that changes.
pub(crate) async fn events(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
) -> Result<impl IntoResponse, Fault> {
    let batch = shared.batches.get(id)?;
    // Whoever reads slowly gets the newest when he has read the one before.
    let (send, receive) = tokio::sync::mpsc::channel::<Result<Event, Infallible>>(1);
    tokio::spawn(async move {
        let mut before = Value::Null;
        loop {
            let of_task = batch.clone();
            let Ok(now) = tokio::task::spawn_blocking(move || told(id, &of_task)).await else { return };
            if now != before {
                let Ok(event) = Event::default().json_data(&now) else { return };
                if send.send(Ok(event)).await.is_err() {
                    return;
                }
                before = now;
            }
            tokio::select! {
                () = tokio::time::sleep(OFTEN) => {}
                () = send.closed() => return,
            }
        }
    });
    Ok(Sse::new(ReceiverStream::new(receive)).keep_alive(KeepAlive::default()))
}

/// Finishes the files in flight and begins no more.
pub(crate) async fn pause(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
) -> Result<Json<Value>, Fault> {
    let batch = shared.batches.get(id)?;
    match &batch {
        Known::Running(running) => running.pause(),
        Known::Watched(_) => {
            return Err(Fault::conflict("this batch was started elsewhere: stop it there, with Ctrl-C"));
        }
    }
    Ok(Json(told(id, &batch)))
}

/// Goes on with what is left.
pub(crate) async fn resume(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let batch = shared.batches.get(id)?;
        match &batch {
            Known::Running(running) => Running::resume(running).map_err(Fault::conflict)?,
            Known::Watched(_) => {
                return Err(Fault::conflict(
                    "this batch was started elsewhere; start one here into the same folder",
                ));
            }
        }
        Ok(Json(told(id, &batch)))
    })
    .await
}

/// What became of files (`done`, `failed`), by their names: as this window's batches know, and the journals in the folders that
/// were opened and in those directly below.
pub(crate) async fn states(State(shared): State<Arc<Shared>>) -> Result<Json<Value>, Fault> {
    aside(move || {
        let mut found = Map::new();
        for folder in shared.roots.folders() {
            let below = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
            for out in below.chain([folder.clone()]).filter(|out| out.join(FOLDER).is_dir()) {
                // A journal that cannot be read is told where it is watched.
                let states = Watched::open(out).map(|watched| watched.states()).unwrap_or_default();
                for (key, state) in states {
                    let place =
                        shared.roots.folders().iter().map(|root| root.join(&key)).find(|path| path.is_file());
                    if let Some(name) = place.and_then(|path| shared.roots.name(&path)) {
                        found.insert(name, state.into());
                    }
                }
            }
        }
        for (_, batch) in locked(&shared.batches.known).iter() {
            if let Known::Running(running) = batch {
                let states = running.states();
                let named =
                    states.iter().filter_map(|(path, state)| Some((shared.roots.name(path)?, *state)));
                found.extend(named.map(|(name, state)| (name, state.into())));
            }
        }
        Ok(Json(found.into()))
    })
    .await
}
