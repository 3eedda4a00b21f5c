//! `darkroot profile`: make, judge and use camera profiles.

mod apply;
mod export;
mod from_matrix;
mod from_spectra;
mod lint;
mod list;
mod make;
mod shot_args;
mod show;
mod table;
mod told;

pub(crate) use shot_args::ShotArgs;

use anyhow::Result;
use clap::{Args, Subcommand};
use darkroot::ProfileStore;

use crate::{Common, Outcome};

/// Make, judge and use camera profiles
///
/// With shots of a colour chart it makes a profile: darkroot profile chart.NEF --chart classic24 --light D50.
/// With tables of patches that were measured elsewhere, too: darkroot profile chart.ti3 --light D50 --make Nikon --camera-model D700
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Profile {
    #[command(subcommand)]
    command: Option<Command>,

    #[command(flatten)]
    make: make::Make,
}

#[derive(Debug, Subcommand)]
enum Command {
    Apply(apply::Apply),
    Show(show::Show),
    List(list::List),
    Lint(lint::Lint),
    FromSpectra(from_spectra::FromSpectra),
    FromMatrix(from_matrix::FromMatrix),
    Export(export::Export),
}

impl Profile {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        let Some(command) = self.command else { return self.make.run(common) };
        match command {
            Command::Apply(command) => command.run(),
            Command::Show(command) => command.run(),
            Command::List(command) => command.run(),
            Command::Lint(command) => command.run(),
            Command::FromSpectra(command) => command.run(common),
            Command::FromMatrix(command) => command.run(common),
            Command::Export(command) => command.run(common),
        }
    }
}

/// The user's profiles and those built in; profile files that cannot be used are said.
pub(crate) fn store() -> ProfileStore {
    let store = ProfileStore::of_user();
    for fault in &store.faults {
        crate::say(format_args!("warning: {fault}"));
    }
    store
}
