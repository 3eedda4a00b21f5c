//! Colours of a session: the shot of a folder that shows a colour chart gives white balance and profile to the
//! folder's other files of the same camera.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use develop::Balance;
use serde::{Deserialize, Serialize};

use super::crew::{Crew, Moment, Next, Work};
use super::find::{Source, Sources};
use super::journal::JournalError;
use super::record::{CameraNames, Identity};
use super::run::BatchError;
use super::stop::Stop;
use super::task::{Answer, Task};
use crate::make_profile::ChartRequest;
use crate::{Error, ProfileChoice, Settings, ShotOptions, charts, find_chart, light, make_profile, store};

/// Least confidence of a chart that colours a session.
const SURE: f64 = 0.8;

/// What a look at a file showed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sight {
    /// The camera.
    pub camera: CameraNames,
    /// Name of the surest chart's layout, and how sure, 0..=1.
    pub chart: Option<(String, f64)>,
    /// The file as it was.
    pub source: Identity,
}

/// A look that stands in a journal, so that the next run need not look again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Looked {
    /// The file's path below its root.
    pub input: String,
    /// The chart that was looked for; any if none.
    pub layout: Option<String>,
    /// What was seen.
    pub sight: Sight,
}

/// What one chart shot gives to the files of its camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionColour {
    /// The camera.
    pub camera: CameraNames,
    /// The chart shot's path below its root.
    pub chart: String,
    /// The profile's file.
    pub profile: PathBuf,
    /// SHA-256 of the profile.
    pub sha256: String,
    /// White-balance multipliers of red, green and blue.
    pub multipliers: [f64; 3],
    /// Mean CIEDE2000 over the patches, each by a fit without it.
    pub left_out: f64,
}

impl SessionColour {
    /// The settings with this white balance and profile.
    pub(super) fn apply(&self, settings: &mut Settings) {
        settings.recipe.balance = Balance::Multipliers(self.multipliers);
        settings.profile = ProfileChoice::File(self.profile.clone());
    }
}

/// Which shot gives the colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChartShot {
    /// The shot; the ones that show a chart, folder by folder, if none.
    pub file: Option<PathBuf>,
    /// The chart; any with a built-in reference, if none.
    pub layout: Option<String>,
    /// Its reference; the built-in one, if none.
    pub reference: Option<String>,
    /// The light, as [`light::find`] takes it.
    pub light: String,
}

/// Colours of sessions, by folder.
#[derive(Debug, Clone, Default)]
pub struct Session {
    by_folder: HashMap<String, Arc<Vec<SessionColour>>>,
    /// For folders without their own.
    everywhere: Arc<Vec<SessionColour>>,
}

/// Folder of a key.
fn folder(key: &str) -> &str {
    key.rsplit_once('/').map_or("", |(folder, _)| folder)
}

impl Session {
    /// The colours for a file.
    pub(super) fn colours_of(&self, key: &str) -> Arc<Vec<SessionColour>> {
        Arc::clone(self.by_folder.get(folder(key)).unwrap_or(&self.everywhere))
    }

