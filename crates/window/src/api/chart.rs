//! Charts: found or placed by hand, measured, judged; profiles made of them.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use axum::Json;
use axum::extract::{Path, State};
use axum::http::header::{CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::response::IntoResponse;
use darkroot::charts::{self, NamedReference};
use darkroot::find_chart::find_in;
use darkroot::shot::{self, Gate, Shot, ShotOptions, Verdict, View};
use darkroot::{ChartRequest, LightSource, MadeProfile, Settings, light, make_profile, report};
use darkroot_batch::facts::modified;
use darkroot_chart::{ChartLayout, Quad, windows};
use serde::Deserialize;
use serde_json::{Value, json};

use super::aside;
use super::asked::Body;
use crate::fault::Fault;
use crate::guard::REPORT_POLICY;
use crate::state::{Shared, locked};

/// The shot that was looked at last, and the profiles that were made.
#[derive(Default)]
pub(crate) struct Charts {
    view: Mutex<Option<Viewed>>,
    made: Mutex<VecDeque<(u64, Arc<Made>)>>,
}

/// A shot as it was when it was read.
struct Viewed {
    path: PathBuf,
    modified: i64,
    view: Arc<View>,
}

/// A profile that is not saved yet.
struct Made {
    profile: MadeProfile,
    report: String,
    stem: String,
}

/// Profiles that are kept, at most.
const MADE: usize = 8;

impl Charts {
    /// The sensor's light of a shot.
    fn view(&self, shared: &Shared, file: &str) -> Result<(PathBuf, Arc<View>), Fault> {
        let path = shared.roots.file(file)?.path;
        let modified = std::fs::metadata(&path).map(|data| modified(&data)).unwrap_or_default();
        let mut held = locked(&self.view);
        if let Some(viewed) =
            held.as_ref().filter(|viewed| viewed.path == path && viewed.modified == modified)
        {
            return Ok((path, Arc::clone(&viewed.view)));
        }
        let view = Arc::new(View::open(&path, &Settings::default()).map_err(unusable)?);
        *held = Some(Viewed { path: path.clone(), modified, view: Arc::clone(&view) });
        Ok((path, view))
    }

    fn made(&self, id: u64) -> Result<Arc<Made>, Fault> {
        let made = locked(&self.made);
        let found = made.iter().find(|(of, _)| *of == id).map(|(_, made)| Arc::clone(made));
        found.ok_or_else(|| Fault::missing("this window knows no such profile; make it again"))
    }
}

fn unusable(error: darkroot::Error) -> Fault {
    Fault::unusable(error.to_string())
}

/// Charts, references and lights that can be named.
pub(crate) async fn offers() -> Json<Value> {
    let chart = |layout: &ChartLayout| {
        json!({
            "name": layout.name, "title": layout.title, "columns": layout.columns, "rows": layout.rows,
            "patches": layout.patches.iter().map(|patch| &patch.name).collect::<Vec<_>>(),
            "has_reference": charts::reference(None, layout).is_ok(),
        })
    };
    let all: Vec<Value> = charts::layouts().iter().map(chart).collect();
    Json(json!({ "charts": all, "lights": LightSource::names().collect::<Vec<_>>() }))
}

/// A shot, and what is on it.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Asked {
    file: String,
    /// Name of the chart, or a file that describes it; every chart, if it is missing and looked for.
    chart: Option<String>,
    /// Name of the reference, or a file; that of the chart, if it is missing.
    reference: Option<String>,
    /// Outer corners of the corner patches in pixels of the developed picture, from patch 1 on clockwise as the chart is
    /// printed; found, if they are missing.
    corners: Option<Quad>,
    /// Names of patches to leave out.
    #[serde(default)]
    exclude: Vec<String>,
    /// The light; for a fit.
    light: Option<String>,
    /// Use the shot even if it is not good enough.
    #[serde(default)]
    accept: bool,
}

