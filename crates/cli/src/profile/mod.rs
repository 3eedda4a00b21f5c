//! `darkroot profile`: make, judge and use camera profiles.

mod apply;
mod from_spectra;
mod lint;
mod list;
mod show;

use anyhow::Result;
use clap::{Args, Subcommand};
use darkroot::ProfileStore;

use crate::{Common, Outcome};

/// Make, judge and use camera profiles
#[derive(Debug, Args)]
pub(crate) struct Profile {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Apply(apply::Apply),
    Show(show::Show),
    List(list::List),
    Lint(lint::Lint),
    FromSpectra(from_spectra::FromSpectra),
}

impl Profile {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        match self.command {
            Command::Apply(command) => command.run(),
            Command::Show(command) => command.run(),
            Command::List(command) => command.run(),
            Command::Lint(command) => command.run(),
            Command::FromSpectra(command) => command.run(common),
        }
    }
}

/// The user's profiles and those built in; profile files that cannot be used are said.
fn store() -> ProfileStore {
    let store = ProfileStore::user_folder()
        .map_or_else(ProfileStore::builtin, |folder| ProfileStore::with_user_folder(&folder));
    for fault in &store.faults {
        crate::say(format_args!("warning: {fault}"));
    }
    store
}
