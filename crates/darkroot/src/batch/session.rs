//! Colours of a session: the shot of a folder that shows a colour chart gives white balance and profile to the
//! folder's other files of the same camera.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot_develop::Balance;
use serde::{Deserialize, Serialize};

use super::crew::{Crew, Moment, Next, Work};
use super::find::{Source, Sources};
use super::journal::JournalError;
use super::outcome::BatchError;
use super::record::{CameraNames, Identity};
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

/// A profile that was made of a chart shot, so that the next run need not make it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibrated {
    /// The chart shot's path below its root.
    pub input: String,
    /// SHA-256 of the shot and of everything that was asked for.
    pub request: String,
    /// What came of it.
    pub colour: SessionColour,
}

/// What earlier runs know of charts, by path of the shot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KnownCharts {
    /// Looks.
    pub looked: HashMap<String, Looked>,
    /// Profiles.
    pub calibrated: HashMap<String, Calibrated>,
}

/// Something new about charts, for the journal.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum News {
    Looked(Looked),
    Calibrated(Calibrated),
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
}

/// What looking for the colours of sessions takes.
pub(super) struct Lookout<'a> {
    pub(super) crew: &'a mut Crew,
    pub(super) chart: &'a ChartShot,
    /// Folder for the profiles.
    pub(super) place: &'a Path,
    /// What earlier runs found out.
    pub(super) known: &'a KnownCharts,
    /// Keeps what is new.
    pub(super) note: &'a mut dyn FnMut(News) -> Result<(), JournalError>,
    pub(super) stop: &'a Stop,
}

/// A chart shot with the layout of its chart and what was seen of it.
struct ChartFound<'a> {
    source: &'a Source,
    layout: String,
    sight: &'a Sight,
}

