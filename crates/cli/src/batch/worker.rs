//! The worker process: not for people.

use std::io::{BufReader, stdin, stdout};

use anyhow::Result;
use clap::Args;

use crate::Outcome;
use crate::sandbox::Sandbox;

/// Take tasks on stdin: what `batch` and `watch` start to develop files
#[derive(Debug, Args)]
#[command(hide = true)]
pub(crate) struct Worker {
    #[command(flatten)]
    sandbox: Sandbox,
}

impl Worker {
    pub(crate) fn run(self) -> Result<Outcome> {
        // Faults of profiles were told by the parent.
        let (orders, answers) = (BufReader::new(stdin()), stdout().lock());
        darkroot_batch::serve(
            orders,
            answers,
            &darkroot::ProfileStore::of_user(),
            &crate::hint::words,
            self.sandbox.is_on(),
        )?;
        Ok(Outcome::Done)
    }
}
