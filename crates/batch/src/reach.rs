//! What a task still needs when its worker gives up the rest.

use std::path::{Path, PathBuf};

use darkroot::files::Output;
use darkroot::{ProfileChoice, ProfileStore};
use darkroot_sandbox::{Access, Reach};

use super::develop_task::Opened;
use super::task::Calibrate;

/// Reading one file, and what the system tells of the own process.
pub(crate) fn reading(input: &Path) -> Reach {
    Reach::default().with(input, Access::Read).with("/proc/self", Access::Read)
}

/// Developing: the profiles, and a name for the output, which is open already.
pub(crate) fn developing(opened: &Opened) -> Reach {
    let named = match &opened.settings.profile {
        ProfileChoice::File(path) => Some(path.clone()),
        ProfileChoice::Automatic | ProfileChoice::Matrix => None,
    };
    // A DCP in the user's folder is read when it is wanted; profiles of the session, too.
    let named = named.into_iter().chain(opened.settings.files());
    let profiles = named.chain(ProfileStore::user_folder()).chain(opened.session_profiles());
    let takes_away = opened.settings.overwrite || opened.output.is_renamed();
    let access = if takes_away { Access::Replace } else { Access::Name };
    reading(opened.input())
        .with_any(profiles, Access::Read)
        .with_any(opened.output.folders().to_vec(), access)
}

/// Looking for a chart, whose layout may be a file.
pub(crate) fn looking(input: &Path, layout: Option<&str>) -> Reach {
    reading(input).with_any(layout.map(PathBuf::from), Access::Read)
}

/// Making a profile: layout, reference and light may be files, and the profile gets a name.
pub(crate) fn calibrating(task: &Calibrate, output: &Output) -> Reach {
    let texts = [Some(&task.layout), task.reference.as_ref(), task.light.as_ref()];
    let files = texts.into_iter().flatten().map(PathBuf::from);
    reading(&task.input).with_any(files, Access::Read).with_any(output.folders().to_vec(), Access::Replace)
}