impl Asked {
    fn layout(&self, shared: &Shared) -> Result<ChartLayout, Fault> {
        let text = self.chart.as_deref().unwrap_or("classic24");
        if ChartLayout::by_name(text).is_none() {
            reachable(shared, text)?;
        }
        charts::layout(text).map_err(unusable)
    }

    fn reference(&self, shared: &Shared, layout: &ChartLayout) -> Result<NamedReference, Fault> {
        let text = self.reference.as_deref().filter(|text| !text.is_empty());
        if let Some(text) = text.filter(|text| text.contains(std::path::is_separator) || text.contains('.')) {
            reachable(shared, text)?;
        }
        charts::reference(text, layout).map_err(unusable)
    }

    fn options(&self) -> ShotOptions {
        ShotOptions {
            corners: self.corners,
            exclude: self.exclude.clone(),
            even_out: shot::Correct::WhereItHelps,
            correct_glare: shot::Correct::WhereItHelps,
            accept: self.accept,
            ..ShotOptions::default()
        }
    }
}

/// A file that the page names must lie in a folder that was opened.
fn reachable(shared: &Shared, text: &str) -> Result<(), Fault> {
    if shared.roots.has(text.as_ref()) {
        return Ok(());
    }
    let text = darkroot::quoted(text);
    Err(Fault::asked(format!("{text}: is no name that is built in, and no file in a folder that was opened")))
}

/// Looks for charts: the surest first, or what came nearest.
pub(crate) async fn find(
    State(shared): State<Arc<Shared>>,
    Body(asked): Body<Asked>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let (_, view) = shared.charts.view(&shared, &asked.file)?;
        let layouts = match &asked.chart {
            Some(_) => vec![asked.layout(&shared)?],
            None => charts::layouts(),
        };
        let found = find_in(&view, &layouts);
        let one = |chart: &darkroot_chart::Found| {
            json!({
                "chart": chart.layout, "corners": chart.corners, "confidence": chart.confidence,
                "rotation": chart.rotation_degrees,
            })
        };
        let rejected = found.search.rejected.as_ref().map(|near| {
            json!({ "chart": near.layout, "corners": near.corners, "reason": near.reason.to_string() })
        });
        Ok(Json(json!({
            "size": [found.size.width, found.size.height],
            "found": found.search.found.iter().map(one).collect::<Vec<_>>(),
            "rejected": rejected,
        })))
    })
    .await
}

/// Measures a chart and says how good the shot is. Nothing is refused: whoever places a chart wants to see what is there.
pub(crate) async fn judge(
    State(shared): State<Arc<Shared>>,
    Body(asked): Body<Asked>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let (path, view) = shared.charts.view(&shared, &asked.file)?;
        let layout = asked.layout(&shared)?;
        let reference = asked.reference(&shared, &layout)?;
        let options = ShotOptions { accept: true, ..asked.options() };
        let shot = shot::judged(&path, &view, &layout, &reference.colours, &options, &Settings::default())
            .map_err(unusable)?;
        Ok(Json(told(&shot, &layout)))
    })
    .await
}

fn told(shot: &Shot, layout: &ChartLayout) -> Value {
    let whole = windows::windows(layout, &shot.corners, 0.0).unwrap_or_default();
    let patches: Vec<Value> = shot
        .patches
        .iter()
        .enumerate()
        .map(|(i, patch)| {
            json!({
                "name": patch.name, "rgb": patch.rgb, "clipped": patch.is_clipped(),
                "excluded": patch.excluded, "window": shot.windows.get(i), "outline": whole.get(i),
            })
        })
        .collect();
    json!({
        "corners": shot.corners, "confidence": shot.confidence, "patches": patches,
        "gates": shot.gates.iter().map(gate).collect::<Vec<_>>(),
        "notes": shot.notes,
    })
}

fn gate(gate: &Gate) -> Value {
    let verdict = match gate.verdict {
        Verdict::Good => "good",
        Verdict::Warning => "warning",
        Verdict::Refused => "failed",
    };
    json!({ "name": gate.name(), "verdict": verdict, "words": gate.words(), "advice": gate.advice() })
}

