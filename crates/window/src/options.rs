//! What a window is opened with.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use darkroot::ProfileStore;
use darkroot_batch::{CrewOptions, Wording};

/// What a window is opened with.
#[derive(Debug, Clone)]
pub struct Options {
    /// Folders and files to show. Nothing outside of these folders, and of those that the files lie in, is read or written
    /// for the page.
    pub inputs: Vec<PathBuf>,
    /// Address to listen on.
    pub listen: IpAddr,
    /// Port; 0 for any that is free.
    pub port: u16,
    /// Profiles.
    pub store: ProfileStore,
    /// Folder that profiles are saved to, and read from beside those of the store.
    pub profiles: Option<PathBuf>,
    /// How batches are run.
    pub crew: CrewOptions,
    /// How errors are worded.
    pub wording: Wording,
}

impl Options {
    /// For these folders and files, on the loopback, with the built-in profiles; batches run in threads of this process.
    pub fn of(inputs: Vec<PathBuf>) -> Self {
        let store = ProfileStore::builtin();
        Self {
            inputs,
            listen: Ipv4Addr::LOCALHOST.into(),
            port: 0,
            crew: CrewOptions::in_process(store.clone()),
            store,
            profiles: None,
            wording: Wording::default(),
        }
    }
}
