//! One file to a picture, by the same job as `darkroot develop`.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use darkroot::files::{Output, Tree};
use darkroot::recipe::Layer;
use darkroot::{Control, Error, Format, Report, Target};
use serde::Deserialize;

use super::aside;
use super::asked::{Body, Edited};
use crate::fault::Fault;
use crate::state::Shared;

/// A picture that is to be written.
#[derive(Debug, Deserialize)]
pub(crate) struct Order {
    #[serde(flatten)]
    edited: Edited,
    /// Folder that it goes to; the file's own, if this is missing.
    folder: Option<String>,
    /// Its name without the ending; the file's, if this is missing.
    name: Option<String>,
    /// Its format; what the settings say, if this is missing.
    format: Option<String>,
    /// Whether a picture of that name is replaced.
    #[serde(default)]
    overwrite: bool,
}

/// Develops a file and writes its picture.
pub(crate) async fn export(
    State(shared): State<Arc<Shared>>,
    Body(order): Body<Order>,
) -> Result<Json<Report>, Fault> {
    aside(move || {
        let (place, effective, mut settings) = order.edited.settings(&shared)?;
        let nobody = Layer::flags([]).map_err(|e| Fault::asked(e.to_string()))?;
        let format = match &order.format {
            Some(text) => Format::from_extension(text)
                .ok_or_else(|| Fault::asked(format!("`{}` is no format", darkroot::quoted(text))))?,
            None => effective
                .format(&Target::Beside, &settings, &nobody)
                .map_err(|e| Fault::asked(e.to_string()))?,
        };
        settings.format = Some(format);
        settings.overwrite = order.overwrite;
        let stem = match &order.name {
            Some(name) if name.is_empty() || name.contains(['/', '\\', '\0']) || name.starts_with('.') => {
                return Err(Fault::asked("the name of a picture has no slash and no dot at its beginning"));
            }
            Some(name) => name.into(),
            None => place.path.file_stem().unwrap_or_default().to_owned(),
        };
        let mut name = stem;
        name.push(format!(".{}", format.extension()));
        let to = match &order.folder {
            Some(folder) => shared.roots.place(folder)?,
            None => crate::roots::Place {
                path: place.path.parent().unwrap_or(&place.root).to_owned(),
                root: place.root.clone(),
            },
        };
        let output = to.path.join(name);
        settings.tree = Some(Tree { root: to.root, scratch: to.path });
        let target = Target::File(output);
        let jobs = darkroot::plan_outputs(&[(place.path.clone(), format)], &target);
        let job = jobs.map_err(|e| Fault::conflict(e.to_string()))?.remove(0);
        let failed = |error: Error| {
            let status = match &error {
                Error::Exists { .. } => StatusCode::CONFLICT,
                _ => StatusCode::UNPROCESSABLE_ENTITY,
            };
            Fault::new(status, error.to_string())
        };
        let out: Output = darkroot::open_output(&job, &settings).map_err(failed)?;
        let read = || place.read();
        let report = darkroot::develop_into(out, &job, read, &settings, &shared.store(), Control::default());
        report.map(Json).map_err(failed)
    })
    .await
}