/// Makes a profile, which is not saved yet.
pub(crate) async fn fit(
    State(shared): State<Arc<Shared>>,
    Body(asked): Body<Asked>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let path = shared.roots.file(&asked.file)?.path;
        let layout = asked.layout(&shared)?;
        let reference = asked.reference(&shared, &layout)?;
        let text = asked.light.as_deref().unwrap_or_default();
        if LightSource::by_name(text).is_none() {
            reachable(&shared, text)?;
        }
        let light = light::find(text).map_err(unusable)?;
        let request = ChartRequest::of(vec![(path.clone(), light)], layout, reference, asked.options());
        let profile = make_profile(&request, &Settings::default()).map_err(unusable)?;
        let report = report::html(&profile, &request.layout);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let camera = profile.profile.camera().name();
        let lights: Vec<Value> = profile.lights.iter().map(fitted).collect();
        let mut made = locked(&shared.charts.made);
        let id = made.back().map_or(1, |(last, _)| last + 1);
        made.push_back((id, Arc::new(Made { profile, report, stem: stem.clone() })));
        if made.len() > MADE {
            made.pop_front();
        }
        Ok(Json(json!({ "id": id, "camera": camera, "name": stem, "lights": lights })))
    })
    .await
}

/// What a fit under one light came to.
fn fitted(light: &darkroot::make_profile::MadeLight) -> Value {
    let chosen = light.calibrated.calibration.kind;
    let figures = light.calibrated.compared.iter().find(|compared| compared.kind == chosen);
    let left_out = figures
        .and_then(|compared| compared.result.as_ref().ok())
        .and_then(|figures| figures.leave_one_out)
        .map(|errors| json!({ "mean": errors.de2000.mean, "max": errors.de2000.max }));
    json!({
        "light": light.light.light.name, "model": chosen.to_string(), "left_out": left_out,
        "gates": light.gates.iter().map(gate).collect::<Vec<_>>(),
        "notes": light.calibrated.notes,
    })
}

/// The report of a profile that was made, a page of its own.
pub(crate) async fn report(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
) -> Result<impl IntoResponse, Fault> {
    let made = shared.charts.made(id)?;
    let headers = [(CONTENT_TYPE, "text/html; charset=utf-8"), (CONTENT_SECURITY_POLICY, REPORT_POLICY)];
    Ok((headers, made.report.clone()))
}

/// How a profile is saved.
#[derive(Debug, Deserialize)]
pub(crate) struct Saved {
    /// Its name in the user's folder of profiles, without the ending; that of the shot, if it is missing.
    name: Option<String>,
    #[serde(default)]
    overwrite: bool,
}

/// Saves a profile to the user's folder, from where it serves its camera from now on.
pub(crate) async fn save(
    State(shared): State<Arc<Shared>>,
    Path(id): Path<u64>,
    Body(Saved { name, overwrite }): Body<Saved>,
) -> Result<Json<Value>, Fault> {
    aside(move || {
        let made = shared.charts.made(id)?;
        let name = name.unwrap_or_else(|| made.stem.clone());
        if name.is_empty() || name.len() > 100 || name.starts_with('.') || name.contains(['/', '\\', '\0']) {
            return Err(Fault::asked("the name of a profile has no slash and no dot at its beginning"));
        }
        let Some(folder) = &shared.profiles else {
            return Err(Fault::unusable(
                "there is no folder for profiles: set XDG_DATA_HOME or HOME and open the window again",
            ));
        };
        let path = folder.join(format!("{name}.toml"));
        let saved = darkroot::store::write(&made.profile.profile, &path, overwrite);
        saved.map_err(|error| match error {
            darkroot::Error::Exists { .. } => Fault::conflict(error.to_string()),
            other => unusable(other),
        })?;
        shared.read_profiles();
        Ok(Json(json!({ "path": darkroot::path_text::text(&path), "shown": darkroot::shown(&path) })))
    })
    .await
}
