//! What can be wrong with a recipe. Each message names the place, what is wrong and what is allowed.

use std::path::PathBuf;

use super::layers::FOLDER_FILE;
use crate::settings::{Key, NotAValue};
use crate::{quoted, shown};

/// Why a recipe cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unreadable {
    /// Nothing of that name.
    #[error("there is no such file")]
    Missing,
    /// A folder of that name.
    #[error("it is a folder")]
    Folder,
    /// Bytes that are no text.
    #[error("it is not text in UTF-8")]
    NotText,
    /// So large that it is something else.
    #[error("it is larger than any recipe (1 MB)")]
    TooLarge,
    /// Something else.
    #[error("{message}")]
    System {
        /// What the system says.
        message: String,
    },
}

/// Settings that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RecipeError {
    /// The file cannot be read.
    #[error("{path}: the recipe cannot be read: {source}", path = shown(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Unreadable,
    },
    /// The file is no TOML.
    #[error("{path}:{line}: this is not TOML (`name = value`, text in quotes): {}", quoted(message), path = shown(path))]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// What the reader of TOML says.
        message: String,
    },
    /// A name that is no setting.
    #[error("{path}:{line}: `{}` is no setting; {}", quoted(name), instead(*nearest), path = shown(path))]
    Key {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// The name.
        name: String,
        /// What may have been meant.
        nearest: Option<Key>,
    },
    /// A value of the wrong type.
    #[error("{path}:{line}: `{}` cannot be {found}; write {allowed}", quoted(name), path = shown(path))]
    Type {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// The name.
        name: String,
        /// What it is, in words.
        found: &'static str,
        /// What it can be, in words.
        allowed: String,
    },
    /// A value that the key does not have.
    #[error("{path}:{line}: `{key}`: {wrong}", path = shown(path))]
    Value {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// The key.
        key: Key,
        /// What is wrong with it.
        wrong: NotAValue,
    },
    /// A value that the flag does not have.
    #[error("`{key}`: {wrong}")]
    Flag {
        /// The key.
        key: Key,
        /// What is wrong with it.
        wrong: NotAValue,
    },
    /// `root` where it means nothing.
    #[error(
        "{path}:{line}: `root` belongs into a {FOLDER_FILE}, where it ends the search in the folders above; leave it \
         out here", path = shown(path)
    )]
    Root {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
    },
    /// A profile where a recipe should be.
    #[error("{path}: is a camera profile, not a recipe", path = shown(path))]
    Profile {
        /// The file.
        path: PathBuf,
    },
    /// A sidecar of XMP that is none.
    #[error("{message}")]
    Sidecar {
        /// Which file, what is wrong, and what can be done.
        message: String,
    },
    /// A name that is no setting, not from a file.
    #[error("`{}` is no setting; {}", quoted(name), instead(Key::nearest(name)))]
    Name {
        /// The name.
        name: String,
    },
}

fn instead(nearest: Option<Key>) -> String {
    match nearest {
        Some(key) => format!("did you mean `{key}`?"),
        None => format!("there are {}", Key::names()),
    }
}
