//! The process that decodes for a window: not for people.

use std::io::{stdin, stdout};

use anyhow::Result;
use clap::Args;

use crate::Outcome;
use crate::sandbox::Sandbox;

/// Decode what comes on stdin: what `open` starts for each photograph
#[derive(Debug, Args)]
#[command(hide = true)]
pub(crate) struct Decoder {
    #[command(flatten)]
    sandbox: Sandbox,
}

impl Decoder {
    pub(crate) fn run(self) -> Result<Outcome> {
        let plain = |error: &(dyn std::error::Error + 'static)| error.to_string();
        darkroot_window::serve_decoder(stdin().lock(), stdout().lock(), &plain, self.sandbox.is_on())?;
        Ok(Outcome::Done)
    }
}
