//! What can be wrong with a place where inputs are looked for.

use darkroot::shown;
use std::io;
use std::path::PathBuf;

/// What could not be read while looking for inputs. The others are developed all the same.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SourceFault {
    /// A link that leads up the tree, and would be followed for ever.
    #[error("{path}: is a link to a folder above it; it is not followed", path = shown(path))]
    LinkLoop {
        /// The link.
        path: PathBuf,
    },
    /// A folder without permission.
    #[error("{path}: permission denied; check the folder's rights", path = shown(path))]
    Denied {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing at the end of a link, or not any more.
    #[error("{path}: is gone, or a link to nothing", path = shown(path))]
    Gone {
        /// The file or folder.
        path: PathBuf,
    },
    /// A folder that cannot be read for another reason.
    #[error("{path}: cannot be read: {source}", path = shown(path))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: walkdir::Error,
    },
    /// A file that cannot be read.
    #[error(transparent)]
    File(#[from] darkroot::Error),
}

impl From<walkdir::Error> for SourceFault {
    fn from(source: walkdir::Error) -> Self {
        let path = source.path().map(PathBuf::from).unwrap_or_default();
        if source.loop_ancestor().is_some() {
            return Self::LinkLoop { path };
        }
        match source.io_error().map(io::Error::kind) {
            Some(io::ErrorKind::PermissionDenied) => Self::Denied { path },
            Some(io::ErrorKind::NotFound) => Self::Gone { path },
            _ => Self::Folder { path, source },
        }
    }
}
