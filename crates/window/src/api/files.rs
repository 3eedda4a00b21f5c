//! Files, what is known of them, and their small pictures.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::IntoResponse;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::aside;
use super::asked::{Asked, Body};
use crate::facts::Facts;
use crate::fault::Fault;
use crate::state::Shared;

/// A raw file of the folders that were opened.
#[derive(Debug, Serialize)]
struct Listed {
    file: String,
    size: u64,
    /// Time of its last change, milliseconds since 1970.
    modified: i64,
}

/// Every raw file, by folder and name.
pub(crate) async fn list(State(shared): State<Arc<Shared>>) -> Result<Json<Value>, Fault> {
    aside(move || {
        let nowhere = std::path::Path::new("");
        let found = darkroot_batch::find(&shared.roots.search(), nowhere)
            .map_err(|e| Fault::missing(shared.wording.of(&e)))?;
        let listed = |source: &darkroot_batch::Source| {
            let file = shared.roots.name(&source.path)?;
            Some(Listed { file, size: source.size, modified: source.modified / 1_000_000 })
        };
        let files: Vec<Listed> = found.files.iter().filter_map(listed).collect();
        let faults: Vec<String> = found.faults.iter().map(|fault| shared.wording.of(fault)).collect();
        Ok(Json(json!({ "files": files, "faults": faults })))
    })
    .await
}

/// Names of files.
#[derive(Debug, Deserialize)]
pub(crate) struct Names {
    files: Vec<String>,
}

/// Files whose facts are told at once, at most.
const AT_ONCE: usize = 64;

/// What is known of some files, in the order of their names; a fault where one is not there.
pub(crate) async fn facts(
    State(shared): State<Arc<Shared>>,
    Body(Names { files }): Body<Names>,
) -> Result<Json<Vec<Value>>, Fault> {
    if files.len() > AT_ONCE {
        return Err(Fault::asked(format!("at most {AT_ONCE} files at once")));
    }
    aside(move || {
        let one = |name: &String| -> Result<Facts, Fault> {
            let place = shared.roots.file(name)?;
            Ok(shared.facts.of(name, &place))
        };
        let told = |name: &String| match one(name) {
            Ok(facts) => json!(facts),
            Err(fault) => json!({ "fault": fault.words }),
        };
        Ok(Json(files.iter().map(told).collect()))
    })
    .await
}

/// A small picture that is asked for.
#[derive(Debug, Deserialize)]
pub(crate) struct Small {
    file: String,
    /// Whether a coarse one will do, if it is there sooner.
    #[serde(default)]
    quick: bool,
}

/// The small picture of a file.
pub(crate) async fn small(
    State(shared): State<Arc<Shared>>,
    Asked(Small { file, quick }): Asked<Small>,
) -> Result<impl IntoResponse, Fault> {
    let picture = aside(move || {
        let place = shared.roots.file(&file)?;
        shared.smalls.of(&file, &place, &shared.store(), quick)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "image/jpeg"), (CACHE_CONTROL, "private, max-age=3600")], picture.to_vec()))
}
