//! Where profiles come from: the user's folder first, then those built into the program.

use std::borrow::Cow;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use darkroot_photo::Camera;
use darkroot_profile::export::dcp;
use darkroot_profile::{Calibration, Kind, Profile, ProfileCamera};

use crate::Error;
use crate::light::LightSource;
use crate::settings::ProfileChoice;
use crate::shown;

/// A profile of this build.
struct BuiltIn {
    make: &'static str,
    model: &'static str,
    aliases: &'static [&'static str],
    text: &'static str,
}

/// Every profile of this build.
const BUILTIN: &[BuiltIn] = include!(concat!(env!("OUT_DIR"), "/profiles.rs"));

/// A profile and where it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The profile.
    pub profile: Profile,
    /// Where it is from, in words: a path, or "built in".
    pub place: String,
}

/// The profile of one photograph, and where it is from, in words.
#[derive(Debug, Clone)]
pub struct ChosenProfile<'a> {
    /// The profile.
    pub profile: Cow<'a, Profile>,
    /// A path, "built in", or what it was estimated from.
    pub place: Cow<'a, str>,
    /// Whether it was estimated, because there is no other.
    pub estimated: bool,
}

impl ChosenProfile<'_> {
    /// The same for one light alone, whatever the white: computed for its spectrum where the profile is a camera, else what the
    /// profile has for its white.
    #[must_use]
    pub(crate) fn under(self, light: &LightSource) -> Self {
        let computed = || self.profile.known_camera()?.model_under(light.spectrum.as_ref()?);
        let model = computed().unwrap_or_else(|| self.profile.model_for(light.light.xy));
        let kind = match self.profile.known_camera() {
            Some(_) => Kind::Spectral,
            None => self.profile.calibrations()[0].kind,
        };
        let calibration = Calibration::new(light.light.clone(), kind, model);
        let (camera, origin) = (self.profile.camera().clone(), self.profile.origin().clone());
        match Profile::new(camera, vec![calibration], origin) {
            Some(profile) => Self {
                profile: Cow::Owned(profile.rendered_by(self.profile.rendering().cloned())),
                place: Cow::Owned(format!("{}, for {}", self.place, light.light.name)),
                ..self
            },
            None => self,
        }
    }
}

/// Profiles by camera.
#[derive(Debug, Clone, Default)]
pub struct ProfileStore {
    entries: Vec<Entry>,
    /// The one profile that is given for every photograph, if there is such a one.
    only: Option<Box<Found>>,
    /// Profile files that could not be used, each with its reason.
    pub faults: Vec<String>,
}

/// A profile that is there. One that is built in is read when it is first wanted, and so is a DCP, which takes some tenths of
/// a second.
#[derive(Debug, Clone)]
struct Entry {
    camera: ProfileCamera,
    source: Source,
    found: OnceLock<Option<Found>>,
}

/// Where a profile is read from.
#[derive(Debug, Clone)]
enum Source {
    File(PathBuf),
    BuiltIn(&'static str),
}

impl Entry {
    fn built_in(profile: &BuiltIn) -> Self {
        let aliases = profile.aliases.iter().map(|&alias| alias.to_owned()).collect();
        let camera =
            ProfileCamera { make: profile.make.to_owned(), model: profile.model.to_owned(), aliases };
        Self { camera, source: Source::BuiltIn(profile.text), found: OnceLock::new() }
    }

    /// A file of the user's folder. All that can be wrong with a file is said here.
    fn read(path: &Path) -> Result<Self, Error> {
        if !has_extension(path, "dcp") {
            let found = Found { profile: read(path)?, place: shown(path) };
            let camera = found.profile.camera().clone();
            return Ok(Self {
                camera,
                source: Source::File(path.to_owned()),
                found: OnceLock::from(Some(found)),
            });
        }
        let bytes = crate::files::read(path)?;
        let camera = dcp::camera(&bytes).map_err(|source| Error::Dcp { path: path.to_owned(), source })?;
        Ok(Self { camera, source: Source::File(path.to_owned()), found: OnceLock::new() })
    }

