//! One layer of settings, and where it is from.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use super::written::written;
use super::{RecipeError, file};
use crate::settings::{Key, NotAValue};
use crate::shown;

/// Where a value comes from, in rising priority.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// Nobody said anything.
    Default,
    /// A `darkroot.toml` in the file's folder or above.
    Folder(PathBuf),
    /// The recipe that was named.
    Recipe(PathBuf),
    /// The command line.
    Flag,
    /// The file's own `.darkroot.toml`.
    Sidecar(PathBuf),
}

impl Origin {
    /// One word for machines: default, folder, recipe, flag or sidecar.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Folder(_) => "folder",
            Self::Recipe(_) => "recipe",
            Self::Flag => "flag",
            Self::Sidecar(_) => "sidecar",
        }
    }

    /// The file that says it, if it is one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Folder(path) | Self::Recipe(path) | Self::Sidecar(path) => Some(path),
            Self::Default | Self::Flag => None,
        }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.path() {
            Some(path) => write!(f, "{}", shown(path)),
            None if *self == Self::Flag => f.write_str("command line"),
            None => f.write_str("default"),
        }
    }
}

/// What one place says: texts as on the command line, each of them checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layer {
    /// Where it is from.
    pub origin: Origin,
    values: BTreeMap<Key, String>,
}

impl Layer {
    /// What the command line says.
    ///
    /// # Errors
    /// A text that is no value of its key.
    pub fn flags(values: impl IntoIterator<Item = (Key, String)>) -> Result<Self, RecipeError> {
        let mut layer = Self::empty(Origin::Flag);
        for (key, text) in values {
            layer.set(key, &text).map_err(|wrong| RecipeError::Flag { key, wrong })?;
        }
        Ok(layer)
    }

    /// What the sidecar of a raw file says, or shall say.
    ///
    /// # Errors
    /// A text that is no value of its key.
    pub fn sidecar(
        input: &Path,
        values: impl IntoIterator<Item = (Key, String)>,
    ) -> Result<Self, RecipeError> {
        let mut layer = Self::empty(Origin::Sidecar(super::sidecar(input)));
        for (key, text) in values {
            layer.set(key, &text).map_err(|wrong| RecipeError::Flag { key, wrong })?;
        }
        Ok(layer)
    }

    /// Reads a recipe file.
    ///
    /// # Errors
    /// A file that cannot be read, or a name or a value that is none.
    pub fn read(path: &Path) -> Result<Self, RecipeError> {
        file::read(path, Origin::Recipe)
    }

    /// What a text of TOML says, as a recipe file has it. Files in it are relative to the current folder.
    ///
    /// # Errors
    /// A name or a value that is none.
    pub fn parse(text: &str) -> Result<Self, RecipeError> {
        file::read_text(text)
    }

    /// As a recipe file, a line for each setting that it says something about.
    pub fn to_toml(&self) -> String {
        self.iter().map(|(key, text)| format!("{key} = {}\n", written(key, text))).collect()
    }

    pub(super) fn empty(origin: Origin) -> Self {
        Self { origin, values: BTreeMap::new() }
    }

    pub(super) fn set(&mut self, key: Key, text: &str) -> Result<(), NotAValue> {
        self.values.insert(key, key.checked(text)?);
        Ok(())
    }

    /// What it says about a key, if anything.
    pub fn get(&self, key: Key) -> Option<&str> {
        self.values.get(&key).map(String::as_str)
    }

    /// All that it says.
    pub fn iter(&self) -> impl Iterator<Item = (Key, &str)> {
        self.values.iter().map(|(key, text)| (*key, text.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_that_is_written_says_the_same_when_it_is_read() {
        let text = "exposure = 0.5\nlook = \"linear\"\nwhite-balance = \"2.1,1,1.5\"\nauto-exposure = true\n";
        let layer = Layer::parse(text).unwrap();
        assert_eq!(Layer::parse(&layer.to_toml()), Ok(layer.clone()));
        assert_eq!(layer.iter().count(), 4);
        let message = Layer::parse("spcae = 1").unwrap_err().to_string();
        assert!(message.starts_with("the recipe:1: ") && message.contains("`space`?"), "{message}");
    }
}
