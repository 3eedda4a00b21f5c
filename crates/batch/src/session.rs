//! Colours of a session: the shot of a folder that shows a colour chart gives white balance and profile to the
//! folder's other files of the same camera.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use darkroot::{path_text, shown, store};

use super::batch_error::BatchError;
use super::crew::Crew;
use super::facts::{Calibrated, CameraNames, ChartLook, Looked, SessionColour, modified};
use super::find::{Source, Sources};
use super::hash;
use super::history::KnownCharts;
use super::journal::JournalError;
use super::record::Record;
use super::stop::Stop;
use super::task::{Answer, Calibrate, Task};
use super::work::{Next, Progress, Work};

/// Which shot gives the colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChartShot {
    /// The shot; the ones that show a chart, folder by folder, if none.
    pub file: Option<PathBuf>,
    /// The chart; any with a built-in reference, if none.
    pub layout: Option<String>,
    /// Its reference; the built-in one, if none.
    pub reference: Option<String>,
    /// The light, as [`darkroot::light::find`] takes it; the one that each shot shows, if none.
    pub light: Option<String>,
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
    pub(crate) fn colours_of(&self, key: &str) -> Arc<Vec<SessionColour>> {
        Arc::clone(self.by_folder.get(folder(key)).unwrap_or(&self.everywhere))
    }
}

/// What looking for the colours of sessions takes.
pub(crate) struct ChartSearch<'a> {
    pub(crate) crew: &'a mut Crew,
    pub(crate) chart: &'a ChartShot,
    /// The output folder, and one below it for the profiles.
    pub(crate) out: &'a Path,
    pub(crate) place: &'a Path,
    /// What earlier runs found out.
    pub(crate) known: &'a KnownCharts,
    /// Keeps what is new.
    pub(crate) note: &'a mut dyn FnMut(Record) -> Result<(), JournalError>,
    pub(crate) stop: &'a Stop,
}

/// A chart shot with the layout of its chart and what was seen of it.
struct ChartFound<'a> {
    source: &'a Source,
    layout: String,
    look: &'a ChartLook,
}

impl ChartSearch<'_> {
    /// Looks for charts in all files, or in the one named, and makes a profile for each folder and camera. `say`
    /// is told in words what was found.
    ///
    /// # Errors
    /// The shot that was named shows no chart, or no profile can be made of it.
    pub(crate) fn find(
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
        let data = std::fs::metadata(file);
        let (size, modified) = data.map_or((0, 0), |m| (m.len(), modified(&m)));
        let named = [Source { path: file.to_owned(), key: path_text::text(file), size, modified }];
        let looks = self.look_at(&named)?;
        let look = looks.get(&named[0].key);
        let Some((look, (layout, _))) = look.and_then(|s| Some((s, s.chart.clone()?))) else {
            return Err(BatchError::NoChart { path: file.to_owned() });
        };
        let shots = vec![ChartFound { source: &named[0], layout, look }];
        let colour = self.calibrate(&shots, &mut |fault| say(&fault))?;
        let Some((_, colour)) = colour.into_iter().next() else {
            return Err(BatchError::NoProfile { path: file.to_owned() });
        };
        say(&words("all files", &colour));
        Ok(Session { by_folder: HashMap::new(), everywhere: Arc::new(vec![colour]) })
    }

    fn of_folders(&mut self, sources: &Sources, say: &mut dyn FnMut(&str)) -> Result<Session, BatchError> {
        let looks = self.look_at(&sources.files)?;
        // The surest chart of each folder and camera.
        let mut best: BTreeMap<(String, CameraNames), (f64, ChartFound<'_>)> = BTreeMap::new();
        for source in &sources.files {
            let Some(look) = looks.get(&source.key) else { continue };
            let Some((layout, sure)) = look.chart.clone() else { continue };
            let key = (folder(&source.key).to_owned(), look.camera.clone());
            if best.get(&key).is_none_or(|(other, _)| sure > *other) {
                best.insert(key, (sure, ChartFound { source, layout, look }));
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
            say("no colour chart was found in any folder: files are developed without one");
        }
        let by_folder = by_folder.into_iter().map(|(folder, colours)| (folder, Arc::new(colours))).collect();
        Ok(Session { by_folder, everywhere: Arc::default() })
    }

    /// What each file shows, by key; files that cannot be read show nothing.
    fn look_at(&mut self, files: &[Source]) -> Result<HashMap<String, ChartLook>, BatchError> {
        let layout = &self.chart.layout;
        let mut looks = HashMap::new();
        let mut queue = VecDeque::new();
        for (id, file) in files.iter().enumerate() {
            let before = self.known.looked.get(&file.key).filter(|looked| {
                let then = &looked.look.source;
                (then.size, then.modified) == (file.size, file.modified) && looked.layout == *layout
            });
            match before {
                Some(looked) => {
                    looks.insert(file.key.clone(), looked.look.clone());
                }
                None => {
                    let task = Task::Look { input: file.path.clone(), layout: layout.clone() };
                    queue.push_back(Work::new(id, task, file.size));
                }
            }
        }
        let Self { crew, note, stop, .. } = self;
        let mut failed = FirstError::default();
        crew.perform(queue, stop, &mut |work, progress| {
            if let Progress::Ended(Ok(Answer::Looked(look))) = progress {
                let input = files[work.id].key.clone();
                looks.insert(input.clone(), look.clone());
                failed.keep(note(Record::Looked(Looked { input, layout: layout.clone(), look })));
            }
            if failed.any() { Next::Finish } else { Next::GoOn }
        })
        .map_err(BatchError::Worker)?;
        failed.result()?;
        Ok(looks)
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
            let profile = self.place.join(format!("{}.toml", &hash::text(&shot.source.key)[..16]));
            let task = Task::Calibrate(Calibrate {
                input: shot.source.path.clone(),
                sha256: shot.look.source.sha256.clone(),
                layout: shot.layout.clone(),
                reference: self.chart.reference.clone(),
                light: self.chart.light.clone(),
                out: self.out.to_owned(),
                profile,
            });
            queue.push_back(Work::new(id, task, shot.source.size));
        }
        let wording = self.crew.wording().clone();
        let Self { crew, note, stop, .. } = self;
        let mut failed = FirstError::default();
        crew.perform(queue, stop, &mut |work, progress| {
            match progress {
                Progress::Ended(Ok(Answer::Calibrated(colour))) => {
                    let input = shots[work.id].source.key.clone();
                    let colour = SessionColour { chart: input.clone(), ..*colour };
                    made.insert(work.id, colour.clone());
                    let request = requests[work.id].clone();
                    failed.keep(note(Record::Calibrated(Calibrated { input, request, colour })));
                }
                Progress::Ended(Err(failure)) => fault(failure.words(&wording)),
                _ => {}
            }
            if failed.any() { Next::Finish } else { Next::GoOn }
        })
        .map_err(BatchError::Worker)?;
        let keyed = made.into_iter().map(|(id, colour)| (shots[id].source.key.clone(), colour));
        let keyed = keyed.collect();
        failed.result()?;
        Ok(keyed)
    }
}

