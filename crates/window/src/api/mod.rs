//! The endpoints, `/api/v1/...` behind the token, as `docs/window.md` lists them: a file for each group.
//!
//! Requests and answers are JSON, but for pictures. What goes wrong is `{"error": "a sentence"}` with a status of HTTP.

use std::sync::Arc;

use axum::extract::{DefaultBodyLimit, Path, State};
use axum::middleware;
use axum::routing::{get, post};
use axum::{Json, Router};
use serde_json::{Value, json};

use crate::fault::Fault;
use crate::guard::{Guard, guard};
use crate::page;
use crate::state::Shared;

pub(crate) mod asked;
pub(crate) mod batch;
pub(crate) mod chart;
pub(crate) mod develop;
pub(crate) mod edits;
pub(crate) mod export;
pub(crate) mod files;
pub(crate) mod folders;

/// A request says what it wants in no more bytes than that.
const LARGEST_REQUEST: usize = 1 << 20;

/// All that the server answers.
pub(crate) fn router(shared: Arc<Shared>, gate: Arc<Guard>) -> Router {
    let api = Router::new()
        .route("/status", get(status))
        .route("/settings", get(settings))
        .route("/files", get(files::list))
        .route("/facts", post(files::facts))
        .route("/small", get(files::small))
        .route("/folders", get(folders::list))
        .route("/edits", get(edits::get).put(edits::put))
        .route("/edits/copy", post(edits::copy))
        .route("/stars", post(edits::stars))
        .route("/render", post(develop::render))
        .route("/frame", post(develop::frame))
        .route("/spot", post(develop::spot))
        .route("/balance", post(develop::balance))
        .route("/export", post(export::export))
        .route("/batch", get(batch::list).post(batch::start))
        .route("/states", get(batch::states))
        .route("/batch/watch", post(batch::watch))
        .route("/batch/{id}", get(batch::one))
        .route("/batch/{id}/events", get(batch::events))
        .route("/batch/{id}/sheet", get(batch::sheet))
        .route("/batch/{id}/pause", post(batch::pause))
        .route("/batch/{id}/resume", post(batch::resume))
        .route("/charts", get(chart::offers))
        .route("/chart/find", post(chart::find))
        .route("/chart/judge", post(chart::judge))
        .route("/chart/fit", post(chart::fit))
        .route("/chart/fit/{id}/report", get(chart::report))
        .route("/chart/fit/{id}/save", post(chart::save))
        .fallback(|| async { Fault::missing("there is no such endpoint; docs/window.md lists them") })
        .method_not_allowed_fallback(|| async { Fault::asked("this endpoint does not take that method") })
        .with_state(shared);
    let all = Router::new()
        .nest("/api/v1", api)
        .route("/", get(|| async { page::file("") }))
        .route("/{name}", get(|Path(name): Path<String>| async move { page::file(&name) }))
        .fallback(|| async { Fault::missing("there is no such page") })
        .layer(DefaultBodyLimit::max(LARGEST_REQUEST));
    // Paths are looked at when the guard has taken the token from them.
    Router::new().fallback_service(all).layer(middleware::from_fn_with_state(gate, guard))
}

/// Version, folders, and what became of requests for pictures.
async fn status(State(shared): State<Arc<Shared>>) -> Json<Value> {
    let folders: Vec<String> = shared.roots.folders().iter().map(darkroot::shown).collect();
    Json(json!({
        "version": darkroot::VERSION,
        "folders": folders,
        "only": shared.roots.only,
        "pictures": shared.latest.told(),
        "profiles": shared.profiles.as_ref().map(darkroot::shown),
    }))
}

/// The table of settings.
async fn settings() -> Json<Value> {
    Json(darkroot::settings::describe())
}

/// Does what takes its time where it keeps nobody waiting.
pub(crate) async fn aside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Fault> + Send + 'static,
) -> Result<T, Fault> {
    tokio::task::spawn_blocking(work).await.unwrap_or_else(|_| {
        let words = "the program made a mistake over this request; its own words are on the terminal";
        Err(Fault::new(axum::http::StatusCode::INTERNAL_SERVER_ERROR, words))
    })
}