    /// Looks for charts in all files, or in the one named, and makes a profile for each folder and camera. Profiles
    /// are written into `place`. `known` are looks of earlier runs; `note` keeps new ones. `say` hears in words what
    /// was found.
    ///
    /// # Errors
    /// The shot that was named shows no chart, or no profile can be made of it.
    #[expect(clippy::too_many_arguments, reason = "called from one place, by the owner of all of them")]
    pub(super) fn find(
        crew: &mut Crew,
        sources: &Sources,
        chart: &ChartShot,
        place: &Path,
        known: &HashMap<String, Looked>,
        note: &mut dyn FnMut(Looked) -> Result<(), JournalError>,
        stop: &Stop,
        say: &mut dyn FnMut(&str),
    ) -> Result<Self, BatchError> {
        if let Some(file) = &chart.file {
            let size = std::fs::metadata(file).map_or(0, |m| m.len());
            let key = file.display().to_string();
            let named = [Source { path: file.clone(), key, size, modified: 0 }];
            let sights = look_at(crew, &named, chart, &HashMap::new(), note, stop)?;
            let shown = sights.values().find_map(|s| s.chart.as_ref().map(|c| (&named[0], c.0.clone())));
            let Some((source, layout)) = shown else {
                let what =
                    "no colour chart was found in it; name another file with `--chart-shot`, or leave it out";
                return Err(BatchError::Chart(format!("{}: {what}", file.display())));
            };
            let colour = make(crew, vec![(source, layout)], chart, place, stop, &mut |fault| {
                say(&fault);
            })?;
            let Some((_, colour)) = colour.into_iter().next() else {
                let what = "no profile can be made of it; take the chart again, or leave out `--chart-shot`";
                return Err(BatchError::Chart(format!("{}: {what}", file.display())));
            };
            say(&words("all files", &colour));
            return Ok(Self { by_folder: HashMap::new(), everywhere: Arc::new(vec![colour]) });
        }

        let sights = look_at(crew, &sources.files, chart, known, note, stop)?;
        // The surest chart of each folder and camera.
        let mut best: BTreeMap<(String, String), (&Source, String, f64)> = BTreeMap::new();
        for source in &sources.files {
            let Some(Sight { camera, chart: Some((layout, sure)), .. }) = sights.get(&source.key) else {
                continue;
            };
            let key = (folder(&source.key).to_owned(), format!("{camera:?}"));
            if best.get(&key).is_none_or(|(_, _, other)| sure > other) {
                best.insert(key, (source, layout.clone(), *sure));
            }
        }
        let shots = best.into_values().map(|(source, layout, _)| (source, layout)).collect();
        let made = make(crew, shots, chart, place, stop, &mut |fault| {
            say(&format!("{fault}; this shot colours nothing"));
        })?;
        let mut by_folder: HashMap<String, Vec<SessionColour>> = HashMap::new();
        for (key, colour) in made {
            let name = if folder(&key).is_empty() { "the folder" } else { folder(&key) };
            say(&words(name, &colour));
            by_folder.entry(folder(&key).to_owned()).or_default().push(colour);
        }
        if by_folder.is_empty() {
            say("no colour chart was found in any folder: files are developed as without `--chart-shot`");
        }
        let by_folder = by_folder.into_iter().map(|(folder, colours)| (folder, Arc::new(colours))).collect();
        Ok(Self { by_folder, everywhere: Arc::default() })
    }
}

fn words(which: &str, colour: &SessionColour) -> String {
    let camera = photo::Camera::from(&colour.camera).name();
    format!(
        "{which}: white balance and profile for {camera} from the chart in {} (mean dE2000 of left-out patches {:.2})",
        colour.chart, colour.left_out
    )
}

/// What each file shows, by key; files that cannot be read show nothing.
fn look_at(
    crew: &mut Crew,
    files: &[Source],
    chart: &ChartShot,
    known: &HashMap<String, Looked>,
    note: &mut dyn FnMut(Looked) -> Result<(), JournalError>,
    stop: &Stop,
) -> Result<HashMap<String, Sight>, BatchError> {
    let mut sights = HashMap::new();
    let mut queue = VecDeque::new();
    for (id, file) in files.iter().enumerate() {
        let before = known.get(&file.key).filter(|looked| {
            let then = &looked.sight.source;
            (then.size, then.modified) == (file.size, file.modified) && looked.layout == chart.layout
        });
        match before {
            Some(looked) => {
                sights.insert(file.key.clone(), looked.sight.clone());
            }
            None => {
                let task = Task::Look { input: file.path.clone(), layout: chart.layout.clone() };
                queue.push_back(Work::new(id, task, file.size));
            }
        }
    }
    let mut failed = None;
    crew.perform(queue, stop, &mut |work, moment| {
        if let Moment::Came(Ok(Answer::Looked(sight))) = moment {
            let input = files[work.id].key.clone();
            sights.insert(input.clone(), sight.clone());
            failed = note(Looked { input, layout: chart.layout.clone(), sight }).err();
        }
        if failed.is_some() { Next::Finish } else { Next::GoOn }
    })
    .map_err(BatchError::Worker)?;
    failed.map_or(Ok(sights), |e| Err(e.into()))
}

