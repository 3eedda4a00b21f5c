//! `darkroot completions` and `darkroot man`.

use std::io::Write;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::{Cli, Outcome};
use darkroot::shown;

/// Print completions for a shell
///
/// For bash: darkroot completions bash > ~/.local/share/bash-completion/completions/darkroot
#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(self) -> Result<Outcome> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "darkroot", &mut text);
        crate::out::ours().write_all(&text)?;
        Ok(Outcome::Done)
    }
}

/// Print the manual page, or write the pages of all commands into a folder
#[derive(Debug, Args)]
pub(crate) struct Man {
    /// Folder to write darkroot.1, darkroot-develop.1, ... into
    #[arg(value_name = "FOLDER")]
    folder: Option<PathBuf>,
}

impl Man {
    pub(crate) fn run(self) -> Result<Outcome> {
        match self.folder {
            Some(folder) => {
                std::fs::create_dir_all(&folder)
                    .with_context(|| format!("{}: the folder cannot be made", shown(&folder)))?;
                clap_mangen::generate_to(Cli::command(), &folder)
                    .with_context(|| format!("{}: the pages cannot be written", shown(&folder)))?;
            }
            None => {
                let mut page = Vec::new();
                clap_mangen::Man::new(Cli::command()).render(&mut page)?;
                crate::out::ours().write_all(&page)?;
            }
        }
        Ok(Outcome::Done)
    }
}
