//! What a process gives up before it reads a byte of hostile input.
//!
//! Decoders of raw files are foreign code that meets whatever people send. If one is led astray so far that it does what
//! a file says, [`confine`] bounds what that can be: the process reads no path but those of its [`Reach`], writes nowhere
//! else, opens no connection, starts no program, touches no other process, and never gets any of this back.
//!
//! On Linux, Landlock holds the paths and seccomp the system calls. What a kernel does not offer is said by [`Held`],
//! not passed over. Other systems offer neither.
//!
//! **What it does not do:** descriptors that are open already stay open. Only the calling thread and threads that it
//! starts later are held to their paths, so it is called while there is no other.

use std::path::PathBuf;

#[cfg(target_os = "linux")]
mod paths;

#[cfg(all(
    target_os = "linux",
    any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")
))]
mod calls;

/// What may be done with a path, and with everything below it if it is a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Read.
    Read,
    /// Give a file that is open already a name here. What stands here cannot be read, written or replaced.
    Name,
    /// As [`Access::Name`], also in place of something that stands here.
    Replace,
    /// Make, write, rename and remove files and folders.
    Write,
}

/// All the paths that a process still needs. What is not there is left out.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Reach(Vec<(PathBuf, Access)>);

impl Reach {
    /// With one path more.
    #[must_use]
    pub fn with(mut self, path: impl Into<PathBuf>, access: Access) -> Self {
        self.0.push((path.into(), access));
        self
    }

    /// With one path more, if there is one.
    #[must_use]
    pub fn with_any(self, paths: impl IntoIterator<Item = PathBuf>, access: Access) -> Self {
        paths.into_iter().fold(self, |reach, path| reach.with(path, access))
    }
}

/// What becomes of a process that makes a system call which it gave up. A path out of reach is always an error for whoever
/// asks for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breach {
    /// The system ends it with the signal SIGSYS.
    Ends,
    /// The call fails.
    Fails,
}

/// What holds a process, or could.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Held {
    /// Files and folders out of reach are closed (Landlock).
    pub paths: bool,
    /// Network, programs and other processes are (seccomp).
    pub calls: bool,
}

impl Held {
    /// What this system does not offer, as a sentence; `None` where it offers all.
    pub fn missing(self) -> Option<&'static str> {
        match (self.paths, self.calls) {
            (true, true) => None,
            (false, true) => Some(
                "this system has no Landlock of version 2 (Linux 5.19): a decoder that is led astray could reach other files",
            ),
            (true, false) => Some(
                "this system has no seccomp: a decoder that is led astray could start programs and open connections",
            ),
            (false, false) => Some(
                "this system offers no sandbox (Landlock and seccomp of Linux): a decoder that is led astray could do \
                 whatever you can",
            ),
        }
    }
}

/// The system offers a sandbox and then refuses it.
#[derive(Debug, thiserror::Error)]
#[error("the sandbox cannot be set up: {0}")]
pub struct NotConfined(#[source] Box<dyn std::error::Error + Send + Sync>);

/// Gives up everything but what is in reach, for good. Called again, it gives up more. Says what holds from now on.
///
/// # Errors
/// The system refuses what it offers.
pub fn confine(reach: &Reach, breach: Breach) -> Result<Held, NotConfined> {
    system::confine(reach, breach)
}

/// What the system offers; nothing is given up.
pub fn offered() -> Held {
    system::offered()
}

#[cfg(target_os = "linux")]
mod system {
    use super::{Access, Breach, Held, NotConfined, Reach, paths};

    pub(crate) fn confine(reach: &Reach, breach: Breach) -> Result<Held, NotConfined> {
        use rustix::process::{Resource, Rlimit, setrlimit};
        // Its memory is not to be left in files either. A limit can always be lowered.
        let _ = setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) });
        // The calls first: what the system says of them may lie on a path that is closed then.
        let makes_files = reach.0.iter().any(|(_, access)| *access == Access::Write);
        let calls = calls(breach, makes_files)?;
        Ok(Held { paths: paths::close(&reach.0)?, calls })
    }

    pub(crate) fn offered() -> Held {
        Held { paths: paths::offered(), calls: calls_offered() }
    }

    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64"))]
    use super::calls::{give_up as calls, offered as calls_offered};

    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")))]
    fn calls(_: Breach, _: bool) -> Result<bool, NotConfined> {
        Ok(false)
    }

    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")))]
    fn calls_offered() -> bool {
        false
    }
}

#[cfg(not(target_os = "linux"))]
mod system {
    use super::{Breach, Held, NotConfined, Reach};

    pub(crate) fn confine(_: &Reach, _: Breach) -> Result<Held, NotConfined> {
        Ok(Held::default())
    }

    pub(crate) fn offered() -> Held {
        Held::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said() {
        assert_eq!(Held { paths: true, calls: true }.missing(), None);
        for (held, word) in [
            (Held { paths: false, calls: true }, "other files"),
            (Held { paths: true, calls: false }, "connections"),
            (Held::default(), "no sandbox"),
        ] {
            assert!(held.missing().unwrap().contains(word));
        }
    }
}
