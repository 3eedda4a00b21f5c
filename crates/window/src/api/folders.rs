//! Folders, to choose where pictures go.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use darkroot_batch::facts::FOLDER;
use serde::Deserialize;
use serde_json::{Value, json};

use super::aside;
use super::asked::Asked;
use crate::fault::Fault;
use crate::state::Shared;

/// A folder by its name; all that were opened, if it is missing.
#[derive(Debug, Deserialize)]
pub(crate) struct Below {
    folder: Option<String>,
}

/// The folders in a folder, and whether a batch has written there.
pub(crate) async fn list(
    State(shared): State<Arc<Shared>>,
    Asked(Below { folder }): Asked<Below>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let Some(folder) = folder else {
            let one = |(i, path): (usize, &std::path::PathBuf)| json!({ "folder": format!("{i}/"), "shown": darkroot::shown(path), "journal": has_journal(path) });
            return Ok(Json(shared.roots.folders().iter().enumerate().map(one).collect()));
        };
        let place = shared.roots.place(&folder)?;
        place.check()?;
        let failed = |e| Fault::missing(format!("{}: cannot be read: {e}", darkroot::shown(&place.path)));
        let mut found = Vec::new();
        for entry in std::fs::read_dir(&place.path).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let path = entry.path();
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            let hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
            if let Some(name) = shared.roots.name(&path).filter(|_| is_folder && !hidden) {
                found.push((entry.file_name(), name, path));
            }
        }
        found.sort();
        let one = |(name, folder, path): &(std::ffi::OsString, String, std::path::PathBuf)| {
            json!({ "folder": folder, "shown": darkroot::shown(name), "journal": has_journal(path) })
        };
        Ok(Json(found.iter().map(one).collect()))
    })
    .await
}

fn has_journal(path: &std::path::Path) -> bool {
    path.join(FOLDER).is_dir()
}