    fn get(&self) -> Option<&Found> {
        let make = || match &self.source {
            Source::File(path) => Some(Found { profile: read(path).ok()?, place: shown(path) }),
            Source::BuiltIn(text) => {
                let profile = darkroot_profile::file::parse(text).ok()?;
                Some(Found { profile, place: "built in".to_owned() })
            }
        };
        self.found.get_or_init(make).as_ref()
    }
}

impl ProfileStore {
    /// The profiles built into the program.
    pub fn builtin() -> Self {
        Self::default().with_builtin()
    }

    /// A store of this one profile, for programs that have it in memory. It is given for every photograph; one of another
    /// camera is refused, unless the profile names no camera.
    pub fn of_one(profile: Profile) -> Self {
        let only = Found { profile, place: "the profile that was given".to_owned() };
        Self { only: Some(Box::new(only)), ..Self::default() }
    }

    /// The profiles of the user's folder (every `.toml` below it, then every `.dcp`; the folder may be missing), then
    /// the built-in ones.
    pub fn with_user_folder(folder: &Path) -> Self {
        let mut store = Self::default();
        let mut files = Vec::new();
        collect(folder, 0, &mut HashSet::new(), &mut files);
        files.sort_by_cached_key(|path| (has_extension(path, "dcp"), path.clone()));
        for path in files {
            match Entry::read(&path) {
                Ok(entry) => store.entries.push(entry),
                Err(fault) => store.faults.push(fault.to_string()),
            }
        }
        store.with_builtin()
    }

    /// The profiles of the user's folder, where there is one, and the built-in ones.
    pub fn of_user() -> Self {
        Self::user_folder().map_or_else(Self::builtin, |folder| Self::with_user_folder(&folder))
    }

    /// The user's profile folder: `darkroot/profiles` in the XDG data folder (`XDG_DATA_HOME`, else
    /// `~/.local/share`). `None` where there is no home.
    pub fn user_folder() -> Option<PathBuf> {
        let set = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
        let data = set("XDG_DATA_HOME").filter(|p| p.is_absolute());
        let data = data.or_else(|| set("HOME").map(|home| home.join(".local/share")))?;
        Some(data.join("darkroot/profiles"))
    }

    /// The first profile for a camera.
    pub fn find(&self, camera: &Camera) -> Option<&Found> {
        self.entries.iter().filter(|e| is_of(&e.camera, camera)).find_map(Entry::get)
    }

    /// The profile that a person names: a file, or the camera of a profile in the store ("Nikon D700").
    ///
    /// # Errors
    /// Neither of both, or a file that is no usable profile.
    pub fn choose(&self, text: &str) -> Result<Found, Error> {
        self.named(Path::new(text))
    }

    /// As [`Self::choose`]. What is called like a file and is not there is told as a missing file.
    ///
    /// # Errors
    /// As there.
    pub fn named(&self, path: &Path) -> Result<Found, Error> {
        let text = path.to_str();
        if path.exists() || crate::files::is_stream(path) || text.is_none_or(crate::settings::is_file_name) {
            return Ok(Found { profile: read(path)?, place: shown(path) });
        }
        let camera = text.unwrap_or_default();
        let named = self.entries.iter().filter(|e| e.camera.is("", camera)).find_map(Entry::get);
        named.cloned().ok_or_else(|| Error::NoProfile { text: camera.to_owned() })
    }

    /// The profile that gives a camera's colours; `None` where the file's own matrices do.
    ///
    /// # Errors
    /// A file that cannot be read, is no usable profile, or is for another camera.
    pub fn for_camera(
        &self,
        camera: &Camera,
        choice: &ProfileChoice,
    ) -> Result<Option<ChosenProfile<'_>>, Error> {
        let chosen = |found: &Found| ChosenProfile {
            profile: Cow::Owned(found.profile.clone()),
            place: Cow::Owned(found.place.clone()),
            estimated: false,
        };
        let checked = |found: &Found, path: &Path| match is_for(&found.profile, camera) {
            true => Ok(Some(chosen(found))),
            false => Err(Error::OtherCamera {
                path: path.to_owned(),
                of: found.profile.camera().name(),
                picture: None,
                camera: camera.name(),
            }),
        };
        match choice {
            ProfileChoice::Matrix => Ok(None),
            ProfileChoice::Automatic if self.only.is_some() => self.only.as_ref().map_or(Ok(None), |only| {
                let serves_all = only.profile.camera().name().is_empty();
                if serves_all { Ok(Some(chosen(only))) } else { checked(only, Path::new(&only.place)) }
            }),
            ProfileChoice::Automatic => Ok(self.find(camera).map(|found| ChosenProfile {
                profile: Cow::Borrowed(&found.profile),
                place: Cow::Borrowed(&found.place),
                estimated: false,
            })),
            ProfileChoice::File(path) => checked(&self.named(path)?, path),
        }
    }

