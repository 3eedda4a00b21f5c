//! Edits: what the sidecar of a file says.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use axum::response::{IntoResponse, Response};
use darkroot::recipe::{self, Layer};
use darkroot::{Effective, Key, metadata};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::aside;
use super::asked::{Asked, Body, Edits, Named, layer};
use crate::fault::Fault;
use crate::roots::Place;
use crate::state::{Shared, layers};

/// What holds for a file without its sidecar, what the sidecar says, and which state of it that is.
pub(crate) async fn get(
    State(shared): State<Arc<Shared>>,
    Asked(Named { file }): Asked<Named>,
) -> Result<Json<Value>, Fault> {
    aside(move || told(&shared.roots.file(&file)?)).await
}

fn told(place: &Place) -> Result<Json<Value>, Fault> {
    let unusable = |e: darkroot::RecipeError| Fault::unusable(e.to_string());
    let base = layers().and_then(|mut layers| layers.for_file_with(&place.path, None)).map_err(unusable)?;
    let edits = said(place)?;
    Ok(Json(json!({ "base": values(&base), "edits": edits, "version": version(place) })))
}

/// Text and origin of every setting.
fn values(effective: &Effective) -> Map<String, Value> {
    let one = |key: Key| {
        let (text, origin) = effective.get(key);
        (key.name().to_owned(), json!({ "text": text, "from": origin.to_string() }))
    };
    Key::all().map(one).collect()
}

/// What the sidecar says.
fn said(place: &Place) -> Result<Edits, Fault> {
    let edits = recipe::edits(&place.path).map_err(|e| Fault::unusable(e.to_string()))?;
    let texts =
        |layer: &Layer| layer.iter().map(|(key, text)| (key.name().to_owned(), text.to_owned())).collect();
    Ok(edits.as_ref().map(texts).unwrap_or_default())
}

/// Tells one state of a sidecar from another; empty where there is none.
fn version(place: &Place) -> String {
    let bytes = darkroot::files::read_text(&recipe::sidecar(&place.path));
    bytes.map(|bytes| darkroot::files::sha256(&bytes)[..16].to_owned()).unwrap_or_default()
}

/// What a sidecar shall say.
#[derive(Debug, Deserialize)]
pub(crate) struct Put {
    file: String,
    edits: Edits,
    /// The state that the edits began with; written over whatever there is, if it is missing.
    version: Option<String>,
}

/// Writes the sidecar of a file.
pub(crate) async fn put(State(shared): State<Arc<Shared>>, Body(put): Body<Put>) -> Result<Response, Fault> {
    aside(move || {
        let place = shared.roots.file(&put.file)?;
        let layer = layer(&shared, &place, &put.edits)?;
        if put.version.is_some_and(|known| known != version(&place)) {
            return Err(Fault::conflict(
                "somebody else changed the edits of this file meanwhile: load them, or save yours over them",
            ));
        }
        write(&place, &layer)?;
        Ok(told(&place)?.into_response())
    })
    .await
}

fn write(place: &Place, layer: &Layer) -> Result<(), Fault> {
    recipe::write_sidecar(&place.root, &place.path, layer).map_err(|e| Fault::unusable(e.to_string()))
}

/// Settings that are copied from one file to others.
#[derive(Debug, Deserialize)]
pub(crate) struct Copy {
    files: Vec<String>,
    /// What their sidecars shall say of `settings`.
    edits: Edits,
    /// Names of the settings that are copied: one that `edits` does not have is taken away.
    settings: Vec<String>,
}

/// Copies settings into the sidecars of files. What their sidecars say of other settings stays.
pub(crate) async fn copy(
    State(shared): State<Arc<Shared>>,
    Body(copy): Body<Copy>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let changed = |file: &String| {
            let place = shared.roots.file(file)?;
            let mut edits = said(&place)?;
            for name in &copy.settings {
                match copy.edits.get(name) {
                    Some(text) => edits.insert(name.clone(), text.clone()),
                    None => edits.remove(name),
                };
            }
            write(&place, &layer(&shared, &place, &edits)?)
        };
        Ok(each(&copy.files, changed))
    })
    .await
}

/// Stars for files.
#[derive(Debug, Deserialize)]
pub(crate) struct Stars {
    files: Vec<String>,
    stars: u8,
}

/// Gives files stars, 0 to 5, in their sidecars.
pub(crate) async fn stars(
    State(shared): State<Arc<Shared>>,
    Body(Stars { files, stars }): Body<Stars>,
) -> Result<Json<Value>, Fault> {
    const TAGS: &str = "set-tag";
    aside(move || {
        let starred = |file: &String| {
            let place = shared.roots.file(file)?;
            let mut edits = said(&place)?;
            let tags = edits.get(TAGS).map(String::as_str).unwrap_or_default();
            let tags = metadata::with_rating(tags, stars);
            edits.insert(TAGS.to_owned(), tags);
            write(&place, &layer(&shared, &place, &edits)?)
        };
        Ok(each(&files, starred))
    })
    .await
}

/// How many files were changed, and what went wrong with the others.
fn each(files: &[String], change: impl Fn(&String) -> Result<(), Fault>) -> Json<Value> {
    let faults: Vec<Value> = files
        .iter()
        .filter_map(|file| Some(json!({ "file": file, "error": change(file).err()?.words })))
        .collect();
    Json(json!({ "done": files.len() - faults.len(), "faults": faults }))
}