/// All that a profile follows from: the shot, what was asked for, and the program.
fn request(chart: &ChartShot, shot: &ChartFound<'_>) -> String {
    // A name that is no file stands for something built in.
    let content = |name: &str| hash::file(Path::new(name)).unwrap_or_default();
    let reference = chart.reference.as_deref().unwrap_or_default();
    let light = chart.light.as_deref().unwrap_or_default();
    let lamp = light.split(':').next().unwrap_or_default();
    hash::text(&format!(
        "{}\n{}\n{} {}\n{reference} {}\n{} {}",
        darkroot::VERSION,
        shot.look.source.sha256,
        shot.layout,
        content(&shot.layout),
        content(reference),
        light,
        content(lamp),
    ))
}

/// Whether the profile's file is what it was.
fn is_there(colour: &SessionColour) -> bool {
    store::read(&colour.profile)
        .is_ok_and(|p| hash::text(&darkroot_profile::file::format(&p)) == colour.sha256)
}

fn words(which: &str, colour: &SessionColour) -> String {
    let camera = darkroot_photo::Camera::from(&colour.camera).name();
    format!(
        "{which}: white balance and profile for {camera} from the chart in {} (mean dE2000 of left-out patches {:.2})",
        shown(&path_text::path(&colour.chart)),
        colour.left_out
    )
}

/// The first of several errors. Later successes do not make it undone.
#[derive(Debug, Default)]
struct FirstError(Option<JournalError>);

impl FirstError {
    fn keep(&mut self, result: Result<(), JournalError>) {
        if let (None, Err(error)) = (&self.0, result) {
            self.0 = Some(error);
        }
    }

    fn any(&self) -> bool {
        self.0.is_some()
    }

    fn result(self) -> Result<(), JournalError> {
        self.0.map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_success_does_not_hide_an_earlier_error() {
        let locked = |name: &str| Err(JournalError::Locked { path: name.into() });
        let mut failed = FirstError::default();
        failed.keep(Ok(()));
        assert!(!failed.any());
        failed.keep(locked("first"));
        failed.keep(Ok(()));
        failed.keep(locked("second"));
        assert!(failed.any());
        assert!(failed.result().unwrap_err().to_string().starts_with("first"));
    }
}