    /// All profiles, those of the user first.
    pub fn all(&self) -> Vec<&Found> {
        self.entries.iter().filter_map(Entry::get).collect()
    }

    fn with_builtin(mut self) -> Self {
        self.entries.extend(BUILTIN.iter().map(Entry::built_in));
        self
    }
}

/// Whether a profile is for a camera, by any of the camera's names.
pub(crate) fn is_for(profile: &Profile, camera: &Camera) -> bool {
    is_of(profile.camera(), camera)
}

fn is_of(of: &ProfileCamera, camera: &Camera) -> bool {
    of.is(&camera.common_make, &camera.common_model) || of.is(&camera.make, &camera.model)
}

/// Reads one profile file: Darkroot's own, or a DCP, of which the summary says what was taken.
///
/// # Errors
/// A file that cannot be read or is no usable profile.
pub fn read(path: &Path) -> Result<Profile, Error> {
    let bytes = crate::files::read_text(path)?;
    if dcp::is_dcp(&bytes) {
        let imported = dcp::import(&bytes);
        return imported.map(|i| i.profile).map_err(|source| Error::Dcp { path: path.to_owned(), source });
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        let source = darkroot_profile::Error::Syntax { detail: "it is no text".to_owned() };
        Error::Profile { path: path.to_owned(), source }
    })?;
    darkroot_profile::file::parse(&text).map_err(|source| Error::Profile { path: path.to_owned(), source })
}

/// Writes a profile's file, whole or not at all. Missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub fn write(profile: &Profile, path: &Path, overwrite: bool) -> Result<(), Error> {
    crate::files::write_whole(path, darkroot_profile::file::format(profile).as_bytes(), overwrite)
}

/// As [`write()`], to an output that was opened for this path before; a profile that is there is replaced.
///
/// # Errors
/// A file that cannot be written.
pub fn write_into(output: crate::files::Output, profile: &Profile, path: &Path) -> Result<(), Error> {
    output.write_whole(path, darkroot_profile::file::format(profile).as_bytes(), true)
}

/// Folders inside folders that are still looked into.
const DEEPEST: usize = 8;

/// The profiles of a folder and of those in it, each folder once, by whatever links it is met.
fn collect(folder: &Path, depth: usize, seen: &mut HashSet<PathBuf>, files: &mut Vec<PathBuf>) {
    let is_new = folder.canonicalize().is_ok_and(|place| seen.insert(place));
    if depth > DEEPEST || !is_new {
        return;
    }
    // A folder that is missing or closed to us holds no profiles.
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, depth + 1, seen, files);
        } else if has_extension(&path, "toml") || has_extension(&path, "dcp") {
            files.push(path);
        }
    }
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(wanted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_profile_is_sound() {
        assert_eq!(BUILTIN.len(), 52);
        for built_in in BUILTIN {
            let profile = darkroot_profile::file::parse(built_in.text);
            let camera = profile.map(|profile| profile.camera().clone());
            assert_eq!(camera, Ok(Entry::built_in(built_in).camera), "{}", built_in.model);
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_round_in_circles_end() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        for link in ["a/up", "a/again", "b"] {
            std::os::unix::fs::symlink(folder.path(), folder.path().join(link)).unwrap();
        }
        std::fs::write(folder.path().join("a/broken.toml"), "x").unwrap();
        assert_eq!(ProfileStore::with_user_folder(folder.path()).faults.len(), 1);
    }

    #[test]
    fn a_missing_user_folder_is_no_fault() {
        assert!(ProfileStore::with_user_folder(Path::new("/nowhere/at/all")).faults.is_empty());
    }
}
