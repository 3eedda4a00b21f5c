//! The layers of a run, put together for each file.

use std::collections::HashMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::file::{self, FolderFile};
use super::{Effective, Layer, Origin, RecipeError};

/// The file that holds for all files of its folder and of those below.
pub const FOLDER_FILE: &str = "darkroot.toml";

/// The file that holds for one raw file: `DSC_0001.NEF.darkroot.toml`.
pub fn sidecar(input: &Path) -> PathBuf {
    let mut name = OsString::from(input);
    name.push(".");
    name.push(FOLDER_FILE);
    name.into()
}

/// What the sidecar of a raw file says, if there is one.
///
/// # Errors
/// It cannot be read or is wrong.
pub fn edits(input: &Path) -> Result<Option<Layer>, RecipeError> {
    file::read_if_there(&sidecar(input), Origin::Sidecar)
}

/// Everything that can say something about a file. What folders say is read once; a clone that was made before
/// the first file reads it again.
#[derive(Debug, Clone)]
pub struct Layers {
    recipe: Option<Layer>,
    flags: Layer,
    /// Whether `darkroot.toml` and sidecars count.
    folders: bool,
    /// What was found in each folder.
    found: HashMap<PathBuf, Option<Arc<FolderFile>>>,
}

impl Layers {
    /// The layers of a run: the recipe that was named, the flags, and, if `folders`, whatever stands in folders
    /// and beside files.
    ///
    /// # Errors
    /// The recipe cannot be read or is wrong.
    pub fn new(recipe: Option<&Path>, flags: Layer, folders: bool) -> Result<Self, RecipeError> {
        let recipe = recipe.map(|path| file::read(path, Origin::Recipe)).transpose()?;
        Ok(Self { recipe, flags, folders, found: HashMap::new() })
    }

    /// What the command line says.
    pub fn flags(&self) -> &Layer {
        &self.flags
    }

    /// What holds for a file. It need not exist.
    ///
    /// # Errors
    /// A `darkroot.toml` above it, or one of its sidecars, cannot be read or is wrong.
    pub fn for_file(&mut self, input: &Path) -> Result<Effective, RecipeError> {
        let edits = if self.folders { edits(input)? } else { None };
        self.for_file_with(input, edits.as_ref())
    }

    /// What would hold for a file if this were its sidecar.
    ///
    /// # Errors
    /// As [`Layers::for_file`].
    pub fn for_file_with(&mut self, input: &Path, edits: Option<&Layer>) -> Result<Effective, RecipeError> {
        let folder = input.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut effective = self.for_folder(folder)?;
        if let Some(layer) = edits {
            effective.lay(layer);
        }
        if self.folders {
            effective.read_sidecar(input);
        }
        Ok(effective)
    }

    /// What holds for the files of a folder that have no sidecar.
    ///
    /// # Errors
    /// A `darkroot.toml` in it or above cannot be read or is wrong.
    pub fn for_folder(&mut self, folder: &Path) -> Result<Effective, RecipeError> {
        let mut effective = Effective::default();
        if self.folders {
            // The folder as the system knows it: `..` and links lead to other folders above.
            let folder = std::fs::canonicalize(folder)
                .or_else(|_| std::path::absolute(folder))
                .unwrap_or_else(|_| folder.to_owned());
            let mut above = Vec::new();
            for folder in folder.ancestors() {
                if let Some(found) = self.folder_file(folder)? {
                    let root = found.root;
                    above.push(found);
                    if root {
                        break;
                    }
                }
            }
            for found in above.iter().rev() {
                effective.lay(&found.layer);
            }
        }
        for layer in self.recipe.iter().chain([&self.flags]) {
            effective.lay(layer);
        }
        Ok(effective)
    }

    fn folder_file(&mut self, folder: &Path) -> Result<Option<Arc<FolderFile>>, RecipeError> {
        if let Some(found) = self.found.get(folder) {
            return Ok(found.clone());
        }
        let found = file::read_folder_file(&folder.join(FOLDER_FILE))?.map(Arc::new);
        self.found.insert(folder.to_owned(), found.clone());
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Key;

    /// A folder of files with these texts.
    fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        folder
    }

    fn layers(recipe: Option<&Path>, flags: &[(Key, &str)]) -> Layers {
        let flags = Layer::flags(flags.iter().map(|(key, text)| (*key, (*text).to_owned()))).unwrap();
        Layers::new(recipe, flags, true).unwrap()
    }

