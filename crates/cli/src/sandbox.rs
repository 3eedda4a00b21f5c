//! What the program gives up before it reads a file that somebody made.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use darkroot::{Output, ProfileChoice, ProfileStore, Settings};
use darkroot_sandbox::{Access, Breach, Reach, confine, offered};

use crate::Common;

/// Whether anything is given up.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct Sandbox {
    /// Decode without a sandbox: a decoder that a file leads astray can then do whatever you can
    #[arg(long)]
    no_sandbox: bool,
}

impl Sandbox {
    pub(crate) fn is_on(self) -> bool {
        !self.no_sandbox
    }

    /// Says what the system does not offer of it.
    pub(crate) fn say(self, common: Common) {
        match offered().missing() {
            _ if self.no_sandbox || common.quiet => {}
            Some(missing) => crate::say(format_args!("note: {missing}")),
            None if common.verbose => {
                crate::say(format_args!("sandbox: paths by Landlock, system calls by seccomp"));
            }
            None => {}
        }
    }

    /// Gives up, for good, everything but this. It is done before there is a second thread, which would keep its rights.
    pub(crate) fn confine(self, reach: &Reach) -> Result<()> {
        if self.is_on() {
            // A call that is given up fails: the other files are not to suffer.
            confine(reach, Breach::Fails)?;
        }
        Ok(())
    }
}

/// Reading these files, the profiles, and what the system tells of the own process.
pub(crate) fn reading<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> Reach {
    Reach::default()
        .with_any(files.into_iter().cloned(), Access::Read)
        .with_any(ProfileStore::user_folder(), Access::Read)
        .with("/proc/self", Access::Read)
}

/// The files that settings name: the profile, and a shot of a chart with its layout and reference.
pub(crate) fn named(settings: &Settings) -> impl Iterator<Item = PathBuf> {
    let profile = match &settings.profile {
        ProfileChoice::File(path) => Some(path.clone()),
        ProfileChoice::Automatic | ProfileChoice::Matrix => None,
    };
    profile.into_iter().chain(settings.files())
}

/// With a name for an output that is open.
pub(crate) fn naming(reach: Reach, output: &Output, overwrite: bool) -> Reach {
    let access = if overwrite || output.is_renamed() { Access::Replace } else { Access::Name };
    reach.with_any(output.folders().to_vec(), access)
}

/// With writing into the folder of this path, or, where it is still to be made, into the one above that.
pub(crate) fn writing(reach: Reach, path: &Path) -> Reach {
    let above = path.ancestors().skip(1).find(|folder| folder.as_os_str().is_empty() || folder.is_dir());
    let folder = above.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    reach.with(folder, Access::Write)
}