impl Lookout<'_> {
    /// Looks for charts in all files, or in the one named, and makes a profile for each folder and camera. `say` hears
    /// in words what was found.
    ///
    /// # Errors
    /// The shot that was named shows no chart, or no profile can be made of it.
    pub(super) fn find(
        mut self,
        sources: &Sources,
        say: &mut dyn FnMut(&str),
    ) -> Result<Session, BatchError> {
        match &self.chart.file {
            Some(file) => self.of_file(file, say),
            None => self.of_folders(sources, say),
        }
    }

    fn of_file(&mut self, file: &Path, say: &mut dyn FnMut(&str)) -> Result<Session, BatchError> {
        let fault = |what: &str| BatchError::Chart(format!("{}: {what}", file.display()));
        let data = std::fs::metadata(file);
        let (size, modified) = data.map_or((0, 0), |m| (m.len(), super::find::modified(&m)));
        let named = [Source { path: file.to_owned(), key: file.display().to_string(), size, modified }];
        let sights = self.look_at(&named)?;
        let sight = sights.get(&named[0].key);
        let Some((sight, (layout, _))) = sight.and_then(|s| Some((s, s.chart.clone()?))) else {
            return Err(fault(
                "no colour chart was found in it; name another file with `--chart-shot`, or leave it out",
            ));
        };
        let shots = vec![ChartFound { source: &named[0], layout, sight }];
        let colour = self.calibrate(&shots, &mut |fault| say(&fault))?;
        let Some((_, colour)) = colour.into_iter().next() else {
            return Err(fault(
                "no profile can be made of it; take the chart again, or leave out `--chart-shot`",
            ));
        };
        say(&words("all files", &colour));
        Ok(Session { by_folder: HashMap::new(), everywhere: Arc::new(vec![colour]) })
    }

    fn of_folders(&mut self, sources: &Sources, say: &mut dyn FnMut(&str)) -> Result<Session, BatchError> {
        let sights = self.look_at(&sources.files)?;
        // The surest chart of each folder and camera.
        let mut best: BTreeMap<(String, String), (f64, ChartFound<'_>)> = BTreeMap::new();
        for source in &sources.files {
            let Some(sight) = sights.get(&source.key) else { continue };
            let Some((layout, sure)) = sight.chart.clone() else { continue };
            let key = (folder(&source.key).to_owned(), format!("{:?}", sight.camera));
            if best.get(&key).is_none_or(|(other, _)| sure > *other) {
                best.insert(key, (sure, ChartFound { source, layout, sight }));
            }
        }
        let shots: Vec<ChartFound<'_>> = best.into_values().map(|(_, shot)| shot).collect();
        let made =
            self.calibrate(&shots, &mut |fault| say(&format!("{fault}; this shot colours nothing")))?;
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
        Ok(Session { by_folder, everywhere: Arc::default() })
    }

    /// What each file shows, by key; files that cannot be read show nothing.
    fn look_at(&mut self, files: &[Source]) -> Result<HashMap<String, Sight>, BatchError> {
        let layout = &self.chart.layout;
        let mut sights = HashMap::new();
        let mut queue = VecDeque::new();
        for (id, file) in files.iter().enumerate() {
            let before = self.known.looked.get(&file.key).filter(|looked| {
                let then = &looked.sight.source;
                (then.size, then.modified) == (file.size, file.modified) && looked.layout == *layout
            });
            match before {
                Some(looked) => {
                    sights.insert(file.key.clone(), looked.sight.clone());
                }
                None => {
                    let task = Task::Look { input: file.path.clone(), layout: layout.clone() };
                    queue.push_back(Work::new(id, task, file.size));
                }
            }
        }
        let Self { crew, note, stop, .. } = self;
        let mut failed = None;
        crew.perform(queue, stop, &mut |work, moment| {
            if let Moment::Came(Ok(Answer::Looked(sight))) = moment {
                let input = files[work.id].key.clone();
                sights.insert(input.clone(), sight.clone());
                failed = note(News::Looked(Looked { input, layout: layout.clone(), sight })).err();
            }
            if failed.is_some() { Next::Finish } else { Next::GoOn }
        })
        .map_err(BatchError::Worker)?;
        failed.map_or(Ok(sights), |e| Err(e.into()))
    }

    /// A profile of each shot, made now or by an earlier run; faults are told. Keys with their colours, in the order of
    /// the shots.
    fn calibrate(
        &mut self,
        shots: &[ChartFound<'_>],
        fault: &mut dyn FnMut(String),
    ) -> Result<Vec<(String, SessionColour)>, BatchError> {
        let mut made = BTreeMap::new();
        let mut queue = VecDeque::new();
        let requests: Vec<String> = shots.iter().map(|shot| request(self.chart, shot)).collect();
        for (id, shot) in shots.iter().enumerate() {
            let before = self.known.calibrated.get(&shot.source.key);
            let before = before.filter(|c| c.request == requests[id] && is_there(&c.colour));
            if let Some(before) = before {
                made.insert(id, before.colour.clone());
                continue;
            }
            // Names of folders can be anything; a hash of the key is a name on every disk.
            let profile = self.place.join(format!("{}.toml", &super::hash::text(&shot.source.key)[..16]));
            let task = Task::Calibrate {
                input: shot.source.path.clone(),
                layout: shot.layout.clone(),
                reference: self.chart.reference.clone(),
                light: self.chart.light.clone(),
                profile,
            };
            queue.push_back(Work::new(id, task, shot.source.size));
        }
        let Self { crew, note, stop, .. } = self;
        let mut failed = None;
        crew.perform(queue, stop, &mut |work, moment| {
            match moment {
                Moment::Came(Ok(Answer::Calibrated(colour))) => {
                    let input = shots[work.id].source.key.clone();
                    let colour = SessionColour { chart: input.clone(), ..*colour };
                    made.insert(work.id, colour.clone());
                    let request = requests[work.id].clone();
                    failed = note(News::Calibrated(Calibrated { input, request, colour })).err();
                }
                Moment::Came(Err(trouble)) => fault(trouble.error),
                _ => {}
            }
            if failed.is_some() { Next::Finish } else { Next::GoOn }
        })
        .map_err(BatchError::Worker)?;
        let keyed = made.into_iter().map(|(id, colour)| (shots[id].source.key.clone(), colour));
        failed.map_or(Ok(keyed.collect()), |e| Err(e.into()))
    }
}

/// All that a profile follows from: the shot, what was asked for, and the program.
fn request(chart: &ChartShot, shot: &ChartFound<'_>) -> String {
    // A name that is no file stands for something built in.
    let content = |name: &str| super::hash::file(Path::new(name)).unwrap_or_default();
    let reference = chart.reference.as_deref().unwrap_or_default();
    let light = chart.light.split(':').next().unwrap_or_default();
    super::hash::text(&format!(
        "{}\n{}\n{} {}\n{reference} {}\n{} {}",
        crate::VERSION,
        shot.sight.source.sha256,
        shot.layout,
        content(&shot.layout),
        content(reference),
        chart.light,
        content(light),
    ))
}

/// Whether the profile's file is what it was.
fn is_there(colour: &SessionColour) -> bool {
    store::read(&colour.profile)
        .is_ok_and(|p| super::hash::text(&darkroot_profile::file::format(&p)) == colour.sha256)
}

fn words(which: &str, colour: &SessionColour) -> String {
    let camera = darkroot_photo::Camera::from(&colour.camera).name();
    format!(
        "{which}: white balance and profile for {camera} from the chart in {} (mean dE2000 of left-out patches {:.2})",
        colour.chart, colour.left_out
    )
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
    let first = made.lights.first().ok_or(Error::NoLight)?;
    let camera = first.shots.first().map(|s| CameraNames::from(&s.camera)).unwrap_or_default();
    let white = first.calibrated.white_rgb;
    if white.iter().any(|v| *v <= 0.0) {
        return Err(Error::chart(input, crate::fault::ChartError::DarkGreys));
    }
    store::write(&made.profile, profile, true)?;
    Ok(SessionColour {
        camera,
        chart: String::new(),
        profile: profile.to_owned(),
        sha256: super::hash::text(&darkroot_profile::file::format(&made.profile)),
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
