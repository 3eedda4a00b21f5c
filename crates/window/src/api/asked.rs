//! What requests have in common: a file, and what is to hold for it.

use std::collections::BTreeMap;

use axum::Json;
use axum::extract::{FromRequest, FromRequestParts, Query, Request};
use axum::http::request::Parts;
use darkroot::recipe::{self, Layer};
use darkroot::{Effective, Key, Settings};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::fault::Fault;
use crate::roots::Place;
use crate::screen::named_files;
use crate::state::{Shared, layers};

/// A body of JSON; what is wrong with it is told as every other fault.
pub(crate) struct Body<T>(pub(crate) T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequest<S> for Body<T> {
    type Rejection = Fault;

    async fn from_request(request: Request, state: &S) -> Result<Self, Fault> {
        match Json::from_request(request, state).await {
            Ok(Json(body)) => Ok(Self(body)),
            Err(rejection) => Err(Fault::new(rejection.status(), rejection.body_text())),
        }
    }
}

/// The query of an address.
pub(crate) struct Asked<T>(pub(crate) T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Asked<T> {
    type Rejection = Fault;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Fault> {
        match Query::from_request_parts(parts, state).await {
            Ok(Query(query)) => Ok(Self(query)),
            Err(rejection) => Err(Fault::new(rejection.status(), rejection.body_text())),
        }
    }
}

/// Texts by the names of settings: what the sidecar of a file says, or shall say.
pub(crate) type Edits = BTreeMap<String, String>;

/// A file by its name.
#[derive(Debug, Deserialize)]
pub(crate) struct Named {
    pub(crate) file: String,
}

/// A file as it would be with these edits in place of its sidecar.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Edited {
    pub(crate) file: String,
    /// What its sidecar shall say; what it says, if this is missing.
    pub(crate) edits: Option<Edits>,
}

impl Edited {
    /// The file, what holds for it, and the settings that this means.
    pub(crate) fn settings(&self, shared: &Shared) -> Result<(Place, Effective, Settings), Fault> {
        let place = shared.roots.file(&self.file)?;
        let unusable = |e: darkroot::RecipeError| Fault::unusable(e.to_string());
        let mut layers = layers().map_err(unusable)?;
        let effective = match &self.edits {
            None => layers.for_file(&place.path).map_err(unusable)?,
            Some(edits) => {
                let layer = layer(shared, &place, edits)?;
                layers.for_file_with(&place.path, Some(&layer)).map_err(unusable)?
            }
        };
        let settings = effective.settings().map_err(unusable)?;
        Ok((place, effective, settings))
    }
}

/// The layer of edits that come from the page. Files that they name must lie in folders that were opened, or where profiles
/// are kept, unless the file's own sidecar names them already.
pub(crate) fn layer(shared: &Shared, place: &Place, edits: &Edits) -> Result<Layer, Fault> {
    let named = |(name, text): (&String, &String)| match Key::from_name(name) {
        Some(key) => Ok((key, text.clone())),
        None => Err(Fault::asked(format!("`{}` is no setting", darkroot::quoted(name)))),
    };
    let values = edits.iter().map(named).collect::<Result<Vec<_>, _>>()?;
    for (key, text) in named_files(&values) {
        let path = std::path::Path::new(text);
        let is_profile = || {
            let folder = shared.profiles.as_ref().and_then(|folder| folder.canonicalize().ok());
            folder.zip(path.canonicalize().ok()).is_some_and(|(folder, path)| path.starts_with(folder))
        };
        let is_known = || {
            let known = recipe::edits(&place.path).ok().flatten();
            known.is_some_and(|known| known.get(key) == Some(text))
        };
        if !(shared.roots.has(path) || is_profile() || is_known()) {
            let text = darkroot::quoted(text);
            return Err(Fault::asked(format!(
                "`{key}`: {text} lies in no folder that was opened; give its whole path, and open its folder, too"
            )));
        }
    }
    Layer::sidecar(&place.path, values).map_err(|e| Fault::asked(e.to_string()))
}