/// A profile of each shot; faults are told. Keys with their colours, in the order of the shots.
fn make(
    crew: &mut Crew,
    shots: Vec<(&Source, String)>,
    chart: &ChartShot,
    place: &Path,
    stop: &Stop,
    fault: &mut dyn FnMut(String),
) -> Result<Vec<(String, SessionColour)>, BatchError> {
    let task = |(id, (source, layout)): (usize, &(&Source, String))| {
        // Names of folders can be anything; a hash of the key is a name on every disk.
        let profile = place.join(format!("{}.toml", &super::hash::text(&source.key)[..16]));
        let task = Task::Calibrate {
            input: source.path.clone(),
            layout: layout.clone(),
            reference: chart.reference.clone(),
            light: chart.light.clone(),
            profile,
        };
        Work::new(id, task, source.size)
    };
    let queue: VecDeque<Work> = shots.iter().enumerate().map(task).collect();
    let mut made = BTreeMap::new();
    crew.perform(queue, stop, &mut |work, moment| {
        match moment {
            Moment::Came(Ok(Answer::Calibrated(colour))) => {
                made.insert(work.id, *colour);
            }
            Moment::Came(Err(trouble)) => fault(trouble.error),
            _ => {}
        }
        Next::GoOn
    })
    .map_err(BatchError::Worker)?;
    let keyed = made.into_iter().map(|(id, colour)| {
        let key = shots[id].0.key.clone();
        (key.clone(), SessionColour { chart: key, ..colour })
    });
    Ok(keyed.collect())
}

/// Looks for a chart: those with a built-in reference, or the one named.
pub(super) fn look(
    input: &Path,
    layout: Option<&str>,
    settings: &Settings,
) -> Result<Option<(String, f64)>, Error> {
    let layouts = match layout {
        Some(name) => vec![charts::layout(name)?],
        None => charts::layouts().into_iter().filter(|l| charts::reference(None, l).is_ok()).collect(),
    };
    let found = find_chart::find_charts(input, &layouts, settings)?;
    let best = found.search.found.into_iter().next();
    Ok(best.filter(|f| f.confidence >= SURE).map(|f| (f.layout, f.confidence)))
}

/// Makes a profile of a chart shot and writes it.
pub(super) fn calibrate(
    input: &Path,
    chart: &str,
    reference: Option<&str>,
    light: &str,
    profile: &Path,
    settings: &Settings,
) -> Result<SessionColour, Error> {
    let layout = charts::layout(chart)?;
    let reference = charts::reference(reference, &layout)?;
    let request = ChartRequest {
        shots: vec![(input.to_owned(), light::find(light)?)],
        layout,
        reference: reference.colours,
        reference_name: reference.name,
        reference_sha256: reference.sha256,
        options: ShotOptions::default(),
        kind: None,
        average: false,
        date: String::new(),
    };
    let made = make_profile(&request, settings)?;
    let fault = |what: &str| Error::Chart { path: input.to_owned(), what: what.to_owned() };
    let first = made.lights.first().ok_or_else(|| fault("gives no light"))?;
    let camera = first.shots.first().map(|s| CameraNames::from(&s.camera)).unwrap_or_default();
    let white = first.calibrated.white_rgb;
    if white.iter().any(|v| *v <= 0.0) {
        return Err(fault("its greys have no light in a channel"));
    }
    store::write(&made.profile, profile, true)?;
    Ok(SessionColour {
        camera,
        chart: String::new(),
        profile: profile.to_owned(),
        sha256: super::hash::text(&::profile::file::format(&made.profile)),
        multipliers: white.map(|v| white[1] / v),
        left_out: first
            .calibrated
            .calibration
            .figures
            .leave_one_out
            .as_ref()
            .map_or(f64::NAN, |e| e.de2000.mean),
    })
}
