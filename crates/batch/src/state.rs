//! Whether a file is done, or why it is to be developed.

use std::collections::HashMap;
use std::path::PathBuf;

use darkroot::{Engine, ProfileChoice, ProfileStore, Settings};
use darkroot_develop::OutputSpace;

use super::facts::{CameraNames, Identity, modified};
use super::failure::Conflict;
use super::find::Source;
use super::hash;
use super::history::Known;
use super::item::{Item, PlanOptions, State, Why};

/// Hashes of profiles and of other files that settings name, each taken once.
pub(crate) struct Profiles<'a> {
    store: &'a ProfileStore,
    kept: std::sync::Mutex<HashMap<(Wanted, CameraNames), String>>,
    files: std::sync::Mutex<HashMap<Vec<PathBuf>, String>>,
}

/// What the settings say of the profile.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Wanted {
    /// None: the output or the engine takes no profile, or the file's own matrix was asked for.
    Nothing,
    /// The one that fits the camera.
    Automatic,
    /// The one in this file.
    File(PathBuf),
}

impl Wanted {
    fn of(settings: &Settings) -> Self {
        if settings.space == Some(OutputSpace::Camera) || settings.engine == Engine::Imagepipe {
            return Self::Nothing;
        }
        match &settings.profile {
            ProfileChoice::Matrix => Self::Nothing,
            ProfileChoice::Automatic => Self::Automatic,
            ProfileChoice::File(path) => Self::File(path.clone()),
        }
    }
}

impl<'a> Profiles<'a> {
    pub(crate) fn of(store: &'a ProfileStore) -> Self {
        Self { store, kept: std::sync::Mutex::default(), files: std::sync::Mutex::default() }
    }

    /// Hash of the profile that a camera would get now; `None` when it cannot be read.
    fn now(&self, item: &Item, camera: &CameraNames) -> Option<String> {
        let mut settings = item.prepared.settings.clone();
        if let Some(colour) = item.session.iter().find(|c| c.camera == *camera) {
            colour.apply(&mut settings);
        }
        let key = (Wanted::of(&settings), camera.clone());
        let mut kept = self.kept.lock().ok()?;
        if let Some(hash) = kept.get(&key) {
            return Some(hash.clone());
        }
        let hash = hash::profile(&settings, &camera.into(), self.store).ok()?;
        kept.insert(key, hash.clone());
        Some(hash)
    }

    /// Hash of the other files that settings name, as they are now; `None` when one cannot be read.
    pub(crate) fn files(&self, settings: &Settings) -> Option<String> {
        let key: Vec<PathBuf> = settings.files().collect();
        let mut kept = self.files.lock().ok()?;
        if let Some(hash) = kept.get(&key) {
            return Some(hash.clone());
        }
        let hash = hash::files(settings).ok()?;
        kept.insert(key, hash.clone());
        Some(hash)
    }
}

pub(crate) fn state(
    item: &Item,
    options: &PlanOptions,
    known: Option<&Known>,
    profiles: &Profiles<'_>,
) -> State {
    let path = item.place(&options.out);
    let there = path.symlink_metadata().ok();
    let nothing = Known::default();
    let known = known.unwrap_or(&nothing);
    let Some(done) = &known.done else {
        if there.is_some() && !known.open && !options.overwrite {
            return State::Conflict(Conflict::NotOurs { path });
        }
        return State::Todo(match known {
            Known { open: true, .. } => Why::Interrupted,
            Known { failed: Some(_), .. } => Why::FailedBefore,
            _ => Why::New,
        });
    };
    let why = if options.redo {
        Some(Why::Asked)
    } else if known.open {
        Some(Why::Interrupted)
    } else if done.input != item.source.key || changed(&done.source, &item.source) {
        Some(Why::InputChanged)
    } else if done.settings != item.settings_hash(&done.camera) {
        Some(Why::SettingsChanged)
    } else if profiles.now(item, &done.camera).is_none_or(|hash| hash != done.profile) {
        Some(Why::ProfileChanged)
    } else if item.files != done.files {
        Some(Why::FileChanged)
    } else {
        known.failed.as_ref().map(|_| Why::FailedBefore)
    };
    let Some(data) = there else { return State::Todo(why.unwrap_or(Why::OutputMissing)) };
    let touched = data.len() != done.written.size || modified(&data) != done.written.modified;
    match why {
        // What is there is this journal's, or was wished away.
        Some(why) if known.open || options.overwrite || !touched => State::Todo(why),
        Some(why) => match hash::file(&path) {
            Ok(hash) if hash == done.written.sha256 => State::Todo(why),
            _ => State::Conflict(Conflict::Changed { path }),
        },
        None if options.verify && !touched => match hash::file(&path) {
            Ok(hash) if hash == done.written.sha256 => State::Done(Box::new(done.clone())),
            _ => State::Todo(Why::OutputDamaged),
        },
        None => State::Done(Box::new(done.clone())),
    }
}

/// Whether the file has another content than when it was read.
fn changed(then: &Identity, now: &Source) -> bool {
    if then.size != now.size {
        return true;
    }
    then.modified != now.modified && hash::file(&now.path).ok().as_ref() != Some(&then.sha256)
}
