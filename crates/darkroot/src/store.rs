//! Where profiles come from: the user's folder first, then those built into the program.

use std::path::{Path, PathBuf};

use photo::Camera;
use profile::Profile;

use crate::Error;

/// Path inside `profiles/` and text of every profile of this build.
const BUILTIN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/profiles.rs"));

/// A profile and where it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The profile.
    pub profile: Profile,
    /// Where it is from, in words: a path, or "built in".
    pub place: String,
}

/// Profiles by camera.
#[derive(Debug, Clone, Default)]
pub struct ProfileStore {
    found: Vec<Found>,
    /// Profile files that could not be used, each with its reason.
    pub faults: Vec<String>,
}

impl ProfileStore {
    /// The profiles built into the program.
    pub fn builtin() -> Self {
        Self::default().with_builtin()
    }

    /// The profiles of the user's folder (every `.toml` below it; the folder may be missing), then the built-in
    /// ones.
    pub fn with_user_folder(folder: &Path) -> Self {
        let mut store = Self::default();
        let mut files = Vec::new();
        collect(folder, &mut files);
        files.sort();
        for path in files {
            match read(&path) {
                Ok(profile) => store.found.push(Found { profile, place: path.display().to_string() }),
                Err(fault) => store.faults.push(fault.to_string()),
            }
        }
        store.with_builtin()
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
        self.found.iter().find(|f| is_for(&f.profile, camera))
    }

    /// The profile that a person names: a file, or the camera of a profile in the store ("Nikon D700").
    ///
    /// # Errors
    /// Neither of both, or a file that is no usable profile.
    pub fn choose(&self, text: &str) -> Result<Found, Error> {
        let path = Path::new(text);
        if path.is_file() {
            return Ok(Found { profile: read(path)?, place: text.to_owned() });
        }
        let named = self.found.iter().find(|f| f.profile.camera().is("", text));
        named.cloned().ok_or_else(|| Error::NoProfile { text: text.to_owned() })
    }

    /// All profiles, those of the user first.
    pub fn all(&self) -> &[Found] {
        &self.found
    }

    fn with_builtin(mut self) -> Self {
        for (name, text) in BUILTIN {
            match profile::file::parse(text) {
                Ok(profile) => self.found.push(Found { profile, place: "built in".to_owned() }),
                Err(fault) => self.faults.push(format!("built-in profile {name}: {fault}")),
            }
        }
        self
    }
}

/// Whether a profile is for a camera, by any of the camera's names.
pub(crate) fn is_for(profile: &Profile, camera: &Camera) -> bool {
    let of = profile.camera();
    of.is(&camera.common_make, &camera.common_model) || of.is(&camera.make, &camera.model)
}

/// Reads one profile file: Darkroot's own, or a DCP, of which the summary says what was taken.
///
/// # Errors
/// A file that cannot be read or is no usable profile.
pub fn read(path: &Path) -> Result<Profile, Error> {
    let bytes = crate::files::read(path)?;
    if profile::export::dcp::is_dcp(&bytes) {
        let imported = profile::export::dcp::import(&bytes);
        return imported.map(|i| i.profile).map_err(|source| Error::Dcp { path: path.to_owned(), source });
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        let source = profile::Error::Syntax { detail: "it is no text".to_owned() };
        Error::Profile { path: path.to_owned(), source }
    })?;
    profile::file::parse(&text).map_err(|source| Error::Profile { path: path.to_owned(), source })
}

/// Writes a profile's file, whole or not at all. Missing folders are made.
///
/// # Errors
/// A file that exists and is not to be replaced, or that cannot be written.
pub fn write(profile: &Profile, path: &Path, overwrite: bool) -> Result<(), Error> {
    crate::files::write_whole(path, profile::file::format(profile).as_bytes(), overwrite)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    // A folder that is missing or closed to us holds no profiles.
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == "toml") {
            files.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_profile_is_sound() {
        let store = ProfileStore::builtin();
        assert!(store.faults.is_empty(), "{:?}", store.faults);
        assert_eq!(store.all().len(), BUILTIN.len());
    }

    #[test]
    fn a_missing_user_folder_is_no_fault() {
        assert!(ProfileStore::with_user_folder(Path::new("/nowhere/at/all")).faults.is_empty());
    }
}