    #[test]
    fn each_layer_counts_more_than_the_ones_below_it_key_by_key() {
        let place = folder(&[
            (
                "darkroot.toml",
                "root = true\nexposure = 1\nlook = \"flat\"\nquality = 80\nbits = 8\ncrop = \"active\"",
            ),
            ("roll/darkroot.toml", "exposure = 2\nlook = \"vivid\"\nquality = 81\nbits = 8"),
            ("recipe.toml", "exposure = 3\nlook = \"flat\"\nquality = 82"),
            ("roll/a.nef.darkroot.toml", "exposure = 5"),
        ]);
        let recipe = place.path().join("recipe.toml");
        let flags = [(Key::named("exposure"), "4"), (Key::named("look"), "neutral")];
        let effective = layers(Some(&recipe), &flags).for_file(&place.path().join("roll/a.nef")).unwrap();
        for (key, text, origin) in [
            (Key::named("exposure"), "5", "sidecar"),
            (Key::named("look"), "neutral", "flag"),
            (Key::named("quality"), "82", "recipe"),
            (Key::named("bits"), "8", "folder"),
            (Key::named("crop"), "active", "folder"),
            (Key::named("space"), "auto", "default"),
        ] {
            let (found, from) = effective.get(key);
            assert_eq!((found, from.name()), (text, origin), "{key}");
        }
        let files: Vec<_> = effective.files().iter().map(|(o, keys)| (o.name(), keys.clone())).collect();
        let expected = [
            ("folder", vec![Key::named("crop")]),
            ("folder", vec![Key::named("bits")]),
            ("recipe", vec![Key::named("quality")]),
            ("sidecar", vec![Key::named("exposure")]),
        ];
        assert_eq!(files, expected);
        assert!((effective.settings().unwrap().recipe.exposure.stops - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_root_ends_the_search_upwards() {
        let place = folder(&[
            ("darkroot.toml", "root = true\nlook = \"flat\""),
            ("a/darkroot.toml", "root = true\nexposure = 1"),
            ("a/b/darkroot.toml", "quality = 50"),
        ]);
        let effective = layers(None, &[]).for_file(&place.path().join("a/b/x.nef")).unwrap();
        assert_eq!(effective.get(Key::named("look")), ("neutral", &Origin::Default));
        assert_eq!(effective.get(Key::named("exposure")).0, "1");
        assert_eq!(effective.get(Key::named("quality")).0, "50");
    }

    #[test]
    fn dots_and_links_lead_to_the_folders_that_are_really_above() {
        let place = folder(&[
            ("darkroot.toml", "root = true"),
            ("one/darkroot.toml", "look = \"flat\""),
            ("two/darkroot.toml", "look = \"vivid\""),
        ]);
        let look = |path: &str| {
            let effective = layers(None, &[]).for_file(&place.path().join(path)).unwrap();
            effective.get(Key::named("look")).0.to_owned()
        };
        assert_eq!(look("one/../two/x.nef"), "vivid");
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("../two", place.path().join("one/link")).unwrap();
            assert_eq!(look("one/link/x.nef"), "vivid");
        }
    }

    #[test]
    fn without_recipes_only_the_named_one_and_flags_count() {
        let place = folder(&[
            ("darkroot.toml", "look = \"film\""),
            ("a.nef.darkroot.toml", "nonsense"),
            ("recipe.toml", "exposure = 3"),
        ]);
        let recipe = place.path().join("recipe.toml");
        let mut layers = Layers::new(Some(&recipe), Layer::flags([]).unwrap(), false).unwrap();
        let effective = layers.for_file(&place.path().join("a.nef")).unwrap();
        assert_eq!(effective.get(Key::named("exposure")), ("3", &Origin::Recipe(recipe)));
        assert_eq!(effective.get(Key::named("look")).1, &Origin::Default);
    }

    #[test]
    fn a_root_in_another_file_than_that_of_a_folder_is_refused() {
        let place = folder(&[
            ("darkroot.toml", "root = true"),
            ("a.nef.darkroot.toml", "look = \"flat\"\nroot = true"),
        ]);
        let error = layers(None, &[]).for_file(&place.path().join("a.nef")).unwrap_err().to_string();
        assert!(error.contains("a.nef.darkroot.toml:2:") && error.contains("`root`"), "{error}");
    }
}
